//! The map of the orbits around a body, seen from the north. Bodies are dragged along and across their orbits.

use super::Now;
use crate::editor::command::{Action, Commands, SystemAction};
use crate::editor::state::system::trial::TrialRun;
use crate::editor::viewport::travel::Arrival;
use crate::system::kepler::Ellipse;
use crate::system::limits::{STABLE_SHARE, hill_radii_m, roche_limit_m};
use crate::system::{Orbit, System};
use eframe::egui::{self, Color32, Painter, Pos2, Rect, Sense, Shape, Stroke, Vec2};
use glam::{DVec2, DVec3};
use std::f64::consts::TAU;

/// Height, in points.
const HEIGHT: f32 = 230.0;
/// Sides of a drawn orbit or limit.
const SIDES: u32 = 128;
/// Margin around the widest orbit, as a factor.
const ROOM: f64 = 1.12;
/// Least size of an orbit that is drawn, of one whose body is told apart from its parent, and of one whose periapsis
/// can be dragged, in points.
const LEAST_ORBIT: f64 = 2.0;
const LEAST_APART: f64 = 6.0;
const LEAST_HANDLED: f32 = 24.0;
/// Distance from a body or a handle within which a click is on it, in points.
const REACH: f32 = 12.0;
/// Eccentricity that dragging reaches.
const MOST_DRAGGED: f64 = 0.9;
const LIMIT_COLOR: Color32 = Color32::from_rgb(190, 110, 80);
const HELD_COLOR: Color32 = Color32::from_rgb(80, 130, 90);
const TRAIL_COLOR: Color32 = Color32::from_rgb(150, 120, 60);

/// What is dragged.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Held {
    Body(usize),
    Periapsis(usize),
}

/// What the map shows, and what is dragged on it.
pub(super) struct OrbitMap {
    /// The body in the middle: the selected one.
    pub(super) center: usize,
    /// Magnification.
    zoom: f64,
    /// What is dragged, and the scale at the start of the drag: it stays, or the body would run away from the pointer.
    held: Option<(Held, Scale)>,
}

/// The scale of the map.
#[derive(Clone, Copy, Debug)]
struct Scale {
    widest_m: f64,
    /// Points for each metre at the widest orbit.
    per_m: f64,
}

impl Default for OrbitMap {
    fn default() -> Self {
        Self { center: 0, zoom: 1.0, held: None }
    }
}

impl OrbitMap {
    pub(super) fn look_at(&mut self, body: usize) {
        (self.center, self.zoom) = (body, 1.0);
    }

