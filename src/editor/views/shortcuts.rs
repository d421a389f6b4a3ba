//! Keys and dropped files, as commands.

use super::{controls, performance, photo};
use crate::editor::command::{Action, Commands, Window};
use crate::editor::commands;
use crate::editor::panels::biomes;
use crate::editor::state::State;
use crate::editor::widgets::keys_are_taken;
use eframe::egui;

/// Turns this frame's keys and dropped files into commands. `was_typing`: a field had the focus at the end of the last
/// frame. Escape ends the typing first, and egui takes the focus away before anybody sees the key.
pub fn take(ctx: &egui::Context, state: &State, was_typing: bool, commands: &mut Commands) {
    // A question comes first: a dropped file would replace the document below it.
    if state.questions.is_asking() {
        return;
    }
    if !keys_are_taken(ctx) {
        take_escape(ctx, state, was_typing, commands);
        take_shortcuts(ctx, commands);
    }
    let dropped = ctx.input(|input| input.raw.dropped_files.first().map(|file| file.path().to_owned()));
    commands.extend(dropped.map(Action::OpenPath));
}

fn take_shortcuts(ctx: &egui::Context, commands: &mut Commands) {
    // Letters and digits choose biomes while the table has the focus.
    let typing = ctx.text_edit_focused() || biomes::has_keys(ctx);
    for (shortcut, row) in commands::all_shortcuts() {
        if !(typing && row.yields_to_text) && ctx.input_mut(|input| input.consume_shortcut(&shortcut)) {
            commands.send(row.command);
        }
    }
}

/// Escape closes the window on top.
fn take_escape(ctx: &egui::Context, state: &State, was_typing: bool, commands: &mut Commands) {
    let windows = [
        (controls::layer(), state.shows.controls, Window::Controls),
        (performance::layer(), state.shows.performance, Window::Performance),
        (photo::layer(), state.shows.photo, Window::Photo),
    ];
    let order: Vec<egui::LayerId> = ctx.memory(|memory| memory.layer_ids().collect());
    let height = |layer: &egui::LayerId| order.iter().position(|other| other == layer);
    let top = windows.into_iter().filter(|(_, open, _)| *open).max_by_key(|(layer, ..)| height(layer));
    if let Some((.., window)) = top
        && !was_typing
        && ctx.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Escape))
    {
        commands.push(Action::Close(window));
    }
}
