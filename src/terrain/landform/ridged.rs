//! Ridged multifractal (Musgrave, in Ebert et al. 2003): noise folded at zero into crests, `(1 - |n|)^2`, each octave
//! strong where the one before was.

use super::octaves::{Weighted, series};
use super::varying::{Around, Point};
use super::{Arithmetic, Chunk, Evaluate, Scratch, Scratch64};
use crate::planet;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::Noise;
use crate::terrain::simd::for_each_simd;
use glam::DVec3;

/// Points per lattice cell at which an octave shows in full: crests are half as long as waves.
const LEAST_POINTS: f64 = 2.2;

/// Greatest total weight of the octaves that are evaluated in f32.
const REST: f64 = 0.07;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ridged {
    octaves: Vec<Weighted>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
    feedback: f32,
}

impl Ridged {
    pub(super) fn new(params: &planet::Ridged, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Ridged { wavelength_km, octaves, gain, lacunarity, feedback } = *params;
        let octaves = series(seed, radius_km / wavelength_km, octaves, gain, lacunarity);
        Self { f64_octaves: arithmetic.f64_octaves(&octaves, REST), octaves, feedback: feedback as f32 }
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
        let point = Point::new(Around { dir_planet, angle_rad });
        let feedback = f64::from(self.feedback);
        let (mut sum, mut feed) = ((0.0, 0.0), (1.0, 1.0));
        for Weighted { octave, weight } in &self.octaves {
            let (low, high) = point.noise(octave).range();
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
        let Scratch { sums, noise, jets: [crest, feed, ..], in_f64, .. } = scratch;
        let Scratch64 { noise: noise64, jets: [crest64, feed64, ..], .. } = in_f64;
        let n = chunk.len();
        feed.fill(n, 1.0);
        feed64.fill(n, 1.0);
        let exact = chunk.f64_octaves(self.f64_octaves);
        let mut share = 0.0;
        for (k, Weighted { octave, weight }) in self.octaves.iter().enumerate() {
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            if chunk.skips(&fades) {
                sums.stand_for_all(n, share);
                break;
            }
            share += f64::from(*weight);
            if k < exact {
                noise64.values(chunk.simd, chunk.skewed, octave);
                fold::<f64>(chunk.simd, n, noise64, self.feedback, feed64, crest64);
                sums.add_f64(chunk, &crest64.value, f64::from(*weight));
                if !fades.is_unseen() {
                    noise.gradients(chunk.simd, chunk.skewed, octave);
                    fold::<Jet>(chunk.simd, n, noise, self.feedback, feed, crest);
                    sums.add_gradients(chunk, &crest.gradient, *weight, &fades);
                }
                feed.round_from(n, feed64);
                continue;
            }
            // An octave too fine for every band needs no gradient, nor do the finer ones that follow.
            if fades.is_unseen() {
                noise.values(chunk.simd, chunk.skewed, octave);
                fold::<f32>(chunk.simd, n, noise, self.feedback, feed, crest);
            } else {
                noise.gradients(chunk.simd, chunk.skewed, octave);
                fold::<Jet>(chunk.simd, n, noise, self.feedback, feed, crest);
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
for_each_simd!(fn fold<R: Real>(n: usize, noise: &Noise<R::S>, feedback: f32, feed: &mut Jets<R::S>, crest: &mut Jets<R::S>) = fold_body);
