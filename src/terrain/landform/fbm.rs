//! Fractal Brownian motion: octaves of noise summed.

use super::octaves::{Weighted, coarser_than, series};
use super::{Chunk, Evaluate, Landform, Scratch};
use crate::planet;
use crate::terrain::noise;

/// Points for each lattice cell from which on an octave shows in full: a wave is about two cells long.
pub(super) const LEAST_POINTS: f64 = 1.5;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fbm {
    octaves: Vec<Weighted>,
}

impl Fbm {
    pub(super) fn new(params: &planet::Fbm, seed: u64, radius_km: f64) -> Self {
        let planet::Fbm { wavelength_km, octaves, gain, lacunarity } = *params;
        Self { octaves: series(seed, radius_km / wavelength_km, octaves, gain, lacunarity) }
    }

    pub(super) fn plain(seed: u64, frequency: f64, octaves: u32) -> Self {
        Self { octaves: series(seed, frequency, octaves, 0.5, 2.0) }
    }
}

impl Evaluate for Fbm {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-noise::BOUND, noise::BOUND)
    }

    fn coarse(&self, feature_rad: f64) -> Option<Landform> {
        Some(Landform::Fbm(Self { octaves: coarser_than(&self.octaves, feature_rad) }))
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, .. } = scratch;
        for Weighted { octave, weight } in &self.octaves {
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            if fades.is_unseen() {
                noise.values(chunk.simd, chunk.skewed, octave);
            } else {
                noise.gradients(chunk.simd, chunk.skewed, octave);
            }
            sums.add(chunk, &noise.value, &noise.gradient, *weight, &fades);
        }
    }
}
