//! Noise alone, for `tellus bench`: 8 octaves at any points on the unit sphere, on the calling thread.

use super::field::{ALL_OCTAVES, Field};
use super::landform::Landform;
use super::points::Points;
use crate::simd::Simd;
use glam::DVec3;

/// Points and a noise to evaluate at them.
#[derive(Debug)]
pub struct NoiseBench {
    points: Points,
    landform: Landform,
}

impl NoiseBench {
    /// 8 octaves, the coarsest with 8 cells to the radius of the sphere.
    pub fn new(dirs: Vec<DVec3>) -> Self {
        Self { points: Points::new(dirs), landform: Landform::fbm(1, 8.0, 8) }
    }

    /// Evaluates values. Returns their sum, so that nothing is optimised away.
    pub fn values(&self, simd: Simd) -> f64 {
        Field::new(&self.landform, simd, &self.points, &[]).value.iter().sum()
    }

    /// Evaluates values and gradients. Returns the sum of the values, as [`NoiseBench::values`].
    pub fn gradients(&self, simd: Simd) -> f64 {
        Field::new(&self.landform, simd, &self.points, ALL_OCTAVES).value.iter().sum()
    }
}
