//! How well a place suits a population: the density there as a share of the greatest.

use crate::planet::{Planet, Population};
use crate::simd::{Simd, for_each_simd};
use crate::terrain::edits::Planting;
use crate::terrain::{Sample, noise};
use glam::DVec3;

/// Degrees over which a population thins out beyond the ends of its temperatures.
pub(crate) const SOFT_C: f64 = 2.0;
/// Degrees over which it thins out beyond the ends of its slopes.
pub(crate) const SOFT_DEG: f64 = 3.0;
/// Moisture over which it thins out beyond the ends of its range.
pub(crate) const SOFT_MOISTURE: f64 = 0.04;
/// Metres over which it thins out beyond the ends of its heights.
pub(crate) const SOFT_M: f64 = 15.0;

/// What a population asks of a place.
#[derive(Clone, Debug)]
pub(super) struct Suitability {
    pub(super) population: Population,
    /// For each biome of the palette, whether the population stands there.
    biomes: Vec<bool>,
    sea_m: Option<f64>,
}

impl Suitability {
    pub(super) fn new(planet: &Planet, population: &Population) -> Self {
        let biomes = planet.biomes.palette.iter().map(|biome| population.stands_in(biome.key)).collect();
        Self { population: population.clone(), biomes, sea_m: planet.sea_level_m() }
    }

    /// Share of the density of the population that the ground at a sample bears, 0 to 1.
    pub(super) fn at(&self, sample: &Sample) -> f64 {
        if self.is_dry(sample) { self.on_ground(sample) * self.by_bank(sample) } else { 0.0 }
    }

    /// The part of it that the distance from water leaves.
    pub(super) fn by_bank(&self, sample: &Sample) -> f64 {
        self.population.by_bank(sample.bank_m.unwrap_or(f64::INFINITY))
    }

    /// The share as far as it is found between places whose samples are known. A population that asks for banks looks
    /// for water at each of its own places: a sample that lies in the river must not thin it out.
    pub(super) fn in_soil(&self, sample: &Sample) -> f64 {
        if self.population.asks_bank() || self.is_dry(sample) { self.on_ground(sample) } else { 0.0 }
    }

    /// The share where water would suit.
    fn on_ground(&self, sample: &Sample) -> f64 {
        let population = &self.population;
        if !self.biomes.get(sample.biome).is_some_and(|stands| *stands) {
            return 0.0;
        }
        let slope_deg = sample.slope_rad.to_degrees();
        let above_m = sample.height_m - self.sea_m.unwrap_or(0.0);
        between(slope_deg, population.slope_from_deg, population.slope_to_deg, SOFT_DEG)
            * between(above_m, population.height_from_m, population.height_to_m, SOFT_M)
            * between(sample.temperature_c, population.temperature_from_c, population.temperature_to_c, SOFT_C)
            * between(sample.moisture, population.moisture_from, population.moisture_to, SOFT_MOISTURE)
            * population.by_curvature(sample.curvature)
    }

    /// The same after edits: where it is dry enough, strokes plant also what no rule puts there.
    pub(super) fn planted(&self, sample: &Sample, planting: Planting) -> f64 {
        if self.is_dry(sample) { planting.of(self.at(sample)) } else { 0.0 }
    }

    /// Whether a place is dry enough: neither in water nor on the shore, unless the population stands in water.
    pub(super) fn is_dry(&self, sample: &Sample) -> bool {
        let is_wet = sample.water_level_m.is_some_and(|level_m| level_m > sample.height_m);
        let is_shore = self.sea_m.is_some_and(|sea_m| sample.height_m < sea_m + self.population.shore_m);
        self.population.in_water || !(is_wet || is_shore)
    }

    /// Whether groups leave less than all objects anywhere.
    pub(super) fn has_groups(&self) -> bool {
        self.population.clumping > 0.0
    }

    /// Finds the shares of the objects that groups leave at directions, one each: from `1 - clumping` to
    /// `1 + clumping`, over the greatest. `noise`: radius of the planet in metres, and seed.
    pub(super) fn find_clumpings(&self, simd: Simd, dirs: &[DVec3], noise: (f64, u32), shares: &mut [f64]) {
        let Population { clumping, clump_m, .. } = self.population;
        clumpings(simd, dirs, noise.0 / clump_m, clumping, noise.1, shares);
    }
}

#[inline(always)]
fn clumpings_body(dirs: &[DVec3], per_clump: f64, clumping: f64, seed: u32, shares: &mut [f64]) {
    for (dir, share) in dirs.iter().zip(shares) {
        let [x, y, z] = noise::skew((*dir * per_clump).to_array()).map(noise::split::<f64>);
        let noise = noise::value([x.0, y.0, z.0], [x.1, y.1, z.1], seed);
        *share = (1.0 + clumping * (2.0 * noise).clamp(-1.0, 1.0)) / (1.0 + clumping);
    }
}
for_each_simd!(fn clumpings(
    dirs: &[DVec3], per_clump: f64, clumping: f64, seed: u32, shares: &mut [f64]
) = clumpings_body);

/// 1 within a range, 0 from `soft` outside its ends on.
fn between(x: f64, from: f64, to: f64, soft: f64) -> f64 {
    let outside = (from - x).max(x - to).max(0.0);
    (1.0 - outside / soft).max(0.0)
}
