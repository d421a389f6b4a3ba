//! Level of detail: camera, ranges, choice of nodes, culling, morph, index permutations.
//!
//! - [`view`]: camera, viewport, quality; [`pose`]: position and orientation of the eye
//! - [`tile`]: a tile: vertices and bounds; [`horizon`]: horizon angles
//! - [`stitch`]: index permutations for coarser neighbours
//! - [`opening`]: the camera when a planet is opened; [`scout`]: random planets that open on a good view
//! - [`chords`]: the edges of the coarser mesh that the vertices of a finer level divide
//! - [`range`]: the distance at which each level splits
//! - [`morph`]: vertices between the coarser mesh and their exact position
//! - [`select`]: which nodes must be split for a view
//! - [`cull`]: frustum and horizon

pub mod chords;
pub mod cull;
pub mod horizon;
pub mod morph;
pub mod opening;
pub mod pose;
pub mod range;
pub mod scout;
pub mod select;
pub mod stitch;
pub mod tile;
pub mod view;

pub use cull::Culling;
pub use range::Ranges;
pub use select::Selection;
pub use tile::{Tile, Vertex};
pub use view::{Camera, Quality, View};
