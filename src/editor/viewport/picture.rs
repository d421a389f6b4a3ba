//! The picture on screen: uploads the tiles of a surface to the GPU, and draws it when something has changed.

use super::adaptation::{self, Adaptation};
use super::clock::{EditClock, FrameMeter};
use super::frames::FrameLog;
use super::neighbours::Sky;
use super::refinement::Refinement;
use super::settings::ViewSettings;
use super::swap::{Swap, UPLOAD_BUDGET_BYTES};
use super::target::Target;
use super::timeline::{self, Span};
use crate::lod::{Quality, View};
use crate::planet::Planet;
use crate::render::{
    BodyId, DebugView, FrameStats, LutRuns, MarkedCells, Metering, Post, RenderError, Renderer, Reuse, Scene,
};
use crate::terrain::Revision;
use crate::tiles::{Leaf, Surface};
use eframe::egui::{self, TextureId};
use eframe::egui_wgpu::RenderState;
use std::sync::Arc;
use std::time::{Duration, Instant};

/// The subject of the picture.
pub(super) struct Subject<'a> {
    pub(super) surface: Arc<Surface>,
    /// The planet that gives sea, air, clouds and light.
    pub(super) revision: Revision,
    pub(super) view: View,
    /// The view whose tiles are kept, if detail is frozen.
    pub(super) frozen: Option<View>,
    pub(super) settings: &'a ViewSettings,
    /// Cells of the biome table whose ground lights up.
    pub(super) marked: Option<Arc<MarkedCells>>,
    /// The other bodies of the planet's system.
    pub(super) sky: Option<Sky>,
    /// Whether cloud maps and the LUTs of the air may be drafts: a button of the pointer is down.
    pub(super) drafts: bool,
    /// Whether a finer surface is on its way.
    pub(super) is_busy: bool,
    /// Time of the frame.
    pub(super) now_secs: f64,
}

/// The measurements that drawing takes part in.
pub(super) struct Meters<'a> {
    pub(super) frames: &'a mut FrameLog,
    pub(super) frame_meter: &'a mut FrameMeter,
    pub(super) edit_clock: &'a mut EditClock,
}

/// The renderer with eframe's device, or why there is none.
enum Drawing {
    Ready(Box<Renderer>, RenderState),
    Failed(String),
}

/// The picture on screen.
pub(super) struct Picture {
    drawing: Drawing,
    swap: Swap,
    /// The upload under way or just done: when, and how many bytes had been uploaded before it.
    upload: Option<(Span, u64)>,
    target: Option<Target>,
    drawn: Option<PictureKey>,
    /// The bodies of the newest picture.
    bodies: Vec<BodyId>,
    adaptation: Adaptation,
    pub(super) refinement: Refinement,
    stats: FrameStats,
    count: u64,
}

impl Picture {
    /// Draws with eframe's device, or says why it cannot.
    pub(super) fn new(render_state: Option<&RenderState>) -> Self {
        let drawing = match render_state {
            Some(state) => match renderer_on(state) {
                Ok(renderer) => Drawing::Ready(Box::new(renderer), state.clone()),
                Err(error) => Drawing::Failed(error.to_string()),
            },
            None => Drawing::Failed("There is no graphics device to draw with.".to_owned()),
        };
        Self::with(drawing, render_state)
    }

    /// Another picture with the same device and pipelines.
    pub(super) fn sibling(&self) -> Self {
        match &self.drawing {
            Drawing::Ready(renderer, state) => {
                Self::with(Drawing::Ready(Box::new(renderer.sibling()), state.clone()), Some(state))
            }
            Drawing::Failed(why) => Self::with(Drawing::Failed(why.clone()), None),
        }
    }

