//! Which biome lies at a place: the table's, or what the rules for steep ground, beaches and snow put in its stead. `material.wgsl`
//! goes by the same rules with soft edges, halfway where a rule changes its answer here.
//!
//! Heights and slopes are the evaluator's own here, every octave in them, whoever asks from wherever. A picture knows what its detail
//! shows, down to about two pixels: from near it is the same, biome for biome. Where a pixel is wider than the mountains, their valleys
//! and cliffs are none of its heights and slopes, and it shows the biome of the ground between.

use crate::planet::{Biomes, Planet};

/// How much gentler and steeper than its limit a beach begins and ends to fade.
pub(crate) const BEACH_SOFT_DEG: f64 = 4.0;
/// The same for snow.
pub(crate) const SNOW_SOFT_DEG: f64 = 5.0;

/// What the rules look at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    /// The biome of the table: an index into the palette.
    pub(crate) biome: usize,
    pub(crate) height_m: f64,
    pub(crate) slope_rad: f64,
    pub(crate) temperature_c: f64,
}

/// The biome by the rules: an index into the palette. Rock that all biomes share is none of it.
pub(crate) fn biome_by_rules(planet: &Planet, site: Site) -> usize {
    let biomes = &planet.biomes;
    // Halfway by cosine, as the shader mixes.
    let cosine = |degrees: f64| degrees.clamp(0.0, 180.0).to_radians().cos();
    let middle = |from_deg: f64, to_deg: f64| 0.5 * (cosine(from_deg) + cosine(to_deg));
    let slope = site.slope_rad.cos();
    let mut biome = site.biome;
    let rule = biomes.palette.get(biome).and_then(|biome| biomes.steep_rule(biome));
    if let Some(rule) = rule
        && let Some(into) = rule.into
        && slope < middle(rule.from_deg, rule.to_deg)
    {
        biome = into;
    }
    if let Some(sea_m) = planet.sea_level_m()
        && let Some(beach) = beach(biomes)
        && (site.height_m - sea_m).abs() < biomes.beach_m
        && slope > middle(biomes.beach_steepest_deg - BEACH_SOFT_DEG, biomes.beach_steepest_deg + BEACH_SOFT_DEG)
    {
        biome = beach;
    }
    if let Some(snow) = biomes.snow.then(|| biomes.index_of(biomes.snow_key)).flatten()
        && site.temperature_c < biomes.snow_below_c
        && slope > middle(biomes.snow_steepest_deg - SNOW_SOFT_DEG, biomes.snow_steepest_deg + SNOW_SOFT_DEG)
    {
        biome = snow;
    }
    biome
}

fn beach(biomes: &Biomes) -> Option<usize> {
    (biomes.beach_m > 0.0).then(|| biomes.index_of(biomes.beach_key)).flatten()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Biome, Steep, Table, Water};

    fn planet() -> Planet {
        let biome = |key| Biome { key, ..Biome::default() };
        let steep =
            Biome { steep: Steep::Biome, steep_key: 'r', steep_from_deg: 20.0, steep_to_deg: 40.0, ..biome('a') };
        let biomes = Biomes {
            palette: vec![steep, biome('r'), biome('b'), biome('s')],
            table: Table::uniform('a', 2, 2),
            beach_m: 5.0,
            beach_key: 'b',
            snow: true,
            snow_key: 's',
            ..Biomes::default()
        };
        Planet { biomes, water: Some(Water { level_m: 100.0, ..Water::default() }), ..Planet::default() }
    }

    #[test]
    fn steep_ground_beaches_and_snow_have_their_turn() {
        let planet = planet();
        let at = |height_m, slope_deg: f64, temperature_c| {
            biome_by_rules(&planet, Site { biome: 0, height_m, slope_rad: slope_deg.to_radians(), temperature_c })
        };
        assert_eq!(at(500.0, 10.0, 10.0), 0);
        assert_eq!(at(500.0, 45.0, 10.0), 1, "steep");
        assert_eq!(at(104.0, 5.0, 10.0), 2, "beach");
        assert_eq!(at(106.0, 5.0, 10.0), 0, "too high for a beach");
        assert_eq!(at(104.0, 45.0, 10.0), 1, "too steep for a beach");
        assert_eq!(at(500.0, 10.0, -20.0), 3, "snow");
        assert_eq!(at(500.0, 50.0, -20.0), 1, "too steep for snow");
        assert_eq!(at(104.0, 5.0, -20.0), 3, "snow on a beach");
    }

    #[test]
    fn rules_that_are_off_or_name_no_biome_change_nothing() {
        let mut planet = planet();
        planet.biomes.beach_m = 0.0;
        planet.biomes.snow = false;
        planet.biomes.palette[0].steep = Steep::Stays;
        let site = Site { biome: 0, height_m: 100.0, slope_rad: 1.2, temperature_c: -90.0 };
        assert_eq!(biome_by_rules(&planet, site), 0);
        planet.biomes.snow = true;
        planet.biomes.snow_key = '?';
        planet.biomes.palette[0].steep = Steep::Rock;
        assert_eq!(biome_by_rules(&planet, Site { slope_rad: 0.1, ..site }), 0);
    }
}
