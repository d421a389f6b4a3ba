//! One view beside the active one.

use super::map::{Map, MapKind};
use super::{Place, Shows};
use crate::editor::viewport::camera::Cameras;
use crate::editor::viewport::camera::Ground as _;
use crate::editor::viewport::clock::{EditClock, FrameMeter, revision_over};
use crate::editor::viewport::frames::FrameLog;
use crate::editor::viewport::ground::PlanetGround;
use crate::editor::viewport::neighbours::Sky;
use crate::editor::viewport::picture::{Meters, Picture, Subject};
use crate::editor::viewport::settings::ViewSettings;
use crate::lod::{Camera, Quality, View};
use crate::planet::{GroundEdit, Planet};
use crate::render::BodyId;
use crate::terrain::Revision;
use crate::tiles::Surface;
use eframe::egui;
use glam::DVec3;
use std::sync::Arc;

/// What the panes share with the active one.
pub(in crate::editor::viewport) struct PaneSubject<'a> {
    pub(in crate::editor::viewport) has_structure: bool,
    pub(in crate::editor::viewport) settings: ViewSettings,
    /// The newest valid planet.
    pub(in crate::editor::viewport) newest: Option<Revision>,
    pub(in crate::editor::viewport) own_id: BodyId,
    pub(in crate::editor::viewport) sky: Option<Sky>,
    pub(in crate::editor::viewport) selected: Option<&'a GroundEdit>,
    pub(in crate::editor::viewport) drafts: bool,
    pub(in crate::editor::viewport) is_busy: bool,
    pub(in crate::editor::viewport) now_secs: f64,
}

/// A view with its own camera and its own way to draw.
pub(super) struct Pane {
    pub(super) shows: Shows,
    pub(super) linked: bool,
    pub(super) picture: Picture,
    pub(super) cameras: Cameras,
    /// Radius of the reference sphere over which its camera is placed; 0 at first.
    ground_radius_m: f64,
    /// The view whose tiles were kept when it was the active one.
    pub(super) frozen: Option<View>,
    map: Map,
    view: Option<View>,
    rect: egui::Rect,
    response: Option<egui::Response>,
    chosen: Option<DVec3>,
    // Nobody reads the times of this picture.
    frames: FrameLog,
    frame_meter: FrameMeter,
    edit_clock: EditClock,
}

impl Pane {
    pub(super) fn new(shows: Shows, picture: Picture, cameras: Cameras, ctx: &egui::Context) -> Self {
        Self {
            shows,
            linked: true,
            picture,
            cameras,
            ground_radius_m: 0.0,
            frozen: None,
            map: Map::new(ctx),
            view: None,
            rect: egui::Rect::NOTHING,
            response: None,
            chosen: None,
            frames: FrameLog::default(),
            frame_meter: FrameMeter::default(),
            edit_clock: EditClock::default(),
        }
    }

    pub(super) fn rect(&self) -> egui::Rect {
        self.rect
    }

    /// Its camera in the newest frame.
    pub(super) fn camera(&self) -> Option<Camera> {
        self.view.map(|view| view.camera)
    }

    /// Notes where it is in the window, and what the pointer does there.
    pub(super) fn place(&mut self, place: &Place) {
        (self.rect, self.response) = (place.rect, Some(place.response.clone()));
    }

    /// The direction that was clicked on its map since the last call.
    pub(super) fn take_chosen(&mut self) -> Option<DVec3> {
        self.chosen.take()
    }

    /// Whether it shows the planet and `newest` is not on screen yet.
    pub(super) fn is_behind(&self, newest: Option<&Arc<Surface>>) -> bool {
        matches!(self.shows, Shows::Planet(_)) && self.picture.is_behind(newest)
    }

    /// Its view of the planet. A map needs tiles of one pixel alone. `shared`: the camera of linked panes.
    pub(super) fn view(
        &mut self,
        shared: Option<&Cameras>,
        quality: Quality,
        ground: &PlanetGround<'_>,
        pixels_per_point: f32,
        valid: &Planet,
    ) -> View {
        if let Some(shared) = shared.filter(|_| self.linked) {
            self.cameras = shared.clone();
        } else if self.ground_radius_m > 0.0 && self.ground_radius_m != ground.radius_m() {
            self.cameras.rescale(self.ground_radius_m, ground.radius_m(), ground);
        }
        self.ground_radius_m = ground.radius_m();
        self.cameras.keep_above(ground);
        let side_px = |points: f32| (points * pixels_per_point).round().max(1.0) as u32;
        let size_px = match self.shows {
            Shows::Planet(_) => [side_px(self.rect.width()), side_px(self.rect.height())],
            Shows::Map(_) => [1, 1],
        };
        let view = View { camera: self.cameras.camera(ground), size_px, quality };
        self.view = Some(view);
        let mut wanted = view;
        wanted.camera.position_planet_m *= valid.radius_m() / self.ground_radius_m;
        wanted
    }

    /// Draws it. `eye`: the camera of the active pane.
    pub(super) fn show(
        &mut self,
        ui: &mut egui::Ui,
        shared: &PaneSubject<'_>,
        surface: Option<&Arc<Surface>>,
        eye: Option<&Camera>,
    ) {
        match self.shows {
            Shows::Map(kind) => self.show_map(ui, kind, shared, surface, eye),
            Shows::Planet(_) => self.show_planet(ui, shared, surface),
        }
    }

    fn show_map(
        &mut self,
        ui: &mut egui::Ui,
        kind: MapKind,
        shared: &PaneSubject<'_>,
        surface: Option<&Arc<Surface>>,
        eye: Option<&Camera>,
    ) {
        if let Some(surface) = surface.filter(|surface| !shared.is_busy && !shared.drafts && surface.complete) {
            self.map.ask(kind, &surface.terrain);
        }
        let response = self.response.as_ref();
        self.chosen = self.map.show(ui, kind, self.rect, response, eye, shared.selected);
    }

    fn show_planet(&mut self, ui: &egui::Ui, shared: &PaneSubject<'_>, newest: Option<&Arc<Surface>>) {
        let Shows::Planet(debug_view) = self.shows else { return };
        self.picture.advance(shared.own_id, newest, &mut self.frames, ui.ctx());
        let (Some(view), Some(surface)) = (self.view, self.picture.surface().cloned()) else { return };
        let is_busy = shared.is_busy || self.picture.is_behind(newest);
        let settings = ViewSettings { debug_view, ..shared.settings };
        let subject = Subject {
            revision: revision_over(shared.newest.as_ref(), &surface),
            surface,
            view,
            frozen: None,
            settings: &settings,
            marked: None,
            sky: shared.sky.clone(),
            drafts: shared.drafts,
            is_busy,
            now_secs: shared.now_secs,
        };
        let (frames, frame_meter, edit_clock) = (&mut self.frames, &mut self.frame_meter, &mut self.edit_clock);
        self.picture.draw(&subject, &mut Meters { frames, frame_meter, edit_clock });
        if let Some(texture) = self.picture.texture() {
            let uv = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
            ui.painter().image(texture, self.rect, uv, egui::Color32::WHITE);
        }
        for wait in [self.picture.adapts_after(&settings), self.picture.refines_after(&settings, shared.now_secs)] {
            if let Some(wait) = wait.filter(|_| !is_busy) {
                ui.ctx().request_repaint_after(wait);
            }
        }
    }
}
