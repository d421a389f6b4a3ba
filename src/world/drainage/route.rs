//! Routes of water: each land cell's receiver, the discharge, and a search along the way down.

use super::flood::Filled;
use crate::world::cells::Cells;
use crate::world::grid::arc_rad;
use glam::DVec3;
use rayon::prelude::*;

/// Where water goes.
pub(super) struct Routes {
    /// The cell to which a cell's water goes; itself in the sea and at sinks.
    pub(super) receiver: Vec<u32>,
    /// Length of the way there in radians.
    pub(super) step_rad: Vec<f64>,
    /// Land cells, each after its receiver.
    pub(super) order: Vec<u32>,
}

/// For each diagonal neighbour the two neighbours between it and the cell; indices into [`Cells::neighbours`].
const BESIDE: [(usize, [usize; 2]); 4] = [(0, [1, 3]), (2, [1, 4]), (5, [3, 6]), (7, [4, 6])];

impl Routes {
    /// The steepest way down from each cell of a filled surface. Ways over two diagonals never cross.
    pub(super) fn new(cells: &Cells, nodes: &[DVec3], filled: Filled, is_sea: &[bool]) -> Self {
        let Filled { units, order } = filled;
        let steepest = |cell: usize| {
            if is_sea[cell] {
                return cell as u32;
            }
            let (here, from) = (units[cell], nodes[cell]);
            let mut best = (0.0, cell as u32);
            for &other in &cells.neighbours[cell] {
                let there = units[other as usize];
                if there < here {
                    let drop = f64::from(here - there);
                    let slope2 = drop * drop / from.distance_squared(nodes[other as usize]);
                    if slope2 > best.0 {
                        best = (slope2, other);
                    }
                }
            }
            best.1
        };
        let steep: Vec<u32> = (0..units.len()).into_par_iter().map(steepest).collect();
        let uncrossed = |cell: usize| {
            let to = steep[cell];
            for (diagonal, beside) in BESIDE {
                if cells.neighbours[cell][diagonal] != to {
                    continue;
                }
                let [a, b] = beside.map(|k| cells.neighbours[cell][k]);
                let crossing = |from: u32, into: u32| from != to && steep[from as usize] == into && from != into;
                let (from, into) = if crossing(a, b) {
                    (a, b)
                } else if crossing(b, a) {
                    (b, a)
                } else {
                    continue;
                };
                // Of two ways that cross, the one from the higher cell turns to the lower end of the other.
                let key = |cell: u32| (units[cell as usize], cell);
                if key(cell as u32) > key(from) {
                    return if key(into) < key(to) || is_sea[into as usize] {
                        into
                    } else {
                        lower(&units, to, into, cell)
                    };
                }
            }
            to
        };
        let receiver: Vec<u32> = (0..units.len()).into_par_iter().map(uncrossed).collect();
        let step_rad =
            (0..units.len()).into_par_iter().map(|cell| arc_rad(nodes[cell], nodes[receiver[cell] as usize])).collect();
        Self { receiver, step_rad, order }
    }

    /// Sums `source` of each cell and of all cells above it. Whole numbers: the order does not matter.
    pub(super) fn accumulated(&self, source: &[u64]) -> Vec<u64> {
        let mut sums = source.to_vec();
        for &cell in self.order.iter().rev() {
            let to = self.receiver[cell as usize];
            if to != cell {
                sums[to as usize] += sums[cell as usize];
            }
        }
        sums
    }
}

/// The cell `into` beside a cell if it is lower than the cell, or else the old way.
fn lower(units: &[u32], to: u32, into: u32, cell: usize) -> u32 {
    if units[into as usize] < units[cell] { into } else { to }
}

/// Pointers far down each way, so that a search along it takes a logarithmic number of steps (Myers 1983).
pub(super) struct Jumps {
    jump: Vec<u32>,
}

impl Jumps {
    pub(super) fn new(routes: &Routes) -> Self {
        let mut jump: Vec<u32> = (0..routes.receiver.len() as u32).collect();
        let mut depth = vec![0_u32; jump.len()];
        for &cell in &routes.order {
            let to = routes.receiver[cell as usize];
            if to == cell {
                continue;
            }
            let (one, two) = (jump[to as usize], jump[jump[to as usize] as usize]);
            depth[cell as usize] = depth[to as usize] + 1;
            let (d0, d1, d2) = (depth[to as usize], depth[one as usize], depth[two as usize]);
            jump[cell as usize] = if d0 - d1 == d1 - d2 { two } else { to };
        }
        Self { jump }
    }

    /// The last cell on the way down from `cell` at which `value` is above `limit`, and the next one. `value` must
    /// fall along the way, and be above the limit at the cell.
    pub(super) fn search(&self, receiver: &[u32], value: &[f64], limit: f64, cell: u32) -> (u32, u32) {
        let mut at = cell;
        loop {
            let (far, next) = (self.jump[at as usize], receiver[at as usize]);
            if far != at && value[far as usize] > limit {
                at = far;
            } else if next != at && value[next as usize] > limit {
                at = next;
            } else {
                return (at, next);
            }
        }
    }
}
