//! Rivers: where water runs, how much of it, the beds that it carves, and lakes.
//!
//! The solver works on a grid of a cube, coarse to fine. On each grid it repeats: fill pits, find the steepest way
//! down, sum the discharge, and set the height of each bed by a closed form (see `carve`). The result is a function of
//! rock, rise, rain and age, never of a history. Great rivers of a coarser grid are cut into the start of the finer
//! one, so that both have them in the same places.
//!
//! - `flood`: filling of pits; `route`: receivers and discharge; `carve`: heights of beds; `lakes`: lakes
//! - `forced`: courses that are drawn by hand; `kept`: rivers on disk
//! - `start`: sea, closed basins and the surface at which a grid starts; deltas; `basins`: land by mouths

mod basins;
mod carve;
mod flood;
mod forced;
mod kept;
mod lakes;
mod route;
mod start;

use super::cells::Cells;
use super::grid::{areas_sr, node};
use super::map::KeepGoing;
use super::noise::{hash, unit};
use super::sculpted::DrawnCourse;
use crate::planet::Rivers as Params;
pub(crate) use basins::Basins;
use forced::Forced;
use glam::DVec3;
use lakes::Lakes;
use rayon::prelude::*;
use route::Routes;

/// The unit of summed discharge: m³ a year on a sphere of radius 1 m.
pub(super) const DISCHARGE_UNIT: f64 = 1.0 / (1_u64 << 40) as f64;

/// Seconds in a year.
pub(super) const YEAR_S: f64 = 3.156e7;

/// What the rivers of a planet depend on, at the cells of one grid.
pub(crate) struct Inputs<'a> {
    pub(crate) params: &'a Params,
    /// Seed of the planet.
    pub(crate) seed: u32,
    /// Cells along the side of a face.
    pub(crate) side: usize,
    /// Radius of the planet. Only the talus depends on it.
    pub(crate) radius_km: f64,
    /// Height of the sea's surface in metres, if there is a sea.
    pub(crate) sea_level_m: Option<f64>,
    /// Height of the ground in metres before it rises and is carved.
    pub(crate) initial_m: &'a [f64],
    /// Height in metres by which rock rises in the age of the rivers.
    pub(crate) uplift_m: &'a [f64],
    /// Logarithm of how easily rock is carved; 0 is the mean.
    pub(crate) softness: &'a [f64],
    /// Water that runs off, in mm a year.
    pub(crate) runoff_mm: &'a [f64],
    /// Rivers whose courses are drawn by hand.
    pub(crate) courses: &'a [DrawnCourse],
    /// What a lake loses to the air beyond the rain that falls on it, in mm a year. Below zero where it gains.
    pub(crate) dryness_mm: &'a [f64],
}

/// A lake.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Lake {
    /// Height of the surface in metres.
    pub(crate) level_m: f64,
    /// The cell into which it overflows; none if its water only evaporates.
    pub(crate) outlet: Option<u32>,
    /// Area as a solid angle.
    pub(crate) area_sr: f64,
}

/// A mouth of a great river, for its delta.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Mouth {
    pub(crate) dir: DVec3,
    pub(crate) reach_rad: f64,
}

/// Rivers and lakes at the cells of a grid.
#[derive(Default)]
pub(crate) struct Drainage {
    pub(crate) side: usize,
    /// Seed of the nodes: the river of a cell runs through [`super::grid::node`] of it.
    pub(crate) seed: u32,
    /// Height of the ground in metres; under water that of the bed.
    pub(crate) height_m: Vec<f32>,
    /// Height of the river's bed in metres; in a lake with an outlet that of its surface. It falls along all receivers.
    /// Like `discharge`, `sinks` and `mouths` it serves the next finer grid, and is empty in rivers that were read.
    pub(crate) bed_m: Vec<f64>,
    /// The cell to which a cell's water goes; itself in the sea and at the bottom of a basin without an outlet.
    pub(crate) receiver: Vec<u32>,
    /// Discharge in m³/s on this planet.
    pub(crate) discharge_m3_s: Vec<f32>,
    /// Discharge summed in whole units; see [`DISCHARGE_UNIT`].
    pub(crate) discharge: Vec<u64>,
    /// The lake of each cell: 0 is none, else one more than the index in `lakes`.
    pub(crate) lake: Vec<u32>,
    pub(crate) lakes: Vec<Lake>,
    /// Whether a cell lies in the sea.
    pub(crate) is_sea: Vec<bool>,
    /// Bottoms of basins without an outlet.
    pub(crate) sinks: Vec<u32>,
    /// Mouths of the great rivers whose deltas a finer grid builds.
    pub(crate) mouths: Vec<Mouth>,
    /// Land cells, each after its receiver.
    pub(crate) order: Vec<u32>,
}

