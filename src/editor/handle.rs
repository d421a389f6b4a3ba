//! The one place that carries out what the user asked for.

use super::answers::{ChangeAnswer, PromptAnswer, ReplaceAnswer};
use super::app::EditorApp;
use super::bookmarks::BookmarkAction;
use super::command::Command;
use super::files::Goal;
use super::viewport::camera::{Cameras, Ground};
use crate::lod::Quality;
use crate::planet::param::ParamPath;
use eframe::egui;
use std::path::PathBuf;

/// A command, or one of those that carry a value.
#[derive(Clone, Debug, PartialEq)]
pub enum Action {
    /// See [`Command`].
    Command(Command),
    /// Open a file.
    OpenPath(PathBuf),
    /// Open a shipped preset.
    OpenShipped(usize),
    /// Answer the prompt about unsaved work.
    Answer(PromptAnswer),
    /// Answer the question whether a file is to be replaced.
    Replace(ReplaceAnswer),
    /// Answer the question whose planet is to stand in the open file.
    Change(ChangeAnswer),
    /// Answer the field that asks for a path; None cancels.
    Path(Option<PathBuf>),
    /// Take work over that a crash left behind, or throw it away.
    Recover(bool),
    /// Choose a file for the parameter there.
    Browse(ParamPath),
    /// Do something with a bookmark.
    Bookmark(BookmarkAction),
    /// Draw better or faster.
    Quality(Quality),
}

impl Action {
    /// Whether a value that is being typed must be taken over first, so that it is neither lost
    /// nor left out of the file.
    fn needs_typed_value(&self) -> bool {
        use Command::{New, Open, Quit, RandomPlanet, Save, SaveAs};
        match self {
            Action::Command(command) => matches!(command, New | Open | Save | SaveAs | Quit | RandomPlanet),
            Action::OpenPath(_) | Action::OpenShipped(_) => true,
            Action::Browse(_) => true,
            Action::Answer(_) | Action::Replace(_) | Action::Change(_) | Action::Path(_) => false,
            Action::Recover(_) | Action::Bookmark(_) | Action::Quality(_) => false,
        }
    }
}

impl EditorApp {
    /// Carries out everything asked for since the last frame.
    pub(super) fn handle_actions(&mut self, ctx: &egui::Context) {
        for action in std::mem::take(&mut self.actions) {
            let focused = ctx.memory(egui::Memory::focused);
            if let Some(id) = focused
                && action.needs_typed_value()
                && ctx.text_edit_focused()
                && !self.files.has_question()
            {
                ctx.memory_mut(|memory| memory.surrender_focus(id));
                self.deferred.push(action);
                continue;
            }
            self.handle(ctx, action);
        }
    }

    fn handle(&mut self, ctx: &egui::Context, action: Action) {
        match action {
            Action::Command(command) => self.handle_command(ctx, command),
            Action::OpenPath(path) => self.pursue(ctx, Goal::OpenPath(path)),
            Action::OpenShipped(index) => self.pursue(ctx, Goal::OpenShipped(index)),
            Action::Answer(answer) => self.answer_prompt(ctx, answer),
            Action::Replace(answer) => self.answer_replace(ctx, answer),
            Action::Change(answer) => self.answer_change(ctx, answer),
            Action::Path(path) => self.take_path(ctx, path),
            Action::Recover(keep) => self.recover(keep),
            Action::Browse(path) => self.browse(ctx, path),
            Action::Bookmark(action) => self.handle_bookmark(action),
            Action::Quality(quality) => self.viewport.settings.quality = quality,
        }
    }

    fn handle_command(&mut self, ctx: &egui::Context, command: Command) {
        match command {
            Command::New => self.pursue(ctx, Goal::New),
            Command::Open => self.pursue(ctx, Goal::Open),
            Command::Save => self.save(ctx),
            Command::SaveAs => self.save_as(ctx),
            Command::Quit => self.pursue(ctx, Goal::Quit),
            Command::RandomPlanet => self.roll(),
            Command::Undo => {
                self.document.undo();
                self.after_jump(ctx);
            }
            Command::Redo => {
                self.document.redo();
                self.after_jump(ctx);
            }
            Command::ResetView => {
                let planet = self.document.valid_planet().clone();
                self.viewport.reset_view(&planet);
            }
            Command::PlayPause => self.viewport.settings.playing ^= true,
            Command::TogglePanel => self.show_panel ^= true,
            Command::TogglePerformance => self.show_performance ^= true,
            Command::ToggleFullscreen => {
                let fullscreen = ctx.input(|input| input.viewport().fullscreen.unwrap_or(false));
                ctx.send_viewport_cmd(egui::ViewportCommand::Fullscreen(!fullscreen));
            }
            Command::ToggleTheme => {
                let dark = ctx.theme() == egui::Theme::Dark;
                ctx.set_theme(if dark { egui::Theme::Light } else { egui::Theme::Dark });
            }
            Command::Controls => self.show_controls ^= true,
            Command::Move(mode) => {
                self.move_cameras(|cameras, ground| cameras.set_mode(mode, ground));
                self.viewport.take_focus();
            }
            Command::LevelView => self.move_cameras(Cameras::level),
            Command::Dive => self.move_cameras(|cameras, _| cameras.set_dive(!cameras.dives())),
            Command::FreezeDetail => self.viewport.settings.freeze_detail ^= true,
            Command::Show(view) => self.viewport.settings.debug_view = view,
            Command::AddBookmark => self.add_bookmark(),
            Command::ImportTable => self.ask_for_table(ctx, true),
            Command::ExportTable => self.ask_for_table(ctx, false),
            Command::GoTo(index) => self.go_to_bookmark(usize::from(index)),
        }
    }

    fn move_cameras(&mut self, change: impl FnOnce(&mut Cameras, &dyn Ground)) {
        let planet = self.document.valid_planet().clone();
        self.viewport.move_cameras(&planet, change);
    }

    /// After undo and redo: measure the picture as after any edit.
    fn after_jump(&mut self, ctx: &egui::Context) {
        let planet = self.document.valid_planet().clone();
        self.viewport.edit_clock.edited(&planet, std::time::Instant::now());
        ctx.request_repaint();
    }
}
