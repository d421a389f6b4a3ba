//! Meshes of artists that populations refer to: glTF 2.0 files, and what is kept of them.
//!
//! - `data`: nodes, corners and colours, as they are kept
//! - `read`: opens the file and the files that it names, or takes their bytes
//! - `decode`: the scene of a document; `surface`: triangles of a primitive; `accessor`: numbers of a buffer
//! - `texture`: pictures of colours, averaged
//!
//! A population whose mesh is missing stands with a plain form.

mod accessor;
mod data;
mod decode;
mod read;
mod surface;
mod texture;

pub use data::{MAX_TRIANGLES, MeshCorner, MeshData, MeshFile, MeshNode};
pub use read::MAX_FILE_BYTES;
pub(super) use read::{decoded, load};
pub(super) use texture::linear as linear_from_srgb;
