//! Tiles from nodes, on all cores, off the caller's thread.
//!
//! - `make`: one tile from one node, stage by stage; `mesh`: its vertices; `deviation`: their heights above coarser
//!   meshes
//! - `detail`: detail textures; `horizon`: horizon angles; `sunlight`: the shadow of the ground at a place by them
//! - `cache`: tiles of earlier requests, whole or as inputs for stages
//! - `refine`: the LOD cut of a view; `sew`: seams between its tiles
//! - [`builder`]: surfaces in the background; `worker`: its thread
//! - `stats`: time and memory
pub mod builder;
mod cache;
mod detail;
mod deviation;
mod horizon;
mod make;
mod mesh;
mod refine;
mod sew;
mod stats;
mod sunlight;
mod worker;

pub use builder::{BuildProgress, Builder, BuilderOptions};
pub use cache::DEFAULT_BUDGET_BYTES;
pub use horizon::HorizonWork;
pub use refine::budget_tiles;
use refine::{Goal, refine};

pub use stats::{BuildStats, Memory, StageWork};

use crate::life::scenery::{Scenery, SceneryCache};
pub use crate::lod::cull::lowest_radius_m;
use crate::lod::horizon::HorizonTile;
use crate::lod::tile::DetailTile;
use crate::lod::{Culling, Ranges, Tile, View};
use crate::planet::{InvalidPlanet, Planet};
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use crate::terrain::coarse::CellFields;
pub use crate::world::{MapLevel, MapWork};
use glam::DVec3;
use rayon::prelude::*;
use std::collections::HashMap;
use std::sync::Arc;
use std::time::Instant;

/// A complete set of tiles that covers the whole planet without a gap. The renderer draws it.
#[derive(Clone)]
#[non_exhaustive]
pub struct Surface {
    /// The terrain that the tiles were made with.
    pub terrain: Arc<Terrain>,
    /// The leaves, each with its edge mask for [`crate::lod::stitch::triangle_indices`].
    pub leaves: Vec<Leaf>,
    /// Plants, stones and other objects on the ground, as far as they are there.
    pub scenery: Scenery,
    /// Whether every tile is as fine as the view asks and the world maps are final. If not, a better surface follows.
    pub complete: bool,
    /// The view that it was made for.
    pub view: View,
    /// The ranges of the LOD cut, which also shape the morph.
    pub ranges: Ranges,
    /// When it was requested. The times in `stats` count from here.
    pub asked: Instant,
    /// Time that it took.
    pub stats: BuildStats,
}

/// A leaf of the LOD cut: a tile and its neighbourhood.
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct Leaf {
    /// The mesh.
    pub tile: Arc<Tile>,
    /// Parent edges, as bits of [`crate::sphere::Edge::bit`]: edges beyond which the neighbour is one level coarser.
    pub coarser_edges: u8,
    /// Edges beyond which the neighbour is one level finer, as bits of [`crate::sphere::Edge::bit`].
    pub finer_edges: u8,
    /// The tile whose detail texture is to be shown: this one, or an ancestor if the mesh is finer than shading needs.
    pub shading_tile: Arc<Tile>,
    /// The detail texture of `shading_tile`, or of an ancestor of it until that is there.
    pub detail: Option<Arc<DetailTile>>,
    /// Its horizon angles, or those of an ancestor; perhaps of an earlier revision while new ones are computed.
    pub horizon: Option<Arc<HorizonTile>>,
}

impl Leaf {
    /// Whether the detail texture that is to be shown is there.
    fn has_own_detail(&self) -> bool {
        self.detail.as_ref().is_some_and(|detail| detail.heights_serial == self.shading_tile.heights_serial)
    }
}

impl Surface {
    /// The eye position for the morph ([`crate::lod::morph`]) when the surface is seen from `eye_planet_m`: that
    /// position, clamped to the distance from the LOD cut's own eye within which tiles know the older vertices of their
    /// neighbours.
    pub fn morphing_eye_m(&self, eye_planet_m: DVec3) -> DVec3 {
        let chosen_m = self.view.camera.position_planet_m;
        let finest = self.leaves.iter().map(|leaf| leaf.tile.id.level).max().unwrap_or(0);
        let allowed_m = self.ranges.eye_spacings() * self.ranges.spacing_m(finest);
        chosen_m + (eye_planet_m - chosen_m).clamp_length_max(allowed_m)
    }
}

/// Builds the complete surface for a view and waits for it.
///
/// # Errors
/// As [`Terrain::try_new`].
pub fn build_now(planet: &Arc<Planet>, view: &View) -> Result<Surface, InvalidPlanet> {
    let (mut stats, fields) = (BuildStats::default(), CellFields::default());
    let terrain = Arc::new(Terrain::try_new_with(planet.clone(), &fields, &mut stats.maps)?);
    stats.octave_samples = fields.take_octave_samples();
    Ok(built(&terrain, view, stats, &Limits::default()))
}