    fn with(drawing: Drawing, render_state: Option<&RenderState>) -> Self {
        // On a software adapter the pictures between the first and the adapted one take too long.
        let is_cpu = |state: &RenderState| state.adapter.get_info().device_type == wgpu::DeviceType::Cpu;
        let is_software = render_state.is_none_or(is_cpu);
        Self {
            drawing,
            swap: Swap::default(),
            upload: None,
            target: None,
            drawn: None,
            bodies: Vec::new(),
            adaptation: Adaptation::new(!is_software),
            refinement: Refinement::new(is_software),
            stats: FrameStats::default(),
            count: 0,
        }
    }

    /// A renderer on the same device; none without a device.
    pub(super) fn second_renderer(&self) -> Option<Renderer> {
        match &self.drawing {
            Drawing::Ready(renderer, _) => Some(renderer.sibling()),
            Drawing::Failed(_) => None,
        }
    }

    /// The surface on screen.
    pub(super) fn surface(&self) -> Option<&Arc<Surface>> {
        self.swap.shown()
    }

    /// Whether `newest` is not on screen yet.
    pub(super) fn is_behind(&self, newest: Option<&Arc<Surface>>) -> bool {
        self.swap.is_under_way(newest)
    }

    /// How often each look-up texture has been made since the start.
    pub(super) fn lut_runs(&self) -> Option<LutRuns> {
        match &self.drawing {
            Drawing::Ready(renderer, _) => Some(renderer.lut_runs(self.bodies.first().copied().unwrap_or_default())),
            Drawing::Failed(_) => None,
        }
    }

    /// Figures of the newest picture.
    pub(super) fn stats(&self) -> FrameStats {
        self.stats
    }

    /// How many pictures have been drawn since the start.
    pub(super) fn count(&self) -> u64 {
        self.count
    }

    /// Why nothing, or only an old picture, is drawn.
    pub(super) fn error(&self) -> Option<&str> {
        match &self.drawing {
            Drawing::Ready(renderer, _) => renderer.shader_error(),
            Drawing::Failed(error) => Some(error.as_str()),
        }
    }

    /// The texture that holds the picture.
    pub(super) fn texture(&self) -> Option<TextureId> {
        self.target.as_ref().map(Target::id)
    }

    /// How long to wait for the next picture while the exposure adapts.
    pub(super) fn adapts_after(&self, settings: &ViewSettings) -> Option<Duration> {
        (settings.auto_exposure && self.adaptation.is_under_way()).then_some(adaptation::PAUSE)
    }

    /// How long to wait for the next sample of a still picture.
    pub(super) fn refines_after(&self, settings: &ViewSettings, now_secs: f64) -> Option<Duration> {
        let is_drawn = settings.refine && self.drawn.is_some() && matches!(self.drawing, Drawing::Ready(..));
        is_drawn.then(|| self.refinement.due_after(now_secs)).flatten()
    }

    /// Shows a surface that was drawn as that of a neighbour.
    pub(super) fn show_at_once(&mut self, surface: Arc<Surface>) {
        self.swap = Swap::of(Some(surface));
    }

    /// Keeps the picture as it is until there is another surface.
    pub(super) fn wait_for_surface(&mut self) {
        self.swap = Swap::of(None);
    }

    /// Uploads one frame's share of the newest surface, that of the body `id`, and shows it once all of its tiles are
    /// uploaded.
    pub(super) fn advance(
        &mut self,
        id: BodyId,
        newest: Option<&Arc<Surface>>,
        frames: &mut FrameLog,
        ctx: &egui::Context,
    ) {
        let (drawing, upload) = (&mut self.drawing, &mut self.upload);
        self.swap.advance(newest.cloned(), |surface| {
            let Drawing::Ready(renderer, _) = drawing else { return true };
            let (begin, before) = (Instant::now(), renderer.uploaded_bytes());
            let done = renderer.upload(id, surface, UPLOAD_BUDGET_BYTES);
            let now = Span::since(begin);
            frames.uploaded(now.end - now.begin);
            let (first, before) = upload.map_or((now, before), |(span, before)| (span, before));
            *upload = Some((Span { end: now.end, ..first }, before));
            done
        });
        if self.is_behind(newest) {
            ctx.request_repaint();
        }
    }