    pub(super) fn show(&mut self, ui: &mut egui::Ui, now: &Now<'_>, commands: &mut Commands) {
        let (rect, response) = ui.allocate_exact_size(Vec2::new(ui.available_width(), HEIGHT), Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Map of the orbits"));
        if response.hovered() {
            let scroll = f64::from(ui.input(|input| input.smooth_scroll_delta().y));
            self.zoom = (self.zoom * (scroll * 0.004).exp()).clamp(0.2, 1e4);
        }
        let painter = ui.painter_at(rect);
        painter.rect_filled(rect, 4.0, Color32::from_gray(12));
        let scale = self.held.map_or_else(|| Scale::new(now, self.center, rect, self.zoom), |(_, scale)| scale);
        let map = Map { now, center: self.center, center_m: now.poses[self.center].position_m, rect, scale };
        map.draw_limits(&painter);
        map.draw_orbits(&painter);
        map.draw_trails(&painter);
        let (bodies, handles) = (map.bodies(), map.handles());
        let font = egui::TextStyle::Small.resolve(ui.style());
        let near = |at: Option<Pos2>| at.and_then(|pointer| nearest(&bodies, &handles, pointer));
        let hovered = self.held.map(|(held, _)| held).or_else(|| near(response.hover_pos()));
        for (body, at) in &handles {
            let is_hovered = hovered == Some(Held::Periapsis(*body));
            let color = if is_hovered { Color32::WHITE } else { Color32::from_gray(110) };
            painter.add(Shape::closed_line(diamond(*at), Stroke::new(1.0, color)));
        }
        for (body, at) in &bodies {
            draw_body(&painter, &font, now, *body, *at);
        }
        if response.drag_started() {
            self.held = near(ui.input(|input| input.pointer.press_origin())).map(|held| (held, scale));
        }
        if let (Some((held, _)), Some(pointer)) = (self.held, response.interact_pointer_pos())
            && response.dragged()
            && let Some((system, label)) = map.dragged(held, pointer)
        {
            commands.push(Action::System(SystemAction::Edit(Box::new(system), label)));
        }
        if !response.dragged() {
            self.held = None;
        }
        if let Some(Held::Body(body)) = near(response.interact_pointer_pos()) {
            if response.double_clicked() && now.can_visit(body) {
                commands.push(Action::System(SystemAction::Visit(body, Arrival::Orbit)));
            } else if response.clicked() {
                self.look_at(body);
            }
        }
        if hovered.is_some_and(|held| now.orbit(held.body()).is_some()) {
            ui.ctx().set_cursor_icon(egui::CursorIcon::Grab);
        }
        if self.held.is_some() {
            return;
        }
        response.on_hover_text(
            "From the north; distances as their roots. Drag a body to move it and its orbit, a diamond to stretch the \
             orbit. The wheel zooms, a click puts a body in the middle, a double click goes there. Green: how far the \
             body in the middle holds moons for long. Red: within it, tides tear moons apart.",
        );
    }
}

impl Held {
    fn body(self) -> usize {
        match self {
            Held::Body(body) | Held::Periapsis(body) => body,
        }
    }
}

/// What is under the pointer: bodies come before handles.
fn nearest(bodies: &[(usize, Pos2)], handles: &[(usize, Pos2)], pointer: Pos2) -> Option<Held> {
    let of = |places: &[(usize, Pos2)]| {
        let near = places.iter().map(|(body, at)| (at.distance(pointer), *body)).filter(|near| near.0 < REACH);
        near.min_by(|a, b| a.0.total_cmp(&b.0)).map(|(_, body)| body)
    };
    of(bodies).map(Held::Body).or_else(|| of(handles).map(Held::Periapsis))
}

fn diamond(at: Pos2) -> Vec<Pos2> {
    [Vec2::X, Vec2::Y, -Vec2::X, -Vec2::Y].into_iter().map(|side| at + side * 4.0).collect()
}

/// The map in a rectangle.
struct Map<'a> {
    now: &'a Now<'a>,
    center: usize,
    center_m: DVec3,
    rect: Rect,
    scale: Scale,
}

impl Scale {
    fn new(now: &Now<'_>, center: usize, rect: Rect, zoom: f64) -> Self {
        let size_m = |body: usize| now.orbit(body).map_or(0.0, |orbit| orbit.semi_major_m * (1.0 + orbit.eccentricity));
        let widest_m = now.children(center).map(size_m).fold(0.0, f64::max);
        // A body without moons is shown on its own orbit.
        let widest_m = if widest_m > 0.0 { widest_m } else { size_m(center).max(1.0) };
        let per_m = 0.5 * f64::from(rect.height().min(rect.width())) / (widest_m * ROOM) * zoom;
        Self { widest_m, per_m }
    }
}

