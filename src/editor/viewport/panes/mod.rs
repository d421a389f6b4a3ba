//! More views of the planet beside the first: up to four panes, each with its own camera and its own way to draw, or a
//! map of the whole globe.
//!
//! One pane is *active*: it is the viewport proper, with its tools, chips and keys. A press or a turn of the wheel over
//! another pane makes that one active: the two change roles, so that every tool works in every pane. Panes that are
//! *linked* share one camera.
//!
//! - `pane`: one view beside the active one; `map`: maps of the globe, flat or around a pole
//! - `bar`: the menu of a pane; `kept`: the panes from one start to the next

mod bar;
mod kept;
mod map;
mod pane;

use super::Viewport;
use super::camera::{Cameras, Ground as _};
use super::ground::PlanetGround;
use crate::lod::{Camera, View};
use crate::planet::Planet;
use crate::render::DebugView;
use eframe::egui;
use glam::DVec3;
pub use map::MapKind;
use pane::Pane;
pub(super) use pane::PaneSubject;

/// Room between two panes, points.
const GAP: f32 = 2.0;

/// How many panes the viewport has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq, Hash)]
pub enum PaneLayout {
    /// The view with the tools alone.
    #[default]
    One,
    /// Two side by side.
    Two,
    /// Two rows of two.
    Four,
}

impl PaneLayout {
    /// All layouts.
    pub const ALL: [PaneLayout; 3] = [PaneLayout::One, PaneLayout::Two, PaneLayout::Four];

    /// How many panes it has.
    pub fn panes(self) -> usize {
        match self {
            PaneLayout::One => 1,
            PaneLayout::Two => 2,
            PaneLayout::Four => 4,
        }
    }

    /// The panes in a rectangle, row by row.
    fn rects(self, all: egui::Rect) -> Vec<egui::Rect> {
        let halves = |rect: egui::Rect| {
            let (left, right) = rect.split_left_right_at_fraction(0.5);
            [left.with_max_x(left.right() - 0.5 * GAP), right.with_min_x(right.left() + 0.5 * GAP)]
        };
        match self {
            PaneLayout::One => vec![all],
            PaneLayout::Two => halves(all).to_vec(),
            PaneLayout::Four => {
                let (top, bottom) = all.split_top_bottom_at_fraction(0.5);
                let rows = [top.with_max_y(top.bottom() - 0.5 * GAP), bottom.with_min_y(bottom.top() + 0.5 * GAP)];
                rows.into_iter().flat_map(halves).collect()
            }
        }
    }
}

/// What a pane shows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shows {
    /// The planet, as a debug view draws it.
    Planet(DebugView),
    /// A map of the globe.
    Map(MapKind),
}

impl Shows {
    /// All that a planet has; maps if there `may_be_map`s.
    pub fn all(has_structure: bool, may_be_map: bool) -> impl Iterator<Item = Shows> {
        let views = DebugView::ALL.into_iter().filter(move |view| has_structure || !view.needs_structure());
        views.map(Shows::Planet).chain(MapKind::ALL.into_iter().filter(move |_| may_be_map).map(Shows::Map))
    }

    /// The name in menus.
    pub fn label(self) -> &'static str {
        match self {
            Shows::Planet(view) => view.label(),
            Shows::Map(kind) => kind.label(),
        }
    }
}

/// The panes of the viewport.
pub(super) struct Panes {
    layout: PaneLayout,
    /// Place of the active pane.
    pub(super) active: usize,
    /// Whether the active pane shares its camera.
    linked: bool,
    /// By place; none at that of the active pane.
    others: Vec<Option<Pane>>,
    /// The camera of linked panes while the active one is not linked, and the radius of the reference sphere over which
    /// it is placed.
    shared: Option<(Cameras, f64)>,
    /// The direction that was clicked on a map.
    chosen: Option<DVec3>,
}

impl Default for Panes {
    fn default() -> Self {
        Self { layout: PaneLayout::One, active: 0, linked: true, others: vec![None], shared: None, chosen: None }
    }
}

/// A pane's place in the window, and what the pointer does there.
pub(super) struct Place {
    pub(super) rect: egui::Rect,
    pub(super) response: egui::Response,
}

impl Viewport {
    /// How many panes there are.
    pub fn layout(&self) -> PaneLayout {
        self.panes.layout
    }

    /// What the pane at a place shows; None without such a pane.
    pub fn shows(&self, place: usize) -> Option<Shows> {
        if place == self.panes.active {
            return Some(Shows::Planet(self.settings.debug_view));
        }
        self.panes.others.get(place)?.as_ref().map(|pane| pane.shows)
    }

    /// Where the pane at a place is in the window, and its camera in the newest frame. None without such a pane.
    pub fn pane(&self, place: usize) -> Option<(egui::Rect, Option<Camera>)> {
        if place == self.panes.active {
            return Some((self.rect, self.shown_camera));
        }
        let pane = self.panes.others.get(place)?.as_ref()?;
        Some((pane.rect(), pane.camera()))
    }

