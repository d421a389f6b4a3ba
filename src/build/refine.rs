//! From a view to a complete set of tiles: the restricted quadtree, refined level by level.
//!
//! Each level is built on all cores before the next one is looked at, so that whatever time allows, the tiles of the levels
//! done so far cover the whole planet without a gap. A node is split only together with the neighbours that this makes
//! necessary: no two neighbours are ever more than one level apart.

use super::cache::Cache;
use super::{BuildStats, Leaf, Surface};
use crate::lod::{Selection, View};
use crate::planet::Planet;
use crate::sphere::{Edge, NodeId};
use crate::terrain::Terrain;
use rayon::prelude::*;
use std::collections::HashSet;
use std::sync::Arc;
use std::time::Instant;

/// Builds the tiles that a view needs, as far as `keep_going` allows (it is asked before each tile beyond the coarsest; after
/// it says no, no finer level is begun). Tiles are taken from and left in `cache`.
pub(crate) fn refine(
    terrain: &Arc<Terrain>,
    view: &View,
    cache: &Cache,
    keep_going: &(dyn Fn() -> bool + Sync),
) -> Surface {
    let started = Instant::now();
    let radius_m = terrain.planet().radius_m();
    let selection = Selection::new(view, radius_m, lowest_radius_m(terrain));
    let mut split: HashSet<NodeId> = HashSet::new();
    let mut built = Counts::default();
    let mut complete = true;

    let mut level: Vec<NodeId> = NodeId::roots().to_vec();
    built.add(build_all(terrain, cache, &level, &|| true).unwrap_or_default());
    loop {
        let wanted: Vec<NodeId> = level
            .iter()
            .filter(|id| cache.tile(**id).is_some_and(|tile| selection.wants_split(&tile)))
            .copied()
            .collect();
        if wanted.is_empty() {
            break;
        }
        let children: Vec<NodeId> = wanted.iter().flat_map(|id| id.children()).collect();
        let mut wanted = wanted;
        match build_all(terrain, cache, &children, keep_going) {
            Some(counts) => built.add(counts),
            // Out of time: go on with what is there from before.
            None => {
                complete = false;
                wanted.retain(|id| id.children().iter().all(|child| cache.tile(*child).is_some()));
            }
        }
        level = wanted.iter().flat_map(|id| id.children()).collect();
        for id in wanted {
            split_with_neighbours(id, &mut split);
        }
    }
    // Splits forced by neighbours; few, and needed for a set without cracks, so never cut short.
    let mut forced: Vec<NodeId> =
        split.iter().flat_map(|id| id.children()).filter(|id| cache.tile(*id).is_none()).collect();
    forced.sort_unstable();
    built.add(build_all(terrain, cache, &forced, &|| true).unwrap_or_default());

    let leaves = leaves(&split, cache);
    let vertices = leaves.iter().map(|leaf| leaf.tile.vertices.len()).sum();
    let stats = BuildStats {
        tiles: leaves.len(),
        vertices,
        tiles_built: built.tiles,
        octave_samples: built.octave_samples,
        duration_secs: started.elapsed().as_secs_f64(),
    };
    Surface { terrain: terrain.clone(), leaves, complete, stats }
}

/// Distance from the planet's centre of the lowest ground or sea that can hide what is behind it.
pub fn lowest_radius_m(terrain: &Terrain) -> f64 {
    let planet: &Planet = terrain.planet();
    let lowest_m = terrain.height_bounds_m().0;
    planet.radius_m() + planet.sea_level_m().map_or(lowest_m, |sea| sea.max(lowest_m))
}

#[derive(Clone, Copy, Default)]
struct Counts {
    tiles: usize,
    octave_samples: usize,
}

impl Counts {
    fn add(&mut self, other: Counts) {
        self.tiles += other.tiles;
        self.octave_samples += other.octave_samples;
    }
}

/// Builds those of the nodes that the cache lacks, on all cores. `None` if `keep_going` said no before the end; what was
/// built until then stays in the cache.
fn build_all(
    terrain: &Terrain,
    cache: &Cache,
    nodes: &[NodeId],
    keep_going: &(dyn Fn() -> bool + Sync),
) -> Option<Counts> {
    let missing: Vec<NodeId> = nodes.iter().filter(|id| cache.tile(**id).is_none()).copied().collect();
    missing
        .par_iter()
        .map(|&id| {
            keep_going().then(|| {
                let work = cache.build(id, terrain);
                Counts { tiles: 1, octave_samples: work.octave_samples }
            })
        })
        .try_reduce(Counts::default, |mut a, b| {
            a.add(b);
            Some(a)
        })
}

/// Marks a node as split, and with it every node that must be so that neighbours differ by one level at most.
fn split_with_neighbours(id: NodeId, split: &mut HashSet<NodeId>) {
    if !split.insert(id) {
        return;
    }
    if let Some(parent) = id.parent() {
        split_with_neighbours(parent, split);
        for edge in Edge::ALL {
            if let Some(needed) = id.neighbour(edge).parent() {
                split_with_neighbours(needed, split);
            }
        }
    }
}

/// The nodes that are shown, each with the edges beyond which the neighbour is coarser.
fn leaves(split: &HashSet<NodeId>, cache: &Cache) -> Vec<Leaf> {
    let mut ids: Vec<NodeId> = NodeId::roots()
        .into_iter()
        .chain(split.iter().flat_map(|id| id.children()))
        .filter(|id| !split.contains(id))
        .collect();
    ids.sort_unstable();
    ids.into_iter()
        .filter_map(|id| {
            let coarser = |edge: &Edge| id.neighbour(*edge).parent().is_some_and(|parent| !split.contains(&parent));
            let coarser_edges = Edge::ALL.iter().filter(|edge| coarser(edge)).fold(0, |mask, edge| mask | edge.bit());
            Some(Leaf { tile: cache.tile(id)?, coarser_edges, normals: None })
        })
        .collect()
}
