//! Draws a planet with wgpu into any texture view on the caller's own device.
//!
//! One frame, pass by pass; each file is named like its shader in `shaders/`:
//! - `tables` with `air_tables`, `cloud_map`, `biome_table`, `noise_tile`, `material_maps` (of `material_kinds`, by
//!   `material_noise`): what outlives a frame, made anew only when what it depends on changed
//! - `morph`: how far vertices have come out of the coarser mesh
//! - `terrain` with `pool`, and `layer_pool` for `detail_pool` and `horizon_pool`: the ground into radiance and depth
//! - `water`: the sea over it
//! - `clouds`: their light, transmittance and distance
//! - `air`: the air in front of everything, stars and the star's disc behind it
//! - `exposure`: how bright the picture is, and what exposure suits it
//! - `tonemap` with `tone`: radiance to what is shown
//! - `antialias`: smooth edges
//! - `display`: into the target, in its size
//!
//! `sky_probe` asks the shaders of the air about single rays.
//!
//! Around them: `shaders` (includes, checks, hot reload), `globals` (the uniform buffer), `targets`, `gpu` (helpers),
//! `scene_pass` (what the full-screen passes over the scene share), `white_balance` (what the camera takes for white).

mod air;
mod air_tables;
mod antialias;
mod biome_table;
mod border_tile;
mod cloud_map;
mod clouds;
mod detail_pool;
mod display;
mod exposure;
mod globals;
mod gpu;
mod horizon_pool;
mod layer_pool;
mod material_kinds;
mod material_maps;
mod material_noise;
mod morph;
mod noise_tile;
mod pool;
mod scene_pass;
pub mod shaders;
mod sky_probe;
mod tables;
mod targets;
mod terrain;
mod tone;
mod tonemap;
mod water;
mod white_balance;

pub use biome_table::MarkedCells;
pub use exposure::Metering;
pub use sky_probe::SkyAnswer;
pub use tables::TableRuns;
pub use tone::Tone;
pub use white_balance::white_balance;

use crate::lod::{Quality, View};
use crate::planet::{InvalidPlanet, Planet};
use crate::tiles::Surface;
use glam::DVec3;
use std::sync::Arc;

/// What is drawn of the surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum DebugView {
    /// The planet.
    #[default]
    Shaded,
    /// Height, from the lowest to the highest of the surface.
    Height,
    /// The normal in the planet frame as a colour.
    Normal,
    /// Angle against the horizontal, 0 to 60°.
    Slope,
    /// The biome's colour by itself.
    Biome,
    /// Temperature, -40 to 40 °C.
    Temperature,
    /// Moisture, dry to wet.
    Moisture,
    /// The tile's level in the quadtree.
    Lod,
    /// Lines where tiles meet.
    TileBorders,
    /// The edges of the triangles.
    Wireframe,
    /// Vertex spacing in pixels of the picture, as the level of detail sees it: blue 1, green 4, yellow 16, red 64.
    Error,
    /// White where there is ground, black elsewhere.
    Coverage,
    /// The ground's own colour (its albedo), patterns and all, without light.
    Albedo,
}

impl DebugView {
    /// All of them.
    pub const ALL: [DebugView; 13] = [
        DebugView::Shaded,
        DebugView::Height,
        DebugView::Normal,
        DebugView::Slope,
        DebugView::Biome,
        DebugView::Temperature,
        DebugView::Moisture,
        DebugView::Lod,
        DebugView::TileBorders,
        DebugView::Wireframe,
        DebugView::Error,
        DebugView::Coverage,
        DebugView::Albedo,
    ];

    /// The name a person reads.
    pub fn label(self) -> &'static str {
        match self {
            DebugView::Shaded => "Shaded",
            DebugView::Height => "Height",
            DebugView::Normal => "Normal",
            DebugView::Slope => "Slope",
            DebugView::Biome => "Biome",
            DebugView::Temperature => "Temperature",
            DebugView::Moisture => "Moisture",
            DebugView::Lod => "Level",
            DebugView::TileBorders => "Tile borders",
            DebugView::Error => "Error",
            DebugView::Wireframe => "Wireframe",
            DebugView::Coverage => "Coverage",
            DebugView::Albedo => "Albedo",
        }
    }
}

/// One picture.
pub struct Frame<'a> {
    /// The tiles.
    pub surface: &'a Surface,
    /// The planet for everything that is not in the tiles: it may be newer than the surface's.
    pub planet: &'a Planet,
    /// Camera, size of the target (exactly), quality.
    pub view: View,
    /// The view that the tiles were chosen for, if it is another: they are culled and blended as seen from there.
    pub frozen: Option<View>,
    /// Unit vector from the planet to its star.
    pub sun_dir_planet: DVec3,
    /// Seconds since time zero: drift of the clouds, waves.
    pub time_secs: f64,
    /// Exposure in stops, of which 0 suits a sunlit planet; with automatic exposure ([`Renderer::metering`]) a correction to it.
    pub exposure_ev: f64,
    /// Shaded, or a debug view.
    pub debug_view: DebugView,
}

