//! The ground that rivers carve: the drainage of the globe, and its evaluator at a point.
//!
//! - [`Plates`] and [`Weather`] as world maps: how they follow from a planet
//! - [`Carved`]: the drainage on grids from 64 cells a side on, each solved from the one before

use super::bytes::{Reader, Writer};
use super::cells::Cells;
use super::drainage::{self, Basins, Drainage};
use super::floodplain::Floodplains;
use super::grid::refined;
use super::map::{Inputs, Job, WorldMap};
use super::plates::{Plates, Rock};
use super::rivers::Rivers;
use super::sculpted::rock_of;
use super::weather::{self, Weather};
use crate::planet::Key;
use std::sync::{Arc, OnceLock};

/// Cells along the side of the grids of plates and weather, and of the coarsest grid of rivers.
const COARSEST: usize = 64;

impl WorldMap for Plates {
    const NAME: &'static str = "plates";
    const SIDES: &'static [usize] = &[COARSEST];
    const COARSE_FIRST: bool = true;

    fn key(inputs: &Inputs) -> Option<Key> {
        inputs.structure.as_ref().map(|structure| Key::of(&(&structure.plates, structure.seed)))
    }

    fn solve(job: &Job<'_>, side: usize, _coarser: Option<&Self>) -> Option<Self> {
        let structure = job.inputs().structure.as_ref()?;
        Plates::solve(&structure.plates, structure.seed, side, job.keep_going)
    }

    const STORED: bool = true;

    fn write(&self, to: &mut Writer) {
        self.write_to(to);
    }

    fn read(inputs: &Inputs, side: usize, from: &mut Reader<'_>) -> Option<Self> {
        let structure = inputs.structure.as_ref()?;
        Plates::read_from(&structure.plates, structure.seed, side, from)
    }
}

impl WorldMap for Weather {
    const NAME: &'static str = "weather";
    const SIDES: &'static [usize] = &[COARSEST];

    fn key(inputs: &Inputs) -> Option<Key> {
        let structure = inputs.structure.as_ref()?;
        Some(Key::of(&(structure, inputs.under, inputs.sea_level_m, inputs.sculpted)))
    }

    fn solve(job: &Job<'_>, side: usize, _coarser: Option<&Self>) -> Option<Self> {
        let rock = rock(job, None)?;
        // Rivers need rain, and rain needs the relief that rivers leave.
        let first = weather_over(job, side, &rock_of(job, &rock).risen_m())?;
        let drainage = drainage_of(job, &rock, &first, None)?;
        let carved_m: Vec<f64> = drainage.height_m.iter().map(|height_m| f64::from(*height_m)).collect();
        weather_over(job, side, &carved_m)
    }

    const STORED: bool = true;

    fn write(&self, to: &mut Writer) {
        self.write_to(to);
    }

    fn read(_inputs: &Inputs, side: usize, from: &mut Reader<'_>) -> Option<Self> {
        Weather::read_from(side, from)
    }
}

/// The carved ground of a planet.
pub(crate) struct Carved {
    pub(crate) drainage: Arc<Drainage>,
    pub(crate) rivers: Arc<Rivers>,
    pub(crate) floodplains: Floodplains,
    /// What the next level is solved from; none if the map was read from disk.
    rock: Option<Rock>,
    basins: OnceLock<Basins>,
}

impl Carved {
    pub(super) fn new(drainage: Arc<Drainage>, sea_level_m: Option<f64>, radius_km: f64, rock: Option<Rock>) -> Self {
        let rivers = Arc::new(Rivers::new(drainage.clone(), sea_level_m, radius_km));
        let floodplains = Floodplains::new(&drainage);
        Self { drainage, rivers, floodplains, rock, basins: OnceLock::new() }
    }

    /// The basins, found when they are first asked for.
    pub(crate) fn basins(&self) -> &Basins {
        self.basins.get_or_init(|| Basins::new(&self.drainage))
    }
}

impl WorldMap for Carved {
    const NAME: &'static str = "rivers";
    const SIDES: &'static [usize] = &[COARSEST, 128, 256, 512, 1024];
    const COARSE_FIRST: bool = true;

