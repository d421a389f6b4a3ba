//! A pass over all pixels of the picture: its description, and its pipeline.

use super::gpu::{self, Slot};
use super::targets::Target;
use super::variant::{Variant, Varies};
use super::{RenderError, shaders};
use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

/// A resource that a pass reads, in the order of its bindings.
#[derive(Clone, Copy)]
pub(crate) enum Input {
    /// A texture that is loaded, never filtered.
    Load(Target),
    /// A texture that is filtered.
    Sample(Target),
    /// A depth texture.
    Depth(Target),
    /// The buffer of the view's exposure.
    Exposure,
}

/// A texture that a pass writes.
#[derive(Clone, Copy)]
pub(crate) struct Output {
    pub(crate) target: Target,
    pub(crate) blend: Blend,
}

/// How what a pass writes is joined with what the texture holds.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Blend {
    /// It replaces that.
    Replace,
    /// It multiplies that: each body in turn, from 1 on.
    Multiply,
    /// Its colour is added to that; alpha stays.
    Add,
}

/// Writes a texture.
pub(crate) const fn writes(target: Target) -> Output {
    Output { target, blend: Blend::Replace }
}

/// Whose uniforms a pass reads.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Scope {
    /// The frame and one body. Groups: uniforms, LUTs, inputs.
    Body,
    /// The same without the LUTs. Groups: uniforms, inputs.
    BodyAlone,
    /// The frame alone. Groups: uniforms, inputs.
    View,
}

/// What there is to draw: decides which passes run.
#[derive(Default)]
pub(crate) struct Work {
    /// The planets, not a debug view.
    pub(crate) shaded: bool,
    /// The body has a sea.
    pub(crate) sea: bool,
    /// The body has clouds.
    pub(crate) clouds: bool,
    /// The clouds of most pixels are those of the frame before.
    pub(crate) carries_clouds: bool,
    /// The body has an aurora.
    pub(crate) aurora: bool,
    /// Edges are smoothed.
    pub(crate) smooth_edges: bool,
}

/// A pass over all pixels of the picture.
pub(crate) struct ScreenPass {
    /// Its shader file.
    pub(crate) shader: &'static str,
    pub(crate) scope: Scope,
    pub(crate) reads: &'static [Input],
    pub(crate) writes: &'static [Output],
    /// A depth texture that the pass tests and writes.
    pub(crate) depth: Option<Target>,
    /// Which variants of its pipeline there are.
    pub(crate) varies: Varies,
    /// When it runs.
    pub(crate) runs: fn(&Work) -> bool,
}

/// Layouts of the groups that passes share.
#[derive(Clone, Copy)]
pub(crate) struct Shared<'a> {
    pub(crate) uniforms: &'a wgpu::BindGroupLayout,
    pub(crate) luts: &'a wgpu::BindGroupLayout,
}

/// Format of the output, and variant.
type Kind = (Option<wgpu::TextureFormat>, Variant);

/// The pipeline of a pass.
pub(crate) struct ScreenPipeline {
    pub(crate) pass: &'static ScreenPass,
    inputs: wgpu::BindGroupLayout,
    layout: wgpu::PipelineLayout,
    module: wgpu::ShaderModule,
    /// By the format of the output, if the pass writes it, and by variant.
    pipelines: Mutex<HashMap<Kind, wgpu::RenderPipeline>>,
}

/// What a pass is drawn with.
pub(crate) struct Drawing<'a> {
    pub(crate) device: &'a wgpu::Device,
    /// The groups before the inputs.
    pub(crate) groups: &'a [&'a wgpu::BindGroup],
    pub(crate) texture: &'a dyn Fn(Target) -> Option<&'a wgpu::TextureView>,
    pub(crate) exposure: &'a wgpu::Buffer,
    /// Left, top, width and height in the targets.
    pub(crate) viewport_px: [u32; 4],
    /// What the body needs.
    pub(crate) variant: Variant,
    /// Whether the targets keep what they hold; if not they are cleared.
    pub(crate) load: bool,
    /// Whether the caller's targets keep what they hold outside of the viewport.
    pub(crate) keeps_rest: bool,
}

impl ScreenPipeline {
    /// Checks the shader and makes the pipeline.
    pub(crate) fn new(
        device: &wgpu::Device,
        shared: Shared<'_>,
        pass: &'static ScreenPass,
    ) -> Result<Self, RenderError> {
        let slot = |input: &Input| match input {
            Input::Load(_) => Slot::Unfiltered2d,
            Input::Sample(_) => Slot::Float2d,
            Input::Depth(_) => Slot::Depth,
            Input::Exposure => Slot::Uniform,
        };
        let slots: Vec<Slot> = pass.reads.iter().map(slot).collect();
        let inputs = gpu::layout(device, pass.shader, &slots);
        let groups = match pass.scope {
            Scope::Body => vec![shared.uniforms, shared.luts, &inputs],
            Scope::BodyAlone | Scope::View => vec![shared.uniforms, &inputs],
        };
        let layout = gpu::pipeline_layout(device, pass.shader, &groups);
        let module = shaders::module(device, pass.shader)?;
        let made = Self { pass, inputs, layout, module, pipelines: Mutex::default() };
        let writes_output = pass.writes.iter().any(|output| output.target == Target::Output);
        if !writes_output {
            made.pipeline(device, None, Variant::FIRST)?;
        }
        Ok(made)
    }

