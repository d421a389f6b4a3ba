//! The LOD cut of a view, refined level by level: a restricted quadtree.
//!
//! Each level is built on all cores before the next level is examined, so that the levels built so far cover the whole
//! planet without a gap whenever time runs out. A node is split only together with the neighbours that must be split so
//! that neighbours differ by at most one level. Within a level, nodes near the camera come first.

use super::cache::Cache;
use super::sew::Seams;
use super::stats::{BuildStats, Work};
use super::{Leaf, Surface};
use crate::life::Scenery;
use crate::lod::cull::lowest_radius_m;
use crate::lod::tile::{DETAIL_BYTES, DetailTile, TILE_QUADS, TILE_VERTICES, Tile, Vertex};
use crate::lod::{Quality, Ranges, Selection, View};
use crate::planet::Key;
use crate::sphere::{Edge, NodeId};
use crate::terrain::Terrain;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};
use std::time::Instant;

/// Triangle budget: the most tiles that a picture of this size may show, of 2,048 triangles each. Up to half of the
/// tiles of a surface lie outside the picture, coarser with distance; they are there for when the camera turns, and are
/// not drawn. Small pictures have less at medium and high quality: more triangles a pixel show nothing more.
pub fn budget_tiles(quality: Quality, size_px: [u32; 2]) -> usize {
    let pixels = size_px.map(|px| px as usize).into_iter().fold(1, usize::saturating_mul);
    let most = match quality {
        Quality::Low => FEWEST_TILES,
        Quality::Medium => 500,
        Quality::High => 1200,
    };
    most.min(FEWEST_TILES.max(pixels.saturating_mul(TRIANGLES_PER_PIXEL) / TILE_TRIANGLES))
}

/// Triangle budget of low quality, and of very small pictures: fewer cannot fill the least ranges.
const FEWEST_TILES: usize = 300;
/// Triangles of a tile.
const TILE_TRIANGLES: usize = 2 * TILE_QUADS * TILE_QUADS;
/// Most triangles for each pixel, where the picture is not very small.
const TRIANGLES_PER_PIXEL: usize = 24;

/// LOD bias: the factor on the allowed screen-space error that makes the LOD cut fit the triangle budget, in steps of
/// an eighth of an octave.
fn bias_factor(step: u32) -> f64 {
    (f64::from(step) * 0.125).exp2()
}
/// Greatest step of the LOD bias: a factor of 64.
const MAX_BIAS: u32 = 48;
/// The step for ground so rugged that its cut exceeds the budget even with the greatest LOD bias: the nearest nodes of
/// each level are split, as far as the budget goes.
const RATIONED: u32 = MAX_BIAS + 1;
/// Tiles that a split adds.
const MORE_TILES: usize = 3;

/// What a surface is built for.
#[derive(Clone, Copy)]
pub(crate) struct Goal {
    /// The view.
    pub(crate) view: View,
    /// The most tiles that the picture may show.
    budget: usize,
    /// When it was asked for.
    asked: Instant,
}

impl Goal {
    /// A surface for a view, within the triangle budget of its quality.
    pub(crate) fn new(view: &View, asked: Instant) -> Self {
        Self { view: *view, budget: budget_tiles(view.quality, view.size_px), asked }
    }

    /// The same with tiles and detail textures that take no more than some bytes.
    pub(crate) fn within(self, bytes: usize) -> Self {
        Self { budget: self.budget.min(bytes / BYTES_PER_SEEN_TILE), ..self }
    }
}

/// Memory for each tile that a picture shows: its detail texture and three meshes, because about as many tiles lie
/// outside the picture, a third as many are their ancestors, and horizon angles take the rest.
const BYTES_PER_SEEN_TILE: usize = 3 * TILE_VERTICES * size_of::<Vertex>() + DETAIL_BYTES;