/// The inputs of a grid, and what is derived from them once.
pub(super) struct Level<'a> {
    pub(super) params: &'a Params,
    pub(super) radius_km: f64,
    pub(super) base_m: f64,
    pub(super) areas_sr: Vec<f64>,
    pub(super) is_sea: Vec<bool>,
    /// Height of the ground at the start; deltas are among it, and it is nowhere on land below the base.
    pub(super) start_m: Vec<f64>,
    pub(super) uplift_m: &'a [f64],
    pub(super) dryness_mm: &'a [f64],
    /// Land cells, and those of them that touch the sea.
    pub(super) land: Vec<u32>,
    pub(super) shore: Vec<u32>,
    /// How slowly rock is carved; see `carve`.
    pub(super) slowness: Vec<f64>,
    /// Courses that are drawn by hand.
    forced: Forced,
}

impl Level<'_> {
    /// Height of the ground after rock has risen, if nothing had been carved.
    pub(super) fn surface_m(&self, cell: usize) -> f64 {
        self.start_m[cell] + self.uplift_m[cell]
    }

    /// Height of the bottom of a basin without an outlet: what rivers lay down keeps it near the base level or above.
    pub(super) fn sink_m(&self, cell: usize) -> f64 {
        self.surface_m(cell).max(self.base_m - 40.0)
    }
}

/// How often routes and heights are found in turn on a grid.
pub(crate) fn rounds(side: usize) -> usize {
    match side {
        0..=64 => 6,
        65..=128 => 4,
        129..=256 => 3,
        _ => 2,
    }
}

/// Share of the new heights that each round but the last takes over.
const RELAXATION: f64 = 0.65;

impl Drainage {
    /// Solves the rivers on a grid, given those of the grid of half the side, if there is one. None if `keep_going`
    /// said no.
    pub(crate) fn solve(inputs: &Inputs<'_>, coarser: Option<&Drainage>, keep_going: &KeepGoing<'_>) -> Option<Self> {
        let cells = Cells::of(inputs.side);
        let seed = hash(hash(inputs.seed, inputs.params.seed), 0x21FE);
        let coarser = coarser.filter(|coarser| coarser.side * 2 == inputs.side);
        let base_m = inputs.sea_level_m.unwrap_or_else(|| start::plains_m(inputs));
        let areas_sr = areas_sr(inputs.side);
        let (start_m, is_sea) = start::ground(inputs, &cells, &areas_sr, base_m, coarser, seed);
        let mut level = Level {
            params: inputs.params,
            radius_km: inputs.radius_km,
            base_m,
            areas_sr,
            is_sea,
            start_m,
            uplift_m: inputs.uplift_m,
            dryness_mm: inputs.dryness_mm,
            land: Vec::new(),
            shore: Vec::new(),
            slowness: Vec::new(),
            forced: Forced::default(),
        };
        let nodes = level.complete(inputs, &cells, seed, keep_going)?;
        let mut source = level.source(inputs);
        level.forced.add_springs(&mut source);
        let mut surface_m = start::surface(&level, &cells, coarser, seed);
        let mut sinks = match coarser {
            Some(coarser) => start::finer_sinks(&level, coarser, inputs.side),
            None => start::sinks(&level, &cells, &nodes, &source, keep_going)?,
        };
        sinks.retain(|&sink| !level.is_sea[sink as usize]);
        let rounds = rounds(inputs.side);
        let mut found = None;
        for round in 0..rounds {
            if !keep_going() {
                return None;
            }
            let units = level.dry_units(&surface_m, |cell, above_m| roughness_m(above_m, seed, cell));
            let units = level.filled(&cells, units, &sinks, keep_going)?;
            let routes = Routes::new(&cells, &nodes, &units, &level);
            let discharge = routes.accumulated(&source);
            let beds_m = carve::beds_m(&level, &routes, &discharge);
            if round + 1 < rounds {
                for (&cell, bed_m) in routes.order.iter().zip(&beds_m) {
                    let surface_m = &mut surface_m[cell as usize];
                    *surface_m += (bed_m - *surface_m) * RELAXATION;
                }
            }
            found = Some((routes, discharge, beds_m));
        }
        let (routes, discharge, beds_m) = found?;
        let discharge = routes.by_cell(&discharge);
        let mut bed_m = vec![base_m; level.is_sea.len()];
        routes.order.iter().zip(&beds_m).for_each(|(&cell, &at_m)| bed_m[cell as usize] = at_m);
        let Lakes { ground_m, lake, lakes } = Lakes::find(&level, &cells, &routes, &discharge, &mut bed_m);
        let height_m = (0..ground_m.len())
            .into_par_iter()
            .map(|cell| (if level.is_sea[cell] { level.start_m[cell] } else { ground_m[cell] }) as f32)
            .collect();
        let radius_m = inputs.radius_km * 1000.0;
        let true_m3_s = |units: &u64| (*units as f64 * (DISCHARGE_UNIT * radius_m * radius_m / YEAR_S)) as f32;
        let mouths = start::mouths(&level, &routes, &discharge, &nodes, coarser, seed);
        Some(Self {
            side: inputs.side,
            seed,
            height_m,
            bed_m,
            discharge_m3_s: discharge.par_iter().map(true_m3_s).collect(),
            discharge,
            lake,
            lakes,
            is_sea: level.is_sea,
            sinks,
            mouths,
            receiver: routes.receiver,
            order: routes.order,
        })
    }
}

