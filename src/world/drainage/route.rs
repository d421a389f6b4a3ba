//! Routes of water: each land cell's receiver, the discharge, and a search along the way down.

use super::Level;
use crate::world::cells::Cells;
use crate::world::grid::arc_rad;
use glam::DVec3;
use rayon::prelude::*;
use std::ops::Range;

/// Where water goes. Positions are indices into `order`.
pub(super) struct Routes {
    /// The cell to which a cell's water goes; itself in the sea and at sinks.
    pub(super) receiver: Vec<u32>,
    /// Land cells, basin by basin, each after its receiver and near to it.
    pub(super) order: Vec<u32>,
    /// The position of each receiver; the own position where that is in the sea, and at sinks.
    pub(super) below: Vec<u32>,
    /// Length of the way to the receiver in radians, by position.
    pub(super) step_rad: Vec<f64>,
    /// Positions of whole basins, some thousand cells at a time: the shares of threads.
    pub(super) groups: Vec<Range<usize>>,
}

/// For each diagonal neighbour the two neighbours between it and the cell; indices into [`Cells::neighbours`].
const BESIDE: [(usize, [usize; 2]); 4] = [(0, [1, 3]), (2, [1, 4]), (5, [3, 6]), (7, [4, 6])];

/// Least cells of a group of basins.
const GROUP: usize = 2048;

const NONE: u32 = u32::MAX;

