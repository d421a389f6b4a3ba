//! What lies over the picture: the ways to move and to look, a compass with the star, a scale, a legend.

use crate::editor::command::{Command, Commands};
use crate::editor::commands;
use crate::editor::state::State;
use crate::editor::viewport::camera::Mode;
use crate::editor::widgets::number::{length_text, round_length_m};
use crate::editor::widgets::{color32, keys_text, menu_button};
use crate::render::{DebugView, Legend};
use crate::sphere::geo::east_north;
use eframe::egui::{self, Align2, Color32, Pos2, Rect, Stroke, pos2, vec2};
use std::f64::consts::TAU;

/// Room to the edges of the picture, points.
const ASIDE: f32 = 12.0;
/// Radius of the compass, and longest bar of the scale, points.
const COMPASS: f32 = 20.0;
const LONGEST_BAR: f32 = 130.0;
/// Size of a ramp in the legend, and side of a mark, points.
const RAMP: egui::Vec2 = vec2(180.0, 10.0);
const MARK: f32 = 11.0;
const ROW: f32 = 16.0;
/// Time for which the picture may be behind an edit without a word.
const PATIENCE_SECS: f32 = 0.8;
/// Most marks of a legend.
const MOST_MARKS: usize = 16;
const INK: Color32 = Color32::from_gray(225);
const FAINT: Color32 = Color32::from_gray(130);
/// Behind what is written over the picture.
const SHADE: Color32 = Color32::from_black_alpha(150);

/// Shows the overlay over the picture in `rect`.
pub fn show(ui: &mut egui::Ui, rect: Rect, state: &State, commands: &mut Commands) {
    if !state.shows.overlay || rect.width() < 200.0 || rect.height() < 160.0 {
        return;
    }
    chips(ui, rect, state, commands);
    compass(ui, rect, state);
    let mut bottom = rect.bottom() - ASIDE;
    if let Some(metres) = state.viewport.metres_per_point() {
        scale(ui, pos2(rect.left() + ASIDE, bottom), metres);
        bottom -= 30.0;
    }
    let view = state.viewport.settings.debug_view;
    let of_layer = state.viewport.layer_view().legend();
    let of_view = || match view {
        DebugView::Density => state.shown_population().map(Legend::of_density),
        _ => state.viewport.surface().and_then(|surface| Legend::of(view, &surface)),
    };
    if let Some(legend) = of_layer.or_else(of_view) {
        show_legend(ui, pos2(rect.left() + ASIDE, bottom), &legend);
    }
}

/// The mode of the camera and the debug view, as menus.
fn chips(ui: &mut egui::Ui, rect: Rect, state: &State, commands: &mut Commands) {
    let place = Rect::from_min_size(rect.min + egui::Vec2::splat(ASIDE), vec2(rect.width() - 120.0, 22.0));
    let layout = egui::Layout::left_to_right(egui::Align::Center);
    let ui = &mut ui.new_child(egui::UiBuilder::new().max_rect(place).layout(layout));
    let mode = state.viewport.cameras().mode();
    let view = state.viewport.settings.debug_view;
    let modes = Mode::ALL.map(Command::Move);
    let views = DebugView::ALL.map(Command::Show);
    for (name, now, choices) in [("Camera mode", mode.label(), &modes[..]), ("View", view.label(), &views[..])] {
        let response = menu_button(ui, now, |ui| {
            for row in choices.iter().filter_map(|command| commands::row(*command)) {
                let button = egui::Button::selectable(row.is_chosen(state) == Some(true), row.label);
                let keys = row.shortcuts.first().map(|keys| keys_text(ui.ctx(), keys)).unwrap_or_default();
                if ui.add(button.shortcut_text(keys)).on_hover_text(row.tooltip).clicked() {
                    commands.send(row.command);
                    ui.close();
                }
            }
        })
        .response;
        response.on_hover_text(format!("{name}: click to change")).accessible_name(format!("{name}: {now}"));
    }
    if view != DebugView::Shaded
        && let Some(row) = commands::row(Command::Show(DebugView::Shaded))
        && ui.button("Back to shaded").on_hover_text(row.tooltip).clicked()
    {
        commands.send(row.command);
    }
    if let Some(told) = working(state) {
        let text = egui::RichText::new(told).color(INK).background_color(SHADE).size(11.5);
        ui.add(egui::Label::new(text).selectable(false));
        ui.ctx().request_repaint_after_secs(0.25);
    } else if state.viewport.is_busy() {
        ui.ctx().request_repaint_after_secs(PATIENCE_SECS);
    }
}

/// What the picture waits for, once that takes long.
fn working(state: &State) -> Option<String> {
    let waiting_secs = state.viewport.waiting().filter(|_| state.viewport.is_busy())?.as_secs_f32();
    (waiting_secs > PATIENCE_SECS).then(|| format!("Building… {waiting_secs:.0} s"))
}

