//! The window that bakes maps for other programs: which maps, their form, size and format, a small picture of one.

use crate::bake::{Bake, Detail, Format, MAX_SIZE, Map};
use crate::editor::command::{Action, BakeAction, Commands, Window};
use crate::editor::state::State;
use crate::editor::state::baking::{BakeSettings, Baking, Form};
use crate::editor::widgets::number::length_text;
use crate::editor::widgets::typed::{Allowed, plain_field};
use crate::planet::Planet;
use crate::planet::param::Unit;
use eframe::egui;

/// Sizes to choose from.
const SIZES: [u32; 6] = [1024, 2048, 4096, 8192, 16_384, MAX_SIZE / 2];
/// Pixels from which a bake with all detail of a structure takes hours.
const LARGE: u64 = 1 << 20;

/// The maps, grouped.
const GROUPS: [(&str, &[Map]); 4] = [
    ("Shape", &[Map::Height, Map::Normal, Map::NormalPlanet, Map::Slope]),
    ("Surface", &[Map::Albedo, Map::Roughness, Map::Biome]),
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

/// The window, with the small picture on the graphics device.
#[derive(Default)]
pub struct BakeWindow {
    shown: Option<(u64, egui::TextureHandle)>,
}

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("bake window")
}

impl BakeWindow {
    /// Shows the window if it is open.
    pub fn show(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        if !state.shows.bake {
            self.shown = None;
            return;
        }
        let mut open = true;
        let window = egui::Window::new("Bake maps").id(id()).open(&mut open).default_pos([12.0, 40.0]);
        window.default_size([330.0, 680.0]).vscroll(true).show(ctx, |ui| {
            let (mut settings, planet) = (state.bake.clone(), state.document.valid_planet());
            maps(ui, &mut settings, planet);
            ui.add_space(4.0);
            self.preview(ui, state);
            ui.add_space(4.0);
            egui::Grid::new("bake").num_columns(2).spacing([12.0, 6.0]).show(ui, |ui| form(ui, &mut settings, state));
            told(ui, &settings, planet);
            ui.separator();
            match &state.baking {
                Some(baking) => under_way(ui, baking, commands),
                None => start(ui, &settings, planet, commands),
            }
            if settings != state.bake {
                commands.push(Action::Bake(BakeAction::Set(Box::new(settings))));
            }
        });
        if !open {
            commands.push(Action::Close(Window::Bake));
        }
    }

    /// The small picture in a box whose size depends on the form alone, so that nothing below moves when it arrives.
    fn preview(&mut self, ui: &mut egui::Ui, state: &State) {
        let width = ui.available_width();
        let aspect = match state.bake.form {
            Form::Globe | Form::Region => 0.5,
            Form::Cube => 1.0 / 6.0,
        };
        let (rect, area) = ui.allocate_exact_size(egui::vec2(width, width * aspect), egui::Sense::hover());
        ui.painter().rect_filled(rect, 2.0, ui.visuals().extreme_bg_color);
        let Some((number, preview)) = &state.bake_preview.newest else {
            ui.weak("The small picture is being made …");
            return;
        };
        if self.shown.as_ref().is_none_or(|(shown, _)| shown != number) {
            let [width, height] = preview.size_px.map(|side| side as usize);
            let rgb: Vec<u8> = preview.pixels.iter().flatten().copied().collect();
            let image = egui::ColorImage::from_rgb([width, height], &rgb);
            let texture = ui.ctx().load_texture("bake preview", image, egui::TextureOptions::LINEAR);
            self.shown = Some((*number, texture));
        }
        let Some((_, texture)) = &self.shown else { return };
        let map = preview.map;
        let size = texture.size_vec2();
        let fitted = size * (rect.size() / size).min_elem();
        let at = egui::Rect::from_center_size(rect.center(), fitted);
        egui::Image::new(texture).corner_radius(2.0).paint_at(ui, at);
        area.on_hover_text(format!("{}, small", map.label()));
        let [low, high] = preview.range;
        let range = match map.unit() {
            _ if map.channels() > 1 || map == Map::Biome => String::new(),
            "m" => format!(": {} to {}", signed_length(low), signed_length(high)),
            unit => format!(": {low:.3} to {high:.3} {unit}"),
        };
        let busy = if state.bake_preview.is_busy() { " …" } else { "" };
        ui.weak(format!("{}{range}{busy}", map.label()));
    }
}

fn signed_length(m: f64) -> String {
    format!("{}{}", if m < 0.0 { "−" } else { "" }, length_text(m.abs()))
}

