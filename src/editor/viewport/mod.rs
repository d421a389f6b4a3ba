//! The picture of the planet: asks for a surface, draws it into a texture when something changed, moves the camera.
//!
//! - [`camera`]: where one looks from; pure mathematics
//! - [`input`]: what the pointer and the keys do
//! - [`ground`]: the ground as the camera knows it
//! - [`target`]: the offscreen texture and its colour encoding
//! - `outline`: what a frozen view sees, drawn into another
//! - [`mod@pointer`]: what lies under the pointer
//! - [`swap`]: the surface on screen, and the next one while it is uploaded
//! - [`adaptation`]: exposure that follows what there is to see
//! - [`clock`], [`timeline`], [`frames`]: the time from an edit to its picture, where it went, the time of each frame

pub mod adaptation;
pub mod camera;
pub mod clock;
pub mod frames;
pub mod ground;
pub mod input;
mod outline;
pub mod pointer;
pub mod swap;
pub mod target;
pub mod timeline;

use super::painter::is_chord;
use crate::lod::opening::opening_place;
use crate::lod::{Quality, View};
use crate::planet::Planet;
use crate::render::{DebugView, Frame, FrameStats, MarkedCells, Renderer, TableRuns, Tone};
use crate::sphere::LatLon;
use crate::tiles::{Builder, Leaf, Memory, Surface};
use adaptation::Adaptation;
use camera::pose::Pose;
use camera::{Cameras, Ground};
use clock::{EditClock, FrameMeter, same_tiles};
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use frames::FrameLog;
use glam::DVec3;
use ground::PlanetGround;
use pointer::{Probe, UnderPointer};
use std::sync::Arc;
use std::time::Instant;
use swap::{Swap, UPLOAD_BUDGET_BYTES};
use target::Target;
use timeline::Span;

/// What is looked at and how; no part of the document.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// Shaded, or a debug view.
    pub debug_view: DebugView,
    /// How well things are drawn.
    pub quality: Quality,
    /// Whether the tiles stay those of the view in which they were frozen.
    pub freeze_detail: bool,
    /// Exposure in stops.
    pub exposure_ev: f64,
    /// Whether the exposure is a correction to what suits the picture.
    pub auto_exposure: bool,
    /// The curve from radiance to the picture.
    pub tone: Tone,
    /// Seconds since time zero.
    pub time_secs: f64,
    /// Whether time goes on.
    pub playing: bool,
    /// Seconds of the planet for each second of the clock.
    pub time_speed: f64,
}

/// Everything a picture depends on: an equal key is an equal picture.
struct PictureKey {
    surface: Arc<Surface>,
    planet: Arc<Planet>,
    view: View,
    frozen: Option<View>,
    time_secs: f64,
    exposure_ev: f64,
    auto_exposure: bool,
    tone: Tone,
    debug_view: DebugView,
    marked: Option<Arc<MarkedCells>>,
}

impl PictureKey {
    fn same(&self, other: &PictureKey) -> bool {
        same_leaves(&self.surface, &other.surface)
            && Arc::ptr_eq(&self.planet, &other.planet)
            && self.view == other.view
            && self.frozen == other.frozen
            && self.time_secs == other.time_secs
            && self.exposure_ev == other.exposure_ev
            && self.auto_exposure == other.auto_exposure
            && self.tone == other.tone
            && self.debug_view == other.debug_view
            && self.marked == other.marked
    }
}

/// Whether two surfaces are made of the same tiles and stand for as much.
fn same_leaves(a: &Arc<Surface>, b: &Arc<Surface>) -> bool {
    let serials = |leaf: &Leaf| {
        let (detail, horizon) = (leaf.detail.as_ref(), leaf.horizon.as_ref());
        (leaf.tile.serial, detail.map(|detail| detail.serial), horizon.map(|horizon| horizon.serial))
    };
    let same = |(a, b): (&Leaf, &Leaf)| serials(a) == serials(b) && a.coarser_edges == b.coarser_edges;
    let all = || a.leaves.len() == b.leaves.len() && a.leaves.iter().zip(&b.leaves).all(same);
    Arc::ptr_eq(a, b) || (a.complete == b.complete && a.ranges == b.ranges && all())
}

