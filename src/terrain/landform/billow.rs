//! Billow noise: octaves folded at zero into creases and rounded above, `1 - (1 - |n|)^2`; `ridged` upside down,
//! without its feedback. Creases are rounded a little, as by sediment: sharp ones would be drawn as saw teeth.

use super::folded::{Fold, Folded};
use super::octaves::{Weighted, series};
use super::varying::{Around, Point};
use super::{Arithmetic, Chunk, Evaluate, Scratch};
use crate::planet;
use crate::simd::{Simd, for_each_simd};
use crate::terrain::jet::{Jets, Real};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::Noise;

/// Noise value below which a crease is round.
const CREASE: f32 = 0.05;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Billow {
    folded: Folded,
}

impl Billow {
    pub(super) fn new(params: &planet::Billow, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Billow { wavelength_km, octaves, gain, lacunarity } = *params;
        let octaves = series(seed, radius_km / wavelength_km, octaves, gain, lacunarity);
        Self { folded: Folded::new(octaves, arithmetic) }
    }
}

impl Evaluate for Billow {
    fn octave_count(&self) -> usize {
        self.folded.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        // The weights sum to 1 up to rounding.
        (-1.0 - 1e-5, 1.0 + 1e-5)
    }

    fn bounds_around(&self, around: Around) -> (f64, f64) {
        let point = Point::new(around);
        let crease = f64::from(CREASE);
        let hill = |noise: f64| {
            let fold = (noise * noise + crease * crease).sqrt() - crease;
            1.0 - (1.0 - fold).max(0.0).powi(2)
        };
        let sum = self.folded.octaves.iter().fold((0.0, 0.0), |(lo, hi), Weighted { octave, weight }| {
            let (low, high) = point.noise(octave).range();
            let (nearest, farthest) = (low.max(-high).max(0.0), high.max(-low));
            (lo + hill(nearest) * f64::from(*weight), hi + hill(farthest) * f64::from(*weight))
        });
        (2.0 * sum.0 - 1.0 - 1e-5, 2.0 * sum.1 - 1.0 + 1e-5)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        self.folded.add_to(self, chunk, scratch);
    }
}

impl Fold for Billow {
    fn fold<R: Real>(
        &self,
        simd: Simd,
        n: usize,
        noise: &Noise<R::S>,
        _feed: &mut Jets<R::S>,
        height: &mut Jets<R::S>,
    ) {
        round::<R>(simd, n, noise, height);
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
