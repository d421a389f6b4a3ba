//! The coarsest level: the reaches of the solved drainage, one for each land cell.

use super::evaluate::RELIEF;
use super::grid::{Cell, Grid, STEPS};
use super::reach::{INFLUENCE, Reach, width_m};
use super::tributaries::RISE;
use crate::sphere::raster::Raster;
use crate::world::cells::Cells;
use crate::world::drainage::Drainage;
use glam::DVec3;
use rayon::prelude::*;
use std::sync::Arc;

/// A cell that nothing flows into, or that lies in no lake.
pub(super) const NONE: u32 = u32::MAX;

/// Depth of a mouth below the water it flows into.
const MOUTH_M: f64 = 3.0;
/// Half the width of the valley floor of a river of 100 m³/s in low land.
const VALLEY_M: f64 = 1500.0;
/// Share of a cell's relief that remains where a valley floor fills it.
const FLOOR_RELIEF: f64 = 0.25;

/// Half the width of the valley floor of a river, in metres. The floor of a great river is kilometres wide even in a
/// canyon (the exponent is that of the depth of rivers, and the factor chosen by eye); that of a small one is many
/// times its width where the land is flat.
fn floor_m(discharge_m3_s: f64, relief_m: f64) -> f64 {
    let floodplain_m = 6.0 * width_m(discharge_m3_s) / (1.0 + relief_m * (1.0 / 60.0));
    let valley_m = VALLEY_M * libm::pow(discharge_m3_s.max(0.0) * 0.01, 0.4) / (1.0 + relief_m * (1.0 / 2500.0));
    floodplain_m.max(valley_m)
}

/// The solved drainage, prepared for look-ups.
pub(super) struct Trunks {
    pub(super) grid: Grid,
    cells: Arc<Cells>,
    pub(super) radius_m: f64,
    pub(super) sea_level_m: Option<f64>,
    pub(super) drainage: Arc<Drainage>,
    /// The cell upstream that carries most water, if any.
    pub(super) main: Vec<u32>,
    /// The last cell of the river that each cell belongs to.
    pub(super) river: Vec<u32>,
    lake_near: Vec<u32>,
    /// Water that each cell adds to its river.
    pub(super) runoff_m3_s: Vec<f32>,
    /// How far the ground rises between the reaches of a cell.
    pub(super) relief_m: Vec<f32>,
}

impl Trunks {
    pub(super) fn new(drainage: Arc<Drainage>, sea_level_m: Option<f64>, radius_km: f64) -> Self {
        let Drainage { side, receiver, discharge_m3_s, seed, .. } = &*drainage;
        let grid = Grid::new(*side, 0, *seed);
        let count = receiver.len();
        let flows = |cell: usize| receiver[cell] as usize != cell;
        // Main branches: the greatest discharge, then the least number.
        let mut main = vec![NONE; count];
        let mut runoff_m3_s = discharge_m3_s.clone();
        for cell in (0..count).filter(|&cell| flows(cell)) {
            let to = receiver[cell] as usize;
            runoff_m3_s[to] -= discharge_m3_s[cell];
            if main[to] == NONE || discharge_m3_s[main[to] as usize] < discharge_m3_s[cell] {
                main[to] = cell as u32;
            }
        }
        runoff_m3_s.iter_mut().for_each(|runoff| *runoff = runoff.max(0.0));
        let mut trunks = Self {
            grid,
            cells: Cells::of(grid.side),
            radius_m: radius_km * 1e3,
            sea_level_m,
            drainage,
            main,
            river: Vec::new(),
            lake_near: Vec::new(),
            runoff_m3_s,
            relief_m: Vec::new(),
        };
        trunks.river = trunks.rivers();
        let lake = &trunks.drainage.lake;
        let lake_near = |cell: usize| match lake[cell] {
            0 => trunks.around(cell).map(|other| lake[other]).into_iter().filter(|&lake| lake != 0).min(),
            lake => Some(lake),
        };
        let lakes = (0..count).into_par_iter().map(|cell| lake_near(cell).unwrap_or(0)).collect();
        trunks.lake_near = lakes;
        trunks.relief_m = (0..count).into_par_iter().map(|cell| trunks.relief(cell)).collect();
        trunks
    }

