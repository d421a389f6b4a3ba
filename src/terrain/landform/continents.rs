//! Continents and oceans: warped fractal noise mapped by a hypsometric curve, which gives each part of the globe its
//! share of the surface: abyssal plain, continental rise and slope, shelf, coastal plain, interior.
//!
//! A globe holds few continents, so the shares of the noise itself differ much from seed to seed. The curve is
//! therefore fitted to quantiles of this very noise, measured at compilation at points spread evenly over the sphere.

use super::curve::Curve;
use super::fbm::{LEAST_POINTS, add_octaves};
use super::octaves::{Weighted, series};
use super::varying::{Around, Point};
use super::warp::Warp;
use super::{Arithmetic, Chunk, Evaluate, Scratch};
use crate::planet;
use crate::simd::Simd;
use crate::terrain::lane::CHUNK;
use crate::terrain::points::Points;
use glam::DVec3;

/// Points at which the noise is measured. Presets in use depend on it.
const SURVEY: usize = 2048;

/// The coarsest wavelength of the warp in wavelengths of the continents, and its octaves.
const WARP_WAVELENGTH: f64 = 0.5;
const WARP_OCTAVES: u32 = 4;

/// How many octaves, the coarsest, are warped. In finer ones the warp would show as grain in one direction.
const WARPED_OCTAVES: usize = 4;

/// Greatest total weight of the octaves that are evaluated in f32. The profile is several times steeper than the
/// noise.
const REST: f64 = 0.03;

/// Height of the edge of the shelf.
const SHELF_EDGE: f64 = -0.05;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Continents {
    warp: Warp,
    octaves: Vec<Weighted>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
    curve: Curve,
}

impl Continents {
    pub(super) fn new(params: &planet::Continents, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Continents { wavelength_km, octaves, gain, lacunarity, warp, land, shelf } = *params;
        let frequency = radius_km / wavelength_km;
        let octaves = series(seed, frequency, octaves, gain, lacunarity);
        let mut continents = Self {
            warp: Warp::new(seed, frequency / WARP_WAVELENGTH, WARP_OCTAVES, warp / frequency),
            f64_octaves: arithmetic.f64_octaves(&octaves, REST),
            octaves,
            curve: Curve::new(&[]),
        };
        continents.curve = Curve::new(&hypsometry(&continents.survey(), land, shelf));
        continents
    }

    /// The noise before the curve at points spread evenly over the sphere, sorted.
    fn survey(&self) -> Vec<f64> {
        let points = Points::new(spread(SURVEY));
        let mut scratch = Box::<Scratch>::default();
        let mut values = Vec::with_capacity(SURVEY);
        for start in (0..SURVEY).step_by(CHUNK) {
            let range = start..(start + CHUNK).min(SURVEY);
            let n = range.len();
            let chunk = Chunk {
                // Every set has the same bits.
                simd: Simd::detect(),
                skewed: [&points.x[range.clone()], &points.y[range.clone()], &points.z[range.clone()]],
                dirs: &points.dirs[range],
                point_spacing_rad: 0.0,
                spacings_rad: &[],
                seen_only: false,
                squeeze: 1.0,
            };
            scratch.sums.restart(&chunk);
            self.add_noise(&chunk, &mut scratch);
            values.extend_from_slice(&scratch.sums.value[..n]);
        }
        values.sort_by(f64::total_cmp);
        values
    }

    fn add_noise(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, displaced, .. } = scratch;
        let (coarse, fine) = self.octaves.split_at(WARPED_OCTAVES.min(self.octaves.len()));
        self.warp.add_octaves(coarse, self.f64_octaves, chunk, noise, displaced, sums);
        add_octaves(fine, self.f64_octaves.saturating_sub(coarse.len()), chunk, LEAST_POINTS, noise, sums);
    }
}

