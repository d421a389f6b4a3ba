//! What outlives a frame: the tables of the air, the weather map, the noise tile, the patterns of the ground and the biomes. Each is made again
//! only when what it depends on has changed.

use super::border_tile;
use super::gpu::{self, Slot};
use super::material_maps::MaterialMaps;
use super::{Passes, biome_table, cloud_map, noise_tile};
use crate::planet::{Atmosphere, Biomes, Planet};
use biome_table::MarkedCells;
use std::sync::Arc;

/// Format of the tables: filterable and wide enough for radiance.
pub(crate) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Pixels along a face of the weather map.
pub(crate) const WEATHER_SIDE_PX: u32 = 512;

/// What the tables of the air depend on: the air, the planet's radius, and the star's, whose width softens the terminator.
type AirKey = (Atmosphere, f64, f64);

/// What the weather map depends on: scale, curl, seeds, radius.
type WeatherKey = (f64, f64, u32, u32, f64);

/// How often each table has been made since the start.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableRuns {
    /// The biome table.
    pub biomes: u64,
    /// The weather map.
    pub weather: u64,
    /// The four tables of the air.
    pub air: u64,
    /// The uniforms: what the planet, the camera and the clock come to.
    pub uniforms: u64,
}

/// The textures of group 1 and their bind groups.
pub(crate) struct Tables {
    pub(crate) layout: wgpu::BindGroupLayout,
    /// Optical depth, multiple scattering, irradiance, sky.
    air: [wgpu::TextureView; 4],
    weather: cloud_map::WeatherMap,
    /// The noise of the ground and the clouds, and that of the borders between biomes.
    noise: [wgpu::TextureView; 2],
    biomes: biome_table::BiomeTextures,
    materials: MaterialMaps,
    groups: Groups,
    air_key: Option<AirKey>,
    weather_key: Option<WeatherKey>,
    biome_key: Option<(Biomes, Option<Arc<MarkedCells>>)>,
    biome_texels: biome_table::BiomeTexels,
    runs: TableRuns,
}

/// The tables bound for drawing, and for filling the later tables of the air while those behind them are not there yet.
struct Groups {
    all: wgpu::BindGroup,
    first_of_air: wgpu::BindGroup,
    first_two_of_air: wgpu::BindGroup,
}

