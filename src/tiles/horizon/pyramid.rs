//! The heights of a surface at every level: those of its tiles, and for each ancestor every second vertex of its
//! children. No noise is evaluated, and equal heights have equal hashes, whenever they were made.

use crate::lod::Tile;
use crate::lod::tile::{TILE_QUADS, TILE_SIDE, TILE_VERTICES};
use crate::sphere::{Edge, NodeId};
use crate::tiles::Surface;
use std::collections::{BTreeMap, HashMap};

/// The ground of one node.
pub(super) struct Ground {
    /// Height of ground or sea, whichever is higher, at each vertex.
    pub(super) height_m: Vec<f32>,
    /// Equal for equal heights.
    pub(super) hash: u64,
    /// Whether finer nodes are known.
    pub(super) split: bool,
}

/// See the module.
pub(super) struct Pyramid {
    nodes: HashMap<NodeId, Ground>,
}

impl Pyramid {
    pub(super) fn new(surface: &Surface) -> Self {
        profiling::scope!("pyramid");
        let sea_m = surface.terrain.planet().sea_level_m().map_or(f32::MIN, |level| level as f32);
        let mut nodes: HashMap<NodeId, Ground> = HashMap::new();
        // Deepest first: a parent is made once all of its children are there.
        let mut levels: BTreeMap<u8, Vec<NodeId>> = BTreeMap::new();
        for leaf in &surface.leaves {
            nodes.insert(leaf.tile.id, Ground::new(heights_of(&leaf.tile, sea_m), false));
            levels.entry(leaf.tile.id.level).or_default().push(leaf.tile.id);
        }
        while let Some((level, ids)) = levels.pop_last() {
            for parent in ids.iter().filter(|id| id.quarter() == (0, 0)).filter_map(|id| id.parent()) {
                if let Some(height_m) = joined(&nodes, parent) {
                    nodes.insert(parent, Ground::new(height_m, true));
                    levels.entry(level - 1).or_default().push(parent);
                }
            }
        }
        Self { nodes }
    }

    /// The ground of a node.
    pub(super) fn get(&self, id: NodeId) -> Option<&Ground> {
        self.nodes.get(&id)
    }

    /// The ground of a node, or of its finest known ancestor.
    pub(super) fn deepest(&self, id: NodeId) -> Option<(NodeId, &Ground)> {
        std::iter::successors(Some(id), |id| id.parent()).find_map(|id| Some((id, self.get(id)?)))
    }

    /// Hash of all ground from which the near horizon of a node is made: its own, and that around it.
    pub(super) fn hash_around(&self, id: NodeId) -> u64 {
        let own = self.get(id).map_or(0, |ground| ground.hash);
        around(id)
            .into_iter()
            .filter_map(|id| self.deepest(id))
            .fold(own, |all, (id, ground)| mixed(mixed(all, ground.hash), u64::from(id.level)))
    }
}

impl Ground {
    fn new(height_m: Vec<f32>, split: bool) -> Self {
        let hash = height_m.iter().fold(0, |hash, height| mixed(hash, u64::from(height.to_bits())));
        Self { height_m, hash, split }
    }
}

/// Adds a number to a hash.
pub(super) fn mixed(hash: u64, number: u64) -> u64 {
    let folded = (hash.rotate_left(23) ^ number).wrapping_mul(0x9E37_79B9_7F4A_7C15);
    folded ^ (folded >> 32)
}

fn heights_of(tile: &Tile, sea_m: f32) -> Vec<f32> {
    tile.vertices.iter().map(|vertex| vertex.height_m.max(sea_m)).collect()
}

/// Every second vertex of every second row of a node's children, if all are there.
fn joined(nodes: &HashMap<NodeId, Ground>, parent: NodeId) -> Option<Vec<f32>> {
    let mut height_m = vec![0.0; TILE_VERTICES];
    for child in parent.children() {
        let finer = &nodes.get(&child)?.height_m;
        let (right, upper) = child.quarter();
        let half = TILE_QUADS / 2;
        for y in 0..=half {
            for x in 0..=half {
                height_m[(y + upper * half) * TILE_SIDE + x + right * half] = *finer.get(2 * y * TILE_SIDE + 2 * x)?;
            }
        }
    }
    Some(height_m)
}

/// The nodes of the same level that touch a node, at edges and corners.
pub(super) fn around(id: NodeId) -> Vec<NodeId> {
    let beside = Edge::ALL.map(|edge| id.neighbour(edge));
    let mut all = beside.to_vec();
    // A node beside two of those is at a corner. At a corner of the cube there is none.
    let second: Vec<NodeId> = beside.iter().flat_map(|id| Edge::ALL.map(|edge| id.neighbour(edge))).collect();
    for (i, corner) in second.iter().enumerate() {
        if *corner != id && second[..i].contains(corner) && !all.contains(corner) {
            all.push(*corner);
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::Face;

    #[test]
    fn eight_nodes_lie_around_one_and_seven_at_a_corner_of_the_cube() {
        let node = |x, y| NodeId { level: 3, face: Face::PosX, x, y };
        assert_eq!(around(node(3, 4)).len(), 8);
        assert_eq!(around(node(0, 4)).len(), 8);
        assert_eq!(around(node(0, 0)).len(), 7);
    }
}
