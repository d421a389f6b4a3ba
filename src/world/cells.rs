//! Cells of a cube around the sphere: the grid on which world maps are solved.

use crate::sphere::raster::{cube_direction, cube_point};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The cells of six faces of `side` by `side`, face by face, row by row. The same for every planet.
pub(crate) struct Cells {
    /// Cells along the side of a face.
    pub(crate) side: usize,
    /// Unit directions of the centres.
    pub(crate) dirs: Vec<DVec3>,
    /// The eight cells around each cell. At a corner of the cube some of them coincide.
    pub(crate) neighbours: Vec<[u32; 8]>,
}

/// Time after which cells that nobody uses are forgotten.
const KEPT: Duration = Duration::from_secs(60);

/// Cells that were asked for.
struct Known {
    cells: Arc<Cells>,
    /// When they were asked for last.
    asked: Instant,
}

/// Forgets cells that nobody uses and nobody has asked for in a while.
fn forget(known: &mut BTreeMap<usize, Known>, now: Instant) {
    known.retain(|_, known| Arc::strong_count(&known.cells) > 1 || now.saturating_duration_since(known.asked) < KEPT);
}

impl Cells {
    /// The cells of a side: shared, and kept until nobody has asked for them for a while. Those of the finest side take
    /// 350 MB.
    pub(crate) fn of(side: usize) -> Arc<Cells> {
        static KNOWN: Mutex<BTreeMap<usize, Known>> = Mutex::new(BTreeMap::new());
        // Computed outside the lock: its thread pool may hand this thread other work that asks for cells.
        let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        let now = Instant::now();
        let find = |known: &mut BTreeMap<usize, Known>| {
            forget(known, now);
            let found = known.get_mut(&side)?;
            found.asked = now;
            Some(found.cells.clone())
        };
        if let Some(cells) = find(&mut known()) {
            return cells;
        }
        let cells = Arc::new(Self::new(side));
        known().entry(side).or_insert(Known { cells, asked: now }).cells.clone()
    }

    /// The eight cells around a cell, as [`Self::neighbours`] lists them. Away from the edges of faces they follow from
    /// the cell alone, without a look into a large table.
    #[inline(always)]
    pub(crate) fn around(&self, cell: usize) -> [u32; 8] {
        let side = self.side as u32;
        let (column, row) = (cell as u32 % side, cell as u32 / side % side);
        // Below zero wraps around.
        if column.wrapping_sub(1) < side.wrapping_sub(2) && row.wrapping_sub(1) < side - 2 {
            return beside(cell, self.side);
        }
        self.neighbours[cell]
    }

    /// Half the angle that a cell in the middle of a face spans: detail finer than this is not seen by the cells.
    pub(crate) fn spacing_rad(&self) -> f64 {
        1.0 / self.side as f64
    }

    fn new(side: usize) -> Self {
        let place = |cell: usize| (cell / (side * side), cell % side, cell / side % side);
        let dir = |face, x: f64, y: f64| cube_direction(face, side, x + 0.5, y + 0.5);
        let around = |cell: usize| {
            let (face, column, row) = place(cell);
            let inner = 1..side - 1;
            if inner.contains(&column) && inner.contains(&row) {
                return beside(cell, side);
            }
            let steps = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
            steps.map(|(dx, dy)| {
                let (x, y) = (column as f64 + f64::from(dx), row as f64 + f64::from(dy));
                let (face, x, y) = cube_point(dir(face, x, y), side);
                let index = |w: f64| (w as usize).min(side - 1);
                ((face * side + index(y)) * side + index(x)) as u32
            })
        };
        let center = |cell: usize| {
            let (face, column, row) = place(cell);
            dir(face, column as f64, row as f64)
        };
        let cells = 0..6 * side * side;
        Self {
            side,
            dirs: cells.clone().into_par_iter().map(center).collect(),
            neighbours: cells.into_par_iter().map(around).collect(),
        }
    }
}

/// The eight cells around one that does not lie at an edge of its face.
#[inline(always)]
fn beside(cell: usize, side: usize) -> [u32; 8] {
    let (cell, side) = (cell as u32, side as u32);
    let (above, below) = (cell - side, cell + side);
    [above - 1, above, above + 1, cell - 1, cell + 1, below - 1, below, below + 1]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_that_nobody_uses_are_forgotten_after_a_while() {
        let now = Instant::now();
        let cells = |side| Arc::new(Cells::new(side));
        let used = cells(2);
        let mut known: BTreeMap<usize, Known> = [
            (2, Known { cells: used.clone(), asked: now }),
            (4, Known { cells: cells(4), asked: now }),
            (8, Known { cells: cells(8), asked: now + KEPT }),
        ]
        .into();
        let sides = |known: &BTreeMap<usize, Known>| known.keys().copied().collect::<Vec<_>>();
        forget(&mut known, now);
        assert_eq!(sides(&known), [2, 4, 8]);
        forget(&mut known, now + KEPT);
        assert_eq!(sides(&known), [2, 8]);
        drop(used);
        forget(&mut known, now + 2 * KEPT);
        assert!(known.is_empty());
    }
}