/// Why the renderer could not do what was asked.
#[derive(Debug, thiserror::Error)]
pub enum RenderError {
    /// A shader does not compile: what naga or the driver says, with the file and line it comes from.
    #[error("{0}")]
    Shader(String),
    /// The device does not answer.
    #[error("the device: {0}")]
    Device(String),
    /// The target has another size than the picture: what lies beyond the picture would be streaks.
    #[error(
        "the target is {} x {} pixels and the frame's view {} x {}; set the view's size_px to the target's size",
        target_px[0], target_px[1], view_px[0], view_px[1]
    )]
    TargetSize {
        /// Width and height of the target's texture.
        target_px: [u32; 2],
        /// [`View::size_px`] of the frame.
        view_px: [u32; 2],
    },
    /// The planet is one that no preset may describe.
    #[error(transparent)]
    Planet(#[from] InvalidPlanet),
}

/// What one frame drew.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameStats {
    /// Tiles drawn after culling.
    pub tiles_drawn: usize,
    /// Triangles drawn.
    pub triangles: usize,
}

/// Every pipeline; made anew as a whole when a shader changes on disk.
pub(crate) struct Passes {
    air_tables: air_tables::AirTablesPass,
    cloud_map: cloud_map::CloudMapPass,
    morph: morph::MorphPass,
    terrain: terrain::TerrainPass,
    water: water::WaterPass,
    clouds: clouds::CloudsPass,
    air: air::AirPass,
    exposure: exposure::ExposurePass,
    tonemap: tonemap::TonemapPass,
    antialias: antialias::AntialiasPass,
    display: display::DisplayPass,
}

impl Passes {
    fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        tables: &wgpu::BindGroupLayout,
        target_format: wgpu::TextureFormat,
    ) -> Result<Self, RenderError> {
        Ok(Self {
            air_tables: air_tables::AirTablesPass::new(device, globals, tables)?,
            cloud_map: cloud_map::CloudMapPass::new(device, globals)?,
            morph: morph::MorphPass::new(device)?,
            terrain: terrain::TerrainPass::new(device, globals, tables)?,
            water: water::WaterPass::new(device, globals, tables)?,
            clouds: clouds::CloudsPass::new(device, globals, tables)?,
            air: air::AirPass::new(device, globals, tables)?,
            exposure: exposure::ExposurePass::new(device)?,
            tonemap: tonemap::TonemapPass::new(device, globals)?,
            antialias: antialias::AntialiasPass::new(device, globals, tables)?,
            display: display::DisplayPass::new(device, globals, tables, target_format)?,
        })
    }
}

/// What the full-screen passes read, bound once for as long as targets and passes stay; each for either radiance target as
/// the scene.
struct Inputs {
    water: [wgpu::BindGroup; 2],
    clouds: [wgpu::BindGroup; 2],
    air: [wgpu::BindGroup; 2],
    exposure: [wgpu::BindGroup; 2],
    tonemap: [wgpu::BindGroup; 2],
    antialias: [wgpu::BindGroup; 2],
    /// Of the picture with the edges as they are, and with smooth ones.
    display: [[wgpu::BindGroup; 2]; 2],
}

impl Inputs {
    fn new(device: &wgpu::Device, passes: &Passes, targets: &targets::Targets) -> Self {
        Self {
            water: [0, 1].map(|scene| passes.water.bind(device, targets, scene)),
            clouds: [0, 1].map(|scene| passes.clouds.bind(device, targets, scene)),
            air: [0, 1].map(|scene| passes.air.bind(device, targets, scene)),
            exposure: [0, 1].map(|scene| passes.exposure.bind(device, &targets.hdr[scene])),
            tonemap: [0, 1].map(|scene| passes.tonemap.bind(device, targets, scene, &passes.exposure.result)),
            antialias: [0, 1].map(|scene| passes.antialias.bind(device, targets, scene)),
            display: [0, 1].map(|scene| {
                [targets.toned(scene), targets.smoothed()].map(|shown| passes.display.bind(device, shown))
            }),
        }
    }
}

