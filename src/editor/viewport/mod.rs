//! The viewport: asks for a surface, shows its picture, moves the camera.
//!
//! - [`camera`]: the cameras; pure mathematics
//! - [`settings`]: debug view, quality, exposure, time
//! - [`input`]: pointer and keys
//! - [`ground`]: the ground as the camera knows it; `eye`: where the eye is, and what it looks at
//! - `picture`: the drawing; [`target`]: its texture; [`swap`]: the surface on screen, and the next one during its
//!   upload
//! - [`compare`]: another planet beside the one that is edited
//! - [`layer_view`]: layers alone, and an overlay of what one does
//! - `neighbours`: the other bodies of a system around the planet; [`voyage`], [`travel`]: flights from body to body;
//!   `landing`: from orbit down to the ground
//! - [`panes`]: more views beside the first, and maps of the globe
//! - `outline`: the frustum of a frozen view
//! - [`mod@pointer`]: the ground under the pointer; [`inspector`]: the inspected place; [`clicks`]: clicks for the open
//!   tab; `plate_drag`: a plate that is dragged
//! - [`sculpt`]: strokes, stamps and lines; `ring`, `handles`: what is drawn of them; `measure`: lengths, profiles
//! - [`adaptation`]: exposure that adapts gradually; [`refinement`]: still pictures that get finer
//! - [`clock`], [`timeline`], [`frames`]: the time from an edit to its picture, its parts, the time of each frame

pub mod adaptation;
pub mod camera;
pub mod clicks;
pub mod clock;
pub mod compare;
mod eye;
pub mod frames;
pub mod ground;
mod handles;
pub mod input;
pub mod inspector;
mod landing;
pub mod layer_view;
mod measure;
mod neighbours;
mod outline;
pub mod panes;
mod picture;
mod plate_drag;
pub mod pointer;
pub mod refinement;
mod ring;
pub mod sculpt;
pub mod settings;
pub mod swap;
pub mod target;
pub mod timeline;
pub mod travel;
pub mod voyage;

pub use clicks::{Click, ReadyDrag, TabLink};
pub use settings::ViewSettings;

use crate::lod::opening::opening_place;
use crate::lod::{Camera, View};
use crate::planet::Planet;
use crate::render::{FrameStats, LutRuns, Renderer};
use crate::terrain::{MapStore, Revision};
use crate::tiles::{Builder, BuilderOptions, Memory, Surface};
use camera::{Cameras, Ground};
use clicks::Clicks;
use clock::{EditClock, FrameMeter, revision_over};
use compare::{Compare, Shared};
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use frames::FrameLog;
use ground::PlanetGround;
use inspector::Inspector;
use layer_view::LayerView;
use neighbours::{Neighbours, Sky};
use panes::{PaneSubject, Panes, Place};
use picture::{Meters, Picture, Subject, quality_for};
use pointer::{Aim, KnownPlace, Probe, in_view};
use sculpt::{Hand, Scene};
use std::sync::Arc;
use travel::Travel;

/// Longest step of the planet's time in a frame, in seconds of the clock: a slow frame must not make it jump.
const MAX_FRAME_SECS: f32 = 0.1;

/// The viewport and its state.
pub struct Viewport {
    /// Debug view, quality, exposure, time.
    pub settings: ViewSettings,
    /// Time from an edit to its picture.
    pub edit_clock: EditClock,
    /// Time from frame to frame.
    pub frame_meter: FrameMeter,
    /// How long each frame took.
    pub frames: FrameLog,
    /// What the open tab shows on the planet, and which clicks and drags it takes.
    pub tab: TabLink,
    /// The inspected place.
    pub inspector: Inspector,
    layer_view: LayerView,
    /// The planet that this one is compared with.
    compare: Option<Compare>,
    maps: Option<Arc<MapStore>>,
    /// The other bodies of the system that the planet is in.
    neighbours: Option<Neighbours>,
    /// The flight to another of them.
    travel: Option<Travel>,
    /// Whether a flight down to the ground is asked for.
    is_landing: bool,
    builder: Builder,
    /// The newest valid planet.
    newest: Option<Revision>,
    picture: Picture,
    cameras: Cameras,
    /// Radius of the reference sphere over which the cameras are placed.
    ground_radius_m: f64,
    /// The view whose tiles are kept.
    frozen: Option<View>,
    /// Where the picture is in the window, and its camera.
    rect: egui::Rect,
    shown_camera: Option<Camera>,
    wants_focus: bool,
    moving: bool,
    ctx: egui::Context,
    drag: input::Drag,
    pointer: Probe,
    clicks: Clicks,
    hand: Hand,
    panes: Panes,
}