/// A ring with north and the star: up is where the eye looks.
fn compass(ui: &egui::Ui, rect: Rect, state: &State) {
    let planet = state.document.valid_planet();
    let pose = state.viewport.pose(planet);
    let heading_rad = pose.bookmark(String::new(), 0.0).heading_deg.to_radians();
    let star = state.viewport.star_dir_planet(planet);
    let up = pose.up();
    let (east, north) = east_north(up);
    let star_rad = f64::atan2(star.dot(east), star.dot(north));
    let middle = pos2(rect.right() - ASIDE - COMPASS - 6.0, rect.top() + ASIDE + COMPASS + 6.0);
    let at = |bearing_rad: f64, radius: f32| {
        // Clockwise from the top.
        let turn = (bearing_rad - heading_rad - TAU / 4.0) as f32;
        middle + radius * egui::Vec2::angled(turn)
    };
    let painter = ui.painter_at(rect);
    painter.circle(middle, COMPASS + 6.0, SHADE, Stroke::NONE);
    painter.circle_stroke(middle, COMPASS, Stroke::new(1.0, FAINT));
    for quarter in 1..4 {
        let bearing = f64::from(quarter) * TAU / 4.0;
        painter.line_segment([at(bearing, COMPASS - 4.0), at(bearing, COMPASS)], Stroke::new(1.0, FAINT));
    }
    let needle = vec![at(0.0, COMPASS - 2.0), at(TAU / 4.0, 4.0), at(-TAU / 4.0, 4.0)];
    painter.add(egui::Shape::convex_polygon(needle, Color32::from_rgb(205, 70, 60), Stroke::NONE));
    painter.text(at(0.5 * TAU, COMPASS * 0.45), Align2::CENTER_CENTER, "N", small(ui), INK);
    let is_up = star.dot(up) > 0.0;
    let color = Color32::from_rgb(250, 205, 95);
    let (fill, line) = if is_up { (color, Color32::TRANSPARENT) } else { (SHADE, color.gamma_multiply(0.7)) };
    painter.circle(at(star_rad, COMPASS), 4.0, fill, Stroke::new(1.2, line));
    let response = ui.interact(
        Rect::from_center_size(middle, egui::Vec2::splat(2.0 * COMPASS)),
        egui::Id::unique("compass"),
        egui::Sense::hover(),
    );
    let height_deg = star.dot(up).clamp(-1.0, 1.0).asin().to_degrees();
    let below = if is_up { "above" } else { "below" };
    response.on_hover_text(format!(
        "Heading {:.0}°. The red needle points north, the yellow dot to the star, {:.0}° {below} the horizon",
        heading_rad.to_degrees(),
        height_deg.abs(),
    ));
}

/// A bar of a round length.
fn scale(ui: &egui::Ui, left: Pos2, metres_per_point: f64) {
    let length_m = round_length_m(metres_per_point * f64::from(LONGEST_BAR));
    let width = (length_m / metres_per_point) as f32;
    let painter = ui.painter();
    painter.rect_filled(Rect::from_min_max(left - vec2(6.0, 22.0), left + vec2(width + 6.0, 6.0)), 3.0, SHADE);
    let line = Stroke::new(1.5, INK);
    painter.line_segment([left, left + vec2(width, 0.0)], line);
    for x in [0.0, width] {
        painter.line_segment([left + vec2(x, -5.0), left + vec2(x, 0.0)], line);
    }
    let text = left + vec2(0.5 * width, -7.0);
    painter.text(text, Align2::CENTER_BOTTOM, length_text(length_m), small(ui), INK);
}

fn show_legend(ui: &egui::Ui, bottom: Pos2, legend: &Legend) {
    let painter = ui.painter();
    match legend {
        Legend::Ramp { colors, ends } => {
            let bar = Rect::from_min_size(bottom - vec2(0.0, 20.0 + RAMP.y), RAMP);
            painter.rect_filled(bar.expand2(vec2(6.0, 4.0)).with_max_y(bottom.y + 2.0), 3.0, SHADE);
            let mut mesh = egui::Mesh::default();
            let steps = (colors.len() - 1).max(1) as f32;
            for (number, color) in colors.iter().enumerate() {
                let x = bar.left() + bar.width() * number as f32 / steps;
                mesh.colored_vertex(pos2(x, bar.top()), color32(*color));
                mesh.colored_vertex(pos2(x, bar.bottom()), color32(*color));
            }
            for number in 0..colors.len().saturating_sub(1) as u32 {
                mesh.add_triangle(2 * number, 2 * number + 1, 2 * number + 2);
                mesh.add_triangle(2 * number + 1, 2 * number + 2, 2 * number + 3);
            }
            painter.add(mesh);
            let below = bar.bottom() + 3.0;
            painter.text(pos2(bar.left(), below), Align2::LEFT_TOP, &ends[0], small(ui), INK);
            painter.text(pos2(bar.right(), below), Align2::RIGHT_TOP, &ends[1], small(ui), INK);
        }
        Legend::Marks(marks) => {
            let shown = marks.len().min(MOST_MARKS);
            let top = bottom - vec2(0.0, ROW * shown as f32);
            painter.rect_filled(Rect::from_min_max(top - vec2(6.0, 4.0), bottom + vec2(150.0, 2.0)), 3.0, SHADE);
            for (number, (color, text)) in marks.iter().take(shown).enumerate() {
                let at = top + vec2(0.0, ROW * number as f32);
                painter.rect_filled(Rect::from_min_size(at, egui::Vec2::splat(MARK)), 2.0, color32(*color));
                painter.text(at + vec2(MARK + 6.0, -1.0), Align2::LEFT_TOP, text, small(ui), INK);
            }
        }
    }
}

fn small(ui: &egui::Ui) -> egui::FontId {
    egui::FontId { size: 11.5, ..egui::TextStyle::Body.resolve(ui.style()) }
}
