//! Textures that are reused from frame to frame. [`SharedLuts`]: noises and patterns, one set for a device. [`Luts`]:
//! the LUTs of the air, the cloud maps and the biome textures of a body; each is computed again when the content of
//! its key has changed.
//!
//! Method of the LUTs of the air: Hillaire, A Scalable and Production Ready Sky and Atmosphere Rendering Technique,
//! 2020.

use super::biome_table::{BiomeTexels, BiomeTextures, MarkedCells};
use super::border_tile;
use super::cloud_map::{CloudFrame, CloudMaps};
use super::gpu::{self, Slot};
use super::life::CanopyRows;
use super::patterns::{self, Pattern, PatternArrays, PatternPool};
use super::scene::Scene;
use super::screen_pass::Shared;
use super::shared::{GLOW_NODES, MULTISCATTER_SIZE, OPTICAL_DEPTH_SIZE, SEEN_NODES, SKY_LUT_SIZE, TURNS_AT_ONCE};
use super::targets::RADIANCE_FORMAT;
use super::{RenderError, noise_tile, shaders};
use crate::planet::{Biomes, Key};
use crate::terrain::{Revision, Terrain};
use crate::world::{MapPicture, MapView};
use std::sync::Arc;

/// The LUTs of the air, as indices into [`AIR_LUTS`].
const DEPTH: usize = 0;
const MULTISCATTER: usize = 1;
const OTHER_MULTISCATTER: usize = 2;
const SEEN: usize = 3;
const GLOW: usize = 4;
const SKY: usize = 5;
/// Name, size and number of layers of each; `None`: no layers.
const AIR_LUTS: [(&str, [u32; 2], Option<u32>); 6] = [
    ("optical depth", OPTICAL_DEPTH_SIZE, None),
    ("multiscatter", MULTISCATTER_SIZE, Some(4)),
    ("other multiscatter", MULTISCATTER_SIZE, Some(4)),
    ("seen", tiled(SEEN_NODES), Some(TURNS_AT_ONCE)),
    ("glow", tiled(GLOW_NODES), Some(TURNS_AT_ONCE)),
    ("sky", SKY_LUT_SIZE, Some(1)),
];
/// What a pass may read besides optical depth: the LUTs in the places of multiple scattering and of the sky.
/// A texture must not be bound while it is drawn, so others stand in.
const READ: [[usize; 2]; 4] = [[MULTISCATTER, GLOW], [OTHER_MULTISCATTER, GLOW], [MULTISCATTER, SEEN], [GLOW, SEEN]];
const READ_MULTISCATTER: Option<usize> = Some(0);
const READ_OTHER: Option<usize> = Some(1);
const READ_SEEN: Option<usize> = Some(2);
const READ_GLOW: Option<usize> = Some(3);
/// The passes that draw them, in order: shader, the LUT drawn, and for shaders that read LUTs, the index into [`READ`].
/// Each correction of multiple scattering reads one LUT and draws the other.
const AIR_PASSES: [(&str, usize, Option<usize>); 10] = [
    ("optical_depth.wgsl", DEPTH, None),
    ("multiscatter_guess.wgsl", MULTISCATTER, READ_OTHER),
    ("multiscatter_first.wgsl", OTHER_MULTISCATTER, READ_MULTISCATTER),
    ("multiscatter.wgsl", MULTISCATTER, READ_OTHER),
    ("multiscatter.wgsl", OTHER_MULTISCATTER, READ_MULTISCATTER),
    ("multiscatter.wgsl", MULTISCATTER, READ_OTHER),
    ("seen.wgsl", SEEN, READ_MULTISCATTER),
    ("glow.wgsl", GLOW, READ_SEEN),
    ("glow_draft.wgsl", GLOW, READ_SEEN),
    ("sky.wgsl", SKY, READ_GLOW),
];
/// The first pass of each key: optical depth, scattered light.
const FIRST_OF_KEY: [usize; 2] = [0, 1];
/// The passes that sum light over directions, which drafts leave out, and the one that takes their place in drafts.
const SUMS: [usize; 2] = [6, 7];
const DRAFT: usize = 8;

/// Size of a LUT of tiles, by its elevations and azimuths.
const fn tiled(nodes: [u32; 2]) -> [u32; 2] {
    [nodes[0] * MULTISCATTER_SIZE[0], nodes[1] / TURNS_AT_ONCE * MULTISCATTER_SIZE[1]]
}

