//! The choices of maps.

use super::rows;
use crate::bake::{Detail, Format, Landscape, MAX_SIZE, Map, Quadtree};
use crate::editor::state::State;
use crate::editor::state::bake_settings::{BakeSettings, Form};
use crate::editor::widgets::typed::{Allowed, plain_field};
use crate::planet::Planet;
use eframe::egui;
use std::ops::RangeInclusive;

/// Sizes to choose from.
const SIZES: [u32; 9] = [256, 1009, 1024, 2017, 2048, 4096, 8192, 16_384, MAX_SIZE / 2];
/// Finest level of a quadtree that is offered: 32,766 tiles of a map.
const MOST_LEVELS: u32 = 6;
/// Pixels from which a bake with all detail of a structure takes hours.
const LARGE: u64 = 1 << 20;

/// The maps, grouped.
const GROUPS: [(&str, &[Map]); 4] = [
    ("Shape", &[Map::Height, Map::Normal, Map::NormalPlanet, Map::Slope]),
    (
        "Surface",
        &[
            Map::Albedo,
            Map::Roughness,
            Map::AmbientOcclusion,
            Map::Biome,
            Map::Canopy,
            Map::CanopyHeight,
            Map::NightLights,
        ],
    ),
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
            let before = usual_size(settings.form);
            ui.selectable_value(&mut settings.form, form, name).on_hover_text(told);
            // A width of one's own stays.
            if settings.size == before {
                settings.size = usual_size(settings.form);
            }
        }
    });
    ui.end_row();
    if settings.uses_region() {
        rows::region(ui, &mut settings.region, state);
    }
    pieces(ui, settings);
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

/// Width of a picture, unless another one is chosen.
fn usual_size(form: Form) -> u32 {
    match form {
        Form::Globe | Form::Cube | Form::Region => BakeSettings::default().size,
        Form::Landscape => Landscape::SIZE,
        Form::Quadtree => Quadtree::SIZE,
    }
}

/// The tiles of a landscape or of a quadtree.
fn pieces(ui: &mut egui::Ui, settings: &mut BakeSettings) {
    let mut row = |(label, name): (&str, &str), told: &str, value: u32, allowed: RangeInclusive<u32>| {
        ui.label(label).on_hover_text(told);
        let mut number = f64::from(value);
        plain_field(ui, &mut number, 0.1, 0, Allowed::whole(*allowed.start(), *allowed.end())).accessible_name(name);
        ui.end_row();
        number as u32
    };
    match settings.form {
        Form::Landscape => {
            let most = (MAX_SIZE / settings.size.max(1)).max(1);
            let tiles = row(("Tiles", "Tiles of landscape"), "Along each side", settings.landscape_tiles, 1..=most);
            settings.landscape_tiles = tiles.clamp(1, most);
        }
        Form::Quadtree => {
            let quadtree = &mut settings.quadtree;
            let told = "The finest level has 2 to its power tiles along a side of each of six faces";
            quadtree.levels =
                row(("Levels", "Levels of quadtree"), told, quadtree.levels.into(), 0..=MOST_LEVELS) as u8;
            let told = "Pixels of the neighbours around each tile";
            quadtree.apron = row(("Apron", "Apron of quadtree"), told, quadtree.apron, 0..=settings.size / 8);
        }
        _ => {}
    }
}

/// The extent of the work.
pub(super) fn tell(ui: &mut egui::Ui, settings: &BakeSettings, planet: &Planet) {
    let ([width, height], pictures) = settings.pictures();
    let pixels = u64::from(width) * u64::from(height) * pictures;
    let channels: usize =
        settings.maps.iter().filter(|map| map.missing(planet).is_none()).map(|map| map.channels()).sum();
    let megabytes = (pixels * channels as u64 * settings.format.bytes_per_number()) as f64 / 1e6;
    let count = match settings.form {
        Form::Globe | Form::Region => format!("{width} × {height}"),
        Form::Cube => format!("{pictures} faces of {width} × {height}"),
        Form::Landscape | Form::Quadtree => format!("{pictures} tiles of {width} × {height}"),
    };
    ui.weak(format!("{count} px, up to {megabytes:.0} MB"));
    let is_slow = planet.structure.is_some() && settings.detail == Detail::All;
    rows::slow(ui, is_slow && !settings.uses_region() && pixels > LARGE);
}
