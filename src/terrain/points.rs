//! Points as the noise loops want them: coordinates apart, skewed once.

use super::noise;
use glam::DVec3;

/// Directions of a batch, skewed onto the simplex grid, and the latitude's sine for the climate.
#[derive(Debug, Default)]
pub(crate) struct Points {
    /// Skewed coordinates.
    pub(crate) x: Vec<f64>,
    pub(crate) y: Vec<f64>,
    pub(crate) z: Vec<f64>,
    /// The unit directions themselves.
    pub(crate) dirs: Vec<DVec3>,
}

impl Points {
    pub(crate) fn new(dirs: Vec<DVec3>) -> Self {
        let skewed = |axis: usize| dirs.iter().map(|d| noise::skew(d.to_array())[axis]).collect();
        Self { x: skewed(0), y: skewed(1), z: skewed(2), dirs }
    }

    pub(crate) fn len(&self) -> usize {
        self.dirs.len()
    }
}
