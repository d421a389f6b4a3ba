//! The choices of 3D tiles.

use super::rows;
use crate::editor::state::State;
use crate::editor::state::bake_settings::BakeSettings;
use crate::editor::widgets::number::length_text;
use crate::editor::widgets::typed::{Allowed, plain_field};
use crate::planet::Planet;
use eframe::egui;

/// Widths of textures to choose from.
const TEXTURES: [u32; 4] = [64, 128, 256, 512];
/// Cells along a side of a tile to choose from.
const CELLS: [u32; 4] = [16, 32, 64, 128];

pub(super) fn form(ui: &mut egui::Ui, settings: &mut BakeSettings, state: &State) {
    ui.label("Levels").on_hover_text("The finest level. Level N has 2^N squares along each side of six faces");
    let mut levels = f64::from(settings.tiles.levels);
    plain_field(ui, &mut levels, 0.1, 0, Allowed::whole(0.0, 16.0)).accessible_name("Finest level");
    settings.tiles.levels = levels as u8;
    ui.end_row();
    ui.label("Fine levels").on_hover_text("Where levels beyond 2 are");
    ui.horizontal(|ui| {
        for (in_region, name) in [(false, "Everywhere"), (true, "In a region")] {
            ui.selectable_value(&mut settings.tiles.in_region, in_region, name);
        }
    });
    ui.end_row();
    if settings.tiles.in_region {
        rows::region(ui, &mut settings.region, state);
    }
    ui.label("Cells").on_hover_text("Along a side of a tile");
    ui.horizontal(|ui| {
        for cells in CELLS {
            ui.selectable_value(&mut settings.tiles.cells, cells, cells.to_string());
        }
    });
    ui.end_row();
    rows::textures(ui, &mut settings.tiles.texture_px, &TEXTURES);
    let planet = state.document.valid_planet();
    if planet.water.is_some() || planet.structure.is_some() {
        ui.label("Water");
        ui.horizontal(|ui| {
            for (has_water, name, told) in
                [(true, "Surface", "Tiles run on seas, lakes and rivers"), (false, "None", "The ground alone")]
            {
                ui.selectable_value(&mut settings.tiles.has_water, has_water, name).on_hover_text(told);
            }
        });
        ui.end_row();
    }
    rows::vertices(ui, &mut settings.tiles.is_quantized);
    ui.label("Index").on_hover_text("How a viewer learns which tiles there are");
    ui.horizontal(|ui| {
        for (is_implicit, name, told) in [
            (false, "List", "All tiles in tileset.json, for every viewer"),
            (true, "Implicit", "A binary file for each face, levels up to 10; viewers must read boxes from metadata"),
        ] {
            ui.selectable_value(&mut settings.tiles.is_implicit, is_implicit, name).on_hover_text(told);
        }
    });
    ui.end_row();
}

pub(super) fn tell(ui: &mut egui::Ui, settings: &BakeSettings, planet: &Planet) {
    let tileset = settings.tileset();
    match tileset.check(planet) {
        Err(why) => {
            ui.add(egui::Label::new(egui::RichText::new(why).color(ui.visuals().warn_fg_color)).wrap());
        }
        Ok(()) => {
            let count = tileset.tiles(planet).unwrap_or_default();
            ui.weak(format!("{count} tiles, vertices {} apart in the finest", length_text(tileset.finest_m(planet))));
            rows::slow(ui, tileset.is_slow(planet));
        }
    }
}
