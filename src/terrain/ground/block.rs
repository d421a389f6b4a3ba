//! A block of ground: exact heights on its part of the lattice, and triangles between them.

use super::convex::Triangle;
use super::lattice::{BlockId, QUADS};
use crate::terrain::Terrain;
use crate::terrain::query::Scratch;
use glam::DVec3;

/// Vertices along a side.
const SIDE: usize = QUADS + 1;

/// The vertices of a block, and bounds of its cells.
pub(super) struct Block {
    pub(super) id: BlockId,
    /// Row by row, in the planet frame.
    vertices_m: Vec<DVec3>,
    /// A ball around each cell: its middle and its radius.
    balls_m: Vec<(DVec3, f64)>,
    /// Greatest distance of a vertex from the centre of the planet.
    pub(super) top_m: f64,
    /// How far the triangles may lie from the ground: see [`Block::measured_m`].
    pub(super) deviation_m: f64,
    /// The question that needed it last.
    pub(super) asked: u64,
}

impl Block {
    /// Resident size of a block.
    pub(super) const BYTES: usize = SIDE * SIDE * size_of::<DVec3>() + QUADS * QUADS * size_of::<(DVec3, f64)>();

    pub(super) fn new(id: BlockId, terrain: &Terrain, scratch: &mut Scratch) -> Self {
        let dirs: Vec<DVec3> = (0..SIDE * SIDE).map(|i| id.direction(i % SIDE, i / SIDE)).collect();
        let mut heights_m = vec![0.0; dirs.len()];
        terrain.heights_spaced_into(&dirs, 0.0, &mut heights_m, scratch);
        let radius_m = terrain.planet().radius_m();
        let vertices_m: Vec<DVec3> =
            dirs.iter().zip(&heights_m).map(|(dir, height_m)| *dir * (radius_m + height_m)).collect();
        let ball = |cell: usize| {
            let corners = corners(cell % QUADS, cell / QUADS).map(|vertex| vertices_m[vertex]);
            let middle_m = 0.25 * corners.iter().sum::<DVec3>();
            (middle_m, corners.iter().map(|corner| corner.distance(middle_m)).fold(0.0, f64::max))
        };
        let balls_m = (0..QUADS * QUADS).map(ball).collect();
        let top_m = radius_m + heights_m.iter().copied().fold(f64::MIN, f64::max);
        let deviation_m = Self::measured_m(&vertices_m);
        Self { id, vertices_m, balls_m, top_m, deviation_m, asked: 0 }
    }

    /// Twice the greatest deviation of a vertex from the chord between its neighbours on the lattice twice as coarse.
    /// The ground between vertices deviates by an eighth of that where it is smooth, and by all of it where a ridge
    /// passes close to a vertex.
    fn measured_m(vertices_m: &[DVec3]) -> f64 {
        let vertex = |column: usize, row: usize| vertices_m[row * SIDE + column];
        let mut greatest_m = 0.0_f64;
        for row in 0..SIDE {
            for column in (0..SIDE).filter(|column| column % 2 == 1 || row % 2 == 1) {
                // Beside it, above and below it, or along the diagonal.
                let (along, up) = (column % 2, row % 2);
                let chord_m = 0.5 * (vertex(column - along, row - up) + vertex(column + along, row + up));
                greatest_m = greatest_m.max((vertex(column, row).length() - chord_m.length()).abs());
            }
        }
        2.0 * greatest_m
    }

    /// The two triangles of a cell.
    pub(super) fn triangles(&self, column: usize, row: usize) -> [Triangle; 2] {
        let [a, b, c, d] = corners(column, row).map(|vertex| self.vertices_m[vertex]);
        [Triangle([a, b, c]), Triangle([a, c, d])]
    }

    /// Distance of the triangles from the centre of the planet, in a direction over a cell.
    pub(super) fn ground_m(&self, [column, row]: [usize; 2], dir: DVec3) -> f64 {
        let [a, b, c, d] = corners(column, row).map(|vertex| self.vertices_m[vertex]);
        // The side of the diagonal, seen from the centre.
        let third = if a.cross(c).dot(dir) > 0.0 { d } else { b };
        let normal = (third - a).cross(c - a);
        normal.dot(a) / normal.dot(dir)
    }

    /// A ball around a cell: its middle and its radius.
    pub(super) fn ball_m(&self, column: usize, row: usize) -> (DVec3, f64) {
        self.balls_m[row * QUADS + column]
    }
}

/// Indices of the vertices around a cell, anticlockwise from its lower corner.
fn corners(column: usize, row: usize) -> [usize; 4] {
    let first = row * SIDE + column;
    [first, first + 1, first + SIDE + 1, first + SIDE]
}
