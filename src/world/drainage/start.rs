//! Where a grid starts: sea and land, basins without an outlet, the beds of the coarser grid, deltas.

use super::carve::earthly_m3_s;
use super::route::Routes;
use super::{DISCHARGE_UNIT, Drainage, Inputs, Level, Mouth, flood};
use crate::world::EARTH_KM;
use crate::world::cells::Cells;
use crate::world::grid::{cell_at, children, node, refined};
use crate::world::map::KeepGoing;
use crate::world::noise::{fbm, hash, unit};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

/// A sea is at least this share of the globe; smaller basins below its level are land.
const LEAST_SEA: f64 = 0.003;

/// Share of a planet without a sea that is plains into which rivers run dry.
const PLAINS: f64 = 0.12;

/// Depth in metres below which no delta is built.
const DELTA_FLOOR_M: f64 = 350.0;

/// The base level of a planet without a sea: the height below which [`PLAINS`] of its cells lie.
pub(super) fn plains_m(inputs: &Inputs<'_>) -> f64 {
    let mut all: Vec<f64> = inputs.initial_m.iter().zip(inputs.uplift_m).map(|(a, b)| a + b).collect();
    let rank = (PLAINS * all.len() as f64) as usize;
    let (_, level, _) = all.select_nth_unstable_by(rank, f64::total_cmp);
    *level
}

/// The ground at the start and the cells that lie in the sea.
pub(super) fn ground(
    inputs: &Inputs<'_>,
    cells: &Cells,
    areas_sr: &[f64],
    base_m: f64,
    coarser: Option<&Drainage>,
    seed: u32,
) -> (Vec<f64>, Vec<bool>) {
    let mut start_m = inputs.initial_m.to_vec();
    let mut reached = vec![0; start_m.len()];
    for (number, mouth) in coarser.map_or(&[][..], |coarser| &coarser.mouths).iter().enumerate() {
        add_delta(&mut start_m, cells, mouth, base_m, seed, (&mut reached, number as u32 + 1));
    }
    let low: Vec<bool> = start_m.iter().zip(inputs.uplift_m).map(|(m, up)| m + up < base_m).collect();
    let mut is_sea = vec![false; low.len()];
    let mut seen = vec![false; low.len()];
    for first in 0..low.len() {
        if !low[first] || seen[first] {
            continue;
        }
        let (mut sea, mut next, mut area_sr) = (vec![first as u32], 0, 0.0);
        seen[first] = true;
        while let Some(&cell) = sea.get(next) {
            next += 1;
            area_sr += areas_sr[cell as usize];
            for other in cells.around(cell as usize) {
                if low[other as usize] && !std::mem::replace(&mut seen[other as usize], true) {
                    sea.push(other);
                }
            }
        }
        if area_sr >= LEAST_SEA * 4.0 * PI || inputs.sea_level_m.is_none() {
            for cell in sea {
                is_sea[cell as usize] = true;
            }
        }
    }
    for (start_m, is_sea) in start_m.iter_mut().zip(&is_sea) {
        if !is_sea {
            *start_m = start_m.max(base_m - 400.0);
        }
    }
    (start_m, is_sea)
}

/// Raises the shelf before a mouth: a plain with lobes, a few metres above the sea. `reached` has the last number that
/// reached each cell.
fn add_delta(
    start_m: &mut [f64],
    cells: &Cells,
    mouth: &Mouth,
    base_m: f64,
    seed: u32,
    (reached, number): (&mut [u32], u32),
) {
    let (mut near, mut next) = (Vec::new(), 0);
    near.push(cell_at(cells.side, mouth.dir));
    reached[near[0]] = number;
    while let Some(&cell) = near.get(next) {
        next += 1;
        let dir = cells.dirs[cell];
        let straight = dir.distance(mouth.dir);
        let depth_m = base_m - start_m[cell];
        // Ground above the plain stays as it is.
        if depth_m > -6.0 && depth_m < DELTA_FLOOR_M && straight < 1.8 * 1.6 * mouth.reach_rad {
            let lobes = 1.0 + 0.9 * fbm(dir, 0.8 / mouth.reach_rad, 3, 0.6, hash(seed, 91));
            let away = straight / (mouth.reach_rad * lobes.clamp(0.3, 1.6));
            if away < 1.0 {
                start_m[cell] = start_m[cell].max(base_m + 1.0 + 5.0 * (1.0 - away));
            } else if away < 1.8 {
                start_m[cell] = start_m[cell].max(base_m - 25.0 - 120.0 * (away - 1.0));
            }
        }
        if straight < 2.0 * mouth.reach_rad {
            for other in cells.around(cell).map(|other| other as usize) {
                if std::mem::replace(&mut reached[other], number) != number {
                    near.push(other);
                }
            }
        }
    }
}

/// The mouths of great rivers, found on the grid of 128 cells and kept.
pub(super) fn mouths(
    level: &Level<'_>,
    routes: &Routes,
    discharge: &[u64],
    nodes: &[DVec3],
    coarser: Option<&Drainage>,
    seed: u32,
) -> Vec<Mouth> {
    const FOUND_AT: usize = 6 * 128 * 128;
    if discharge.len() != FOUND_AT {
        return coarser.map_or_else(Vec::new, |coarser| coarser.mouths.clone());
    }
    let mut mouths = Vec::new();
    for &cell in &routes.order {
        let to = routes.receiver[cell as usize] as usize;
        let m3_s = earthly_m3_s(discharge[cell as usize]);
        let varied = unit(hash(seed ^ 0xDE17A, cell));
        // Tides and waves keep some rivers from a delta.
        if level.is_sea[to] && m3_s > 900.0 && varied > 0.25 && level.params.deposition > 0.0 {
            let root = (m3_s / 1000.0).sqrt();
            // About the power 0.4 of the discharge: 55 km for the Nile, 300 km for the Amazon.
            let km = 42.0 * root.sqrt() * root.sqrt().sqrt() * (0.7 + 0.8 * varied) * level.params.deposition.sqrt();
            mouths.push(Mouth { dir: nodes[to], reach_rad: km.min(400.0) / EARTH_KM });
        }
    }
    mouths
}

