//! The inspector: all that is known of the place under the pointer, or of a place that is held while one edits.

use super::look;
use super::status::location_text;
use crate::editor::command::{Action, Command, Commands, Window};
use crate::editor::commands;
use crate::editor::state::State;
use crate::editor::viewport::pointer::KnownPlace;
use crate::editor::widgets::number::{format_digits, length_text};
use crate::editor::widgets::{color32, keys_text};
use crate::planet::Planet;
use crate::sphere::geo::east_north;
use eframe::egui::{self, Rect, Sense, pos2, vec2};

/// Width of the window and of a bar, in points.
const WIDTH: f32 = 300.0;
const BAR_WIDTH: f32 = 84.0;
/// Winds with a name, clockwise from north.
const WINDS: [&str; 8] = ["north", "north-east", "east", "south-east", "south", "south-west", "west", "north-west"];

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("inspector window")
}

/// Shows the window if it is open.
pub fn show(ctx: &egui::Context, state: &State, commands: &mut Commands) {
    let mut open = state.shows.inspector;
    let window = egui::Window::new("Inspector").id(id()).open(&mut open).resizable(false);
    window.default_pos(look::WINDOW_POS).show(ctx, |ui| {
        ui.set_width(WIDTH);
        let inspector = &state.viewport.inspector;
        let keys = |command| {
            let shortcut = commands::row(command).and_then(|row| row.shortcuts.first());
            shortcut.map(|shortcut| keys_text(ctx, shortcut)).unwrap_or_default()
        };
        let hold_keys = keys(Command::HoldPlace);
        let Some(place) = inspector.place() else {
            ui.weak(format!(
                "Point at the planet. {hold_keys} holds the place, so that you see what an edit does there."
            ));
            return;
        };
        head(ui, place, inspector.is_held(), &hold_keys, commands);
        let room = (ctx.content_rect().height() - 150.0).max(100.0);
        // Without a least height, egui scrolls from 400 points on.
        egui::ScrollArea::vertical().max_height(room).min_scrolled_height(room).show(ui, |ui| {
            let planet = state.document.valid_planet();
            egui::Grid::new("place").num_columns(2).spacing([12.0, 3.0]).show(ui, |ui| facts(ui, place, planet));
            if planet.giant.is_none() {
                ui.separator();
                height_parts(ui, place, planet);
            }
        });
    });
    if open != state.shows.inspector {
        commands.push(Action::Close(Window::Inspector));
    }
}

fn head(ui: &mut egui::Ui, place: &KnownPlace, is_held: bool, keys: &str, commands: &mut Commands) {
    ui.horizontal(|ui| {
        ui.strong(location_text(place.location));
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let hold = ui.selectable_label(is_held, if is_held { "Held" } else { "Hold" });
            let told = format!("Stay at this place while the pointer moves and the planet changes ({keys})");
            if hold.on_hover_text(told).clicked() {
                commands.send(Command::HoldPlace);
            }
            let (lat_deg, lon_deg) = place.location.to_degrees();
            if ui.button("Copy").on_hover_text("Copy latitude and longitude, as Go to place reads them").clicked() {
                ui.ctx().copy_text(format!("{lat_deg:.6}, {lon_deg:.6}"));
            }
        });
    });
}

