//! How much of the planet's land lies in each cell of the biome table, and how much of it each biome has: a survey at directions
//! that stand for equal areas, on a thread of its own. It asks the terrain that everything else asks.

use crate::planet::Planet;
use crate::terrain::Terrain;
use crate::terrain::survey::spread;
use glam::DVec3;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, Sender, channel};

/// Directions asked for: shares are good to about a tenth of a percent.
const DIRECTIONS: usize = 24_576;

/// What was found. Shares are of the land, or of everything where there is no sea; each list adds up to 1, or to 0 without land.
#[derive(Clone, Debug, PartialEq)]
pub struct Survey {
    columns: usize,
    /// Share of each cell, row by row.
    cells: Vec<f64>,
    /// Share of each biome of the palette, after the rules for steep ground, beaches and snow.
    pub biomes: Vec<f64>,
    /// Share of the whole surface that lies under the sea.
    pub sea: f64,
    /// The greatest share of a cell.
    pub most: f64,
}

impl Survey {
    /// Asks a terrain.
    pub fn of(terrain: &Terrain) -> Self {
        let planet = terrain.planet();
        let dirs: Vec<DVec3> = spread(DIRECTIONS).collect();
        let sea_m = planet.sea_level_m().unwrap_or(f64::MIN);
        let columns = planet.biomes.table.columns();
        let mut cells = vec![0.0; columns * planet.biomes.table.rows().len()];
        let mut biomes = vec![0.0; planet.biomes.palette.len()];
        let grounds = terrain.grounds(&dirs);
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

    /// Share of a cell; none outside of the table that was surveyed.
    pub fn cell(&self, column: usize, row: usize) -> f64 {
        let inside = column < self.columns;
        self.cells.get(row * self.columns + column).copied().filter(|_| inside).unwrap_or(0.0)
    }
}

/// Asks and remembers the newest answer.
pub struct Surveyor {
    terrains: Sender<Arc<Terrain>>,
    answers: Receiver<Survey>,
    asked: Option<Arc<Terrain>>,
    survey: Option<Survey>,
}

impl Surveyor {
    /// Starts the thread; `wake` is called from it with each answer. It ends with the surveyor.
    pub fn new(wake: impl Fn() + Send + 'static) -> Self {
        let (terrains, asked) = channel::<Arc<Terrain>>();
        let (answered, answers) = channel();
        let spawned = std::thread::Builder::new().name("tellus-survey".to_owned()).spawn(move || {
            while let Ok(terrain) = asked.recv() {
                // Only the newest matters.
                let terrain = asked.try_iter().last().unwrap_or(terrain);
                if answered.send(Survey::of(&terrain)).is_err() {
                    return;
                }
                wake();
            }
        });
        // Without a thread there are no figures, and nothing else breaks.
        debug_assert!(spawned.is_ok());
        Self { terrains, answers, asked: None, survey: None }
    }

    /// Asks about a terrain, unless the newest question was about the same ground or its world maps are not final yet.
    pub fn ask(&mut self, terrain: &Arc<Terrain>) {
        if terrain.has_final_maps() && !self.asked.as_ref().is_some_and(|asked| same_ground(asked, terrain)) {
            // Without a thread there is nobody to ask.
            let _ = self.terrains.send(terrain.clone());
            self.asked = Some(terrain.clone());
        }
        if let Some(survey) = self.answers.try_iter().last() {
            self.survey = Some(survey);
        }
    }

    /// The newest answer; perhaps about an earlier revision.
    pub fn survey(&self) -> Option<&Survey> {
        self.survey.as_ref()
    }
}

/// Whether a survey would find the same: equal tiles, and equal rules from there to the biome.
fn same_ground(a: &Arc<Terrain>, b: &Arc<Terrain>) -> bool {
    let same_rules = |a: &Planet, b: &Planet| a.biomes == b.biomes && a.climate == b.climate;
    Arc::ptr_eq(a, b)
        || (same_rules(a.planet(), b.planet())
            && a.planet().sea_level_m() == b.planet().sea_level_m()
            && !b.keys().changes_since(a.keys()).touches_tiles())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Table, shipped};

    #[test]
    fn shares_add_up_and_the_sea_is_left_out() {
        let mut planet = shipped::default_planet();
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
