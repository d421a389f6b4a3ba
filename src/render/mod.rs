//! Draws planets with wgpu, on the caller's own device.
//!
//! A [`Scene`] holds a camera, suns and bodies. [`Renderer::render`] draws it into one texture. A game that has things
//! of its own to draw uses the stages instead: [`Renderer::prepare`], then of [`PreparedFrame`] `draw_opaque`, its own
//! draw calls into the same targets, `draw_air`, and `draw_post` or a post-process of its own.
//!
//! - `scene`: what is drawn; `debug_view`: or in its place. `renderer`: resources and preparation. `prepared`: the
//!   stages. `error`: what can go wrong
//! - `passes`: the list of all passes; `screen_pass`: a pass over all pixels; `targets`: the textures between them
//! - `variant`: pipelines leave out what a body does not need; `nearness`: what no pixel resolves from afar
//! - opaque stage: `morph` (compute), `terrain` with `ground_view`, `body_tiles`, `pool`, `layer_pool`, `detail_pool`,
//!   `horizon_pool`; then `life` (objects on the ground) and `water`
//! - air stage: `clouds`, `air`, `aurora`; `copy` where there is no air
//! - post-process: `exposure` (compute), `bloom`, `tonemap` with `tone` and `white_balance`, `antialias`, `display`
//! - `history`: what a view keeps for its next frame: clouds while the camera moves, and `still`, the mean of a still
//!   scene
//! - `caster`: things of a game that cast shadows
//! - `photo`: pictures of any size, in tiles, of many samples, through a lens
//! - `luts`: LUTs of the air, `cloud_map`, `biome_table`, the tiles `noise_tile` and `border_tile`, and the `patterns`
//!   of the ground
//! - `uniform_groups`, `uniforms`, `shared`, `wgsl`: what Rust and WGSL share, from one source; [`shaders`]: includes,
//!   checks, hot reload
//! - `worlds`: the bodies of a system around a camera: places, lights, points
//! - `gpu`: helpers around wgpu; `sky_probe`: single rays through the shaders of the air
//! - `resident`: the memory that all of it takes
//!
//! Each pass is named like its shader in `shaders/`. A new pass is a file here, a file there, and a line in `passes`.

mod air;
mod antialias;
mod aurora;
mod biome_table;
mod bloom;
mod body_tiles;
mod border_tile;
mod caster;
mod cloud_map;
mod clouds;
mod copy;
mod debug_view;
mod detail_pool;
mod display;
mod error;
mod exposure;
mod gpu;
mod ground_view;
mod history;
mod horizon_pool;
mod layer_pool;
mod legend;
mod life;
mod luts;
mod morph;
mod nearness;
mod noise_tile;
mod passes;
mod patterns;
mod photo;
mod pool;
mod prepared;
mod renderer;
mod resident;
mod scene;
mod screen_pass;
pub mod shaders;
mod shared;
mod sky_probe;
mod still;
mod targets;
mod terrain;
mod tone;
mod tonemap;
mod uniform_groups;
mod uniforms;
mod variant;
mod water;
mod wgsl;
mod white_balance;
mod worlds;

pub use biome_table::MarkedCells;
pub use caster::{ShadowCaster, ShadowView};
#[cfg(feature = "cli")]
pub(crate) use cloud_map::cloud_keyframe;
pub use debug_view::DebugView;
pub use error::RenderError;
pub use exposure::{Metered, Metering};
pub use gpu::{read_texture, texture};
pub use legend::{Color, Legend};
pub use life::{FormCamera, FormMesh, FormTarget, FormView};
pub use luts::LutRuns;
pub use photo::{Develop, Lens, Photo};
pub use prepared::{OpaqueTargets, PreparedFrame};
pub use renderer::Renderer;
pub use scene::{Body, BodyId, Matrices, Point, Post, Projection, Reuse, Scene, Sun, ViewId, split_position};
pub use shaders::{air_wgsl, caster_wgsl};
pub use shared::{MAX_POINTS, MAX_SUNS};
pub use sky_probe::SkyAnswer;
pub use targets::{DEPTH_FORMAT, RADIANCE_FORMAT};
pub use tone::Tone;
pub(crate) use tone::srgb_from_linear;
/// The GPU crate of all signatures.
pub use wgpu;
pub use white_balance::white_balance;
pub use worlds::{Around, Neighbour, Worlds, mean_albedo};

/// What one frame drew.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct FrameStats {
    /// Tiles drawn after culling.
    pub tiles_drawn: usize,
    /// Triangles drawn.
    pub triangles: usize,
    /// Objects drawn that stand on the ground.
    pub objects_drawn: usize,
}
