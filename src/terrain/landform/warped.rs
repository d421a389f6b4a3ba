//! Fractal noise at displaced points: swirls and folds.

use super::octaves::{Weighted, series};
use super::warp::Warp;
use super::{Chunk, Evaluate, Scratch};
use crate::planet;
use crate::terrain::noise;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Warped {
    warp: Warp,
    octaves: Vec<Weighted>,
}

impl Warped {
    pub(super) fn new(params: &planet::Warped, seed: u64, radius_km: f64) -> Self {
        let planet::Warped { wavelength_km, octaves, gain, lacunarity, warp_km, warp_wavelength_km, warp_octaves } =
            *params;
        Self {
            warp: Warp::new(seed, radius_km / warp_wavelength_km, warp_octaves, warp_km / radius_km),
            octaves: series(seed, radius_km / wavelength_km, octaves, gain, lacunarity),
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

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, displaced, .. } = scratch;
        self.warp.add_octaves(&self.octaves, chunk, noise, displaced, sums);
    }
}

#[cfg(test)]
mod tests {
    use super::super::Landform;
    use super::*;
    use crate::terrain::field::Field;
    use crate::terrain::points::Points;
    use crate::terrain::simd::Simd;
    use glam::DVec3;

    /// Heights of the default kind with 4 km of amplitude on the Earth, along `count` points so far apart, and
    /// what f64 throughout gives.
    fn walk(start: DVec3, step_m: f64, count: usize) -> Vec<(f64, f64)> {
        let warped = Warped::new(&planet::Warped { warp_km: 500.0, ..Default::default() }, 11, 6371.0);
        let start = start.normalize();
        let along = start.any_orthonormal_vector() * (step_m / 6_371_000.0);
        let points = Points::new((0..count).map(|i| (start + along * i as f64).normalize()).collect());
        let chunk = Chunk {
            simd: Simd::detect(),
            skewed: [&points.x, &points.y, &points.z],
            dirs: &points.dirs,
            spacings_rad: &[],
            seen_only: false,
        };
        // Every octave at displaced points, as the first of a series is.
        let mut exact = [0.0; noise::CHUNK];
        for octave in &warped.octaves {
            let mut scratch = Box::<Scratch>::default();
            let Scratch { sums, noise, displaced, .. } = &mut *scratch;
            sums.restart(&chunk);
            warped.warp.add_octaves(std::slice::from_ref(octave), &chunk, noise, displaced, sums);
            for (exact, v) in exact.iter_mut().zip(&sums.value) {
                *exact += v;
            }
        }
        let field = Field::new(&Landform::Warped(warped), Simd::detect(), &points, &[]);
        field.value.iter().zip(exact).map(|(v, exact)| (v * 4000.0, exact * 4000.0)).collect()
    }

    #[test]
    fn within_a_millimetre_of_f64_and_smooth_underfoot() {
        let mut worst_m = 0.0_f64;
        for i in 0..60 {
            let start = DVec3::new(0.1 * f64::from(i) - 3.0, 0.7, 1.0 - 0.03 * f64::from(i));
            for (height_m, exact_m) in walk(start, 0.1, 256) {
                assert!((height_m - exact_m).abs() < 5e-4, "{height_m} {exact_m}");
            }
            let steps = walk(start, 0.01, 256);
            for three in steps.windows(3) {
                let bend_m = three[0].0 - 2.0 * three[1].0 + three[2].0;
                worst_m = worst_m.max(bend_m.abs());
            }
        }
        assert!(worst_m < 7e-4, "{worst_m}");
    }
}
