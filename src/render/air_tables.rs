//! Pipelines that fill the tables of the air: `optical_depth.wgsl`, `multiscatter.wgsl`, `irradiance.wgsl`, `sky.wgsl`.
//!
//! Hillaire, A Scalable and Production Ready Sky and Atmosphere Rendering Technique, 2020.

use super::{RenderError, gpu, tables};

/// One pipeline for each table, in the order in which they build on each other.
pub(crate) struct AirTablesPass {
    pub(crate) optical_depth: wgpu::RenderPipeline,
    pub(crate) multiscatter: wgpu::RenderPipeline,
    pub(crate) irradiance: wgpu::RenderPipeline,
    pub(crate) sky: wgpu::RenderPipeline,
}

impl AirTablesPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        tables: &wgpu::BindGroupLayout,
    ) -> Result<Self, RenderError> {
        let make =
            |entry, layouts: &[&wgpu::BindGroupLayout]| gpu::screen_pipeline(device, entry, layouts, &[tables::FORMAT]);
        Ok(Self {
            optical_depth: make("optical_depth.wgsl", &[globals])?,
            multiscatter: make("multiscatter.wgsl", &[globals, tables])?,
            irradiance: make("irradiance.wgsl", &[globals, tables])?,
            sky: make("sky.wgsl", &[globals, tables])?,
        })
    }
}