impl Level<'_> {
    /// Sets what follows from the sea and the land. Answers the nodes of land and of the sea beside it; None if
    /// `keep_going` said no.
    fn complete(
        &mut self,
        inputs: &Inputs<'_>,
        cells: &Cells,
        seed: u32,
        keep_going: &KeepGoing<'_>,
    ) -> Option<Vec<DVec3>> {
        let (all, is_sea) = (0..self.is_sea.len(), &self.is_sea);
        let meets = |cell: usize, sea: bool| cells.around(cell).iter().any(|&other| is_sea[other as usize] == sea);
        self.land = all.clone().filter(|&cell| !is_sea[cell]).map(|cell| cell as u32).collect();
        self.shore = self.land.par_iter().copied().filter(|&cell| meets(cell as usize, true)).collect();
        let slowness = |cell: usize| {
            if is_sea[cell] { 0.0 } else { carve::slowness(self.params, inputs.softness[cell]) }
        };
        self.slowness = all.clone().into_par_iter().with_min_len(1024).map(slowness).collect();
        self.forced = Forced::new(inputs.courses, cells, inputs.radius_km, is_sea, keep_going)?;
        self.forced.cut(&mut self.slowness);
        let place = |cell: usize| {
            if is_sea[cell] && !meets(cell, false) { DVec3::ZERO } else { node(inputs.side, cell, seed) }
        };
        Some(all.into_par_iter().with_min_len(1024).map(place).collect())
    }

    /// Heights for the flood, with `rough` of the cell and its height above the base added.
    fn dry_units(&self, surface_m: &[f64], rough: impl Fn(usize, f64) -> f64 + Sync) -> Vec<u32> {
        let units = |(cell, m): (usize, &f64)| {
            let above_m = m - self.base_m;
            if self.is_sea[cell] { 0 } else { flood::dry_units(above_m + rough(cell, above_m)) }
        };
        surface_m.par_iter().enumerate().with_min_len(4096).map(units).collect()
    }

    /// Heights for routes from those of [`Level::dry_units`]: without pits, and with the trenches of drawn rivers.
    fn filled(
        &self,
        cells: &Cells,
        mut units: Vec<u32>,
        sinks: &[u32],
        keep_going: &KeepGoing<'_>,
    ) -> Option<Vec<u32>> {
        let fill = |units| flood::fill(cells, units, &self.shore, sinks, keep_going);
        if !self.forced.is_empty() {
            let filled = if self.forced.ends_inland() { fill(units.clone())? } else { Vec::new() };
            self.forced.dig(&mut units, &filled);
        }
        fill(units)
    }

    /// Water that each cell adds to its river, in units of the discharge.
    fn source(&self, inputs: &Inputs<'_>) -> Vec<u64> {
        let even_mm = 350.0;
        let of = |cell: usize| {
            let pattern = inputs.params.rain_pattern;
            let mm = inputs.params.rain * (even_mm + (inputs.runoff_mm[cell].max(4.0) - even_mm) * pattern);
            if self.is_sea[cell] { 0 } else { (mm * 1e-3 * self.areas_sr[cell] / DISCHARGE_UNIT) as u64 + 1 }
        };
        (0..self.areas_sr.len()).into_par_iter().map(of).collect()
    }
}

/// Roughness of the surface on which routes are found: without it rivers run straight over even slopes.
fn roughness_m(above_m: f64, seed: u32, cell: usize) -> f64 {
    (unit(hash(seed ^ 0x5EED, cell as u32)) - 0.5) * (0.06 * above_m.clamp(0.0, 1200.0) + 4.0)
}

#[cfg(test)]
mod tests;
