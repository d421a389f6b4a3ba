//! Which nodes are shown: the camera, the choice of nodes by screen-space error, culling, index permutations.
//!
//! - [`view`]: camera, viewport, quality

pub mod view;

pub use view::{Camera, Quality, View};
