//! A frame whose uniforms, tiles and LUTs are on the GPU: the stages that the caller records.

use super::clouds;
use super::life::LifeTargets;
use super::renderer::{Renderer, ViewResources};
use super::scene::BodyId;
use super::screen_pass::{Drawing, ScreenPipeline, Work};
use super::targets::{self, DEPTH_FORMAT, Owned, RADIANCE_FORMAT, Target};
use super::terrain::GroundTargets;
use super::variant::Variant;
use super::{FrameStats, Metering, RenderError};

/// Targets of the opaque stage. Both are as large as [`Renderer::prepare`] was told.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct OpaqueTargets<'a> {
    /// Radiance, [`RADIANCE_FORMAT`].
    pub radiance: &'a wgpu::TextureView,
    /// Depth, [`DEPTH_FORMAT`].
    pub depth: &'a wgpu::TextureView,
    /// Whether both keep what they hold; if not they are cleared, to black and to infinity (0).
    pub load: bool,
}

impl<'a> OpaqueTargets<'a> {
    /// Targets that are cleared.
    pub fn cleared(radiance: &'a wgpu::TextureView, depth: &'a wgpu::TextureView) -> Self {
        Self { radiance, depth, load: false }
    }

    /// Targets that already hold a picture: what is nearer stays.
    pub fn loaded(radiance: &'a wgpu::TextureView, depth: &'a wgpu::TextureView) -> Self {
        Self { radiance, depth, load: true }
    }
}

/// A body in the plan of a frame.
pub(crate) struct PlannedBody {
    pub(crate) id: BodyId,
    /// Index in the scene.
    pub(crate) index: usize,
    pub(crate) work: Work,
    /// Whether the air stage draws it.
    pub(crate) has_air: bool,
}

/// What the stages of a frame draw.
pub(crate) struct Plan {
    pub(crate) viewport_px: [u32; 4],
    /// Whether the view owns the targets that a caller would lend.
    pub(crate) has_own_targets: bool,
    /// The farthest first.
    pub(crate) bodies: Vec<PlannedBody>,
    /// Whether the air of any body is drawn.
    pub(crate) has_air: bool,
    /// Edges of triangles alone.
    pub(crate) lines: bool,
    pub(crate) metering: Metering,
    /// Whether the lens scatters light of this picture. A tile of a photograph has that of the whole.
    pub(crate) makes_bloom: bool,
    /// Decides which passes of the post-process run.
    pub(crate) post: Work,
}

impl Plan {
    /// The textures that the view needs of its own.
    pub(crate) fn owned(&self) -> Vec<Owned> {
        let mut owned = vec![Target::GroundSurface, Target::Stars, Target::Toned, Target::CloudLight];
        owned.extend([Target::CloudDistance, Target::Smoothed]);
        if self.bodies.iter().any(|body| body.work.shaded && body.work.sea) {
            owned.extend([Target::GroundRadiance, Target::GroundDepth]);
        }
        let mut owned: Vec<Owned> = owned.into_iter().map(Owned::Target).collect();
        if self.has_own_targets {
            owned.extend([Target::Radiance, Target::Depth, Target::Composite].map(Owned::Target));
        }
        let airs = self.bodies.iter().filter(|body| body.has_air).count();
        owned.extend((0..airs.saturating_sub(1).min(2)).map(Owned::Between));
        owned
    }
}

/// See the module. Record the stages in the order in which they are listed here.
pub struct PreparedFrame<'r> {
    renderer: &'r Renderer,
    view: &'r ViewResources,
    plan: Plan,
}

impl<'r> PreparedFrame<'r> {
    pub(crate) fn new(renderer: &'r Renderer, view: &'r ViewResources, plan: Plan) -> Self {
        Self { renderer, view, plan }
    }

