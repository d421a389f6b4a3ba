//! The choice of a picture for a height map or a stamp, and of a mesh for a population.

use crate::editor::files::dialogs::DialogRequest;
use crate::editor::panels::sculpt::BRUSH;
use crate::editor::state::State;
use crate::editor::state::questions::Asking;
use crate::planet::param::{Domain, ParamPath, Segment, ValueMut};
use eframe::egui;
use std::path::Path;

/// Asks for a picture or a mesh for the parameter at `path`.
pub fn browse(state: &mut State, ctx: &egui::Context, path: ParamPath) {
    let folder = state.document.folder();
    let request =
        if is_mesh(state, &path) { DialogRequest::Model { folder } } else { DialogRequest::Picture { folder } };
    state.questions.ask(ctx, Asking::Picture(path), request);
}

/// Whether the parameter at `path` names a mesh.
fn is_mesh(state: &State, path: &ParamPath) -> bool {
    state.document.planet().meshes().any(|(at, _)| at == *path)
}

/// Writes the name of the chosen file into the parameter at `path`, unless the planet has no such parameter any more.
pub fn choose(state: &mut State, path: &ParamPath, file: &Path) {
    if let [Segment::Field(BRUSH), ..] = path.segments() {
        state.questions.for_brush = Some(file.to_owned());
        return;
    }
    let mut planet = (**state.document.planet()).clone();
    planet.each(&mut |at, param, value| {
        if at == path
            && let (Domain::File { .. }, ValueMut::Text(text)) = (param.domain, value)
        {
            *text = file.to_string_lossy().into_owned();
        }
    });
    if let Some(folder) = state.document.folder() {
        planet = planet.moved_to(&folder);
    }
    let label = if is_mesh(state, path) { "Choose mesh" } else { "Choose picture" };
    state.edit(planet, Some(label.to_owned()));
}
