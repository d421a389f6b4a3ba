//! Smooth edges (`antialias.wgsl`): reads what the tone mapping made, writes it anew.

use super::RenderError;
use super::gpu::Slot;
use super::scene_pass::ScenePass;
use super::targets::{HDR_FORMAT, Targets};

/// See the module.
pub(crate) struct AntialiasPass(ScenePass);

impl AntialiasPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        tables: &wgpu::BindGroupLayout,
    ) -> Result<Self, RenderError> {
        ScenePass::new(device, [globals, tables], "antialias.wgsl", &[Slot::Float2d], &[HDR_FORMAT]).map(Self)
    }

    /// Binds what it reads. `scene`: which of the two radiance targets holds the scene.
    pub(crate) fn bind(&self, device: &wgpu::Device, targets: &Targets, scene: usize) -> wgpu::BindGroup {
        self.0.bind(device, &[targets.toned(scene)])
    }

    /// Draws it. `inputs`: what [`Self::bind`] made.
    pub(crate) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        groups: [&wgpu::BindGroup; 2],
        inputs: &wgpu::BindGroup,
        targets: &Targets,
    ) {
        self.0.draw(encoder, groups, inputs, &[targets.smoothed()]);
    }
}