    /// Stage 1: ground and sea of all bodies.
    ///
    /// # Errors [`RenderError::TargetSize`], [`RenderError::TargetFormat`], [`RenderError::TargetUsage`]: the targets
    /// do not fit.
    pub fn draw_opaque(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        to: &OpaqueTargets<'_>,
    ) -> Result<FrameStats, RenderError> {
        let attachment = wgpu::TextureUsages::RENDER_ATTACHMENT;
        self.check("radiance target", to.radiance, RADIANCE_FORMAT, attachment)?;
        self.check("depth target", to.depth, DEPTH_FORMAT, attachment)?;
        let view = self.view;
        let mut stats = FrameStats::default();
        let mut load = to.load;
        for body in &self.plan.bodies {
            let (Some(resources), Some(body_view)) = (self.renderer.bodies.get(&body.id), view.bodies.get(&body.id))
            else {
                continue;
            };
            let texture = |target| match target {
                Target::Radiance => Some(to.radiance),
                Target::Depth => Some(to.depth),
                other => view.targets.get(Owned::Target(other)),
            };
            // Under a sea the ground goes into targets of its own, and the sea pass writes both.
            let under_sea = body.work.shaded && body.work.sea;
            let [radiance, depth] = match under_sea {
                true => [Target::GroundRadiance, Target::GroundDepth],
                false => [Target::Radiance, Target::Depth],
            };
            let textures = [radiance, Target::GroundSurface, depth].map(texture);
            let [Some(radiance), Some(surface), Some(depth)] = textures else { continue };
            let ground = GroundTargets {
                radiance,
                surface,
                depth,
                viewport_px: self.plan.viewport_px,
                load: load && !under_sea,
                lines: self.plan.lines,
                variant: body_view.variant,
            };
            let groups = [&body_view.group, resources.luts.group()];
            let pass = &self.renderer.pipelines.terrain;
            let tiles = (&resources.tiles, &body_view.ground);
            let device = &self.renderer.device;
            let drawn = pass.draw((device, encoder), &self.renderer.indices, groups, tiles, &ground)?;
            stats.tiles_drawn += drawn.tiles_drawn;
            stats.triangles += drawn.triangles;
            let over = LifeTargets { radiance, surface, depth, viewport_px: self.plan.viewport_px };
            let objects = (&resources.models, &body_view.life);
            let drawn = self.renderer.pipelines.life.draw((device, encoder), &body_view.group, objects, &over);
            stats.triangles += drawn.triangles;
            stats.objects_drawn += drawn.objects_drawn;
            for pass in self.running(&self.renderer.pipelines.opaque, &body.work) {
                pass.draw(
                    encoder,
                    &Drawing { variant: body_view.variant, ..self.drawing(view, &groups, &texture, load) },
                )?;
            }
            load = true;
        }
        if !load {
            clear(encoder, to);
        }
        Ok(stats)
    }

    /// Stage 2: clouds and air of all bodies over `radiance` and `depth`, whoever drew into them, and stars and suns
    /// where depth is 0; into `composite`, which is another texture of the same format.
    ///
    /// # Errors
    /// As [`PreparedFrame::draw_opaque`].
    pub fn draw_air(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        radiance: &wgpu::TextureView,
        depth: &wgpu::TextureView,
        composite: &wgpu::TextureView,
    ) -> Result<(), RenderError> {
        let (read, written) = (wgpu::TextureUsages::TEXTURE_BINDING, wgpu::TextureUsages::RENDER_ATTACHMENT);
        self.check("radiance target", radiance, RADIANCE_FORMAT, read)?;
        self.check("depth target", depth, DEPTH_FORMAT, read)?;
        self.check("composite target", composite, RADIANCE_FORMAT, written)?;
        let view = self.view;
        let with_air: Vec<_> = self.plan.bodies.iter().filter(|body| body.has_air).collect();
        for (number, body) in with_air.iter().enumerate() {
            let (Some(resources), Some(body_view)) = (self.renderer.bodies.get(&body.id), view.bodies.get(&body.id))
            else {
                continue;
            };
            let between = |number: usize| view.targets.get(Owned::Between(number % 2));
            let texture = |target| match target {
                Target::BeforeAir if number == 0 => Some(radiance),
                Target::BeforeAir => between(number - 1),
                Target::AfterAir if number + 1 == with_air.len() => Some(composite),
                Target::AfterAir => between(number),
                Target::Depth => Some(depth),
                other => view.targets.get(Owned::Target(other)),
            };
            let kept = body_view.clouds.as_ref();
            let with_kept = |target| kept.and_then(|kept| kept.texture(target, false)).or_else(|| texture(target));
            let marching = |target| kept.and_then(|kept| kept.texture(target, true)).or_else(|| texture(target));
            let groups = [&body_view.group, resources.luts.group()];
            for pass in self.running(&self.renderer.pipelines.air, &body.work) {
                let mut drawing = self.drawing(view, &groups, &with_kept, number > 0);
                (drawing.keeps_rest, drawing.variant) = (!self.is_whole(), body_view.variant);
                if let (Some(kept), true) = (kept, pass.pass.shader == clouds::PASS.shader) {
                    drawing.texture = &marching;
                    drawing.viewport_px = kept.marched_px(self.plan.viewport_px);
                }
                pass.draw(encoder, &drawing)?;
            }
        }
        if with_air.is_empty() {
            let texture = |target| match target {
                Target::BeforeAir => Some(radiance),
                Target::AfterAir => Some(composite),
                other => view.targets.get(Owned::Target(other)),
            };
            let groups = [&view.group];
            let drawing = self.drawing(view, &groups, &texture, false);
            self.renderer.pipelines.copy.draw(encoder, &Drawing { keeps_rest: !self.is_whole(), ..drawing })?;
        }
        Ok(())
    }

