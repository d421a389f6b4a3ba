//! The window of new planets: what one can begin as, with small pictures.

use crate::editor::command::{Action, Commands, Window};
use crate::editor::state::State;
use crate::editor::state::templates::ALL;
use crate::editor::widgets::planet_button::planet_button;
use eframe::egui;

/// Width and height of a picture, points.
const SIDE: f32 = 116.0;
const COLUMNS: usize = 5;

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("templates window")
}

/// Shows the window while it is open.
pub fn show(ctx: &egui::Context, state: &State, commands: &mut Commands) {
    let mut open = state.shows.templates;
    let window = egui::Window::new("New planet").id(id()).open(&mut open).resizable(false).collapsible(false);
    window.anchor(egui::Align2::CENTER_TOP, [0.0, 40.0]).show(ctx, |ui| {
        ui.spacing_mut().item_spacing = egui::vec2(8.0, 6.0);
        let room = (ctx.content_rect().height() - 130.0).max(200.0);
        egui::ScrollArea::vertical().max_height(room).show(ui, |ui| {
            for (entries, cells) in ALL.chunks(COLUMNS).zip(state.templates.cells.chunks(COLUMNS)) {
                ui.horizontal_top(|ui| {
                    for (entry, cell) in entries.iter().zip(cells) {
                        ui.vertical(|ui| {
                            ui.set_width(SIDE);
                            if planet_button(ui, cell, entry.name, entry.note, SIDE).clicked() {
                                commands.push(Action::Begin(entry.template));
                            }
                            ui.add(egui::Label::new(entry.name).truncate().selectable(false));
                        });
                    }
                });
            }
        });
        ui.weak("A random kind shows one of many. What is locked in this planet stays in a random one.");
    });
    if open != state.shows.templates {
        commands.push(Action::Close(Window::Templates));
    }
}
