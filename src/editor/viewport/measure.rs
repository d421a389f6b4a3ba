//! Measuring on the planet: the length of a line over the ground, its profile, and the area inside it.
//!
//! Lengths and areas are those of the reference sphere; heights are those of the ground that is drawn.

use super::ring::Ground;
use super::sculpt::Scene;
use crate::editor::widgets::number::length_text;
use crate::terrain::Terrain;
use eframe::egui::{self, Color32, Pos2, Rect, Stroke, pos2, vec2};
use glam::DVec3;
use std::sync::{Arc, Weak};

/// Places at which the profile has a height.
const SAMPLES: usize = 256;
/// Most points of a line.
const MOST_POINTS: usize = 64;
/// Size of the plot, in points of the window.
const PLOT: egui::Vec2 = vec2(300.0, 84.0);
const INK: Color32 = Color32::from_rgb(120, 220, 255);
const SEA: Color32 = Color32::from_rgb(70, 120, 220);

/// The line that is measured.
#[derive(Default)]
pub(super) struct Measure {
    points: Vec<DVec3>,
    /// Whether the last point follows the pointer.
    dragging: bool,
    /// Whether the next click begins another line.
    ended: bool,
    measured: Option<(Weak<Terrain>, Measured)>,
}

/// What a line measures.
#[derive(Clone, Debug, PartialEq)]
struct Measured {
    length_m: f64,
    /// Of the shape whose last side leads back to the first point; None for fewer than three points.
    area_m2: Option<f64>,
    /// Heights at equal distances.
    heights_m: Vec<f64>,
    sea_m: Option<f64>,
}

impl Measure {
    /// Takes drags and clicks: a drag measures a straight way, clicks add points, Enter or a double click ends the
    /// line, Escape forgets it.
    pub(super) fn handle(&mut self, ui: &egui::Ui, response: &egui::Response, scene: &Scene<'_>) {
        let (enter, escape, origin) =
            ui.input(|i| (i.key_pressed(egui::Key::Enter), i.key_pressed(egui::Key::Escape), i.pointer.press_origin()));
        if escape {
            *self = Self::default();
        }
        self.ended |= enter;
        if response.hovered() {
            ui.ctx().set_cursor_icon(egui::CursorIcon::Crosshair);
        }
        let at = |pos: Option<Pos2>| scene.ground(scene.surface, pos?);
        if response.drag_started_by(egui::PointerButton::Primary)
            && let Some(from) = at(origin)
        {
            (self.points, self.dragging, self.ended, self.measured) = (vec![from, from], true, false, None);
        }
        if self.dragging
            && let (Some(last), Some(to)) = (self.points.last_mut(), at(response.interact_pointer_pos()))
            && *last != to
        {
            (*last, self.measured) = (to, None);
        }
        if response.drag_stopped() {
            self.dragging = false;
        }
        if response.double_clicked() {
            self.ended = true;
        } else if response.clicked()
            && let Some(to) = at(response.interact_pointer_pos())
        {
            if std::mem::take(&mut self.ended) || self.points.len() >= MOST_POINTS {
                self.points.clear();
            }
            self.points.push(to);
            self.measured = None;
        }
    }

    /// Draws the line, its figures and its profile.
    pub(super) fn paint(&mut self, painter: &egui::Painter, ground: &Ground<'_>, terrain: &Arc<Terrain>) {
        if self.points.is_empty() {
            return;
        }
        let way = way(&self.points);
        ground.draw(painter, &way, Stroke::new(2.0, INK));
        for place in self.points.iter().filter_map(|dir| ground.on_screen(*dir)) {
            painter.circle(place, 3.5, INK, Stroke::new(1.0, Color32::BLACK));
        }
        if self.points.len() < 2 {
            return;
        }
        let known = self.measured.take().filter(|(of, _)| of.as_ptr() == Arc::as_ptr(terrain));
        let (_, measured) =
            self.measured.insert(known.unwrap_or_else(|| (Arc::downgrade(terrain), measure(terrain, &self.points))));
        // Above the scale.
        let corner = ground.rect.left_bottom() + vec2(12.0, -44.0);
        egui::Area::new(egui::Id::unique("measured"))
            .pivot(egui::Align2::LEFT_BOTTOM)
            .fixed_pos(corner)
            .interactable(false)
            .show(painter.ctx(), |ui| egui::Frame::popup(ui.style()).show(ui, |ui| figures(ui, measured)));
    }
}

/// Directions along the way through points, close enough together to be drawn.
fn way(points: &[DVec3]) -> Vec<DVec3> {
    let total_rad: f64 = points.windows(2).map(|pair| pair[0].angle_between(pair[1])).sum();
    let mut way = Vec::new();
    for pair in points.windows(2) {
        let angle_rad = pair[0].angle_between(pair[1]);
        let steps = (SAMPLES as f64 * angle_rad / total_rad.max(1e-30)).ceil().clamp(1.0, SAMPLES as f64) as usize;
        way.extend((0..steps).map(|step| along(pair[0], pair[1], step as f64 / steps as f64)));
    }
    way.extend(points.last());
    way
}

/// The direction at a share of the great arc between two.
fn along(from: DVec3, to: DVec3, share: f64) -> DVec3 {
    let angle_rad = from.angle_between(to);
    let sine = angle_rad.sin();
    if sine < 1e-9 {
        return from.lerp(to, share).normalize_or(from);
    }
    ((from * ((1.0 - share) * angle_rad).sin() + to * (share * angle_rad).sin()) / sine).normalize()
}

