//! Seams between tiles whose heights have different levels of rivers.
//!
//! A coarse tile shows fewer levels of rivers than a fine one, so a vertex that both have may have two heights. Along
//! an edge with a coarser neighbour, and at its ends, the finer tile takes the vertices of the coarser one: the ground
//! has no crack. All other ground has one height for each vertex, and nothing to sew.

use super::Leaf;
use super::mesh::next_serial;
use crate::lod::tile::{TILE_SIDE, Tile, Vertex};
use crate::sphere::{Edge, NodeId};
use glam::DVec3;
use std::collections::HashMap;
use std::collections::hash_map::DefaultHasher;
use std::hash::{Hash as _, Hasher as _};
use std::sync::Arc;

/// Sewn tiles of the last LOD cut, by the serial of the tile and a hash of what it took from its neighbours: as long
/// as nothing changes around them they stay the same tiles.
#[derive(Default)]
pub(super) struct Seams(HashMap<(u64, u64), Arc<Tile>>);

/// Vertices that lie closer together on the unit sphere are one; those of the finest level are a hundred times as far
/// apart.
const SAME: f64 = 1e-10;

/// A vertex that a finer tile takes.
#[derive(Clone, Copy)]
struct Taken {
    dir: DVec3,
    vertex: Vertex,
    /// Level of the tile that it comes from.
    level: u8,
}

impl Seams {
    /// Sews the leaves of a LOD cut.
    pub(super) fn sew(&mut self, leaves: &mut [Leaf]) {
        profiling::scope!("sew");
        let index: HashMap<NodeId, usize> = leaves.iter().enumerate().map(|(i, leaf)| (leaf.tile.id, i)).collect();
        let mut by_level: Vec<usize> = (0..leaves.len()).collect();
        by_level.sort_by_key(|&i| leaves[i].tile.id.level);
        let mut patches: Vec<Vec<(usize, Vertex)>> = vec![Vec::new(); leaves.len()];
        let mut ends: Vec<Taken> = Vec::new();
        for &i in &by_level {
            let (id, mask) = (leaves[i].tile.id, leaves[i].coarser_edges);
            for edge in Edge::ALL.into_iter().filter(|edge| mask & edge.bit() != 0) {
                let Some(&other) = id.neighbour(edge).parent().and_then(|parent| index.get(&parent)) else { continue };
                let theirs = rim(&leaves[other].tile, &patches[other]);
                for step in (0..TILE_SIDE).step_by(2) {
                    let at = on_edge(edge, step);
                    let dir = dir_of(&leaves[i].tile.vertices[at]);
                    let Some(taken) = theirs.iter().find(|taken| taken.dir.distance_squared(dir) < SAME * SAME) else {
                        continue;
                    };
                    if differs(&taken.vertex, &leaves[i].tile.vertices[at]) {
                        put(&mut patches[i], at, taken.vertex);
                        if step == 0 || step == TILE_SIDE - 1 {
                            ends.push(*taken);
                        }
                    }
                }
            }
        }
        // Tiles that meet an end of a seam with a corner only. The coarsest tile around decides.
        ends.sort_by_key(|taken| std::cmp::Reverse(taken.level));
        for (leaf, patch) in leaves.iter().zip(&mut patches).filter(|_| !ends.is_empty()) {
            for at in CORNERS {
                let dir = dir_of(&leaf.tile.vertices[at]);
                for taken in ends.iter().filter(|taken| taken.level < leaf.tile.id.level) {
                    if taken.dir.distance_squared(dir) < SAME * SAME {
                        put(patch, at, taken.vertex);
                    }
                }
            }
        }
        let before = std::mem::take(&mut self.0);
        for (leaf, patch) in leaves.iter_mut().zip(patches).filter(|(_, patch)| !patch.is_empty()) {
            let key = (leaf.tile.serial, hash_of(&patch));
            let tile = before.get(&key).cloned().unwrap_or_else(|| Arc::new(sewn(&leaf.tile, &patch)));
            self.0.insert(key, tile.clone());
            leaf.tile = tile;
        }
    }
}

const CORNERS: [usize; 4] = [0, TILE_SIDE - 1, TILE_SIDE * (TILE_SIDE - 1), TILE_SIDE * TILE_SIDE - 1];

/// Index of a vertex on an edge.
fn on_edge(edge: Edge, step: usize) -> usize {
    let last = TILE_SIDE - 1;
    let (x, y) = match edge {
        Edge::Left => (0, step),
        Edge::Right => (last, step),
        Edge::Bottom => (step, 0),
        Edge::Top => (step, last),
    };
    y * TILE_SIDE + x
}

fn dir_of(vertex: &Vertex) -> DVec3 {
    vertex.position_planet_m().normalize_or_zero()
}

fn differs(a: &Vertex, b: &Vertex) -> bool {
    (a.position_high_m, a.position_low_m) != (b.position_high_m, b.position_low_m)
}

/// The vertices on all edges of a tile, with its patch.
fn rim(tile: &Tile, patch: &[(usize, Vertex)]) -> Vec<Taken> {
    let places = Edge::ALL.into_iter().flat_map(|edge| (0..TILE_SIDE).map(move |step| on_edge(edge, step)));
    let vertex = |at: usize| patch.iter().find(|(place, _)| *place == at).map_or(tile.vertices[at], |(_, own)| *own);
    let taken = |vertex: Vertex| Taken { dir: dir_of(&vertex), vertex, level: tile.id.level };
    places.map(|at| taken(vertex(at))).collect()
}

fn put(patch: &mut Vec<(usize, Vertex)>, at: usize, vertex: Vertex) {
    patch.retain(|(place, _)| *place != at);
    patch.push((at, vertex));
}

fn hash_of(patch: &[(usize, Vertex)]) -> u64 {
    let mut hasher = DefaultHasher::new();
    for (at, vertex) in patch {
        (at, vertex.position_high_m.map(f32::to_bits), vertex.position_low_m.map(f32::to_bits)).hash(&mut hasher);
        (vertex.deviation_m.to_bits(), vertex.foreseen_m.to_bits()).hash(&mut hasher);
    }
    hasher.finish()
}

/// The same tile with other vertices at some places. Climate and normals stay its own.
fn sewn(tile: &Tile, patch: &[(usize, Vertex)]) -> Tile {
    let mut sewn = Tile { serial: next_serial(), ..Tile::clone(tile) };
    for (at, taken) in patch {
        let own = &mut sewn.vertices[*at];
        let moved_m = own.position_planet_m().distance(taken.position_planet_m());
        sewn.bounding_radius_m = sewn.bounding_radius_m.max(tile.bounding_radius_m + moved_m);
        sewn.min_height_m = sewn.min_height_m.min(f64::from(taken.height_m));
        sewn.max_height_m = sewn.max_height_m.max(f64::from(taken.height_m));
        *own = Vertex {
            position_high_m: taken.position_high_m,
            position_low_m: taken.position_low_m,
            height_m: taken.height_m,
            deviation_m: taken.deviation_m,
            foreseen_m: taken.foreseen_m,
            ..*own
        };
    }
    sewn
}
