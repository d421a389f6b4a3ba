//! Tests of the renderer, on whichever adapter wgpu's environment variables choose. A test without an adapter fails.
//!
//! - `shaders`: every WGSL file through naga
//! - `air`, `sky`: the atmosphere, against goldens and against the CPU reference
//! - `albedo`: what grounds, seas and clouds reflect, from orbit
//! - `biomes`, `colours`, `materials`, `textures`: the colours of the ground
//! - `casters`: things of a game: the shadows that they cast, and those that fall on them
//! - `clouds`: clouds over time, drafts of their maps
//! - `cloud_edges`: clouds near the horizon: stairs and stripes
//! - `cloud_light`: light under clouds: rain, fog, night
//! - `lakes`: water of planets with a structure
//! - `meshes`: meshes of artists as objects
//! - `life`: objects on the ground and their shadows; `planting`: what strokes clear and plant of them, from afar;
//!   `density`: how many stand where, as a picture; `forms`: pictures of single forms
//! - `neighbours`: shadows and light between bodies, rings
//! - `night`: airglow, aurora, lights of settlements
//! - `history`: clouds carried over while the camera moves, and still pictures that converge
//! - `edges`, `shimmer`, `lod_pictures`, `shadows`: pictures against finer pictures and ray casts
//! - `planets`: the shipped presets, against goldens
//! - `photo`: photographs: tiles, samples, the lens
//! - `render`: passes, stages and errors of the renderer
//! - `ring_pieces`: rings near the eye, against the plane layer
//! - `scene`: several bodies, the caller's targets, projections and viewports
//! - `sea`: waves, the view from below, floes
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout, missing_docs)]

mod air;
mod albedo;
mod biomes;
mod casters;
mod cloud_edges;
mod cloud_light;
mod clouds;
mod colours;
mod density;
mod edges;
mod forms;
mod history;
mod lakes;
mod life;
mod lod_pictures;
mod materials;
mod meshes;
mod neighbours;
mod night;
mod photo;
mod planets;
mod planting;
mod render;
mod ring_pieces;
mod scene;
mod sea;
mod shaders;
mod shadows;
mod shimmer;
mod sky;
mod textures;

#[path = "../support/glb.rs"]
mod glb;
#[path = "../support/mod.rs"]
mod support;
