//! The sphere as six squares: faces, the mapping between a square and the sphere, node addresses, latitude and
//! longitude.
//!
//! The planet frame is right-handed, in metres, with its origin at the centre: +Z through the north pole, +X through
//! latitude 0, longitude 0, +Y through longitude 90° east.
//!
//! - [`cube`]: faces and the mapping, with its inverse
//! - [`node`]: addresses of quadtree nodes and their neighbours across all face edges
//! - [`geo`]: latitude, longitude, local north and east, evenly spread directions
//! - `curve`: the order in which far points are best asked
//! - [`tangent`]: the local frame of a place
//! - [`raster`]: grids of numbers over the sphere, sampled smoothly

pub mod cube;
#[cfg(feature = "bake")]
pub(crate) mod curve;
pub mod geo;
pub mod node;
pub mod raster;
pub mod tangent;

pub use cube::Face;
pub use geo::{LatLon, spread};
pub use node::{Edge, NodeId};
pub use tangent::Tangent;
