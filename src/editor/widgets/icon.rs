//! Small icons, drawn as lines: they need no font, and are sharp at every scale.

use eframe::egui::{self, Color32, Pos2, Rect, Shape, Stroke, StrokeKind, pos2, vec2};
use std::f32::consts::TAU;

/// An icon.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Icon {
    Reset,
    Dice,
    Play,
    Pause,
    Up,
    Down,
    Duplicate,
    Remove,
    Close,
    Lock,
    Open,
}

/// A button with an icon; `name` is its accessible name.
pub fn icon_button(ui: &mut egui::Ui, icon: Icon, name: &str, tooltip: &str) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(vec2(20.0, 20.0), egui::Sense::click());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), name));
    if ui.is_rect_visible(rect) {
        let visuals = ui.style().interact(&response);
        if response.hovered() || response.has_focus() {
            ui.painter().rect_filled(rect, visuals.corner_radius, visuals.weak_bg_fill);
        }
        paint(ui.painter(), icon, Rect::from_center_size(rect.center(), vec2(12.0, 12.0)), visuals.fg_stroke.color);
    }
    response.on_hover_text(tooltip)
}

/// An icon that is no button, faint.
pub fn icon(ui: &mut egui::Ui, icon: Icon, tooltip: &str) {
    let (rect, response) = ui.allocate_exact_size(vec2(20.0, 20.0), egui::Sense::hover());
    mark(ui, icon, Rect::from_center_size(rect.center(), vec2(12.0, 12.0)));
    response.on_hover_text(tooltip);
}

/// An icon on top of what is at a place, faint.
pub fn mark(ui: &egui::Ui, icon: Icon, rect: Rect) {
    if ui.is_rect_visible(rect) {
        paint(ui.painter(), icon, rect, ui.visuals().weak_text_color());
    }
}

fn paint(painter: &egui::Painter, icon: Icon, rect: Rect, color: Color32) {
    let stroke = Stroke::new(1.3, color);
    let at = |x: f32, y: f32| pos2(rect.left() + x * rect.width(), rect.top() + y * rect.height());
    let line = |points: Vec<Pos2>| painter.add(Shape::line(points, stroke));
    let solid = |points: Vec<Pos2>| painter.add(Shape::convex_polygon(points, color, Stroke::NONE));
    match icon {
        Icon::Reset => {
            // Three quarters of a circle that end in an arrow head.
            let point = |turn: f32| rect.center() + 0.42 * rect.width() * egui::Vec2::angled(turn * TAU);
            line((0..=18).map(|i| point(-0.12 - 0.75 * i as f32 / 18.0)).collect());
            solid(vec![at(0.62, 0.20), at(1.0, 0.05), at(0.98, 0.46)]);
        }
        Icon::Dice => {
            painter.rect_stroke(rect, 2.0, stroke, StrokeKind::Inside);
            for (x, y) in [(0.28, 0.28), (0.72, 0.72), (0.5, 0.5), (0.72, 0.28), (0.28, 0.72)] {
                painter.circle_filled(at(x, y), 1.1, color);
            }
        }
        Icon::Play => {
            solid(vec![at(0.2, 0.05), at(0.95, 0.5), at(0.2, 0.95)]);
        }
        Icon::Pause => {
            painter.rect_filled(Rect::from_min_max(at(0.15, 0.05), at(0.4, 0.95)), 0.0, color);
            painter.rect_filled(Rect::from_min_max(at(0.6, 0.05), at(0.85, 0.95)), 0.0, color);
        }
        Icon::Up => {
            solid(vec![at(0.5, 0.2), at(0.95, 0.8), at(0.05, 0.8)]);
        }
        Icon::Down => {
            solid(vec![at(0.05, 0.2), at(0.95, 0.2), at(0.5, 0.8)]);
        }
        Icon::Duplicate => {
            painter.rect_stroke(Rect::from_min_max(at(0.0, 0.3), at(0.7, 1.0)), 1.0, stroke, StrokeKind::Inside);
            line(vec![at(0.3, 0.15), at(0.3, 0.03), at(0.97, 0.03), at(0.97, 0.7), at(0.85, 0.7)]);
        }
        Icon::Close => {
            line(vec![at(0.15, 0.15), at(0.85, 0.85)]);
            line(vec![at(0.85, 0.15), at(0.15, 0.85)]);
        }
        Icon::Lock | Icon::Open => {
            painter.rect_filled(Rect::from_min_max(at(0.15, 0.48), at(0.85, 1.0)), 1.0, color);
            // The shackle; of an open lock its right end is in the air.
            let end = if icon == Icon::Lock { 0.48 } else { 0.3 };
            line(vec![at(0.28, 0.48), at(0.28, 0.22), at(0.4, 0.05), at(0.6, 0.05), at(0.72, 0.22), at(0.72, end)]);
        }
        Icon::Remove => {
            line(vec![at(0.0, 0.2), at(1.0, 0.2)]);
            line(vec![at(0.35, 0.2), at(0.35, 0.03), at(0.65, 0.03), at(0.65, 0.2)]);
            line(vec![at(0.14, 0.2), at(0.22, 0.98), at(0.78, 0.98), at(0.86, 0.2)]);
        }
    }
}