    fn levels(inputs: &Inputs) -> usize {
        inputs.grids
    }

    fn key(inputs: &Inputs) -> Option<Key> {
        Weather::key(inputs)
    }

    fn solve(job: &Job<'_>, _side: usize, coarser: Option<&Self>) -> Option<Self> {
        let structure = job.inputs().structure.as_ref()?;
        let weather = job.world.weather.map()?;
        let rock = rock(job, coarser.and_then(|coarser| coarser.rock.as_ref()))?;
        let drainage = Arc::new(drainage_of(job, &rock, weather, coarser.map(|coarser| &*coarser.drainage))?);
        Some(Self::new(drainage, job.inputs().sea_level_m, structure.radius_km, Some(rock)))
    }

    fn can_be_refined(&self) -> bool {
        self.rock.is_some()
    }

    const STORED: bool = true;

    fn write(&self, to: &mut Writer) {
        self.drainage.write(to);
    }

    fn read(inputs: &Inputs, side: usize, from: &mut Reader<'_>) -> Option<Self> {
        let drainage = Arc::new(Drainage::read(side, from)?);
        Some(Self::new(drainage, inputs.sea_level_m, inputs.structure.as_ref()?.radius_km, None))
    }
}

/// The crust on the coarsest grid, or on the one after `coarser`: solved on the first two, with detail added on finer
/// ones.
fn rock(job: &Job<'_>, coarser: Option<&Rock>) -> Option<Rock> {
    let plates = job.world.plates.map()?;
    let rock = match coarser {
        None => plates.rock.clone(),
        Some(coarser) if coarser.side == plates.rock.side => plates.finer(job.keep_going)?.clone(),
        Some(coarser) => coarser.finer(&plates.layout),
    };
    (job.keep_going)().then_some(rock)
}

pub(super) fn weather_over(job: &Job<'_>, side: usize, heights_m: &[f64]) -> Option<Weather> {
    let Inputs { sea_level_m, structure, .. } = job.inputs();
    let structure = structure.as_ref()?;
    let sculpted = job.ground.sculpted(&Cells::of(side));
    let inputs = weather::Inputs {
        params: &structure.weather,
        side,
        heights_m,
        more_rain_mm: sculpted.as_ref().map(|paint| &paint.rain_mm[..]),
        sea_level_m: *sea_level_m,
        equator_c: structure.equator_c,
        pole_c: structure.pole_c,
        lapse_c_per_km: structure.lapse_c_per_km,
    };
    Weather::solve(&inputs, job.keep_going)
}

pub(super) fn drainage_of(
    job: &Job<'_>,
    rock: &Rock,
    weather: &Weather,
    coarser: Option<&Drainage>,
) -> Option<Drainage> {
    let Inputs { sea_level_m, structure, .. } = job.inputs();
    let structure = structure.as_ref()?;
    let [runoff_mm, dryness_mm] =
        [weather.runoff_mm(), weather.dryness_mm()].map(|values| resampled(values, weather.side, rock.side));
    let Rock { base_m: mut initial_m, uplift_m, softness, .. } = rock_of(job, rock);
    let under_m = job.ground.under_m(&Cells::of(rock.side), job.keep_going)?;
    initial_m.iter_mut().zip(&under_m).for_each(|(initial_m, under_m)| *initial_m += under_m);
    let inputs = drainage::Inputs {
        params: &structure.rivers,
        seed: structure.seed,
        side: rock.side,
        radius_km: structure.radius_km,
        sea_level_m: *sea_level_m,
        initial_m: &initial_m,
        uplift_m: &uplift_m,
        softness: &softness,
        courses: job.ground.courses(),
        runoff_mm: &runoff_mm,
        dryness_mm: &dryness_mm,
    };
    Drainage::solve(&inputs, coarser, job.keep_going)
}

/// Values of a grid at the cells of a finer one, whose side is a power of two times as large.
fn resampled(mut values: Vec<f64>, mut side: usize, to: usize) -> Vec<f64> {
    while side < to {
        values = refined(&Cells::of(side), &values);
        side *= 2;
    }
    values
}