impl Map<'_> {
    /// Where a position is. Distances are roots, so that inner orbits are not crowded together.
    fn at(&self, position_m: DVec3) -> Pos2 {
        let away_m = position_m - self.center_m;
        let away = away_m * (self.scale.per_m * (self.scale.widest_m / away_m.truncate().length().max(1.0)).sqrt());
        self.rect.center() + Vec2::new(away.x as f32, -away.y as f32)
    }

    /// The place under a point of the window, metres from the body in the middle: the other way round.
    fn under(&self, point: Pos2) -> DVec2 {
        let away = point - self.rect.center();
        let away = DVec2::new(f64::from(away.x), -f64::from(away.y));
        away * (away.length() / (self.scale.per_m * self.scale.per_m * self.scale.widest_m))
    }

    /// The system with what is dragged under the pointer, and the name of the step.
    fn dragged(&self, held: Held, pointer: Pos2) -> Option<(System, String)> {
        let body = held.body();
        let (ellipse, parent) = (self.now.orbit(body)?, self.now.parents[body]?);
        let over_m = self.under(pointer) + (self.center_m - self.now.poses[parent].position_m).truncate();
        let mut system = self.now.system().clone();
        let member = &mut system.bodies[body];
        let (orbit, label) = match held {
            Held::Body(_) => (moved(member.orbit.as_ref(), ellipse, over_m, self.now.time_secs)?, "Move"),
            Held::Periapsis(_) => (stretched(member.orbit.as_ref(), ellipse, over_m)?, "Stretch the orbit of"),
        };
        let label = format!("{label} {}", member.name);
        (member.orbit, member.start) = (Some(orbit), None);
        Some((system, label))
    }

    fn draw_orbits(&self, painter: &Painter) {
        for (body, parent) in self.now.parents.iter().enumerate() {
            let (Some(orbit), Some(parent)) = (self.now.orbit(body), *parent) else { continue };
            if orbit.semi_major_m * self.scale.per_m < LEAST_ORBIT {
                continue;
            }
            let around_m = self.now.poses[parent].position_m;
            let point = |side: u32| self.at(around_m + orbit.at_anomaly(TAU * f64::from(side) / f64::from(SIDES)));
            let line: Vec<Pos2> = (0..=SIDES).map(point).collect();
            let is_here = self.now.here == Some(body);
            let color = if is_here { Color32::from_rgb(120, 170, 230) } else { Color32::from_gray(70) };
            painter.add(Shape::line(line, Stroke::new(1.0, color)));
        }
    }

    /// How near moons of the body in the middle may come, and how far they are held for long.
    fn draw_limits(&self, painter: &Painter) {
        let system = self.now.system();
        let radius_m = self.now.open.worlds.radii_m()[self.center];
        let circle = |distance_m: f64, color: Color32| {
            let point = |side: u32| {
                let turn = TAU * f64::from(side) / f64::from(SIDES);
                self.at(self.center_m + DVec3::new(turn.cos(), turn.sin(), 0.0) * distance_m)
            };
            let line: Vec<Pos2> = (0..=SIDES).map(point).collect();
            painter.extend(Shape::dashed_line(&line, Stroke::new(1.0, color), 4.0, 3.0));
        };
        let hill_m = hill_radii_m(system)[self.center];
        if hill_m.is_finite() {
            circle(STABLE_SHARE * hill_m, HELD_COLOR);
        }
        if radius_m > 0.0 && system.bodies[self.center].light.is_none() {
            circle(roche_limit_m(radius_m, [1.0, 1.0]), LIMIT_COLOR);
        }
    }

    /// The last orbits of a trial.
    fn draw_trails(&self, painter: &Painter) {
        let TrialRun::Done(tried) = &self.now.open.trial else { return };
        for (body, parent) in self.now.parents.iter().enumerate() {
            let (Some(orbit), Some(parent)) = (self.now.orbit(body), *parent) else { continue };
            if orbit.semi_major_m * self.scale.per_m < LEAST_APART {
                continue;
            }
            let around_m = self.now.poses[parent].position_m;
            let line: Vec<Pos2> = tried.trails.of(body).map(|point_m| self.at(around_m + point_m)).collect();
            painter.add(Shape::line(line, Stroke::new(1.0, TRAIL_COLOR)));
        }
    }

    /// The bodies on the map, without points, and without moons that are not told apart from their planet.
    fn bodies(&self) -> Vec<(usize, Pos2)> {
        let is_apart = |body: &usize| {
            self.now.orbit(*body).is_none_or(|orbit| orbit.semi_major_m * self.scale.per_m > LEAST_APART)
        };
        (0..self.now.poses.len())
            .filter(|body| !self.now.system().bodies[*body].is_point())
            .filter(is_apart)
            .map(|body| (body, self.at(self.now.poses[body].position_m)))
            .filter(|(_, at)| self.rect.contains(*at))
            .collect()
    }

    /// The periapses that can be dragged.
    fn handles(&self) -> Vec<(usize, Pos2)> {
        let handle = |body: usize| {
            let (orbit, parent) = (self.now.orbit(body)?, self.now.parents[body]?);
            let around_m = self.now.poses[parent].position_m;
            let at = self.at(around_m + orbit.at_anomaly(0.0));
            (at.distance(self.at(around_m)) > LEAST_HANDLED).then_some((body, at))
        };
        (0..self.now.poses.len()).filter_map(handle).filter(|(_, at)| self.rect.contains(*at)).collect()
    }
}

