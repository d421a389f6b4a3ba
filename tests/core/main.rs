//! Tests of the core: presets, evaluator, level of detail, tiles. They need neither the GPU nor the user interface.
//!
//! - `preset`, `heightmap`, `nonsense`: files and values, good and bad
//! - `extremes`: valid planets at the ends of their ranges
//! - `idle`: parameters without effect
//! - `header`: the C header
//! - `fuzz`: changed files of strangers; `words`: what is said of them
//! - `saving`: saves that are killed; `beside`: edits in a file beside the preset
//! - `allocations`: queries that allocate nothing
//! - `sphere`, `landforms`, `joining`, `relief`, `terrain`: the evaluator
//! - `lod`, `rebuild`: level of detail and incremental rebuilds
//! - `sculpt`, `images`, `stamp`, `erosion`, `paint`, `masks`, `structural`: ground edits
//! - `rivers`: water on the whole course of rivers
//! - `physics`, `ground`, `walker`: contacts, sweeps, and those who walk
//! - `system`: orbits and resonances; `trial`: what trials of systems find
//! - `meshes`: meshes of artists that populations have; `textures`: texture sets of biomes
//! - `life`: what stands on the ground; `lie`: by water, ridges and hollows; `planting`: by hand; `solid`: what of it
//!   is hit
//! - `water`: rivers, lakes and weather of a structure
//! - `spread`: points far apart among rivers
//! - `atmosphere`: the CPU reference of the air
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod allocations;
mod atmosphere;
mod beside;
mod erosion;
mod extremes;
mod fuzz;
mod ground;
mod header;
mod heightmap;
mod idle;
mod images;
mod joining;
mod landforms;
mod lie;
mod life;
mod lod;
mod masks;
mod meshes;
mod nonsense;
mod paint;
mod physics;
mod planting;
mod preset;
mod rebuild;
mod relief;
mod rivers;
mod saving;
mod scenery;
mod sculpt;
mod solid;
mod sphere;
mod spread;
mod stages;
mod stamp;
mod structural;
mod structure;
mod system;
mod terrain;
mod textures;
mod trial;
mod walker;
mod water;
mod words;

#[path = "../support"]
mod support {
    pub mod dice;
    pub mod edits;
    pub mod glb;
    pub mod layered;
    pub mod png;
    pub mod textures;
}
