//! Opening and saving, and the promise that no work is lost on the way.

use super::app::{EditorApp, default_planet};
use super::command::Command;
use super::dialogs::{DialogRequest, FileDialogs};
use super::document::Document;
use super::handle::Action;
use super::prompts::Message;
use super::recovery;
use super::widgets::random_seed;
use crate::planet::param::ParamPath;
use crate::planet::{LoadError, Planet, random, shipped};
use eframe::egui;
use std::path::{Path, PathBuf};

/// What the user wants to do that would lose unsaved work.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Goal {
    New,
    Random,
    Open,
    OpenPath(PathBuf),
    OpenShipped(usize),
    Quit,
}

/// The dialog that is open.
pub(super) enum Asking {
    Open,
    SaveAs,
    /// A picture for the parameter there.
    Picture(ParamPath),
    /// A biome table to import.
    ImportTable,
    /// A file for the biome table.
    ExportTable,
}

/// The state of opening and saving.
pub struct FileFlow {
    dialogs: Box<dyn FileDialogs>,
    asking: Option<Asking>,
    /// Waits for an answer to "save, discard or cancel?".
    pub(super) prompt: Option<Goal>,
    /// Goes on as soon as the document is saved.
    after_save: Option<Goal>,
    may_close: bool,
}

impl FileFlow {
    /// Asks through these dialogs.
    pub fn new(dialogs: Box<dyn FileDialogs>) -> Self {
        Self { dialogs, asking: None, prompt: None, after_save: None, may_close: false }
    }

    /// Whether the prompt about unsaved work is open: nothing else goes on meanwhile.
    pub fn is_asking(&self) -> bool {
        self.prompt.is_some()
    }
}

/// An answer to the prompt.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum PromptAnswer {
    Save,
    Discard,
    Cancel,
}

impl EditorApp {
    /// Does it, after asking if unsaved work would be lost.
    pub(super) fn pursue(&mut self, ctx: &egui::Context, goal: Goal) {
        self.files.after_save = None;
        if self.document.is_dirty() {
            self.files.prompt = Some(goal);
        } else {
            self.reach(ctx, goal);
        }
    }

    /// Does it, whatever is lost.
    fn reach(&mut self, ctx: &egui::Context, goal: Goal) {
        match goal {
            Goal::New => self.replace(Document::new(default_planet(), None)),
            Goal::Random => self.replace(Document::unsaved(random::random(random_seed()))),
            Goal::Open => {
                let folder = self.document.folder();
                self.ask(ctx, Asking::Open, DialogRequest::Open { folder });
            }
            Goal::OpenPath(path) => self.load(&path),
            Goal::OpenShipped(index) => {
                if let Some(preset) = shipped::ALL.get(index) {
                    match Planet::from_text(preset.file, preset.text) {
                        Ok(planet) => self.replace(Document::new(planet, None)),
                        Err(error) => self.messages.push(load_failed(Path::new(preset.file), &error)),
                    }
                }
            }
            Goal::Quit => {
                self.files.may_close = true;
                ctx.send_viewport_cmd(egui::ViewportCommand::Close);
            }
        }
    }

    /// Opens a file; what is wrong with it is shown in a window, and the document stays.
    pub(super) fn load(&mut self, path: &Path) {
        match Planet::open(path) {
            Ok(planet) => self.replace(Document::new(planet, Some(path.to_owned()))),
            Err(error) => self.messages.push(load_failed(path, &error)),
        }
    }

    /// Takes over the first thing a crash left behind, or throws it away.
    pub(super) fn recover(&mut self, keep: bool) {
        if !self.orphans.is_empty() {
            let orphan = self.orphans.remove(0);
            match &self.recovery {
                // Kept until this editor's own file takes its place: a second crash loses nothing.
                Some(recovery) if keep => recovery.adopt(&orphan.file),
                _ => recovery::remove(&orphan.file),
            }
            if keep {
                self.replace(Document::unsaved(orphan.planet));
            }
        }
    }

    /// Asks for a picture for the parameter at `path`.
    pub(super) fn browse(&mut self, ctx: &egui::Context, path: ParamPath) {
        let folder = self.document.folder();
        self.ask(ctx, Asking::Picture(path), DialogRequest::Picture { folder });
    }

