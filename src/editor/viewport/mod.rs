//! The picture of the planet: asks for a surface, draws it into a texture when something changed, moves the camera.
//!
//! - [`camera_controller`]: where one looks from; pure mathematics
//! - [`input`]: what the pointer and the keys do
//! - [`ground`]: the ground as the camera knows it
//! - [`target`]: the offscreen texture and its colour encoding
//! - [`adaptation`]: exposure that follows what there is to see
//! - [`clock`]: the time from an edit to its picture

pub mod adaptation;
pub mod camera_controller;
pub mod clock;
pub mod ground;
pub mod input;
pub mod target;

use crate::build::{Builder, Surface};
use crate::lod::opening::opening_place;
use crate::lod::{Quality, View};
use crate::planet::Planet;
use crate::render::{DebugView, Frame, FrameStats, Renderer};
use crate::sphere::LatLon;
use adaptation::Adaptation;
use camera_controller::{CameraController, Ground};
use clock::{EditClock, FrameMeter};
use eframe::egui;
use eframe::egui_wgpu::RenderState;
use ground::PlanetGround;
use std::sync::Arc;
use target::Target;

/// What lies under the pointer.
#[derive(Clone, Debug, PartialEq)]
#[allow(missing_docs)]
pub struct UnderPointer {
    pub place: LatLon,
    pub height_m: f64,
    pub temperature_c: f64,
    pub moisture: f64,
    pub biome: String,
}

/// What is looked at and how; no part of the document.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// Shaded, or a debug view.
    pub debug_view: DebugView,
    /// How well things are drawn.
    pub quality: Quality,
    /// Exposure in stops.
    pub exposure_ev: f64,
    /// Whether the exposure is a correction to what suits the picture.
    pub auto_exposure: bool,
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
    time_secs: f64,
    exposure_ev: f64,
    auto_exposure: bool,
    debug_view: DebugView,
}

impl PictureKey {
    fn same(&self, other: &PictureKey) -> bool {
        Arc::ptr_eq(&self.surface, &other.surface)
            && Arc::ptr_eq(&self.planet, &other.planet)
            && self.view == other.view
            && self.time_secs == other.time_secs
            && self.exposure_ev == other.exposure_ev
            && self.auto_exposure == other.auto_exposure
            && self.debug_view == other.debug_view
    }
}

/// What can be drawn with, or why nothing can.
enum Drawing {
    Ready(Box<Renderer>, RenderState),
    Failed(String),
}

