//! Photographs and films of a planet, in files.
//!
//! - `shot`: builds what a view needs, and takes its photograph
//! - `sequence`: photographs one after the other, each into a file
//! - `place`: a planet's place in a system: the other bodies of a photograph
//! - `path`: the way of a camera over bookmarks
//! - `thumbnail`: small pictures, drawn quickly
//! - `file`: PNG and OpenEXR; names of frames

mod file;
mod path;
mod place;
mod sequence;
mod shot;
mod thumbnail;

pub use file::{FileKind, frame_path};
pub use path::CameraPath;
pub use place::InSystem;
pub use sequence::{Film, Sequence, Taken};
pub use shot::Shot;
pub use thumbnail::Thumbnail;
