//! The window of the variations: nine small pictures. A click takes one, and the next nine are around it.

use super::look;
use crate::editor::command::{Action, Commands, VariationAction, Window};
use crate::editor::panels::PANELS;
use crate::editor::state::State;
use crate::editor::state::variations::COUNT;
use crate::editor::widgets::planet_button::planet_button;
use crate::planet::locks::Locks;
use eframe::egui;

/// Width and height of a picture, points: at most and at least.
const MOST: f32 = 150.0;
const LEAST: f32 = 72.0;
/// Height of the window without the pictures.
const BESIDES: f32 = 190.0;
const COLUMNS: usize = 3;

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("variations window")
}

/// Shows the window while it is open.
pub fn show(ctx: &egui::Context, state: &State, commands: &mut Commands) {
    let mut open = state.shows.variations;
    let window = egui::Window::new("Variations").id(id()).open(&mut open).resizable(false).collapsible(false);
    window.default_pos(look::WINDOW_POS).show(ctx, |ui| {
        let room = (ctx.content_rect().height() - BESIDES) / (COUNT / COLUMNS) as f32;
        let side = room.clamp(LEAST, MOST);
        ui.set_max_width(side * COLUMNS as f32 + 8.0);
        wishes(ui, state, commands);
        grid(ui, state, side, commands);
        ui.add_space(2.0);
        locks(ui, state, commands);
    });
    if open != state.shows.variations {
        commands.push(Action::Close(Window::Variations));
    }
}

fn wishes(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let mut wish = state.variations.wish;
    ui.horizontal(|ui| {
        let label = ui.label("Difference");
        let mut percent = (wish.stray * 100.0).round();
        ui.spacing_mut().slider_width = (ui.available_width() - 150.0).clamp(60.0, 140.0);
        let slider = egui::Slider::new(&mut percent, 2.0..=100.0).suffix(" %").integer();
        let told = "How far numbers may move, as a share of their size; from 50 % on, seeds often change as well";
        if ui.add(slider).labelled_by(label.id).on_hover_text(told).changed() {
            wish.stray = percent / 100.0;
        }
        if ui.button("Again").on_hover_text("Nine other variations").clicked() {
            commands.push(Action::Variation(VariationAction::Again));
        }
    });
    ui.horizontal(|ui| {
        let label = ui.label("Vary");
        let name =
            |part| PANELS.iter().find(|panel| Some(panel.part) == part).map_or("Everything", |panel| panel.label);
        egui::ComboBox::from_id_salt("what varies")
            .selected_text(name(wish.part))
            .width(120.0)
            .show_ui(ui, |ui| {
                for part in std::iter::once(None).chain(PANELS.iter().map(|panel| Some(panel.part))) {
                    ui.selectable_value(&mut wish.part, part, name(part));
                }
            })
            .response
            .labelled_by(label.id)
            .on_hover_text("The tab whose parameters vary");
        let missing = state.variations.sheet.missing();
        if missing > 0 {
            ui.weak(format!("drawing {} of {COUNT}", COUNT - missing + 1));
        }
    });
    if wish != state.variations.wish {
        commands.push(Action::Variation(VariationAction::Wish(wish)));
    }
}

fn grid(ui: &mut egui::Ui, state: &State, side: f32, commands: &mut Commands) {
    ui.spacing_mut().item_spacing = egui::vec2(4.0, 4.0);
    for (row, cells) in state.variations.sheet.cells.chunks(COLUMNS).enumerate() {
        ui.horizontal(|ui| {
            for (column, cell) in cells.iter().enumerate() {
                let number = row * COLUMNS + column;
                let name = format!("Variation {}", number + 1);
                if planet_button(ui, cell, &name, "Take it; undo goes back", side).clicked() {
                    commands.push(Action::Variation(VariationAction::Take(number)));
                }
            }
        });
    }
}

fn locks(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let count = Locks::of(state.document.planet()).len();
    ui.horizontal(|ui| {
        let told = "Locked parameters stay: right-click the name of a parameter or of a layer, or lock a whole tab with \
                    the padlock beside its filter";
        match count {
            0 => ui.weak("Nothing is locked"),
            1 => ui.weak("1 lock"),
            _ => ui.weak(format!("{count} locks")),
        }
        .on_hover_text(told);
        if count > 0 && ui.button("Unlock all").clicked() {
            commands.push(Action::Variation(VariationAction::UnlockAll));
        }
    });
}
