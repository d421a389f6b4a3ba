//! Fractal Brownian motion: octaves of noise summed.

use super::octaves::{Weighted, series};
use super::varying::{Around, Point};
use super::{Arithmetic, Chunk, Evaluate, Scratch, Sums};
use crate::planet;
use crate::terrain::noise::{self, Noise};

/// Points per lattice cell at which an octave shows in full: a wave is about two cells long.
pub(super) const LEAST_POINTS: f64 = 1.5;

/// Greatest total weight of the octaves that are evaluated in f32.
pub(super) const REST: f64 = 0.26;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fbm {
    octaves: Vec<Weighted>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
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
        Self { f64_octaves: arithmetic.f64_octaves(&octaves, REST), octaves }
    }
}

impl Evaluate for Fbm {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-noise::BOUND, noise::BOUND)
    }

    fn bounds_around(&self, around: Around) -> (f64, f64) {
        Point::new(around).sum(&self.octaves).range()
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, .. } = scratch;
        add_octaves(&self.octaves, self.f64_octaves, chunk, LEAST_POINTS, noise, sums);
    }
}

/// Adds octaves, the first `f64_octaves` of them in f64. Each shows in full from `least_points` points per lattice
/// cell.
pub(super) fn add_octaves(
    octaves: &[Weighted],
    f64_octaves: usize,
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
        if k < chunk.f64_octaves(f64_octaves) {
            noise.add_f64(chunk.simd, chunk.skewed, octave, f64::from(*weight), &mut sums.value);
            if !fades.is_unseen() {
                noise.gradients_of_f64(chunk.simd, chunk.len(), octave);
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
