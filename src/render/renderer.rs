//! The renderer of a device: pipelines and patterns once, resources for each body and for each view.

use super::bloom::Bloom;
use super::body_tiles::BodyTiles;
use super::debug_view::DebugView;
use super::ground_view::GroundView;
use super::history::{CloudFrame, CloudHistory, Progress, Still};
use super::life::{CanopyRows, Cascades, LifeModels, LifeView, PlantingBuffer, ShadowMap};
use super::luts::{LutRuns, Luts, SharedLuts};
use super::passes::Pipelines;
use super::prepared::{Plan, PlannedBody, PreparedFrame};
use super::scene::{Body, BodyId, Reuse, Scene, ViewId};
use super::screen_pass::{Shared, Work};
use super::shared::MAX_SUNS;
use super::targets::{self, Owned, Target, Targets};
use super::terrain::Indices;
use super::uniform_groups::UniformGroups;
use super::uniforms::{self, Drawn, UniformBuffer};
use super::variant::Variant;
use super::{FrameStats, Metered, Metering, RenderError, exposure, gpu, shaders};
use crate::clouds::coverages;
use crate::planet::Planet;
use crate::tiles::Surface;
use std::collections::{HashMap, HashSet};
use std::sync::Arc;

/// Draws scenes on one device. Bodies and views have their own resources, under the ids that a scene gives them.
pub struct Renderer {
    pub(crate) device: wgpu::Device,
    pub(crate) queue: wgpu::Queue,
    shared: Arc<UniformGroups>,
    pub(crate) patterns: Arc<SharedLuts>,
    pub(crate) indices: Arc<Indices>,
    pub(crate) pipelines: Arc<Pipelines>,
    pub(crate) bodies: HashMap<BodyId, BodyResources>,
    /// Bytes of tiles that were uploaded for bodies that are forgotten.
    forgotten_bytes: u64,
    pub(crate) views: HashMap<ViewId, ViewResources>,
    watch: shaders::Watch,
    shader_error: Option<String>,
    /// The view of the newest [`Renderer::render`], and the target that holds its radiance.
    newest: Option<(ViewId, Target)>,
}

/// Resources of a body.
pub(crate) struct BodyResources {
    pub(crate) tiles: BodyTiles,
    pub(crate) luts: Luts,
    pub(crate) models: LifeModels,
    /// Views that have drawn the body in this frame of it.
    drawn_by: HashSet<ViewId>,
}

/// Resources of a view.
pub(crate) struct ViewResources {
    frame: UniformBuffer,
    /// Group of the passes that read no body.
    pub(crate) group: wgpu::BindGroup,
    pub(crate) targets: Targets,
    pub(crate) exposure: exposure::Exposure,
    pub(crate) bloom: Bloom,
    pub(crate) progress: Progress,
    /// The mean of the frames of a still scene.
    pub(crate) still: Option<Still>,
    pub(crate) bodies: HashMap<BodyId, BodyView>,
}

/// Resources of a body in a view.
pub(crate) struct BodyView {
    uniforms: UniformBuffer,
    /// Group 0 of the passes that draw the body.
    pub(crate) group: wgpu::BindGroup,
    pub(crate) ground: GroundView,
    pub(crate) life: LifeView,
    pub(crate) shadows: Option<ShadowMap>,
    pub(crate) planting: PlantingBuffer,
    /// The clouds of the frames before, if they are kept.
    pub(crate) clouds: Option<CloudHistory>,
    /// What the body needs in this frame.
    pub(crate) variant: Variant,
}

impl Renderer {
    /// Features and limits to ask of the device; works on every adapter of the WebGPU default limits.
    pub fn required_limits() -> wgpu::Limits {
        wgpu::Limits::default()
    }