fn facts(ui: &mut egui::Ui, place: &KnownPlace, planet: &Planet) {
    let sample = &place.sample;
    let mut row = |name: &str, value: String| {
        ui.weak(name);
        ui.label(value);
        ui.end_row();
    };
    if planet.giant.is_some() {
        row("Ground", "none: a gas giant".to_owned());
        clouds(place, &mut row);
        return;
    }
    row("Height", length_text(sample.height_m));
    row("Slope", format!("{:.1}°", sample.slope_rad.to_degrees()));
    if let Some(level_m) = sample.water_level_m {
        let kind = if sample.lake.is_some() {
            "lake"
        } else if planet.sea_level_m() == Some(level_m) {
            "sea"
        } else {
            "river"
        };
        row("Water", format!("{kind}, {} deep", length_text(level_m - sample.height_m)));
    }
    if let Some(river) = &sample.river {
        row("River", format!("{} away, {} wide", length_text(river.distance_m), length_text(river.width_m)));
        row("Discharge", format!("{} m³/s", format_digits(river.discharge_m3_s, 3)));
    }
    row("Temperature", format!("{:.1} °C", sample.temperature_c));
    row("Moisture", format!("{:.2}", sample.moisture));
    row("Rain and snow", format!("{:.0} mm a year", sample.rain_mm));
    let speed_m_s = sample.wind_planet_m_s.length();
    if speed_m_s > 0.0 {
        let (east, north) = east_north(place.location.direction());
        // A wind has the name of where it comes from.
        let from_rad = f64::atan2(-sample.wind_planet_m_s.dot(east), -sample.wind_planet_m_s.dot(north));
        let eighth = (from_rad.to_degrees() / 45.0).round().rem_euclid(8.0) as usize;
        row("Wind", format!("{speed_m_s:.1} m/s from {}", WINDS[eighth % 8]));
    }
    clouds(place, &mut row);
    if let Some(plate) = sample.plate {
        row("Plate", plate.to_string());
    }
    ui.weak("Biome");
    ui.horizontal(|ui| {
        if let Some(biome) = planet.biomes.palette.get(sample.biome) {
            let (swatch, _) = ui.allocate_exact_size(vec2(12.0, 12.0), Sense::hover());
            ui.painter().rect_filled(swatch, 3.0, color32(biome.color));
        }
        let [column, row] = sample.cell;
        ui.label(&place.biome).on_hover_text(format!("Column {} and row {} of the biome table", column + 1, row + 1));
    });
    ui.end_row();
}

fn clouds(place: &KnownPlace, row: &mut impl FnMut(&str, String)) {
    let Some(cover) = place.cover else { return };
    let kinds = [("low", cover.low), ("middle", cover.middle), ("veil", cover.veil), ("fog", cover.fog)];
    let shares =
        kinds.iter().filter(|(_, share)| *share >= 0.005).map(|(kind, share)| format!("{kind} {:.0} %", share * 100.0));
    let told: Vec<String> = shares.collect();
    row("Clouds", if told.is_empty() { "none".to_owned() } else { told.join(", ") });
}

/// What each layer adds, and the rest, as numbers and bars from a common zero.
fn height_parts(ui: &mut egui::Ui, place: &KnownPlace, planet: &Planet) {
    let named = planet.layers.iter().zip(&place.layers_m).filter(|(layer, _)| layer.enabled);
    let mut parts: Vec<(&str, f64)> = named.map(|(layer, change_m)| (layer.name.as_str(), *change_m)).collect();
    let rest_m = place.sample.height_m - parts.iter().map(|(_, change_m)| change_m).sum::<f64>();
    // Sums of layers are exact to far less than a millimetre.
    if rest_m.abs() > 1e-3 {
        parts.push(("All else", rest_m));
    }
    if parts.is_empty() {
        ui.weak("No layer is on.");
        return;
    }
    let most_m = parts.iter().fold(1e-9, |most: f64, (_, change_m)| most.max(change_m.abs()));
    egui::Grid::new("parts of the height").num_columns(3).spacing([8.0, 2.0]).show(ui, |ui| {
        for (name, change_m) in parts {
            ui.allocate_ui(vec2(110.0, 16.0), |ui| {
                let label = ui.add(egui::Label::new(name).truncate());
                if name == "All else" {
                    label.on_hover_text("Structure, relief of biomes, ground edits, the height curve and limits");
                }
            });
            bar(ui, change_m / most_m);
            let sign = if change_m < 0.0 { "−" } else { "+" };
            ui.label(format!("{sign}{}", length_text(change_m.abs())));
            ui.end_row();
        }
    });
}

/// A bar to the right for what raises the ground, to the left for what lowers it.
fn bar(ui: &mut egui::Ui, share: f64) {
    let (rect, _) = ui.allocate_exact_size(vec2(BAR_WIDTH, 10.0), Sense::hover());
    let (middle, end) = (rect.center().x, rect.center().x + 0.5 * rect.width() * share as f32);
    let painter = ui.painter();
    painter.rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
    let filled = Rect::from_min_max(pos2(middle.min(end), rect.top()), pos2(middle.max(end), rect.bottom()));
    let color = if share < 0.0 { egui::Color32::from_rgb(70, 130, 220) } else { egui::Color32::from_rgb(214, 106, 62) };
    painter.rect_filled(filled, 1.0, color);
    painter.vline(middle, rect.y_range(), ui.visuals().widgets.noninteractive.bg_stroke);
}