    /// The pipeline for a format of the output and a body.
    fn pipeline(
        &self,
        device: &wgpu::Device,
        output: Option<wgpu::TextureFormat>,
        variant: Variant,
    ) -> Result<wgpu::RenderPipeline, RenderError> {
        let variant = variant.among(self.pass.varies);
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = pipelines.get(&(output, variant)) {
            return Ok(pipeline.clone());
        }
        let component = |src_factor, dst_factor| {
            let operation = wgpu::BlendOperation::Add;
            wgpu::BlendComponent { src_factor, dst_factor, operation }
        };
        let (zero, one) = (wgpu::BlendFactor::Zero, wgpu::BlendFactor::One);
        let multiply = component(wgpu::BlendFactor::Dst, zero);
        let blend = |blend: Blend| match blend {
            Blend::Replace => None,
            Blend::Multiply => Some(wgpu::BlendState { color: multiply, alpha: multiply }),
            Blend::Add => Some(wgpu::BlendState { color: component(one, one), alpha: component(zero, one) }),
        };
        let state = |of: &Output| {
            let format = of.target.format().or(output)?;
            let write_mask = wgpu::ColorWrites::ALL;
            Some(wgpu::ColorTargetState { format, blend: blend(of.blend), write_mask })
        };
        let targets: Vec<_> = self.pass.writes.iter().map(state).collect();
        let description = gpu::ScreenPipelineDescriptor {
            entry: self.pass.shader,
            layout: &self.layout,
            module: &self.module,
            targets: &targets,
            writes_depth: self.pass.depth.is_some(),
            encodes_srgb: output.is_some_and(|format| format.is_srgb()),
            is_linear: output == Some(wgpu::TextureFormat::Rgba32Float),
            constants: &variant.constants(self.pass.varies),
        };
        let pipeline = gpu::screen_pipeline(device, &description)?;
        pipelines.insert((output, variant), pipeline.clone());
        Ok(pipeline)
    }

    /// Draws the pass; nothing if a texture that it needs is not there.
    pub(crate) fn draw(&self, encoder: &mut wgpu::CommandEncoder, with: &Drawing<'_>) -> Result<(), RenderError> {
        let pass = self.pass;
        let output = pass.writes.iter().find(|output| output.target == Target::Output);
        let format = output.and_then(|output| (with.texture)(output.target)).map(|view| view.texture().format());
        let pipeline = self.pipeline(with.device, format, with.variant)?;
        let resource = |input: &Input| match input {
            Input::Load(target) | Input::Sample(target) | Input::Depth(target) => {
                (with.texture)(*target).map(wgpu::BindingResource::TextureView)
            }
            Input::Exposure => Some(with.exposure.as_entire_binding()),
        };
        let Some(resources) = pass.reads.iter().map(resource).collect::<Option<Vec<_>>>() else { return Ok(()) };
        let inputs = gpu::group(with.device, pass.shader, &self.inputs, resources);
        let attachment = |output: &Output| {
            let (clear, keeps) = match output.blend {
                Blend::Replace => (wgpu::Color::TRANSPARENT, with.load || with.keeps_rest),
                Blend::Multiply => (wgpu::Color::WHITE, with.load),
                Blend::Add => (wgpu::Color::TRANSPARENT, true),
            };
            let load = if keeps { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(clear) };
            Some(wgpu::RenderPassColorAttachment {
                view: (with.texture)(output.target)?,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })
        };
        let attachments: Vec<_> = pass.writes.iter().map(attachment).collect();
        let depth_view = pass.depth.and_then(|target| (with.texture)(target));
        let mut draw = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some(pass.shader),
            color_attachments: &attachments,
            depth_stencil_attachment: depth_view.map(|view| gpu::depth_attachment(view, with.load)),
            ..wgpu::RenderPassDescriptor::default()
        });
        draw.set_pipeline(&pipeline);
        let groups = if pass.scope == Scope::BodyAlone { &with.groups[..1] } else { with.groups };
        for (i, group) in (0..).zip(groups.iter().copied().chain([&inputs])) {
            draw.set_bind_group(i, group, &[]);
        }
        gpu::set_viewport(&mut draw, with.viewport_px);
        draw.draw(0..3, 0..1);
        Ok(())
    }
}
