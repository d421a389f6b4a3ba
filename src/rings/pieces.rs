//! The pieces of rings near the eye: how large they are, how many, and in which cells of space they lie.
//!
//! Pieces have sizes by a power law: their number for each range of sizes falls with the cube of the size, as in the
//! rings of Saturn (Zebker, Marouf and Tyler, Icarus 64, 1985: exponents from 2.7 to 3.3). So each factor of size has
//! an equal share of the optical depth. Sizes are dealt with in classes. Each class has a grid of cells with at most
//! one piece in each, placed by a hash of the cell: `shaders/ring_pieces.wgsl` walks through them.
//!
//! The mean transmittance of the pieces is that of the layer: what a class cannot hold with one piece for each cell
//! stays fine debris, as dust is.

use crate::planet::Planet;

/// Classes of sizes.
pub const SIZE_CLASSES: usize = 6;
/// The largest piece of a class over the smallest.
pub const SIZE_RATIO: f64 = 2.3;
/// The greatest share of cells with a piece.
pub const MOST_CHANCE: f64 = 0.9;
/// Facets are at this share of the radius from the centre of a piece, at least and at most: in pairs, one on each side.
pub const FACETS_AT: [f64; 2] = [0.4, 0.9];
/// Mean cross section of a piece with four pairs of facets over that of the ball around it.
pub const BLOCK_SHARE: f64 = 0.729;
/// Share of cells with a piece where rings are as dense as the profile's 1.
const USUAL_CHANCE: f64 = 0.5;
/// Least width and height of a cell, in radii of the largest piece.
const LEAST_WIDTH: f64 = 2.6;
const LEAST_HEIGHT: f64 = 2.2;
/// A class fades out where its largest piece is this many pixels wide.
const LOST_PX: f64 = 1.5;

/// A class of sizes.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SizeClass {
    /// Radius of the ball around the largest piece.
    pub radius_m: f64,
    /// Width of a cell.
    pub cell_m: f64,
    /// Layers of cells across the rings.
    pub layers: u32,
    /// Height of a cell.
    pub layer_m: f64,
    /// Share of cells with a piece for each unit of optical depth.
    pub chance: f64,
    /// The share grows by this times its square, because pieces of one cell never hide each other.
    pub crowding: f64,
}

/// The pieces of the rings of a planet.
#[derive(Clone, Debug, PartialEq)]
pub struct Pieces {
    /// Thickness of the rings.
    pub thickness_m: f64,
    /// Share of the optical depth that all classes have together; the rest is dust.
    pub share: f64,
    /// The largest first.
    pub classes: [SizeClass; SIZE_CLASSES],
}

impl Pieces {
    /// The pieces of a planet; None without rings.
    pub fn new(planet: &Planet) -> Option<Self> {
        let rings = planet.rings.as_ref()?;
        let (thickness_m, share) = (rings.thickness_m, 1.0 - rings.dust);
        let class = |number: usize| {
            let radius_m = 0.5 * rings.largest_m / SIZE_RATIO.powi(number as i32);
            // Mean square of the radii: the cube law from the smallest to the largest.
            let spread = SIZE_RATIO * SIZE_RATIO;
            let square_m2 = radius_m * radius_m * libm::log(spread) / (spread - 1.0);
            let section_m2 = std::f64::consts::PI * square_m2 * BLOCK_SHARE;
            let depth = (rings.optical_depth * share / SIZE_CLASSES as f64).max(1e-3);
            let cube_m3 = USUAL_CHANCE * section_m2 * thickness_m / depth;
            let side_m = libm::cbrt(cube_m3).max(LEAST_WIDTH * radius_m);
            let most_layers = (thickness_m / (LEAST_HEIGHT * radius_m)).floor().max(1.0);
            let layers = (thickness_m / side_m).round().clamp(1.0, most_layers);
            let layer_m = thickness_m / layers;
            let cell_m = (cube_m3 / layer_m).sqrt().max(LEAST_WIDTH * radius_m);
            let filled = section_m2 / (cell_m * cell_m);
            SizeClass {
                radius_m,
                cell_m,
                layers: layers as u32,
                layer_m,
                chance: share / SIZE_CLASSES as f64 / (layers * filled),
                crowding: 0.4 * filled,
            }
        };
        Some(Self { thickness_m, share, classes: std::array::from_fn(class) })
    }

    /// Share of the optical depth that a class holds in pieces where it is `depth` in all.
    pub fn held(&self, class: usize, depth: f64) -> f64 {
        let wanted = self.classes[class].chance * depth;
        self.share / SIZE_CLASSES as f64 * (MOST_CHANCE / wanted.max(1e-12)).min(1.0)
    }

    /// Distance at which a class has faded. `pixel_rad`: angle of a pixel.
    pub fn reach_m(&self, class: usize, pixel_rad: f64) -> f64 {
        2.0 * self.classes[class].radius_m / (LOST_PX * pixel_rad)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Rings, STARTING_RINGS};
    use crate::rings::unit_hash;
    use std::f64::consts::{PI, TAU};

    #[test]
    fn classes_hold_the_optical_depth_of_the_layer() {
        for starting in STARTING_RINGS {
            for (thickness_m, largest_m) in [(1.0, 0.1), (50.0, 8.0), (3.0, 100.0), (10_000.0, 1.0)] {
                let rings = Rings { thickness_m, largest_m, ..starting.make() };
                let planet = Planet { rings: Some(rings.clone()), ..Planet::default() };
                let pieces = Pieces::new(&planet).unwrap();
                let spread = SIZE_RATIO * SIZE_RATIO;
                for (number, class) in pieces.classes.iter().enumerate() {
                    // Pieces for each square metre times their cross section.
                    let chance = (class.chance * 0.7).min(MOST_CHANCE);
                    let square = class.radius_m.powi(2) * spread.ln() / (spread - 1.0);
                    let depth = f64::from(class.layers) * chance / class.cell_m.powi(2) * PI * square * BLOCK_SHARE;
                    assert!((depth / (0.7 * pieces.held(number, 0.7)) - 1.0).abs() < 1e-9, "{}", starting.name);
                    assert!(class.cell_m >= 2.5 * class.radius_m && class.crowding < 0.1);
                    assert!(class.layers == 1 || class.layer_m >= 2.0 * class.radius_m);
                    assert!((class.layer_m * f64::from(class.layers) / thickness_m - 1.0).abs() < 1e-9);
                }
            }
        }
    }

    /// A ray through the ball around a piece meets the piece with this probability.
    #[test]
    fn facets_leave_the_stated_share_of_the_ball() {
        let mut number = 0;
        let mut random = || {
            number += 1;
            unit_hash(number, 7, 11)
        };
        let (rays, mut hits) = (60_000, 0);
        for _ in 0..rays {
            let aside = random().sqrt();
            let half = (1.0 - aside * aside).sqrt();
            let (mut enter, mut leave) = (-half, half);
            for _ in 0..4 {
                let (along, turn) = (2.0 * random() - 1.0, TAU * random());
                let across = (1.0 - along * along).sqrt() * turn.cos() * aside;
                let [near, far] = [(); 2].map(|()| FACETS_AT[0] + (FACETS_AT[1] - FACETS_AT[0]) * random());
                let (a, b) = ((near - across) / along, (-far - across) / along);
                (enter, leave) = (enter.max(a.min(b)), leave.min(a.max(b)));
            }
            hits += u32::from(enter < leave);
        }
        let share = f64::from(hits) / f64::from(rays);
        assert!((share - BLOCK_SHARE).abs() < 0.006, "{share}");
    }
}
