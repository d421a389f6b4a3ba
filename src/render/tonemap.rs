//! From radiance to the target (`tonemap.wgsl`): exposure, film curve, dither, change of size.

use super::RenderError;
use super::gpu::{self, Slot};

/// The pipeline for one target format.
pub(crate) struct TonemapPass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl TonemapPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        format: wgpu::TextureFormat,
    ) -> Result<Self, RenderError> {
        let layout = gpu::layout(device, "tonemap", &[Slot::Float2d]);
        let pipeline = gpu::screen_pipeline(device, "tonemap.wgsl", &[globals, &layout], &[format])?;
        Ok(Self { pipeline, layout })
    }

    /// Binds the radiance it is to show.
    pub(crate) fn bind(&self, device: &wgpu::Device, hdr: &wgpu::TextureView) -> wgpu::BindGroup {
        gpu::texture_group(device, "tonemap", &self.layout, &[hdr])
    }

    /// Shows what [`Self::bind`] bound in `target`.
    pub(crate) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        globals: &wgpu::BindGroup,
        input: &wgpu::BindGroup,
        target: &wgpu::TextureView,
    ) {
        gpu::draw_screen(encoder, "tonemap", &self.pipeline, &[globals, input], &[target]);
    }
}
