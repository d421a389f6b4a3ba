//! Cells of a cube around the sphere: the grid on which world maps are solved.

use crate::sphere::raster::{cube_direction, cube_point};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError, Weak};

/// The cells of six faces of `side` by `side`, face by face, row by row. The same for every planet.
pub(crate) struct Cells {
    /// Cells along the side of a face.
    pub(crate) side: usize,
    /// Unit directions of the centres.
    pub(crate) dirs: Vec<DVec3>,
    /// What [`Cells::around`] answers at the edges of faces, by [`edge_cell`].
    edges: Vec<[u32; 8]>,
}

/// Sides up to here are kept: drafts solve maps on them many times a second, and all of them together take few MB.
const KEPT_SIDE: usize = 64;

/// Cells that somebody holds, and those of small sides.
#[derive(Default)]
struct Known {
    held: BTreeMap<usize, Weak<Cells>>,
    small: Vec<Arc<Cells>>,
}

impl Known {
    fn find(&self, side: usize) -> Option<Arc<Cells>> {
        self.held.get(&side)?.upgrade()
    }

    /// The cells of a side: those that are known, else `cells`.
    fn add(&mut self, cells: Arc<Cells>) -> Arc<Cells> {
        if let Some(found) = self.find(cells.side) {
            return found;
        }
        self.held.retain(|_, cells| cells.strong_count() > 0);
        self.held.insert(cells.side, Arc::downgrade(&cells));
        if cells.side <= KEPT_SIDE {
            self.small.push(cells.clone());
        }
        cells
    }
}

impl Cells {
    /// The cells of a side. They are shared while somebody holds them, as a solved map does with those that it reads;
    /// those of the finest side take 150 MB.
    pub(crate) fn of(side: usize) -> Arc<Cells> {
        static KNOWN: Mutex<Known> = Mutex::new(Known { held: BTreeMap::new(), small: Vec::new() });
        // Computed outside the lock: its thread pool may hand this thread other work that asks for cells.
        let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(cells) = known().find(side) {
            return cells;
        }
        let cells = Arc::new(Self::new(side));
        known().add(cells)
    }

    /// The eight cells around a cell, row by row. At a corner of the cube some of them coincide.
    #[inline(always)]
    pub(crate) fn around(&self, cell: usize) -> [u32; 8] {
        let side = self.side as u32;
        let (column, row) = (cell as u32 % side, cell as u32 / side % side);
        // Below zero wraps around.
        if column.wrapping_sub(1) < side.wrapping_sub(2) && row.wrapping_sub(1) < side - 2 {
            return beside(cell, self.side);
        }
        self.edges[edge_cell(cell, self.side)]
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
        let mut edges = vec![[0; 8]; 6 * 4 * side];
        for cell in cells.clone() {
            let (_, column, row) = place(cell);
            if [column, row].iter().any(|at| [0, side - 1].contains(at)) {
                edges[edge_cell(cell, side)] = around(cell);
            }
        }
        Self { side, dirs: cells.into_par_iter().map(center).collect(), edges }
    }
}

/// Number of a cell at an edge of its face: below `4 * side` on each face.
fn edge_cell(cell: usize, side: usize) -> usize {
    let (face, column, row) = (cell / (side * side), cell % side, cell / side % side);
    let at = match row {
        0 => column,
        _ if row == side - 1 => side + column,
        _ if column == 0 => 2 * side + row,
        _ => 3 * side + row,
    };
    4 * side * face + at
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
    fn cells_around_a_cell_touch_it_and_lie_around_each_other() {
        for side in [1, 2, 3, 16] {
            let cells = Cells::new(side);
            let far = 2.9 * std::f64::consts::FRAC_PI_4 / side as f64 * std::f64::consts::SQRT_2;
            for cell in 0..cells.dirs.len() {
                for other in cells.around(cell) {
                    let other = other as usize;
                    assert!(cells.dirs[cell].angle_between(cells.dirs[other]) < far, "{side}: {cell} {other}");
                    assert!(side < 3 || cells.around(other).contains(&(cell as u32)), "{side}: {cell} {other}");
                }
            }
        }
    }

    #[test]
    fn cells_are_shared_while_somebody_holds_them_and_small_ones_always() {
        let mut known = Known::default();
        let [small, large] = [KEPT_SIDE, KEPT_SIDE + 1].map(|side| Arc::new(Cells::new(side)));
        for cells in [&small, &large] {
            known.add(cells.clone());
            assert!(Arc::ptr_eq(cells, &known.add(Arc::new(Cells::new(cells.side)))));
        }
        drop((small, large));
        assert!(known.find(KEPT_SIDE).is_some() && known.find(KEPT_SIDE + 1).is_none());
    }
}
