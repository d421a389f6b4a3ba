//! The status bar: the ground under the pointer, and figures of the picture.

use crate::editor::state::State;
use crate::editor::viewport::Viewport;
use crate::editor::viewport::pointer::KnownPlace;
use crate::editor::widgets::number::{format_digits, length_text, megabytes};
use crate::sphere::LatLon;
use eframe::egui;

/// Shows the bar.
pub fn show(ui: &mut egui::Ui, state: &State) {
    let viewport = &state.viewport;
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 12.0;
        let (altitude_m, location) = viewport.eye(state.document.valid_planet());
        let left = match viewport.under_pointer() {
            Some(under) => ground_text(under, state.document.valid_planet().atmosphere.is_some()),
            None => format!("Over {}", location_text(location)),
        };
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            figures(ui, state);
            ui.separator();
            ui.label(format!("Eye at {}", length_text(altitude_m))).on_hover_text("Height of the eye above the ground");
            ui.label(mode_text(state)).on_hover_text("How the camera moves: F2 orbit, F3 free flight, F4 walk");
            ui.with_layout(egui::Layout::left_to_right(egui::Align::Center), |ui| {
                ui.add(egui::Label::new(left).truncate())
                    .on_hover_text("Under the pointer: location, height, slope, biome, temperature, moisture");
            });
        });
    });
}

/// What is known of a place. Of ground under water the biome says nothing, and without air nothing is moist.
fn ground_text(under: &KnownPlace, has_air: bool) -> String {
    let (place, sample) = (location_text(under.location), &under.sample);
    if let Some(depth_m) =
        sample.water_level_m.map(|level_m| level_m - sample.height_m).filter(|depth_m| *depth_m > 0.0)
    {
        return format!("{place}   {} under water   {:.1} °C", length_text(depth_m), sample.temperature_c);
    }
    let moisture = if has_air { format!("   moisture {:.2}", sample.moisture) } else { String::new() };
    format!(
        "{place}   {}   {:.0}° steep   {}   {:.1} °C{moisture}",
        length_text(sample.height_m),
        sample.slope_rad.to_degrees(),
        under.biome,
        sample.temperature_c,
    )
}

/// Right to left: the quality, what the picture is doing, and the time of the last edit. The figures behind it are in
/// its tooltip and in the window of the performance.
fn figures(ui: &mut egui::Ui, state: &State) {
    let viewport = &state.viewport;
    let quality = viewport.settings.quality.label();
    ui.label(quality).on_hover_text(format!("Quality. Drawn by {}", state.adapter));
    let now = match (viewport.frame_meter.interval_secs(), viewport.refinement()) {
        _ if viewport.is_busy() => "building…".to_owned(),
        (Some(secs), _) => format!("{:.0} fps", 1.0 / secs.max(1e-4)),
        (None, Some((drawn, most))) if 0 < drawn && drawn < most => format!("refining {drawn}/{most}"),
        _ => "idle".to_owned(),
    };
    ui.label(now).on_hover_ui(|ui| figures_of(ui, viewport));
    if let Some(duration) = viewport.edit_clock.last() {
        ui.label(format!("edit {:.0} ms", duration.as_secs_f64() * 1000.0))
            .on_hover_text("From the last edit to its complete picture");
    }
}

fn figures_of(ui: &mut egui::Ui, viewport: &Viewport) {
    ui.label(
        "Pictures a second while something moves, then samples of the still picture. Nothing is drawn while nothing \
         changes.",
    );
    if let Some(secs) = viewport.frame_meter.interval_secs() {
        ui.label(format!("{:.1} ms from picture to picture", secs * 1000.0));
    }
    if let Some(surface) = viewport.surface() {
        let (stats, drawn) = (surface.stats, viewport.stats());
        ui.label(format!(
            "{} tiles with {}k vertices; {} built in {:.1} ms; {} tiles and {} triangles drawn",
            stats.tiles,
            stats.vertices / 1000,
            stats.tiles_built,
            stats.duration_secs * 1000.0,
            drawn.tiles_drawn,
            drawn.triangles
        ));
    }
    let memory = viewport.memory();
    ui.label(format!(
        "In the cache: {} tiles and {} layer fields, {:.0} of at most {:.0} MB",
        memory.tiles,
        memory.fields,
        megabytes(memory.used_bytes as u64),
        megabytes(memory.budget_bytes as u64)
    ));
}

fn mode_text(state: &State) -> String {
    let cameras = state.viewport.cameras();
    let mut text = cameras.mode().label().to_owned();
    let factor = cameras.speed_factor();
    if (factor - 1.0).abs() > 0.01 {
        text += &format!(" ×{}", format_digits(factor, 2));
    }
    if state.viewport.settings.freeze_detail {
        text += ", detail frozen";
    }
    text
}

/// Latitude and longitude in degrees.
pub fn location_text(location: LatLon) -> String {
    let (lat_deg, lon_deg) = location.to_degrees();
    let ns = if lat_deg < 0.0 { "S" } else { "N" };
    let ew = if lon_deg < 0.0 { "W" } else { "E" };
    format!("{:.3}° {ns} {:.3}° {ew}", lat_deg.abs(), lon_deg.abs())
}
