//! Deviations: heights of a tile's vertices above their chords in the coarser mesh, and the deviations to expect of its
//! children.
//!
//! Everything follows from the tile itself, because the ends of a chord are vertices of the same tile. Values that
//! neighbours share are bit-identical in both, whichever end of a chord comes first.

use crate::lod::chords::{Chord, chords};
use crate::lod::morph::COARSEST_MORPHING;
use crate::lod::select::{UNKNOWN_M, foresee};
use crate::lod::tile::{BLOCK_QUADS, BLOCKS_SIDE, TILE_SIDE, TILE_VERTICES, Tile};
use glam::DVec3;

/// Sets the deviations of the vertices and blocks of a tile. `dirs_planet` and `height_m` are those of its vertices.
pub(super) fn find_deviations(tile: &mut Tile, radius_m: f64, dirs_planet: &[DVec3], height_m: &[f64]) {
    if dirs_planet.len() != TILE_VERTICES || height_m.len() != TILE_VERTICES || tile.vertices.len() != TILE_VERTICES {
        return;
    }
    let id = tile.id;
    let mut deviations_m = [0.0_f32; TILE_VERTICES];
    let mut most_m = [0.0_f32; COARSEST_MORPHING as usize + 1];
    for chord in chords((id.x + id.y) % 2 == 1) {
        // Vertices of level 0 have no chord.
        if 1_u32 << id.level <= u32::from(chord.stride) {
            continue;
        }
        let deviation_m = above_chord_m(chord, radius_m, dirs_planet, height_m) as f32;
        deviations_m[usize::from(chord.vertex)] = deviation_m;
        let vertex = &mut tile.vertices[usize::from(chord.vertex)];
        vertex.deviation_m = deviation_m;
        if chord.stride <= COARSEST_MORPHING {
            vertex.foreseen_m = foreseen_m(chord, id.level, &deviations_m);
            let most_m = &mut most_m[usize::from(chord.stride)];
            *most_m = most_m.max(deviation_m.abs());
        }
    }
    foresee(id.level, &deviations_m, &mut tile.blocks);
    for (i, block) in tile.blocks.iter_mut().enumerate() {
        let first = i / BLOCKS_SIDE * BLOCK_QUADS * TILE_SIDE + i % BLOCKS_SIDE * BLOCK_QUADS;
        block.radius_m = block_radius_m(first, radius_m, dirs_planet, height_m);
    }
    // While they morph, vertices are displaced by up to the sum of the deviations of all levels on the way.
    tile.bounding_radius_m += f64::from(most_m.iter().sum::<f32>());
}

/// Height of a vertex above its chord, along its own vertical.
#[inline]
fn above_chord_m(chord: &Chord, radius_m: f64, dirs: &[DVec3], height_m: &[f64]) -> f64 {
    let (a, b) = (usize::from(chord.younger), usize::from(chord.elder));
    let (mut a, mut b) = ((dirs[a], radius_m + height_m[a]), (dirs[b], radius_m + height_m[b]));
    // In a fixed order, so that rounding is the same for all tiles.
    if (b.0.x, b.0.y, b.0.z) < (a.0.x, a.0.y, a.0.z) {
        (a, b) = (b, a);
    }
    let up = dirs[usize::from(chord.vertex)];
    let along = b.0 - a.0;
    let level = along - up * along.dot(up);
    // Where the chord crosses the vertical.
    let (before, after) = (a.1 * a.0.dot(level), b.1 * b.0.dot(level));
    let share = before / (before - after);
    let (from_m, to_m) = (a.1 * a.0.dot(up), b.1 * b.0.dot(up));
    radius_m + height_m[usize::from(chord.vertex)] - (from_m + share * (to_m - from_m))
}

/// The deviation to expect of a vertex from the deviations of its chord's ends.
#[inline]
fn foreseen_m(chord: &Chord, level: u8, deviations_m: &[f32; TILE_VERTICES]) -> f32 {
    // Born in level 1: the deviations of the ends are unknown.
    if 1_u32 << level <= 2 * u32::from(chord.stride) {
        return UNKNOWN_M;
    }
    let younger_m = 0.5 * deviations_m[usize::from(chord.younger)].abs();
    let elder_m = if chord.elder_is_next { 0.25 * deviations_m[usize::from(chord.elder)].abs() } else { 0.0 };
    younger_m.max(elder_m)
}

/// Distance from the middle of a block to its farthest vertex; `first`: its first vertex.
fn block_radius_m(first: usize, radius_m: f64, dirs: &[DVec3], height_m: &[f64]) -> f32 {
    let at = |i: usize| dirs[i] * (radius_m + height_m[i]);
    let middle_m = at(first + BLOCK_QUADS / 2 * (TILE_SIDE + 1));
    let rows = (0..=BLOCK_QUADS).map(|y| first + y * TILE_SIDE);
    let farthest = rows.flat_map(|row| row..=row + BLOCK_QUADS).map(|i| at(i).distance_squared(middle_m));
    farthest.fold(0.0, f64::max).sqrt() as f32
}
