//! Whether a node is fine enough: screen-space error, and the distances between which levels blend.
//!
//! A node's error is taken as half its vertex spacing: a surface of slope 1 can leave the chord between two vertices by
//! that much. It is projected at the nearest point of the node, so each level has one distance inside which it is
//! split, and each level's distance is half the one before.

use super::{Culling, Quality, View};
use crate::lod::tile::{TILE_QUADS, TILE_SIDE, Tile};
use crate::sphere::NodeId;

/// A node nearer than this many of its vertex spacings is always split, however small the picture: the blend between
/// levels ([`morph_range_m`]) relies on nodes being small against their distance.
const LEAST_DISTANCE_SPACINGS: f64 = 48.0;

/// Nodes a little outside the picture are refined too, so that a turn of the head shows no coarse ground.
const FRUSTUM_MARGIN: f64 = 1.15;

/// Decides for one view which nodes must be split.
#[derive(Clone, Debug)]
pub struct Selection {
    culling: Culling,
    view: View,
    radius_m: f64,
}

impl Selection {
    /// For a view of a planet of this radius, whose ground or sea nowhere lies lower than `lowest_radius_m`.
    pub fn new(view: &View, radius_m: f64, lowest_radius_m: f64) -> Self {
        Self { culling: Culling::widened(view, lowest_radius_m, FRUSTUM_MARGIN), view: *view, radius_m }
    }

    /// Whether the tile is too coarse for the view.
    pub fn wants_split(&self, tile: &Tile) -> bool {
        let level = tile.id.level;
        level < NodeId::MAX_LEVEL
            && self.is_within(tile, split_distance_m(level, self.radius_m, &self.view))
            && self.culling.sees(tile)
    }

    /// Whether any of the tile is nearer than a distance: by its bounding sphere, then by every eighth vertex
    /// and what may lie around it.
    fn is_within(&self, tile: &Tile, distance_m: f64) -> bool {
        const STRIDE: usize = 8;
        let eye = self.view.camera.position_planet_m;
        if eye.distance(tile.center_planet_m) - tile.bounding_radius_m >= distance_m {
            return false;
        }
        let between_m = spacing_rad(tile.id.level) * self.radius_m * STRIDE as f64 * std::f64::consts::FRAC_1_SQRT_2;
        let reach_m = distance_m + between_m;
        (0..TILE_SIDE).step_by(STRIDE).any(|y| {
            (0..TILE_SIDE).step_by(STRIDE).any(|x| {
                let vertex = &tile.vertices[y * TILE_SIDE + x];
                vertex.position_planet_m().distance_squared(eye) < reach_m * reach_m
            })
        })
    }
}

/// Angle between neighbouring vertices of a level (nominal).
pub fn spacing_rad(level: u8) -> f64 {
    std::f64::consts::FRAC_PI_2 / (TILE_QUADS as f64 * f64::from(1_u32 << level))
}

/// Distance from the eye inside which a node of a level is split.
pub fn split_distance_m(level: u8, radius_m: f64, view: &View) -> f64 {
    let spacing_px = match view.quality {
        Quality::Low => 16.0,
        Quality::Medium => 6.0,
        Quality::High => 2.5,
    };
    let focal_px = f64::from(view.size_px[1]) * 0.5 / (view.camera.fov_y_rad * 0.5).tan();
    spacing_rad(level) * radius_m * (focal_px / spacing_px).max(LEAST_DISTANCE_SPACINGS)
}

/// Distances from the eye between which a tile of a level blends into what its parent would show there: start and end,
/// in metres. At the end it is the parent's.
pub fn morph_range_m(level: u8, radius_m: f64, view: &View) -> (f64, f64) {
    if level == 0 {
        return (1e30, 2e30);
    }
    let end_m = split_distance_m(level - 1, radius_m, view);
    (0.7 * end_m, end_m)
}
