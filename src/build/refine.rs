//! From a view to a complete set of tiles: the restricted quadtree, refined level by level.
//!
//! Each level is built on all cores before the next one is looked at, so that whatever time allows, the tiles of the levels
//! done so far cover the whole planet without a gap. A node is split only together with the neighbours that this makes
//! necessary: no two neighbours are ever more than one level apart. Within a level, what is nearest to the eye comes first.

use super::cache::Cache;
use super::stats::{BuildStats, Work};
use super::{Leaf, Surface};
use crate::lod::tile::Tile;
use crate::lod::{Selection, View};
use crate::planet::Planet;
use crate::sphere::{Edge, NodeId};
use crate::terrain::Terrain;
use std::collections::HashSet;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

/// Builds the tiles that a view needs, as far as `keep_going` allows (it is asked before each layer of each tile beyond the
/// coarsest; after it says no, no finer level is begun). Tiles are taken from and left in `cache`. `stats` goes on from what
/// was done before for the request made at `asked`.
pub(crate) fn refine(
    terrain: &Arc<Terrain>,
    view: &View,
    cache: &Cache,
    asked: Instant,
    mut stats: BuildStats,
    keep_going: &(dyn Fn() -> bool + Sync),
) -> Surface {
    profiling::scope!("refine");
    let begun = Instant::now();
    let mut builder = LevelBuilder { terrain, cache, asked, stats: &mut stats, secs: 0.0 };
    let radius_m = terrain.planet().radius_m();
    let selection = Selection::new(view, radius_m, lowest_radius_m(terrain));
    let mut split: HashSet<NodeId> = HashSet::new();
    let mut complete = true;

    let mut level: Vec<NodeId> = NodeId::roots().to_vec();
    builder.build(&level, &|| true);
    loop {
        let tiles = level.iter().filter_map(|id| cache.tile(*id));
        let mut wanted: Vec<Arc<Tile>> = tiles.filter(|tile| selection.wants_split(tile)).collect();
        if wanted.is_empty() {
            break;
        }
        let eye = view.camera.position_planet_m;
        let away_m = |tile: &Tile| tile.center_planet_m.distance(eye) - tile.bounding_radius_m;
        wanted.sort_by(|a, b| away_m(a).total_cmp(&away_m(b)));
        let children: Vec<NodeId> = wanted.iter().flat_map(|tile| tile.id.children()).collect();
        if !builder.build(&children, keep_going) {
            // Out of time: go on with what is there.
            complete = false;
            wanted.retain(|tile| tile.id.children().iter().all(|child| cache.tile(*child).is_some()));
        }
        level = wanted.iter().flat_map(|tile| tile.id.children()).collect();
        for tile in wanted {
            split_with_neighbours(tile.id, &mut split);
        }
    }
    // Splits forced by neighbours; few, and needed for a set without cracks, so never cut short.
    let mut forced: Vec<NodeId> =
        split.iter().flat_map(|id| id.children()).filter(|id| cache.tile(*id).is_none()).collect();
    forced.sort_unstable();
    builder.build(&forced, &|| true);

    let building_secs = builder.secs;
    let leaves = leaves(&split, cache);
    stats.tiles = leaves.len();
    stats.vertices = leaves.iter().map(|leaf| leaf.tile.vertices.len()).sum();
    stats.select_secs += begun.elapsed().as_secs_f64() - building_secs;
    stats.duration_secs = asked.elapsed().as_secs_f64();
    stats.slices += 1;
    Surface { terrain: terrain.clone(), leaves, complete, asked, stats }
}

/// Distance from the planet's centre of the lowest ground or sea that can hide what is behind it.
pub fn lowest_radius_m(terrain: &Terrain) -> f64 {
    let planet: &Planet = terrain.planet();
    let lowest_m = terrain.height_bounds_m().0;
    planet.radius_m() + planet.sea_level_m().map_or(lowest_m, |sea| sea.max(lowest_m))
}

/// Builds nodes on all cores.
struct LevelBuilder<'a> {
    terrain: &'a Terrain,
    cache: &'a Cache,
    asked: Instant,
    stats: &'a mut BuildStats,
    /// Time spent so far.
    secs: f64,
}

impl LevelBuilder<'_> {
    /// Builds those of the nodes that the cache lacks, in their order. False if `keep_going` said no before the end; what was
    /// built until then stays in the cache.
    fn build(&mut self, nodes: &[NodeId], keep_going: &(dyn Fn() -> bool + Sync)) -> bool {
        let missing: Vec<NodeId> = nodes.iter().filter(|id| self.cache.tile(**id).is_none()).copied().collect();
        if missing.is_empty() {
            return true;
        }
        let begun = Instant::now();
        let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        // Each thread takes the next node: strictly in order, which splitting the list between threads would not be.
        let works = rayon::broadcast(|_| {
            let mut work = Work::since(self.asked);
            while !stopped.load(Ordering::Relaxed)
                && let Some(&id) = missing.get(next.fetch_add(1, Ordering::Relaxed))
            {
                if !self.cache.build(id, self.terrain, &mut work, &keep_going) {
                    stopped.store(true, Ordering::Relaxed);
                }
            }
            work
        });
        works.iter().for_each(|work| self.stats.add(work));
        self.secs += begun.elapsed().as_secs_f64();
        !stopped.into_inner()
    }
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
            let tile = cache.tile(id)?;
            let (detail, horizon) = (cache.detail(&tile), cache.nearest_horizon(id));
            Some(Leaf { tile, coarser_edges, detail, horizon })
        })
        .collect()
}