/// All GPU state of one viewport.
pub struct Renderer {
    /// Whether exposure is set by hand or by what there is to see.
    pub metering: Metering,
    /// Cells of the biome table whose places light up; clouds are left away meanwhile.
    pub marked: Option<Arc<MarkedCells>>,
    /// The curve from radiance to the picture.
    pub tone: Tone,
    /// Whether edges are made smooth; without, each pixel is what the curve makes of its radiance.
    pub smooth_edges: bool,
    target_format: wgpu::TextureFormat,
    globals: globals::GlobalsBuffer,
    tables: tables::Tables,
    terrain: terrain::TerrainResources,
    targets: Option<(targets::Targets, Inputs)>,
    /// Which radiance target the newest frame ended in.
    scene: usize,
    passes: Passes,
    watch: shaders::Watch,
    shader_error: Option<String>,
}

impl Renderer {
    /// Features and limits to ask of the device; works on every adapter of the WebGPU default limits.
    pub fn required_limits() -> wgpu::Limits {
        wgpu::Limits::default()
    }
    /// Compiles the pipelines. `target_format` is what [`Renderer::render`] will draw into: `Rgba8UnormSrgb`,
    /// `Bgra8UnormSrgb` or their linear variants (`Rgba8Unorm`: gamma is then applied by the shader).
    pub fn new(
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target_format: wgpu::TextureFormat,
    ) -> Result<Self, RenderError> {
        let globals = globals::GlobalsBuffer::new(device);
        let tables = tables::Tables::new(device, queue);
        let passes = Passes::new(device, &globals.layout, &tables.layout, target_format)?;
        let terrain = terrain::TerrainResources::new(device);
        let (targets, watch, shader_error) = (None, shaders::Watch::new(), None);
        Ok(Self {
            metering: Metering::Manual,
            marked: None,
            tone: Tone::default(),
            smooth_edges: true,
            target_format,
            globals,
            tables,
            terrain,
            targets,
            scene: 0,
            passes,
            watch,
            shader_error,
        })
    }
    /// Uploads tiles of a surface ahead of the frame that will draw it, at most so many bytes (but at least one tile). Whether
    /// all are there now. Without it [`Renderer::render`] uploads what it needs at once.
    pub fn upload(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, surface: &Surface, budget_bytes: u64) -> bool {
        profiling::scope!("upload");
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("upload") });
        let done = self.terrain.upload(device, queue, &mut encoder, surface, budget_bytes);
        queue.submit([encoder.finish()]);
        done
    }
    /// Bytes of tiles uploaded since the start.
    pub fn uploaded_bytes(&self) -> u64 {
        self.terrain.uploaded_bytes()
    }
    /// How often each table has been made since the start.
    pub fn table_runs(&self) -> TableRuns {
        TableRuns { uniforms: self.globals.writes(), ..self.tables.runs() }
    }
    /// Draws one frame and submits it. The target is as large as the frame's view says.
    ///
    /// # Errors
    /// [`RenderError::TargetSize`]: it is not, and nothing is drawn.
    pub fn render(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        target: &wgpu::TextureView,
        frame: &Frame<'_>,
    ) -> Result<FrameStats, RenderError> {
        profiling::scope!("render");
        targets::check_size(target, frame.view.size_px, device.limits().max_texture_dimension_2d)?;
        self.reload_shaders(device);
        let (size_px, scale) = drawn_size(frame, device.limits().max_texture_dimension_2d);
        let (targets, inputs) = match self.targets.take().filter(|(targets, _)| targets.size_px == size_px) {
            Some(kept) => kept,
            None => {
                let targets = targets::Targets::new(device, size_px);
                let inputs = Inputs::new(device, &self.passes, &targets);
                (targets, inputs)
            }
        };
        let height_range_m = height_range_m(frame.surface);
        let setup = globals::Setup {
            size_px,
            scale,
            height_range_m,
            weather_side_px: tables::WEATHER_SIDE_PX,
            srgb_target: self.target_format.is_srgb(),
            marked: self.marked.is_some(),
            tone: self.tone,
        };
        self.globals.write(queue, frame, &setup);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
        self.terrain.prepare(device, queue, &mut encoder, frame, height_range_m.0);
        self.terrain.morph(&mut encoder, &self.passes.morph);
        let globals = &self.globals.group;
        self.tables.update((device, queue), &mut encoder, globals, &self.passes, frame.planet, self.marked.as_ref());
        let groups = [globals, self.tables.group()];

        let stats = self.terrain.draw(&mut encoder, &self.passes.terrain, groups, &targets, frame.debug_view);
        let mut scene = 0;
        if frame.debug_view == DebugView::Shaded {
            if frame.planet.water.is_some() {
                self.passes.water.draw(&mut encoder, groups, &inputs.water[scene], &targets, scene);
                scene = 1 - scene;
            }
            let cloudy = frame.planet.clouds.as_ref().is_some_and(|clouds| clouds.coverage > 0.0);
            if cloudy && self.marked.is_none() {
                self.passes.clouds.draw(&mut encoder, groups, &inputs.clouds[scene], &targets);
            }
            self.passes.air.draw(&mut encoder, groups, &inputs.air[scene], &targets, scene);
            scene = 1 - scene;
        }
        let metering = if frame.debug_view == DebugView::Shaded { self.metering } else { Metering::Manual };
        self.passes.exposure.draw(queue, &mut encoder, &inputs.exposure[scene], size_px, metering);
        self.passes.tonemap.draw(&mut encoder, globals, &inputs.tonemap[scene], targets.toned(scene));
        let smooth = self.smooth_edges && frame.debug_view == DebugView::Shaded;
        if smooth {
            self.passes.antialias.draw(&mut encoder, groups, &inputs.antialias[scene], &targets);
        }
        self.passes.display.draw(&mut encoder, groups, &inputs.display[scene][usize::from(smooth)], target);
        queue.submit([encoder.finish()]);
        self.targets = Some((targets, inputs));
        self.scene = scene;
        Ok(stats)
    }

    /// The radiance of the newest frame before exposure and curve, without stars: size of the picture as it was drawn, and red,
    /// green and blue of each pixel (1: white ground at noon). Waits for the device.
    pub fn radiance(
        &self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
    ) -> Result<([u32; 2], Vec<[f32; 3]>), RenderError> {
        let Some((targets, _)) = &self.targets else { return Ok(([0, 0], Vec::new())) };
        let [width, height] = targets.size_px;
        // Four halves a pixel; rows begin at multiples of 256 bytes.
        let row = (width * 8).next_multiple_of(wgpu::COPY_BYTES_PER_ROW_ALIGNMENT);
        let buffer = device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("radiance"),
            size: u64::from(row * height),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("radiance") });
        let texture = targets.hdr[self.scene].texture();
        let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(row), rows_per_image: None };
        let to = wgpu::TexelCopyBufferInfo { buffer: &buffer, layout };
        encoder.copy_texture_to_buffer(texture.as_image_copy(), to, texture.size());
        queue.submit([encoder.finish()]);
        let bytes = gpu::read(device, &buffer)?;
        let half = |bytes: &[u8]| half::f16::from_le_bytes([bytes[0], bytes[1]]).to_f32();
        let pixel = |bytes: &[u8]| [half(bytes), half(&bytes[2..]), half(&bytes[4..])];
        let line = |line: &[u8]| line[..width as usize * 8].chunks_exact(8).map(pixel).collect::<Vec<_>>();
        Ok((targets.size_px, bytes.chunks(row as usize).flat_map(line).collect()))
    }
    /// What is wrong with a shader that was just edited on disk (debug builds); the last good one goes on drawing.
    pub fn shader_error(&self) -> Option<&str> {
        self.shader_error.as_deref()
    }

    fn reload_shaders(&mut self, device: &wgpu::Device) {
        if !self.watch.changed() {
            return;
        }
        match Passes::new(device, &self.globals.layout, &self.tables.layout, self.target_format) {
            Ok(passes) => {
                self.passes = passes;
                self.targets = None;
                self.tables.forget();
                self.shader_error = None;
            }
            Err(error) => self.shader_error = Some(error.to_string()),
        }
    }
}