impl Viewport {
    /// A viewport that draws with eframe's device, or shows why it cannot.
    /// `maps`: where solved world maps are kept.
    pub fn new(
        ctx: &egui::Context,
        render_state: Option<&RenderState>,
        planet: &Planet,
        maps: Option<Arc<MapStore>>,
    ) -> Self {
        let waker = || {
            let ctx = ctx.clone();
            move || ctx.request_repaint()
        };
        Self {
            settings: ViewSettings::new(quality_for(render_state)),
            edit_clock: EditClock::default(),
            frame_meter: FrameMeter::default(),
            frames: FrameLog::default(),
            tab: TabLink::default(),
            inspector: Inspector::new(waker()),
            layer_view: LayerView::default(),
            compare: None,
            builder: Builder::with_options(BuilderOptions::default().maps(maps.clone()), waker()),
            maps,
            neighbours: None,
            travel: None,
            is_landing: false,
            newest: None,
            picture: Picture::new(render_state),
            cameras: Cameras::new(planet.radius_m(), opening_place(planet)),
            ground_radius_m: planet.radius_m(),
            frozen: None,
            rect: egui::Rect::NOTHING,
            shown_camera: None,
            wants_focus: false,
            moving: false,
            ctx: ctx.clone(),
            drag: input::Drag::None,
            pointer: Probe::new(waker()),
            clicks: Clicks::new(waker()),
            hand: Hand::default(),
            panes: Panes::default(),
        }
    }

    /// Looks at the whole planet, as when it was opened.
    pub fn reset_view(&mut self, planet: &Planet) {
        self.is_landing = false;
        let dive = self.cameras.dives();
        let lit = self.neighbours.as_ref().and_then(|neighbours| neighbours.lit_planet(self.settings.time_secs));
        self.cameras = Cameras::new(self.ground_radius_m, opening_place(lit.as_ref().unwrap_or(planet)));
        self.cameras.set_dive(dive);
        self.reset_panes();
    }

    /// The window's context.
    pub fn ctx(&self) -> &egui::Context {
        &self.ctx
    }

    /// A renderer on the same device, for pictures that are not on screen; none without a device.
    pub fn second_renderer(&self) -> Option<Renderer> {
        self.picture.second_renderer()
    }

    /// The surface on screen, and the planet that gives it sea, air, clouds and light.
    pub fn shown(&self) -> Option<(Arc<Surface>, Revision)> {
        self.surface().map(|surface| (surface.clone(), revision_over(self.newest.as_ref(), &surface)))
    }

    /// The surface on screen.
    pub fn surface(&self) -> Option<Arc<Surface>> {
        self.picture.surface().cloned()
    }

    /// Whether the hand of the sculptor is at work.
    pub fn is_drawing(&self) -> bool {
        self.hand.is_drawing()
    }

    /// Whether a finer surface is being built or uploaded.
    pub fn is_busy(&self) -> bool {
        self.builder.is_busy() || self.picture.is_behind(self.own_surface().as_ref()) || self.panes_are_behind()
    }

    /// The newest surface of the view with the tools.
    fn own_surface(&self) -> Option<Arc<Surface>> {
        self.builder.surface_of(self.panes.active)
    }

    /// The time for which an edit has waited for its picture.
    pub fn waiting(&self) -> Option<std::time::Duration> {
        self.edit_clock.waiting()
    }

    /// Where solved world maps are kept.
    pub fn map_store(&self) -> Option<Arc<MapStore>> {
        self.maps.clone()
    }

    /// The memory that the cache of tiles and fields takes.
    pub fn memory(&self) -> Memory {
        self.builder.memory()
    }

    /// How often each look-up texture has been made since the start.
    pub fn lut_runs(&self) -> Option<LutRuns> {
        self.picture.lut_runs()
    }

    /// Layers alone, and the overlay of what one does.
    pub fn layer_view(&self) -> &LayerView {
        &self.layer_view
    }

    /// The ground under the pointer, if the pointer is over the globe.
    pub fn under_pointer(&self) -> Option<&KnownPlace> {
        self.pointer.answer()
    }

    /// The newest click for the open tab and the ground there, once, when the ground is known.
    pub fn take_click(&mut self) -> Option<(Click, KnownPlace)> {
        self.clicks.take()
    }

    /// Index of the ground edit that was made or moved on the planet since the last call.
    pub fn take_touched_edit(&mut self) -> Option<usize> {
        self.hand.take_touched()
    }

    /// Figures of the newest picture.
    pub fn stats(&self) -> FrameStats {
        self.picture.stats()
    }

    /// Samples that a still picture has, and those of a finished one; none where pictures are not refined.
    pub fn refinement(&self) -> Option<(u32, u32)> {
        self.settings.refine.then(|| self.picture.refinement.progress())
    }