    /// Whether an adapter draws to all formats that the renderer needs. Those of OpenGL do not.
    pub fn can_use(adapter: &wgpu::Adapter) -> bool {
        let draws_to = |format| {
            let features = adapter.get_texture_format_features(format);
            features.allowed_usages.contains(wgpu::TextureUsages::RENDER_ATTACHMENT)
        };
        [wgpu::TextureFormat::Rg32Float, wgpu::TextureFormat::R32Float, super::RADIANCE_FORMAT]
            .into_iter()
            .all(draws_to)
    }

    /// Compiles the pipelines and uploads the patterns.
    ///
    /// # Errors
    /// [`RenderError::Shader`]: the driver rejects a shader.
    pub fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Result<Self, RenderError> {
        let shared = UniformGroups::new(device);
        let patterns = SharedLuts::new(device, queue);
        let pipelines = Pipelines::new(device, Shared { uniforms: &shared.layout, luts: &patterns.layout })?;
        Ok(Self {
            device: device.clone(),
            queue: queue.clone(),
            shared: Arc::new(shared),
            patterns: Arc::new(patterns),
            indices: Arc::new(Indices::new(device)),
            pipelines: Arc::new(pipelines),
            bodies: HashMap::new(),
            forgotten_bytes: 0,
            views: HashMap::new(),
            watch: shaders::Watch::new(),
            shader_error: None,
            newest: None,
        })
    }

    /// A second renderer on the same device, with bodies and views of its own: it shares the pipelines and the patterns
    /// of this one, so that it costs nothing to make.
    pub fn sibling(&self) -> Self {
        Self {
            device: self.device.clone(),
            queue: self.queue.clone(),
            shared: Arc::clone(&self.shared),
            patterns: Arc::clone(&self.patterns),
            indices: Arc::clone(&self.indices),
            pipelines: Arc::clone(&self.pipelines),
            bodies: HashMap::new(),
            forgotten_bytes: 0,
            views: HashMap::new(),
            watch: shaders::Watch::new(),
            shader_error: None,
            newest: None,
        }
    }

    /// Layouts of the two bind groups of a body ([`PreparedFrame::body_groups`]): group 0 and 1 of a pipeline whose
    /// shader begins with [`super::air_wgsl`].
    pub fn body_layouts(&self) -> [&wgpu::BindGroupLayout; 2] {
        [&self.shared.layout, &self.patterns.layout]
    }

    /// Frees the resources of a body that scenes no longer hold.
    pub fn forget_body(&mut self, id: BodyId) {
        let forgotten = self.bodies.remove(&id);
        self.forgotten_bytes += forgotten.map_or(0, |body| body.tiles.uploaded_bytes());
        for view in self.views.values_mut() {
            view.bodies.remove(&id);
        }
    }

    /// Frees the resources of a view that is no longer drawn.
    pub fn forget_view(&mut self, id: ViewId) {
        self.views.remove(&id);
    }

    /// Draws the patterns of a planet's ground on other threads (some 20 to 170 ms of a core for each kind that no
    /// planet has shown). Call it where the planet's tiles are asked for; without it the first frame waits for them.
    pub fn draw_patterns_ahead(planet: &Planet) {
        super::patterns::draw_ahead(&planet.biomes);
    }

