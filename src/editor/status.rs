//! The status bar: what lies under the pointer, and true figures of what was drawn.

use super::app::EditorApp;
use super::performance::megabytes;
use super::widgets::number::{format_digits, length_text};
use crate::sphere::LatLon;
use eframe::egui;

/// Shows the bar.
pub fn show(ui: &mut egui::Ui, app: &EditorApp) {
    let viewport = app.viewport();
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 12.0;
        let (altitude_m, place) = viewport.eye(app.document().valid_planet());
        let left = match viewport.under_pointer() {
            Some(under) => format!(
                "{}   {}   {:.0}° steep   {}   {:.1} °C   moisture {:.2}",
                place_text(under.place),
                length_text(under.height_m),
                under.slope_deg,
                under.biome,
                under.temperature_c,
                under.moisture
            ),
            None => format!("Over {}", place_text(place)),
        };
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            figures(ui, app);
            ui.separator();
            ui.label(format!("Eye at {}", length_text(altitude_m))).on_hover_text("Height of the eye above the ground");
            ui.label(mode_text(app)).on_hover_text("How you move: F2 around the planet, F3 in free flight, F4 on foot");
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                ui.add(egui::Label::new(left).truncate())
                    .on_hover_text("Under the pointer: place, height, slope, biome, temperature, moisture");
            });
        });
    });
}

/// Right to left.
fn figures(ui: &mut egui::Ui, app: &EditorApp) {
    let viewport = app.viewport();
    let quality = viewport.settings.quality.label();
    ui.label(quality).on_hover_text(format!("Quality. Drawn by {}", app.adapter()));
    let frames = match viewport.frame_meter.interval_secs() {
        Some(secs) => format!("{:.0} fps, {:.1} ms", 1.0 / secs.max(1e-4), secs * 1000.0),
        None => "idle".to_owned(),
    };
    ui.label(frames).on_hover_text("Pictures a second while something moves; nothing is drawn while all is still");
    if let Some(duration) = viewport.edit_clock.last() {
        ui.label(format!("edit {:.1} ms", duration.as_secs_f64() * 1000.0))
            .on_hover_text("From the last edit to its complete picture");
    }
    let memory = viewport.memory();
    ui.label(format!("{:.0} MB", megabytes(memory.used_bytes as u64))).on_hover_text(format!(
        "Kept for later: {} tiles and {} layer fields, at most {:.0} MB",
        memory.tiles,
        memory.fields,
        megabytes(memory.budget_bytes as u64)
    ));
    if let Some(surface) = viewport.surface() {
        let stats = surface.stats;
        let drawn = viewport.stats();
        let busy = if viewport.is_busy() { " …" } else { "" };
        ui.label(format!("{} tiles, {}k vertices{busy}", stats.tiles, stats.vertices / 1000)).on_hover_text(format!(
            "{} tiles built in {:.1} ms; {} tiles and {} triangles drawn",
            stats.tiles_built,
            stats.duration_secs * 1000.0,
            drawn.tiles_drawn,
            drawn.triangles
        ));
    }
}

fn mode_text(app: &EditorApp) -> String {
    let cameras = app.viewport().cameras();
    let mut text = cameras.mode().label().to_owned();
    let factor = cameras.speed_factor();
    if (factor - 1.0).abs() > 0.01 {
        text += &format!(" ×{}", format_digits(factor, 2));
    }
    if app.viewport().settings.freeze_detail {
        text += ", detail frozen";
    }
    text
}

fn place_text(place: LatLon) -> String {
    let (lat_deg, lon_deg) = place.to_degrees();
    let ns = if lat_deg < 0.0 { "S" } else { "N" };
    let ew = if lon_deg < 0.0 { "W" } else { "E" };
    format!("{:.3}° {ns} {:.3}° {ew}", lat_deg.abs(), lon_deg.abs())
}
