//! Tiles from nodes, on all cores, off the caller's thread.
//!
//! - `make`: one tile from one node, stage by stage
//! - `normals`: the normal tile of one node
//! - `cache`: tiles kept for later, and for the stages an edit leaves intact
//! - `refine`: a complete set of tiles for a view
//! - [`builder`]: all of it in the background
pub mod builder;
mod cache;
mod make;
mod normals;
mod refine;

pub use builder::Builder;
pub use refine::lowest_radius_m;

use crate::lod::tile::NormalTile;
use crate::lod::{Culling, Tile, View};
use crate::planet::Planet;
use crate::terrain::Terrain;
use rayon::prelude::*;
use std::sync::Arc;

/// A complete set of tiles that covers the whole planet without a gap; what the renderer draws.
pub struct Surface {
    /// The evaluator the tiles were made with.
    pub terrain: Arc<Terrain>,
    /// The tiles that are shown, each with its edge mask for [`crate::lod::stitch::triangle_indices`].
    pub leaves: Vec<Leaf>,
    /// Whether every tile is as fine as the view asks; if not, a finer surface follows.
    pub complete: bool,
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

/// What building a surface took.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct BuildStats {
    /// Tiles in the surface.
    pub tiles: usize,
    /// Vertices in the surface.
    pub vertices: usize,
    /// Tiles (re)built for it.
    pub tiles_built: usize,
    /// Octaves of noise times points that were evaluated.
    pub octave_samples: usize,
    /// Seconds from the request to the finished surface.
    pub duration_secs: f64,
}

/// Builds the complete surface for a view and waits for it.
pub fn build_now(planet: &Arc<Planet>, view: &View) -> Surface {
    refine::refine(&Arc::new(Terrain::new(planet.clone())), view, &cache::Cache::default(), &|| true)
}

/// Finds the normal tiles of all that a view shows of a surface, and waits for them.
pub fn add_normals(surface: &mut Surface, view: &View) {
    let culling = Culling::new(view, lowest_radius_m(&surface.terrain));
    let terrain = &surface.terrain;
    surface.leaves.par_iter_mut().filter(|leaf| leaf.normals.is_none() && culling.sees(&leaf.tile)).for_each(|leaf| {
        leaf.normals = Some(Arc::new(normals::make_normal_tile(terrain, leaf.tile.id)));
    });
}
