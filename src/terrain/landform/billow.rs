//! Billow noise: each octave folded at zero into creases and rounded above them, `1 - (1 - |n|)^2`: what `ridged` is
//! upside down, without its feedback. The creases are a little rounded too, as by sediment; sharp ones
//! would be drawn as saw teeth.

use super::octaves::{Weighted, series};
use super::{Chunk, Evaluate, Scratch};
use crate::planet;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::noise::{CHUNK, Noise};
use crate::terrain::simd::for_each_simd;

/// Points for each lattice cell from which on an octave shows in full: hills are half as long as waves.
const LEAST_POINTS: f64 = 2.2;

/// Noise below which a crease is round.
const CREASE: f32 = 0.05;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Billow {
    octaves: Vec<Weighted>,
}

impl Billow {
    pub(super) fn new(params: &planet::Billow, seed: u64, radius_km: f64) -> Self {
        let planet::Billow { wavelength_km, octaves, gain, lacunarity } = *params;
        Self { octaves: series(seed, radius_km / wavelength_km, octaves, gain, lacunarity) }
    }
}

impl Evaluate for Billow {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        // The weights sum to 1 but for their rounding.
        (-1.0 - 1e-5, 1.0 + 1e-5)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, jets: [hill, ..], .. } = scratch;
        let n = chunk.len();
        let mut share = 0.0;
        for Weighted { octave, weight } in &self.octaves {
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            if chunk.skips(&fades) {
                sums.stand_for_all(n, share);
                break;
            }
            share += f64::from(*weight);
            if fades.is_unseen() {
                noise.values(chunk.simd, chunk.skewed, octave);
                round_values(chunk.simd, n, noise, hill);
            } else {
                noise.gradients(chunk.simd, chunk.skewed, octave);
                round_gradients(chunk.simd, n, noise, hill);
            }
            sums.add(chunk, &hill.value, &hill.gradient, *weight, &fades);
        }
        // Octaves sum to 0..1.
        sums.map(n, |v| (v * 2.0 - 1.0, 2.0));
    }
}

#[inline(always)]
fn round_body<R: Real>(n: usize, noise: &Noise, hill: &mut Jets) {
    for i in 0..n.min(CHUNK) {
        let fold = R::noise(noise, i).square().plus(CREASE * CREASE).sqrt().plus(-CREASE);
        let off_top = (R::constant(1.0) - fold).at_least(0.0);
        (R::constant(1.0) - off_top.square()).store(hill, i);
    }
}
for_each_simd!(fn round_values(n: usize, noise: &Noise, hill: &mut Jets) = round_body::<f32>);
for_each_simd!(fn round_gradients(n: usize, noise: &Noise, hill: &mut Jets) = round_body::<Jet>);