    /// Draws the subject, unless the texture holds that picture already.
    pub(super) fn draw(&mut self, subject: &Subject<'_>, meters: &mut Meters<'_>) {
        let Drawing::Ready(renderer, state) = &mut self.drawing else { return };
        let Subject { revision, settings, .. } = subject;
        let key = PictureKey::of(subject);
        let target = self.target.get_or_insert_with(|| Target::new(state, key.view.size_px));
        let resized = target.resize(key.view.size_px);
        let changed = resized || !self.drawn.as_ref().is_some_and(|drawn| drawn.same(&key));
        let adapting = settings.auto_exposure && self.adaptation.is_under_way();
        let is_due = self.refinement.due_after(subject.now_secs) == Some(Duration::ZERO);
        let refining = settings.refine && !subject.is_busy && is_due;
        if !changed && !adapting && !refining {
            if !self.swap.is_uploading() {
                self.upload = None;
            }
            return;
        }
        let begin = Instant::now();
        let sun_dir_planet = revision.planet().star.place(key.time_secs).direction();
        let mut scene = Scene::of_revision(revision.clone(), &key.surface, key.view, sun_dir_planet);
        scene.time_secs = key.time_secs;
        if let Some(sky) = &key.sky {
            sky.light(&mut scene, key.view.camera.position_planet_m, key.time_secs);
        }
        (scene.debug_view, scene.population) = (key.debug_view, key.population);
        scene.drafts = key.drafts;
        let is_sample = !changed && !adapting;
        let metering = match settings.auto_exposure && is_sample {
            // A further sample keeps the exposure.
            true => Metering::Adapting { secs: 0.0 },
            false => self.adaptation.metering(settings.auto_exposure, changed),
        };
        scene.post = Post { metering, ..key.post };
        scene.reuse = match &self.drawn {
            _ if !settings.refine => Reuse::None,
            _ if !changed => Reuse::Still,
            Some(drawn) if !resized && drawn.only_moved(&key) => Reuse::Moving,
            _ => Reuse::Begin,
        };
        if let Some(own) = scene.bodies.first_mut() {
            own.frozen = key.frozen;
            own.marked.clone_from(&key.marked);
        }
        let drawn = renderer.render(target.view(), &scene);
        match drawn {
            Ok(stats) => self.stats = stats,
            Err(error) => {
                self.drawing = Drawing::Failed(error.to_string());
                return;
            }
        }
        let bodies: Vec<BodyId> = scene.bodies.iter().map(|body| body.id).collect();
        for gone in self.bodies.iter().filter(|id| !bodies.contains(id)) {
            renderer.forget_body(*gone);
        }
        self.bodies = bodies;
        self.count += 1;
        self.refinement.drew(!changed);
        if is_sample {
            return;
        }
        meters.frame_meter.drawn();
        let draw = Span::since(begin);
        meters.frames.drew(draw.end - draw.begin);
        let upload = if self.swap.is_uploading() { None } else { self.upload.take() };
        let (upload, before) = upload.unzip();
        let uploaded_bytes = before.map_or(0, |before| renderer.uploaded_bytes() - before);
        meters.edit_clock.drawn(&key.surface, revision, &timeline::Drawing { upload, uploaded_bytes, draw });
        self.drawn = Some(key);
    }
}

/// A renderer with eframe's device. A [`Renderer`] among egui's callback resources lends its pipelines.
fn renderer_on(state: &RenderState) -> Result<Renderer, RenderError> {
    let first = state.renderer.read().callback_resources.get::<Renderer>().map(Renderer::sibling);
    first.map_or_else(|| Renderer::new(&state.device, &state.queue), Ok)
}

