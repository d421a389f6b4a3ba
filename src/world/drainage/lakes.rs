//! Lakes: basins that an outlet has not drained yet, and basins from which water only evaporates.

use super::route::Routes;
use super::{DISCHARGE_UNIT, Lake, Level};
use crate::world::cells::Cells;
use rayon::prelude::*;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// The ground, the lake of each cell (1-based; 0 is none), and the lakes.
pub(super) struct Lakes {
    pub(super) ground_m: Vec<f64>,
    pub(super) lake: Vec<u32>,
    pub(super) lakes: Vec<Lake>,
}

/// Depth in metres that a basin needs to hold a lake, if the parameter `lakes` is 1.
const LEAST_DEPTH_M: f64 = 130.0;

/// Depth in metres beyond which the floor of a lake is taken for filled with sediment.
const MOST_DEPTH_M: f64 = 900.0;

/// Height of the rock under a bed, and of what a river has laid down on it.
fn floor_m(level: &Level<'_>, cell: usize, bed_m: f64) -> f64 {
    let rock_m = level.surface_m(cell);
    rock_m + (bed_m - rock_m).max(0.0) * (0.4 * level.params.deposition).min(0.9)
}

/// Depth below the surface of a lake at which ground beside it is lower ground, metres. Beds on the way out of a lake
/// are raised a little above those that were carved.
const LEAK_M: f64 = 5.0;

impl Lakes {
    /// Finds the lakes. `beds_m` is raised to the surface of each lake, and beyond it so far that it still falls along
    /// all routes.
    pub(super) fn find(
        level: &Level<'_>,
        cells: &Cells,
        routes: &Routes,
        discharge: &[u64],
        beds_m: &mut [f64],
    ) -> Self {
        let mut lakes = Self { ground_m: Vec::new(), lake: vec![0; beds_m.len()], lakes: Vec::new() };
        if level.params.lakes > 0.0 {
            lakes.add_closed(level, cells, routes, discharge, beds_m);
        }
        lakes.ground_m = beds_m.to_vec();
        if level.params.lakes > 0.0 {
            let carved_m = beds_m.to_vec();
            lakes.add_open(level, cells, routes, &carved_m, beds_m);
            for _ in 0..2 {
                lakes.close_gaps(level, cells, &carved_m);
            }
        }
        lakes
    }

    /// Basins with an outlet: the rock under a river bed lies lower than the outlet of the basin has been cut. Cells
    /// beside lower ground of another basin stay dry: they are the rim of the lake. `carved_m`: beds without lakes.
    fn add_open(&mut self, level: &Level<'_>, cells: &Cells, routes: &Routes, carved_m: &[f64], beds_m: &mut [f64]) {
        let least_m = LEAST_DEPTH_M / level.params.lakes;
        for &cell in &routes.order {
            let (cell, to) = (cell as usize, routes.receiver[cell as usize] as usize);
            if to == cell || self.lake[cell] != 0 {
                continue;
            }
            let (below, rock_m) = (self.lake[to], floor_m(level, cell, beds_m[cell]));
            let joined = below.checked_sub(1).map(|k| self.lakes[k as usize]).filter(|lake| lake.outlet.is_some());
            if let Some(lake) = joined {
                if rock_m < lake.level_m - 0.5 * least_m && self.is_held(cells, cell, (below, lake.level_m), carved_m) {
                    self.flood(level, cell, below, beds_m);
                    continue;
                }
            } else if below == 0
                && !level.is_sea[to]
                && rock_m < beds_m[to] - least_m
                && self.is_held(cells, cell, (self.lakes.len() as u32 + 1, beds_m[to]), carved_m)
            {
                self.lakes.push(Lake { level_m: beds_m[to], outlet: Some(to as u32), area_sr: 0.0 });
                let number = self.lakes.len() as u32;
                self.flood(level, cell, number, beds_m);
                continue;
            }
            beds_m[cell] = beds_m[cell].max(beds_m[to] + 0.01);
            self.ground_m[cell] = beds_m[cell];
        }
    }

    /// Floods low ground that a lake surrounds: small rivers have laid it down.
    fn close_gaps(&mut self, level: &Level<'_>, cells: &Cells, carved_m: &[f64]) {
        const MOST_M: f64 = 60.0;
        let before = self.lake.clone();
        let is_beside = |&cell: &u32| {
            let around = cells.around(cell as usize);
            before[cell as usize] == 0 && around.iter().any(|&other| before[other as usize] != 0)
        };
        let beside: Vec<u32> = level.land.par_iter().copied().with_min_len(4096).filter(is_beside).collect();
        for cell in beside.into_iter().map(|cell| cell as usize) {
            let around = cells.around(cell);
            let Some(number) = around.iter().map(|&other| before[other as usize]).find(|number| *number != 0) else {
                continue;
            };
            let wet = around.iter().filter(|&&other| before[other as usize] == number).count();
            let level_m = self.lakes[number as usize - 1].level_m;
            let is_low = self.ground_m[cell] < level_m + MOST_M;
            if wet >= 5 && is_low && self.is_held(cells, cell, (number, level_m), carved_m) {
                let lake = &mut self.lakes[number as usize - 1];
                self.lake[cell] = number;
                self.ground_m[cell] = self.ground_m[cell].min(lake.level_m - 1.0);
                lake.area_sr += level.areas_sr[cell];
            }
        }
    }