/// The viewport and all of its live state.
pub struct Viewport {
    /// What is looked at and how.
    pub settings: ViewSettings,
    /// Time from an edit to its picture.
    pub edit_clock: EditClock,
    /// Time from frame to frame.
    pub frame_meter: FrameMeter,
    builder: Builder,
    drawing: Drawing,
    target: Option<Target>,
    drawn: Option<PictureKey>,
    adaptation: Adaptation,
    stats: FrameStats,
    controller: CameraController,
    ground_radius_m: f64,
    drag: input::Drag,
    under_pointer: Option<UnderPointer>,
    under_pointer_key: Option<(egui::Pos2, View, Arc<Surface>)>,
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
        let ctx = ctx.clone();
        Self {
            settings: ViewSettings {
                debug_view: DebugView::default(),
                quality,
                exposure_ev: 0.0,
                auto_exposure: true,
                time_secs: 0.0,
                playing: false,
                time_speed: 600.0,
            },
            edit_clock: EditClock::default(),
            frame_meter: FrameMeter::default(),
            builder: Builder::new(move || ctx.request_repaint()),
            drawing,
            target: None,
            drawn: None,
            adaptation: Adaptation::new(by_eye),
            stats: FrameStats::default(),
            controller: CameraController::new(planet.radius_m(), opening_place(planet)),
            ground_radius_m: planet.radius_m(),
            drag: input::Drag::None,
            under_pointer: None,
            under_pointer_key: None,
            pictures: 0,
        }
    }

    /// Looks at the whole planet again.
    pub fn reset_view(&mut self, planet: &Planet) {
        self.controller = CameraController::new(self.ground_radius_m, opening_place(planet));
    }

    /// The newest surface.
    pub fn surface(&self) -> Option<Arc<Surface>> {
        self.builder.surface()
    }

    /// Whether a finer surface is being built.
    pub fn is_busy(&self) -> bool {
        self.builder.is_busy()
    }

    /// What lies under the pointer, if it is over the globe.
    pub fn under_pointer(&self) -> Option<&UnderPointer> {
        self.under_pointer.as_ref()
    }

    /// What the newest picture took.
    pub fn stats(&self) -> FrameStats {
        self.stats
    }

    /// How many pictures have been drawn since the start.
    pub fn pictures(&self) -> u64 {
        self.pictures
    }

    /// Height of the eye above the ground, and the place under it.
    pub fn eye(&self, planet: &Planet) -> (f64, LatLon) {
        let surface = self.builder.surface();
        let ground = PlanetGround::new(planet, surface.as_deref().map(|surface| &*surface.terrain));
        (self.controller.altitude_m(&ground), self.controller.place())
    }

    /// Why nothing or something old is drawn.
    pub fn error(&self) -> Option<&str> {
        match &self.drawing {
            Drawing::Ready(renderer, _) => renderer.shader_error(),
            Drawing::Failed(error) => Some(error),
        }
    }

    /// Shows the picture in all of the room there is. `valid` is what is drawn; a drag of the sun changes `draft`, and gives
    /// the label of that edit.
    pub fn show(&mut self, ui: &mut egui::Ui, valid: &Arc<Planet>, draft: &mut Planet) -> Option<&'static str> {
        let (rect, response) = ui.allocate_exact_size(ui.available_size(), egui::Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "View of the planet"));
        ui.painter().rect_filled(rect, 0.0, egui::Color32::BLACK);
        if rect.width() < 1.0 || rect.height() < 1.0 {
            return None;
        }

        let surface = self.builder.surface();
        let terrain = surface.as_deref().map(|surface| &*surface.terrain);
        let ground = PlanetGround::new(valid, terrain);
        if ground.radius_m() != self.ground_radius_m {
            self.controller.rescale(self.ground_radius_m, ground.radius_m());
            self.ground_radius_m = ground.radius_m();
        }
        self.controller.keep_above(&ground);
        let moved = input::handle(ui, &response, &mut self.drag, &mut self.controller, &ground, draft);

        let settings = &mut self.settings;
        if settings.playing {
            settings.time_secs += f64::from(ui.input(|i| i.stable_dt).min(0.1)) * settings.time_speed;
        }
        if moved.animating || settings.playing {
            ui.ctx().request_repaint();
        } else if settings.auto_exposure && self.adaptation.is_under_way() {
            ui.ctx().request_repaint_after(adaptation::PAUSE);
        }

        let pixels_per_point = ui.ctx().pixels_per_point();
        let side_px = |points: f32| (points * pixels_per_point).round().max(1.0) as u32;
        let view = View {
            camera: self.controller.camera(&ground),
            size_px: [side_px(rect.width()), side_px(rect.height())],
            quality: self.settings.quality,
        };
        // The camera stands over the surface that is shown; a planet of another size is asked for from as far in its radii.
        let mut wanted = view;
        wanted.camera.position_planet_m *= valid.radius_m() / self.ground_radius_m;
        self.builder.request(valid, &wanted);
        self.look_under_pointer(&response, &view, surface.as_ref());
        if let Some(surface) = surface {
            // Sea and air of one size over ground of another would flash until the new tiles are there.
            let shown = surface.terrain.planet().clone();
            let planet = if shown.radius_km == valid.radius_km { valid } else { &shown };
            self.draw(surface, planet, view);
        }
        if let Some(target) = &self.target {
            let uv = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
            ui.painter().image(target.id(), rect, uv, egui::Color32::WHITE);
        }
        moved.sun.then_some(input::SUN_STEP)
    }

    /// Draws, unless the picture of just that is there already.
    fn draw(&mut self, surface: Arc<Surface>, planet: &Arc<Planet>, view: View) {
        let Drawing::Ready(renderer, state) = &mut self.drawing else { return };
        let key = PictureKey {
            surface,
            planet: planet.clone(),
            view,
            time_secs: self.settings.time_secs,
            exposure_ev: self.settings.exposure_ev,
            auto_exposure: self.settings.auto_exposure,
            debug_view: self.settings.debug_view,
        };
        let target = self.target.get_or_insert_with(|| Target::new(state, view.size_px));
        let resized = target.resize(view.size_px);
        let changed = resized || !self.drawn.as_ref().is_some_and(|drawn| drawn.same(&key));
        let adapting = self.settings.auto_exposure && self.adaptation.is_under_way();
        if !changed && !adapting {
            return;
        }
        renderer.metering = self.adaptation.metering(self.settings.auto_exposure, changed);
        let star = &planet.star;
        self.stats = renderer.render(
            &state.device,
            &state.queue,
            target.view(),
            &Frame {
                surface: &key.surface,
                planet,
                view,
                sun_dir_planet: LatLon::from_degrees(star.latitude_deg, star.longitude_deg).direction(),
                time_secs: key.time_secs,
                exposure_ev: key.exposure_ev,
                debug_view: key.debug_view,
            },
        );
        self.pictures += 1;
        self.frame_meter.drawn();
        self.edit_clock.drawn(&key.surface, planet);
        self.drawn = Some(key);
    }

    /// Asks the evaluator what lies under the pointer, unless the answer is known.
    fn look_under_pointer(&mut self, response: &egui::Response, view: &View, surface: Option<&Arc<Surface>>) {
        let (Some(pos), Some(surface)) = (response.hover_pos(), surface) else {
            self.under_pointer = None;
            self.under_pointer_key = None;
            return;
        };
        let known = self.under_pointer_key.as_ref();
        if known.is_some_and(|(p, v, s)| *p == pos && v == view && Arc::ptr_eq(s, surface)) {
            return;
        }
        self.under_pointer_key = Some((pos, *view, surface.clone()));
        let rect = response.rect;
        let x = f64::from((pos.x - rect.center().x) / (0.5 * rect.width()));
        let y = f64::from((rect.center().y - pos.y) / (0.5 * rect.height()));
        let camera = &view.camera;
        let ray = camera.ray_dir_planet(x, y, view.aspect());
        self.under_pointer = surface.terrain.raycast(camera.position_planet_m, ray).map(|distance_m| {
            let dir = camera.position_planet_m + ray * distance_m;
            let sample = surface.terrain.sample(dir);
            let palette = &surface.terrain.planet().biomes.palette;
            UnderPointer {
                place: LatLon::from_direction(dir),
                height_m: sample.height_m,
                temperature_c: sample.temperature_c,
                moisture: sample.moisture,
                biome: palette.get(sample.biome).map_or_else(String::new, |biome| biome.name.clone()),
            }
        });
    }
}
