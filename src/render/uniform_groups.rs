//! Bind group 0 of every pass: the uniforms of a frame and a body, samplers, the shadows of objects and their planting
//! map.

use super::gpu;
use super::life::{CASCADES, PlantingBuffer, ShadowMap};
use super::uniforms::{self, UniformBuffer};

/// Makes the groups of uniforms.
pub(crate) struct UniformGroups {
    pub(crate) layout: wgpu::BindGroupLayout,
    samplers: [wgpu::Sampler; 2],
    comparison: wgpu::Sampler,
    /// Stands in where nothing casts a shadow.
    no_shadows: ShadowMap,
    /// Stands in where no edit changes what stands on the ground.
    no_planting: PlantingBuffer,
}

impl UniformGroups {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let samplers = gpu::samplers(device);
        let (comparison, no_shadows) = (gpu::comparison_sampler(device), ShadowMap::new(device, 1, CASCADES));
        let no_planting = PlantingBuffer::new(device);
        Self { layout: uniforms::layout(device), samplers, comparison, no_shadows, no_planting }
    }

    pub(crate) fn group(
        &self,
        device: &wgpu::Device,
        frame: &UniformBuffer,
        body: &UniformBuffer,
        (shadows, planting): (Option<&ShadowMap>, Option<&PlantingBuffer>),
    ) -> wgpu::BindGroup {
        use wgpu::BindingResource::{Sampler, TextureView};
        let [clamped, repeated] = self.samplers.each_ref().map(Sampler);
        let buffers = [frame.buffer.as_entire_binding(), body.buffer.as_entire_binding()];
        let shadows = TextureView(&shadows.unwrap_or(&self.no_shadows).view);
        let planting = planting.unwrap_or(&self.no_planting).buffer.as_entire_binding();
        let rest = [clamped, repeated, shadows, Sampler(&self.comparison), planting];
        gpu::group(device, "uniforms", &self.layout, buffers.into_iter().chain(rest))
    }
}
