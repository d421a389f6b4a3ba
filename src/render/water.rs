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

    /// Draws it. `scene`: which of the two radiance targets holds the scene.
    pub(crate) fn draw(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        groups: [&wgpu::BindGroup; 2],
        targets: &Targets,
        scene: usize,
    ) {
        let inputs = [&targets.hdr[scene], &targets.depth, &targets.temperature];
        self.0.draw(device, encoder, groups, &inputs, &[&targets.hdr[1 - scene]]);
    }
}
