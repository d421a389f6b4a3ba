//! The shape that the ground has on screen: vertices rise out of the coarser mesh as the eye comes nearer. This is the same
//! arithmetic as `morph.wgsl`, for tests and for games that must know where exactly the drawn ground is.
//!
//! Geomorphing as a hierarchical basis: the drawn place of a vertex is the middle of its chord *as drawn*, plus a share of its
//! deviation from that chord. The share depends on nothing but the eye and what the vertex itself carries, and it is 0 for all
//! vertices that a coarser mesh leaves out, so that any choice of tiles draws the very same surface. (CDLOD, Strugar 2010, morphs
//! level by level at fixed distances; here each vertex has a distance of its own.)
//!
//! Vertices born three levels before the tile's or earlier have always come out in full: a tile is nowhere as far from the eye as
//! that ([`super::range`]).

use super::chords::chords;
use super::range::{FULL_AT, Ranges};
use super::tile::{TILE_VERTICES, Tile, Vertex};
use glam::DVec3;

/// The coarsest grid of a tile whose vertices may still be on their way: every so many vertices.
pub const COARSEST_MORPHING: u16 = 4;

/// How far each vertex of a tile is drawn above (below, if negative) its true place, in metres along its own vertical, for an eye
/// in the planet frame.
pub fn shifts_m(tile: &Tile, eye_planet_m: DVec3, ranges: &Ranges) -> Vec<f32> {
    let eye = Split::new(eye_planet_m);
    let mut shifts_m = vec![0.0_f32; TILE_VERTICES];
    for chord in chords(false).iter().filter(|chord| chord.stride <= COARSEST_MORPHING) {
        let vertex = &tile.vertices[usize::from(chord.vertex)];
        let spacing_m = ranges.spacing_m(tile.id.level) as f32 * f32::from(chord.stride);
        let share = share(vertex, spacing_m, &eye, ranges);
        let ends_m = shifts_m[usize::from(chord.younger)] + shifts_m[usize::from(chord.elder)];
        shifts_m[usize::from(chord.vertex)] = 0.5 * ends_m - (1.0 - share) * vertex.deviation_m;
    }
    shifts_m
}

/// A position as the shader has it.
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

/// How far a vertex has come out: 0 not at all, 1 in full.
fn share(vertex: &Vertex, spacing_m: f32, eye: &Split, ranges: &Ranges) -> f32 {
    let [x, y, z] =
        [0, 1, 2].map(|i| (vertex.position_high_m[i] - eye.high_m[i]) + (vertex.position_low_m[i] - eye.low_m[i]));
    let distance_m = (x * x + y * y + z * z).sqrt();
    let (least, most) = (ranges.least_spacings as f32 * spacing_m, ranges.most_spacings as f32 * spacing_m);
    let begin_m = (vertex.foreseen_m * ranges.reach as f32).clamp(least, most);
    ((begin_m - distance_m) / (begin_m * (1.0 - FULL_AT as f32))).clamp(0.0, 1.0)
}
