//! Clouds (`clouds.wgsl`): their light, transmittance and distance, for the air pass to put in.

use super::RenderError;
use super::gpu::{self, Slot};
use super::targets::{DISTANCE_FORMAT, HDR_FORMAT, Targets};

/// The pipeline and the layout of what it reads.
pub(crate) struct CloudsPass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl CloudsPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        tables: &wgpu::BindGroupLayout,
    ) -> Result<Self, RenderError> {
        let layout = gpu::layout(device, "clouds", &[Slot::Unfiltered2d, Slot::Depth]);
        let layouts = [globals, tables, &layout];
        let pipeline = gpu::screen_pipeline(device, "clouds.wgsl", &layouts, &[HDR_FORMAT, DISTANCE_FORMAT])?;
        Ok(Self { pipeline, layout })
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
        let views = [&targets.hdr[scene], &targets.depth];
        let inputs = gpu::texture_group(device, "clouds", &self.layout, &views);
        let groups = [groups[0], groups[1], &inputs];
        gpu::draw_screen(encoder, "clouds", &self.pipeline, &groups, &[&targets.cloud_light, &targets.cloud_distance]);
    }
}
