//! Photographs and films of a planet, in files.
//!
//! - `shot`: builds what a view needs, and takes its photograph
//! - `path`: the way of a camera over bookmarks
//! - `file`: PNG and OpenEXR; names of frames

mod file;
mod path;
mod shot;

pub use file::{FileKind, frame_path};
pub use path::{CameraPath, surface_radius_m};
pub use shot::{Sequence, Shot};
