//! Texture sets of artists that biomes refer to: pictures of colour, normals, roughness, heights and occlusion.
//!
//! - `set`: what is kept of a set, and the reference to it
//! - `names`: the names of its pictures, by that of its colour picture
//! - `read`: finds and reads the pictures; `decode`: their formats; `shrink`: their size
//! - `compose`: one texture layer from the pictures; `layer`: such a layer, as built-in patterns have it, too
//!
//! A biome whose set is missing shows its built-in pattern.

mod compose;
mod decode;
pub(crate) mod layer;
mod names;
mod read;
mod set;
mod shrink;

pub use decode::MAX_TEXTURE_SIDE;
pub(crate) use layer::SIDE;
pub(super) use read::{decoded, load};
pub use set::{TextureSet, TextureSetFile};