/// Number of times that each texture of a body, and its uniforms, have been written since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct LutRuns {
    /// The biome textures.
    pub biomes: u64,
    /// The cloud maps.
    pub weather: u64,
    /// The LUT of the optical depth of the air.
    pub optical_depth: u64,
    /// The LUTs of light that the air scatters, and of the light of the sky.
    pub air: u64,
    /// The uniforms of the body and of the frame.
    pub uniforms: u64,
}

/// Textures shared by all bodies.
pub(crate) struct SharedLuts {
    /// The tiling noise of ground and clouds, and the noise of the border jitter.
    noise: [wgpu::TextureView; 2],
    patterns: PatternPool,
    /// Layout of the bind group of a body's LUTs.
    pub(crate) layout: wgpu::BindGroupLayout,
}

impl SharedLuts {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        use Slot::{Cube, CubeArray, Float2d, Float2dArray, Float3d, Unfiltered2d};
        let air = [Float2d, Float2dArray, Float2dArray];
        let rest = [CubeArray, Float3d, Unfiltered2d, Unfiltered2d, Float2dArray, Float2dArray, Float3d, Cube];
        Self {
            noise: [noise_tile::upload(device, queue), border_tile::upload(device, queue)],
            patterns: PatternPool::new(device, queue),
            layout: gpu::layout(device, "LUTs", &[&air[..], &rest].concat()),
        }
    }
}

impl SharedLuts {
    /// Memory of all textures.
    pub(crate) fn resident_bytes(&self) -> u64 {
        gpu::view_bytes(&self.noise) + self.patterns.resident_bytes()
    }
}

/// The pipelines that draw LUTs.
pub(crate) struct LutPipelines {
    air: Vec<wgpu::RenderPipeline>,
}

impl LutPipelines {
    pub(crate) fn new(device: &wgpu::Device, shared: Shared<'_>) -> Result<Self, RenderError> {
        let pipeline = |&(entry, drawn, read): &(&'static str, usize, Option<usize>)| {
            let groups = [shared.uniforms, shared.luts];
            let groups = if read.is_none() { &groups[..1] } else { &groups[..] };
            let description = gpu::ScreenPipelineDescriptor {
                entry,
                layout: &gpu::pipeline_layout(device, entry, groups),
                module: &shaders::module(device, entry)?,
                targets: &vec![Some(RADIANCE_FORMAT.into()); AIR_LUTS[drawn].2.unwrap_or(1) as usize],
                writes_depth: false,
                encodes_srgb: false,
                is_linear: false,
                constants: &[],
            };
            gpu::screen_pipeline(device, &description)
        };
        let air = AIR_PASSES.iter().map(pipeline).collect::<Result<_, _>>()?;
        Ok(Self { air })
    }
}

/// The views of a LUT of the air: to read it, and each layer to draw it.
struct AirLut {
    all: wgpu::TextureView,
    layers: Vec<wgpu::TextureView>,
}

impl AirLut {
    fn new(device: &wgpu::Device, &(name, size, layers): &(&str, [u32; 2], Option<u32>)) -> Self {
        let Some(layers) = layers else {
            let all = gpu::target(device, name, size, RADIANCE_FORMAT);
            return Self { layers: vec![all.clone()], all };
        };
        let (all, layers) = gpu::layered_target(device, name, size, layers, RADIANCE_FORMAT);
        Self { all, layers }
    }
}

/// The LUTs of a body.
pub(crate) struct Luts {
    air: Vec<AirLut>,
    clouds: CloudMaps,
    biomes: BiomeTextures,
    patterns: PatternArrays,
    /// The patterns that the planet shows.
    shown_patterns: Arc<[Pattern]>,
    /// The cube with the world map that a debug view shows, and what is in it.
    map_picture: wgpu::TextureView,
    shown_map: Option<(MapView, [Option<Key>; 2])>,
    groups: Groups,
    /// For optical depth and scattered light: the planet's key, and the bits of the widest sun's angular radius, which
    /// softens the terminator.
    air_keys: [Option<(Key, u32)>; FIRST_OF_KEY.len()],
    /// Whether the LUTs of scattered light are drafts.
    air_is_draft: bool,
    biome_key: Option<(Key, Option<Arc<MarkedCells>>, CanopyRows)>,
    biome_texels: BiomeTexels,
    pub(crate) runs: LutRuns,
}

