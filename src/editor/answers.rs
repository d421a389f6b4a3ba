//! What follows from the answers to questions about files, and from the window's close button.

use super::app::EditorApp;
use super::command::Command;
use super::disk::Theirs;
use super::files::{Change, Goal, Replace};
use super::handle::Action;
use eframe::egui;

/// An answer to the prompt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum PromptAnswer {
    Save,
    Discard,
    Cancel,
}

/// An answer to the question whether a file is to be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum ReplaceAnswer {
    Replace,
    OtherName,
    Cancel,
}

/// An answer to the question whose planet is to stand in the open file.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum ChangeAnswer {
    Reload,
    KeepMine,
    SaveAs,
    Cancel,
}

impl EditorApp {
    /// Goes on after the question whether a file is to be replaced.
    pub(super) fn answer_replace(&mut self, ctx: &egui::Context, answer: ReplaceAnswer) {
        let Some(replace) = self.files.replace.take() else { return };
        match (answer, replace) {
            (ReplaceAnswer::Replace, Replace::Planet(path)) => self.write(ctx, path),
            (ReplaceAnswer::Replace, Replace::Table(path)) => self.export_table(&path),
            (ReplaceAnswer::OtherName, Replace::Planet(_)) => self.save_as(ctx),
            (ReplaceAnswer::OtherName, Replace::Table(_)) => self.ask_for_table(ctx, false),
            (ReplaceAnswer::Cancel, _) => self.files.after_save = None,
        }
    }

    /// Goes on after the question whose planet is to stand in the open file.
    pub(super) fn answer_change(&mut self, ctx: &egui::Context, answer: ChangeAnswer) {
        let Some(Change { theirs: Theirs { bytes, planet }, saving, .. }) = self.files.change.take() else { return };
        match (answer, planet) {
            (ChangeAnswer::Reload, Ok(planet)) => {
                self.files.after_save = None;
                self.reload(planet, bytes);
            }
            (ChangeAnswer::KeepMine, planet) => {
                // Theirs has been seen: the next save is one over it.
                self.document.note_disk(planet.ok(), Some(bytes));
                if saving {
                    self.save(ctx);
                }
            }
            (ChangeAnswer::SaveAs, _) => {
                // Mine is to stand elsewhere. Should it come back to this file after all, that is asked about again.
                self.disk.put_off = Some(bytes);
                self.save_as(ctx);
            }
            (ChangeAnswer::Cancel, _) | (ChangeAnswer::Reload, Err(_)) => {
                self.files.after_save = None;
                self.disk.put_off = Some(bytes);
            }
        }
    }

    /// The window's close button: holds it back while there is unsaved work.
    pub(super) fn handle_close_request(&mut self, ctx: &egui::Context) {
        if !ctx.input(|input| input.viewport().close_requested()) || self.files.may_close {
            return;
        }
        // A value that is still being typed makes the document unsaved too, once it is taken over. The field of a
        // question belongs to no value, and keeps the keys.
        if ctx.text_edit_focused() && !self.files.has_question() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.actions.push(Action::Command(Command::Quit));
        } else if self.loses_work() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.files.prompt = Some(Goal::Quit);
        }
    }

    /// Goes on after the prompt about unsaved work.
    pub(super) fn answer_prompt(&mut self, ctx: &egui::Context, answer: PromptAnswer) {
        let Some(goal) = self.files.prompt.take() else { return };
        match answer {
            PromptAnswer::Save => {
                self.files.after_save = Some(goal);
                self.save(ctx);
            }
            PromptAnswer::Discard => self.reach(ctx, goal),
            PromptAnswer::Cancel => {}
        }
    }
}
