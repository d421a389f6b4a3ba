//! How far it is to the sea, all over a planet.
//!
//! Heights on a cube of cells tell land from sea; between two neighbours that differ, the shore lies where a
//! straight line between their heights meets the sea. From there the nearest point of the shore spreads from cell
//! to cell (vector distance propagation, Danielsson 1980), and the signed distance is a [`Raster`]: below zero in
//! the sea, zero on the shore.

use super::points::Points;
use crate::sphere::raster::{Raster, cube_direction, cube_point};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::VecDeque;
use std::fmt;
use std::sync::OnceLock;

/// Cells along the side of a face: one is about 200 km wide on the Earth.
const SIDE: usize = 48;
/// The angle that a cell in the middle of a face spans.
pub(crate) const CELL_RAD: f64 = 2.0 / SIDE as f64;
const CELLS: usize = 6 * SIDE * SIDE;

/// The distance, as an angle, that stands for a planet without any sea; more than any there can be.
const NOWHERE_RAD: f32 = 1e9;

/// Signed distances from the shore.
pub(crate) struct Coast {
    distance_rad: Raster<f32>,
}

impl fmt::Debug for Coast {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Coast")
    }
}

impl Coast {
    /// Where the ground's height must be known, in batches.
    pub(crate) fn points() -> &'static [Points] {
        &Cells::get().batches
    }

    /// Finds the shore of a sea of this level, given the heights at [`Coast::points`].
    pub(crate) fn new(sea_level_m: f64, heights_m: &[f64]) -> Self {
        let Cells { dirs, neighbours, .. } = Cells::get();
        let above_m: Vec<f64> = heights_m.iter().map(|height_m| height_m - sea_level_m).collect();
        let is_sea = |cell: usize| above_m[cell] < 0.0;
        // The nearest point of the shore known to each cell, and the square of the straight line there.
        let mut shore = vec![(f64::MAX, DVec3::ZERO); CELLS];
        let mut waiting = VecDeque::new();
        for (cell, around) in neighbours.iter().enumerate() {
            for other in around.iter().map(|&other| usize::from(other)) {
                if is_sea(cell) != is_sea(other) {
                    let share = above_m[cell] / (above_m[cell] - above_m[other]);
                    let point = (dirs[cell] + (dirs[other] - dirs[cell]) * share).normalize();
                    let distance2 = dirs[cell].distance_squared(point);
                    if distance2 < shore[cell].0 {
                        shore[cell] = (distance2, point);
                    }
                }
            }
            if shore[cell].0 < f64::MAX {
                waiting.push_back(cell);
            }
        }
        let mut is_waiting: Vec<bool> = shore.iter().map(|(distance2, _)| *distance2 < f64::MAX).collect();
        while let Some(cell) = waiting.pop_front() {
            is_waiting[cell] = false;
            let (_, point) = shore[cell];
            for other in neighbours[cell].iter().map(|&other| usize::from(other)) {
                let distance2 = dirs[other].distance_squared(point);
                if distance2 < shore[other].0 {
                    shore[other] = (distance2, point);
                    if !std::mem::replace(&mut is_waiting[other], true) {
                        waiting.push_back(other);
                    }
                }
            }
        }
        let distance_rad = (0..CELLS).into_par_iter().map(|cell| {
            let chord = shore[cell].0.sqrt();
            let distance_rad =
                if chord <= 2.0 { (2.0 * libm::asin((0.5 * chord).min(1.0))) as f32 } else { NOWHERE_RAD };
            if is_sea(cell) { -distance_rad } else { distance_rad }
        });
        Self { distance_rad: Raster::cube(SIDE, distance_rad.collect()) }
    }

    /// Distance to the sea as an angle; 0 in the sea.
    pub(crate) fn inland_rad(&self, dir_planet: DVec3) -> f64 {
        self.distance_rad.value(&self.distance_rad.place(dir_planet), 0).max(0.0)
    }
}

/// The cells of the cube: the same for every planet.
struct Cells {
    dirs: Vec<DVec3>,
    /// The same, few enough in each for the fields of all layers to stay in the second-level cache.
    batches: Vec<Points>,
    neighbours: Vec<[u16; 8]>,
}

impl Cells {
    fn get() -> &'static Cells {
        static CELLS_OF_ALL: OnceLock<Cells> = OnceLock::new();
        CELLS_OF_ALL.get_or_init(|| {
            let place = |cell: usize| (cell / (SIDE * SIDE), cell % SIDE, cell / SIDE % SIDE);
            let dir = |face, x: f64, y: f64| cube_direction(face, SIDE, x + 0.5, y + 0.5);
            let around = |cell: usize| {
                let (face, column, row) = place(cell);
                let steps = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
                steps.map(|(dx, dy)| {
                    let (x, y) = (column as f64 + f64::from(dx), row as f64 + f64::from(dy));
                    let (face, x, y) = cube_point(dir(face, x, y), SIDE);
                    let index = |w: f64| (w as usize).min(SIDE - 1);
                    ((face * SIDE + index(y)) * SIDE + index(x)) as u16
                })
            };
            let dirs = (0..CELLS).map(|cell| {
                let (face, column, row) = place(cell);
                dir(face, column as f64, row as f64)
            });
            let dirs: Vec<DVec3> = dirs.collect();
            let batches = dirs.chunks(CELLS / 18).map(|dirs| Points::new(dirs.to_vec())).collect();
            Cells { dirs, batches, neighbours: (0..CELLS).map(around).collect() }
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn distances_to_a_round_shore_are_right() {
        // Land within 40° of a place; the height falls evenly with the angle.
        let (middle, radius_rad) = (DVec3::new(0.6, -0.5, 0.62).normalize(), 0.7);
        let height_m = |d: &DVec3| 100.0 + (radius_rad - d.angle_between(middle)) * 1e4;
        let coast = Coast::new(100.0, &Cells::get().dirs.iter().map(height_m).collect::<Vec<_>>());
        for dir in Cells::get().dirs.iter().step_by(7) {
            let right = (radius_rad - dir.angle_between(middle)).max(0.0);
            // Rounded off within a cell of the middle, to which all shores are equally near.
            let tolerance = if dir.angle_between(middle) < 0.08 { 0.02 } else { 0.006 };
            assert!((coast.inland_rad(*dir) - right).abs() < tolerance, "{dir}: {} {right}", coast.inland_rad(*dir));
        }
    }

    #[test]
    fn without_a_shore_it_is_all_near_or_all_far() {
        let all = |height_m: f64| Coast::new(0.0, &[height_m; CELLS]).inland_rad(DVec3::X);
        assert_eq!(all(-5.0), 0.0);
        assert!(all(5.0) > 1e8);
    }
}