/// The orbit of the same shape through a place, where the body stands now. Angles of a body with elements stay as they
/// are written.
fn moved(elements: Option<&Orbit>, ellipse: &Ellipse, over_m: DVec2, time_secs: f64) -> Option<Orbit> {
    let through = ellipse.through(over_m, time_secs)?;
    let found = through.elements();
    let old = elements.cloned().unwrap_or_else(|| ellipse.elements());
    let scale = through.semi_major_m / ellipse.semi_major_m;
    let Orbit { semi_major_km, anomaly_deg, period_hours, .. } = Orbit {
        semi_major_km: found.semi_major_km.clamp(1.0, 1e12),
        anomaly_deg: found.anomaly_deg,
        period_hours: (old.period_hours * scale.powf(1.5)).min(1e10),
        ..old.clone()
    }
    .rounded();
    Some(Orbit { semi_major_km, anomaly_deg, period_hours, ..old })
}

/// The orbit of the same size with its periapsis under a place.
fn stretched(elements: Option<&Orbit>, ellipse: &Ellipse, over_m: DVec2) -> Option<Orbit> {
    let old = elements.cloned().unwrap_or_else(|| ellipse.elements());
    let in_plane_m = ellipse.in_plane_m(over_m)?;
    let eccentricity = (1.0 - in_plane_m.length() / ellipse.semi_major_m).clamp(0.0, MOST_DRAGGED);
    let turned_deg = libm::atan2(in_plane_m.y, in_plane_m.x).to_degrees();
    let periapsis_deg = (old.periapsis_deg + turned_deg).rem_euclid(360.0);
    let Orbit { eccentricity, periapsis_deg, .. } = Orbit { eccentricity, periapsis_deg, ..old.clone() }.rounded();
    Some(Orbit { eccentricity, periapsis_deg, ..old })
}

fn draw_body(painter: &Painter, font: &egui::FontId, now: &Now<'_>, body: usize, at: Pos2) {
    let member = &now.system().bodies[body];
    let (radius, color) = match &member.light {
        Some(light) => {
            let [r, g, b] = light.color().map(|c| c as f32);
            (5.0, egui::Rgba::from_rgb(r, g, b).into())
        }
        None if now.here == Some(body) => (3.0, Color32::from_rgb(140, 190, 250)),
        None => (3.0, Color32::from_gray(190)),
    };
    painter.circle_filled(at, radius, color);
    let beside = at + Vec2::new(6.0, -6.0);
    painter.text(beside, egui::Align2::LEFT_BOTTOM, &member.name, font.clone(), Color32::from_gray(200));
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dragging_moves_a_body_and_its_periapsis_where_the_pointer_is() {
        let orbit = Orbit { eccentricity: 0.2, periapsis_deg: 30.0, ..Orbit::default() };
        let ellipse = Ellipse::new(&orbit, 1.327e20);
        let place_m = DVec2::new(-9e10, 4e10);
        let dragged = moved(Some(&orbit), &ellipse, place_m, 5e6).unwrap();
        let at_m = Ellipse::new(&dragged, 1.327e20).state(5e6).0.truncate();
        assert!((at_m - place_m).length() < 1e-4 * place_m.length(), "{at_m}");
        assert_eq!((dragged.eccentricity, dragged.periapsis_deg), (0.2, 30.0));

        let place_m = DVec2::new(3e10, 5e10);
        let pulled = stretched(Some(&orbit), &ellipse, place_m).unwrap();
        let ellipse = Ellipse::new(&pulled, 1.327e20);
        assert!((ellipse.at_anomaly(0.0).truncate() - place_m).length() < 2e-3 * place_m.length());
        assert_eq!(pulled.semi_major_km, orbit.semi_major_km);
        // Beyond the circle, the orbit stays a circle.
        assert_eq!(stretched(Some(&orbit), &ellipse, DVec2::X * 9e11).unwrap().eccentricity, 0.0);
    }
}
