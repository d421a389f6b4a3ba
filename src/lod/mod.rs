//! Which nodes are shown: the camera, the choice of nodes by screen-space error, culling, index permutations.
//!
//! - [`view`]: camera, viewport, quality
//! - [`tile`]: what a tile is: vertices, bounds; [`horizon`]: how high the ground around it stands
//! - [`stitch`]: index permutations for coarser neighbours
//! - [`opening`]: where the camera stands when a planet is opened
//! - [`select`]: which nodes must be split for a view, and how levels blend
//! - [`cull`]: frustum and horizon

pub mod cull;
pub mod horizon;
pub mod opening;
pub mod select;
pub mod stitch;
pub mod tile;
pub mod view;

pub use cull::Culling;
pub use select::{Selection, morph_range_m};
pub use tile::{Tile, Vertex};
pub use view::{Camera, Quality, View};