    /// The ground as the cells give it, and the relief between reaches, as rasters.
    pub(super) fn rasters(&self, ground_m: Vec<f32>) -> [Raster<f32>; 2] {
        [ground_m, self.relief_m.clone()].map(|texels| Raster::cube(self.grid.side, texels))
    }

    /// The texels of the ground. In lakes they are lowered so that the spline, which is softer than its texels, meets
    /// the bed in the middle of the cell.
    pub(super) fn ground_m(&self) -> Vec<f32> {
        let texel = |(cell, &height_m): (usize, &f32)| {
            if self.drainage.lake[cell] == 0 {
                return height_m;
            }
            let around = self.around(cell).map(|other| f64::from(self.drainage.height_m[other]));
            // The weights of a cubic B-spline at a knot: 4/9, 1/9 and 1/36.
            let sum: f64 =
                around.iter().zip(STEPS).map(|(m, (x, y))| if x * y == 0 { m / 9.0 } else { m / 36.0 }).sum();
            height_m.min((2.25 * (f64::from(height_m) - sum)) as f32)
        };
        self.drainage.height_m.par_iter().enumerate().with_min_len(4096).map(texel).collect()
    }

    fn around(&self, cell: usize) -> [usize; 8] {
        self.cells.around(cell).map(|other| other as usize)
    }

    /// A cell and the eight around it, with their middles.
    pub(super) fn ring(&self, cell: usize) -> impl Iterator<Item = (usize, DVec3)> {
        let all = std::iter::once(cell).chain(self.around(cell));
        all.map(|cell| (cell, self.cells.dirs[cell]))
    }

    /// Follows each river to its last cell. Nothing is followed twice.
    fn rivers(&self) -> Vec<u32> {
        let mut river = vec![NONE; self.drainage.receiver.len()];
        let mut path = Vec::new();
        for start in 0..river.len() {
            let mut cell = start;
            while river[cell] == NONE {
                path.push(cell);
                let to = self.drainage.receiver[cell] as usize;
                if to == cell || !self.flows(to) || self.main[to] as usize != cell {
                    river[cell] = cell as u32;
                    break;
                }
                cell = to;
                // A circle of receivers would be an error of the solver; it must not hang the evaluator.
                if path.len() > river.len() {
                    break;
                }
            }
            let last = if river[cell] == NONE { cell as u32 } else { river[cell] };
            path.drain(..).for_each(|cell| river[cell] = last);
        }
        river
    }

    fn flows(&self, cell: usize) -> bool {
        self.drainage.receiver[cell] as usize != cell
    }

    /// The level of a lake, counted from 1.
    pub(super) fn level_of(&self, lake: u32) -> Option<f64> {
        Some(self.drainage.lakes.get((lake as usize).checked_sub(1)?)?.level_m)
    }

    /// Mean difference in height to the land around a cell, less where a valley floor fills the cell; 0 in water.
    fn relief(&self, cell: usize) -> f32 {
        let Drainage { height_m, lake, .. } = &*self.drainage;
        let land = |cell: usize| self.flows(cell) && lake[cell] == 0;
        if !land(cell) {
            return 0.0;
        }
        let rise = |other: usize| if land(other) { (height_m[other] - height_m[cell]).abs() } else { 0.0 };
        let mean_m = self.around(cell).iter().map(|&other| rise(other)).sum::<f32>() / 8.0;
        let half_m = 0.5 * self.grid.width_rad(self.cells.dirs[cell]) * self.radius_m;
        let floor = floor_m(f64::from(self.drainage.discharge_m3_s[cell]), f64::from(mean_m)) / half_m;
        mean_m * (1.0 - (1.0 - FLOOR_RELIEF) * floor.min(1.0)) as f32
    }

    fn node(&self, cell: usize) -> DVec3 {
        self.grid.node(self.grid.cell(cell as u64))
    }