/// Bind groups with all LUTs for drawing, and for drawing the LUTs of the air, as in [`READ`].
struct Groups {
    all: wgpu::BindGroup,
    air: [wgpu::BindGroup; READ.len()],
}

impl Luts {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, shared: &SharedLuts) -> Self {
        let air: Vec<_> = AIR_LUTS.iter().map(|lut| AirLut::new(device, lut)).collect();
        let clouds = CloudMaps::new(device);
        let biome_texels = BiomeTexels::new(&Biomes::default(), &[], None, &CanopyRows::default());
        let biomes = BiomeTextures::with(device, queue, &biome_texels);
        let shown_patterns: Arc<[Pattern]> = [].into();
        let patterns = shared.patterns.with(device, queue, &shown_patterns);
        let map_picture = write_map(device, queue, &no_map());
        let groups = Groups::new(device, shared, &air, [&clouds.cubes, &map_picture], (&biomes, &patterns));
        Self {
            air,
            clouds,
            biomes,
            patterns,
            shown_patterns,
            map_picture,
            shown_map: None,
            groups,
            air_keys: Default::default(),
            air_is_draft: false,
            biome_key: None,
            biome_texels,
            runs: LutRuns::default(),
        }
    }

    /// Memory of all textures.
    pub(crate) fn resident_bytes(&self) -> u64 {
        let rest = [&self.clouds.cubes, &self.map_picture, &self.biomes.ids, &self.biomes.params];
        gpu::view_bytes(self.air.iter().map(|lut| &lut.all).chain(rest))
    }

    /// The bind group for drawing.
    pub(crate) fn group(&self) -> &wgpu::BindGroup {
        &self.groups.all
    }

    /// Makes the next frame draw everything again, because shaders have changed.
    pub(crate) fn forget(&mut self) {
        self.air_keys = Default::default();
    }

    /// Updates everything that a revision has made stale. `uniforms`: those of the body, already written.
    /// `sun_radius_rad`: angular radius of the widest sun in them. `drafts`: LUTs of scattered light that must be made
    /// again may be drafts.
    pub(crate) fn update(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        (shared, pipelines): (&SharedLuts, &LutPipelines),
        (uniforms, sun_radius_rad): (&wgpu::BindGroup, f32),
        (revision, drafts): (&Revision, bool),
        (marked, canopies): (Option<&Arc<MarkedCells>>, CanopyRows),
    ) {
        let (planet, keys) = (revision.planet(), revision.keys());
        let biome_key = (keys.materials(), marked.cloned(), canopies);
        let is_stale = self.biome_key.as_ref() != Some(&biome_key);
        if is_stale {
            self.shown_patterns = patterns::patterns_of(&planet.biomes);
        }
        // Another body may have made new arrays: the old ones are dropped once nobody holds them.
        let patterns = shared.patterns.with(device, queue, &self.shown_patterns);
        let has_moved = patterns != self.patterns;
        if has_moved {
            self.patterns = patterns;
            self.bind(device, shared);
        }
        if is_stale || has_moved {
            let marked = marked.map(|marked| &**marked);
            let texels = BiomeTexels::new(&planet.biomes, self.patterns.patterns(), marked, &biome_key.2);
            self.write_biomes(device, queue, shared, texels);
            self.biome_key = Some(biome_key);
        }
        if planet.atmosphere.is_some() {
            let sun = sun_radius_rad.to_bits();
            let air_keys = [(keys.optical_depth(), 0), (keys.air_tables(), sun)].map(Some);
            // The second key includes the first one.
            let stale = (0..air_keys.len()).find(|i| self.air_keys[*i] != air_keys[*i]);
            if stale.is_none() && self.air_is_draft && !drafts {
                self.air_is_draft = false;
                self.fill_air(encoder, uniforms, pipelines, SUMS[0]);
                self.runs.air += 1;
            }
            if let Some(stale) = stale {
                // The first LUTs are never drafts.
                self.air_is_draft = drafts && self.air_keys[stale].is_some();
                self.fill_air(encoder, uniforms, pipelines, FIRST_OF_KEY[stale]);
                self.air_keys = air_keys;
                self.runs.optical_depth += u64::from(stale == 0);
                self.runs.air += 1;
            }
        }
    }

    /// Brings the cloud maps to the time of a scene. `terrain`: whose rain makes clouds.
    pub(crate) fn update_clouds(
        &mut self,
        queue: &wgpu::Queue,
        (revision, terrain): (&Revision, Option<&Terrain>),
        scene: &Scene<'_>,
    ) -> CloudFrame {
        let planet = revision.planet();
        let has_winds = planet.structure.is_some() && planet.water.is_some();
        if planet.clouds.is_none() && !has_winds {
            return CloudFrame::default();
        }
        let frame = self.clouds.update(queue, (revision, terrain), scene.time_secs, scene.drafts);
        self.runs.weather = self.clouds.runs;
        frame
    }

    /// Draws a world map into the cube of the debug views, if it is not there already.
    pub(crate) fn show_map(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        shared: &SharedLuts,
        view: MapView,
        terrain: &Terrain,
    ) {
        let shown = Some((view, terrain.map_picture_key(view)));
        if self.shown_map == shown {
            return;
        }
        self.shown_map = shown;
        self.map_picture = write_map(device, queue, &terrain.map_picture(view).unwrap_or_else(no_map));
        self.bind(device, shared);
    }

    fn bind(&mut self, device: &wgpu::Device, shared: &SharedLuts) {
        let cubes = [&self.clouds.cubes, &self.map_picture];
        self.groups = Groups::new(device, shared, &self.air, cubes, (&self.biomes, &self.patterns));
    }

    /// Writes the biome textures if their texels have changed. Some edits, such as names, do not change texels.
    fn write_biomes(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, shared: &SharedLuts, texels: BiomeTexels) {
        if texels == self.biome_texels {
            return;
        }
        if self.biomes.fit(&texels) {
            self.biomes.write(queue, &texels);
        } else {
            self.biomes = BiomeTextures::with(device, queue, &texels);
            self.bind(device, shared);
        }
        self.biome_texels = texels;
        self.runs.biomes += 1;
    }

    fn fill_air(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        uniforms: &wgpu::BindGroup,
        pipelines: &LutPipelines,
        first: usize,
    ) {
        for (number, (pipeline, (shader, drawn, read))) in pipelines.air.iter().zip(AIR_PASSES).enumerate().skip(first)
        {
            let is_left_out = if self.air_is_draft { SUMS.contains(&number) } else { number == DRAFT };
            if is_left_out {
                continue;
            }
            let groups = match read {
                None => vec![uniforms],
                Some(read) => vec![uniforms, &self.groups.air[read]],
            };
            let layers: Vec<_> = self.air[drawn].layers.iter().collect();
            gpu::draw_screen(encoder, shader, pipeline, &groups, &layers);
        }
    }
}

