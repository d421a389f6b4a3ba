//! Rows of choices that maps, meshes and tiles share.

use crate::bake::{Bake, Detail, Region};
use crate::editor::state::State;
use crate::editor::state::bake_settings::BakeSettings;
use crate::editor::widgets::typed::{Allowed, plain_field};
use crate::planet::Planet;
use crate::planet::param::Unit;
use eframe::egui;

/// The centre and the side of a region.
pub(super) fn region(ui: &mut egui::Ui, region: &mut Region, state: &State) {
    let planet = state.document.valid_planet();
    let degrees = |most: f64| Allowed::numbers(Unit::Degrees, -most, most);
    ui.label("Centre");
    ui.horizontal(|ui| {
        plain_field(ui, &mut region.lat_deg, 0.1, 4, degrees(90.0)).accessible_name("Latitude of region");
        plain_field(ui, &mut region.lon_deg, 0.1, 4, degrees(180.0)).accessible_name("Longitude of region");
        if ui.button("Here").on_hover_text("The place in the middle of the picture").clicked() {
            (region.lat_deg, region.lon_deg) = state.viewport.looked_at(planet).0.to_degrees();
        }
    });
    ui.end_row();
    ui.label("Side");
    let most_km = Bake::longest_side_km(planet.radius_km);
    region.side_km = region.side_km.min(most_km);
    let speed = region.side_km * 0.01;
    plain_field(ui, &mut region.side_km, speed, 3, Allowed::numbers(Unit::Kilometres, 1e-3, most_km))
        .accessible_name("Side of region");
    ui.end_row();
}

/// Colours at the vertices, or textures of a width.
pub(super) fn textures(ui: &mut egui::Ui, texture_px: &mut Option<u32>, sizes: &[u32]) {
    ui.label("Colours").on_hover_text("Textures: colour, normals and roughness of each square");
    let named = |px: Option<u32>| px.map_or("At vertices".to_owned(), |px| format!("Textures of {px} px"));
    egui::ComboBox::from_id_salt("textures").selected_text(named(*texture_px)).width(190.0).show_ui(ui, |ui| {
        for px in [None].into_iter().chain(sizes.iter().copied().map(Some)) {
            ui.selectable_value(texture_px, px, named(px));
        }
    });
    ui.end_row();
}

/// How much of a structure is baked.
pub(super) fn detail(ui: &mut egui::Ui, settings: &mut BakeSettings, planet: &Planet) {
    if planet.structure.is_none() {
        return;
    }
    ui.label("Rivers");
    ui.horizontal(|ui| {
        for (detail, name, told) in [
            (Detail::Pixel, "As wide as pixels", "Without valleys that are too narrow for the pixels or vertices"),
            (Detail::All, "All", "Every river under a point is made: milliseconds for each of points far apart"),
        ] {
            ui.selectable_value(&mut settings.detail, detail, name).on_hover_text(told);
        }
    });
    ui.end_row();
}

/// Warns of a bake that takes long.
pub(super) fn slow(ui: &mut egui::Ui, is_slow: bool) {
    if is_slow {
        ui.colored_label(ui.visuals().warn_fg_color, "All rivers between points so far apart take hours.");
    }
}

/// Whether vertices are floats or whole numbers.
pub(super) fn vertices(ui: &mut egui::Ui, is_quantized: &mut bool) {
    ui.label("Vertices");
    ui.horizontal(|ui| {
        for (is_whole, name, told) in [
            (false, "Floats", "32 bits, for every reader"),
            (true, "Whole numbers", "16 and 8 bits: half as large. Readers must know KHR_mesh_quantization"),
        ] {
            ui.selectable_value(is_quantized, is_whole, name).on_hover_text(told);
        }
    });
    ui.end_row();
}