    /// Uploads tiles of a surface ahead of the frame that will draw it, at most `budget_bytes`, but at least one tile.
    /// Whether all are on the GPU now. Without it [`Renderer::prepare`] uploads all that it needs.
    pub fn upload(&mut self, id: BodyId, surface: &Surface, budget_bytes: u64) -> bool {
        profiling::scope!("upload");
        let (device, queue) = (&self.device, &self.queue);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("upload") });
        let body = self.bodies.entry(id).or_insert_with(|| BodyResources::new(device, queue, &self.patterns));
        let done = body.tiles.upload(device, queue, &mut encoder, surface, budget_bytes);
        queue.submit([encoder.finish()]);
        done
    }

    /// Bytes of tiles uploaded since the start.
    pub fn uploaded_bytes(&self) -> u64 {
        let kept: u64 = self.bodies.values().map(|body| body.tiles.uploaded_bytes()).sum();
        self.forgotten_bytes + kept
    }

    /// How often the textures of a body have been made since the start.
    pub fn lut_runs(&self, id: BodyId) -> LutRuns {
        self.bodies.get(&id).map(|body| body.luts.runs).unwrap_or_default()
    }

    /// The newest error of a shader that was edited on disk (debug builds). The last good shaders go on drawing.
    pub fn shader_error(&self) -> Option<&str> {
        self.shader_error.as_deref()
    }

    /// Writes uniforms, uploads tiles and fills LUTs for a frame, and gives the stages to record.
    ///
    /// `target_px`: size of the caller's targets; `viewport_px`: left, top, width and height of the picture in them.
    /// Uniforms go through the queue: submit `encoder` before the same view is prepared again.
    ///
    /// # Errors
    /// [`RenderError::Viewport`], [`RenderError::TooManySuns`], [`RenderError::BodyTwice`]: the scene cannot be drawn.
    pub fn prepare(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene<'_>,
        target_px: [u32; 2],
        viewport_px: [u32; 4],
    ) -> Result<PreparedFrame<'_>, RenderError> {
        let [x, y, width, height] = viewport_px.map(u64::from);
        let [wide, high] = target_px.map(u64::from);
        if width == 0 || height == 0 || x + width > wide || y + height > high {
            return Err(RenderError::Viewport { viewport_px, target_px });
        }
        // Only [`Renderer::render`] makes the mean of a still scene.
        let reuse = if scene.reuse == Reuse::Still { Reuse::Begin } else { scene.reuse };
        self.begin_view(scene.view_id, target_px, reuse);
        let drawn = Drawn { viewport_px, render_scale: 1.0, matrices: scene.matrices() };
        self.prepare_drawn(encoder, scene, target_px, &drawn, false)
    }

    /// Begins a frame of a view with targets of a size.
    fn begin_view(&mut self, id: ViewId, target_px: [u32; 2], reuse: Reuse) -> Progress {
        let device = &self.device;
        let view = self.views.entry(id).or_insert_with(|| {
            let frame = UniformBuffer::new::<uniforms::Frame>(device, "frame");
            let group = self.shared.group(
                device,
                &frame,
                &UniformBuffer::new::<uniforms::Body>(device, "no body"),
                (None, None),
            );
            ViewResources {
                frame,
                group,
                targets: Targets::new(target_px),
                exposure: exposure::Exposure::new(device),
                bloom: Bloom::new(device, [1, 1]),
                progress: Progress::default(),
                still: None,
                bodies: HashMap::new(),
            }
        });
        if view.targets.size_px != target_px {
            view.targets = Targets::new(target_px);
        }
        view.progress.begin(reuse);
        view.progress
    }

    fn prepare_drawn(
        &mut self,
        encoder: &mut wgpu::CommandEncoder,
        scene: &Scene<'_>,
        target_px: [u32; 2],
        drawn: &Drawn,
        has_own_targets: bool,
    ) -> Result<PreparedFrame<'_>, RenderError> {
        let suns = scene.bodies.iter().map(|body| scene.suns_of(body.id).count()).max();
        if let Some(suns) = suns.filter(|suns| *suns > MAX_SUNS) {
            return Err(RenderError::TooManySuns(suns));
        }
        let mut ids = HashSet::new();
        if let Some(twice) = scene.bodies.iter().find(|body| !ids.insert(body.id)) {
            return Err(RenderError::BodyTwice(twice.id.0));
        }
        self.reload_shaders();
        let mut plan = plan(scene, drawn, has_own_targets);
        let (device, queue) = (&self.device, &self.queue);
        let shared = &*self.shared;
        let Some(view) = self.views.get_mut(&scene.view_id) else { return Err(not_there()) };
        let picture_px = [drawn.viewport_px[2], drawn.viewport_px[3]];
        if plan.makes_bloom && !view.bloom.fits(picture_px) {
            view.bloom = Bloom::new(device, picture_px);
        }
        for owned in plan.owned() {
            view.targets.make(device, owned);
        }
        let mut frame_values = uniforms::frame(scene, drawn);
        let still_scale = (1.0 / drawn.render_scale).max(1.0);
        view.progress.write(&mut frame_values, still_scale);
        let still_px = if still_scale > 1.0 { scene.size_px } else { target_px };
        view.still = view.still.take().filter(|still| scene.reuse != Reuse::None && still.targets.size_px == still_px);
        if view.progress.still > 0 {
            view.still.get_or_insert_with(|| Still::new(device, still_px)).advance();
        }
        let frame_written = view.frame.write(queue, &frame_values);
        for (number, planned) in plan.bodies.iter_mut().enumerate() {
            let body = &scene.bodies[planned.index];
            let resources =
                self.bodies.entry(body.id).or_insert_with(|| BodyResources::new(device, queue, &self.patterns));
            let body_view = view.bodies.entry(body.id).or_insert_with(|| {
                let uniforms = UniformBuffer::new::<uniforms::Body>(device, "body");
                let group = shared.group(device, &view.frame, &uniforms, (None, None));
                let (ground, life) = (GroundView::new(device), LifeView::default());
                let (planting, variant) = (PlantingBuffer::new(device), Variant::FIRST);
                BodyView { uniforms, group, ground, life, shadows: None, planting, clouds: None, variant }
            });
            let mut values = uniforms::body(scene, body, drawn, number == 0);
            let terrain = &*body.surface.terrain;
            let clouds = resources.luts.update_clouds(queue, (&body.revision, Some(terrain)), scene);
            values.cloud_offsets = clouds.offsets;
            (values.cloud_odd_share, values.cloud_least_level) = (clouds.odd_share, clouds.least_level);
            body_view.variant = Variant::of(&values, frame_values.pixel_rad);
            let clouds = CloudFrame {
                reuse: if planned.work.clouds { scene.reuse } else { Reuse::None },
                progress: view.progress,
                size_px: target_px,
                quality: scene.quality,
                eye_m: body.eye_planet_m(),
                drift_rad: uniforms::clouds::drift_rad(body.planet(), scene.time_secs),
            };
            planned.work.carries_clouds = CloudHistory::prepare(&mut body_view.clouds, device, &clouds, &mut values);
            let cascades = Cascades::new(scene, body);
            let mut is_other = body_view.planting.show(device, body, &mut values);
            if let Some(cascades) = &cascades {
                cascades.write(&mut values);
                is_other |= ShadowMap::fit(&mut body_view.shadows, device, cascades);
            }
            if is_other {
                let rest = (body_view.shadows.as_ref(), Some(&body_view.planting));
                body_view.group = shared.group(device, &view.frame, &body_view.uniforms, rest);
            }
            let body_written = body_view.uniforms.write(queue, &values);
            resources.luts.runs.uniforms += u64::from(frame_written || body_written);
            resources.begin_view(scene.view_id);
            let lod_view = scene.view_of(body.position_m, body.scene_from_body);
            body_view.ground.prepare((device, queue), encoder, &mut resources.tiles, body, &lod_view);
            body_view.ground.morph(encoder, &self.pipelines.morph);
            resources.luts.update(
                (device, queue),
                encoder,
                (&*self.patterns, &self.pipelines.luts),
                (&body_view.group, values.lut_sun_radius_rad),
                (&body.revision, scene.drafts),
                (body.marked.as_ref(), CanopyRows::new(body, scene.shown_population())),
            );
            let life = &mut body_view.life;
            if matches!(scene.debug_view, DebugView::Shaded | DebugView::Albedo) {
                let (models, tiles) = (&mut resources.models, &mut resources.tiles);
                life.prepare((device, queue), models, tiles, body, &lod_view, cascades.as_ref());
                let objects = (&resources.models, &*life, cascades.as_ref().zip(body_view.shadows.as_ref()));
                self.pipelines.life.cast((device, encoder), objects, &body.casters);
                let groups = [&body_view.group, resources.luts.group()];
                self.pipelines.life.light(device, encoder, groups, &resources.tiles, life);
            } else {
                life.clear();
            }
            if let Some(map) = scene.debug_view.map() {
                resources.luts.show_map((device, queue), &self.patterns, map, &body.surface.terrain);
            }
        }
        let renderer: &Self = self;
        match renderer.views.get(&scene.view_id) {
            Some(view) => Ok(PreparedFrame::new(renderer, view, plan)),
            None => Err(not_there()),
        }
    }

    /// Draws a scene into a target as large as [`Scene::size_px`] and submits it: all stages in the view's own targets,
    /// at the render scale of the scene's quality.
    ///
    /// # Errors
    /// [`RenderError::TargetSize`]: the target has another size, and nothing is drawn. Others as [`Renderer::prepare`].
    pub fn render(&mut self, target: &wgpu::TextureView, scene: &Scene<'_>) -> Result<FrameStats, RenderError> {
        profiling::scope!("render");
        let limit_px = self.device.limits().max_texture_dimension_2d;
        targets::check_size("target", target, scene.size_px, limit_px)?;
        let (size_px, render_scale) = targets::drawn_size(scene, limit_px);
        let (device, queue) = (self.device.clone(), self.queue.clone());
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor { label: Some("frame") });
        let viewport_px = [0, 0, size_px[0], size_px[1]];
        let jitter_px = self.begin_view(scene.view_id, size_px, scene.reuse).jitter_px() / f64::from(render_scale);
        let mut scene = scene.clone();
        scene.projection.jitter_px[0] += jitter_px.x;
        scene.projection.jitter_px[1] += jitter_px.y;
        let drawn = Drawn { viewport_px, render_scale, matrices: scene.matrices() };
        let frame = self.prepare_drawn(&mut encoder, &scene, size_px, &drawn, true)?;
        let (stats, radiance) = frame.draw_all(&mut encoder, target)?;
        self.newest = Some((scene.view_id, radiance));
        queue.submit([encoder.finish()]);
        Ok(stats)
    }

    /// The radiance of the newest [`Renderer::render`] before exposure and tone curve, without stars: size of the
    /// picture as it was drawn, and red, green and blue of each pixel (1: white ground at noon). Waits for the device.
    ///
    /// # Errors
    /// [`RenderError::Device`]: the device does not answer.
    pub fn radiance(&self) -> Result<([u32; 2], Vec<[f32; 3]>), RenderError> {
        let newest = self.newest.and_then(|(id, target)| {
            let targets = &self.views.get(&id)?.targets;
            Some((targets.size_px, targets.get(Owned::Target(target))?))
        });
        let Some(([width, height], view)) = newest else { return Ok(([0, 0], Vec::new())) };
        let bytes = gpu::read_texture(&self.device, &self.queue, view.texture())?;
        let half = |bytes: &[u8]| half::f16::from_le_bytes([bytes[0], bytes[1]]).to_f32();
        let pixel = |bytes: &[u8]| [half(bytes), half(&bytes[2..]), half(&bytes[4..])];
        Ok(([width, height], bytes.chunks_exact(8).map(pixel).collect()))
    }

    /// What the newest [`Renderer::render`] of a view metered, for [`super::Metering::Fixed`]: zeros for a view that
    /// was not drawn. Waits for the device.
    ///
    /// # Errors
    /// [`RenderError::Device`]: the device does not answer.
    pub fn metered(&self, id: ViewId) -> Result<Metered, RenderError> {
        let Some(view) = self.views.get(&id) else { return Ok(Metered::default()) };
        let buffer = self.device.create_buffer(&wgpu::BufferDescriptor {
            label: Some("metered"),
            size: 16,
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        });
        let mut encoder = self.device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(&view.exposure.result, 0, &buffer, 0, 16);
        self.queue.submit([encoder.finish()]);
        let bytes = gpu::read(&self.device, &buffer)?;
        let value = |bytes: &[u8]| f64::from(f32::from_le_bytes([bytes[0], bytes[1], bytes[2], bytes[3]]));
        Ok(Metered { ev: value(&bytes[4..]), beyond_ev: value(&bytes[8..]), fill_ev: value(&bytes[12..]) })
    }

    /// Group 0 of a frame and a body.
    pub(crate) fn uniform_group(&self, frame: &UniformBuffer, body: &UniformBuffer) -> wgpu::BindGroup {
        self.shared.group(&self.device, frame, body, (None, None))
    }

    fn reload_shaders(&mut self) {
        if !self.watch.changed() {
            return;
        }
        let shared = Shared { uniforms: &self.shared.layout, luts: &self.patterns.layout };
        match Pipelines::new(&self.device, shared) {
            Ok(pipelines) => {
                self.pipelines = Arc::new(pipelines);
                for body in self.bodies.values_mut() {
                    body.luts.forget();
                }
                self.shader_error = None;
            }
            Err(error) => self.shader_error = Some(error.to_string()),
        }
    }
}

