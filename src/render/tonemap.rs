//! From radiance to what is shown (`tonemap.wgsl`): exposure and film curve, in the scene's size.

use super::RenderError;
use super::gpu::{self, Slot};
use super::targets::{HDR_FORMAT, Targets};

/// See the module.
pub(crate) struct TonemapPass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl TonemapPass {
    pub(crate) fn new(device: &wgpu::Device, globals: &wgpu::BindGroupLayout) -> Result<Self, RenderError> {
        let layout = gpu::layout(device, "tonemap", &[Slot::Float2d, Slot::Uniform]);
        let pipeline = gpu::screen_pipeline(device, "tonemap.wgsl", &[globals, &layout], &[HDR_FORMAT])?;
        Ok(Self { pipeline, layout })
    }

    /// Binds the radiance it is to show and what was metered, see [`super::exposure::ExposurePass::result`]. `scene`: which of the
    /// two radiance targets holds the scene.
    pub(crate) fn bind(
        &self,
        device: &wgpu::Device,
        targets: &Targets,
        scene: usize,
        exposure: &wgpu::Buffer,
    ) -> wgpu::BindGroup {
        device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("tonemap"),
            layout: &self.layout,
            entries: &[
                wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&targets.hdr[scene]) },
                wgpu::BindGroupEntry { binding: 1, resource: exposure.as_entire_binding() },
            ],
        })
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
