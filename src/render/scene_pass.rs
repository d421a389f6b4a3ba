//! A full-screen pass over the scene: what the sea, the clouds and the air have in common.

use super::RenderError;
use super::gpu::{self, Slot};

/// A pipeline that reads globals, tables and a few textures, and the layout of those textures.
pub(crate) struct ScenePass {
    entry: &'static str,
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl ScenePass {
    /// Compiles the shader `entry`. `shared`: the layouts of globals and tables; `inputs`: the textures it reads as group 2;
    /// `outputs`: the formats it writes.
    pub(crate) fn new(
        device: &wgpu::Device,
        shared: [&wgpu::BindGroupLayout; 2],
        entry: &'static str,
        inputs: &[Slot],
        outputs: &[wgpu::TextureFormat],
    ) -> Result<Self, RenderError> {
        let layout = gpu::layout(device, entry, inputs);
        let pipeline = gpu::screen_pipeline(device, entry, &[shared[0], shared[1], &layout], outputs)?;
        Ok(Self { entry, pipeline, layout })
    }

    /// The textures it is to read, bound once for many frames.
    pub(crate) fn bind(&self, device: &wgpu::Device, inputs: &[&wgpu::TextureView]) -> wgpu::BindGroup {
        gpu::texture_group(device, self.entry, &self.layout, inputs)
    }

    /// Draws it, reading `inputs` and writing `outputs`.
    pub(crate) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        shared: [&wgpu::BindGroup; 2],
        inputs: &wgpu::BindGroup,
        outputs: &[&wgpu::TextureView],
    ) {
        gpu::draw_screen(encoder, self.entry, &self.pipeline, &[shared[0], shared[1], inputs], outputs);
    }
}