    /// Lets refinement wait as if the user had touched something: other pictures need the device.
    pub fn postpone_refinement(&mut self, now_secs: f64) {
        self.picture.refinement.touched(now_secs);
        self.panes.touched(now_secs);
    }

    /// How many pictures have been drawn since the start.
    pub fn pictures(&self) -> u64 {
        self.picture.count()
    }

    /// Where the picture is in the window.
    pub fn rect(&self) -> egui::Rect {
        self.rect
    }

    /// The cameras.
    pub fn cameras(&self) -> &Cameras {
        &self.cameras
    }

    /// Whether the camera goes on moving without input.
    pub fn is_moving(&self) -> bool {
        self.moving
    }

    /// Changes the cameras.
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

    /// Gives the keyboard focus to the picture.
    pub fn take_focus(&mut self) {
        self.wants_focus = true;
    }

    /// Why nothing, or only an old picture, is drawn.
    pub fn error(&self) -> Option<String> {
        self.picture.error().map(str::to_owned).or_else(|| self.builder.error())
    }

    /// Shows the picture in all of the room there is. `valid` is the planet that is drawn. A drag of the sun, of a
    /// plate or of a tool changes `draft`, and gives the name of that edit.
    pub fn show(&mut self, ui: &mut egui::Ui, valid: &Arc<Planet>, draft: &mut Planet) -> Option<&'static str> {
        let Place { rect, response } = self.place_panes(ui);
        if std::mem::take(&mut self.wants_focus) {
            response.request_focus();
        }
        if rect.width() < 1.0 || rect.height() < 1.0 {
            return None;
        }

        let seen = self.layer_view.seen(valid, &self.tab.solo, self.tab.overlay.is_some());
        let valid = &seen;
        let own_id = self.own_id();
        self.picture.advance(own_id, self.own_surface().as_ref(), &mut self.frames, ui.ctx());
        self.advance_travel(ui, &response);
        self.advance_landing(valid);
        let surface = self.surface();
        let terrain = surface.as_deref().map(|surface| &*surface.terrain);
        let ground = PlanetGround::new(valid, terrain);
        self.follow_ground(&ground);
        let link = self.tab.sculpt.clone();
        let scene = surface.as_ref().map(|surface| Scene { surface, camera: self.cameras.camera(&ground), rect });
        let held = scene.map(|scene| self.hand.handle(ui, &response, &link, &scene, draft)).unwrap_or_default();
        let edited = input::Edited {
            planet: draft,
            held: held.taken,
            time_secs: self.settings.time_secs,
            turns_sun: self.neighbours.is_none(),
            plates: terrain.filter(|_| self.tab.plates),
        };
        let moved = match self.travel {
            // Any input ends the flight instead.
            Some(_) => input::Moved { animating: true, edit: None },
            None => input::handle(ui, &response, &mut self.drag, &mut self.cameras, &ground, edited),
        };
        self.moving = moved.animating;
        self.advance_time(ui);

