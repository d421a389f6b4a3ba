//! A small drainage to test with: islands of noise, filled, drained and worn down by rivers for a while.

use crate::world::cells::Cells;
use crate::world::drainage::{Drainage, Lake};
use glam::DVec3;
use std::cmp::Reverse;
use std::collections::BinaryHeap;

/// Where the sea stands.
pub(crate) const SEA_M: f64 = 0.0;
pub(crate) const RADIUS_KM: f64 = 6371.0;

/// Sums of a few waves in scattered directions.
fn bumps(dir: DVec3, seed: u32) -> f64 {
    let mut sum = 0.0;
    let mut state = u64::from(seed) + 7;
    let mut next = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64 * 2.0 - 1.0
    };
    for octave in 0..7 {
        let (frequency, weight) = (2.2 * libm::pow(1.9, f64::from(octave)), libm::pow(0.6, f64::from(octave)));
        for _ in 0..6 {
            let along = DVec3::new(next(), next(), next());
            sum += weight * libm::sin(frequency * along.dot(dir) * 2.0 + 9.0 * next()) * 0.4;
        }
    }
    sum
}

/// Raises pits to their rims: receivers, and an order from mouths to springs.
fn flood(cells: &Cells, ground_m: &[f64]) -> (Vec<f64>, Vec<u32>, Vec<u32>) {
    let count = ground_m.len();
    let (mut filled, mut order) = (ground_m.to_vec(), Vec::with_capacity(count));
    let mut seen = vec![false; count];
    let mut heap: BinaryHeap<Reverse<(i64, u32)>> = BinaryHeap::new();
    let key = |height_m: f64| (height_m * 1e4) as i64;
    for cell in (0..count).filter(|&cell| ground_m[cell] < SEA_M) {
        seen[cell] = true;
        heap.push(Reverse((key(ground_m[cell]), cell as u32)));
    }
    while let Some(Reverse((_, cell))) = heap.pop() {
        order.push(cell);
        for other in cells.around(cell as usize) {
            if !std::mem::replace(&mut seen[other as usize], true) {
                let uneven = 0.02 + f64::from(other.wrapping_mul(2_654_435_761) >> 24) * 1e-3;
                filled[other as usize] = ground_m[other as usize].max(filled[cell as usize] + uneven);
                heap.push(Reverse((key(filled[other as usize]), other)));
            }
        }
    }
    let below = |a: u32, b: u32| (filled[a as usize], a) < (filled[b as usize], b);
    let receiver = (0..count as u32).map(|cell| {
        if filled[cell as usize] < SEA_M {
            return cell;
        }
        let around = cells.around(cell as usize);
        let beside = [Some((1, 3)), None, Some((1, 4)), None, None, Some((3, 6)), None, Some((4, 6))];
        let slope = |other: u32| {
            let length = cells.dirs[cell as usize].distance(cells.dirs[other as usize]);
            (filled[cell as usize] - filled[other as usize]) / length
        };
        let open = (0..8).filter(|&k| {
            let beside: Option<(usize, usize)> = beside[k];
            beside.is_none_or(|(a, b)| !below(around[a], around[k]) && !below(around[b], around[k]))
        });
        let best = open.map(|k| around[k]).max_by(|a, b| slope(*a).total_cmp(&slope(*b)).then(b.cmp(a)));
        best.filter(|&other| slope(other) > 0.0).unwrap_or(cell)
    });
    let receiver: Vec<u32> = receiver.collect();
    order.sort_by(|a, b| filled[*a as usize].total_cmp(&filled[*b as usize]).then(a.cmp(b)));
    (filled, receiver, order)
}

/// A drainage of `6 * side * side` cells of a planet as large as the Earth.
pub(crate) fn drainage(side: usize, seed: u32, steps: usize) -> Drainage {
    let (cells, radius_m) = (Cells::of(side), RADIUS_KM * 1e3);
    let count = cells.dirs.len();
    let mut ground_m: Vec<f64> = cells.dirs.iter().map(|dir| bumps(*dir, seed) * 700.0 + 100.0).collect();
    let uplift: Vec<f64> = cells.dirs.iter().map(|dir| 0.25 + bumps(*dir, seed + 1).max(0.0) * 1.5).collect();
    let mut discharge = vec![0.0; count];
    let mut receiver = Vec::new();
    for step in 0..=steps {
        let (filled, to, order) = flood(&cells, &ground_m);
        (ground_m, receiver) = (filled, to);
        let yields = |cell: usize| {
            let depth = cells.dirs[cell].abs().max_element();
            let width_km = 2.0 / side as f64 * radius_m * 1e-3;
            width_km * width_km * depth * depth * depth * 0.012
        };
        discharge = (0..count).map(yields).collect::<Vec<f64>>();
        for &cell in order.iter().rev() {
            let (cell, to) = (cell as usize, receiver[cell as usize] as usize);
            if to != cell {
                discharge[to] += discharge[cell];
            }
        }
        if step == steps {
            break;
        }
        for &cell in &order {
            let (cell, to) = (cell as usize, receiver[cell as usize] as usize);
            if to != cell {
                let length_m = cells.dirs[cell].distance(cells.dirs[to]) * radius_m;
                let wear = 1200.0 * discharge[cell].sqrt() / length_m;
                let below = ground_m[to].max(SEA_M - 30.0);
                ground_m[cell] = (ground_m[cell] + 60.0 * uplift[cell] + wear * below) / (1.0 + wear);
            }
        }
    }
    Drainage {
        side,
        height_m: ground_m.iter().map(|height_m| *height_m as f32).collect(),
        receiver,
        discharge_m3_s: discharge.iter().map(|discharge| *discharge as f32).collect(),
        lake: vec![0; count],
        lakes: Vec::new(),
        seed,
        ..Drainage::default()
    }
}

/// Drowns the country above the cell that has the greatest discharge of all between two bounds; answers that cell.
pub(crate) fn dam(drainage: &mut Drainage, discharge_m3_s: [f32; 2]) -> Option<u32> {
    let flows = |cell: &usize| drainage.receiver[*cell] as usize != *cell;
    let fits = |cell: &usize| {
        (discharge_m3_s[0]..discharge_m3_s[1]).contains(&drainage.discharge_m3_s[*cell])
            && drainage.height_m[*cell] > 50.0
    };
    let outlet = (0..drainage.height_m.len())
        .filter(flows)
        .filter(fits)
        .max_by(|a, b| drainage.discharge_m3_s[*a].total_cmp(&drainage.discharge_m3_s[*b]))?;
    let level_m = drainage.height_m[outlet];
    let mut waiting = vec![outlet as u32];
    while let Some(cell) = waiting.pop() {
        for other in 0..drainage.receiver.len() {
            if drainage.receiver[other] == cell && other as u32 != cell && drainage.height_m[other] < level_m + 150.0 {
                drainage.height_m[other] = level_m - 40.0;
                drainage.lake[other] = 1;
                waiting.push(other as u32);
            }
        }
    }
    drainage.lakes = vec![Lake { level_m: f64::from(level_m), outlet: Some(outlet as u32), area_sr: 0.0 }];
    Some(outlet as u32)
}
