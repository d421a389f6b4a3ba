//! Distance to the coast, all over a planet.
//!
//! Heights at the cells tell land from sea. Between two neighbours that differ, the coast lies where the straight line
//! between their heights meets the sea level. From there the nearest coast point spreads from cell to cell (vector
//! distance propagation, Danielsson 1980). The signed distance is a [`Raster`] of angles in radians: below zero in the
//! sea, zero on the coast.

use super::Slot;
use super::carved::Carved;
use super::cells::Cells;
use super::map::{Inputs, Job, WorldMap};
use crate::planet::Key;
use crate::sphere::raster::{NearPoints, Raster};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::VecDeque;

/// The distance in radians that stands for a planet without any coast; greater than every distance on a sphere.
const NOWHERE_RAD: f32 = 1e9;

/// Signed distances to the coast.
pub(crate) struct Coast {
    distance_rad: Raster<f32>,
}

impl WorldMap for Coast {
    const NAME: &'static str = "coast";
    /// One level: a cell is about 200 km wide on the Earth, and the map is solved in a few milliseconds.
    const SIDES: &'static [usize] = &[48];

    fn key(inputs: &Inputs) -> Option<Key> {
        let sea_level_m = inputs.sea_level_m.filter(|_| inputs.reads_coast)?;
        Some(Key::of(&(inputs.heights, sea_level_m, Slot::<Carved>::final_key(inputs))))
    }

    fn solve(job: &Job<'_>, side: usize, _coarser: Option<&Self>) -> Option<Self> {
        let (cells, sea_level_m) = (Cells::of(side), job.inputs().sea_level_m?);
        let heights_m = job.ground.heights_m(&cells, job.keep_going)?;
        Some(Self::new(&cells, sea_level_m, &heights_m))
    }
}

impl Coast {
    /// Finds the coast of a sea of this level, given the height at each cell.
    fn new(cells: &Cells, sea_level_m: f64, heights_m: &[f64]) -> Self {
        let Cells { side, dirs, .. } = cells;
        let above_m: Vec<f64> = heights_m.iter().map(|height_m| height_m - sea_level_m).collect();
        let is_sea = |cell: usize| above_m[cell] < 0.0;
        // The nearest coast point known to each cell, and the square of the straight line to it.
        let mut nearest = vec![(f64::MAX, DVec3::ZERO); dirs.len()];
        let mut waiting = VecDeque::new();
        for cell in 0..dirs.len() {
            for other in cells.around(cell).map(|other| other as usize) {
                if is_sea(cell) != is_sea(other) {
                    let share = above_m[cell] / (above_m[cell] - above_m[other]);
                    let point = (dirs[cell] + (dirs[other] - dirs[cell]) * share).normalize();
                    let distance2 = dirs[cell].distance_squared(point);
                    if distance2 < nearest[cell].0 {
                        nearest[cell] = (distance2, point);
                    }
                }
            }
            if nearest[cell].0 < f64::MAX {
                waiting.push_back(cell);
            }
        }
        let mut is_waiting: Vec<bool> = nearest.iter().map(|(distance2, _)| *distance2 < f64::MAX).collect();
        while let Some(cell) = waiting.pop_front() {
            is_waiting[cell] = false;
            let (_, point) = nearest[cell];
            for other in cells.around(cell).map(|other| other as usize) {
                let distance2 = dirs[other].distance_squared(point);
                if distance2 < nearest[other].0 {
                    nearest[other] = (distance2, point);
                    if !std::mem::replace(&mut is_waiting[other], true) {
                        waiting.push_back(other);
                    }
                }
            }
        }
        let distance_rad = (0..dirs.len()).into_par_iter().map(|cell| {
            let chord = nearest[cell].0.sqrt();
            let distance_rad =
                if chord <= 2.0 { (2.0 * libm::asin((0.5 * chord).min(1.0))) as f32 } else { NOWHERE_RAD };
            if is_sea(cell) { -distance_rad } else { distance_rad }
        });
        Self { distance_rad: Raster::cube(*side, distance_rad.collect()) }
    }

    /// Finds the distances from the sea at points near each other, as angles: one number for each.
    pub(crate) fn find_inland_rad(&self, points: &NearPoints, inland_rad: &mut Vec<f64>) {
        self.distance_rad.values(points, inland_rad);
        inland_rad.iter_mut().for_each(|inland_rad| *inland_rad = inland_rad.max(0.0));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn inland_rad(coast: &Coast, dir: DVec3) -> f64 {
        let (mut points, mut inland_rad) = (NearPoints::default(), Vec::new());
        points.refill(std::iter::once(dir));
        coast.find_inland_rad(&points, &mut inland_rad);
        inland_rad[0]
    }

    #[test]
    fn distances_to_a_round_coast_are_right() {
        // Land within 40° of a point; the height falls evenly with the angle.
        let (middle, radius_rad) = (DVec3::new(0.6, -0.5, 0.62).normalize(), 0.7);
        let height_m = |d: &DVec3| 100.0 + (radius_rad - d.angle_between(middle)) * 1e4;
        let cells = Cells::of(48);
        let coast = Coast::new(&cells, 100.0, &cells.dirs.iter().map(height_m).collect::<Vec<_>>());
        for dir in cells.dirs.iter().step_by(7) {
            let right = (radius_rad - dir.angle_between(middle)).max(0.0);
            // Within a cell of the middle, which is equally far from the whole coast, the raster is rounded off.
            let tolerance = if dir.angle_between(middle) < 0.08 { 0.02 } else { 0.006 };
            let found = inland_rad(&coast, *dir);
            assert!((found - right).abs() < tolerance, "{dir}: {found} {right}");
        }
    }

    #[test]
    fn without_a_coast_all_is_near_or_all_is_far() {
        let all = |height_m: f64| inland_rad(&Coast::new(&Cells::of(8), 0.0, &[height_m; 6 * 8 * 8]), DVec3::X);
        assert_eq!(all(-5.0), 0.0);
        assert!(all(5.0) > 1e8);
    }
}
