//! The sea (`water.wgsl`): reads the scene with its depth, writes it anew with the sea in it.

use super::RenderError;
use super::gpu::Slot;
use super::scene_pass::ScenePass;
use super::targets::{HDR_FORMAT, Targets};

/// See the module.
pub(crate) struct WaterPass(ScenePass);

impl WaterPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        tables: &wgpu::BindGroupLayout,
    ) -> Result<Self, RenderError> {
        let inputs = [Slot::Unfiltered2d, Slot::Depth, Slot::Unfiltered2d];
        ScenePass::new(device, [globals, tables], "water.wgsl", &inputs, &[HDR_FORMAT]).map(Self)
    }

    /// Binds what it reads. `scene`: which of the two radiance targets holds the scene.
    pub(crate) fn bind(&self, device: &wgpu::Device, targets: &Targets, scene: usize) -> wgpu::BindGroup {
        self.0.bind(device, &[&targets.hdr[scene], &targets.depth, &targets.surface])
    }

    /// Draws it. `inputs`: what [`Self::bind`] made for this `scene`.
    pub(crate) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        groups: [&wgpu::BindGroup; 2],
        inputs: &wgpu::BindGroup,
        targets: &Targets,
        scene: usize,
    ) {
        self.0.draw(encoder, groups, inputs, &[&targets.hdr[1 - scene]]);
    }
}