/// The quality that an adapter can bear: low on a software adapter.
pub(super) fn quality_for(render_state: Option<&RenderState>) -> Quality {
    render_state.map_or(Quality::Low, |state| match state.adapter.get_info().device_type {
        wgpu::DeviceType::Cpu => Quality::Low,
        wgpu::DeviceType::DiscreteGpu => Quality::High,
        _ => Quality::Medium,
    })
}

/// Everything that a picture depends on: equal keys give equal pictures.
struct PictureKey {
    surface: Arc<Surface>,
    planet: Arc<Planet>,
    view: View,
    frozen: Option<View>,
    time_secs: f64,
    post: Post,
    auto_exposure: bool,
    debug_view: DebugView,
    /// The population whose density is shown, if one is.
    population: usize,
    marked: Option<Arc<MarkedCells>>,
    sky: Option<Sky>,
    drafts: bool,
}

impl PictureKey {
    fn of(subject: &Subject<'_>) -> Self {
        let shows_density = subject.settings.debug_view == DebugView::Density;
        Self {
            surface: subject.surface.clone(),
            planet: subject.revision.planet().clone(),
            view: subject.view,
            frozen: subject.frozen,
            time_secs: subject.settings.time_secs,
            post: subject.settings.post,
            auto_exposure: subject.settings.auto_exposure,
            debug_view: subject.settings.debug_view,
            population: if shows_density { subject.settings.population } else { 0 },
            marked: subject.marked.clone(),
            sky: subject.sky.clone(),
            drafts: subject.drafts,
        }
    }

    fn same(&self, other: &PictureKey) -> bool {
        same_ground(&self.surface, &other.surface)
            && Arc::ptr_eq(&self.planet, &other.planet)
            && self.view == other.view
            && self.frozen == other.frozen
            && self.time_secs == other.time_secs
            && self.post == other.post
            && self.auto_exposure == other.auto_exposure
            && self.debug_view == other.debug_view
            && self.population == other.population
            && self.marked == other.marked
            && self.same_sky(other)
            // What was drawn with drafts is drawn again without.
            && (!self.drafts || other.drafts)
    }

    fn same_sky(&self, other: &PictureKey) -> bool {
        match (&self.sky, &other.sky) {
            (Some(own), Some(other)) => own.same(other),
            (own, other) => own.is_none() && other.is_none(),
        }
    }

    /// Whether another picture is of the same planet, drawn in the same way: it differs by the camera, the time or the
    /// tiles alone.
    fn only_moved(&self, other: &PictureKey) -> bool {
        let of_planet = self.debug_view == DebugView::Shaded && Arc::ptr_eq(&self.planet, &other.planet);
        of_planet
            && self.debug_view == other.debug_view
            && (self.view.size_px, self.view.quality) == (other.view.size_px, other.view.quality)
            && self.post == other.post
            && self.marked == other.marked
            && (!self.drafts || other.drafts)
    }
}

/// Whether two surfaces have the same tiles, with the same detail textures, horizons, parent edges and ranges, and the
/// same objects.
fn same_ground(a: &Arc<Surface>, b: &Arc<Surface>) -> bool {
    let serials = |leaf: &Leaf| {
        let (detail, horizon) = (leaf.detail.as_ref(), leaf.horizon.as_ref());
        (leaf.tile.serial, detail.map(|detail| detail.serial), horizon.map(|horizon| horizon.serial))
    };
    let edges = |leaf: &Leaf| (leaf.coarser_edges, leaf.finer_edges);
    let same = |(a, b): (&Leaf, &Leaf)| serials(a) == serials(b) && edges(a) == edges(b);
    let all = || a.leaves.len() == b.leaves.len() && a.leaves.iter().zip(&b.leaves).all(same);
    let same_objects = || a.scenery.is_same(&b.scenery);
    Arc::ptr_eq(a, b) || (a.complete == b.complete && a.ranges == b.ranges && all() && same_objects())
}
