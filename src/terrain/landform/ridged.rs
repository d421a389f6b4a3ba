//! Ridged multifractal (Musgrave, in Ebert et al. 2003): noise folded at zero into crests, `(1 - |n|)^2`, each octave
//! strong where the one before was.

use super::octaves::{Weighted, series};
use super::{Arithmetic, Chunk, Evaluate, Scratch, Wide};
use crate::planet;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::noise::{self, CHUNK, Noise};
use crate::terrain::simd::for_each_simd;
use glam::DVec3;

/// Points for each lattice cell from which on an octave shows in full: crests are half as long as waves.
const LEAST_POINTS: f64 = 2.2;

/// Weight of the octaves that f32 is enough for.
const REST: f64 = 0.07;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ridged {
    octaves: Vec<Weighted>,
    /// So many of them are found in f64.
    exact: usize,
    feedback: f32,
}

impl Ridged {
    pub(super) fn new(params: &planet::Ridged, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Ridged { wavelength_km, octaves, gain, lacunarity, feedback } = *params;
        let octaves = series(seed, radius_km / wavelength_km, octaves, gain, lacunarity);
        Self { exact: arithmetic.exact_of(&octaves, REST), octaves, feedback: feedback as f32 }
    }
}

impl Evaluate for Ridged {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-1.0, 1.0)
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let skewed = noise::skew(dir_planet.to_array());
        let feedback = f64::from(self.feedback);
        let (mut sum, mut feed) = ((0.0, 0.0), (1.0, 1.0));
        for Weighted { octave, weight } in &self.octaves {
            let (low, high) = noise::range_near(skewed, octave, angle_rad);
            // Folding turns the noise nearest to zero into the highest crest.
            let nearest = low.max(-high).max(0.0);
            let farthest = high.max(-low);
            let crest = |fold: f64, feed: f64| fold.max(0.0).powi(2) * feed;
            let (low, high) = (crest(1.0 - farthest, feed.0), crest(1.0 - nearest, feed.1));
            sum = (sum.0 + low * f64::from(*weight), sum.1 + high * f64::from(*weight));
            feed = ((low * feedback).min(1.0), (high * feedback).min(1.0));
        }
        (2.0 * sum.0 - 1.0, 2.0 * sum.1 - 1.0)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, jets: [crest, feed, ..], wide, .. } = scratch;
        let Wide { noise: exact_noise, jets: [exact_crest, exact_feed, ..] } = wide;
        let n = chunk.len();
        feed.fill(n, 1.0);
        exact_feed.fill(n, 1.0);
        let exact = chunk.exact(self.exact);
        let mut share = 0.0;
        for (k, Weighted { octave, weight }) in self.octaves.iter().enumerate() {
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            if chunk.skips(&fades) {
                sums.stand_for_all(n, share);
                break;
            }
            share += f64::from(*weight);
            if k < exact {
                exact_noise.values(chunk.simd, chunk.skewed, octave);
                fold_exact(chunk.simd, n, exact_noise, self.feedback, exact_feed, exact_crest);
                sums.add_exact(chunk, &exact_crest.value, f64::from(*weight));
                if !fades.is_unseen() {
                    noise.gradients(chunk.simd, chunk.skewed, octave);
                    fold_gradients(chunk.simd, n, noise, self.feedback, feed, crest);
                    sums.add_gradients(chunk, &crest.gradient, *weight, &fades);
                }
                feed.round_from(n, exact_feed);
                continue;
            }
            // An octave too fine for every band needs no gradient, nor do the finer ones that follow it.
            if fades.is_unseen() {
                noise.values(chunk.simd, chunk.skewed, octave);
                fold_values(chunk.simd, n, noise, self.feedback, feed, crest);
            } else {
                noise.gradients(chunk.simd, chunk.skewed, octave);
                fold_gradients(chunk.simd, n, noise, self.feedback, feed, crest);
            }
            sums.add(chunk, &crest.value, &crest.gradient, *weight, &fades);
        }
        // Octaves sum to 0..1.
        sums.map(n, |v| (v * 2.0 - 1.0, 2.0));
    }
}

#[inline(always)]
fn fold_body<R: Real>(n: usize, noise: &Noise<R::S>, feedback: f32, feed: &mut Jets<R::S>, crest: &mut Jets<R::S>) {
    for i in 0..n.min(CHUNK) {
        let fold = (R::constant(1.0) - R::noise(noise, i).abs()).at_least(0.0);
        let height = fold.square() * R::load(feed, i);
        height.store(crest, i);
        height.scale(feedback).at_most(1.0).store(feed, i);
    }
}
for_each_simd!(fn fold_values(n: usize, noise: &Noise, feedback: f32, feed: &mut Jets, crest: &mut Jets) = fold_body::<f32>);
for_each_simd!(fn fold_exact(n: usize, noise: &Noise<f64>, feedback: f32, feed: &mut Jets<f64>, crest: &mut Jets<f64>) = fold_body::<f64>);
for_each_simd!(fn fold_gradients(n: usize, noise: &Noise, feedback: f32, feed: &mut Jets, crest: &mut Jets) = fold_body::<Jet>);
