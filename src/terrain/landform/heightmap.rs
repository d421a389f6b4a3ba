//! Heights from a picture (see [`crate::sphere::raster`]). Values come from its finest level; gradients from the
//! level whose texel spacing matches the point spacing of the band.

use super::{Arithmetic, Chunk, Evaluate, Scratch};
use crate::planet;
use crate::planet::picture::Picture;
use glam::DVec3;
use std::sync::Arc;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct HeightMap {
    picture: Option<Arc<Picture>>,
    low: f64,
    high: f64,
}

impl HeightMap {
    pub(super) fn new(params: &planet::HeightMap, _seed: u64, _radius_km: f64, _arithmetic: Arithmetic) -> Self {
        let planet::HeightMap { file, layout, low, high } = params;
        Self { picture: file.picture(*layout).cloned(), low: *low, high: *high }
    }
}

impl HeightMap {
    /// Heights for two values of the picture, in order.
    fn of(&self, (lo, hi): (f64, f64)) -> (f64, f64) {
        let (a, b) = (self.low + (self.high - self.low) * lo, self.low + (self.high - self.low) * hi);
        // The weights of a spline sum to 1 up to rounding.
        let rounding = 1e-9 * (1.0 + a.abs().max(b.abs()));
        (a.min(b) - rounding, a.max(b) + rounding)
    }
}

impl Evaluate for HeightMap {
    fn octave_count(&self) -> usize {
        0
    }

    fn bounds(&self) -> (f64, f64) {
        self.picture.as_ref().map_or((0.0, 0.0), |picture| self.of(picture.bounds()))
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        self.picture.as_ref().map_or((0.0, 0.0), |picture| self.of(picture.bounds_near(dir_planet, angle_rad)))
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Some(picture) = &self.picture else { return };
        let span = self.high - self.low;
        for (i, &dir) in chunk.dirs.iter().enumerate() {
            let place = picture.place(dir);
            let finest = picture.sample(&place, 0);
            scratch.sums.value[i] += self.low + span * finest.0;
            // Bands often share a level.
            let mut sampled: (usize, DVec3) = (0, finest.1);
            for (gradient, &spacing_rad) in scratch.sums.gradients_mut().iter_mut().zip(chunk.spacings_rad) {
                let level = picture.level_for(spacing_rad);
                if level != sampled.0 {
                    sampled = (level, picture.sample(&place, level).1);
                }
                for (lane, slope) in gradient.iter_mut().zip((sampled.1 * span).to_array()) {
                    lane[i] += slope as f32;
                }
            }
        }
    }
}