/// What can be drawn with, or why nothing can.
enum Drawing {
    Ready(Box<Renderer>, RenderState),
    Failed(String),
}

/// What a click on the planet is for, beside turning it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Click {
    /// Choose the biome that lies there.
    Pick,
    /// Paint the cell of the biome table that the place falls into.
    Paint,
}

/// What the painter of the biome table has to do with the picture.
#[derive(Clone, Debug, Default)]
pub struct PainterLink {
    /// Cells whose places light up.
    pub marked: Option<Arc<MarkedCells>>,
    /// Whether a click with Ctrl paints.
    pub paints: bool,
    /// Whether a plain click picks.
    pub picks: bool,
}

/// The viewport and all of its live state.
pub struct Viewport {
    /// What is looked at and how.
    pub settings: ViewSettings,
    /// Time from an edit to its picture.
    pub edit_clock: EditClock,
    /// Time from frame to frame.
    pub frame_meter: FrameMeter,
    /// How long each frame took.
    pub frames: FrameLog,
    builder: Builder,
    swap: Swap,
    /// The upload under way or just done: when, and how many bytes were uploaded before it.
    upload: Option<(Span, u64)>,
    drawing: Drawing,
    target: Option<Target>,
    drawn: Option<PictureKey>,
    adaptation: Adaptation,
    stats: FrameStats,
    cameras: Cameras,
    ground_radius_m: f64,
    /// The view whose tiles are kept.
    frozen: Option<View>,
    wants_focus: bool,
    moving: bool,
    drag: input::Drag,
    pointer: Probe,
    /// What the painter of the biome table has to do with the picture.
    pub painter: PainterLink,
    /// Clicks that are for the painter: asked about apart from where the pointer is now.
    clicks: Probe,
    clicked: Option<Click>,
    pictures: u64,
}

impl Viewport {
    /// A viewport that draws with eframe's device, or shows why it cannot.
    pub fn new(ctx: &egui::Context, render_state: Option<&RenderState>, planet: &Planet) -> Self {
        let drawing = match render_state {
            Some(state) => match Renderer::new(&state.device, &state.queue, target::FORMAT) {
                Ok(renderer) => Drawing::Ready(Box::new(renderer), state.clone()),
                Err(error) => Drawing::Failed(error.to_string()),
            },
            None => Drawing::Failed("There is no graphics device to draw with.".to_owned()),
        };
        let quality = render_state.map_or(Quality::Low, |state| match state.adapter.get_info().device_type {
            wgpu::DeviceType::Cpu => Quality::Low,
            wgpu::DeviceType::DiscreteGpu => Quality::High,
            _ => Quality::Medium,
        });
        // On a software adapter the pictures in between would cost more than they please.
        let by_eye = render_state.is_some_and(|state| state.adapter.get_info().device_type != wgpu::DeviceType::Cpu);
        let (ctx, pointer_ctx, click_ctx) = (ctx.clone(), ctx.clone(), ctx.clone());
        Self {
            settings: ViewSettings {
                debug_view: DebugView::default(),
                quality,
                freeze_detail: false,
                exposure_ev: 0.0,
                auto_exposure: true,
                tone: Tone::default(),
                time_secs: 0.0,
                playing: false,
                time_speed: 600.0,
            },
            edit_clock: EditClock::default(),
            frame_meter: FrameMeter::default(),
            frames: FrameLog::default(),
            builder: Builder::new(move || ctx.request_repaint()),
            swap: Swap::default(),
            upload: None,
            drawing,
            target: None,
            drawn: None,
            adaptation: Adaptation::new(by_eye),
            stats: FrameStats::default(),
            cameras: Cameras::new(planet.radius_m(), opening_place(planet)),
            ground_radius_m: planet.radius_m(),
            frozen: None,
            wants_focus: false,
            moving: false,
            drag: input::Drag::None,
            pointer: Probe::new(move || pointer_ctx.request_repaint()),
            painter: PainterLink::default(),
            clicks: Probe::new(move || click_ctx.request_repaint()),
            clicked: None,
            pictures: 0,
        }
    }

