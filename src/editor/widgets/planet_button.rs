//! The small picture of a planet as a button.

use crate::editor::state::sheet::Cell;
use eframe::egui;

/// Shows the button; `name` is its accessible name.
pub fn planet_button(ui: &mut egui::Ui, cell: &Cell, name: &str, told: &str, side: f32) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(side), egui::Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), name));
    let visuals = ui.style().interact(&response);
    let painter = ui.painter();
    painter.rect_filled(rect, 3.0, egui::Color32::BLACK);
    let mut why = None;
    match &cell.picture {
        Some(Ok(texture)) => {
            let whole = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
            painter.image(texture.id(), rect, whole, egui::Color32::WHITE);
        }
        Some(Err(error)) => {
            let color = egui::Color32::from_gray(150);
            let font = egui::TextStyle::Body.resolve(ui.style());
            painter.text(rect.center(), egui::Align2::CENTER_CENTER, "no picture", font, color);
            why = Some(error);
        }
        None => {
            painter.circle_stroke(rect.center(), 0.45 * side, egui::Stroke::new(1.0, egui::Color32::from_gray(60)));
        }
    }
    if response.hovered() || response.has_focus() {
        painter.rect_stroke(rect, 3.0, (2.0, visuals.fg_stroke.color), egui::StrokeKind::Inside);
    }
    response.on_hover_ui(|ui| {
        ui.label(told);
        if let Some(why) = why {
            ui.weak(why);
        }
    })
}
