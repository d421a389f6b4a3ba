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

    /// Binds what it reads. `scene`: which of the two radiance targets holds the scene.
    pub(crate) fn bind(&self, device: &wgpu::Device, targets: &Targets, scene: usize) -> wgpu::BindGroup {
        self.0.bind(device, &[&targets.hdr[scene], &targets.depth])
    }

    /// Draws it. `inputs`: what [`Self::bind`] made.
    pub(crate) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        groups: [&wgpu::BindGroup; 2],
        inputs: &wgpu::BindGroup,
        targets: &Targets,
    ) {
        self.0.draw(encoder, groups, inputs, &[&targets.cloud_light, &targets.cloud_distance]);
    }
}
