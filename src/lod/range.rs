//! How far from the eye each level shows.
//!
//! A vertex appears where the error of the ground without it is foreseen to pass a tolerance in pixels, but nowhere beyond the
//! distance at which the level's vertices stand closer than is worth drawing, and everywhere inside the distance at which the level
//! before would be too coarse for what is shaded. It is a function of the eye and of the vertex alone: whichever tiles are drawn,
//! the ground has one shape (see [`super::morph`]).

use super::{Quality, View};
use crate::lod::tile::TILE_QUADS;

/// A level shows at least as far out as so many of its vertex spacings, however small the picture: nodes must be small against
/// their distance for what is shaded to change from level to level without a step.
const LEAST_SPACINGS: f64 = 100.0;
/// Where that is too much for the budget of triangles, it is so many.
const FEWEST_SPACINGS: f64 = 70.0;
/// And at most so many times as far out as it must: what a tile knows of older vertices suffices only so far (`morph.rs`).
const MOST_OVER_LEAST: f64 = 3.0;
/// Errors may be so many times as large as the quality asks before all levels show less far, and so many times before they show
/// less far than is good for what is shaded.
const LENIENT: [f64; 2] = [4.0, 8.0];
/// A vertex has come out in full when the eye is at this share of the distance where it began.
pub const FULL_AT: f64 = 0.6;
/// Shading changes from a level to the next between this share of the level's range and its end.
pub const SHADED_AT: f64 = 0.92;

/// The distances of one view.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ranges {
    /// Metres from vertex to vertex at level 0 (nominal).
    pub root_spacing_m: f64,
    /// Spacings of a level out to which it always shows.
    pub least_spacings: f64,
    /// Spacings of a level beyond which it never shows.
    pub most_spacings: f64,
    /// Metres of distance for each metre by which the ground would be wrong.
    pub reach: f64,
}

impl Ranges {
    /// For a view of a planet of this radius; errors may be `leniency` (1 or more) times as large as the quality asks.
    pub fn new(view: &View, radius_m: f64, leniency: f64) -> Self {
        // Pixels that the ground may be wrong by; most and least pixels between vertices.
        let (error_px, coarsest_px, finest_px) = match view.quality {
            Quality::Low => (2.0, 16.0, 8.0),
            Quality::Medium => (1.0, 12.0, 5.0),
            Quality::High => (0.5, 7.0, 2.5),
        };
        let focal_px = 1.0 / view.pixel_rad();
        // A level takes over where the one before has become too coarse: at twice its own spacing.
        let floor = (LEAST_SPACINGS * LENIENT[1] / leniency).clamp(FEWEST_SPACINGS, LEAST_SPACINGS);
        let least_spacings = (2.0 * focal_px / (coarsest_px * (leniency / LENIENT[0]).max(1.0))).max(floor);
        let most_spacings = (2.0 * focal_px / finest_px).clamp(least_spacings, MOST_OVER_LEAST * least_spacings);
        let root_spacing_m = spacing_rad(0) * radius_m;
        Self { root_spacing_m, least_spacings, most_spacings, reach: focal_px / (error_px * leniency) }
    }

    /// How far an eye may be from the one that tiles were chosen for, in spacings of the finest: a vertex that is older than its tile knows
    /// must have come out in full even at the tile's far end.
    pub fn eye_spacings(&self) -> f64 {
        // Where a level three before has come out, less the farthest that a level shows and the diagonal of the node split for it.
        let known = 8.0 * FULL_AT * self.least_spacings;
        let farthest = MOST_OVER_LEAST * self.least_spacings + 2.0 * TILE_QUADS as f64 * std::f64::consts::SQRT_2;
        (known - farthest).clamp(0.0, self.least_spacings)
    }

    /// Metres from vertex to vertex of a level (nominal).
    pub fn spacing_m(&self, level: u8) -> f64 {
        self.root_spacing_m / f64::from(1_u32 << level)
    }

    /// Distance inside which all ground is shown at this level or finer.
    pub fn always_m(&self, level: u8) -> f64 {
        self.spacing_m(level) * self.least_spacings
    }

    /// Distance at which a vertex born at a level begins to appear, where the ground without it is foreseen to be wrong by so much.
    pub fn begin_m(&self, level: u8, foreseen_m: f64) -> f64 {
        let spacing_m = self.spacing_m(level);
        (foreseen_m * self.reach).clamp(spacing_m * self.least_spacings, spacing_m * self.most_spacings)
    }
}

/// Angle between neighbouring vertices of a level (nominal).
pub fn spacing_rad(level: u8) -> f64 {
    std::f64::consts::FRAC_PI_2 / (TILE_QUADS as f64 * f64::from(1_u32 << level))
}
