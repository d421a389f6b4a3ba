//! Which tiles can be seen: frustum and horizon.

use super::View;
use crate::build::tile::Tile;

/// What a view can see; made once a frame.
pub struct Culling {}

impl Culling {
    /// For a view of a planet whose ground nowhere lies lower than `lowest_radius_m` from the centre.
    pub fn new(_view: &View, _lowest_radius_m: f64) -> Self {
        Self {}
    }
    /// Whether any of the tile may be seen. Never wrongly false: mountains beyond the horizon stay.
    pub fn sees(&self, _tile: &Tile) -> bool {
        true
    }
}
