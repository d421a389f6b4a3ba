//! Which nodes are shown: the camera, the choice of nodes by screen-space error, culling, index permutations.
//!
//! - [`view`]: camera, viewport, quality
//! - [`tile`]: what a tile is: vertices, bounds; [`horizon`]: how high the ground around it stands
//! - [`stitch`]: index permutations for coarser neighbours
//! - [`opening`]: where the camera stands when a planet is opened
//! - [`chords`]: what stands in for a vertex before it appears
//! - [`range`]: how far from the eye each level shows
//! - [`morph`]: how vertices rise out of the coarser mesh
//! - [`select`]: which nodes must be split for a view
//! - [`cull`]: frustum and horizon

pub mod chords;
pub mod cull;
pub mod horizon;
pub mod morph;
pub mod opening;
pub mod range;
pub mod select;
pub mod stitch;
pub mod tile;
pub mod view;

pub use cull::Culling;
pub use range::Ranges;
pub use select::Selection;
pub use tile::{Tile, Vertex};
pub use view::{Camera, Quality, View};