/// Builds the tiles of a view. `keep_going` is asked before each layer of each tile; once it says no, no finer level is
/// begun, but the coarsest level is always built. Tiles are taken from `cache` and stored there. `before` is the last
/// finished LOD cut, and becomes the new one. `stats` continues from earlier slices of the request.
pub(crate) fn refine(
    terrain: &Arc<Terrain>,
    goal: &Goal,
    cache: &Cache,
    before: &mut Option<Cut>,
    mut stats: BuildStats,
    keep_going: &(dyn Fn() -> bool + Sync),
) -> Surface {
    profiling::scope!("refine");
    let begun = Instant::now();
    let Goal { ref view, budget, asked } = *goal;
    let lowest_radius_m = lowest_radius_m(terrain);
    let heights = terrain.tile_keys().heights;
    let start = before.as_ref().filter(|cut| cut.heights == heights && is_near(&cut.view, view, lowest_radius_m));
    let mut builder = LevelBuilder { terrain, cache, asked, stats: &mut stats, secs: 0.0 };
    let mut choose = |bias: u32| {
        let ranges = Ranges::new(view, terrain.planet().radius_m(), bias_factor(bias));
        let selection = Selection::new(view, &ranges, lowest_radius_m, start.map(|cut| &cut.split));
        choose(&mut builder, &selection, (ranges, bias), goal, keep_going)
    };
    let choice = within_budget(&mut choose, budget, start.map_or(0, |cut| cut.bias));
    // Splits forced by neighbours. They are few and prevent cracks, so they are never cut short.
    let mut forced: Vec<NodeId> =
        choice.split.iter().flat_map(|id| id.children()).filter(|id| cache.tile(*id).is_none()).collect();
    forced.sort_unstable();
    builder.build(&forced, &|| true);

    let building_secs = builder.secs;
    let mut leaves = leaves(&choice, cache);
    let mut seams = before.as_mut().map(|cut| std::mem::take(&mut cut.seams)).unwrap_or_default();
    if terrain.planet().structure.is_some() {
        seams.sew(&mut leaves);
    }
    stats.tiles = leaves.len();
    stats.vertices = leaves.iter().map(|leaf| leaf.tile.vertices.len()).sum();
    stats.select_secs += begun.elapsed().as_secs_f64() - building_secs;
    stats.duration_secs = asked.elapsed().as_secs_f64();
    stats.slices += 1;
    let Choice { ranges, complete, bias, split, .. } = choice;
    if complete {
        *before = Some(Cut { heights, view: *view, bias, split, seams });
    } else if let Some(cut) = before {
        cut.seams = seams;
    }
    let scenery = Scenery::default();
    Surface { terrain: terrain.clone(), leaves, scenery, complete, view: *view, ranges, asked, stats }
}

/// A finished LOD cut, from which the search for the next one starts.
pub(crate) struct Cut {
    /// Content key of the heights.
    heights: Key,
    /// The view that it was made for.
    view: View,
    /// Its LOD bias, as a step.
    bias: u32,
    /// The nodes that are split.
    split: HashSet<NodeId>,
    /// Its sewn tiles.
    seams: Seams,
}

/// A LOD cut that is searched for.
struct Choice {
    ranges: Ranges,
    bias: u32,
    split: HashSet<NodeId>,
    /// Nodes that are shown with their own detail texture, or a finer one.
    own_detail: HashSet<NodeId>,
    /// Number of tiles that the picture shows.
    seen: usize,
    /// Whether it was finished in time.
    complete: bool,
}

/// Whether the LOD cut of one view is a good start for another: not after a jump.
fn is_near(before: &View, after: &View, lowest_radius_m: f64) -> bool {
    let (from, to) = (&before.camera, &after.camera);
    let altitude_m = to.position_planet_m.length() - lowest_radius_m;
    before.size_px == after.size_px
        && before.quality == after.quality
        && from.fov_y_rad == to.fov_y_rad
        && from.position_planet_m.distance(to.position_planet_m) < 0.25 * altitude_m
}

/// The finest LOD cut that fits the triangle budget. The search starts at a coarse cut, so that few tiles are built
/// that are not shown. The LOD bias of the view before is kept while its cut fits and uses most of the budget.
fn within_budget(choose: &mut dyn FnMut(u32) -> Choice, budget: usize, before: u32) -> Choice {
    let fits = |choice: &Choice| choice.seen <= budget;
    if before > 0 {
        let choice = choose(before);
        if fits(&choice) && (!choice.complete || choice.seen > budget * 4 / 5) {
            return choice;
        }
    }
    let mut choice = choose(MAX_BIAS);
    if !fits(&choice) {
        return choose(RATIONED);
    }
    let mut too_strict = None;
    while choice.complete && choice.bias > too_strict.map_or(0, |step| step + 1) {
        let step = too_strict.map_or(choice.bias / 2, |step| u32::midpoint(step, choice.bias));
        let stricter = choose(step);
        if fits(&stricter) {
            choice = stricter;
        } else {
            too_strict = Some(step);
        }
    }
    choice
}

