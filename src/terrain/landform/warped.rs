//! Fractal noise at displaced points: swirls and folds.

use super::fbm::REST;
use super::octaves::{Weighted, series};
use super::varying::Around;
use super::warp::Warp;
use super::{Arithmetic, Chunk, Evaluate, Scratch};
use crate::planet;
use crate::terrain::noise;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Warped {
    warp: Warp,
    octaves: Vec<Weighted>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
}

impl Warped {
    pub(super) fn new(params: &planet::Warped, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Warped { wavelength_km, octaves, gain, lacunarity, warp_km, warp_wavelength_km, warp_octaves } =
            *params;
        let octaves = series(seed, radius_km / wavelength_km, octaves, gain, lacunarity);
        Self {
            warp: Warp::new(seed, radius_km / warp_wavelength_km, warp_octaves, warp_km / radius_km),
            f64_octaves: arithmetic.f64_octaves(&octaves, REST),
            octaves,
        }
    }
}

impl Evaluate for Warped {
    fn octave_count(&self) -> usize {
        self.warp.octave_count() + self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-noise::BOUND, noise::BOUND)
    }

    fn bounds_around(&self, around: Around) -> (f64, f64) {
        self.warp.near(around).0.sum(&self.octaves).range()
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, displaced, .. } = scratch;
        self.warp.add_octaves(&self.octaves, self.f64_octaves, chunk, noise, displaced, sums);
    }
}
