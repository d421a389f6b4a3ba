//! Clouds (`clouds.wgsl`): their light, transmittance and distance, for the air pass to put in.

use super::RenderError;
use super::gpu::Slot;
use super::scene_pass::ScenePass;
use super::targets::{DISTANCE_FORMAT, HDR_FORMAT, Targets};

/// See the module.
pub(crate) struct CloudsPass(ScenePass);

impl CloudsPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        tables: &wgpu::BindGroupLayout,
    ) -> Result<Self, RenderError> {
        let inputs = [Slot::Unfiltered2d, Slot::Depth];
        ScenePass::new(device, [globals, tables], "clouds.wgsl", &inputs, &[HDR_FORMAT, DISTANCE_FORMAT]).map(Self)
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
        let inputs = [&targets.hdr[scene], &targets.depth];
        self.0.draw(device, encoder, groups, &inputs, &[&targets.cloud_light, &targets.cloud_distance]);
    }
}
