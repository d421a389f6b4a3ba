//! Photographs and films of a planet, in files.
//!
//! - `shot`: builds what a view needs, and takes its photograph
//! - `sequence`: photographs one after the other, each into a file
//! - `path`: the way of a camera over bookmarks
//! - `thumbnail`: small pictures, drawn quickly
//! - `file`: PNG and OpenEXR; names of frames

mod file;
mod path;
mod sequence;
mod shot;
mod thumbnail;

pub use file::{FileKind, frame_path};
pub use path::CameraPath;
pub use sequence::{Film, Sequence};
pub use shot::Shot;
pub use thumbnail::Thumbnail;
