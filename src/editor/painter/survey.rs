//! The shares of the planet's land in each cell of the biome table and in each biome: samples of the evaluator at
//! directions of equal areas.

use crate::editor::state::surveyor::{Asked, same_heights};
use crate::planet::Planet;
use crate::sphere::spread;
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use glam::DVec3;
use std::f64::consts::PI;

/// Number of directions: the error of a share is about a tenth of a percent.
const DIRECTIONS: usize = 24_576;

/// The result. Shares are of the land, or of the whole surface of a planet without a sea. Each list adds up to 1, or to
/// 0 without land.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    columns: usize,
    /// Share of each cell, row by row.
    cells: Vec<f64>,
    /// Share of each biome of the palette, after the surface rules (steep ground, beaches, snow).
    pub biomes: Vec<f64>,
    /// Share of the whole surface under the sea.
    pub sea: f64,
    /// The largest share of a cell.
    pub most: f64,
}

impl Survey {
    /// Surveys a terrain.
    pub fn of(terrain: &Terrain) -> Self {
        let planet = terrain.planet();
        let dirs: Vec<DVec3> = spread(DIRECTIONS).collect();
        let sea_m = planet.sea_level_m().unwrap_or(f64::MIN);
        let columns = planet.biomes.table.columns();
        let mut cells = vec![0.0; columns * planet.biomes.table.rows().len()];
        let mut biomes = vec![0.0; planet.biomes.palette.len()];
        let mut grounds = vec![Sample::default(); DIRECTIONS];
        // Single valleys do not count, and finding rivers that nothing has drawn would take a minute.
        let spacing_rad = (4.0 * PI / DIRECTIONS as f64).sqrt();
        let wanted = Wanted::HEIGHT.and_biome();
        terrain.samples_spaced_into(&dirs, spacing_rad, wanted, &mut grounds, &mut Scratch::default());
        let land = grounds.iter().filter(|ground| ground.height_m >= sea_m);
        let count = land.clone().count();
        let share = 1.0 / count.max(1) as f64;
        for ground in land {
            let [column, row] = ground.cell;
            if let Some(cell) = cells.get_mut(row * columns + column) {
                *cell += share;
            }
            if let Some(biome) = biomes.get_mut(ground.biome) {
                *biome += share;
            }
        }
        let most = cells.iter().copied().fold(0.0, f64::max);
        Self { columns, cells, biomes, sea: 1.0 - count as f64 / DIRECTIONS as f64, most }
    }

    /// Share of a cell; 0 outside the surveyed table.
    pub fn cell(&self, column: usize, row: usize) -> f64 {
        let inside = column < self.columns;
        self.cells.get(row * self.columns + column).copied().filter(|_| inside).unwrap_or(0.0)
    }
}

/// Whether a survey would find the same: equal tiles, and equal rules from there to the biome.
pub fn same_survey(asked: &Asked, terrain: &Terrain) -> bool {
    let (a, b) = (&asked.planet, terrain.planet());
    let same_rules = |a: &Planet, b: &Planet| a.biomes == b.biomes && a.climate == b.climate;
    same_rules(a, b) && a.sea_level_m() == b.sea_level_m() && same_heights(asked, terrain)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Structure, Table, Water, shipped};
    use std::sync::Arc;

    /// A survey of a planet with rivers builds no block of them: it would take a minute.
    #[test]
    fn rivers_are_left_out() {
        let structure = Some(Structure { grids: 1, ..Structure::default() });
        let planet = Planet { structure, water: Some(Water::default()), ..shipped::layered() };
        let terrain = Terrain::try_new(Arc::new(Planet { layers: Vec::new(), ..planet })).unwrap();
        let survey = Survey::of(&terrain);
        assert!((survey.cells.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        assert!((0.4..0.9).contains(&survey.sea), "{}", survey.sea);
        assert_eq!(terrain.world().carved.map().unwrap().rivers.blocks(), 0);
    }

    #[test]
    fn shares_add_up_and_the_sea_is_left_out() {
        let mut planet = shipped::layered();
        let survey = Survey::of(&Terrain::try_new(Arc::new(planet.clone())).unwrap());
        assert!((survey.cells.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        assert!((survey.biomes.iter().sum::<f64>() - 1.0).abs() < 1e-9);
        assert!((0.4..0.9).contains(&survey.sea), "{}", survey.sea);
        assert_eq!((survey.cell(99, 0), survey.cell(0, 99)), (0.0, 0.0));

        let key = planet.biomes.palette[3].key;
        planet.biomes.table = Table::uniform(key, 8, 8);
        planet.biomes.beach_m = 0.0;
        let survey = Survey::of(&Terrain::try_new(Arc::new(planet)).unwrap());
        assert!((survey.biomes[3] - 1.0).abs() < 1e-9);
    }
}
