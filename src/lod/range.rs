//! Ranges: the distance from the eye at which each level splits.
//!
//! A vertex begins to appear at the distance where the expected screen-space error without it exceeds a tolerance in
//! pixels. That distance is limited above, where vertices of its level would be closer together on screen than is worth
//! drawing, and below, where the coarser level would be too coarse for shading. It depends only on the eye and the
//! vertex: whichever tiles are drawn, the ground has one shape (see [`super::morph`]).

use super::{Quality, View};
use crate::lod::tile::TILE_QUADS;

/// Least range of a level in its vertex spacings: nodes must be small relative to their distance, or shading changes
/// visibly from level to level.
const LEAST_SPACINGS: f64 = 100.0;
/// The same in small pictures, and once the LOD bias reaches `BIAS_LIMITS[1]`: the least range shrinks to fit the
/// triangle budget. Below 50, tiles would lack chords of older vertices (`eye_spacings`).
const FEWEST_SPACINGS: f64 = 70.0;
/// Least range of a level's detail textures. In small pictures their texels are far smaller than pixels at
/// [`FEWEST_SPACINGS`]. It exceeds the diagonal of a tile, 45: a tile that begins within the range ends within twice
/// the range, as far as its texture and its parent's in it reach.
const FEWEST_SHADED: f64 = 48.0;
/// Greatest range relative to the least: tiles know the chords of older vertices only this far (`morph.rs`).
const MOST_OVER_LEAST: f64 = 3.0;
/// LOD bias beyond which the spacing on screen grows, and beyond which [`LEAST_SPACINGS`] shrinks.
const BIAS_LIMITS: [f64; 2] = [4.0, 8.0];
/// A vertex has reached its exact position when the eye is at this share of the distance where it began to appear.
pub const FULL_AT: f64 = 0.6;
/// Shading blends to the next level between this share of the range and its end.
pub const SHADED_AT: f64 = 0.92;

/// The ranges of one view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranges {
    /// Nominal distance between vertices at level 0.
    pub root_spacing_m: f64,
    /// Least range of a level in its vertex spacings.
    pub least_spacings: f64,
    /// Greatest range of a level in its vertex spacings.
    pub most_spacings: f64,
    /// Range of a level's detail textures in its vertex spacings: at most the least range of its vertices.
    pub shaded_spacings: f64,
    /// Metres of distance for each metre of geometric error: at this distance the error meets the tolerance.
    pub reach: f64,
}

impl Ranges {
    /// Ranges of a view of a planet of this radius. `bias` is the LOD bias: 1 or more times the tolerance of the
    /// quality.
    pub fn new(view: &View, radius_m: f64, bias: f64) -> Self {
        // Tolerance of the screen-space error in pixels; most and least pixels between vertices.
        let (error_px, coarsest_px, finest_px) = match view.quality {
            Quality::Low => (2.0, 16.0, 8.0),
            Quality::Medium => (1.0, 12.0, 5.0),
            Quality::High => (0.5, 7.0, 2.5),
        };
        let focal_px = 1.0 / view.pixel_rad();
        // A level takes over where the coarser level, with twice the spacing, has become too coarse.
        let wanted = 2.0 * focal_px / (coarsest_px * (bias / BIAS_LIMITS[0]).max(1.0));
        let floor = (LEAST_SPACINGS * BIAS_LIMITS[1] / bias).min(2.0 * wanted).clamp(FEWEST_SPACINGS, LEAST_SPACINGS);
        let least_spacings = wanted.max(floor);
        let shaded_spacings = wanted.max(FEWEST_SHADED).min(least_spacings);
        let most_spacings = (2.0 * focal_px / finest_px).clamp(least_spacings, MOST_OVER_LEAST * least_spacings);
        let root_spacing_m = spacing_rad(0) * radius_m;
        Self { root_spacing_m, least_spacings, most_spacings, shaded_spacings, reach: focal_px / (error_px * bias) }
    }

    /// Distance, in spacings of the finest level, that the eye may move from where the LOD cut was made. Beyond it, a
    /// vertex older than its tile knows may not have reached its exact position at the far end of the tile.
    pub fn eye_spacings(&self) -> f64 {
        // The distance at which vertices three levels older are exact, less the greatest range of a level and the
        // diagonal of the node split for it.
        let known = 8.0 * FULL_AT * self.least_spacings;
        let farthest = MOST_OVER_LEAST * self.least_spacings + 2.0 * TILE_QUADS as f64 * std::f64::consts::SQRT_2;
        (known - farthest).clamp(0.0, self.least_spacings)
    }

    /// Nominal distance between vertices of a level.
    pub fn spacing_m(&self, level: u8) -> f64 {
        self.root_spacing_m / f64::from(1_u32 << level)
    }

    /// Distance inside which all ground has the vertices of this level.
    pub fn always_m(&self, level: u8) -> f64 {
        self.spacing_m(level) * self.least_spacings
    }

    /// Distance inside which all ground has the detail textures of this level, or finer ones.
    pub fn shaded_m(&self, level: u8) -> f64 {
        self.spacing_m(level) * self.shaded_spacings
    }

    /// Distance at which a vertex born at a level begins to appear, given the expected error without it.
    pub fn begin_m(&self, level: u8, foreseen_m: f64) -> f64 {
        let spacing_m = self.spacing_m(level);
        (foreseen_m * self.reach).clamp(spacing_m * self.least_spacings, spacing_m * self.most_spacings)
    }
}

/// Nominal angle between neighbouring vertices of a level.
pub fn spacing_rad(level: u8) -> f64 {
    std::f64::consts::FRAC_PI_2 / (TILE_QUADS as f64 * f64::from(1_u32 << level))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::Camera;
    use crate::sphere::LatLon;

    #[test]
    fn detail_textures_of_small_pictures_reach_less_far_and_vertices_keep_their_chords() {
        let camera = Camera::over(LatLon::from_degrees(0.0, 0.0), 7e6, 0.0, 0.0, Camera::DEFAULT_FOV_Y_RAD);
        for quality in [Quality::Low, Quality::Medium, Quality::High] {
            let ranges = |size_px| Ranges::new(&View { camera, size_px, quality }, 6e6, 1.0);
            let (large, small) = (ranges([1280, 800]), ranges([160, 90]));
            assert_eq!(large.shaded_spacings, large.least_spacings);
            assert_eq!((small.shaded_spacings, small.least_spacings), (FEWEST_SHADED, FEWEST_SPACINGS));
            for ranges in [large, small] {
                assert!(ranges.shaded_spacings <= ranges.least_spacings && ranges.eye_spacings() > 0.0);
                assert!(ranges.shaded_m(5) <= ranges.always_m(5));
            }
        }
    }
}
