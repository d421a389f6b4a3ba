//! The choices of maps.

use super::rows;
use crate::bake::{Detail, Format, MAX_SIZE, Map};
use crate::editor::state::State;
use crate::editor::state::bake_settings::{BakeSettings, Form};
use crate::editor::widgets::typed::{Allowed, plain_field};
use crate::planet::Planet;
use eframe::egui;

/// Sizes to choose from.
const SIZES: [u32; 6] = [1024, 2048, 4096, 8192, 16_384, MAX_SIZE / 2];
/// Pixels from which a bake with all detail of a structure takes hours.
const LARGE: u64 = 1 << 20;

/// The maps, grouped.
const GROUPS: [(&str, &[Map]); 4] = [
    ("Shape", &[Map::Height, Map::Normal, Map::NormalPlanet, Map::Slope]),
    ("Surface", &[Map::Albedo, Map::Roughness, Map::AmbientOcclusion, Map::Biome, Map::NightLights]),
    (
        "Climate and clouds",
        &[
            Map::Temperature,
            Map::Precipitation,
            Map::Moisture,
            Map::Rain,
            Map::CloudCover,
            Map::MiddleCover,
            Map::VeilCover,
            Map::FogCover,
        ],
    ),
    ("Water", &[Map::WaterDepth, Map::Discharge, Map::Flow]),
];

/// The maps to bake. The one that is clicked last shows in the small picture.
pub(super) fn choose(ui: &mut egui::Ui, settings: &mut BakeSettings, planet: &Planet) {
    for (title, group) in GROUPS {
        ui.label(title);
        ui.horizontal_wrapped(|ui| {
            for &map in group {
                let lack = map.missing(planet);
                let chosen = settings.maps.contains(&map) && lack.is_none();
                let button = ui.add_enabled(lack.is_none(), egui::Button::selectable(chosen, map.label()));
                let button = button.on_hover_text(map.told());
                let button = match lack {
                    Some(lack) => button.on_disabled_hover_text(format!("{} has {lack}", planet.name)),
                    None => button,
                };
                if button.clicked() {
                    settings.maps.retain(|other| *other != map);
                    if !chosen {
                        settings.maps.push(map);
                        settings.maps.sort_by_key(|map| Map::ALL.iter().position(|other| other == map));
                    }
                    settings.previewed = map;
                }
            }
        });
    }
}

pub(super) fn form(ui: &mut egui::Ui, settings: &mut BakeSettings, state: &State) {
    ui.label("Form");
    ui.horizontal(|ui| {
        for (form, name, told) in Form::ALL {
            ui.selectable_value(&mut settings.form, form, name).on_hover_text(told);
        }
    });
    ui.end_row();
    if settings.form == Form::Region {
        rows::region(ui, &mut settings.region, state);
    }
    ui.label("Size").on_hover_text("Width of a picture");
    ui.horizontal(|ui| {
        egui::ComboBox::from_id_salt("size").selected_text(format!("{} px", settings.size)).show_ui(ui, |ui| {
            for size in SIZES {
                ui.selectable_value(&mut settings.size, size, format!("{size} px"));
            }
        });
        let mut size = f64::from(settings.size);
        plain_field(ui, &mut size, 8.0, 0, Allowed::whole(2.0, f64::from(MAX_SIZE))).accessible_name("Size of maps");
        settings.size = size as u32;
        if settings.form == Form::Globe {
            settings.size += settings.size % 2;
        }
    });
    ui.end_row();
    ui.label("Format");
    egui::ComboBox::from_id_salt("format").selected_text(settings.format.label()).width(190.0).show_ui(ui, |ui| {
        for format in Format::ALL {
            ui.selectable_value(&mut settings.format, format, format.label());
        }
    });
    ui.end_row();
}

/// The extent of the work.
pub(super) fn tell(ui: &mut egui::Ui, settings: &BakeSettings, planet: &Planet) {
    let ([width, height], pictures) = settings.pictures();
    let pixels = u64::from(width) * u64::from(height) * pictures;
    let channels: usize =
        settings.maps.iter().filter(|map| map.missing(planet).is_none()).map(|map| map.channels()).sum();
    let megabytes = (pixels * channels as u64 * settings.format.bytes_per_number()) as f64 / 1e6;
    let count =
        if pictures > 1 { format!("{pictures} faces of {width} × {height}") } else { format!("{width} × {height}") };
    ui.weak(format!("{count} px, up to {megabytes:.0} MB"));
    let is_slow = planet.structure.is_some() && settings.detail == Detail::All;
    rows::slow(ui, is_slow && settings.form != Form::Region && pixels > LARGE);
}