/// The maps to bake. The one that is clicked last shows in the small picture.
fn maps(ui: &mut egui::Ui, settings: &mut BakeSettings, planet: &Planet) {
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

fn form(ui: &mut egui::Ui, settings: &mut BakeSettings, state: &State) {
    ui.label("Form");
    ui.horizontal(|ui| {
        for (form, name, told) in Form::ALL {
            ui.selectable_value(&mut settings.form, form, name).on_hover_text(told);
        }
    });
    ui.end_row();
    if settings.form == Form::Region {
        let degrees = |most: f64| Allowed::numbers(Unit::Degrees, -most, most);
        ui.label("Centre");
        ui.horizontal(|ui| {
            plain_field(ui, &mut settings.region.lat_deg, 0.1, 4, degrees(90.0)).accessible_name("Latitude of region");
            plain_field(ui, &mut settings.region.lon_deg, 0.1, 4, degrees(180.0))
                .accessible_name("Longitude of region");
            if ui.button("Here").on_hover_text("The place below the camera").clicked() {
                let eye = state.viewport.eye(state.document.valid_planet()).1;
                (settings.region.lat_deg, settings.region.lon_deg) = eye.to_degrees();
            }
        });
        ui.end_row();
        ui.label("Side");
        let most_km = Bake::longest_side_km(state.document.valid_planet().radius_km);
        settings.region.side_km = settings.region.side_km.min(most_km);
        let speed = settings.region.side_km * 0.01;
        plain_field(ui, &mut settings.region.side_km, speed, 3, Allowed::numbers(Unit::Kilometres, 1e-3, most_km))
            .accessible_name("Side of region");
        ui.end_row();
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
    if state.document.valid_planet().structure.is_some() {
        ui.label("Rivers");
        ui.horizontal(|ui| {
            for (detail, name, told) in [
                (Detail::Pixel, "As wide as pixels", "Without valleys that are too narrow for the map's pixels"),
                (Detail::All, "All", "Every river under a pixel is made: milliseconds for each pixel of a large map"),
            ] {
                ui.selectable_value(&mut settings.detail, detail, name).on_hover_text(told);
            }
        });
        ui.end_row();
    }
}

/// The extent of the work.
fn told(ui: &mut egui::Ui, settings: &BakeSettings, planet: &Planet) {
    let ([width, height], pictures) = settings.pictures();
    let pixels = u64::from(width) * u64::from(height) * pictures;
    let channels: usize =
        settings.maps.iter().filter(|map| map.missing(planet).is_none()).map(|map| map.channels()).sum();
    let megabytes = (pixels * channels as u64 * settings.format.bytes_per_number()) as f64 / 1e6;
    let count =
        if pictures > 1 { format!("{pictures} faces of {width} × {height}") } else { format!("{width} × {height}") };
    ui.weak(format!("{count} px, up to {megabytes:.0} MB"));
    if planet.structure.is_some() && settings.detail == Detail::All && settings.form != Form::Region && pixels > LARGE {
        ui.colored_label(ui.visuals().warn_fg_color, "All rivers of a globe at this size take hours.");
    }
}

fn start(ui: &mut egui::Ui, settings: &BakeSettings, planet: &Planet, commands: &mut Commands) {
    let chosen: Vec<Map> = settings.maps.iter().copied().filter(|map| map.missing(planet).is_none()).collect();
    let many = chosen.iter().find(|map| settings.format == Format::R16 && map.channels() > 1);
    let why_not = match (chosen.is_empty(), many) {
        (true, _) => Some("Choose a map".to_owned()),
        (_, Some(map)) => Some(format!("r16 holds one channel, {} has {}", map.label(), map.channels())),
        _ => None,
    };
    let button = ui.add_enabled(why_not.is_none(), egui::Button::new("Bake into folder…"));
    let button = button.on_hover_text("Each map gets a JSON beside it that says what its numbers mean");
    if button.on_disabled_hover_text(why_not.unwrap_or_default()).clicked() {
        commands.push(Action::Bake(BakeAction::Ask));
    }
}

fn under_way(ui: &mut egui::Ui, baking: &Baking, commands: &mut Commands) {
    ui.label(format!("Into {}", baking.folder.display()));
    ui.horizontal(|ui| {
        ui.add(egui::ProgressBar::new(baking.done() as f32).desired_width(200.0).show_percentage());
        if ui.button("Stop").on_hover_text("The same bake goes on from there").clicked() {
            commands.push(Action::Bake(BakeAction::Cancel));
        }
    });
}
