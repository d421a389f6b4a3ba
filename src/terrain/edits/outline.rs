//! Noise for ragged outlines and rough ground: gradient noise in f64, a few octaves.

use crate::terrain::noise::{self, Octave};
use crate::world::noise::mix;
use glam::DVec3;

/// Octaves of a noise.
const OCTAVES: usize = 6;
/// Strength of each octave relative to the one before.
const GAIN: f64 = 0.5;
/// Points for each cell of an octave from which a gradient shows it; at half as many it shows none.
const LEAST_POINTS: f64 = 4.0;
/// Bound of the value.
pub(super) const MOST: f64 = noise::BOUND * (1.0 + 1e-9);

/// A noise over the sphere.
#[derive(Clone, Debug)]
pub(super) struct Noise {
    octaves: [Octave; OCTAVES],
}

/// The noise at a point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Sampled {
    pub(super) value: f64,
    /// Size of the cells as an angle and gradient by the direction, for each octave.
    octaves: [(f64, DVec3); OCTAVES],
}

impl Noise {
    /// The largest features have this size.
    pub(super) fn new(seed: u32, wavelength_rad: f64) -> Self {
        let octaves = std::array::from_fn(|i| {
            let random = |k: u64| mix(mix(u64::from(seed)).wrapping_add(i as u64 * 4 + k));
            let offset = |k: u64| (random(k) >> 40) as f64 / 4096.0;
            // Finer cells than these would be below what f64 can tell apart.
            let frequency = ((1_u64 << i) as f64 / wavelength_rad).min(1e13);
            Octave { frequency, offset: [offset(1), offset(2), offset(3)], seed: random(0) as u32 }
        });
        Self { octaves }
    }

    /// Value, about -1 to 1, and gradient at a direction.
    pub(super) fn at(&self, dir: DVec3) -> Sampled {
        let total = (1.0 - GAIN.powi(OCTAVES as i32)) / (1.0 - GAIN);
        let skewed = noise::skew(dir.to_array());
        let (mut sampled, mut weight) = (Sampled::default(), 1.0 / total);
        for (octave, out) in self.octaves.iter().zip(&mut sampled.octaves) {
            let place = |axis: usize| noise::split::<f64>(skewed[axis] * octave.frequency + octave.offset[axis]);
            let [(ix, x), (iy, y), (iz, z)] = [place(0), place(1), place(2)];
            let (value, gradient) = noise::value_gradient([ix, iy, iz], [x, y, z], octave.seed);
            sampled.value += weight * value;
            *out = (1.0 / octave.frequency, DVec3::from_array(gradient) * (weight * octave.frequency));
            weight *= GAIN;
        }
        sampled
    }
}

impl Sampled {
    /// The gradient by the direction that points so far apart can show.
    pub(super) fn gradient(&self, spacing_rad: f64) -> DVec3 {
        self.octaves.iter().map(|(cell_rad, gradient)| *gradient * seen(*cell_rad, spacing_rad, LEAST_POINTS)).sum()
    }
}

/// The share of a feature of this size that points so far apart show: all of it from `least` points on, none of it from
/// half as many.
pub(super) fn seen(feature_rad: f64, spacing_rad: f64, least: f64) -> f64 {
    (feature_rad / (spacing_rad.max(1e-30) * least) * 2.0 - 1.0).clamp(0.0, 1.0)
}