    /// Stage 3, which the caller may replace: exposure, tone curve, smooth edges, and encoding for the output's format.
    ///
    /// # Errors
    /// As [`PreparedFrame::draw_opaque`].
    pub fn draw_post(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        composite: &wgpu::TextureView,
        output: &wgpu::TextureView,
    ) -> Result<(), RenderError> {
        self.check("composite target", composite, RADIANCE_FORMAT, wgpu::TextureUsages::TEXTURE_BINDING)?;
        targets::check("output", output, None, wgpu::TextureUsages::RENDER_ATTACHMENT)?;
        self.meter(encoder, composite);
        let view = self.view;
        let still = view.still.as_ref().filter(|_| view.progress.still > 0);
        // A still picture keeps the bloom of its first frame.
        if self.plan.makes_bloom && view.progress.still <= 1 {
            let picture = (composite, &view.exposure.result);
            self.renderer.pipelines.bloom.draw(&self.renderer.device, encoder, &view.bloom, &view.group, picture);
        }
        let smoothed = self.plan.post.shaded && self.plan.post.smooth_edges;
        let picture = if smoothed { Target::Smoothed } else { Target::Toned };
        let of_frame = |target| match target {
            Target::Composite => Some(composite),
            Target::Output => Some(output),
            Target::Bloom => view.bloom.light(),
            Target::Picture => view.targets.get(Owned::Target(picture)),
            other => view.targets.get(Owned::Target(other)),
        };
        let of_still = |target| match (target, still) {
            (Target::Composite, Some(still)) => still.texture(Target::MeanLight),
            (Target::Stars, Some(still)) => still.texture(Target::MeanStars),
            (Target::Picture, Some(still)) => still.texture(picture),
            (Target::Toned | Target::Smoothed, Some(still)) => still.texture(target),
            (other, _) => of_frame(other),
        };
        let groups = [&view.group];
        let viewport_px = match still {
            Some(still) => {
                let [width, height] = still.targets.size_px;
                let texture = |target| still.texture(target).or_else(|| of_frame(target));
                let drawing = self.drawing(view, &groups, &texture, false);
                let viewport_px = [0, 0, width, height];
                self.renderer.pipelines.still.draw(encoder, &Drawing { viewport_px, ..drawing })?;
                viewport_px
            }
            None => self.plan.viewport_px,
        };
        for pass in self.running(&self.renderer.pipelines.post, &self.plan.post) {
            let mut drawing = Drawing { viewport_px, ..self.drawing(view, &groups, &of_still, false) };
            if pass.pass.writes.iter().any(|written| written.target == Target::Output) {
                let texture = output.texture();
                // A picture that fills its targets fills the output as well, whatever the render scale.
                if self.is_whole() {
                    drawing.viewport_px = [0, 0, texture.width(), texture.height()];
                } else {
                    drawing.keeps_rest = true;
                }
            }
            pass.draw(encoder, &drawing)?;
        }
        Ok(())
    }

    /// Finds the exposure of a picture: the first step of [`PreparedFrame::draw_post`], for callers with their own.
    pub fn meter(&self, encoder: &mut wgpu::CommandEncoder, composite: &wgpu::TextureView) {
        let device = (&self.renderer.device, &self.renderer.queue);
        let (pass, of) = (&self.renderer.pipelines.exposure, &self.view.exposure);
        pass.draw(device, encoder, of, composite, self.plan.viewport_px, self.plan.metering);
    }

