//! Which nodes are shown: the camera, the choice of nodes by screen-space error, culling, index permutations.
//!
//! - [`view`]: camera, viewport, quality
//! - [`stitch`]: index permutations for coarser neighbours
//! - [`cull`]: frustum and horizon

pub mod cull;
pub mod stitch;
pub mod view;

pub use cull::Culling;
pub use view::{Camera, Quality, View};

/// Distances from the eye between which a tile of a level blends into what its parent would show there: start and end, in
/// metres. At the end it is the parent's.
pub fn morph_range_m(_level: u8, _radius_m: f64, _view: &View) -> (f64, f64) {
    (1e12, 2e12)
}
