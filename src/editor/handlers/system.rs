//! Systems: opens them, and goes from body to body.

use crate::editor::command::SystemAction;
use crate::editor::handlers::opening;
use crate::editor::state::State;
use crate::editor::state::questions::Goal;
use crate::editor::state::system::{OpenSystem, Preset};
use crate::planet::file::read_text;
use crate::system::System;
use eframe::egui;
use std::path::Path;

/// Carries out an action.
pub fn act(state: &mut State, ctx: &egui::Context, action: SystemAction) {
    match action {
        SystemAction::Open(index) => open(state, ctx, OpenSystem::shipped(index)),
        SystemAction::Visit(body) => opening::pursue(state, ctx, Goal::Visit(body)),
        SystemAction::Leave => {
            state.system = None;
            state.viewport.set_system(None);
        }
    }
}

/// Whether a file holds a system. A file that cannot be read is no system: who opens it says why.
pub fn is_system(path: &Path) -> bool {
    read_text(path).is_ok_and(|text| System::is_system(&text))
}

/// Opens a system file, and goes to its first planet.
pub fn open_file(state: &mut State, ctx: &egui::Context, path: &Path) {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    open(state, ctx, OpenSystem::file(path));
}

fn open(state: &mut State, ctx: &egui::Context, opened: Result<OpenSystem, String>) {
    match opened {
        Ok(system) => {
            let first = system.first_planet();
            state.shows.system = true;
            state.system = Some(system);
            if let Some(first) = first {
                opening::pursue(state, ctx, Goal::Visit(first));
            }
        }
        Err(why) => state.report("The system could not be opened", why.lines().map(str::to_owned).collect()),
    }
}

/// Opens the planet of a body, and draws its neighbours.
pub fn visit(state: &mut State, body: usize) {
    let Some(preset) = state.system.as_ref().and_then(|system| system.preset(body)) else { return };
    let number = state.document_number;
    match preset {
        Preset::Shipped(index) => opening::open_shipped(state, index),
        Preset::File(path) => opening::open_path(state, &path),
    }
    // A planet that could not be opened left the document as it was.
    if state.document_number == number {
        return;
    }
    if let Some(system) = &state.system {
        state.viewport.set_system(Some((system.worlds.clone(), body)));
        state.reset_view();
    }
}
