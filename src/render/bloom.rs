//! Bloom: light that a lens scatters over the picture (`bloom.wgsl`). A pyramid of the exposed picture; the tone curve
//! adds its finest level. All pictures have the same number of levels below their own size, so that the glow is as wide
//! for every resolution.

use super::gpu::{self, ScreenPipelineDescriptor, Slot};
use super::{RADIANCE_FORMAT, RenderError, shaders};

/// Pixels of the picture for each texel of the finest level, along each axis.
const FIRST: u32 = 4;
/// The longer side of the coarsest level has at least as many texels.
const LEAST_TEXELS: u32 = 6;
/// Light in a level over that in the next coarser one. By eye.
const FINER: f64 = 0.6;

/// The pipelines of bloom.
pub(crate) struct BloomPass {
    first: Step,
    down: Step,
    up: Step,
}

/// One pipeline, and the layout of its inputs.
struct Step {
    inputs: wgpu::BindGroupLayout,
    pipeline: wgpu::RenderPipeline,
}

/// The bloom of a view.
pub(crate) struct Bloom {
    picture_px: [u32; 2],
    /// The finest first.
    levels: Vec<wgpu::TextureView>,
}

impl Bloom {
    /// Black, for a picture of a size.
    pub(crate) fn new(device: &wgpu::Device, picture_px: [u32; 2]) -> Self {
        let texture = |size_px: [u32; 2]| gpu::target(device, "bloom", size_px, RADIANCE_FORMAT);
        Self { picture_px, levels: sizes(picture_px).into_iter().map(texture).collect() }
    }

    /// Memory of all levels.
    pub(crate) fn resident_bytes(&self) -> u64 {
        gpu::view_bytes(&self.levels)
    }

    /// The light that the lens scatters over the picture, exposed.
    pub(crate) fn light(&self) -> Option<&wgpu::TextureView> {
        self.levels.first()
    }

    /// Whether it is for pictures of this size.
    pub(crate) fn fits(&self, picture_px: [u32; 2]) -> bool {
        self.picture_px == picture_px
    }
}

/// Sizes of the levels, the finest first.
fn sizes(picture_px: [u32; 2]) -> Vec<[u32; 2]> {
    let halved = |size: &[u32; 2]| {
        let half = size.map(|side| side.div_ceil(2));
        (half[0].max(half[1]) >= LEAST_TEXELS).then_some(half)
    };
    std::iter::successors(Some(picture_px.map(|side| side.div_ceil(FIRST))), halved).collect()
}

/// Share that the coarser levels have of a level's sum; `coarser`: how many there are.
fn coarser_share(coarser: usize) -> f64 {
    let light = |levels: usize| (0..levels).map(|level| FINER.powi(level as i32)).sum::<f64>();
    light(coarser) / light(coarser + 1)
}

impl BloomPass {
    pub(crate) fn new(device: &wgpu::Device, uniforms: &wgpu::BindGroupLayout) -> Result<Self, RenderError> {
        let step = |entry: &'static str, slots: &[Slot], blend: Option<wgpu::BlendState>| {
            let inputs = gpu::layout(device, entry, slots);
            let target = wgpu::ColorTargetState { blend, ..RADIANCE_FORMAT.into() };
            let description = ScreenPipelineDescriptor {
                entry,
                layout: &gpu::pipeline_layout(device, entry, &[uniforms, &inputs]),
                module: &shaders::module(device, entry)?,
                targets: &[Some(target)],
                writes_depth: false,
                encodes_srgb: false,
                is_linear: false,
                constants: &[],
            };
            Ok::<Step, RenderError>(Step { pipeline: gpu::screen_pipeline(device, &description)?, inputs })
        };
        let mix = wgpu::BlendComponent {
            src_factor: wgpu::BlendFactor::Constant,
            dst_factor: wgpu::BlendFactor::OneMinusConstant,
            operation: wgpu::BlendOperation::Add,
        };
        Ok(Self {
            first: step("bloom_first.wgsl", &[Slot::Float2d, Slot::Uniform], None)?,
            down: step("bloom_down.wgsl", &[Slot::Float2d], None)?,
            up: step("bloom_up.wgsl", &[Slot::Float2d], Some(wgpu::BlendState { color: mix, alpha: mix }))?,
        })
    }

    /// Makes the bloom of a picture. `uniforms`: group 0 of the view; `exposure`: its metered exposure.
    pub(crate) fn draw(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        of: &Bloom,
        uniforms: &wgpu::BindGroup,
        (radiance, exposure): (&wgpu::TextureView, &wgpu::Buffer),
    ) {
        let Some(finest) = of.light() else { return };
        let inputs = [wgpu::BindingResource::TextureView(radiance), exposure.as_entire_binding()];
        let mut run = |step: &Step, inputs: &[wgpu::BindingResource<'_>], to: &wgpu::TextureView, share: f64| {
            let inputs = gpu::group(device, "bloom", &step.inputs, inputs.iter().cloned());
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("bloom"),
                color_attachments: &[Some(wgpu::RenderPassColorAttachment {
                    view: to,
                    depth_slice: None,
                    resolve_target: None,
                    ops: wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store },
                })],
                ..wgpu::RenderPassDescriptor::default()
            });
            pass.set_pipeline(&step.pipeline);
            pass.set_blend_constant(wgpu::Color { r: share, g: share, b: share, a: share });
            pass.set_bind_group(0, uniforms, &[]);
            pass.set_bind_group(1, &inputs, &[]);
            pass.draw(0..3, 0..1);
        };
        run(&self.first, &inputs, finest, 1.0);
        for pair in of.levels.windows(2) {
            run(&self.down, &[wgpu::BindingResource::TextureView(&pair[0])], &pair[1], 1.0);
        }
        for (coarser, pair) in (1..).zip(of.levels.windows(2).rev()) {
            let share = coarser_share(coarser);
            run(&self.up, &[wgpu::BindingResource::TextureView(&pair[1])], &pair[0], share);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_end_before_they_are_points() {
        assert_eq!(sizes([640, 360]), [[160, 90], [80, 45], [40, 23], [20, 12], [10, 6]]);
        assert_eq!(sizes([240, 2]), [[60, 1], [30, 1], [15, 1], [8, 1]]);
        assert_eq!(sizes([1, 1]), [[1, 1]]);
        assert!(sizes([16_384, 16_384]).len() <= 11);
    }

    #[test]
    fn coarser_levels_of_larger_pictures_have_the_same_light() {
        // Light of the coarsest level over that of the next finer one, for any number of levels.
        for levels in 3..9_usize {
            let mut light = vec![1.0; levels];
            for coarser in (1..levels).rev() {
                // The level with as many coarser ones keeps its part; the coarser ones share the rest.
                let kept = 1.0 - coarser_share(coarser);
                let rest: f64 = coarser_share(coarser);
                light[coarser] *= kept;
                light[..coarser].iter_mut().for_each(|light| *light *= rest);
            }
            assert!((light.iter().sum::<f64>() - 1.0).abs() < 1e-12);
            assert!(light.windows(2).all(|pair| (pair[1] / pair[0] - FINER).abs() < 1e-12), "{light:?}");
        }
    }
}
