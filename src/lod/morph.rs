//! The drawn shape of the ground: vertices morph from the coarser mesh to their exact position as the eye approaches.
//! The same arithmetic as `morph.wgsl`, for tests and for games that need the exact drawn height.
//!
//! Geomorphing in a hierarchical basis: the drawn position of a vertex is the middle of its chord *as drawn* plus a
//! share of its deviation. The share depends only on the eye and on the vertex, and it is 0 for every vertex that a
//! coarser mesh omits, so every LOD cut draws the same surface. (CDLOD, Strugar 2010, morphs level by level at fixed
//! distances; here each vertex has its own distance.)
//!
//! Vertices born three or more levels before the tile's are always exact: no tile is as far from the eye as the
//! distance at which they begin to appear ([`super::range`]). Ground steeper than some 80 degrees reaches so far all
//! the same. There a finer tile has a vertex exact that a coarser neighbour still morphs; so those of the neighbour
//! that lie on the edge between them are exact, too, or the ground would have a gap.

use super::chords::chords;
use super::range::{FULL_AT, Ranges};
use super::tile::{TILE_QUADS, TILE_SIDE, TILE_VERTICES, Tile, Vertex};
use crate::sphere::Edge;
use glam::DVec3;

/// Stride of the coarsest grid of a tile whose vertices may still morph.
pub const COARSEST_MORPHING: u16 = 4;

/// Height of each drawn vertex above its exact position (negative: below), in metres along its own vertical.
/// `finer_edges`: edges beyond which the neighbour is one level finer, as bits of [`Edge::bit`].
pub fn shifts_m(tile: &Tile, finer_edges: u8, eye_planet_m: DVec3, ranges: &Ranges) -> Vec<f32> {
    let eye = Split::new(eye_planet_m);
    let mut shifts_m = vec![0.0_f32; TILE_VERTICES];
    for chord in chords(false).iter().filter(|chord| chord.stride <= COARSEST_MORPHING) {
        let vertex = &tile.vertices[usize::from(chord.vertex)];
        let spacing_m = ranges.spacing_m(tile.id.level) as f32 * f32::from(chord.stride);
        let is_exact = chord.stride == COARSEST_MORPHING && edges_of(chord.vertex) & finer_edges != 0;
        let share = if is_exact { 1.0 } else { share(vertex, spacing_m, &eye, ranges) };
        let ends_m = shifts_m[usize::from(chord.younger)] + shifts_m[usize::from(chord.elder)];
        shifts_m[usize::from(chord.vertex)] = 0.5 * ends_m - (1.0 - share) * vertex.deviation_m;
    }
    shifts_m
}

/// The edges of a tile that a vertex lies on, as bits.
fn edges_of(vertex: u16) -> u8 {
    let (x, y) = (usize::from(vertex) % TILE_SIDE, usize::from(vertex) / TILE_SIDE);
    let on =
        [(Edge::Left, x == 0), (Edge::Right, x == TILE_QUADS), (Edge::Bottom, y == 0), (Edge::Top, y == TILE_QUADS)];
    on.into_iter().filter(|(_, lies)| *lies).fold(0, |mask, (edge, _)| mask | edge.bit())
}

/// A position as the shader holds it.
struct Split {
    high_m: [f32; 3],
    low_m: [f32; 3],
}

impl Split {
    fn new(position_m: DVec3) -> Self {
        let high = position_m.as_vec3();
        Self { high_m: high.to_array(), low_m: (position_m - high.as_dvec3()).as_vec3().to_array() }
    }
}

/// Progress of a vertex: 0 on its chord, 1 at its exact position.
fn share(vertex: &Vertex, spacing_m: f32, eye: &Split, ranges: &Ranges) -> f32 {
    let [x, y, z] =
        [0, 1, 2].map(|i| (vertex.position_high_m[i] - eye.high_m[i]) + (vertex.position_low_m[i] - eye.low_m[i]));
    let distance_m = (x * x + y * y + z * z).sqrt();
    let (least, most) = (ranges.least_spacings as f32 * spacing_m, ranges.most_spacings as f32 * spacing_m);
    let begin_m = (vertex.foreseen_m * ranges.reach as f32).clamp(least, most);
    ((begin_m - distance_m) / (begin_m * (1.0 - FULL_AT as f32))).clamp(0.0, 1.0)
}
