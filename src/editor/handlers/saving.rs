//! Saving: never over the work of another program without a question, never a planet that could not be opened again.

use super::opening;
use crate::editor::files::dialogs::DialogRequest;
use crate::editor::files::disk::{self, OnDisk, TheirFile};
use crate::editor::files::file_names::{PRESET_EXTENSION, is_same_file, with_extension};
use crate::editor::state::State;
use crate::editor::state::questions::{Asking, Replace};
use eframe::egui;
use std::path::{Path, PathBuf};

/// Saves to the document's file, or asks for one.
pub fn save(state: &mut State, ctx: &egui::Context) {
    match state.document.path().map(Path::to_owned) {
        Some(path) => save_own(state, ctx, path),
        None => save_as(state, ctx),
    }
}

/// Asks for a file to save to.
pub fn save_as(state: &mut State, ctx: &egui::Context) {
    let (folder, file_name) = (state.document.folder(), state.document.suggested_file_name());
    state.questions.ask(ctx, Asking::SaveAs, DialogRequest::SaveAs { folder, file_name });
}

/// Saves to the document's own file. If another program has written it, that is asked about.
fn save_own(state: &mut State, ctx: &egui::Context, path: PathBuf) {
    match disk::look(&path, state.document.disk_bytes()) {
        OnDisk::Changed(bytes) => {
            let theirs = TheirFile::read(&path, bytes, state.document.planet());
            state.questions.ask_about_change(path, theirs, true);
        }
        // A file that cannot be read may hold another program's work. If there is none, writing reports the error.
        OnDisk::Unknown if path.is_file() => state.questions.replace = Some(Replace::Planet(path)),
        OnDisk::Same | OnDisk::Gone | OnDisk::Unknown => write(state, ctx, path),
    }
}

/// Saves to a file that was chosen. `agreed` is the file that the user has agreed to replace, if it exists.
pub fn save_chosen(state: &mut State, ctx: &egui::Context, file: &Path, agreed: Option<&Path>) {
    // The file that the planet was read from may have any extension.
    if let Some(own) = state.document.path().filter(|own| is_same_file(own, file)).map(Path::to_owned) {
        return save_own(state, ctx, own);
    }
    let path = with_extension(file, PRESET_EXTENSION);
    match state.document.path().filter(|own| is_same_file(own, &path)).map(Path::to_owned) {
        Some(own) => save_own(state, ctx, own),
        None if state.would_lose("The planet could not be saved", &[&path]) => state.questions.after_save = None,
        None if path.exists() && agreed != Some(&path) => state.questions.replace = Some(Replace::Planet(path)),
        None => write(state, ctx, path),
    }
}

/// Writes the file, and goes on with the action that waited for it.
pub fn write(state: &mut State, ctx: &egui::Context, path: PathBuf) {
    let planet = state.document.planet().clone();
    let problems = state.document.problems();
    if !problems.is_empty() {
        // A file that cannot be opened again would be lost work.
        let lines = problems.iter().map(|(at, problem)| format!("{at}: {problem}")).collect();
        state.report("Not saved: the planet has problems", lines);
        state.questions.after_save = None;
        return;
    }
    match planet.save_text(&path) {
        Ok(text) => {
            state.notices.say(format!("Saved to {}", path.display()));
            state.document.mark_saved(&planet, path, text);
            state.open_file.settle();
            if let Some(goal) = state.questions.after_save.take() {
                opening::pursue(state, ctx, goal);
            }
        }
        Err(error) => {
            state.questions.after_save = None;
            state.report("The planet could not be saved", error.to_string().lines().map(str::to_owned).collect());
        }
    }
}