impl BodyResources {
    fn new(device: &wgpu::Device, queue: &wgpu::Queue, shared: &SharedLuts) -> Self {
        let luts = Luts::new(device, queue, shared);
        Self { tiles: BodyTiles::new(device), luts, models: LifeModels::default(), drawn_by: HashSet::new() }
    }

    /// A view that draws the body for the second time begins a new frame of it.
    fn begin_view(&mut self, id: ViewId) {
        if self.drawn_by.is_empty() || !self.drawn_by.insert(id) {
            self.drawn_by.clear();
            self.drawn_by.insert(id);
            self.tiles.begin_frame();
        }
    }
}

fn not_there() -> RenderError {
    RenderError::Device("the view is not there".to_owned())
}

/// What the stages of a frame have to draw.
fn plan(scene: &Scene<'_>, drawn: &Drawn, has_own_targets: bool) -> Plan {
    let shaded = scene.debug_view == DebugView::Shaded;
    let away_m = |body: &Body<'_>| uniforms::away_m(body);
    let mut order: Vec<usize> = (0..scene.bodies.len()).collect();
    order.sort_by(|&a, &b| away_m(&scene.bodies[b]).total_cmp(&away_m(&scene.bodies[a])));
    let planned = |(number, index): (usize, usize)| {
        let body = &scene.bodies[index];
        let clouds = body
            .planet()
            .clouds
            .as_ref()
            .is_some_and(|clouds| coverages(clouds).iter().any(|coverage| *coverage > 0.0))
            && body.marked.is_none();
        let sea = body.planet().water.is_some();
        let aurora = body.planet().atmosphere.as_ref().is_some_and(|air| air.aurora > 0.0) && body.marked.is_none();
        let work = Work { shaded, sea, clouds, carries_clouds: false, aurora, smooth_edges: scene.post.smooth_edges };
        // The farthest body brings the stars, whether it has air or not.
        let has_air =
            shaded && (number == 0 || clouds || body.planet().atmosphere.is_some() || body.planet().rings.is_some());
        PlannedBody { id: body.id, index, work, has_air }
    };
    let bodies: Vec<PlannedBody> = order.into_iter().enumerate().map(planned).collect();
    Plan {
        viewport_px: drawn.viewport_px,
        has_own_targets,
        has_air: bodies.iter().any(|body| body.has_air),
        bodies,
        lines: scene.debug_view == DebugView::Wireframe,
        makes_bloom: shaded && scene.post.bloom > 0.0 && scene.whole.is_none(),
        metering: if shaded { scene.post.metering } else { Metering::Manual },
        post: Work { shaded, smooth_edges: scene.post.smooth_edges, ..Work::default() },
    }
}