    /// The direction in the planet frame that was clicked on a map since the last call.
    pub fn take_chosen(&mut self) -> Option<DVec3> {
        self.panes.chosen.take()
    }

    /// Place of the pane with the tools.
    pub fn active_pane(&self) -> usize {
        self.panes.active
    }

    /// Sets how many panes there are. The active one stays; new ones show what no other does.
    pub fn set_layout(&mut self, layout: PaneLayout) {
        if layout == self.panes.layout {
            return;
        }
        // The active pane comes first.
        let mut others: Vec<Pane> = std::mem::take(&mut self.panes.others).into_iter().flatten().collect();
        others.truncate(layout.panes() - 1);
        let first: &[Shows] = match layout {
            PaneLayout::One => &[],
            PaneLayout::Two => &[Shows::Map(MapKind::Flat)],
            PaneLayout::Four => &[
                Shows::Planet(DebugView::Height),
                Shows::Planet(DebugView::Biome),
                Shows::Map(MapKind::Flat),
                Shows::Planet(DebugView::Shaded),
            ],
        };
        for &shows in first {
            let is_shown = shows == Shows::Planet(self.settings.debug_view);
            let is_new = !is_shown && !others.iter().any(|pane| pane.shows == shows);
            if is_new && others.len() + 1 < layout.panes() {
                others.push(Pane::new(shows, self.picture.sibling(), self.cameras.clone(), &self.ctx));
            }
        }
        self.panes.layout = layout;
        self.panes.active = 0;
        self.panes.others = std::iter::once(None).chain(others.into_iter().map(Some)).collect();
    }

