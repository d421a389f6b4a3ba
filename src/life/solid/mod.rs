//! What bodies hit of the objects on the ground, and what moves among them.
//!
//! - `shape`: solid shapes of forms, from their meshes; `stem`, `rod`, `hull`: trunks, and convex parts
//! - `forms`: the shapes of a planet's populations; `block`: solid objects of a cell
//! - [`ObjectPatch`]: contacts, sweeps and rays against them
//! - [`HiddenObjects`]: objects that a game hides
//! - [`Surroundings`]: the ground and the objects

mod block;
mod forms;
mod hidden;
mod hull;
mod patch;
mod rod;
mod shape;
mod stem;
mod surroundings;
#[cfg(test)]
mod tests;

pub use hidden::{HiddenObjects, ObjectId};
pub use patch::{Met, ObjectPatch, RayHit};
pub use surroundings::Surroundings;
