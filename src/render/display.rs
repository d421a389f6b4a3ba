//! Into the target (`display.wgsl`): its size, its encoding, dither.

use super::RenderError;
use super::gpu::Slot;
use super::scene_pass::ScenePass;

/// The pipeline for one target format.
pub(crate) struct DisplayPass(ScenePass);

impl DisplayPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        tables: &wgpu::BindGroupLayout,
        format: wgpu::TextureFormat,
    ) -> Result<Self, RenderError> {
        ScenePass::new(device, [globals, tables], "display.wgsl", &[Slot::Float2d], &[format]).map(Self)
    }

    /// Binds what is to be shown.
    pub(crate) fn bind(&self, device: &wgpu::Device, shown: &wgpu::TextureView) -> wgpu::BindGroup {
        self.0.bind(device, &[shown])
    }

    /// Draws it. `inputs`: what [`Self::bind`] made.
    pub(crate) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        groups: [&wgpu::BindGroup; 2],
        inputs: &wgpu::BindGroup,
        target: &wgpu::TextureView,
    ) {
        self.0.draw(encoder, groups, inputs, &[target]);
    }
}