/// Directions spread evenly over the sphere: a Fibonacci lattice.
fn spread(count: usize) -> Vec<DVec3> {
    // The golden angle.
    const TURN_RAD: f64 = 2.399_963_229_728_653;
    (0..count)
        .map(|i| {
            let z = 1.0 - (2 * i + 1) as f64 / count as f64;
            let (sin, cos) = libm::sincos(i as f64 * TURN_RAD);
            let radius = (1.0 - z * z).sqrt();
            DVec3::new(radius * cos, radius * sin, z)
        })
        .collect()
}

/// Knots of the curve: noise and height. `land` is a share of the surface, `shelf` a share of the sea floor.
fn hypsometry(sorted: &[f64], land: f64, shelf: f64) -> Vec<(f64, f64)> {
    let sea = 1.0 - land;
    // Continental slope and rise.
    let slope = 0.2 * (1.0 - shelf);
    let knots = [
        (0.0, -1.0),
        (sea * 0.45 * (1.0 - shelf), -0.97),
        (sea * (1.0 - shelf - slope), -0.86),
        (sea * (1.0 - shelf - 0.3 * slope), -0.3),
        (sea * (1.0 - shelf), SHELF_EDGE),
        (sea, 0.0),
        (sea + land * 0.25, 0.06),
        (sea + land * 0.6, 0.2),
        (sea + land * 0.9, 0.5),
        (1.0, 1.0),
    ];
    // Quantiles may coincide where the octaves are too coarse to tell points apart; knots must not.
    let mut last = f64::MIN;
    knots
        .iter()
        .map(|&(share, height)| {
            last = quantile(sorted, share).max(last + 1e-6);
            (last, height)
        })
        .collect()
}

/// The value below which this share of the sorted values lies.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = (share * sorted.len() as f64 - 0.5).clamp(0.0, (sorted.len() - 1) as f64);
    let below = place as usize;
    let above = (below + 1).min(sorted.len() - 1);
    sorted[below] + (sorted[above] - sorted[below]) * (place - below as f64)
}

impl Evaluate for Continents {
    fn octave_count(&self) -> usize {
        self.warp.octave_count() + self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-1.0, 1.0)
    }

    fn bounds_around(&self, around: Around) -> (f64, f64) {
        let (coarse, fine) = self.octaves.split_at(WARPED_OCTAVES.min(self.octaves.len()));
        let (low, high) = (self.warp.near(around).0.sum(coarse) + Point::new(around).sum(fine)).range();
        // The curve rises everywhere.
        (self.curve.at(low).0 - 1e-9, self.curve.at(high).0 + 1e-9)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        self.add_noise(chunk, scratch);
        scratch.sums.map(chunk.len(), |noise| self.curve.at(noise));
    }
}

#[cfg(test)]
mod tests {
    use super::super::Landform;
    use super::*;
    use crate::terrain::field::Field;

    #[test]
    fn as_much_land_and_shelf_as_asked_for() {
        let points = Points::new(spread(10_000));
        for (seed, land, shelf, wavelength_km) in
            [(1, 0.3, 0.1, 6000.0), (2, 0.05, 0.3, 9000.0), (3, 0.6, 0.05, 3000.0), (4, 0.8, 0.4, 800.0)]
        {
            let params = planet::Continents { land, shelf, wavelength_km, ..Default::default() };
            let landform = Landform::Continents(Continents::new(&params, seed, 6371.0, Arithmetic::Fine));
            let heights = Field::new(&landform, Simd::detect(), &points, &[]).value;
            let share = |from: f64, to: f64| {
                heights.iter().filter(|h| (from..to).contains(*h)).count() as f64 / heights.len() as f64
            };
            let (is_land, is_shelf) = (share(0.0, 2.0), share(SHELF_EDGE, 0.0) / (1.0 - land));

            assert!((is_land - land).abs() < 0.03, "{is_land} of {land}");
            assert!((is_shelf - shelf).abs() < 0.04, "{is_shelf} of {shelf}");
        }
    }
}