    /// Whether a cell can be part of a lake (its number and level): beside it nothing lies lower but the lake itself.
    /// What drains into a lake has beds above its level.
    fn is_held(&self, cells: &Cells, cell: usize, (number, level_m): (u32, f64), beds_m: &[f64]) -> bool {
        let holds = |&other: &u32| self.lake[other as usize] == number || beds_m[other as usize] > level_m - LEAK_M;
        cells.around(cell).iter().all(holds)
    }

    fn flood(&mut self, level: &Level<'_>, cell: usize, number: u32, beds_m: &mut [f64]) {
        let lake = &mut self.lakes[number as usize - 1];
        lake.area_sr += level.areas_sr[cell];
        self.lake[cell] = number;
        self.ground_m[cell] = floor_m(level, cell, beds_m[cell]).clamp(lake.level_m - MOST_DEPTH_M, lake.level_m - 1.0);
        beds_m[cell] = lake.level_m;
    }

    /// Basins without an outlet: the lake around each sink grows until as much evaporates as flows in.
    fn add_closed(&mut self, level: &Level<'_>, cells: &Cells, routes: &Routes, discharge: &[u64], beds_m: &mut [f64]) {
        for &sink in &routes.order {
            if routes.receiver[sink as usize] != sink {
                continue;
            }
            let inflow = discharge[sink as usize] as f64 * DISCHARGE_UNIT;
            let mut waiting = BinaryHeap::from([Reverse((0_u64, sink))]);
            let (mut lost, mut level_m, mut area_sr) = (0.0, beds_m[sink as usize], 0.0);
            let mut wet = Vec::new();
            let number = self.lakes.len() as u32 + 1;
            // Cells beside the lake, the lowest first.
            let mut rim = BinaryHeap::new();
            let above =
                |cell: u32, beds_m: &[f64]| ((beds_m[cell as usize] - beds_m[sink as usize]).max(0.0) * 1024.0) as u64;
            while let Some(Reverse((_, cell))) = waiting.pop() {
                if self.lake[cell as usize] != 0 {
                    continue;
                }
                // Marshes and plains around the lake lose water too.
                let dry_m = 1.8 * level.dryness_mm[cell as usize].max(300.0) * 1e-3;
                if !wet.is_empty() && lost + dry_m * level.areas_sr[cell as usize] > inflow {
                    break;
                }
                // All lower ground of this basin is wet by now. At the level of this cell, water would run over into
                // another basin beyond the rim.
                let next_m = level_m.max(beds_m[cell as usize]);
                for other in cells.around(cell as usize) {
                    rim.push(Reverse(((beds_m[other as usize] * 1024.0) as i64, other)));
                }
                let is_wet = |other: u32| other == cell || self.lake[other as usize] == number;
                while rim.peek().is_some_and(|Reverse((_, other))| is_wet(*other)) {
                    rim.pop();
                }
                let lowest_m = rim.peek().map(|Reverse((_, other))| beds_m[*other as usize]);
                if !wet.is_empty() && lowest_m.is_some_and(|lowest_m| lowest_m <= next_m - LEAK_M) {
                    break;
                }
                lost += dry_m * level.areas_sr[cell as usize];
                area_sr += level.areas_sr[cell as usize];
                level_m = level_m.max(beds_m[cell as usize]);
                self.lake[cell as usize] = number;
                wet.push(cell);
                for other in cells.around(cell as usize) {
                    // Only ground that drains into the lake: beyond it lies another basin.
                    if self.lake[other as usize] == 0 && self.lake[routes.receiver[other as usize] as usize] == number {
                        waiting.push(Reverse((above(other, beds_m), other)));
                    }
                }
            }
            // A salt flat has no lake: less flows in than its lowest cell loses.
            let is_flat = inflow < 0.3 * lost && wet.len() == 1;
            for &cell in &wet {
                if is_flat {
                    self.lake[cell as usize] = 0;
                }
            }
            if !is_flat {
                self.lakes.push(Lake { level_m: level_m + 1.0, outlet: None, area_sr });
            }
        }
    }
}
