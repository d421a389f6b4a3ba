//! The sea (`water.wgsl`): reads the scene with its depth, writes it anew with the sea in it.

use super::RenderError;
use super::gpu::{self, Slot};
use super::targets::{HDR_FORMAT, Targets};

/// The pipeline and the layout of what it reads.
pub(crate) struct WaterPass {
    pipeline: wgpu::RenderPipeline,
    layout: wgpu::BindGroupLayout,
}

impl WaterPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        tables: &wgpu::BindGroupLayout,
    ) -> Result<Self, RenderError> {
        let layout = gpu::layout(device, "water", &[Slot::Unfiltered2d, Slot::Depth, Slot::Unfiltered2d]);
        let layouts = [globals, tables, &layout];
        let pipeline = gpu::screen_pipeline(device, "water.wgsl", &layouts, &[HDR_FORMAT])?;
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
        let views = [&targets.hdr[scene], &targets.depth, &targets.temperature];
        let inputs = gpu::texture_group(device, "water", &self.layout, &views);
        let groups = [groups[0], groups[1], &inputs];
        gpu::draw_screen(encoder, "water", &self.pipeline, &groups, &[&targets.hdr[1 - scene]]);
    }
}