impl Routes {
    /// The steepest way down from each cell of a filled surface, or the way of a course that is drawn by hand. Ways
    /// over two diagonals never cross.
    pub(super) fn new(cells: &Cells, nodes: &[DVec3], units: &[u32], level: &Level<'_>) -> Self {
        let Level { land, is_sea, forced, .. } = level;
        let steepest = |cell: usize| {
            if is_sea[cell] {
                return cell as u32;
            }
            if let Some(to) = forced.receiver(cell, units) {
                return to;
            }
            let (here, from) = (units[cell], nodes[cell]);
            let mut best = (0.0, cell as u32);
            for other in cells.around(cell) {
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
        let steep: Vec<u32> = (0..units.len()).into_par_iter().with_min_len(4096).map(steepest).collect();
        let uncrossed = |cell: usize| {
            let to = steep[cell];
            if to as usize == cell {
                return to;
            }
            let around = cells.around(cell);
            for (diagonal, beside) in BESIDE {
                if around[diagonal] != to {
                    continue;
                }
                let [a, b] = beside.map(|k| around[k]);
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
                let is_forced = |cell: usize| forced.receiver(cell, units).is_some();
                // A drawn course stays, unless the other way begins below it.
                let turns = match (is_forced(cell), is_forced(from as usize)) {
                    (true, false) => units[from as usize] <= units[to as usize],
                    (false, true) => units[cell] > units[into as usize],
                    _ => key(cell as u32) > key(from),
                };
                if turns {
                    return if key(into) < key(to) || is_sea[into as usize] {
                        into
                    } else {
                        lower(units, to, into, cell)
                    };
                }
            }
            to
        };
        let receiver: Vec<u32> = (0..units.len()).into_par_iter().with_min_len(4096).map(uncrossed).collect();
        let mut routes = Self::ordered(receiver, land, is_sea);
        let step = |&cell: &u32| arc_rad(nodes[cell as usize], nodes[routes.receiver[cell as usize] as usize]);
        routes.step_rad = routes.order.par_iter().with_min_len(4096).map(step).collect();
        routes
    }

    /// Orders land cells: from each outlet up its tree. A cell from which no way leads to an outlet is left out.
    pub(super) fn ordered(receiver: Vec<u32>, land: &[u32], is_sea: &[bool]) -> Self {
        // Lists of the cells that flow into each cell.
        let (mut first, mut next) = (vec![NONE; receiver.len()], vec![NONE; receiver.len()]);
        let mut outlets = Vec::new();
        for &cell in land.iter().rev() {
            let to = receiver[cell as usize];
            if to == cell || is_sea[to as usize] {
                outlets.push(cell);
            } else {
                next[cell as usize] = std::mem::replace(&mut first[to as usize], cell);
            }
        }
        let (mut order, mut below) = (Vec::with_capacity(land.len()), Vec::with_capacity(land.len()));
        let (mut groups, mut start, mut waiting) = (Vec::new(), 0, Vec::new());
        for &outlet in outlets.iter().rev() {
            waiting.push((outlet, order.len() as u32));
            while let Some((cell, to)) = waiting.pop() {
                let position = order.len() as u32;
                order.push(cell);
                below.push(to);
                let mut other = first[cell as usize];
                while other != NONE {
                    waiting.push((other, position));
                    other = next[other as usize];
                }
            }
            if order.len() >= start + GROUP {
                groups.push(start..order.len());
                start = order.len();
            }
        }
        groups.push(start..order.len());
        Self { receiver, order, below, step_rad: Vec::new(), groups }
    }

    /// By position: the sum of `source`, which is given by cell, over each cell and all cells above it.
    pub(super) fn accumulated(&self, source: &[u64]) -> Vec<u64> {
        let group = |group: &Range<usize>| {
            let mut sums: Vec<u64> = self.order[group.clone()].iter().map(|&cell| source[cell as usize]).collect();
            for at in (0..sums.len()).rev() {
                let to = self.below[group.start + at] as usize - group.start;
                if to != at {
                    sums[to] += sums[at];
                }
            }
            sums
        };
        self.groups.par_iter().map(group).collect::<Vec<_>>().concat()
    }

    /// Sums by cell from those by position; a cell of the sea has what flows into it.
    pub(super) fn by_cell(&self, sums: &[u64]) -> Vec<u64> {
        let mut values = vec![0; self.receiver.len()];
        for (at, (&cell, &sum)) in self.order.iter().zip(sums).enumerate() {
            values[cell as usize] = sum;
            let to = self.receiver[cell as usize];
            if self.below[at] as usize == at && to != cell {
                values[to as usize] += sum;
            }
        }
        values
    }
}

/// The cell `into` beside a cell if it is lower than the cell, or else the old way.
fn lower(units: &[u32], to: u32, into: u32, cell: usize) -> u32 {
    if units[into as usize] < units[cell] { into } else { to }
}

/// Pointers far down each way of a group, so that a search along it takes a logarithmic number of steps (Myers 1983).
/// Positions count from the start of the group.
pub(super) struct Jumps {
    jump: Vec<u32>,
}

impl Jumps {
    pub(super) fn new(below: &[u32]) -> Self {
        let mut jump: Vec<u32> = Vec::with_capacity(below.len());
        let mut depth: Vec<u32> = Vec::with_capacity(below.len());
        for (at, &to) in below.iter().enumerate() {
            if to as usize == at {
                jump.push(to);
                depth.push(0);
                continue;
            }
            let one = jump[to as usize];
            let two = jump[one as usize];
            let (d0, d1, d2) = (depth[to as usize], depth[one as usize], depth[two as usize]);
            depth.push(d0 + 1);
            jump.push(if d0 - d1 == d1 - d2 { two } else { to });
        }
        Self { jump }
    }

    /// The last position on the way down from `at` at which `value` is above `limit`, and the next one, or the same at
    /// an outlet. `value` must fall along the way, and be above the limit at the start.
    pub(super) fn search(
        &self,
        below: &[u32],
        value: impl Fn(usize) -> f64,
        limit: f64,
        mut at: usize,
    ) -> (usize, usize) {
        loop {
            let (far, next) = (self.jump[at] as usize, below[at] as usize);
            if far != at && value(far) > limit {
                at = far;
            } else if next != at && value(next) > limit {
                at = next;
            } else {
                return (at, next);
            }
        }
    }
}
