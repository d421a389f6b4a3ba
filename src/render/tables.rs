//! What outlives a frame: the tables of the air, the weather map, the noise tile and the biome table. Each is made again
//! only when what it depends on has changed.

use super::gpu::{self, Slot};
use super::{Passes, biome_table, noise_tile};
use crate::planet::{Atmosphere, Biomes, Planet};

/// Format of the tables: filterable and wide enough for radiance.
pub(crate) const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba16Float;
/// Pixels along a face of the weather map.
pub(crate) const WEATHER_SIDE_PX: u32 = 512;

/// What the tables of the air depend on.
type AirKey = (Atmosphere, f64, f64);

/// What the weather map depends on: scale, curl, seeds, radius.
type WeatherKey = (f64, f64, u32, u32, f64);

/// The textures of group 1 and their bind groups.
pub(crate) struct Tables {
    pub(crate) layout: wgpu::BindGroupLayout,
    optical_depth: wgpu::TextureView,
    multiscatter: wgpu::TextureView,
    irradiance: wgpu::TextureView,
    sky: wgpu::TextureView,
    weather: wgpu::Texture,
    weather_cube: wgpu::TextureView,
    noise: wgpu::TextureView,
    biomes: biome_table::BiomeTextures,
    group: wgpu::BindGroup,
    air_key: Option<AirKey>,
    weather_key: Option<WeatherKey>,
    biome_key: Option<Biomes>,
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
                Slot::Float2d,
                Slot::Float2d,
            ],
        );
        let optical_depth = gpu::target(device, "optical depth", [256, 64], FORMAT);
        let multiscatter = gpu::target(device, "multiscatter", [32, 32], FORMAT);
        let irradiance = gpu::target(device, "irradiance", [64, 16], FORMAT);
        let sky = gpu::target(device, "sky", [64, 32], FORMAT);
        let (weather, weather_cube) = super::cloud_map::texture(device);
        let noise = noise_tile::upload(device, queue);
        let biomes = biome_table::BiomeTextures::new(device, queue, &Biomes::default());
        let views = [
            &optical_depth,
            &multiscatter,
            &irradiance,
            &sky,
            &weather_cube,
            &noise,
            &biomes.albedo,
            &biomes.roughness,
        ];
        let group = gpu::texture_group(device, "tables", &layout, &views);
        Self {
            layout,
            optical_depth,
            multiscatter,
            irradiance,
            sky,
            weather,
            weather_cube,
            noise,
            biomes,
            group,
            air_key: None,
            weather_key: None,
            biome_key: None,
        }
    }

    /// The bind group for drawing.
    pub(crate) fn group(&self) -> &wgpu::BindGroup {
        &self.group
    }

    /// Makes everything anew at the next frame: the shaders that fill it have changed.
    pub(crate) fn forget(&mut self) {
        self.air_key = None;
        self.weather_key = None;
    }

    /// Brings everything up to date with a planet. The globals must have been written.
    pub(crate) fn update(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        globals: &wgpu::BindGroup,
        passes: &Passes,
        planet: &Planet,
    ) {
        if self.biome_key.as_ref() != Some(&planet.biomes) {
            self.biomes = biome_table::BiomeTextures::new(device, queue, &planet.biomes);
            self.group = self.bind(device, None);
            self.biome_key = Some(planet.biomes.clone());
        }
        if let Some(air) = &planet.atmosphere {
            // The star's width softens the terminator in the tables.
            let key = (air.clone(), planet.radius_km, planet.star.radius_deg);
            if self.air_key.as_ref() != Some(&key) {
                self.fill_air(device, encoder, globals, passes);
                self.air_key = Some(key);
            }
        }
        if let Some(clouds) = planet.clouds.as_ref().filter(|clouds| clouds.coverage > 0.0) {
            let key = (clouds.scale_km, clouds.curl, clouds.seed, planet.seed, planet.radius_km);
            if self.weather_key != Some(key) {
                passes.cloud_map.draw(encoder, globals, &self.weather);
                self.weather_key = Some(key);
            }
        }
    }

    fn fill_air(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        globals: &wgpu::BindGroup,
        passes: &Passes,
    ) {
        let air = &passes.air_tables;
        gpu::draw_screen(encoder, "optical depth", &air.optical_depth, &[globals], &[&self.optical_depth]);
        let first = self.bind(device, Some(1));
        gpu::draw_screen(encoder, "multiscatter", &air.multiscatter, &[globals, &first], &[&self.multiscatter]);
        let second = self.bind(device, Some(2));
        gpu::draw_screen(encoder, "irradiance", &air.irradiance, &[globals, &second], &[&self.irradiance]);
        gpu::draw_screen(encoder, "sky", &air.sky, &[globals, &second], &[&self.sky]);
    }

    /// The tables as a bind group; with `ready`, only so many tables of the air, the others being filled right now.
    fn bind(&self, device: &wgpu::Device, ready: Option<usize>) -> wgpu::BindGroup {
        let mut views = [
            &self.optical_depth,
            &self.multiscatter,
            &self.irradiance,
            &self.sky,
            &self.weather_cube,
            &self.noise,
            &self.biomes.albedo,
            &self.biomes.roughness,
        ];
        if let Some(ready) = ready {
            views[ready..4].fill(&self.optical_depth);
        }
        gpu::texture_group(device, "tables", &self.layout, &views)
    }
}
