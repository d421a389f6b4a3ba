//! Tiles from nodes, on all cores, off the caller's thread.
//!
//! - `make`: one tile from one node, stage by stage; `mesh`: its vertices
//! - `kept`: the layer fields of one tile, present and past
//! - `normals`: the normal tile of one node
//! - `cache`: tiles kept for later, and for the stages an edit leaves intact
//! - `refine`: a complete set of tiles for a view
//! - [`builder`]: all of it in the background
//! - `stats`: what it took
pub mod builder;
mod cache;
mod kept;
mod make;
mod mesh;
mod normals;
mod refine;
mod stats;

pub use builder::Builder;
pub use cache::DEFAULT_BUDGET_BYTES;
pub use refine::lowest_radius_m;
pub use stats::{BuildStats, Memory, StageWork};

use crate::lod::tile::NormalTile;
use crate::lod::{Culling, Tile, View};
use crate::planet::Planet;
use crate::terrain::Terrain;
use rayon::prelude::*;
use std::sync::Arc;
use std::time::Instant;

/// A complete set of tiles that covers the whole planet without a gap; what the renderer draws.
pub struct Surface {
    /// The evaluator the tiles were made with.
    pub terrain: Arc<Terrain>,
    /// The tiles that are shown, each with its edge mask for [`crate::lod::stitch::triangle_indices`].
    pub leaves: Vec<Leaf>,
    /// Whether every tile is as fine as the view asks; if not, a finer surface follows.
    pub complete: bool,
    /// When it was asked for; the times in `stats` count from there.
    pub asked: Instant,
    /// What it took.
    pub stats: BuildStats,
}

/// A tile as it stands among its neighbours.
#[derive(Clone, Debug)]
pub struct Leaf {
    /// The mesh.
    pub tile: Arc<Tile>,
    /// Bits of [`crate::sphere::Edge::bit`]: edges beyond which the neighbour is one level coarser.
    pub coarser_edges: u8,
    /// Slopes finer than the mesh, once they are there.
    pub normals: Option<Arc<NormalTile>>,
}

/// Builds the complete surface for a view and waits for it.
pub fn build_now(planet: &Arc<Planet>, view: &View) -> Surface {
    let terrain = Arc::new(Terrain::new(planet.clone()));
    let cache = cache::Cache::new(DEFAULT_BUDGET_BYTES);
    refine::refine(&terrain, view, &cache, Instant::now(), BuildStats::default(), &|| true)
}

/// Finds the normal tiles of all that a view shows of a surface, and waits for them.
pub fn add_normals(surface: &mut Surface, view: &View) {
    let culling = Culling::new(view, lowest_radius_m(&surface.terrain));
    let terrain = &surface.terrain;
    surface.leaves.par_iter_mut().filter(|leaf| leaf.normals.is_none() && culling.sees(&leaf.tile)).for_each(|leaf| {
        leaf.normals = Some(Arc::new(normals::make_normal_tile(terrain, leaf.tile.id)));
    });
}
