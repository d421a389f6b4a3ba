//! Answers to questions about files, and the window's close button.

use super::{baking, biome_table, edit_baking, opening, pictures, saving, shooting, system};
use crate::editor::command::{Action, ChangeAnswer, Command, Commands, ReplaceAnswer, UnsavedAnswer};
use crate::editor::files::disk::TheirFile;
use crate::editor::state::State;
use crate::editor::state::bake_settings::Product;
use crate::editor::state::questions::{Asking, Change, Goal, Replace, Work};
use eframe::egui;
use std::path::{Path, PathBuf};

/// Takes the answer of a dialog of the desktop, if there is one.
pub fn poll_dialogs(state: &mut State, ctx: &egui::Context) {
    if let Some((asking, file)) = state.questions.poll() {
        // The dialog itself has asked whether to replace the file.
        let agreed = file.clone();
        chosen(state, ctx, asking, file, Some(&agreed));
    }
}

/// Goes on with a path that was typed in the window; None cancels.
pub fn path(state: &mut State, ctx: &egui::Context, path: Option<PathBuf>) {
    match (state.questions.path.take(), path) {
        (Some(wanted), Some(path)) => chosen(state, ctx, wanted.asking, path, None),
        _ => state.questions.after_save = None,
    }
}

fn chosen(state: &mut State, ctx: &egui::Context, asking: Asking, file: PathBuf, agreed: Option<&Path>) {
    match asking {
        Asking::Open => opening::pursue(state, ctx, Goal::OpenPath(file)),
        Asking::SaveAs => saving::save_chosen(state, ctx, &file, agreed),
        Asking::Picture(path) => pictures::choose(state, &path, &file),
        Asking::ImportTable => biome_table::import(state, &file),
        Asking::ExportTable => biome_table::export_chosen(state, &file, agreed),
        Asking::BakedEdits(edits) => edit_baking::chosen(state, ctx, edits, &file, agreed),
        Asking::Baked(product) => baking::chosen(state, ctx, product, &file, agreed),
        Asking::SaveSystem => system::save_chosen(state, ctx, &file, agreed),
        Asking::Body(parent) => system::add_file(state, parent, &file),
        Asking::Photograph(subject) => shooting::chosen(state, ctx, subject, &file, agreed),
    }
}

/// Goes on after the question about unsaved work.
pub fn unsaved(state: &mut State, ctx: &egui::Context, answer: UnsavedAnswer) {
    let Some((work, goal)) = state.questions.unsaved.take() else { return };
    match (answer, work) {
        (UnsavedAnswer::Save, Work::Planet) => {
            state.questions.after_save = Some(goal);
            saving::save(state, ctx);
        }
        (UnsavedAnswer::Save, Work::System) => {
            state.questions.after_save = Some(goal);
            system::save(state, ctx);
        }
        (UnsavedAnswer::Discard, Work::Planet) => {
            // The flight goes on with the planet as it is.
            let flies = matches!(goal, Goal::Visit(..));
            state.questions.given_up = flies.then(|| state.document.planet().clone());
            opening::pursue_past_planet(state, ctx, goal);
        }
        (UnsavedAnswer::Discard, Work::System) => opening::reach(state, ctx, goal),
        (UnsavedAnswer::Cancel, _) => opening::give_up(state, &goal),
    }
}

/// Goes on after the question whether to replace a file.
pub fn replace(state: &mut State, ctx: &egui::Context, answer: ReplaceAnswer) {
    let Some(replace) = state.questions.replace.take() else { return };
    match (answer, replace) {
        (ReplaceAnswer::Replace, Replace::Planet(path)) => saving::write(state, ctx, path),
        (ReplaceAnswer::Replace, Replace::Table(path)) => biome_table::export(state, &path),
        (ReplaceAnswer::Replace, Replace::System(path)) => system::write(state, ctx, &path),
        (ReplaceAnswer::Replace, Replace::Mesh(path)) => baking::start(state, ctx, Product::Mesh, &path),
        (ReplaceAnswer::Replace, Replace::BakedEdits { edits, path }) => edit_baking::start(state, ctx, edits, &path),
        (ReplaceAnswer::Replace, Replace::Photograph { subject, path, .. }) => {
            shooting::start(state, ctx, subject, &path);
        }
        (ReplaceAnswer::OtherName, Replace::Planet(_)) => saving::save_as(state, ctx),
        (ReplaceAnswer::OtherName, Replace::Table(_)) => biome_table::ask_for_export(state, ctx),
        (ReplaceAnswer::OtherName, Replace::System(_)) => system::save_as(state, ctx),
        (ReplaceAnswer::OtherName, Replace::Mesh(_)) => baking::ask(state, ctx),
        (ReplaceAnswer::OtherName, Replace::BakedEdits { edits, .. }) => edit_baking::ask(state, ctx, edits),
        (ReplaceAnswer::OtherName, Replace::Photograph { subject, .. }) => shooting::ask(state, ctx, subject),
        (ReplaceAnswer::Cancel, _) => state.questions.after_save = None,
    }
}

/// Goes on after the question whose planet to keep in the open file.
pub fn change(state: &mut State, ctx: &egui::Context, answer: ChangeAnswer) {
    let Some(Change { theirs: TheirFile { bytes, planet }, saving, .. }) = state.questions.change.take() else {
        return;
    };
    match (answer, planet) {
        (ChangeAnswer::Reload, Ok(planet)) => {
            state.questions.after_save = None;
            state.reload(planet, bytes);
        }
        (ChangeAnswer::KeepMine, planet) => {
            // The user knows their text: the next save replaces it without a question.
            state.document.note_disk(planet.ok(), Some(bytes));
            if saving {
                saving::save(state, ctx);
            }
        }
        (ChangeAnswer::SaveAs, _) => {
            // If the user then chooses this file after all, the question comes again.
            state.open_file.put_off = Some(bytes);
            saving::save_as(state, ctx);
        }
        (ChangeAnswer::Cancel, _) | (ChangeAnswer::Reload, Err(_)) => {
            state.questions.after_save = None;
            state.open_file.put_off = Some(bytes);
        }
    }
}

/// The window's close button: keeps the window open while there is unsaved work.
pub fn close_request(state: &mut State, ctx: &egui::Context, commands: &mut Commands) {
    if !ctx.input(|input| input.viewport().close_requested()) || state.questions.may_close {
        return;
    }
    // A value that is being typed becomes unsaved work once it is taken over. The field of a question belongs to no
    // value, and keeps the focus.
    if ctx.text_edit_focused() && !state.questions.has_question() {
        ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
        commands.push(Action::Command(Command::Quit));
    } else if state.loses_work() || state.system_is_dirty() {
        ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
        opening::pursue(state, ctx, Goal::Quit);
    }
}
