//! The choice of a picture for a height map or a stamp.

use crate::editor::files::dialogs::DialogRequest;
use crate::editor::panels::sculpt::BRUSH;
use crate::editor::state::State;
use crate::editor::state::questions::Asking;
use crate::planet::param::{Domain, ParamPath, Segment, ValueMut};
use eframe::egui;
use std::path::Path;

/// Asks for a picture for the parameter at `path`.
pub fn browse(state: &mut State, ctx: &egui::Context, path: ParamPath) {
    let folder = state.document.folder();
    state.questions.ask(ctx, Asking::Picture(path), DialogRequest::Picture { folder });
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
    state.edit(planet, Some("Choose picture".to_owned()));
}
