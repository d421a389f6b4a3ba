//! Asks the shaders of the air about single rays (`sky_probe.wgsl`): for tests against [`crate::atmosphere`], and for who wants
//! to know.

use super::gpu::{self, Slot};
use super::scene_pass::ScenePass;
use super::{DebugView, Frame, RenderError, Renderer, globals, tables};
use crate::atmosphere::SkyRay;
use crate::lod::{Camera, Quality, Ranges, View};
use crate::planet::Planet;
use crate::sphere::LatLon;
use crate::terrain::Terrain;
use crate::tiles::{BuildStats, Surface};
use glam::DVec3;
use std::sync::Arc;
use std::time::Instant;

const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// What the shaders say of one ray, for a star of unit irradiance.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyAnswer {
    /// What the air leaves of the light of the star's centre.
    pub transmittance: [f64; 3],
    /// Radiance that the air scatters along the ray, without the ground and the star's disc.
    pub radiance: [f64; 3],
}

impl Renderer {
    /// Evaluates the shaders of the air for each ray and waits for the answer. At most 8192 rays.
    pub fn sky(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        planet: &Planet,
        quality: Quality,
        rays: &[SkyRay],
    ) -> Result<Vec<SkyAnswer>, RenderError> {
        let columns = rays.len() as u32;
        if columns == 0 {
            return Ok(Vec::new());
        }
        self.write_globals(queue, planet, quality)?;
        let shared = [&self.globals.layout, &self.tables.layout];
        let pass = ScenePass::new(device, shared, "sky_probe.wgsl", &[Slot::Unfiltered2d], &[FORMAT, FORMAT])?;
        let input = ray_texture(device, queue, rays);
        let outputs = ["radiance", "transmittance"].map(|label| output(device, label, columns));
        let views = outputs.each_ref().map(|texture| texture.create_view(&wgpu::TextureViewDescriptor::default()));
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("sky probe") });
        self.tables.update((device, queue), &mut encoder, &self.globals.group, &self.passes, planet, None);
        let groups = [&self.globals.group, self.tables.group()];
        pass.draw(&mut encoder, groups, &pass.bind(device, &[&input]), &[&views[0], &views[1]]);
        let buffers = outputs.each_ref().map(|texture| copied(device, &mut encoder, texture));
        queue.submit([encoder.finish()]);
        let [radiance, transmittance] =
            [read(device, &buffers[0], rays.len())?, read(device, &buffers[1], rays.len())?];
        let answers = radiance.into_iter().zip(transmittance);
        Ok(answers.map(|(radiance, transmittance)| SkyAnswer { transmittance, radiance }).collect())
    }

    fn write_globals(&mut self, queue: &wgpu::Queue, planet: &Planet, quality: Quality) -> Result<(), RenderError> {
        let terrain = Arc::new(Terrain::try_new(Arc::new(planet.clone()))?);
        let (asked, stats) = (Instant::now(), BuildStats::default());
        let place = LatLon::from_degrees(0.0, 0.0);
        let camera = Camera::over(place, planet.radius_m() * 2.0, 0.0, 0.0, Camera::DEFAULT_FOV_Y_RAD);
        let view = View { camera, size_px: [1, 1], quality };
        let ranges = Ranges::new(&view, planet.radius_m(), 1.0);
        let surface = Surface { terrain, leaves: Vec::new(), complete: true, view, ranges, asked, stats };
        let frame = Frame {
            surface: &surface,
            planet,
            view,
            frozen: None,
            sun_dir_planet: DVec3::X,
            time_secs: 0.0,
            exposure_ev: 0.0,
            debug_view: DebugView::Shaded,
        };
        let setup = globals::Setup {
            size_px: [1, 1],
            scale: 1,
            height_range_m: (0.0, 0.0),
            weather_side_px: tables::WEATHER_SIDE_PX,
            srgb_target: false,
            marked: false,
            tone: super::Tone::Plain,
        };
        self.globals.write(queue, &frame, &setup);
        Ok(())
    }
}

/// See `sky_probe.wgsl`.
fn ray_texture(device: &wgpu::Device, queue: &wgpu::Queue, rays: &[SkyRay]) -> wgpu::TextureView {
    let texel = |v: DVec3, w: f64| [v.x as f32, v.y as f32, v.z as f32, w as f32];
    let row0 = rays.iter().map(|ray| texel(ray.directions().0, ray.altitude_m * 1e-3));
    let row1 = rays.iter().map(|ray| texel(ray.directions().1, 0.0));
    let texels: Vec<[f32; 4]> = row0.chain(row1).collect();
    let size = wgpu::Extent3d { width: rays.len() as u32, height: 2, depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("rays"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(size.width * 16), rows_per_image: None };
    queue.write_texture(texture.as_image_copy(), bytemuck::cast_slice(&texels), layout, size);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

fn output(device: &wgpu::Device, label: &str, columns: u32) -> wgpu::Texture {
    device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: wgpu::Extent3d { width: columns, height: 1, depth_or_array_layers: 1 },
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: FORMAT,
        usage: wgpu::TextureUsages::RENDER_ATTACHMENT | wgpu::TextureUsages::COPY_SRC,
        view_formats: &[],
    })
}

/// A buffer that will hold the one row of a texture.
fn copied(device: &wgpu::Device, encoder: &mut wgpu::CommandEncoder, texture: &wgpu::Texture) -> wgpu::Buffer {
    let buffer = device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("answers"),
        size: u64::from(texture.width()) * 16,
        usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
        mapped_at_creation: false,
    });
    let layout = wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: None, rows_per_image: None };
    encoder.copy_texture_to_buffer(
        texture.as_image_copy(),
        wgpu::TexelCopyBufferInfo { buffer: &buffer, layout },
        texture.size(),
    );
    buffer
}

fn read(device: &wgpu::Device, buffer: &wgpu::Buffer, count: usize) -> Result<Vec<[f64; 3]>, RenderError> {
    let texels: Vec<[f32; 4]> = gpu::read(device, buffer)?.chunks_exact(16).map(bytemuck::pod_read_unaligned).collect();
    Ok(texels.iter().take(count).map(|t| [t[0], t[1], t[2]].map(f64::from)).collect())
}