    pub(super) fn save(&mut self, ctx: &egui::Context) {
        match self.document.path().map(Path::to_owned) {
            Some(path) => self.save_to(ctx, path),
            None => self.save_as(ctx),
        }
    }

    pub(super) fn save_as(&mut self, ctx: &egui::Context) {
        let request =
            DialogRequest::SaveAs { folder: self.document.folder(), file_name: self.document.suggested_file_name() };
        self.ask(ctx, Asking::SaveAs, request);
    }

    /// Opens a dialog, or says why there is none.
    pub(super) fn ask(&mut self, ctx: &egui::Context, asking: Asking, request: DialogRequest) {
        match self.files.dialogs.start(request, waker(ctx)) {
            Ok(()) => self.files.asking = Some(asking),
            Err(why) => {
                self.files.after_save = None;
                self.messages.push(Message { title: "No file dialog".to_owned(), lines: vec![why] });
            }
        }
    }

    fn save_to(&mut self, ctx: &egui::Context, path: PathBuf) {
        let planet = self.document.planet().clone();
        let problems = self.document.problems();
        if !problems.is_empty() {
            // A file that cannot be opened again would be lost work.
            let lines = problems.iter().map(|(at, problem)| format!("{at}: {problem}")).collect();
            self.messages.push(Message { title: "Not saved: the planet has problems".to_owned(), lines });
            self.files.after_save = None;
            return;
        }
        match planet.save(&path) {
            Ok(()) => {
                self.document.mark_saved(&planet, path);
                if let Some(goal) = self.files.after_save.take() {
                    self.reach(ctx, goal);
                }
            }
            Err(error) => {
                self.files.after_save = None;
                let lines = error.to_string().lines().map(str::to_owned).collect();
                self.messages.push(Message { title: "The planet could not be saved".to_owned(), lines });
            }
        }
    }

    /// Takes the answer of an open dialog.
    pub(super) fn poll_dialogs(&mut self, ctx: &egui::Context) {
        let Some(answer) = self.files.dialogs.poll() else { return };
        match (self.files.asking.take(), answer) {
            (Some(Asking::Open), Some(path)) => self.pursue(ctx, Goal::OpenPath(path)),
            (Some(Asking::SaveAs), Some(path)) => {
                self.save_to(ctx, if path.extension().is_none() { path.with_extension("ron") } else { path });
            }
            (Some(Asking::Picture(place)), Some(file)) => self.choose_file(&place, &file),
            (Some(Asking::ImportTable), Some(file)) => self.import_table(&file),
            (Some(Asking::ExportTable), Some(file)) => self.export_table(&file),
            (_, None) => self.files.after_save = None,
            (None, Some(_)) => {}
        }
    }

    /// The window's close button: holds it back while there is unsaved work.
    pub(super) fn handle_close_request(&mut self, ctx: &egui::Context) {
        if !ctx.input(|input| input.viewport().close_requested()) || self.files.may_close {
            return;
        }
        // A value that is still being typed makes the document unsaved too, once it is taken over.
        if ctx.text_edit_focused() {
            ctx.send_viewport_cmd(egui::ViewportCommand::CancelClose);
            self.actions.push(Action::Command(Command::Quit));
        } else if self.document.is_dirty() {
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

    fn replace(&mut self, document: Document) {
        self.document = document;
        // A dialog that is still open asked about the document before: its answer must not touch this one.
        self.files.asking = None;
        self.files.after_save = None;
        self.renaming = None;
        let planet = self.document.valid_planet().clone();
        self.viewport.reset_view(&planet);
        self.panels.new_document();
    }
}

fn waker(ctx: &egui::Context) -> super::dialogs::Wake {
    let ctx = ctx.clone();
    Box::new(move || ctx.request_repaint())
}

fn load_failed(path: &Path, error: &LoadError) -> Message {
    let lines = match error {
        LoadError::Read { source, .. } => vec![format!("{}: {source}", path.display())],
        LoadError::Invalid { file, problems } => problems
            .iter()
            .map(|problem| {
                let at = if problem.line > 0 { format!(":{}:{}", problem.line, problem.column) } else { String::new() };
                let path = if problem.path.is_empty() { String::new() } else { format!("{}: ", problem.path) };
                format!("{file}{at}: {path}{}", problem.message)
            })
            .collect(),
    };
    Message { title: "The planet could not be opened".to_owned(), lines }
}