/// The same of a terrain, with the world maps that serve it.
pub fn build_over(terrain: &Arc<Terrain>, view: &View) -> Surface {
    built(terrain, view, BuildStats::default(), &Limits::default())
}

/// What the ground of a picture may take.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Limits {
    /// When building ends; the coarsest level is built in any case. None: when all is there.
    pub until: Option<Instant>,
    /// Bytes of the tiles, of what they are built from, and of their detail textures. The LOD bias rises until they
    /// fit, down to some tens of tiles. World maps and height pictures are not counted, nor what a renderer copies to
    /// the GPU. None: what the triangle budget of the quality takes, [`budget_tiles`].
    pub bytes: Option<usize>,
}

impl Limits {
    fn leave_time(&self) -> bool {
        self.until.is_none_or(|until| Instant::now() < until)
    }
}

/// As [`build_over`], within limits. The surface has no gaps; whether the time was enough tells [`Surface::complete`].
pub fn build_within(terrain: &Arc<Terrain>, view: &View, limits: &Limits) -> Surface {
    built(terrain, view, BuildStats::default(), limits)
}

fn built(terrain: &Arc<Terrain>, view: &View, stats: BuildStats, limits: &Limits) -> Surface {
    let cache = cache::Cache::new(limits.bytes.unwrap_or(DEFAULT_BUDGET_BYTES).min(DEFAULT_BUDGET_BYTES));
    cache.serve(terrain);
    let goal = Goal::new(view, Instant::now());
    let goal = limits.bytes.map_or(goal, |bytes| goal.within(bytes));
    refine(terrain, &goal, &cache, &mut None, stats, &|| limits.leave_time())
}

/// Computes the horizon angles and detail textures of all tiles that a view shows, and its scenery, and waits for them.
pub fn add_detail(surface: &mut Surface, view: &View) {
    add_detail_within(surface, view, &Limits::default());
}

/// As [`add_detail`], nearest tiles first, while the limits leave time. Whether all of them are there.
pub fn add_detail_within(surface: &mut Surface, view: &View, limits: &Limits) -> bool {
    let in_time = || limits.leave_time();
    horizon::HorizonFinder::new(surface, view).find(surface, &|_| None, &|_| {}, &in_time, &in_time);
    let is_whole = find_detail(surface, view, &|_, _| {}, &in_time, &in_time);
    let (scenery, has_all) = SceneryCache::default().find(&surface.terrain, view, &in_time);
    surface.scenery = scenery;
    is_whole && has_all
}

/// Computes the detail textures of the tiles that a view shows, nearest tiles first, while `keep_going` says yes; a
/// texture that was begun is finished while `wanted` says yes. Each is passed to `keep`. Returns whether all of them
/// are there.
pub(crate) fn find_detail(
    surface: &mut Surface,
    view: &View,
    keep: &(dyn Fn(&Tile, &Arc<DetailTile>) + Sync),
    keep_going: &(dyn Fn() -> bool + Sync),
    wanted: &(dyn Fn() -> bool + Sync),
) -> bool {
    let culling = Culling::new(view, lowest_radius_m(&surface.terrain));
    let eye = view.camera.position_planet_m;
    let terrain = surface.terrain.clone();
    let lacking = surface.leaves.iter().filter(|leaf| !leaf.has_own_detail() && culling.sees(&leaf.tile));
    let missing: HashMap<NodeId, Arc<Tile>> =
        lacking.map(|leaf| (leaf.shading_tile.id, leaf.shading_tile.clone())).collect();
    let mut missing: Vec<Arc<Tile>> = missing.into_values().collect();
    let away_m = |tile: &Tile| tile.center_planet_m.distance(eye) - tile.bounding_radius_m;
    missing.sort_by(|a, b| away_m(a).total_cmp(&away_m(b)).then(a.id.cmp(&b.id)));
    // In rounds of one tile for each thread, which keeps the order and can be stopped in between.
    let side = rayon::current_num_threads().max(1);
    missing.chunks(side).all(|round| {
        if !keep_going() {
            return false;
        }
        let made: HashMap<NodeId, Arc<DetailTile>> = round
            .par_iter()
            .filter_map(|tile| {
                let detail = Arc::new(detail::make_detail(&terrain, tile, wanted)?);
                keep(tile, &detail);
                Some((tile.id, detail))
            })
            .collect();
        for leaf in &mut surface.leaves {
            if let Some(detail) = made.get(&leaf.shading_tile.id) {
                leaf.detail = Some(detail.clone());
            }
        }
        made.len() == round.len()
    })
}
