//! Values at cells: true areas, jittered nodes, finer and coarser grids.

use super::cells::Cells;
use super::noise::{hash, unit};
use crate::sphere::raster::{cube_direction, cube_point};
use glam::DVec3;
use rayon::prelude::*;

/// How far a node may lie from the middle of its cell, as a share of the cell's side. Below a quarter, four nodes
/// around a corner always make a convex quadrilateral, so that edges between neighbours cross only as two diagonals.
pub(crate) const JITTER: f64 = 0.24;

/// The solid angle of each cell.
pub(crate) fn areas_sr(side: usize) -> Vec<f64> {
    let step = 2.0 / side as f64;
    let face: Vec<f64> = (0..side * side)
        .map(|i| {
            let along = |k: usize| (k as f64 + 0.5) * step - 1.0;
            let (s, t) = (along(i % side), along(i / side));
            let d2 = 1.0 + s * s + t * t;
            step * step / (d2 * d2.sqrt())
        })
        .collect();
    face.repeat(6)
}

/// The unit direction of the node of a cell: the middle, moved by a hash of the seed, the side and the cell.
pub(crate) fn node(side: usize, cell: usize, seed: u32) -> DVec3 {
    let h = hash(hash(seed, side as u32), cell as u32);
    let shift = |bits: u32| (unit(bits) - 0.5) * (2.0 * JITTER);
    let (column, row) = (cell % side, cell / side % side);
    let (x, y) = (column as f64 + 0.5 + shift(h), row as f64 + 0.5 + shift(hash(h, 1)));
    cube_direction(cell / (side * side), side, x, y)
}

/// The cell that holds a unit direction.
pub(crate) fn cell_at(side: usize, dir: DVec3) -> usize {
    let (face, x, y) = cube_point(dir, side);
    let index = |w: f64| (w as usize).min(side - 1);
    (face * side + index(y)) * side + index(x)
}

/// The length of the arc between two unit directions that are near to each other.
pub(crate) fn arc_rad(a: DVec3, b: DVec3) -> f64 {
    let chord2 = a.distance_squared(b);
    chord2.sqrt() * (1.0 + chord2 * (1.0 / 24.0))
}

/// The four cells of the grid of twice the side that lie in a cell: along rows first.
pub(crate) fn children(side: usize, cell: usize) -> [usize; 4] {
    let (face, column, row) = (cell / (side * side), cell % side, cell / side % side);
    let first = (face * 2 * side + 2 * row) * 2 * side + 2 * column;
    [first, first + 1, first + 2 * side, first + 2 * side + 1]
}

/// The cell of the grid of half the side that holds a cell.
pub(crate) fn parent(side: usize, cell: usize) -> usize {
    let (face, column, row) = (cell / (side * side), cell % side, cell / side % side);
    (face * (side / 2) + row / 2) * (side / 2) + column / 2
}

/// The three neighbours of a parent that lie on the side of its child number `quarter`: along the row, along the
/// column, across the corner. Indices into [`Cells::around`].
const TOWARDS: [[usize; 3]; 4] = [[3, 1, 0], [4, 1, 2], [3, 6, 5], [4, 6, 7]];

/// Values on the grid of twice the side, bilinear between the middles of cells.
pub(crate) fn refined(cells: &Cells, values: &[f64]) -> Vec<f64> {
    let side = 2 * cells.side;
    (0..6 * side * side)
        .into_par_iter()
        .map(|child| {
            let cell = parent(side, child);
            let quarter = (child % side) % 2 + 2 * ((child / side % side) % 2);
            let around = cells.around(cell);
            let [row, column, corner] = TOWARDS[quarter].map(|k| values[around[k] as usize]);
            (9.0 * values[cell] + 3.0 * (row + column) + corner) * (1.0 / 16.0)
        })
        .collect()
}

/// Means over each cell and its neighbours, `rounds` times.
pub(crate) fn smoothed(cells: &Cells, values: &[f64], rounds: usize) -> Vec<f64> {
    let mut values = values.to_vec();
    for _ in 0..rounds {
        let mean = |cell: usize| {
            let around: f64 = cells.around(cell).iter().map(|&other| values[other as usize]).sum();
            (2.0 * values[cell] + around) * 0.1
        };
        values = (0..values.len()).into_par_iter().map(mean).collect();
    }
    values
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn areas_cover_the_sphere() {
        let sum: f64 = areas_sr(32).iter().sum();
        assert!((sum / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3, "{sum}");
    }

    #[test]
    fn children_and_parents_agree_and_a_finer_grid_is_smooth() {
        let cells = Cells::of(16);
        for cell in 0..6 * 16 * 16 {
            assert!(children(16, cell).iter().all(|&child| parent(32, child) == cell));
        }
        let plane = |d: &DVec3| d.dot(DVec3::new(0.3, -0.5, 0.8));
        let fine = refined(&cells, &cells.dirs.iter().map(plane).collect::<Vec<_>>());
        let worst = Cells::of(32).dirs.iter().zip(&fine).map(|(d, v)| (plane(d) - v).abs()).fold(0.0, f64::max);
        assert!(worst < 0.03, "{worst}");
    }

    #[test]
    fn nodes_stay_in_their_cells() {
        let cells = Cells::of(32);
        for (cell, dir) in cells.dirs.iter().enumerate() {
            assert!(arc_rad(*dir, node(32, cell, 7)) < 2.0 / 32.0 * 0.5);
        }
    }
}
