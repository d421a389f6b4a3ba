//! The choices of a mesh.

use super::rows;
use crate::bake::mesh::{MeshFormat, MeshWater};
use crate::editor::state::State;
use crate::editor::state::bake_settings::BakeSettings;
use crate::editor::widgets::number::length_text;
use crate::editor::widgets::typed::{Allowed, plain_field};
use crate::planet::Planet;
use crate::planet::param::Unit;
use eframe::egui;

/// Widths of textures to choose from.
const TEXTURES: [u32; 5] = [512, 1024, 2048, 4096, 8192];
/// Units of a file to choose from, and how many of them a metre has.
const SCALES: [(&str, f64); 3] = [("m", 1.0), ("km", 1e-3), ("cm", 100.0)];

pub(super) fn form(ui: &mut egui::Ui, settings: &mut BakeSettings, state: &State) {
    let planet = state.document.valid_planet();
    ui.label("Area");
    ui.horizontal(|ui| {
        for (of_region, name, told) in [
            (false, "Globe", "Six squares about the planet's centre, +Y to the north pole"),
            (true, "Region", "One square about a place, +X to the east, +Y up"),
        ] {
            let of = &mut settings.mesh.of_region;
            if ui.selectable_value(of, of_region, name).on_hover_text(told).changed() {
                // What is close on a globe has millions of vertices, and what is wide there one in a region.
                settings.mesh.spacing_m = None;
            }
        }
    });
    ui.end_row();
    if settings.mesh.of_region {
        rows::region(ui, &mut settings.region, state);
    }
    ui.label("Spacing").on_hover_text("Greatest distance between vertices along a square's middle");
    let spacing_m = settings.mesh(planet).spacing_m(planet.radius_m());
    let mut wanted_m = settings.mesh.spacing_m.unwrap_or(spacing_m);
    let speed = wanted_m * 0.01;
    let allowed = Allowed::numbers(Unit::Metres, 1e-3, 1e9);
    if plain_field(ui, &mut wanted_m, speed, 2, allowed).accessible_name("Spacing of vertices").changed() {
        settings.mesh.spacing_m = Some(wanted_m);
    }
    ui.end_row();
    ui.label("File");
    ui.horizontal(|ui| {
        for (format, name, told) in [
            (MeshFormat::Glb, "glTF", "Binary glTF 2.0: one .glb"),
            (MeshFormat::Obj, "OBJ", "Wavefront OBJ, with materials and pictures beside it"),
        ] {
            ui.selectable_value(&mut settings.mesh.format, format, name).on_hover_text(told);
        }
        ui.label("in");
        let scale = &mut settings.mesh.scale;
        let name = SCALES.iter().find(|(_, known)| known == scale).map_or("own unit", |(name, _)| name);
        let units = egui::ComboBox::from_id_salt("unit").selected_text(name).width(60.0);
        units.show_ui(ui, |ui| {
            for (name, known) in SCALES {
                ui.selectable_value(scale, known, name);
            }
        });
    });
    ui.end_row();
    if settings.mesh.format == MeshFormat::Glb {
        rows::vertices(ui, &mut settings.mesh.is_quantized);
    }
    rows::textures(ui, &mut settings.mesh.texture_px, &TEXTURES);
    if planet.water.is_some() || planet.structure.is_some() {
        ui.label("Water");
        ui.horizontal(|ui| {
            for (water, name, told) in [
                (MeshWater::Surface, "Surface", "The mesh runs on seas, lakes and rivers, which are opaque"),
                (
                    MeshWater::Apart,
                    "Apart",
                    "The mesh runs on the ground, with a transparent mesh of the water over it",
                ),
                (MeshWater::None, "None", "The ground alone"),
            ] {
                ui.selectable_value(&mut settings.mesh.water, water, name).on_hover_text(told);
            }
        });
        ui.end_row();
    }
    ui.label("Levels").on_hover_text("Levels of detail, each with half the vertices of the one before along a side");
    let mut levels = f64::from(settings.mesh.levels);
    plain_field(ui, &mut levels, 0.1, 0, Allowed::whole(1.0, 8.0)).accessible_name("Levels of detail");
    settings.mesh.levels = levels as u32;
    ui.end_row();
    ui.label("Skirts").on_hover_text("They hang from the borders of squares and hide gaps between levels; 0 for none");
    let allowed = Allowed::numbers(Unit::Metres, 0.0, 1e6);
    plain_field(ui, &mut settings.mesh.skirt_m, 1.0, 1, allowed).accessible_name("Depth of skirts");
    ui.end_row();
}

pub(super) fn tell(ui: &mut egui::Ui, settings: &BakeSettings, planet: &Planet) {
    let mesh = settings.mesh(planet);
    let (vertices, spacing_m) = (mesh.vertices() as f64 * 1e-6, mesh.spacing_m(planet.radius_m()));
    ui.weak(format!("{vertices:.2} million vertices, {} apart", length_text(spacing_m)));
    match mesh.check(planet) {
        Err(why) => {
            ui.add(egui::Label::new(egui::RichText::new(why).color(ui.visuals().warn_fg_color)).wrap());
        }
        Ok(()) => rows::slow(ui, mesh.is_slow(planet)),
    }
}
