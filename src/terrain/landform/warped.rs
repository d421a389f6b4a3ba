//! Fractal noise at displaced points: swirls and folds.

use super::fbm::{LEAST_POINTS, add_octaves};
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
        self.warp.displace(chunk, noise, displaced);
        let there = Chunk { skewed: displaced.points(chunk.len()), ..*chunk };
        add_octaves(&self.octaves, &there, LEAST_POINTS * self.warp.squeeze(), noise, sums);
        displaced.pull_back(chunk, sums);
    }
}

#[cfg(test)]
mod tests {
    use super::super::Landform;
    use super::*;
    use crate::terrain::field::Field;
    use crate::terrain::noise::precise;
    use crate::terrain::points::Points;
    use crate::terrain::simd::Simd;
    use glam::DVec3;

    /// Heights of the default kind with 4 km of amplitude on the Earth, along `count` points so far apart, and what f64 throughout
    /// gives.
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
        };
        let Scratch { noise, displaced, .. } = &mut Scratch::default();
        warped.warp.displace(&chunk, noise, displaced);
        let mut precise = [[0.0; noise::CHUNK]];
        for Weighted { octave, weight } in &warped.octaves {
            precise::add(chunk.simd, displaced.points(count), octave, f64::from(*weight), &mut precise);
        }
        let field = Field::new(&Landform::Warped(warped), Simd::detect(), &points, &[]);
        field.value.iter().zip(precise[0]).map(|(v, exact)| (v * 4000.0, exact * 4000.0)).collect()
    }

    #[test]
    fn within_a_millimetre_of_f64_and_smooth_underfoot() {
        for i in 0..60 {
            let start = DVec3::new(0.1 * f64::from(i) - 3.0, 0.7, 1.0 - 0.03 * f64::from(i));
            for (height_m, exact_m) in walk(start, 0.1, 256) {
                assert!((height_m - exact_m).abs() < 1e-3, "{height_m} {exact_m}");
            }
            let steps = walk(start, 0.01, 256);
            for three in steps.windows(3) {
                let bend_m = three[0].0 - 2.0 * three[1].0 + three[2].0;
                assert!(bend_m.abs() < 1e-3, "{bend_m}");
            }
        }
    }
}
