//! Lights of settlements at night, as the renderer shows them from afar (`shaders/settlements.wgsl`): towns where the
//! land is low, flat, mild and watered, most of all near the sea. Patterns finer than a pixel give their mean.

use crate::noise_tile::{NoiseTile, SIDE, VARIATION_PERIODS_M};
use crate::planet::Planet;
use crate::terrain::Sample;
use crate::terrain::border::OCTAVE_TURN;
use glam::DVec3;

/// As the shader has them.
const TOWN_LIGHT: f64 = 1.2e-4;
const SODIUM: DVec3 = DVec3::new(1.0, 0.62, 0.26);
const LED: DVec3 = DVec3::new(0.85, 0.92, 1.0);
const CASCADE: usize = 6;
const MOST: f64 = 60.0;

/// The lights of a planet.
pub(super) struct Lights {
    tile: NoiseTile,
    settlements: f64,
    radius_m: f64,
    sea_m: f64,
}

impl Lights {
    /// The lights of a planet. None if it has none.
    pub(super) fn new(planet: &Planet) -> Option<Self> {
        let sea_m = planet.sea_level_m().filter(|_| planet.settlements > 0.0)?;
        Some(Self { tile: NoiseTile::new(), settlements: planet.settlements, radius_m: planet.radius_m(), sea_m })
    }

    /// Linear sRGB of a place whose height, climate and water are known; sunlit white ground has 1. `slope`: rise over
    /// run as pixels show it, which are `pixel_rad` apart.
    pub(super) fn at(&self, dir: DVec3, sample: &Sample, slope: f64, pixel_rad: f64) -> [f64; 3] {
        let footprint_m = pixel_rad * self.radius_m;
        let over_sea_m = sample.height_m - self.sea_m;
        let is_wet = sample.water_level_m.is_some_and(|level_m| level_m > sample.height_m);
        let temperature_c = sample.temperature_c;
        let mild = smoothstep(-8.0, 6.0, temperature_c) * (1.0 - smoothstep(30.0, 38.0, temperature_c));
        let low = smoothstep(1.0, 4.0, over_sea_m) * (1.0 - smoothstep(300.0, 1800.0, over_sea_m));
        let even = 1.0 - smoothstep(0.12, 0.45, slope);
        let good = self.settlements * mild * low * even * smoothstep(0.12, 0.4, sample.moisture);
        if good <= 0.0 || is_wet {
            return [0.0; 3];
        }
        let (mut crowd, mut newest) = (1.0, 1.0);
        let mut position_m = dir * (self.radius_m + sample.height_m);
        for period_m in VARIATION_PERIODS_M.into_iter().take(CASCADE) {
            let lod = libm::log2((footprint_m * SIDE as f64 / period_m).max(1e-6));
            let at = position_m / period_m;
            let n = self.tile.ground_at(DVec3::new(at.z, at.x, at.y), lod.max(0.0));
            let n2 = n * n;
            newest = 1.0 + (7.0 * n2 * n2 * n2 - 1.0) * (1.0 - smoothstep(0.5, 3.0, lod));
            crowd *= newest;
            position_m = OCTAVE_TURN * position_m;
        }
        let coast = 0.35 + 2.0 * libm::exp(-over_sea_m.max(0.0) / 40.0);
        let light = good * crowd * coast / (1.0 + crowd * coast / MOST);
        let color = SODIUM + (LED - SODIUM) * (0.2 * newest).clamp(0.0, 1.0);
        (color * (TOWN_LIGHT * light)).to_array()
    }
}

fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Water;
    use crate::sphere::geo::spread;

    fn planet() -> Planet {
        Planet { settlements: 1.0, water: Some(Water::default()), ..Planet::default() }
    }

    fn mild(height_m: f64) -> Sample {
        Sample { height_m, temperature_c: 15.0, moisture: 0.6, ..Sample::default() }
    }

    fn mean(lights: &Lights, sample: &Sample, pixel_rad: f64) -> f64 {
        spread(20_000).map(|dir| lights.at(dir, sample, 0.0, pixel_rad)[0]).sum::<f64>() / 20_000.0
    }

    #[test]
    fn people_live_on_low_flat_mild_land() {
        let lights = Lights::new(&planet()).unwrap();
        let good = mean(&lights, &mild(20.0), 1e-3);
        assert!(good > 0.2 * TOWN_LIGHT, "{good}");
        assert!(mean(&lights, &mild(1000.0), 1e-3) < 0.5 * good);
        let sea = Sample { water_level_m: Some(0.0), ..mild(-20.0) };
        let lake = Sample { water_level_m: Some(25.0), ..mild(20.0) };
        for dark in [sea, lake, Sample { temperature_c: -20.0, ..mild(20.0) }, Sample { moisture: 0.05, ..mild(20.0) }]
        {
            assert_eq!(mean(&lights, &dark, 1e-3), 0.0, "{dark:?}");
        }
        assert_eq!(lights.at(DVec3::X, &mild(20.0), 0.5, 1e-3), [0.0; 3]);
        assert!(Lights::new(&Planet { settlements: 0.0, ..planet() }).is_none());
        assert!(Lights::new(&Planet { water: None, ..planet() }).is_none());
    }

    #[test]
    fn coarse_pixels_have_the_mean_of_fine_ones() {
        // Each octave's factor has a mean of 1, and coarse pixels take it; the bound on the light costs some of it.
        let [fine, coarse] =
            [1e-5, 1.0].map(|pixel_rad| mean(&Lights::new(&planet()).unwrap(), &mild(200.0), pixel_rad));
        assert!(fine > 0.3 * coarse && fine < 1.2 * coarse, "{fine} {coarse}");
    }
}
