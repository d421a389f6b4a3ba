//! The lattice of the ground: on each face of the cube the points of a level, in blocks of 16 by 16 cells.
//!
//! It is fixed to the planet: a block has the same vertices, to the bit, whichever patch asks and whatever it asked
//! before. Neighbours share their borders, over the edges of faces too. The borders of cells lie on great circles, as
//! do the edges of triangles seen from the centre: what is over a cell is over its two triangles.

use crate::sphere::{Face, cube};
use glam::DVec3;

/// Cells along the side of a block.
pub(super) const QUADS: usize = 16;
/// The finest level: 2³⁰ cells along a face, a tenth of a metre on the largest planets.
const FINEST: u8 = 26;

/// A block of the lattice: its level, face, column and row.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub(super) struct BlockId {
    pub(super) level: u8,
    pub(super) face: Face,
    pub(super) x: u32,
    pub(super) y: u32,
}

/// Cells of a block: from and up to (exclusively) a column and a row.
#[derive(Clone, Copy, Debug)]
pub(super) struct Span {
    pub(super) id: BlockId,
    pub(super) columns: [usize; 2],
    pub(super) rows: [usize; 2],
}

/// Mean width of a cell of a level.
pub(super) fn cell_m(level: u8, radius_m: f64) -> f64 {
    std::f64::consts::FRAC_PI_2 * radius_m / cells(level)
}

/// Cells along the side of a face.
fn cells(level: u8) -> f64 {
    QUADS as f64 * f64::from(1_u32 << level)
}

/// The coarsest level whose cells are on average no wider than this. What is no number above 0 has the finest.
pub(super) fn level_of(width_m: f64, radius_m: f64) -> u8 {
    (0..FINEST).find(|level| cell_m(*level, radius_m) <= width_m).unwrap_or(FINEST)
}

impl BlockId {
    /// Direction of a vertex, column and row 0 to [`QUADS`].
    pub(super) fn direction(self, column: usize, row: usize) -> DVec3 {
        let along = |block: u32, vertex: usize| {
            (f64::from(block) * QUADS as f64 + vertex as f64) * 2.0 / cells(self.level) - 1.0
        };
        cube::direction(self.face, along(self.x, column), along(self.y, row))
    }
}

/// The cell of a level over which a position lies.
pub(super) fn cell_under(level: u8, position_m: DVec3) -> (BlockId, [usize; 2]) {
    let (face, s, t) = cube::face_point(position_m);
    let [column, row] = [s, t].map(|w| cell_at(level, w));
    let quads = QUADS as u64;
    let id = BlockId { level, face, x: (column / quads) as u32, y: (row / quads) as u32 };
    (id, [(column % quads) as usize, (row % quads) as usize])
}

fn cell_at(level: u8, w: f64) -> u64 {
    let all = cells(level);
    ((w + 1.0) * 0.5 * all).clamp(0.0, all - 1.0) as u64
}

/// The cells that a cone around a direction covers, and perhaps some more. `share`: sine of the cone's angle; of a cone
/// of nearly a right angle or more, all cells.
pub(super) fn spans_under(level: u8, middle: DVec3, share: f64, spans: &mut Vec<Span>) {
    spans.clear();
    let wide = cube::tangent_of(share);
    for face in Face::ALL {
        let Some([s, t]) = cube::part_under(face, middle, wide) else { continue };
        let [columns, rows] = [s, t].map(|w| w.map(|w| cell_at(level, w)));
        let quads = QUADS as u64;
        for y in rows[0] / quads..=rows[1] / quads {
            for x in columns[0] / quads..=columns[1] / quads {
                let inside = |range: [u64; 2], block: u64| {
                    [
                        range[0].max(block * quads) - block * quads,
                        range[1].min(block * quads + quads - 1) + 1 - block * quads,
                    ]
                    .map(|cell| cell as usize)
                };
                let id = BlockId { level, face, x: x as u32, y: y as u32 };
                spans.push(Span { id, columns: inside(columns, x), rows: inside(rows, y) });
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::{Tangent, spread};
    use std::collections::HashSet;

    #[test]
    fn a_ball_lies_over_the_cells_that_are_found() {
        const RADIUS_M: f64 = 40_000.0;
        let edges = [DVec3::new(1.0, 1.0, 0.3), DVec3::new(1.0, -1.0, 1.0), DVec3::new(-1.0, 0.2, 0.9999)];
        let mut spans = Vec::new();
        let mut over_edges = 0;
        for (number, dir) in spread(60).chain(edges.map(DVec3::normalize)).enumerate() {
            let tangent = Tangent::new(dir);
            for reach_m in [0.5, 30.0, 2000.0] {
                let level = level_of(0.25 * reach_m, RADIUS_M);
                spans_under(level, dir, reach_m / RADIUS_M, &mut spans);
                let cells: usize = spans.iter().map(|s| (s.columns[1] - s.columns[0]) * (s.rows[1] - s.rows[0])).sum();
                assert!(cells < 700, "{number} {reach_m}: {cells}");
                over_edges += usize::from(spans.iter().any(|span| span.id.face != spans[0].id.face));
                for i in 0..400 {
                    let (sin, cos) = libm::sincos(f64::from(i));
                    let away_m = reach_m * libm::sqrt(f64::from(i % 20) / 19.0) * 0.999_999;
                    let at_m = dir * RADIUS_M + tangent.planet(DVec3::new(sin, cos, 0.0)) * away_m;
                    let (id, [column, row]) = cell_under(level, at_m);
                    let is_found = |span: &Span| {
                        let within = |range: [usize; 2], at: usize| (range[0]..range[1]).contains(&at);
                        span.id == id && within(span.columns, column) && within(span.rows, row)
                    };
                    assert!(spans.iter().any(is_found), "{number} {reach_m} {id:?}");
                }
            }
        }
        assert!(over_edges > 3, "{over_edges}");
    }

    #[test]
    fn cells_are_as_wide_as_is_said_and_none_is_met_twice() {
        for radius_m in [1000.0, 6_371_000.0, 1e8] {
            let level = level_of(0.25, radius_m);
            assert!(cell_m(level, radius_m) <= 0.25 && cell_m(level, radius_m) > 0.12, "{radius_m}");
            let (id, [column, row]) = cell_under(level, DVec3::new(0.3, -0.5, 0.9) * radius_m);
            let [a, b] = [id.direction(column, row), id.direction(column + 1, row)];
            let wide = a.distance(b) * radius_m / cell_m(level, radius_m);
            assert!(wide > 0.6 && wide < 1.6, "{wide}");
        }
        assert_eq!((level_of(f64::NAN, 1e6), level_of(0.0, 1e6), level_of(1e9, 1e6)), (FINEST, FINEST, 0));
        // All of the globe, for a ball that holds the centre.
        let mut spans = Vec::new();
        spans_under(1, DVec3::X, 2.0, &mut spans);
        assert_eq!(spans.iter().map(|span| span.id).collect::<HashSet<_>>().len(), 24);
    }
}