/// The surface on which the first routes are found.
pub(super) fn surface(level: &Level<'_>, cells: &Cells, coarser: Option<&Drainage>, seed: u32) -> Vec<f64> {
    let Some(coarser) = coarser else {
        return (0..level.start_m.len()).map(|cell| level.start_m[cell] + 0.6 * level.uplift_m[cell]).collect();
    };
    let side = cells.side;
    let mut surface_m = refined(&Cells::of(coarser.side), &coarser.bed_m);
    // The ground beside great rivers lies higher than their beds.
    let beds = beds(coarser, side, seed);
    surface_m.par_iter_mut().zip(&beds).for_each(|(surface_m, &bed_m)| {
        *surface_m = if bed_m < f64::MAX { surface_m.min(bed_m) } else { surface_m.max(level.base_m + 2.0) + 12.0 };
    });
    surface_m
}

/// Great rivers of a coarser grid, drawn into a finer one: the height of the bed, or the greatest number.
fn beds(coarser: &Drainage, side: usize, seed: u32) -> Vec<f64> {
    // Rivers with the water of this many cells of mean runoff are kept.
    const CELLS: f64 = 5.0;
    let cell_sr = 4.0 * PI / (6 * coarser.side * coarser.side) as f64;
    let least = (CELLS * cell_sr * 0.35 / DISCHARGE_UNIT) as u64;
    let mut beds_m = vec![f64::MAX; 6 * side * side];
    for &cell in &coarser.order {
        let to = coarser.receiver[cell as usize];
        if coarser.discharge[cell as usize] < least || to == cell {
            continue;
        }
        let place = |cell: u32| node(coarser.side, cell as usize, coarser.seed);
        let (from, end) = (place(cell), place(to));
        let (high_m, low_m) = (coarser.bed_m[cell as usize], coarser.bed_m[to as usize]);
        // A bend: the middle of the way is moved aside.
        let aside = from.cross(end) * ((unit(hash(seed ^ 0xBE4D, cell)) - 0.5) * 0.6);
        const STEPS: usize = 12;
        for step in 0..=STEPS {
            let t = step as f64 / STEPS as f64;
            let dir = from + (end - from) * t + aside * (4.0 * t * (1.0 - t));
            let bed_m = &mut beds_m[cell_at(side, dir)];
            *bed_m = bed_m.min(high_m + (low_m - high_m) * t);
        }
    }
    beds_m
}

/// The bottoms of basins from which more would evaporate than flows in.
pub(super) fn sinks(
    level: &Level<'_>,
    cells: &Cells,
    nodes: &[DVec3],
    source: &[u64],
    keep_going: &KeepGoing<'_>,
) -> Option<Vec<u32>> {
    // A basin must be this deep, and its floor this many cells wide, before rivers cut its rim.
    const LEAST_M: f64 = 60.0;
    const LEAST_CELLS: usize = 2;
    let surface_m: Vec<f64> = (0..source.len()).map(|cell| level.surface_m(cell)).collect();
    let units = level.filled(cells, level.dry_units(&surface_m, |_, _| 0.0), &[], keep_going)?;
    let depth_m: Vec<f64> =
        (0..source.len()).map(|cell| f64::from(units[cell]) * flood::UNIT_M + level.base_m - surface_m[cell]).collect();
    let routes = Routes::new(cells, nodes, &units, level);
    let discharge = routes.by_cell(&routes.accumulated(source));
    let mut seen: Vec<bool> = depth_m.iter().enumerate().map(|(c, m)| level.is_sea[c] || *m < LEAST_M).collect();
    let mut sinks = Vec::new();
    for first in 0..seen.len() {
        if std::mem::replace(&mut seen[first], true) {
            continue;
        }
        let (mut basin, mut next) = (vec![first], 0);
        let (mut lost, mut inflow) = (0.0, 0_u64);
        while let Some(&cell) = basin.get(next) {
            next += 1;
            lost += level.dryness_mm[cell].max(0.0) * 1e-3 * level.areas_sr[cell];
            inflow = inflow.max(discharge[cell]);
            for other in cells.around(cell).map(|other| other as usize) {
                if !std::mem::replace(&mut seen[other], true) {
                    basin.push(other);
                }
            }
        }
        if basin.len() >= LEAST_CELLS && lost > inflow as f64 * DISCHARGE_UNIT {
            let lowest = basin.iter().min_by(|a, b| surface_m[**a].total_cmp(&surface_m[**b]).then(a.cmp(b)));
            sinks.extend(lowest.map(|cell| *cell as u32));
        }
    }
    sinks.sort_unstable();
    Some(sinks)
}

/// The same basins on the grid of twice the side: each sink moves to the lowest cell of its four.
pub(super) fn finer_sinks(level: &Level<'_>, coarser: &Drainage, side: usize) -> Vec<u32> {
    let finer = |&sink: &u32| {
        let four = children(side / 2, sink as usize);
        let lowest = four.iter().min_by(|a, b| level.surface_m(**a).total_cmp(&level.surface_m(**b)).then(a.cmp(b)));
        lowest.map(|cell| *cell as u32)
    };
    coarser.sinks.iter().filter_map(finer).collect()
}
