//! Another planet beside the one that is edited, seen by the same camera: a line that can be dragged parts the two.

use super::Viewport;
use super::clock::{EditClock, FrameMeter};
use super::frames::FrameLog;
use super::picture::{Meters, Picture, Subject};
use super::settings::ViewSettings;
use crate::lod::View;
use crate::planet::Planet;
use crate::render::BodyId;
use crate::tiles::{Builder, BuilderOptions};
use eframe::egui;
use std::sync::Arc;

/// Width of the strip that takes the drag of the line, points.
const HANDLE: f32 = 12.0;
/// Least share of the picture on either side.
const LEAST: f32 = 0.02;
/// Room between the line and the names of the sides, points.
const ASIDE: f32 = 10.0;

/// A kept planet and its picture.
pub struct Compare {
    planet: Arc<Planet>,
    builder: Builder,
    picture: Picture,
    /// The place of the line, 0 at the left edge, 1 at the right.
    split: f32,
    // Nobody reads the times of this picture.
    frames: FrameLog,
    frame_meter: FrameMeter,
    edit_clock: EditClock,
}

/// What the picture of the kept planet shares with that of the other.
pub(super) struct Shared<'a> {
    pub(super) settings: &'a ViewSettings,
    pub(super) view: View,
    /// Radius of the planet over which the camera of the view stands.
    pub(super) radius_m: f64,
    pub(super) drafts: bool,
    pub(super) touched: bool,
    pub(super) now_secs: f64,
}

/// The planet that the one on screen is compared with.
impl Viewport {
    /// The planet that this one is compared with.
    pub fn compare(&self) -> Option<&Compare> {
        self.compare.as_ref()
    }

    /// Keeps a planet to compare others with; None ends the comparison.
    pub fn set_compare(&mut self, planet: Option<Arc<Planet>>, ctx: &egui::Context) {
        let options = || BuilderOptions::default().maps(self.maps.clone());
        self.compare = planet.map(|planet| Compare::new(planet, &self.picture, options(), ctx));
    }

    /// Keeps a planet in the place of the one that is kept, and gives that.
    pub fn swap_compared(&mut self, planet: Arc<Planet>) -> Option<Arc<Planet>> {
        self.compare.as_mut().map(|compare| compare.swap(planet))
    }
}

impl Compare {
    /// Keeps a planet, to be drawn like `beside`.
    pub(super) fn new(planet: Arc<Planet>, beside: &Picture, options: BuilderOptions, ctx: &egui::Context) -> Self {
        let ctx = ctx.clone();
        Self {
            planet,
            builder: Builder::with_options(options, move || ctx.request_repaint()),
            picture: beside.sibling(),
            split: 0.5,
            frames: FrameLog::default(),
            frame_meter: FrameMeter::default(),
            edit_clock: EditClock::default(),
        }
    }

    /// The kept planet.
    pub fn planet(&self) -> &Arc<Planet> {
        &self.planet
    }

    /// Whether its picture is complete.
    pub fn is_drawn(&self) -> bool {
        let surface = self.picture.surface();
        surface.is_some_and(|surface| surface.complete) && self.picture.count() > 0 && !self.builder.is_busy()
    }

    /// Keeps another planet. Gives the one before.
    pub(super) fn swap(&mut self, planet: Arc<Planet>) -> Arc<Planet> {
        std::mem::replace(&mut self.planet, planet)
    }

    /// Shows the kept planet to the left of the line, over the picture of the other one in `rect`.
    pub(super) fn show(&mut self, ui: &egui::Ui, rect: egui::Rect, shared: &Shared<'_>) {
        self.draw(ui, shared);
        let x = self.line(ui, rect);
        let left = rect.with_max_x(x);
        if let Some(texture) = self.picture.texture() {
            let uv = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
            ui.painter_at(left).image(texture, rect, uv, egui::Color32::WHITE);
        }
        let painter = ui.painter_at(rect);
        painter.vline(x, rect.y_range(), egui::Stroke::new(1.5, egui::Color32::from_gray(220)));
        painter.circle(egui::pos2(x, rect.center().y), 6.0, egui::Color32::from_gray(220), egui::Stroke::NONE);
        let font = egui::TextStyle::Body.resolve(ui.style());
        for (text, at, align) in
            [("Kept copy", x - ASIDE, egui::Align2::RIGHT_TOP), ("Now", x + ASIDE, egui::Align2::LEFT_TOP)]
        {
            painter.text(egui::pos2(at, rect.top() + ASIDE), align, text, font.clone(), egui::Color32::from_gray(230));
        }
    }

    /// Lets the line be dragged. Gives its place in the window.
    fn line(&mut self, ui: &egui::Ui, rect: egui::Rect) -> f32 {
        let place = |split: f32| rect.left() + split * rect.width();
        let strip = egui::Rect::from_x_y_ranges(
            place(self.split) - 0.5 * HANDLE..=place(self.split) + 0.5 * HANDLE,
            rect.y_range(),
        );
        let handle = ui.interact(strip, egui::Id::unique("compare line"), egui::Sense::drag());
        handle.widget_info(|| {
            let value = f64::from(self.split);
            egui::WidgetInfo::slider(ui.is_enabled(), value, "Line between the kept copy and the planet")
        });
        let handle = handle.on_hover_cursor(egui::CursorIcon::ResizeHorizontal);
        if let Some(pointer) = handle.interact_pointer_pos().filter(|_| handle.dragged()) {
            self.split = (pointer.x - rect.left()) / rect.width().max(1.0);
        }
        self.split = self.split.clamp(LEAST, 1.0 - LEAST);
        place(self.split)
    }

    fn draw(&mut self, ui: &egui::Ui, shared: &Shared<'_>) {
        let ctx = ui.ctx();
        self.picture.advance(BodyId::default(), self.builder.surface().as_ref(), &mut self.frames, ctx);
        // The same place on a planet of another radius.
        let mut view = shared.view;
        view.camera.position_planet_m *= self.planet.radius_m() / shared.radius_m;
        if let Err(error) = self.builder.request(&self.planet, &view) {
            log::error!("{error}");
        }
        if shared.touched {
            self.picture.refinement.touched(shared.now_secs);
        }
        let is_busy = self.builder.is_busy() || self.picture.is_behind(self.builder.surface().as_ref());
        if let Some(surface) = self.picture.surface().cloned() {
            let subject = Subject {
                revision: surface.terrain.revision().clone(),
                surface,
                view,
                frozen: None,
                settings: shared.settings,
                marked: None,
                sky: None,
                drafts: shared.drafts,
                is_busy,
                now_secs: shared.now_secs,
            };
            let (frames, frame_meter, edit_clock) = (&mut self.frames, &mut self.frame_meter, &mut self.edit_clock);
            self.picture.draw(&subject, &mut Meters { frames, frame_meter, edit_clock });
        }
        if let Some(wait) = self.picture.refines_after(shared.settings, shared.now_secs).filter(|_| !is_busy) {
            ctx.request_repaint_after(wait);
        }
        if let Some(wait) = self.picture.adapts_after(shared.settings) {
            ctx.request_repaint_after(wait);
        }
    }
}
