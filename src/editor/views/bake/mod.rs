//! The window that bakes for other programs: maps, a mesh or 3D tiles, with a small picture of what comes.
//!
//! - `maps`, `mesh`, `tiles`: the choices of each; `rows`: rows of choices that they share

mod maps;
mod mesh;
mod rows;
mod tiles;

use crate::bake::{Format, Map};
use crate::editor::command::{Action, BakeAction, Commands, Window};
use crate::editor::state::State;
use crate::editor::state::bake_settings::{BakeSettings, Form, Product};
use crate::editor::state::baking::Baking;
use crate::editor::views::look;
use crate::editor::widgets::number::length_text;
use crate::planet::Planet;
use eframe::egui;

/// Room that the foot of the window takes: what is told, a line, the button.
const FOOT: f32 = 96.0;

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
        let window = egui::Window::new("Bake").id(id()).open(&mut open).default_pos(look::WINDOW_POS);
        let most = (ctx.content_rect().height() - 110.0).max(200.0);
        window.resizable([true, false]).default_width(350.0).show(ctx, |ui| {
            let (mut settings, planet) = (state.bake.clone(), state.document.valid_planet());
            ui.horizontal(|ui| {
                for (product, name, told) in Product::ALL {
                    ui.selectable_value(&mut settings.product, product, name).on_hover_text(told);
                }
            });
            ui.separator();
            // The button stays in sight however low the window is.
            let body = egui::ScrollArea::vertical().max_height(most - FOOT).auto_shrink([false, true]);
            body.show(ui, |ui| {
                if settings.product == Product::Maps {
                    maps::choose(ui, &mut settings, planet);
                    ui.add_space(4.0);
                }
                self.preview(ui, state);
                ui.add_space(4.0);
                let grid = egui::Grid::new(("bake", settings.product)).num_columns(2).spacing([12.0, 6.0]);
                grid.show(ui, |ui| {
                    match settings.product {
                        Product::Maps => maps::form(ui, &mut settings, state),
                        Product::Mesh => mesh::form(ui, &mut settings, state),
                        Product::Tiles => tiles::form(ui, &mut settings, state),
                    }
                    rows::detail(ui, &mut settings, planet);
                });
            });
            ui.separator();
            match settings.product {
                Product::Maps => maps::tell(ui, &settings, planet),
                Product::Mesh => mesh::tell(ui, &settings, planet),
                Product::Tiles => tiles::tell(ui, &settings, planet),
            }
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
        let aspect = match state.bake.as_shown().form {
            Form::Globe | Form::Region | Form::Landscape => 0.5,
            Form::Cube | Form::Quadtree => 1.0 / 6.0,
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

/// What stands in the way of a bake.
fn why_not(settings: &BakeSettings, planet: &Planet) -> Option<String> {
    match settings.product {
        Product::Maps => {
            let maps = settings.maps_of(planet);
            let many = |map: &&Map| settings.format == Format::R16 && map.channels() > 1;
            match (maps.is_empty(), maps.iter().find(many)) {
                (true, _) => Some("Choose a map".to_owned()),
                (_, Some(map)) => Some(format!("r16 holds one channel, {} has {}", map.label(), map.channels())),
                _ => None,
            }
        }
        Product::Mesh => settings.mesh(planet).check(planet).err(),
        Product::Tiles => settings.tileset().check(planet).err(),
    }
}

fn start(ui: &mut egui::Ui, settings: &BakeSettings, planet: &Planet, commands: &mut Commands) {
    let why_not = why_not(settings, planet);
    let (label, told) = match settings.product {
        Product::Maps => ("Bake into folder…", "Each map gets a JSON beside it that says what its numbers mean"),
        Product::Mesh => ("Bake into file…", "A .glb holds its textures; an .obj has a .mtl and .png files beside it"),
        Product::Tiles => ("Bake into folder…", "Load tileset.json in Cesium, or in its plugins for game engines"),
    };
    let button = ui.add_enabled(why_not.is_none(), egui::Button::new(label)).on_hover_text(told);
    if button.on_disabled_hover_text(why_not.as_deref().unwrap_or_default()).clicked() {
        commands.push(Action::Bake(BakeAction::Ask));
    }
}

fn under_way(ui: &mut egui::Ui, baking: &Baking, commands: &mut Commands) {
    ui.add(egui::Label::new(format!("Into {}", baking.to.display())).truncate());
    ui.horizontal(|ui| {
        ui.add(egui::ProgressBar::new(baking.done() as f32).desired_width(200.0).show_percentage());
        let told = match baking.product {
            Product::Mesh => "Nothing is written",
            Product::Maps | Product::Tiles => "The same bake goes on from there",
        };
        if ui.button("Stop").on_hover_text(told).clicked() {
            commands.push(Action::Bake(BakeAction::Cancel));
        }
    });
}
