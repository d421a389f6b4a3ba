//! Fractal Brownian motion: octaves of noise summed.

use super::octaves::{Weighted, series};
use super::{Arithmetic, Chunk, Evaluate, Scratch, Sums};
use crate::planet;
use crate::terrain::noise::{self, Noise, precise};
use glam::DVec3;

/// Points for each lattice cell from which on an octave shows in full: a wave is about two cells long.
pub(super) const LEAST_POINTS: f64 = 1.5;

/// Weight of the octaves that f32 is enough for.
pub(super) const REST: f64 = 0.26;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fbm {
    octaves: Vec<Weighted>,
    /// So many of them are found in f64.
    exact: usize,
}

impl Fbm {
    pub(super) fn new(params: &planet::Fbm, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Fbm { wavelength_km, octaves, gain, lacunarity } = *params;
        Self::of(series(seed, radius_km / wavelength_km, octaves, gain, lacunarity), arithmetic)
    }

    pub(super) fn plain(seed: u64, frequency: f64, octaves: u32, arithmetic: Arithmetic) -> Self {
        Self::of(series(seed, frequency, octaves, 0.5, 2.0), arithmetic)
    }

    fn of(octaves: Vec<Weighted>, arithmetic: Arithmetic) -> Self {
        Self { exact: arithmetic.exact_of(&octaves, REST), octaves }
    }
}

impl Evaluate for Fbm {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-noise::BOUND, noise::BOUND)
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        range_near(&self.octaves, noise::skew(dir_planet.to_array()), angle_rad)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, .. } = scratch;
        add_octaves(&self.octaves, self.exact, chunk, LEAST_POINTS, noise, sums);
    }
}

/// Lattice cells within which an octave's slope is much the same.
const STRAIGHT: f64 = 0.06;

/// Lowest and highest sum of octaves within a distance of a skewed point. The slopes of octaves much coarser than the
/// distance are summed before their length counts, as they often cancel.
pub(super) fn range_near(octaves: &[Weighted], point_skewed: [f64; 3], distance: f64) -> (f64, f64) {
    let (mut lo, mut hi, mut slope) = (0.0, 0.0, DVec3::ZERO);
    for Weighted { octave, weight } in octaves {
        let (weight, cells) = (f64::from(*weight), distance * octave.frequency);
        if cells < STRAIGHT {
            let (value, gradient, _) = noise::slope_near(point_skewed, octave, distance);
            let bend = 0.5 * noise::CURVATURE_BOUND * cells * cells + 1e-7;
            (lo, hi) = (lo + (value - bend) * weight, hi + (value + bend) * weight);
            slope += gradient * (octave.frequency * weight);
        } else {
            let (low, high) = noise::range_near(point_skewed, octave, distance);
            (lo, hi) = (lo + low * weight, hi + high * weight);
        }
    }
    let reach = slope.length() * distance;
    // For the rounding of weights that are f32.
    (lo - reach - 1e-6, hi + reach + 1e-6)
}

/// Adds octaves, the first `exact` of them in f64, each shown in full from `least_points` points for each lattice cell
/// on.
pub(super) fn add_octaves(
    octaves: &[Weighted],
    exact: usize,
    chunk: &Chunk<'_>,
    least_points: f64,
    noise: &mut Noise,
    sums: &mut Sums,
) {
    for (k, Weighted { octave, weight }) in octaves.iter().enumerate() {
        let fades = chunk.fades(1.0 / octave.frequency, least_points);
        if chunk.skips(&fades) {
            break;
        }
        if k < chunk.exact(exact) {
            precise::add(chunk.simd, chunk.skewed, octave, f64::from(*weight), &mut sums.value);
            if !fades.is_unseen() {
                noise.gradients(chunk.simd, chunk.skewed, octave);
                sums.add_gradients(chunk, &noise.gradient, *weight, &fades);
            }
            continue;
        }
        if fades.is_unseen() {
            noise.values(chunk.simd, chunk.skewed, octave);
        } else {
            noise.gradients(chunk.simd, chunk.skewed, octave);
        }
        sums.add(chunk, &noise.value, &noise.gradient, *weight, &fades);
    }
}
