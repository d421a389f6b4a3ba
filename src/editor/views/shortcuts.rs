//! Keys and dropped files, as commands.

use super::{
    bake, controls, history, inspector, library, performance, photo, place, system, templates, text, tour, variations,
};
use crate::editor::command::{Action, Command, Commands, PanelAction, SculptAction, Window};
use crate::editor::commands;
use crate::editor::panels::biomes;
use crate::editor::state::State;
use crate::editor::widgets::keys_are_taken;
use eframe::egui;

/// Where the keys of a frame go first.
#[derive(Clone, Copy, Debug)]
pub struct Keys {
    /// A field had the focus at the end of the last frame. Escape ends the typing first, and egui takes the focus away
    /// before anybody sees the key.
    pub was_typing: bool,
    /// The open tab is filtered.
    pub filtered: bool,
}

/// Turns this frame's keys and dropped files into commands.
pub fn take(ctx: &egui::Context, state: &State, keys: Keys, commands: &mut Commands) {
    // A question comes first: a dropped file would replace the document below it.
    if state.questions.is_asking() {
        return;
    }
    if !keys_are_taken(ctx) {
        take_escape(ctx, state, keys, commands);
        take_shortcuts(ctx, state, commands);
    }
    let dropped = ctx.input(|input| input.raw.dropped_files.first().map(|file| file.path().to_owned()));
    commands.extend(dropped.map(Action::OpenPath));
}

fn take_shortcuts(ctx: &egui::Context, state: &State, commands: &mut Commands) {
    let typing = ctx.text_edit_focused();
    // Letters and digits choose biomes while the table has the focus.
    let chooses = biomes::has_keys(ctx);
    let belongs_to_other = |keys: &egui::KeyboardShortcut| typing || chooses && !keys.modifiers.command;
    // While the finder is open, its own shortcut closes it, and all other keys are its text.
    let taken = |command| !state.shows.finder || command == Command::Finder;
    for (shortcut, row) in commands::all_shortcuts().into_iter().filter(|(_, row)| taken(row.command)) {
        if !(row.yields_to_text && belongs_to_other(&shortcut))
            && ctx.input_mut(|input| input.consume_shortcut(&shortcut))
        {
            commands.send(row.command);
        }
    }
}

/// Escape closes the window on top, or else removes the filter of the open tab, puts the tool down, or ends the
/// comparison. The finder and fields take their own.
fn take_escape(ctx: &egui::Context, state: &State, keys: Keys, commands: &mut Commands) {
    if keys.was_typing || state.shows.finder {
        return;
    }
    let windows = [
        (controls::layer(), state.shows.controls, Window::Controls),
        (performance::layer(), state.shows.performance, Window::Performance),
        (photo::layer(), state.shows.photo, Window::Photo),
        (history::layer(), state.shows.history, Window::History),
        (place::layer(), state.shows.place, Window::Place),
        (inspector::layer(), state.shows.inspector, Window::Inspector),
        (templates::layer(), state.shows.templates, Window::Templates),
        (text::layer(), state.shows.text, Window::Text),
        (bake::layer(), state.shows.bake, Window::Bake),
        (library::layer(), state.shows.library, Window::Library),
        (system::layer(), state.shows.system, Window::System),
        (tour::layer(), state.shows.tour, Window::Tour),
        (variations::layer(), state.shows.variations, Window::Variations),
    ];
    let order: Vec<egui::LayerId> = ctx.memory(|memory| memory.layer_ids().collect());
    let height = |layer: &egui::LayerId| order.iter().position(|other| other == layer);
    let top = windows.into_iter().filter(|(_, open, _)| *open).max_by_key(|(layer, ..)| height(layer));
    let filter = keys.filtered.then_some(Action::Panel(PanelAction::ClearFilter));
    let sculpt = &state.viewport.tab.sculpt;
    // What is drawn point by point is forgotten first.
    let tool = (sculpt.brush.is_some() && !state.viewport.is_drawing())
        .then_some(Action::Panel(PanelAction::Sculpt(SculptAction::PutDown)));
    let compare = state.viewport.compare().is_some().then_some(Action::Command(Command::Compare));
    if let Some(action) = top.map(|(.., window)| Action::Close(window)).or(filter).or(tool).or(compare)
        && ctx.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Escape))
    {
        commands.push(action);
    }
}