impl Tables {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        let layout = gpu::layout(
            device,
            "tables",
            &[
                Slot::Float2d,
                Slot::Float2d,
                Slot::Float2d,
                Slot::Float2d,
                Slot::Cube,
                Slot::Float3d,
                Slot::Unfiltered2d,
                Slot::Unfiltered2d,
                Slot::Float2dArray,
                Slot::Float2dArray,
                Slot::Float3d,
            ],
        );
        let air = [
            gpu::target(device, "optical depth", [256, 64], FORMAT),
            gpu::target(device, "multiscatter", [32, 32], FORMAT),
            gpu::target(device, "irradiance", [64, 16], FORMAT),
            gpu::target(device, "sky", [64, 20], FORMAT),
        ];
        let weather = cloud_map::texture(device);
        let noise = [noise_tile::upload(device, queue), border_tile::upload(device, queue)];
        let biome_texels = biome_table::BiomeTexels::new(&Biomes::default(), None);
        let biomes = biome_table::BiomeTextures::with(device, queue, &biome_texels);
        let materials = MaterialMaps::new(device, queue);
        let groups = Groups::new(device, &layout, &air, &weather.cube, &noise, (&biomes, &materials));
        Self {
            layout,
            air,
            weather,
            noise,
            biomes,
            materials,
            groups,
            air_key: None,
            weather_key: None,
            biome_key: None,
            biome_texels,
            runs: TableRuns::default(),
        }
    }

    /// The bind group for drawing.
    pub(crate) fn group(&self) -> &wgpu::BindGroup {
        &self.groups.all
    }

    /// How often each was made.
    pub(crate) fn runs(&self) -> TableRuns {
        self.runs
    }

    /// Makes everything anew at the next frame: the shaders that fill it have changed.
    pub(crate) fn forget(&mut self) {
        self.air_key = None;
        self.weather_key = None;
    }

    /// Brings everything up to date with a planet. The globals must have been written.
    pub(crate) fn update(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        globals: &wgpu::BindGroup,
        passes: &Passes,
        planet: &Planet,
        marked: Option<&Arc<MarkedCells>>,
    ) {
        let same = |key: &(Biomes, Option<Arc<MarkedCells>>)| key.0 == planet.biomes && key.1.as_ref() == marked;
        if !self.biome_key.as_ref().is_some_and(same) {
            let texels = biome_table::BiomeTexels::new(&planet.biomes, marked.map(|marked| &**marked));
            self.write_biomes(device, queue, texels);
            self.biome_key = Some((planet.biomes.clone(), marked.cloned()));
        }
        if let Some(air) = &planet.atmosphere {
            let key = (air.clone(), planet.radius_km, planet.star.radius_deg);
            if self.air_key.as_ref() != Some(&key) {
                self.fill_air(encoder, globals, passes);
                self.air_key = Some(key);
                self.runs.air += 1;
            }
        }
        if let Some(clouds) = planet.clouds.as_ref().filter(|clouds| clouds.coverage > 0.0 && marked.is_none()) {
            let key = (clouds.scale_km, clouds.curl, clouds.seed, planet.seed, planet.radius_km);
            if self.weather_key != Some(key) {
                passes.cloud_map.draw(encoder, globals, &self.weather);
                self.weather_key = Some(key);
                self.runs.weather += 1;
            }
        }
    }

    /// Nothing happens if what differs is not in the textures: names, or where rows begin.
    fn write_biomes(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, texels: biome_table::BiomeTexels) {
        if texels == self.biome_texels {
            return;
        }
        if self.biomes.fit(&texels) {
            self.biomes.write(queue, &texels);
        } else {
            self.biomes = biome_table::BiomeTextures::with(device, queue, &texels);
            let grounds = (&self.biomes, &self.materials);
            self.groups = Groups::new(device, &self.layout, &self.air, &self.weather.cube, &self.noise, grounds);
        }
        self.biome_texels = texels;
        self.runs.biomes += 1;
    }

    fn fill_air(&self, encoder: &mut wgpu::CommandEncoder, globals: &wgpu::BindGroup, passes: &Passes) {
        let (air, Groups { first_of_air: first, first_two_of_air: two, .. }) = (&passes.air_tables, &self.groups);
        let [optical_depth, multiscatter, irradiance, sky] = &self.air;
        gpu::draw_screen(encoder, "optical depth", &air.optical_depth, &[globals], &[optical_depth]);
        gpu::draw_screen(encoder, "multiscatter", &air.multiscatter, &[globals, first], &[multiscatter]);
        gpu::draw_screen(encoder, "irradiance", &air.irradiance, &[globals, two], &[irradiance]);
        gpu::draw_screen(encoder, "sky", &air.sky, &[globals, two], &[sky]);
    }
}

impl Groups {
    fn new(
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        air: &[wgpu::TextureView; 4],
        weather: &wgpu::TextureView,
        noise: &[wgpu::TextureView; 2],
        (biomes, materials): (&biome_table::BiomeTextures, &MaterialMaps),
    ) -> Self {
        // With only the first so many tables of the air, the others being filled.
        let bind = |ready: usize| {
            let mut air = air.each_ref();
            let first = air[0];
            air[ready..].fill(first);
            let [optical_depth, multiscatter, irradiance, sky] = air;
            let air = [optical_depth, multiscatter, irradiance, sky, weather, &noise[0]];
            let ground = [&biomes.ids, &biomes.params, &materials.tint, &materials.surface, &noise[1]];
            let views: Vec<&wgpu::TextureView> = air.into_iter().chain(ground).collect();
            gpu::texture_group(device, "tables", layout, &views)
        };
        Self { all: bind(4), first_of_air: bind(1), first_two_of_air: bind(2) }
    }
}
