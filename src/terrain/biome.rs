//! The biome at a point: from the biome table by climate, then by the surface rules for steep ground, beaches and
//! snow.
//!
//! `material.wgsl` follows the same rules with soft edges; a rule decides here at the middle of its edge.
//!
//! Heights and slopes are the evaluator's, with every octave. A picture knows heights and slopes down to about two
//! pixels: from near, it shows the same biomes. Where a pixel is wider than a mountain, it shows the biome of the
//! mean ground.

use super::border::Border;
use super::climate::PointClimate;
use crate::planet::Planet;
use glam::DVec3;

/// How far before and after its steepest slope a beach fades.
pub(crate) const BEACH_SOFT_DEG: f64 = 4.0;
/// How far before and after its steepest slope snow fades.
pub(crate) const SNOW_SOFT_DEG: f64 = 5.0;

/// The biome table and the surface rules of a planet, compiled. Biomes are indices into the palette.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct CompiledBiomes {
    border: Border,
    columns: usize,
    rows: usize,
    /// The biome of each cell, row by row; cells whose key the palette lacks have the first biome.
    cells: Vec<usize>,
    /// For each biome, what takes the place of its steep ground.
    steep: Vec<Option<SteepGround>>,
    beach: Option<Beach>,
    snow: Option<Snow>,
}

/// The biome of steep ground, or the rock that biomes share.
#[derive(Clone, Copy, Debug, PartialEq)]
struct SteepGround {
    into: Option<usize>,
    /// Cosine of the slope beyond which it begins.
    cosine: f64,
}

/// A biome that stands in for another beyond a slope.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Rule {
    into: usize,
    /// Cosine of the slope at which it takes over or ends.
    cosine: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Beach {
    rule: Rule,
    sea_m: f64,
    /// Greatest height above or below the sea.
    reach_m: f64,
}

#[derive(Clone, Copy, Debug, PartialEq)]
struct Snow {
    rule: Rule,
    below_c: f64,
}

/// The ground that surface rules look at.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Site {
    pub(crate) height_m: f64,
    /// Cosine of the slope.
    pub(crate) cosine: f64,
    pub(crate) temperature_c: f64,
}

impl CompiledBiomes {
    pub(crate) fn new(planet: &Planet) -> Self {
        let biomes = &planet.biomes;
        let (columns, rows) = (biomes.table.columns(), biomes.table.rows().len());
        let keys = (0..rows).flat_map(|row| (0..columns).map(move |column| biomes.table.key(column, row)));
        let cosine = |degrees: f64| libm::cos(degrees.clamp(0.0, 180.0).to_radians());
        // The shader mixes by cosine, so the middle of an edge is the mean of two cosines.
        let middle = |from_deg: f64, to_deg: f64| 0.5 * (cosine(from_deg) + cosine(to_deg));
        let around = |deg: f64, soft_deg: f64| middle(deg - soft_deg, deg + soft_deg);
        let steep = biomes.palette.iter().map(|biome| {
            let rule = biomes.steep_rule(biome)?;
            Some(SteepGround { into: rule.into, cosine: middle(rule.from_deg, rule.to_deg) })
        });
        let beach = (biomes.beach_m > 0.0).then(|| biomes.index_of(biomes.beach_key)).flatten();
        let snow = biomes.snow.then(|| biomes.index_of(biomes.snow_key)).flatten();
        Self {
            border: Border::new(planet),
            columns,
            rows,
            cells: keys.map(|key| key.and_then(|key| biomes.index_of(key)).unwrap_or(0)).collect(),
            steep: steep.collect(),
            beach: beach.zip(planet.sea_level_m()).map(|(into, sea_m)| Beach {
                rule: Rule { into, cosine: around(biomes.beach_steepest_deg, BEACH_SOFT_DEG) },
                sea_m,
                reach_m: biomes.beach_m,
            }),
            snow: snow.map(|into| Snow {
                rule: Rule { into, cosine: around(biomes.snow_steepest_deg, SNOW_SOFT_DEG) },
                below_c: biomes.snow_below_c,
            }),
        }
    }

    /// The cell of the biome table (column and row), the biome at a point with this climate, and whether the rock that
    /// biomes share is in its place.
    pub(crate) fn at(&self, dir_planet: DVec3, climate: &PointClimate, site: Site) -> ([usize; 2], usize, bool) {
        let cell = self.cell(dir_planet, climate.moisture, climate.row);
        let of_table = self.cells.get(cell[1] * self.columns + cell[0]).copied().unwrap_or(0);
        let (biome, is_rock) = self.by_rules(of_table, site);
        (cell, biome, is_rock)
    }

    fn cell(&self, dir_planet: DVec3, moisture: f64, row: f64) -> [usize; 2] {
        let offset = self.border.offset_at(dir_planet);
        let cell = |at: f64, cells: usize, offset: f64| {
            let cells = cells as f64;
            (at * cells + offset).clamp(0.0, (cells - 0.5).max(0.0)) as usize
        };
        [cell(moisture, self.columns, offset[0]), cell(1.0 - row, self.rows, offset[1])]
    }

    /// The biome by the surface rules. The rock of steep ground that all biomes share is no biome: it is said apart.
    fn by_rules(&self, biome: usize, site: Site) -> (usize, bool) {
        let (mut biome, mut is_rock) = (biome, false);
        if let Some(steep) = self.steep.get(biome).copied().flatten()
            && site.cosine < steep.cosine
        {
            (biome, is_rock) = (steep.into.unwrap_or(biome), steep.into.is_none());
        }
        if let Some(Beach { rule, sea_m, reach_m }) = self.beach
            && (site.height_m - sea_m).abs() < reach_m
            && site.cosine > rule.cosine
        {
            (biome, is_rock) = (rule.into, false);
        }
        if let Some(Snow { rule, below_c }) = self.snow
            && site.temperature_c < below_c
            && site.cosine > rule.cosine
        {
            (biome, is_rock) = (rule.into, false);
        }
        (biome, is_rock)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Biome, Biomes, Steep, Table, Water};

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
        let biomes = CompiledBiomes::new(&planet);
        let at = |height_m, slope_deg: f64, temperature_c| {
            biomes.by_rules(0, Site { height_m, cosine: libm::cos(slope_deg.to_radians()), temperature_c }).0
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
        let site = Site { height_m: 100.0, cosine: 0.36, temperature_c: -90.0 };
        assert_eq!(CompiledBiomes::new(&planet).by_rules(0, site), (0, false));
        planet.biomes.snow = true;
        planet.biomes.snow_key = '?';
        planet.biomes.palette[0].steep = Steep::Rock;
        assert_eq!(CompiledBiomes::new(&planet).by_rules(0, Site { cosine: 0.995, ..site }), (0, false));
        assert_eq!(CompiledBiomes::new(&planet).by_rules(0, site), (0, true), "the rock that biomes share");
    }

    #[test]
    fn without_jitter_cells_follow_climate_alone() {
        let mut planet = Planet::default();
        planet.biomes.border_jitter = 0.0;
        let (columns, rows) = (planet.biomes.table.columns(), planet.biomes.table.rows().len());
        let biomes = CompiledBiomes::new(&planet);
        assert_eq!(biomes.cell(DVec3::X, 0.0, 1.0), [0, 0]);
        assert_eq!(biomes.cell(DVec3::X, 1.0, 0.0), [columns - 1, rows - 1]);
        assert_eq!(biomes.cell(DVec3::X, 0.5, 0.5), [columns / 2, rows / 2]);
    }
}
