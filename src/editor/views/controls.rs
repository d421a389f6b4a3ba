//! The window that lists the keys and the mouse. Shortcuts come from the table of commands.

use crate::editor::command::{Action, Commands, Window};
use crate::editor::commands::COMMANDS;
use crate::editor::state::State;
use crate::editor::widgets::keys_text;
use eframe::egui;

/// Held keys and the mouse, which are no commands.
const GROUPS: [(&str, &[(&str, &str)]); 7] = [
    (
        "Mouse",
        &[
            ("Drag", "Orbit: hold the ground and turn the planet. Fly, walk: look around"),
            ("Right drag", "Look around"),
            ("Scroll", "Orbit: move towards the point under the pointer. Fly: faster or slower"),
            ("Double click", "Fly there; any key stops"),
            ("Shift and drag, middle drag", "Turn the star"),
            ("Right click on a name in the panel", "Copy, paste or reset a value"),
        ],
    ),
    (
        "Orbit",
        &[
            ("W A S D, arrow keys", "Travel over the ground"),
            ("E, Q, Page up, Page down", "Higher, lower"),
            ("Shift and arrow keys", "Look around"),
        ],
    ),
    (
        "Fly",
        &[
            ("W A S D", "Along the view, back, to the sides; faster the higher you are"),
            ("E or Space, Q", "Up, down"),
            ("Z, C", "Roll to the left, to the right"),
            ("Arrow keys", "Look around"),
            ("Shift", "Five times as fast"),
        ],
    ),
    (
        "Biome table",
        &[
            ("A biome's letter, right click, Ctrl and click", "Choose that biome"),
            ("[ ]", "Smaller, larger brush"),
            ("Shift", "Straight lines, outlines of rectangles; fill everywhere; join brush strokes"),
            ("Ctrl and click on the planet", "Paint the climate there"),
            ("Escape", "End the selection"),
        ],
    ),
    (
        "Sculpting, with a tool of the Sculpt tab",
        &[
            ("Drag", "Sculpt; with Shift lower"),
            ("Click", "Place a stamp, or the next point of a line"),
            ("Enter", "End the line"),
            ("Alt and drag", "Move the camera"),
        ],
    ),
    (
        "Plates, in the Structure tab",
        &[("Click", "Choose the plate"), ("Ctrl and drag", "Move the plate, with its continents")],
    ),
    ("Walk", &[("W A S D", "Walk; slower uphill"), ("Shift", "Run"), ("Space", "Jump"), ("Arrow keys", "Look around")]),
];

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("controls window")
}

/// Shows the window while it is open.
pub fn show(ctx: &egui::Context, state: &State, commands: &mut Commands) {
    let mut open = state.shows.controls;
    let most_high = ctx.content_rect().height() - 120.0;
    egui::Window::new("Controls").id(id()).open(&mut open).resizable(false).collapsible(false).show(ctx, |ui| {
        egui::ScrollArea::vertical().max_height(most_high).show(ui, |ui| {
            egui::Grid::new("controls").num_columns(2).spacing([24.0, 4.0]).show(ui, |ui| {
                for (title, rows) in GROUPS {
                    heading(ui, title);
                    for (keys, effect) in rows {
                        row(ui, keys, effect);
                    }
                }
                heading(ui, "Shortcuts");
                for command in COMMANDS.iter().filter(|command| !command.shortcuts.is_empty()) {
                    let keys = command.shortcuts.iter().map(|shortcut| keys_text(ctx, shortcut));
                    row(ui, &keys.collect::<Vec<_>>().join(", "), command.tooltip);
                }
            });
        });
    });
    if open != state.shows.controls {
        commands.push(Action::Close(Window::Controls));
    }
}

fn heading(ui: &mut egui::Ui, title: &str) {
    ui.heading(title);
    ui.end_row();
}

fn row(ui: &mut egui::Ui, keys: &str, effect: &str) {
    ui.strong(keys);
    ui.label(effect.trim_end_matches('.'));
    ui.end_row();
}