    /// Looks at the whole planet again.
    pub fn reset_view(&mut self, planet: &Planet) {
        let dive = self.cameras.dives();
        self.cameras = Cameras::new(self.ground_radius_m, opening_place(planet));
        self.cameras.set_dive(dive);
    }

    /// The surface on screen.
    pub fn surface(&self) -> Option<Arc<Surface>> {
        self.swap.shown().cloned()
    }

    /// Whether a finer surface is being built, or on its way to the screen.
    pub fn is_busy(&self) -> bool {
        self.builder.is_busy() || self.swap.is_under_way(self.builder.surface().as_ref())
    }

    /// What is kept of tiles and their noise.
    pub fn memory(&self) -> Memory {
        self.builder.memory()
    }

    /// How often each table has been made since the start.
    pub fn table_runs(&self) -> Option<TableRuns> {
        match &self.drawing {
            Drawing::Ready(renderer, _) => Some(renderer.table_runs()),
            Drawing::Failed(_) => None,
        }
    }

    /// What lies under the pointer, if it is over the globe.
    pub fn under_pointer(&self) -> Option<&UnderPointer> {
        self.pointer.answer()
    }

    /// What was clicked on for the painter, once, when it is known.
    pub fn take_click(&mut self) -> Option<(Click, UnderPointer)> {
        let click = self.clicked?;
        let answer = self.clicks.take()?;
        self.clicked = None;
        answer.map(|under| (click, under))
    }

    /// What the newest picture took.
    pub fn stats(&self) -> FrameStats {
        self.stats
    }

    /// How many pictures have been drawn since the start.
    pub fn pictures(&self) -> u64 {
        self.pictures
    }

    /// Height of the eye above the ground or the sea, and the place under it.
    pub fn eye(&self, planet: &Planet) -> (f64, LatLon) {
        self.with_ground(planet, |cameras, ground| {
            let pose = cameras.pose(ground);
            let altitude_m = pose.position_planet_m.length() - ground.surface_radius_m(pose.up());
            (altitude_m, LatLon::from_direction(pose.up()))
        })
    }

    /// Where one looks from.
    pub fn pose(&self, planet: &Planet) -> Pose {
        self.with_ground(planet, |cameras, ground| cameras.pose(ground))
    }

    /// Distance from the planet's centre to the ground or the sea, whichever is higher.
    pub fn surface_radius_m(&self, planet: &Planet, dir_planet: DVec3) -> f64 {
        self.with_ground(planet, |_, ground| ground.surface_radius_m(dir_planet))
    }

    /// The cameras: how one moves.
    pub fn cameras(&self) -> &Cameras {
        &self.cameras
    }

    /// Whether the camera goes on moving by itself.
    pub fn is_moving(&self) -> bool {
        self.moving
    }

    /// Changes how or where one moves.
    pub fn move_cameras(&mut self, planet: &Planet, change: impl FnOnce(&mut Cameras, &dyn Ground)) {
        let mut cameras = self.cameras.clone();
        self.with_ground(planet, |_, ground| change(&mut cameras, ground));
        self.cameras = cameras;
        self.moving = true;
    }

    fn with_ground<R>(&self, planet: &Planet, ask: impl FnOnce(&Cameras, &dyn Ground) -> R) -> R {
        let surface = self.surface();
        ask(&self.cameras, &PlanetGround::new(planet, surface.as_deref().map(|surface| &*surface.terrain)))
    }

    /// Gives the keys to the picture.
    pub fn take_focus(&mut self) {
        self.wants_focus = true;
    }

    /// Why nothing or something old is drawn.
    pub fn error(&self) -> Option<String> {
        let drawing = match &self.drawing {
            Drawing::Ready(renderer, _) => renderer.shader_error(),
            Drawing::Failed(error) => Some(error.as_str()),
        };
        drawing.map(str::to_owned).or_else(|| self.builder.error())
    }

