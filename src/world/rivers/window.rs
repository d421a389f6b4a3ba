//! The cells of a square and of some rings around it.

use super::block::Square;
use super::grid::{Cell, Grid, STEPS};
use std::collections::BTreeMap;

pub(super) struct Window {
    /// Cells, each with its ring: 0 in the square.
    pub(super) cells: Vec<(Cell, u8)>,
    /// Positions of the eight around each cell; of the last ring they mean nothing.
    pub(super) around: Vec<[u32; 8]>,
}

impl Window {
    pub(super) fn new(grid: &Grid, square: &Square, rings: usize) -> Self {
        Self::inside(grid, square, rings).unwrap_or_else(|| Self::across(grid, square, rings))
    }

    /// A window within a face, row by row. None if it reaches beyond.
    fn inside(grid: &Grid, square: &Square, rings: usize) -> Option<Self> {
        let side = square.side + 2 * rings;
        let (left, top) = (square.left.checked_sub(rings)?, square.top.checked_sub(rings)?);
        if left.max(top) + side > grid.side {
            return None;
        }
        let ring = |k: usize| rings.saturating_sub(k).max((k + 1).saturating_sub(rings + square.side));
        let cell = |at: usize| {
            let (x, y) = (at % side, at / side);
            (Cell { face: square.face, x: left + x, y: top + y }, ring(x).max(ring(y)) as u8)
        };
        let beside = |at: usize| STEPS.map(|(x, y)| (at as i32 + y * side as i32 + x) as u32);
        let all = 0..side * side;
        Some(Self { cells: all.clone().map(cell).collect(), around: all.map(beside).collect() })
    }

    /// A window that reaches across the edges of its face, ring by ring.
    fn across(grid: &Grid, square: &Square, rings: usize) -> Self {
        let mut cells: Vec<(Cell, u8)> = square.cells(grid).map(|cell| (cell, 0)).collect();
        let mut positions: BTreeMap<u64, u32> = cells.iter().map(|(cell, _)| grid.index(*cell)).zip(0..).collect();
        let mut first = 0;
        for ring in 1..=rings {
            let last = cells.len();
            for at in first..last {
                for step in STEPS {
                    let cell = grid.beside(cells[at].0, step);
                    positions.entry(grid.index(cell)).or_insert_with(|| {
                        cells.push((cell, ring as u8));
                        cells.len() as u32 - 1
                    });
                }
            }
            first = last;
        }
        let position = |cell: Cell| positions.get(&grid.index(cell)).copied().unwrap_or(0);
        let around = cells.iter().map(|(cell, _)| STEPS.map(|step| position(grid.beside(*cell, step)))).collect();
        Self { cells, around }
    }
}

#[cfg(test)]
mod tests {
    use super::super::block::BLOCK;
    use super::*;

    #[test]
    fn a_window_is_the_same_however_it_is_found() {
        let grid = Grid::new(64, 1, 7);
        let square = Square { face: 2, left: 32, top: 80, side: BLOCK };
        let (inside, across) = (Window::inside(&grid, &square, 3).unwrap(), Window::across(&grid, &square, 3));
        let around = |window: &Window| -> BTreeMap<u64, (u8, [u64; 8])> {
            let index = |at: u32| grid.index(window.cells[at as usize].0);
            let inner = window.cells.iter().zip(&window.around).filter(|((_, ring), _)| *ring < 3);
            inner.map(|((cell, ring), around)| (grid.index(*cell), (*ring, around.map(index)))).collect()
        };
        assert_eq!((inside.cells.len(), across.cells.len()), (22 * 22, 22 * 22));
        assert_eq!(around(&inside), around(&across));
        let corner = Square::of_cell(Cell { face: 0, x: 0, y: 0 });
        assert!(Window::inside(&grid, &corner, 3).is_none());
    }
}
