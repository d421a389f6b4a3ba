//! Fractal Brownian motion: octaves of noise summed.

use super::octaves::{Weighted, series};
use super::{Chunk, Evaluate, Scratch, Sums};
use crate::planet;
use crate::terrain::noise::{self, Noise};
use glam::DVec3;

/// Points for each lattice cell from which on an octave shows in full: a wave is about two cells long.
pub(super) const LEAST_POINTS: f64 = 1.5;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Fbm {
    octaves: Vec<Weighted>,
}

impl Fbm {
    pub(super) fn new(params: &planet::Fbm, seed: u64, radius_km: f64) -> Self {
        let planet::Fbm { wavelength_km, octaves, gain, lacunarity } = *params;
        Self { octaves: series(seed, radius_km / wavelength_km, octaves, gain, lacunarity) }
    }

    pub(super) fn plain(seed: u64, frequency: f64, octaves: u32) -> Self {
        Self { octaves: series(seed, frequency, octaves, 0.5, 2.0) }
    }
}

impl Evaluate for Fbm {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-noise::BOUND, noise::BOUND)
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let skewed = noise::skew(dir_planet.to_array());
        self.octaves.iter().fold((0.0, 0.0), |(lo, hi), Weighted { octave, weight }| {
            let (low, high) = noise::range_near(skewed, octave, angle_rad);
            (lo + low * f64::from(*weight), hi + high * f64::from(*weight))
        })
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, .. } = scratch;
        add_octaves(&self.octaves, chunk, LEAST_POINTS, noise, sums);
    }
}

/// Adds octaves, each shown in full from `least_points` points for each lattice cell on.
pub(super) fn add_octaves(
    octaves: &[Weighted],
    chunk: &Chunk<'_>,
    least_points: f64,
    noise: &mut Noise,
    sums: &mut Sums,
) {
    for Weighted { octave, weight } in octaves {
        let fades = chunk.fades(1.0 / octave.frequency, least_points);
        if chunk.skips(&fades) {
            break;
        }
        if fades.is_unseen() {
            noise.values(chunk.simd, chunk.skewed, octave);
        } else {
            noise.gradients(chunk.simd, chunk.skewed, octave);
        }
        sums.add(chunk, &noise.value, &noise.gradient, *weight, &fades);
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::terrain::field::Field;
    use crate::terrain::landform::Landform;
    use crate::terrain::noise::{CHUNK, precise};
    use crate::terrain::points::Points;
    use crate::terrain::simd::Simd;

    /// Walks of 0.1 m steps on the Earth, against the same octaves in f64 throughout: the f32 of an octave costs about a third of
    /// a millimetre for each kilometre of amplitude.
    #[test]
    fn within_fractions_of_a_millimetre_of_f64() {
        let fbm = Fbm::new(&planet::Fbm::default(), 11, 6371.0);
        let mut worst = 0.0_f64;
        for k in 0..200_u32 {
            let turn = f64::from(k) * 2.4;
            let start = DVec3::new(turn.cos(), turn.sin(), f64::from(k) * 0.02 - 2.0).normalize();
            let along = start.any_orthonormal_vector() * (0.1 / 6_371_000.0);
            let points = Points::new((0..CHUNK).map(|i| (start + along * i as f64).normalize()).collect());
            let mut exact = [0.0; CHUNK];
            for Weighted { octave, weight } in &fbm.octaves {
                precise::add(Simd::detect(), [&points.x, &points.y, &points.z], octave, f64::from(*weight), &mut exact);
            }
            let values = Field::new(&Landform::Fbm(fbm.clone()), Simd::detect(), &points, &[]).value;
            for (v, exact) in values.iter().zip(&exact) {
                worst = worst.max((v - exact).abs());
            }
        }
        assert!(worst < 0.4e-6, "{} mm for each kilometre", worst * 1e6);
    }
}