fn measure(terrain: &Terrain, points: &[DVec3]) -> Measured {
    let radius_m = terrain.planet().radius_m();
    let lengths_m: Vec<f64> = points.windows(2).map(|pair| pair[0].angle_between(pair[1]) * radius_m).collect();
    let length_m: f64 = lengths_m.iter().sum();
    let at = |share: f64| {
        let mut left_m = share * length_m;
        for (pair, side_m) in points.windows(2).zip(&lengths_m) {
            if left_m <= *side_m {
                return along(pair[0], pair[1], left_m / side_m.max(1e-9));
            }
            left_m -= side_m;
        }
        points.last().copied().unwrap_or(DVec3::Z)
    };
    let dirs: Vec<DVec3> = (0..SAMPLES).map(|i| at(i as f64 / (SAMPLES - 1) as f64)).collect();
    Measured {
        length_m,
        area_m2: (points.len() > 2).then(|| area_sr(points) * radius_m * radius_m),
        heights_m: terrain.heights_m(&dirs),
        sea_m: terrain.planet().sea_level_m(),
    }
}

/// The solid angle inside a shape, the smaller side of its outline: a fan of triangles (Van Oosterom and Strackee
/// 1983).
fn area_sr(points: &[DVec3]) -> f64 {
    let Some((&a, rest)) = points.split_first() else { return 0.0 };
    let triangle = |pair: &[DVec3]| {
        let (b, c) = (pair[0], pair[1]);
        2.0 * a.dot(b.cross(c)).atan2(1.0 + a.dot(b) + b.dot(c) + c.dot(a))
    };
    let area_sr = rest.windows(2).map(triangle).sum::<f64>().abs();
    area_sr.min((4.0 * std::f64::consts::PI - area_sr).abs())
}

/// Square kilometres, or square metres where the area is small.
fn area_text(area_m2: f64) -> String {
    if area_m2 < 1e5 { format!("{area_m2:.0} m²") } else { format!("{:.4} km²", area_m2 * 1e-6) }
}

fn figures(ui: &mut egui::Ui, measured: &Measured) {
    let Measured { length_m, area_m2, heights_m, sea_m } = measured;
    let [from_m, to_m] = [heights_m.first(), heights_m.last()].map(|height_m| height_m.copied().unwrap_or(0.0));
    let (lo, hi) = heights_m.iter().fold((f64::MAX, f64::MIN), |(lo, hi), h| (lo.min(*h), hi.max(*h)));
    let step_m = length_m / (heights_m.len().max(2) - 1) as f64;
    let steepest = heights_m.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max) / step_m.max(1e-9);
    ui.label(format!("Length {}", length_text(*length_m)));
    if let Some(area_m2) = area_m2 {
        ui.label(format!("Area {}", area_text(*area_m2)));
    }
    ui.label(format!("From {from_m:.0} m to {to_m:.0} m: {:+.0} m", to_m - from_m));
    ui.label(format!("Lowest {lo:.0} m, highest {hi:.0} m, steepest {:.1}°", steepest.atan().to_degrees()));
    let (rect, _) = ui.allocate_exact_size(PLOT, egui::Sense::hover());
    plot(&ui.painter_at(rect), rect.shrink(2.0), heights_m, (lo, hi), *sea_m);
}

/// Draws the profile, and the sea where it lies between the lowest and the highest ground.
fn plot(painter: &egui::Painter, rect: Rect, heights_m: &[f64], (lo, hi): (f64, f64), sea_m: Option<f64>) {
    painter.rect_filled(rect, 2.0, Color32::from_black_alpha(120));
    let span_m = (hi - lo).max(1e-3);
    let y = |height_m: f64| rect.bottom() - ((height_m - lo) / span_m) as f32 * (rect.height() - 4.0) - 2.0;
    let x = |i: usize| rect.left() + rect.width() * i as f32 / (heights_m.len().max(2) - 1) as f32;
    if let Some(sea_m) = sea_m.filter(|sea_m| (lo..=hi).contains(sea_m)) {
        painter.hline(rect.x_range(), y(sea_m), Stroke::new(1.0, SEA));
    }
    let line: Vec<Pos2> = heights_m.iter().enumerate().map(|(i, height_m)| pos2(x(i), y(*height_m))).collect();
    painter.line(line, Stroke::new(1.5, INK));
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;
    use crate::sphere::LatLon;

    fn at(lat_deg: f64, lon_deg: f64) -> DVec3 {
        LatLon::from_degrees(lat_deg, lon_deg).direction()
    }

    #[test]
    fn lengths_areas_and_profiles() -> Result<(), crate::planet::InvalidPlanet> {
        let planet = Planet { radius_km: 1000.0, ..Planet::default() };
        let terrain = Terrain::try_new(planet.into())?;
        let octant = measure(&terrain, &[at(0.0, 0.0), at(0.0, 90.0), at(90.0, 0.0)]);
        let quarter_m = 0.5 * std::f64::consts::PI * 1e6;
        assert!((octant.length_m - 2.0 * quarter_m).abs() < 1.0);
        let area_m2 = octant.area_m2.unwrap_or(0.0);
        assert!((area_m2 / (0.5 * std::f64::consts::PI * 1e12) - 1.0).abs() < 1e-9, "{area_m2}");
        assert_eq!(octant.heights_m.len(), SAMPLES);
        assert_eq!(octant.heights_m[0], terrain.height_m(at(0.0, 0.0)));
        let way = way(&[at(0.0, 0.0), at(0.0, 90.0)]);
        assert!((way[way.len() / 2].angle_between(at(0.0, 45.0))) < 0.01);
        Ok(())
    }
}