    /// Makes room for the panes. A press or a turn of the wheel over another pane that shows the planet makes it the
    /// active one; with a tool in hand the pointer alone does. Gives the place of the active pane.
    pub(super) fn place_panes(&mut self, ui: &mut egui::Ui) -> Place {
        let (all, _) = ui.allocate_exact_size(ui.available_size(), egui::Sense::hover());
        ui.painter().rect_filled(all, 0.0, egui::Color32::BLACK);
        let rects = self.panes.layout.rects(all);
        let mut places: Vec<Place> = Vec::with_capacity(rects.len());
        for (number, rect) in rects.into_iter().enumerate() {
            let response = ui.interact(rect, ui.scope_id().with(("pane", number)), egui::Sense::click_and_drag());
            places.push(Place { rect, response });
        }
        let has_tool = self.tab.sculpt.brush.is_some() || self.tab.sculpt.measures;
        let (pressed, down, turned, pos) = ui.input(|input| {
            let (pointer, turned) = (&input.pointer, input.smooth_scroll_delta() != egui::Vec2::ZERO);
            (pointer.any_pressed(), pointer.any_down(), turned, pointer.interact_pos())
        });
        let on_bar = |rect| bar::place(rect).zip(pos).is_some_and(|(bar, pos)| bar.contains(pos));
        let acts = pressed || turned || (has_tool && !down);
        let wants = |place: &Place| acts && place.response.hovered() && !on_bar(place.rect);
        if let Some(number) = places.iter().position(wants) {
            self.activate(number);
        }
        for (number, place) in places.iter().enumerate() {
            let name = if number == self.panes.active { "View of the planet" } else { "Another view of the planet" };
            place.response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, name));
            if let Some(pane) = self.panes.others.get_mut(number).and_then(Option::as_mut) {
                pane.place(place);
            }
        }
        places.swap_remove(self.panes.active)
    }

    /// Gives a pane that shows the planet the tools.
    fn activate(&mut self, number: usize) {
        // A flight goes on in its own pane.
        if self.travel.is_some() || self.is_landing {
            return;
        }
        let Some(slot) = self.panes.others.get_mut(number) else { return };
        let Some(mut pane) = slot.take_if(|pane| matches!(pane.shows, Shows::Planet(_))) else { return };
        if let Shows::Planet(view) = pane.shows {
            pane.shows = Shows::Planet(std::mem::replace(&mut self.settings.debug_view, view));
        }
        std::mem::swap(&mut self.picture, &mut pane.picture);
        std::mem::swap(&mut self.cameras, &mut pane.cameras);
        std::mem::swap(&mut self.panes.linked, &mut pane.linked);
        std::mem::swap(&mut self.frozen, &mut pane.frozen);
        self.drag = super::input::Drag::None;
        let before = std::mem::replace(&mut self.panes.active, number);
        self.panes.others[before] = Some(pane);
    }

    /// The views that the builder makes tiles for, pane by pane. `own`: that of the active pane.
    pub(super) fn pane_views(&mut self, valid: &Planet, own: View, ground: &PlanetGround<'_>) -> Vec<View> {
        let (panes, radius_m) = (&mut self.panes, ground.radius_m());
        if panes.linked {
            panes.shared = Some((self.cameras.clone(), radius_m));
        } else if let Some((shared, before_m)) = panes.shared.as_mut().filter(|(_, before_m)| *before_m != radius_m) {
            shared.rescale(*before_m, radius_m, ground);
            *before_m = radius_m;
        }
        let pixels_per_point = self.ctx.pixels_per_point();
        let shared = panes.shared.as_ref().map(|(shared, _)| shared);
        let mut views = Vec::with_capacity(panes.others.len());
        for pane in &mut panes.others {
            views.push(match pane {
                None => own,
                Some(pane) => pane.view(shared, own.quality, ground, pixels_per_point, valid),
            });
        }
        views
    }

    /// Draws the panes beside the active one, and their menus.
    pub(super) fn show_panes(&mut self, ui: &mut egui::Ui, rect: egui::Rect, shared: &PaneSubject<'_>) {
        if self.panes.layout == PaneLayout::One {
            return;
        }
        let eye = self.shown_camera;
        let mut chosen = None;
        let mut others = std::mem::take(&mut self.panes.others);
        for (number, slot) in others.iter_mut().enumerate() {
            let Some(pane) = slot else { continue };
            let surface = self.builder.surface_of(number);
            pane.show(ui, shared, surface.as_ref(), eye.as_ref());
            chosen = chosen.or(pane.take_chosen());
            let choices = Shows::all(shared.has_structure, true);
            bar::show(ui, (pane.rect(), number), choices, &mut pane.shows, &mut pane.linked);
        }
        self.panes.others = others;
        let mut own = Shows::Planet(self.settings.debug_view);
        // A map has no tools: another pane must be able to take them.
        let choices = Shows::all(shared.has_structure, self.other_planet_pane().is_some());
        bar::show(ui, (rect, self.panes.active), choices, &mut own, &mut self.panes.linked);
        match own {
            Shows::Planet(view) => self.settings.debug_view = view,
            Shows::Map(_) => self.leave_to(own),
        }
        ui.painter().rect_stroke(
            rect,
            0.0,
            egui::Stroke::new(1.0, ui.visuals().selection.bg_fill),
            egui::StrokeKind::Inside,
        );
        self.panes.chosen = chosen.or(self.panes.chosen);
    }

    /// Gives the tools to another pane that shows the planet, if there is one, and shows something else here.
    fn leave_to(&mut self, shows: Shows) {
        let here = self.panes.active;
        if let Some(number) = self.other_planet_pane() {
            self.activate(number);
            if let Some(Some(pane)) = self.panes.others.get_mut(here) {
                pane.shows = shows;
            }
        }
    }

    /// Place of a pane beside the active one that shows the planet.
    fn other_planet_pane(&self) -> Option<usize> {
        let is_planet = |slot: &Option<Pane>| slot.as_ref().is_some_and(|pane| matches!(pane.shows, Shows::Planet(_)));
        self.panes.others.iter().position(is_planet)
    }

    /// Looks at the planet in all panes as the active one does.
    pub(super) fn reset_panes(&mut self) {
        self.panes.shared = None;
        for pane in self.panes.others.iter_mut().flatten() {
            pane.cameras = self.cameras.clone();
        }
    }

    /// Whether a pane beside the active one waits for its tiles.
    pub(super) fn panes_are_behind(&self) -> bool {
        let is_behind = |(number, slot): (usize, &Option<Pane>)| {
            slot.as_ref().is_some_and(|pane| pane.is_behind(self.builder.surface_of(number).as_ref()))
        };
        self.panes.others.iter().enumerate().any(is_behind)
    }
}

/// The pictures of the panes beside the active one.
impl Panes {
    /// Keeps the pictures as they are until there are surfaces of another body.
    pub(super) fn wait_for_surfaces(&mut self) {
        self.others.iter_mut().flatten().for_each(|pane| pane.picture.wait_for_surface());
    }

    /// Lets refinement wait in all panes.
    pub(super) fn touched(&mut self, now_secs: f64) {
        self.others.iter_mut().flatten().for_each(|pane| pane.picture.refinement.touched(now_secs));
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn panes_tile_the_viewport_row_by_row() {
        let all = egui::Rect::from_min_size(egui::pos2(10.0, 20.0), egui::vec2(802.0, 602.0));
        for layout in PaneLayout::ALL {
            let rects = layout.rects(all);
            assert_eq!(rects.len(), layout.panes());
            assert!(rects.iter().all(|rect| all.contains_rect(*rect) && rect.is_positive()));
            let area: f32 = rects.iter().map(egui::Rect::area).sum();
            assert!(area > 0.99 * all.area() && rects[0].min == all.min && rects[rects.len() - 1].max == all.max);
        }
        let four = PaneLayout::Four.rects(all);
        assert!(four[1].left() > four[0].right() && four[1].top() == four[0].top() && four[2].left() == all.left());
    }
}
