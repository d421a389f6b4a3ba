//! Bind group 0 of every pass: the uniforms of a frame and a body, samplers, and the shadows of objects.

use super::gpu;
use super::life::ShadowMap;
use super::uniforms::{self, UniformBuffer};

/// Makes the groups of uniforms.
pub(crate) struct UniformGroups {
    pub(crate) layout: wgpu::BindGroupLayout,
    samplers: [wgpu::Sampler; 2],
    comparison: wgpu::Sampler,
    /// Stands in where no object casts a shadow.
    no_shadows: ShadowMap,
}

impl UniformGroups {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let samplers = gpu::samplers(device);
        let (comparison, no_shadows) = (gpu::comparison_sampler(device), ShadowMap::new(device, 1));
        Self { layout: uniforms::layout(device), samplers, comparison, no_shadows }
    }

    pub(crate) fn group(
        &self,
        device: &wgpu::Device,
        frame: &UniformBuffer,
        body: &UniformBuffer,
        shadows: Option<&ShadowMap>,
    ) -> wgpu::BindGroup {
        use wgpu::BindingResource::{Sampler, TextureView};
        let [clamped, repeated] = self.samplers.each_ref().map(Sampler);
        let buffers = [frame.buffer.as_entire_binding(), body.buffer.as_entire_binding()];
        let shadows = TextureView(&shadows.unwrap_or(&self.no_shadows).view);
        let rest = [clamped, repeated, shadows, Sampler(&self.comparison)];
        gpu::group(device, "uniforms", &self.layout, buffers.into_iter().chain(rest))
    }
}
