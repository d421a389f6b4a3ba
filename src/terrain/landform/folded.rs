//! Octaves that are folded at zero before they are summed: what `ridged` and `billow` share.

use super::octaves::Weighted;
use super::{Arithmetic, Chunk, Scratch, Scratch64};
use crate::simd::Simd;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::noise::Noise;

/// Points per lattice cell at which an octave shows in full: folded waves are half as long.
const LEAST_POINTS: f64 = 2.2;

/// Greatest total weight of the octaves that are evaluated in f32.
const REST: f64 = 0.07;

/// How one octave is folded.
pub(super) trait Fold {
    /// Folds the noise of an octave into a height, 0 to 1, at the first `n` points. `feed` is handed from one octave to
    /// the next and is 1 before the first.
    fn fold<R: Real>(&self, simd: Simd, n: usize, noise: &Noise<R::S>, feed: &mut Jets<R::S>, height: &mut Jets<R::S>);
}

/// Octaves to fold.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Folded {
    pub(super) octaves: Vec<Weighted>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
}

impl Folded {
    pub(super) fn new(octaves: Vec<Weighted>, arithmetic: Arithmetic) -> Self {
        Self { f64_octaves: arithmetic.f64_octaves(&octaves, REST), octaves }
    }

    /// Adds the folded octaves, mapped to -1 to 1.
    pub(super) fn add_to(&self, fold: &impl Fold, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, jets: [height, feed, ..], in_f64, .. } = scratch;
        let Scratch64 { noise: noise64, jets: [height64, feed64, ..], .. } = in_f64;
        let (simd, n) = (chunk.simd, chunk.len());
        feed.fill(n, 1.0);
        feed64.fill(n, 1.0);
        let f64_octaves = chunk.f64_octaves(self.f64_octaves);
        let mut share = 0.0;
        for (k, Weighted { octave, weight }) in self.octaves.iter().enumerate() {
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            if chunk.skips(&fades) {
                sums.stand_for_all(n, share);
                break;
            }
            share += f64::from(*weight);
            if k < f64_octaves {
                noise64.values(simd, chunk.skewed, octave);
                fold.fold::<f64>(simd, n, noise64, feed64, height64);
                sums.add_f64(chunk, &height64.value, f64::from(*weight));
                if !fades.is_unseen() {
                    noise.gradients(simd, chunk.skewed, octave);
                    fold.fold::<Jet>(simd, n, noise, feed, height);
                    sums.add_gradients(chunk, &height.gradient, *weight, &fades);
                }
                feed.round_from(n, feed64);
                continue;
            }
            // An octave too fine for every band needs no gradient, nor do the finer ones that follow.
            if fades.is_unseen() {
                noise.values(simd, chunk.skewed, octave);
                fold.fold::<f32>(simd, n, noise, feed, height);
            } else {
                noise.gradients(simd, chunk.skewed, octave);
                fold.fold::<Jet>(simd, n, noise, feed, height);
            }
            sums.add(chunk, &height.value, &height.gradient, *weight, &fades);
        }
        // Octaves sum to 0..1.
        sums.map(n, |v| (v * 2.0 - 1.0, 2.0));
    }
}