/// Pictures of more pixels than this are not supersampled: the targets would take gigabytes.
const MOST_SUPERSAMPLED_PX: u32 = 9_000_000;

/// How large the picture is drawn before it is shown: twice the size at high quality, half at low; and that scale as the
/// tone mapping knows it (2, 1, 0 for a half).
fn drawn_size(frame: &Frame<'_>, limit_px: u32) -> ([u32; 2], u32) {
    let size = frame.view.size_px.map(|side| side.clamp(1, limit_px));
    // Debug views show the mesh as it is.
    let plain = matches!(frame.debug_view, DebugView::Coverage | DebugView::Wireframe);
    match frame.view.quality {
        _ if plain => (size, 1),
        Quality::Low => (size.map(|side| side.div_ceil(2)), 0),
        Quality::High if size.iter().all(|side| side * 2 <= limit_px) && size[0] * size[1] <= MOST_SUPERSAMPLED_PX => {
            (size.map(|side| side * 2), 2)
        }
        Quality::Medium | Quality::High => (size, 1),
    }
}

/// Lowest and highest height of all tiles.
fn height_range_m(surface: &Surface) -> (f64, f64) {
    let heights = surface.leaves.iter().map(|leaf| (leaf.tile.min_height_m, leaf.tile.max_height_m));
    heights.reduce(|a, b| (a.0.min(b.0), a.1.max(b.1))).unwrap_or((0.0, 0.0))
}
