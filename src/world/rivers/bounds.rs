//! Bounds of the ground near a direction.
//!
//! The ground is a mean of the solver's raster, of banks and of ground of coarser levels, raised by relief and cut by
//! channels. All of these come from cells a few steps away. So the range of the cells around, widened by the relief and
//! the deepest channel among them, holds for every point of a cell. Ranges of squares of cells make a quadtree.

use super::evaluate::MOST_RELIEF;
use super::grid::Cell;
use super::reach::depth_m;
use super::trunk::Trunks;
use crate::sphere::raster::cube_direction;
use crate::world::cells::Cells;
use glam::DVec3;
use rayon::prelude::*;

/// Steps between a point and the farthest cell that its ground depends on.
const RINGS: usize = 4;

/// Ranges of squares of cells, the finest first, each level half as fine.
pub(super) struct Bounds {
    levels: Vec<(usize, Vec<[f32; 2]>)>,
}

/// Bound of the discharge of a tributary by the runoff of its cell: all neighbours of neighbours flow into it.
const MOST_TRIBUTARY: f64 = 4.0;

const NOTHING: [f32; 2] = [f32::MAX, f32::MIN];

fn both(a: [f32; 2], b: [f32; 2]) -> [f32; 2] {
    [a[0].min(b[0]), a[1].max(b[1])]
}

impl Bounds {
    pub(super) fn new(trunks: &Trunks, ground_m: &[f32]) -> Self {
        let mut grid = trunks.grid;
        let cells = trunks.drainage.height_m.len();
        // The greatest relief and the deepest channel around count for the whole neighbourhood.
        let mut parts: Vec<[f32; 4]> = (0..cells).into_par_iter().map(|cell| own(trunks, ground_m, cell)).collect();
        // Two by two cells at once, where they are even: fewer and wider steps.
        let mut rings = RINGS;
        if grid.side.is_multiple_of(2) {
            let (side, half) = (grid.side, grid.side / 2);
            let four = |cell: usize| {
                let (face, x, y) = (cell / (half * half), 2 * (cell % half), 2 * (cell / half % half));
                let at = |dx: usize, dy: usize| parts[(face * side + y + dy) * side + x + dx];
                [at(1, 0), at(0, 1), at(1, 1)].into_iter().fold(at(0, 0), joined)
            };
            parts = (0..6 * half * half).into_par_iter().map(four).collect();
            (grid.side, rings) = (half, RINGS.div_ceil(2));
        }
        let cells = Cells::of(grid.side);
        for _ in 0..rings {
            let widest = |cell: usize| {
                let around = cells.around(cell);
                around.iter().fold(parts[cell], |part, &other| joined(part, parts[other as usize]))
            };
            parts = (0..parts.len()).into_par_iter().with_min_len(1024).map(widest).collect();
        }
        let widened = |[low, high, relief, depth]: &[f32; 4]| [low - depth - 0.01, high + relief + 0.01];
        let ranges: Vec<[f32; 2]> = parts.iter().map(widened).collect();
        let mut levels = vec![(grid.side, ranges)];
        while let Some((side, ranges)) = levels.last()
            && *side > 1
        {
            let (side, half) = (*side, side.div_ceil(2));
            let mut coarser = vec![NOTHING; 6 * half * half];
            for (cell, range) in ranges.iter().enumerate() {
                let (face, x, y) = (cell / (side * side), cell % side, cell / side % side);
                let slot = &mut coarser[(face * half + y / 2) * half + x / 2];
                *slot = both(*slot, *range);
            }
            levels.push((half, coarser));
        }
        Self { levels }
    }

    /// Lowest and greatest height within an angle of a unit direction.
    pub(super) fn near(&self, dir: DVec3, angle_rad: f64) -> (f64, f64) {
        let mut found = NOTHING;
        if let Some(top) = self.levels.len().checked_sub(1) {
            for face in 0..6 {
                self.descend(top, Cell { face, x: 0, y: 0 }, dir, angle_rad, &mut found);
            }
        }
        (f64::from(found[0]), f64::from(found[1]))
    }

    fn descend(&self, level: usize, at: Cell, dir: DVec3, angle_rad: f64, found: &mut [f32; 2]) {
        let (side, ranges) = &self.levels[level];
        let Some(range) = ranges.get((at.face * side + at.y) * side + at.x).filter(|_| at.x < *side && at.y < *side)
        else {
            return;
        };
        // Squares of an uneven side may end beyond the face.
        let finest = self.levels[0].0 as f64;
        let width = f64::from(1_u32 << level);
        let point = |x: f64, y: f64| cube_direction(at.face, self.levels[0].0, x.min(finest), y.min(finest));
        let (x, y) = (at.x as f64 * width, at.y as f64 * width);
        let middle = point(x + 0.5 * width, y + 0.5 * width);
        let corners = [point(x, y), point(x + width, y), point(x, y + width), point(x + width, y + width)];
        let chord = corners.iter().map(|corner| corner.distance(middle)).fold(0.0, f64::max);
        let radius_rad = 2.0 * libm::asin((0.5 * chord).min(1.0)) * 1.05 + 1e-9;
        let distance_rad = 2.0 * libm::asin((0.5 * dir.distance(middle)).min(1.0));
        if distance_rad > angle_rad + radius_rad || (range[0] >= found[0] && range[1] <= found[1]) {
            return;
        }
        if level == 0 || distance_rad + radius_rad <= angle_rad || radius_rad < 0.25 * angle_rad {
            *found = both(*found, *range);
            return;
        }
        for (dx, dy) in [(0, 0), (1, 0), (0, 1), (1, 1)] {
            self.descend(level - 1, Cell { face: at.face, x: 2 * at.x + dx, y: 2 * at.y + dy }, dir, angle_rad, found);
        }
    }
}

/// The widest of two parts.
fn joined([low, high, relief, depth]: [f32; 4], other: [f32; 4]) -> [f32; 4] {
    [low.min(other[0]), high.max(other[1]), relief.max(other[2]), depth.max(other[3])]
}

/// What a cell adds to the ground around it: its lowest and highest bank or ground, relief and depth of channels.
fn own(trunks: &Trunks, ground_m: &[f32], cell: usize) -> [f32; 4] {
    let height_m = f64::from(trunks.drainage.height_m[cell]);
    let ([start_m, end_m], [first, last], _) = trunks.ends(cell).unwrap_or(([height_m; 2], [0.0; 2], false));
    let trunk = first.max(last);
    let most = trunk.max(MOST_TRIBUTARY * f64::from(trunks.runoff_m3_s[cell]));
    let relief_m = MOST_RELIEF * f64::from(trunks.relief_m[cell]);
    let all = [height_m.min(end_m).min(f64::from(ground_m[cell])), height_m.max(start_m), relief_m, depth_m(most)];
    all.map(|value| value as f32)
}
