//! Evaluates the shaders of the air for single rays (`sky_probe.wgsl`), for tests against [`crate::atmosphere`] and for
//! `tellus sky --gpu`.

use super::gpu::{self, Slot};
use super::life::CanopyRows;
use super::luts::Luts;
use super::scene::{Projection, Scene};
use super::uniforms::{self, Drawn, UniformBuffer};
use super::{RenderError, Renderer, shaders};
use crate::atmosphere::SkyRay;
use crate::lod::Quality;
use crate::planet::Planet;
use crate::terrain::Revision;
use glam::{DQuat, DVec3};
use std::sync::Arc;

const ENTRY: &str = "sky_probe.wgsl";
const FORMAT: wgpu::TextureFormat = wgpu::TextureFormat::Rgba32Float;

/// Result of the shaders for one ray, for unit irradiance of the star.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SkyAnswer {
    /// Transmittance from the centre of the star's disc, RGB.
    pub transmittance: [f64; 3],
    /// Radiance scattered by the air along the ray, without the ground and the star's disc, RGB.
    pub radiance: [f64; 3],
}

impl Renderer {
    /// Evaluates the shaders of the air for at most 8192 rays. Blocks until the device is done.
    ///
    /// # Errors
    /// An invalid planet, a shader that does not compile, or a device that does not answer.
    pub fn sky(&mut self, planet: &Planet, quality: Quality, rays: &[SkyRay]) -> Result<Vec<SkyAnswer>, RenderError> {
        let columns = rays.len() as u32;
        if columns == 0 {
            return Ok(Vec::new());
        }
        let revision = Revision::try_new(Arc::new(planet.clone()))?;
        let (device, queue) = (&self.device, &self.queue);
        let inputs = gpu::layout(device, ENTRY, &[Slot::Unfiltered2d]);
        let [uniforms, luts] = self.body_layouts();
        let description = gpu::ScreenPipelineDescriptor {
            entry: ENTRY,
            layout: &gpu::pipeline_layout(device, ENTRY, &[uniforms, luts, &inputs]),
            module: &shaders::module(device, ENTRY)?,
            targets: &[Some(FORMAT.into()), Some(FORMAT.into())],
            writes_depth: false,
            encodes_srgb: false,
            is_linear: false,
            constants: &[],
        };
        let pipeline = gpu::screen_pipeline(device, &description)?;
        let input = ray_texture(device, queue, rays);
        let input = gpu::group(device, ENTRY, &inputs, [wgpu::BindingResource::TextureView(&input)]);
        let outputs = ["radiance", "transmittance"].map(|label| gpu::target(device, label, [columns, 1], FORMAT));
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("sky probe") });
        let (group, luts) = self.bind_planet(&mut encoder, &revision, quality);
        let groups = [&group, luts.group(), &input];
        gpu::draw_screen(&mut encoder, ENTRY, &pipeline, &groups, &[&outputs[0], &outputs[1]]);
        queue.submit([encoder.finish()]);
        let read = |view: &wgpu::TextureView| -> Result<Vec<[f64; 3]>, RenderError> {
            let bytes = gpu::read_texture(device, queue, view.texture())?;
            let texel = |bytes: &[u8]| -> [f32; 4] { bytemuck::pod_read_unaligned(bytes) };
            Ok(bytes.chunks_exact(16).map(texel).map(|t| [t[0], t[1], t[2]].map(f64::from)).collect())
        };
        let answers = read(&outputs[0])?.into_iter().zip(read(&outputs[1])?);
        Ok(answers.map(|(radiance, transmittance)| SkyAnswer { transmittance, radiance }).collect())
    }

    /// Uniforms and LUTs of a planet, for no particular view.
    fn bind_planet(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        revision: &Revision,
        quality: Quality,
    ) -> (wgpu::BindGroup, Luts) {
        let (device, queue) = (&self.device, &self.queue);
        let view = Scene::new(DQuat::IDENTITY, Projection::symmetric(1.0, 1.0), [1, 1], quality);
        let drawn = Drawn { viewport_px: [0, 0, 1, 1], render_scale: 1.0, matrices: view.matrices() };
        let mut frame = UniformBuffer::new::<uniforms::Frame>(device, "frame");
        frame.write(queue, &uniforms::frame(&view, &drawn));
        let mut body = UniformBuffer::new::<uniforms::Body>(device, "body");
        let values = uniforms::planet_only(revision.planet());
        body.write(queue, &values);
        let group = self.uniform_group(&frame, &body);
        let mut luts = Luts::new(device, queue, &self.patterns);
        let pipelines = (&*self.patterns, &self.pipelines.luts);
        let (sun, ground) = ((&group, values.lut_sun_radius_rad), (None, CanopyRows::default()));
        luts.update((device, queue), encoder, pipelines, sun, (revision, false), ground);
        (group, luts)
    }
}

/// Input texture of `sky_probe.wgsl`: two texels for each ray.
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
