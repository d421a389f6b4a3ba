//! Ridged multifractal (Musgrave, in Ebert et al. 2003): noise folded at zero into crests, `(1 - |n|)^2`, each octave strong
//! where the one before was.

use super::octaves::{Weighted, coarser_than, series};
use super::{Chunk, Evaluate, Landform, Scratch};
use crate::planet;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::noise::{CHUNK, Noise};
use crate::terrain::simd::for_each_simd;

/// Points for each lattice cell from which on an octave shows in full: crests are half as long as waves.
const LEAST_POINTS: f64 = 2.2;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ridged {
    octaves: Vec<Weighted>,
    feedback: f32,
}

impl Ridged {
    pub(super) fn new(params: &planet::Ridged, seed: u64, radius_km: f64) -> Self {
        let planet::Ridged { wavelength_km, octaves, gain, lacunarity, feedback } = *params;
        Self {
            octaves: series(seed, radius_km / wavelength_km, octaves, gain, lacunarity),
            feedback: feedback as f32,
        }
    }
}

impl Evaluate for Ridged {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-1.0, 1.0)
    }

    fn coarse(&self, feature_rad: f64) -> Option<Landform> {
        let mut octaves = coarser_than(&self.octaves, feature_rad);
        // Crests are never below zero: without the finer ones the rest stands for them, or the ground would sink.
        let total: f32 = octaves.iter().map(|w| w.weight).sum();
        octaves.iter_mut().for_each(|w| w.weight /= total);
        Some(Landform::Ridged(Self { octaves, feedback: self.feedback }))
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, jets: [crest, feed, ..] } = scratch;
        let n = chunk.len();
        feed.fill(n, 1.0);
        for Weighted { octave, weight } in &self.octaves {
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
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
fn fold_body<R: Real>(n: usize, noise: &Noise, feedback: f32, feed: &mut Jets, crest: &mut Jets) {
    for i in 0..n.min(CHUNK) {
        let fold = (R::constant(1.0) - R::noise(noise, i).abs()).at_least(0.0);
        let height = fold.square() * R::load(feed, i);
        height.store(crest, i);
        height.scale(feedback).at_most(1.0).store(feed, i);
    }
}
for_each_simd!(fn fold_values(n: usize, noise: &Noise, feedback: f32, feed: &mut Jets, crest: &mut Jets) = fold_body::<f32>);
for_each_simd!(fn fold_gradients(n: usize, noise: &Noise, feedback: f32, feed: &mut Jets, crest: &mut Jets) = fold_body::<Jet>);