    /// The direction of flow through a node, from its main branch to its receiver; none at a spring.
    fn tangent(&self, cell: usize) -> Option<DVec3> {
        let main = self.main[cell];
        (main != NONE && self.flows(cell))
            .then(|| self.node(self.drainage.receiver[cell] as usize) - self.node(main as usize))
    }

    /// Half the width of the valley floor at a cell, radians.
    fn flat_rad(&self, cell: usize, discharge_m3_s: f64) -> f64 {
        floor_m(discharge_m3_s, f64::from(self.relief_m[cell])) / self.radius_m
    }

    /// Heights of the banks and discharge at both ends of the reach that leaves a cell, and whether the river goes on
    /// there. None in the sea and within a lake.
    pub(super) fn ends(&self, cell: usize) -> Option<([f64; 2], [f64; 2], bool)> {
        let to = self.drainage.receiver[cell] as usize;
        let (lake, lake_to) = (self.drainage.lake[cell], self.drainage.lake[to]);
        if to == cell || (lake != 0 && lake == lake_to) {
            return None;
        }
        let from_m = self.level_of(lake).unwrap_or(f64::from(self.drainage.height_m[cell]));
        // A mouth lies a little below the water it flows into: a node of the sea may have higher ground around.
        // The bottom of a dry basin is land: what flows there ends on it, however high it lies.
        let is_over = |level_m: &f64| !self.flows(to) && f64::from(self.drainage.height_m[to]) < *level_m;
        let water_m = if lake_to != 0 { self.level_of(lake_to) } else { self.sea_level_m.filter(is_over) };
        let to_m = match water_m {
            Some(level_m) => (level_m - MOUTH_M).min(from_m),
            None => f64::from(self.drainage.height_m[to]).min(from_m),
        };
        let discharge = f64::from(self.drainage.discharge_m3_s[cell]);
        let goes_on = self.flows(to) && lake_to == 0;
        let is_same = goes_on && self.main[to] as usize == cell;
        let last = if is_same { f64::from(self.drainage.discharge_m3_s[to]).max(discharge) } else { discharge };
        Some(([from_m, to_m], [discharge, last], goes_on))
    }

    /// The reach that leaves a cell; none in the sea and within a lake.
    pub(super) fn reach(&self, at: Cell) -> Option<Reach> {
        let cell = self.grid.index(at) as usize;
        let (bank_m, [discharge, last], goes_on) = self.ends(cell)?;
        let to = self.drainage.receiver[cell] as usize;
        let (lake, lake_to) = (self.drainage.lake[cell], self.drainage.lake[to]);
        let is_main = !goes_on || self.main[to] as usize == cell;
        let (from, to_node) = (self.node(cell), self.node(to));
        Some(Reach {
            river: u64::from(self.river[cell]),
            from,
            to: to_node,
            tangents: [
                if lake == 0 { self.tangent(cell) } else { None },
                if goes_on { self.tangent(to) } else { None },
            ],
            is_main,
            bank_m,
            lake: if lake != 0 { lake } else { lake_to },
            rise_m: RISE * RELIEF * f64::from(self.relief_m[cell]),
            discharge_m3_s: [discharge, last],
            flat_rad: [self.flat_rad(cell, discharge), self.flat_rad(if goes_on { to } else { cell }, last)],
            influence_rad: INFLUENCE * self.grid.width_rad(from),
        })
    }

    /// The lake of a cell or else of a neighbour, counted from 1; 0 for none. Its shore may lie in either.
    pub(super) fn lake_near(&self, cell: usize) -> u32 {
        self.lake_near[cell]
    }

    /// The highest level of standing water, of the sea or of a lake.
    pub(super) fn standing(&self, lake: u32) -> (Option<f64>, u32) {
        match (self.level_of(lake), self.sea_level_m) {
            (Some(lake_m), Some(sea_m)) if sea_m >= lake_m => (Some(sea_m), 0),
            (Some(lake_m), _) => (Some(lake_m), lake),
            (None, sea_m) => (sea_m, 0),
        }
    }
}
