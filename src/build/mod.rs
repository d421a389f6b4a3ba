//! Tiles from nodes, on all cores, off the caller's thread.
pub mod tile;

pub use tile::{Tile, Vertex};

use crate::lod::View;
use crate::planet::Planet;
use crate::terrain::Terrain;
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
    /// Seconds from the request to the finished surface.
    pub duration_secs: f64,
}

/// Builds surfaces in the background: the newest planet and view win, stale work is dropped.
pub struct Builder {}

impl Builder {
    /// Starts the workers. `wake` is called from another thread whenever a new surface is ready.
    pub fn new(_wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self {}
    }
    /// Asks for a planet as seen from a view. Cheap when nothing changed since the last call; call it every frame.
    pub fn request(&self, _planet: &Arc<Planet>, _view: &View) {}
    /// The newest surface, complete or not.
    pub fn surface(&self) -> Option<Arc<Surface>> {
        None
    }
    /// Whether work is under way.
    pub fn is_busy(&self) -> bool {
        false
    }
}

/// Builds the complete surface for a view and waits for it.
pub fn build_now(_planet: &Arc<Planet>, _view: &View) -> Surface {
    Surface {
        leaves: Vec::new(),
        terrain: Arc::new(Terrain::new(_planet.clone())),
        complete: true,
        stats: BuildStats::default(),
    }
}
