//! Cover from rank and target, and the target from the climate.

use crate::planet::{CLIMATE_BELTS, Planet};
use crate::world::weather::{WARMEST_C, Weather};
use glam::DVec3;

/// Log-odds of cover for each unit of wetness (eight octaves of rain) and of the climate's belts. By eye.
const WETNESS: f64 = 3.4;
const BELTS: f64 = 1.3;
/// Log-odds of fog for the coldest currents, and for the whole range of humidity. By eye.
const COLD_FOG: f64 = 5.0;
const HUMID_FOG: f64 = 2.0;
/// Even a desert has a little cloud: added to the rain, mm a year.
const LEAST_MM: f64 = 80.0;
/// Octaves of rain from the median to either end of the wetness.
const OCTAVES: f64 = 4.0;

/// Clouds over a place.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct CloudCover {
    /// Share of the sky that low clouds cover, 0 to 1.
    pub low: f64,
    /// Share that middle clouds cover, 0 to 1.
    pub middle: f64,
    /// Share that the veil of high ice clouds covers, 0 to 1.
    pub veil: f64,
    /// Share of the ground that fog covers, 0 to 1, where the ground lies under the top of the fog.
    pub fog: f64,
}

/// The climate of clouds.
#[derive(Clone, Debug)]
pub(super) struct Targets {
    belts: f64,
    pub(super) weather_share: f64,
    median_mm: f64,
}

impl Targets {
    pub(super) fn new(planet: &Planet, weather: Option<&Weather>) -> Self {
        let weather_share = match (&planet.structure, weather) {
            (Some(structure), Some(_)) => structure.weather_share,
            _ => 0.0,
        };
        let mut sorted = weather.map_or_else(Vec::new, |weather| weather.rain_mm.clone());
        sorted.sort_by(f64::total_cmp);
        let median_mm = sorted.get(sorted.len() / 2).copied().unwrap_or_default();
        Self { belts: planet.climate.belts * (1.0 - weather_share), weather_share, median_mm }
    }

    /// Log-odds of the cover at a direction, relative to the mean of the globe.
    pub(super) fn odds(&self, weather: Option<&Weather>, dir: DVec3) -> f64 {
        // More cloud in the wet belts of the climate (Hadley and Ferrel cells), less in the dry ones.
        let (s, [c0, c1, c2, c3]) = (dir.z * dir.z, CLIMATE_BELTS);
        let belts = BELTS * self.belts * (c0 + s * (c1 + s * (c2 + s * c3)));
        let rain = weather.filter(|_| self.weather_share > 0.0).map_or(0.0, |weather| {
            // The logarithm of the rain relative to the median.
            let ratio = (weather.rain_at(dir) + LEAST_MM) / (self.median_mm + LEAST_MM);
            (0.5 * libm::log2(ratio) / OCTAVES).clamp(-0.5, 0.5)
        });
        belts + WETNESS * self.weather_share * rain
    }

    /// Log-odds of fog at a direction, relative to the mean of the globe: warm air over cold currents is foggy.
    pub(super) fn fog_odds(&self, weather: Option<&Weather>, dir: DVec3) -> f64 {
        weather.filter(|_| self.weather_share > 0.0).map_or(0.0, |weather| {
            let [warmer_c, humidity] = weather.at(dir);
            self.weather_share * (HUMID_FOG * (humidity - 0.5) - COLD_FOG * warmer_c / WARMEST_C)
        })
    }
}

/// The target cover of a direction.
pub(super) fn target(odds: f64) -> f64 {
    1.0 / (1.0 + libm::exp(-odds))
}

/// Cover where the rank of the noise is `rank`. Its mean over all ranks is the target, 1 / (1 + exp(-odds)).
/// `cloud_model.wgsl` has the same formula.
pub(super) fn cover(rank: f64, odds: f64) -> f64 {
    let target = target(odds);
    // The widest transition that keeps the mean: most clouds are thin at their edges, and few are closed.
    let width = target.min(1.0 - target);
    ((rank - 1.0 + target + width) / (2.0 * width + 1e-6)).clamp(0.0, 1.0)
}

/// The offset of the log-odds with which directions of equal areas have a mean cover.
pub(super) fn offset(odds: &[f64], coverage: f64) -> f64 {
    const MOST: f64 = 16.0;
    let (mut low, mut high) = (-MOST, MOST);
    if coverage <= 0.0 || coverage >= 1.0 {
        return if coverage <= 0.0 { -MOST } else { MOST };
    }
    for _ in 0..40 {
        let middle = 0.5 * (low + high);
        let mean = odds.iter().map(|odds| target(odds + middle)).sum::<f64>() / odds.len().max(1) as f64;
        (low, high) = if mean < coverage { (middle, high) } else { (low, middle) };
    }
    0.5 * (low + high)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_mean_cover_is_the_target() {
        for odds in [-4.0, -1.0, 0.0, 0.7, 3.0] {
            let ranks = (0..10_000).map(|i| (f64::from(i) + 0.5) / 10_000.0);
            let mean = ranks.map(|rank| cover(rank, odds)).sum::<f64>() / 10_000.0;
            assert!((mean - target(odds)).abs() < 1e-3, "{odds}: {mean} {}", target(odds));
        }
        assert!(cover(0.002, 16.0) > 0.999 && cover(0.998, -16.0) < 1e-3);
    }

    #[test]
    fn the_offset_meets_the_coverage() {
        let odds: Vec<f64> = (0..500).map(|i| f64::from(i % 50) / 12.0 - 2.0).collect();
        for coverage in [0.05, 0.3, 0.67, 0.95] {
            let offset = offset(&odds, coverage);
            let mean = odds.iter().map(|odds| target(odds + offset)).sum::<f64>() / 500.0;
            assert!((mean - coverage).abs() < 1e-6, "{mean} {coverage}");
        }
    }
}
