//! Cells of one level of refinement: addresses, neighbours, and the node of each cell.

use crate::sphere::raster::{cube_direction, cube_point};
use crate::world::grid::node;
use crate::world::noise::mix;
use glam::DVec3;

/// Cells are refined four by four from one level to the next.
pub(super) const RATIO: usize = 4;
/// A node lies within this share of a cell's width from the middle of its cell.
const JITTER: f64 = 0.3;

/// The cells of six faces of `side` by `side`, of one level.
#[derive(Clone, Copy, Debug)]
pub(super) struct Grid {
    pub(super) side: usize,
    pub(super) level: usize,
    pub(super) seed: u32,
}

/// A cell: its face, column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct Cell {
    pub(super) face: usize,
    pub(super) x: usize,
    pub(super) y: usize,
}

/// A direction on its face: 0 to 1 to the right and down.
#[derive(Clone, Copy, Debug)]
pub(super) struct FacePlace {
    pub(super) face: usize,
    pub(super) x: f64,
    pub(super) y: f64,
}

impl FacePlace {
    #[inline(always)]
    pub(super) fn new(dir: DVec3) -> Self {
        let (face, x, y) = cube_point(dir, 1);
        Self { face, x, y }
    }
}

/// Steps from a cell to the eight around it, in its own face.
pub(super) const STEPS: [(i32, i32); 8] = [(-1, -1), (0, -1), (1, -1), (-1, 0), (1, 0), (-1, 1), (0, 1), (1, 1)];
/// For each step that is diagonal, the two steps beside it.
pub(super) const BESIDE: [Option<(usize, usize)>; 8] =
    [Some((1, 3)), None, Some((1, 4)), None, None, Some((3, 6)), None, Some((4, 6))];

impl Grid {
    pub(super) fn new(coarsest_side: usize, level: usize, seed: u32) -> Self {
        Self { side: coarsest_side * RATIO.pow(level as u32), level, seed }
    }

    pub(super) fn index(&self, cell: Cell) -> u64 {
        ((cell.face * self.side + cell.y) * self.side + cell.x) as u64
    }

    pub(super) fn cell(&self, index: u64) -> Cell {
        let (index, side) = (index as usize, self.side);
        Cell { face: index / (side * side), x: index % side, y: index / side % side }
    }

    /// The cell that holds a direction.
    pub(super) fn cell_of(&self, dir: DVec3) -> Cell {
        self.cell_at(&FacePlace::new(dir))
    }

    /// The cell at a place.
    #[inline(always)]
    pub(super) fn cell_at(&self, place: &FacePlace) -> Cell {
        let index = |w: f64| ((w * self.side as f64) as usize).min(self.side - 1);
        Cell { face: place.face, x: index(place.x), y: index(place.y) }
    }

    /// The cell one step away, across the edges of faces too.
    pub(super) fn beside(&self, cell: Cell, (dx, dy): (i32, i32)) -> Cell {
        let (x, y) = (cell.x as i64 + i64::from(dx), cell.y as i64 + i64::from(dy));
        let side = self.side as i64;
        if (0..side).contains(&x) && (0..side).contains(&y) {
            return Cell { face: cell.face, x: x as usize, y: y as usize };
        }
        self.cell_of(cube_direction(cell.face, self.side, x as f64 + 0.5, y as f64 + 0.5))
    }

    /// The node of a cell: a direction near its middle, a pure function of seed, side, level and cell.
    pub(super) fn node(&self, cell: Cell) -> DVec3 {
        // The nodes of the solver.
        if self.level == 0 {
            return node(self.side, self.index(cell) as usize, self.seed);
        }
        let bits = mix(mix(self.index(cell) ^ (u64::from(self.seed) << 32)) ^ self.side as u64);
        let share = |bits: u64| (bits & 0xffff_ffff) as f64 * (1.0 / 4_294_967_296.0) - 0.5;
        let (jx, jy) = (share(bits) * 2.0 * JITTER, share(bits >> 32) * 2.0 * JITTER);
        cube_direction(cell.face, self.side, cell.x as f64 + 0.5 + jx, cell.y as f64 + 0.5 + jy)
    }

    /// The lesser width of a cell near a direction, as an angle. It is continuous across the edges of faces.
    pub(super) fn width_rad(&self, dir: DVec3) -> f64 {
        let depth = dir.abs().max_element();
        2.0 / self.side as f64 * (depth * depth)
    }
}