/// An even grey, for planets without the map.
fn no_map() -> MapPicture {
    MapPicture { side: 1, texels: vec![[46, 46, 46, 255]; 6] }
}

/// Uploads the picture of a world map.
fn write_map(device: &wgpu::Device, queue: &wgpu::Queue, picture: &MapPicture) -> wgpu::TextureView {
    let side = picture.side as u32;
    let size = wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 6 };
    let texture = gpu::written_texture(device, "world map", size, wgpu::TextureFormat::Rgba8Unorm);
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * side), rows_per_image: Some(side) };
    queue.write_texture(texture.as_image_copy(), picture.texels.as_flattened(), layout, size);
    let cube = wgpu::TextureViewDimension::Cube;
    texture.create_view(&wgpu::TextureViewDescriptor { dimension: Some(cube), ..Default::default() })
}

impl Groups {
    fn new(
        device: &wgpu::Device,
        shared: &SharedLuts,
        air: &[AirLut],
        [clouds, map_picture]: [&wgpu::TextureView; 2],
        (biomes, patterns): (&BiomeTextures, &PatternArrays),
    ) -> Self {
        let noise = &shared.noise;
        let bind = |slots: [usize; 3]| {
            let air = slots.into_iter().map(|i| &air[i].all);
            let (ids, params) = (&biomes.ids, &biomes.params);
            let rest = [clouds, &noise[0], ids, params, &patterns.tint, &patterns.surface, &noise[1], map_picture];
            let views = air.chain(rest).map(wgpu::BindingResource::TextureView);
            gpu::group(device, "LUTs", &shared.layout, views)
        };
        Self { all: bind([DEPTH, GLOW, SKY]), air: READ.map(|[scattered, other]| bind([DEPTH, scattered, other])) }
    }
}