    /// Shows the picture in all of the room there is. `valid` is what is drawn; a drag of the sun changes `draft`, and
    /// gives the label of that edit.
    pub fn show(&mut self, ui: &mut egui::Ui, valid: &Arc<Planet>, draft: &mut Planet) -> Option<&'static str> {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), egui::Sense::click_and_drag());
        if std::mem::take(&mut self.wants_focus) {
            response.request_focus();
        }
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "View of the planet"));
        ui.painter().rect_filled(rect, 0.0, egui::Color32::BLACK);
        if rect.width() < 1.0 || rect.height() < 1.0 {
            return None;
        }

        self.advance(ui.ctx());
        let surface = self.surface();
        let terrain = surface.as_deref().map(|surface| &*surface.terrain);
        let ground = PlanetGround::new(valid, terrain);
        if ground.radius_m() != self.ground_radius_m {
            self.cameras.rescale(self.ground_radius_m, ground.radius_m(), &ground);
            if let Some(frozen) = &mut self.frozen {
                frozen.camera.position_planet_m *= ground.radius_m() / self.ground_radius_m;
            }
            self.ground_radius_m = ground.radius_m();
        }
        self.cameras.keep_above(&ground);
        let moved =
            input::handle(ui, &response, &mut self.drag, &mut self.cameras, &ground, (draft, self.settings.time_secs));

        let settings = &mut self.settings;
        if settings.playing {
            settings.time_secs += f64::from(ui.input(|i| i.stable_dt).min(0.1)) * settings.time_speed;
        }
        self.moving = moved.animating;
        if moved.animating || settings.playing {
            ui.ctx().request_repaint();
        } else if settings.auto_exposure && self.adaptation.is_under_way() {
            ui.ctx().request_repaint_after(adaptation::PAUSE);
        }

        let pixels_per_point = ui.ctx().pixels_per_point();
        let side_px = |points: f32| (points * pixels_per_point).round().max(1.0) as u32;
        let view = View {
            camera: self.cameras.camera(&ground),
            size_px: [side_px(rect.width()), side_px(rect.height())],
            quality: self.settings.quality,
        };
        // The camera stands over the surface that is shown; a planet of another size is asked for
        // from as far in its radii.
        self.frozen = self.settings.freeze_detail.then(|| self.frozen.unwrap_or(view));
        let mut wanted = self.frozen.unwrap_or(view);
        wanted.camera.position_planet_m *= valid.radius_m() / self.ground_radius_m;
        self.builder.request(valid, &wanted);
        self.look_under_pointer(&response, &view, surface.as_ref());
        self.take_painter_click(ui, &response, &view, surface.as_ref());
        if let Some(surface) = surface {
            // Sea, air and light of one planet over the ground of another would flash until the new tiles are there.
            let shown = surface.terrain.planet().clone();
            let planet = if Arc::ptr_eq(&shown, valid) || same_tiles(&surface.terrain, valid) { valid } else { &shown };
            self.draw(surface, planet, view);
        }
        if let Some(target) = &self.target {
            let uv = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
            ui.painter().image(target.id(), rect, uv, egui::Color32::WHITE);
        }
        if let Some(frozen) = &self.frozen {
            outline::paint(&ui.painter_at(rect), rect, frozen, &view, self.ground_radius_m);
        }
        moved.sun.then_some(input::SUN_STEP)
    }

    /// Brings the newest surface nearer to the screen: uploads a frame's worth of it, and swaps
    /// it in when that was all.
    fn advance(&mut self, ctx: &egui::Context) {
        let newest = self.builder.surface();
        let (drawing, frames, span) = (&mut self.drawing, &mut self.frames, &mut self.upload);
        self.swap.advance(newest.clone(), |surface| {
            let Drawing::Ready(renderer, state) = drawing else { return true };
            let (begin, before) = (Instant::now(), renderer.uploaded_bytes());
            let done = renderer.upload(&state.device, &state.queue, surface, UPLOAD_BUDGET_BYTES);
            let now = Span::since(begin);
            frames.uploaded(now.end - now.begin);
            let (first, before) = span.map_or((now, before), |(span, before)| (span, before));
            *span = Some((Span { end: now.end, ..first }, before));
            done
        });
        if self.swap.is_under_way(newest.as_ref()) {
            ctx.request_repaint();
        }
    }

    /// Draws, unless the picture of just that is there already.
    fn draw(&mut self, surface: Arc<Surface>, planet: &Arc<Planet>, view: View) {
        let Drawing::Ready(renderer, state) = &mut self.drawing else { return };
        let key = PictureKey {
            surface,
            planet: planet.clone(),
            view,
            frozen: self.frozen,
            time_secs: self.settings.time_secs,
            exposure_ev: self.settings.exposure_ev,
            auto_exposure: self.settings.auto_exposure,
            tone: self.settings.tone,
            debug_view: self.settings.debug_view,
            marked: self.painter.marked.clone(),
        };
        let target = self.target.get_or_insert_with(|| Target::new(state, view.size_px));
        let resized = target.resize(view.size_px);
        let changed = resized || !self.drawn.as_ref().is_some_and(|drawn| drawn.same(&key));
        let adapting = self.settings.auto_exposure && self.adaptation.is_under_way();
        if !changed && !adapting {
            if !self.swap.is_uploading() {
                self.upload = None;
            }
            return;
        }
        renderer.marked = key.marked.clone();
        renderer.metering = self.adaptation.metering(self.settings.auto_exposure, changed);
        renderer.tone = key.tone;
        let begin = Instant::now();
        let drawn = renderer.render(
            &state.device,
            &state.queue,
            target.view(),
            &Frame {
                surface: &key.surface,
                planet,
                view,
                frozen: key.frozen,
                sun_dir_planet: planet.star.place(key.time_secs).direction(),
                time_secs: key.time_secs,
                exposure_ev: key.exposure_ev,
                debug_view: key.debug_view,
            },
        );
        match drawn {
            Ok(stats) => self.stats = stats,
            Err(error) => {
                self.drawing = Drawing::Failed(error.to_string());
                return;
            }
        }
        self.pictures += 1;
        self.frame_meter.drawn();
        let draw = Span::since(begin);
        self.frames.drew(draw.end - draw.begin);
        let upload = if self.swap.is_uploading() { None } else { self.upload.take() };
        let (upload, before) = upload.unzip();
        let uploaded_bytes = before.map_or(0, |before| renderer.uploaded_bytes() - before);
        self.edit_clock.drawn(&key.surface, planet, &timeline::Drawing { upload, uploaded_bytes, draw });
        self.drawn = Some(key);
    }

    /// Asks what lies where one clicked for the painter.
    fn take_painter_click(
        &mut self,
        ui: &egui::Ui,
        response: &egui::Response,
        view: &View,
        surface: Option<&Arc<Surface>>,
    ) {
        let chord = ui.input(|i| is_chord(i.modifiers));
        let purpose = match (chord, &self.painter) {
            (true, PainterLink { paints: true, .. }) => Click::Paint,
            (false, PainterLink { picks: true, .. }) => Click::Pick,
            _ => return,
        };
        if response.hovered() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair);
        }
        if response.clicked()
            && let (Some(pos), Some(surface)) = (response.interact_pointer_pos(), surface)
        {
            let (x, y) = in_view(response.rect, pos);
            self.clicks.leave();
            self.clicks.ask(x, y, view, surface);
            self.clicked = Some(purpose);
        }
    }

    /// Asks what lies under the pointer.
    fn look_under_pointer(&mut self, response: &egui::Response, view: &View, surface: Option<&Arc<Surface>>) {
        if let (Some(pos), Some(surface)) = (response.hover_pos(), surface) {
            let (x, y) = in_view(response.rect, pos);
            self.pointer.ask(x, y, view, surface);
        } else {
            self.pointer.leave();
        }
    }
}

/// A point of the window in the picture: from -1 to 1, right and up.
fn in_view(rect: egui::Rect, pos: egui::Pos2) -> (f64, f64) {
    let (x, y) = ((pos.x - rect.center().x) / (0.5 * rect.width()), (rect.center().y - pos.y) / (0.5 * rect.height()));
    (f64::from(x), f64::from(y))
}
