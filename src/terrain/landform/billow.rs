//! Billow noise: octaves folded at zero into creases and rounded above, `1 - (1 - |n|)^2`; `ridged` upside down,
//! without its feedback. Creases are rounded a little, as by sediment: sharp ones would be drawn as saw teeth.

use super::octaves::{Weighted, series};
use super::varying::{Around, Point};
use super::{Arithmetic, Chunk, Evaluate, Scratch, Scratch64};
use crate::planet;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::Noise;
use crate::terrain::simd::for_each_simd;
use glam::DVec3;

/// Points per lattice cell at which an octave shows in full: hills are half as long as waves.
const LEAST_POINTS: f64 = 2.2;

/// Greatest total weight of the octaves that are evaluated in f32.
const REST: f64 = 0.07;

/// Noise value below which a crease is round.
const CREASE: f32 = 0.05;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Billow {
    octaves: Vec<Weighted>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
}

impl Billow {
    pub(super) fn new(params: &planet::Billow, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Billow { wavelength_km, octaves, gain, lacunarity } = *params;
        let octaves = series(seed, radius_km / wavelength_km, octaves, gain, lacunarity);
        Self { f64_octaves: arithmetic.f64_octaves(&octaves, REST), octaves }
    }
}

impl Evaluate for Billow {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        // The weights sum to 1 up to rounding.
        (-1.0 - 1e-5, 1.0 + 1e-5)
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let point = Point::new(Around { dir_planet, angle_rad });
        let crease = f64::from(CREASE);
        let hill = |noise: f64| {
            let fold = (noise * noise + crease * crease).sqrt() - crease;
            1.0 - (1.0 - fold).max(0.0).powi(2)
        };
        let sum = self.octaves.iter().fold((0.0, 0.0), |(lo, hi), Weighted { octave, weight }| {
            let (low, high) = point.noise(octave).range();
            let (nearest, farthest) = (low.max(-high).max(0.0), high.max(-low));
            (lo + hill(nearest) * f64::from(*weight), hi + hill(farthest) * f64::from(*weight))
        });
        (2.0 * sum.0 - 1.0 - 1e-5, 2.0 * sum.1 - 1.0 + 1e-5)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, jets: [hill, ..], in_f64, .. } = scratch;
        let Scratch64 { noise: noise64, jets: [hill64, ..], .. } = in_f64;
        let n = chunk.len();
        let mut share = 0.0;
        for (k, Weighted { octave, weight }) in self.octaves.iter().enumerate() {
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            if chunk.skips(&fades) {
                sums.stand_for_all(n, share);
                break;
            }
            share += f64::from(*weight);
            if k < chunk.f64_octaves(self.f64_octaves) {
                noise64.values(chunk.simd, chunk.skewed, octave);
                round::<f64>(chunk.simd, n, noise64, hill64);
                sums.add_f64(chunk, &hill64.value, f64::from(*weight));
                if !fades.is_unseen() {
                    noise.gradients(chunk.simd, chunk.skewed, octave);
                    round::<Jet>(chunk.simd, n, noise, hill);
                    sums.add_gradients(chunk, &hill.gradient, *weight, &fades);
                }
                continue;
            }
            if fades.is_unseen() {
                noise.values(chunk.simd, chunk.skewed, octave);
                round::<f32>(chunk.simd, n, noise, hill);
            } else {
                noise.gradients(chunk.simd, chunk.skewed, octave);
                round::<Jet>(chunk.simd, n, noise, hill);
            }
            sums.add(chunk, &hill.value, &hill.gradient, *weight, &fades);
        }
        // Octaves sum to 0..1.
        sums.map(n, |v| (v * 2.0 - 1.0, 2.0));
    }
}

#[inline(always)]
fn round_body<R: Real>(n: usize, noise: &Noise<R::S>, hill: &mut Jets<R::S>) {
    for i in 0..n.min(CHUNK) {
        let fold = R::noise(noise, i).square().plus(CREASE * CREASE).sqrt().plus(-CREASE);
        let off_top = (R::constant(1.0) - fold).at_least(0.0);
        (R::constant(1.0) - off_top.square()).store(hill, i);
    }
}
for_each_simd!(fn round<R: Real>(n: usize, noise: &Noise<R::S>, hill: &mut Jets<R::S>) = round_body);
