//! The passes of a frame, in their order: the one place that names them all.

use super::screen_pass::{ScreenPass, ScreenPipeline, Shared};
use super::{
    RenderError, air, antialias, aurora, bloom, clouds, copy, display, exposure, life, luts, morph, still, terrain,
    tonemap, water,
};

/// Passes of the opaque stage that follow the ground, for each body.
pub(crate) const OPAQUE: &[&ScreenPass] = &[&water::PASS];
/// Passes of the air stage, for each body from the farthest to the nearest.
pub(crate) const AIR: &[&ScreenPass] = &[&clouds::PASS, &clouds::GATHER, &air::PASS, &aurora::PASS];
/// Passes of the post-process that follow the metering.
pub(crate) const POST: &[&ScreenPass] = &[&tonemap::PASS, &antialias::PASS, &display::PASS];

/// Every pipeline; made anew as a whole when a shader changes on disk.
pub(crate) struct Pipelines {
    pub(crate) luts: luts::LutPipelines,
    pub(crate) morph: morph::MorphPass,
    pub(crate) terrain: terrain::TerrainPass,
    pub(crate) life: life::LifePass,
    pub(crate) opaque: Vec<ScreenPipeline>,
    pub(crate) air: Vec<ScreenPipeline>,
    /// Stands in for the air stage where it draws nothing.
    pub(crate) copy: ScreenPipeline,
    /// The mean of a still scene.
    pub(crate) still: ScreenPipeline,
    pub(crate) exposure: exposure::ExposurePass,
    pub(crate) bloom: bloom::BloomPass,
    pub(crate) post: Vec<ScreenPipeline>,
}

impl Pipelines {
    pub(crate) fn new(device: &wgpu::Device, shared: Shared<'_>) -> Result<Self, RenderError> {
        let make = |list: &'static [&'static ScreenPass]| {
            list.iter().map(|pass| ScreenPipeline::new(device, shared, pass)).collect::<Result<Vec<_>, _>>()
        };
        Ok(Self {
            luts: luts::LutPipelines::new(device, shared)?,
            morph: morph::MorphPass::new(device)?,
            terrain: terrain::TerrainPass::new(device, shared)?,
            life: life::LifePass::new(device, shared)?,
            opaque: make(OPAQUE)?,
            air: make(AIR)?,
            copy: ScreenPipeline::new(device, shared, &copy::PASS)?,
            still: ScreenPipeline::new(device, shared, &still::PASS)?,
            exposure: exposure::ExposurePass::new(device)?,
            bloom: bloom::BloomPass::new(device, shared.uniforms)?,
            post: make(POST)?,
        })
    }
}
