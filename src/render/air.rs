//! The air (`air.wgsl`): reads scene, depth and clouds, writes the finished radiance, and stars apart.

use super::RenderError;
use super::gpu::Slot;
use super::scene_pass::ScenePass;
use super::targets::{HDR_FORMAT, STARS_FORMAT, Targets};

/// See the module.
pub(crate) struct AirPass(ScenePass);

impl AirPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        tables: &wgpu::BindGroupLayout,
    ) -> Result<Self, RenderError> {
        let inputs = [Slot::Unfiltered2d, Slot::Depth, Slot::Unfiltered2d, Slot::Unfiltered2d];
        ScenePass::new(device, [globals, tables], "air.wgsl", &inputs, &[HDR_FORMAT, STARS_FORMAT]).map(Self)
    }

    /// Binds what it reads. `scene`: which of the two radiance targets holds the scene.
    pub(crate) fn bind(&self, device: &wgpu::Device, targets: &Targets, scene: usize) -> wgpu::BindGroup {
        self.0.bind(device, &[&targets.hdr[scene], &targets.depth, &targets.cloud_light, &targets.cloud_distance])
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
        self.0.draw(encoder, groups, inputs, &[&targets.hdr[1 - scene], &targets.stars]);
    }
}
