//! Curvature: whether a point lies on a ridge or in a hollow (the topographic position of Weiss 2001, as a share of its
//! span).

use super::Terrain;
use super::evaluate::BatchScratch;
use super::lane::CHUNK;
use super::query::{Sample, Scratch};
use crate::sphere::geo;
use glam::DVec3;

/// Distance of the four points whose mean height the height of a point is compared with, metres.
pub const CURVATURE_M: f64 = 50.0;

impl Terrain {
    /// Fills in the curvature at the points evaluated last, whose heights are known. Other points are evaluated then.
    pub(super) fn find_curvature(&self, spacing_rad: f64, samples: &mut [Sample], scratch: &mut Scratch) {
        let mut dirs = [DVec3::ZERO; CHUNK];
        let count = samples.len();
        for (dir, at) in dirs.iter_mut().zip(&scratch.0.points.dirs) {
            *dir = *at;
        }
        let share = CURVATURE_M / self.planet().radius_m();
        let mut around = [DVec3::ZERO; CHUNK];
        for [to_east, to_north] in [[share, 0.0], [-share, 0.0], [0.0, share], [0.0, -share]] {
            for (around, dir) in around.iter_mut().zip(&dirs[..count]) {
                let (east, north) = geo::east_north(*dir);
                *around = (*dir + east * to_east + north * to_north).normalize();
            }
            self.evaluate_at(&around[..count], spacing_rad, &[], scratch);
            let BatchScratch { heights, .. } = &*scratch.0;
            for (sample, height_m) in samples.iter_mut().zip(&heights.height_m) {
                sample.curvature += (sample.height_m - height_m) / (4.0 * CURVATURE_M);
            }
        }
    }
}
