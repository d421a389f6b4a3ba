//! What stands on the ground: where the objects of a planet's populations are, and the meshes of their forms.
//!
//! - [`form`]: meshes of forms; `model`: those of a population
//! - `grid`: cells of a population and the candidates in them; `hash`: their random numbers
//! - `soil`: what the ground of a node offers
//! - `suitability`: how well a place suits a population
//! - `placement`: the objects of a cell
//! - `planting_map`: what edits make of populations, for what is seen from afar; `lie_shares`: what water, ridges and
//!   hollows make of them
//! - `canopy`: what populations cover of the ground
//! - `census`: how many objects stand on a whole planet
//! - [`query`]: objects of a terrain, for games and exports; `nearest`: the nearest one
//! - `solid`: what bodies hit of objects, and what moves among them
//! - [`scenery`]: the objects that a view draws, kept from one view to the next; `around`: their cells;
//!   [`thinning`]: how many of them, and how wide, at a distance
//!
//! A cell of a population is a node of the quadtree. Each candidate in it has a place, a size and a rank by integer
//! hash of the population's seed and the node, and stands if its rank is below the density there. The density follows
//! from [`Sample`](crate::terrain::Sample)s, so lists are the same bits on every machine, and objects stand on the
//! ground that queries answer.

mod around;
pub(crate) mod canopy;
mod census;
pub mod form;
mod grid;
mod hash;
#[cfg(feature = "render")]
mod lie_shares;
mod model;
mod nearest;
mod placement;
#[cfg(feature = "render")]
pub(crate) mod planting_map;
pub mod query;
pub mod scenery;
mod soil;
mod solid;
pub(crate) mod suitability;
pub mod thinning;

pub use canopy::{Canopies, Canopy};
pub use model::Model;
pub use nearest::NearestObject;
pub use query::{Instance, TooMany};
pub use scenery::{Scenery, SceneryCell};
pub use solid::{HiddenObjects, Met, ObjectId, ObjectPatch, RayHit, Surroundings};
