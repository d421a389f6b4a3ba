//! Ridged multifractal (Musgrave, in Ebert et al. 2003): noise folded at zero into crests, `(1 - |n|)^2`, each octave
//! strong where the one before was.

use super::folded::{Fold, Folded};
use super::octaves::{Weighted, series};
use super::varying::{Around, Point};
use super::{Arithmetic, Chunk, Evaluate, Scratch};
use crate::planet;
use crate::simd::{Simd, for_each_simd};
use crate::terrain::jet::{Jets, Real};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::Noise;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Ridged {
    folded: Folded,
    feedback: f32,
}

impl Ridged {
    pub(super) fn new(params: &planet::Ridged, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Ridged { wavelength_km, octaves, gain, lacunarity, feedback } = *params;
        let octaves = series(seed, radius_km / wavelength_km, octaves, gain, lacunarity);
        Self { folded: Folded::new(octaves, arithmetic), feedback: feedback as f32 }
    }
}

impl Evaluate for Ridged {
    fn octave_count(&self) -> usize {
        self.folded.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-1.0, 1.0)
    }

    fn bounds_around(&self, around: Around) -> (f64, f64) {
        let point = Point::new(around);
        let feedback = f64::from(self.feedback);
        let (mut sum, mut feed) = ((0.0, 0.0), (1.0, 1.0));
        for Weighted { octave, weight } in &self.folded.octaves {
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
        self.folded.add_to(self, chunk, scratch);
    }
}

impl Fold for Ridged {
    fn fold<R: Real>(&self, simd: Simd, n: usize, noise: &Noise<R::S>, feed: &mut Jets<R::S>, height: &mut Jets<R::S>) {
        fold::<R>(simd, n, noise, self.feedback, feed, height);
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