        let (now_secs, pressed) = ui.input(|i| (i.time, i.pointer.any_down()));
        let touched = pressed || ui.input(|i| !i.events.is_empty());
        if touched {
            self.picture.refinement.touched(now_secs);
            self.panes.touched(now_secs);
        }
        let view = self.view(ui.ctx(), rect, &ground);
        (self.rect, self.shown_camera) = (rect, Some(view.camera));
        self.frozen = self.settings.freeze_detail.then(|| self.frozen.unwrap_or(view));
        // The camera stands over the surface on screen. A planet of another radius is asked for at the same distance
        // in radii.
        let mut wanted = self.frozen.unwrap_or(view);
        wanted.camera.position_planet_m *= valid.radius_m() / self.ground_radius_m;
        let views = self.pane_views(valid, wanted, &ground);
        if self.newest.as_ref().is_none_or(|newest| !Arc::ptr_eq(newest.planet(), valid)) {
            Renderer::draw_patterns_ahead(valid);
        }
        match Revision::try_after(valid.clone(), self.newest.as_ref()) {
            Ok(newest) => self.newest = Some(newest),
            Err(error) => log::error!("{error}"),
        }
        if let Some(newest) = &self.newest {
            self.builder.request_views(newest, &views);
        }
        self.look_under_pointer((ui, &response), &view, surface.as_ref());
        self.clicks.look((ui, &response), &self.tab, &view, surface.as_ref());
        let sky = surface.as_ref().and_then(|_| self.sky(&view));
        if let Some(surface) = surface.clone() {
            self.draw(surface, view, sky.clone(), pressed, now_secs);
        }
        if let Some(wait) = self.picture.refines_after(&self.settings, now_secs).filter(|_| !self.is_busy()) {
            ui.ctx().request_repaint_after(wait);
        }
        if let Some(texture) = self.picture.texture() {
            let uv = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
            ui.painter().image(texture, rect, uv, egui::Color32::WHITE);
        }
        if let Some(surface) = &surface {
            self.layer_view.paint(ui, rect, self.tab.overlay, (&view, surface));
        }
        if let Some(surface) = &surface {
            let scene = Scene { surface, camera: view.camera, rect };
            self.hand.paint(&ui.painter_at(rect), &link, &scene, &view, valid);
            let ground = ring::Ground { terrain: &surface.terrain, view: &view, rect };
            self.inspector.paint(&ui.painter_at(rect), &ground);
        }
        if let Some(compare) = &mut self.compare {
            let (settings, radius_m) = (&self.settings, self.ground_radius_m);
            let shared = Shared { settings, view, radius_m, drafts: pressed, touched, now_secs };
            compare.show(ui, rect, &shared);
        }
        if let Some(frozen) = &self.frozen {
            outline::paint(&ui.painter_at(rect), rect, frozen, &view, self.ground_radius_m);
        }
        let subject = PaneSubject {
            has_structure: valid.structure.is_some(),
            settings: self.settings,
            newest: self.newest.clone(),
            own_id,
            sky,
            selected: link.selected.and_then(|index| valid.edits.get(index)),
            drafts: pressed,
            is_busy: self.is_busy(),
            now_secs,
        };
        self.show_panes(ui, rect, &subject);
        held.edit.or(moved.edit)
    }

    /// Keeps the cameras above the ground, and at the same distance in radii when the planet's radius has changed.
    fn follow_ground(&mut self, ground: &PlanetGround<'_>) {
        let radius_m = ground.radius_m();
        if radius_m != self.ground_radius_m {
            self.cameras.rescale(self.ground_radius_m, radius_m, ground);
            if let Some(frozen) = &mut self.frozen {
                frozen.camera.position_planet_m *= radius_m / self.ground_radius_m;
            }
            self.ground_radius_m = radius_m;
        }
        self.cameras.keep_above(ground);
    }

    /// Lets the planet's time pass, and asks for the next frame while something moves.
    fn advance_time(&mut self, ui: &egui::Ui) {
        let settings = &mut self.settings;
        if settings.playing {
            settings.time_secs += f64::from(ui.input(|i| i.stable_dt).min(MAX_FRAME_SECS)) * settings.time_speed;
        }
        if self.moving || settings.playing {
            ui.ctx().request_repaint();
        } else if let Some(wait) = self.picture.adapts_after(settings) {
            ui.ctx().request_repaint_after(wait);
        }
    }

    fn view(&self, ctx: &egui::Context, rect: egui::Rect, ground: &PlanetGround<'_>) -> View {
        let pixels_per_point = ctx.pixels_per_point();
        let side_px = |points: f32| (points * pixels_per_point).round().max(1.0) as u32;
        View {
            camera: self.cameras.camera(ground),
            size_px: [side_px(rect.width()), side_px(rect.height())],
            quality: self.settings.quality,
        }
    }

    fn draw(&mut self, surface: Arc<Surface>, view: View, sky: Option<Sky>, drafts: bool, now_secs: f64) {
        // The sea, air and light of one planet over the ground of another would flash until the new tiles are there.
        let revision = revision_over(self.newest.as_ref(), &surface);
        let (settings, marked) = (&self.settings, self.tab.marked.clone());
        let (frozen, is_busy) = (self.frozen, self.is_busy());
        let subject = Subject { surface, revision, view, frozen, settings, marked, sky, drafts, is_busy, now_secs };
        let (frames, frame_meter, edit_clock) = (&mut self.frames, &mut self.frame_meter, &mut self.edit_clock);
        self.picture.draw(&subject, &mut Meters { frames, frame_meter, edit_clock });
    }

    /// Asks for the ground under the pointer, and for the inspected place.
    fn look_under_pointer(
        &mut self,
        (ui, response): (&egui::Ui, &egui::Response),
        view: &View,
        surface: Option<&Arc<Surface>>,
    ) {
        let pos = response.hover_pos().or_else(|| clicks::dragged_over(ui, response));
        if let (Some(pos), Some(surface)) = (pos, surface) {
            let (x, y) = in_view(response.rect, pos);
            let time_secs = self.settings.time_secs;
            let clouds_at_secs = self.inspector.is_open.then_some(time_secs);
            self.pointer.ask(Aim::Picture { x, y, view: *view }, surface, clouds_at_secs);
        } else {
            self.pointer.leave();
        }
        self.inspector.update(self.pointer.answer(), surface, self.settings.time_secs);
    }
}