    /// The exposure that was metered: a uniform and storage buffer of four `f32`, the factor on radiance, its
    /// logarithm to base 2, the stops by which highlights exceed white, and those by which dark parts are lifted
    /// ([`super::Metered`]). With [`Metering::Manual`] they are 1 and zeros.
    pub fn exposure(&self) -> &wgpu::Buffer {
        &self.view.exposure.result
    }

    /// Stars of the air stage, for callers with their own post-process: square roots of what a display shows, to be
    /// squared and added after the exposure.
    pub fn stars(&self) -> Option<&wgpu::TextureView> {
        self.view.targets.get(Owned::Target(Target::Stars))
    }

    /// Bind groups 0 and 1 for shaders that begin with [`super::air_wgsl`]: uniforms and LUTs of a body of the scene.
    pub fn body_groups(&self, id: BodyId) -> Option<[&wgpu::BindGroup; 2]> {
        let body_view = self.view.bodies.get(&id)?;
        Some([&body_view.group, self.renderer.bodies.get(&id)?.luts.group()])
    }

    /// All stages in the view's own targets. Statistics, and the target that holds the radiance of the scene.
    pub(crate) fn draw_all(
        self,
        encoder: &mut wgpu::CommandEncoder,
        output: &wgpu::TextureView,
    ) -> Result<(FrameStats, Target), RenderError> {
        let has_air = self.plan.has_air;
        let radiance = if has_air { Target::Composite } else { Target::Radiance };
        let texture = |target| self.view.targets.get(Owned::Target(target));
        let textures = [Target::Radiance, Target::Depth, radiance].map(texture);
        let [Some(opaque), Some(depth), Some(composite)] = textures else {
            return Ok((FrameStats::default(), radiance));
        };
        let stats = self.draw_opaque(encoder, &OpaqueTargets::cleared(opaque, depth))?;
        if has_air {
            self.draw_air(encoder, opaque, depth, composite)?;
        }
        self.draw_post(encoder, composite, output)?;
        Ok((stats, radiance))
    }

    fn check(
        &self,
        name: &'static str,
        view: &wgpu::TextureView,
        format: wgpu::TextureFormat,
        usage: wgpu::TextureUsages,
    ) -> Result<(), RenderError> {
        let limit_px = self.renderer.device.limits().max_texture_dimension_2d;
        targets::check(name, view, Some(format), usage)?;
        targets::check_size(name, view, self.view.targets.size_px, limit_px)
    }

    fn running<'p>(&self, pipelines: &'p [ScreenPipeline], work: &Work) -> impl Iterator<Item = &'p ScreenPipeline> {
        pipelines.iter().filter(move |pipeline| (pipeline.pass.runs)(work))
    }

    fn drawing<'a>(
        &'a self,
        view: &'a ViewResources,
        groups: &'a [&'a wgpu::BindGroup],
        texture: &'a dyn Fn(Target) -> Option<&'a wgpu::TextureView>,
        load: bool,
    ) -> Drawing<'a> {
        Drawing {
            device: &self.renderer.device,
            groups,
            texture,
            exposure: &view.exposure.result,
            viewport_px: self.plan.viewport_px,
            variant: Variant::FIRST,
            load,
            keeps_rest: false,
        }
    }

    /// Whether the picture fills its targets.
    fn is_whole(&self) -> bool {
        let [x, y, width, height] = self.plan.viewport_px;
        [x, y] == [0, 0] && [width, height] == self.view.targets.size_px
    }
}

/// Clears the targets of the opaque stage where there is no body.
fn clear(encoder: &mut wgpu::CommandEncoder, to: &OpaqueTargets<'_>) {
    let ops = wgpu::Operations { load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT), store: wgpu::StoreOp::Store };
    let radiance = wgpu::RenderPassColorAttachment { view: to.radiance, depth_slice: None, resolve_target: None, ops };
    encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
        label: Some("clear"),
        color_attachments: &[Some(radiance)],
        depth_stencil_attachment: Some(super::gpu::depth_attachment(to.depth, false)),
        ..wgpu::RenderPassDescriptor::default()
    });
}