/// Builds a LOD cut level by level; gives up when the budget is exceeded.
fn choose(
    builder: &mut LevelBuilder<'_>,
    selection: &Selection<'_>,
    (ranges, bias): (Ranges, u32),
    goal: &Goal,
    keep_going: &(dyn Fn() -> bool + Sync),
) -> Choice {
    let (cache, budget) = (builder.cache, goal.budget);
    let mut choice =
        Choice { ranges, bias, split: HashSet::new(), own_detail: HashSet::new(), seen: 0, complete: true };
    let eye = goal.view.camera.position_planet_m;
    let away_m = |tile: &Tile| tile.center_planet_m.distance(eye) - tile.bounding_radius_m;
    let mut level: Vec<NodeId> = NodeId::roots().to_vec();
    builder.build(&level, &|| true);
    loop {
        let tiles = level.iter().filter_map(|id| cache.tile(*id));
        let tiles = tiles.inspect(|tile| {
            if selection.wants_detail(tile) {
                choice.own_detail.insert(tile.id);
            }
        });
        let (mut wanted, leaves): (Vec<Arc<Tile>>, Vec<_>) = tiles.partition(|tile| selection.wants_split(tile));
        choice.seen += leaves.iter().filter(|tile| selection.sees(tile)).count();
        if wanted.is_empty() {
            // Counted again, because neighbours have been split, too.
            choice.seen = leaf_ids(&choice.split)
                .filter(|id| nearest_tile(*id, cache).is_some_and(|tile| selection.sees(&tile)))
                .count();
            return choice;
        }
        let room = budget.saturating_sub(choice.seen + wanted.len());
        if choice.seen + wanted.len() > budget && bias < RATIONED {
            choice.seen += wanted.len();
            return choice;
        }
        wanted.sort_by(|a, b| away_m(a).total_cmp(&away_m(b)));
        if bias == RATIONED {
            // A quarter of the budget is for neighbours of split nodes. Half of the room for each level leaves some for
            // the ground before the eye.
            let room = room.saturating_sub(budget / 4);
            let most = (room / MORE_TILES / 2).max(usize::from(room >= MORE_TILES));
            choice.seen += wanted.drain(most.min(wanted.len())..).filter(|tile| selection.sees(tile)).count();
        }
        let children: Vec<NodeId> = wanted.iter().flat_map(|tile| tile.id.children()).collect();
        if !builder.build(&children, keep_going) {
            // Out of time: continue with the tiles that are there.
            choice.complete = false;
            wanted.retain(|tile| tile.id.children().iter().all(|child| cache.tile(*child).is_some()));
        }
        level = wanted.iter().flat_map(|tile| tile.id.children()).collect();
        for tile in wanted {
            split_with_neighbours(tile.id, &mut choice.split);
        }
    }
}

/// Builds nodes on all cores.
struct LevelBuilder<'a> {
    terrain: &'a Terrain,
    cache: &'a Cache,
    asked: Instant,
    stats: &'a mut BuildStats,
    /// Seconds spent so far.
    secs: f64,
}

impl LevelBuilder<'_> {
    /// Builds the nodes that the cache lacks, in order. Returns false if `keep_going` said no before the end; tiles
    /// built until then stay in the cache.
    fn build(&mut self, nodes: &[NodeId], keep_going: &(dyn Fn() -> bool + Sync)) -> bool {
        let missing: Vec<NodeId> = nodes.iter().filter(|id| self.cache.tile(**id).is_none()).copied().collect();
        if missing.is_empty() {
            return true;
        }
        let begun = Instant::now();
        let (next, stopped) = (AtomicUsize::new(0), AtomicBool::new(false));
        // Each thread takes the next node, which keeps the order; splitting the list between threads would not.
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

/// Marks a node as split, and with it every node that must be split so that neighbours differ by at most one level.
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

/// The leaves of a LOD cut.
fn leaf_ids(split: &HashSet<NodeId>) -> impl Iterator<Item = NodeId> {
    let nodes = NodeId::roots().into_iter().chain(split.iter().flat_map(|id| id.children()));
    nodes.filter(|id| !split.contains(id))
}

/// The tile of a node, or of its nearest ancestor that has one.
fn nearest_tile(id: NodeId, cache: &Cache) -> Option<Arc<Tile>> {
    std::iter::successors(Some(id), |id| id.parent()).find_map(|id| cache.tile(id))
}

/// The leaves, each with its parent edges and, if it is there, its detail texture.
fn leaves(choice: &Choice, cache: &Cache) -> Vec<Leaf> {
    let split = &choice.split;
    let mut ids: Vec<NodeId> = leaf_ids(split).collect();
    ids.sort_unstable();
    let mut details: HashMap<NodeId, Option<Shading>> = HashMap::new();
    ids.into_iter()
        .filter_map(|id| {
            let coarser = |edge: &Edge| id.neighbour(*edge).parent().is_some_and(|parent| !split.contains(&parent));
            let finer = |edge: &Edge| split.contains(&id.neighbour(*edge));
            let mask = |is: &dyn Fn(&Edge) -> bool| {
                Edge::ALL.iter().filter(|edge| is(edge)).fold(0, |mask, edge| mask | edge.bit())
            };
            let (coarser_edges, finer_edges) = (mask(&coarser), mask(&finer));
            let tile = cache.tile(id)?;
            let mut shaded = id;
            while let Some(parent) = shaded.parent().filter(|_| !choice.own_detail.contains(&shaded)) {
                shaded = parent;
            }
            let shading = details.entry(shaded).or_insert_with(|| shading(shaded, cache));
            let (shading_tile, detail) = shading.clone().unwrap_or_else(|| (tile.clone(), None));
            let horizon = cache.nearest_horizon(id);
            Some(Leaf { tile, coarser_edges, finer_edges, shading_tile, detail, horizon })
        })
        .collect()
}

/// The tile whose detail texture is shown, and that texture or the one of the nearest ancestor that has one.
type Shading = (Arc<Tile>, Option<Arc<DetailTile>>);

fn shading(id: NodeId, cache: &Cache) -> Option<Shading> {
    let detail = |id: NodeId| cache.tile(id).and_then(|tile| cache.detail(&tile));
    let detail = std::iter::successors(Some(id), |id| id.parent()).find_map(detail);
    Some((cache.tile(id)?, detail))
}
