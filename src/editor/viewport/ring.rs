//! The ring of a brush on the ground, and the points of an edit.

use super::handles::radius_dir;
use super::outline::{in_rect, project};
use crate::editor::widgets::number::length_text;
use crate::lod::View;
use crate::planet::{EditPoint, GroundEdit};
use crate::sphere::geo::east_north;
use crate::terrain::Terrain;
use eframe::egui::{self, Align2, Color32, Painter, Pos2, Rect, Stroke, vec2};
use glam::DVec3;
use std::f64::consts::TAU;

/// Sides of a ring.
const SIDES: usize = 72;
/// Most points of an edit that are drawn.
const MOST_POINTS: usize = 400;
const INK: Color32 = Color32::from_rgb(255, 214, 90);
const FAINT: Color32 = Color32::from_rgba_premultiplied(128, 107, 45, 128);

/// The ground on screen.
pub(super) struct Ground<'a> {
    pub(super) terrain: &'a Terrain,
    pub(super) view: &'a View,
    pub(super) rect: Rect,
}

impl Ground<'_> {
    /// Places on the ground or the sea.
    fn places_m(&self, dirs: &[DVec3]) -> Vec<DVec3> {
        let (radius_m, sea_m) = (self.terrain.planet().radius_m(), self.terrain.planet().sea_level_m());
        let heights_m = self.terrain.heights_m(dirs);
        dirs.iter()
            .zip(heights_m)
            .map(|(dir, height_m)| *dir * (radius_m + height_m.max(sea_m.unwrap_or(f64::MIN))))
            .collect()
    }

    /// Whether a place is on the side of the planet that the eye sees.
    fn is_seen(&self, place_m: DVec3) -> bool {
        place_m.dot(self.view.camera.position_planet_m - place_m) > 0.0
    }

    /// Radius of the planet.
    pub(super) fn radius_m(&self) -> f64 {
        self.terrain.planet().radius_m()
    }

    /// Where the ground under a direction is in the window, if it is on the side that the eye sees.
    pub(super) fn on_screen(&self, dir: DVec3) -> Option<Pos2> {
        let place_m = self.places_m(&[dir]).pop()?;
        self.is_seen(place_m).then(|| self.line(place_m, place_m * (1.0 + 1e-9)))?.map(|[from, _]| from)
    }

    fn line(&self, from: DVec3, to: DVec3) -> Option<[Pos2; 2]> {
        Some(project(self.view, from, to)?.map(|point| in_rect(self.rect, point)))
    }

    /// Draws lines from place to place.
    pub(super) fn draw(&self, painter: &Painter, dirs: &[DVec3], stroke: Stroke) {
        let places_m = self.places_m(dirs);
        for pair in places_m.windows(2).filter(|pair| self.is_seen(pair[0]) && self.is_seen(pair[1])) {
            if let Some(line) = self.line(pair[0], pair[1]) {
                painter.line_segment(line, stroke);
            }
        }
    }

    fn ring(&self, painter: &Painter, middle: DVec3, radius_m: f64, stroke: Stroke) {
        let angle_rad = (radius_m / self.terrain.planet().radius_m()).min(3.0);
        let (east, north) = east_north(middle);
        let around = |i: usize| {
            let (sin, cos) = (i as f64 / SIDES as f64 * TAU).sin_cos();
            middle * angle_rad.cos() + (east * cos + north * sin) * angle_rad.sin()
        };
        let dirs: Vec<DVec3> = (0..=SIDES).map(around).collect();
        self.draw(painter, &dirs, stroke);
    }
}

/// Draws the brush: where it ends, where it begins to fade, and its radius in words.
pub(super) fn paint_brush(painter: &Painter, ground: &Ground<'_>, middle: DVec3, radius_m: f64, softness: f64) {
    ground.ring(painter, middle, radius_m, Stroke::new(1.5, INK));
    if softness > 0.02 && softness < 0.98 {
        ground.ring(painter, middle, radius_m * (1.0 - softness), Stroke::new(1.0, FAINT));
    }
    if let Some(place) = ground.on_screen(middle) {
        let text = length_text(radius_m);
        let font = egui::FontId::proportional(12.0);
        for (offset, color) in [(vec2(15.0, 15.0), Color32::from_black_alpha(200)), (vec2(14.0, 14.0), INK)] {
            painter.text(place + offset, Align2::LEFT_TOP, &text, font.clone(), color);
        }
    }
}

/// Draws where an image of the brush by symmetry ends.
pub(super) fn paint_image(painter: &Painter, ground: &Ground<'_>, middle: DVec3, radius_m: f64) {
    ground.ring(painter, middle, radius_m, Stroke::new(1.0, FAINT));
}

/// Draws the points of an edit and the way between them; of a stamp, its ring.
pub(super) fn paint_edit(painter: &Painter, ground: &Ground<'_>, edit: &GroundEdit) {
    let dirs: Vec<DVec3> = edit.points.0.iter().take(MOST_POINTS).map(EditPoint::direction).collect();
    if edit.tool.is_stamp() {
        let spread_km = if edit.copies > 1 { edit.spread_km } else { 0.0 };
        for radius_km in [edit.radius_km, spread_km].into_iter().filter(|radius_km| *radius_km > 0.0) {
            dirs.iter().for_each(|dir| ground.ring(painter, *dir, radius_km * 1000.0, Stroke::new(1.0, FAINT)));
        }
    } else {
        ground.draw(painter, &dirs, Stroke::new(1.0, FAINT));
    }
    for image in edit.images() {
        let dirs: Vec<DVec3> = dirs.iter().map(|dir| image.of(*dir)).collect();
        match edit.tool.is_stamp() {
            true => dirs.iter().for_each(|dir| paint_image(painter, ground, *dir, edit.radius_km * 1000.0)),
            false => ground.draw(painter, &dirs, Stroke::new(1.0, FAINT)),
        }
    }
    for place in dirs.iter().filter_map(|dir| ground.on_screen(*dir)) {
        painter.circle(place, 3.5, INK, Stroke::new(1.0, Color32::BLACK));
    }
    if let Some(place) = radius_dir(edit, ground.radius_m()).and_then(|dir| ground.on_screen(dir)) {
        let square = Rect::from_center_size(place, vec2(7.0, 7.0));
        painter.rect(square, 0.0, INK, Stroke::new(1.0, Color32::BLACK), egui::StrokeKind::Outside);
    }
}
