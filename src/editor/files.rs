//! Opening and saving, and the promise that no work is lost on the way: neither what is unsaved here, nor what stands
//! in a file that somebody else has written.

use super::app::{EditorApp, default_planet};
use super::dialogs::{DialogRequest, FileDialogs};
use super::disk::{self, OnDisk, Theirs};
use super::document::Document;
use super::file_names::{has_extension, is_same_file, readable_stem, with_extension};
use super::path_field::PathField;
use super::prompts::Message;
use super::recovery;
use super::widgets::random_seed;
use crate::planet::file::read_text;
use crate::planet::param::ParamPath;
use crate::planet::picture::folder_of;
use crate::planet::{LoadError, Planet, random, shipped};
use eframe::egui;
use std::path::{Path, PathBuf};

/// What a planet's file name ends in.
const PRESET: &str = "ron";

/// What the user wants to do that would lose unsaved work.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Goal {
    New,
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

/// A file that exists and would be replaced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(super) enum Replace {
    Planet(PathBuf),
    Table(PathBuf),
}

impl Replace {
    pub(super) fn path(&self) -> &Path {
        match self {
            Replace::Planet(path) | Replace::Table(path) => path,
        }
    }
}

/// The open file holds another text than was last read from it or written to it.
pub(super) struct Change {
    /// The file.
    pub(super) path: PathBuf,
    pub(super) theirs: Theirs,
    /// Whether this was found when the file was about to be written over.
    pub(super) saving: bool,
}

/// The state of opening and saving.
pub struct FileFlow {
    dialogs: Box<dyn FileDialogs>,
    asking: Option<Asking>,
    /// Asks for a path where the desktop has no dialogs, and what for.
    pub(super) path_field: Option<(Asking, PathField)>,
    /// Waits for an answer to "save, discard or cancel?".
    pub(super) prompt: Option<Goal>,
    /// Waits for an answer to "replace that file?".
    pub(super) replace: Option<Replace>,
    /// Waits for an answer to "whose planet?".
    pub(super) change: Option<Change>,
    /// Goes on as soon as the document is saved.
    pub(super) after_save: Option<Goal>,
    pub(super) may_close: bool,
}

impl FileFlow {
    /// Asks through these dialogs.
    pub fn new(dialogs: Box<dyn FileDialogs>) -> Self {
        Self {
            dialogs,
            asking: None,
            path_field: None,
            prompt: None,
            replace: None,
            change: None,
            after_save: None,
            may_close: false,
        }
    }

    /// Whether the window shows a question about files.
    pub(super) fn has_question(&self) -> bool {
        self.prompt.is_some() || self.replace.is_some() || self.change.is_some() || self.path_field.is_some()
    }

    /// Whether a question about files is open, here or in a dialog of the desktop: nothing else goes on meanwhile.
    pub fn is_asking(&self) -> bool {
        self.has_question() || self.asking.is_some()
    }

    /// Asks whose planet is to stand in the file.
    pub(super) fn ask_about_change(&mut self, path: PathBuf, theirs: Theirs, saving: bool) {
        self.change = Some(Change { path, theirs, saving });
    }

    /// Takes back the question about a file that is no longer the open one.
    pub(super) fn keep_to(&mut self, path: Option<&Path>) {
        if self.change.as_ref().is_some_and(|change| Some(change.path.as_path()) != path) {
            self.change = None;
            self.after_save = None;
        }
    }

    /// Takes back every question, and what was to follow: they were about a document that is gone. The answer of a
    /// dialog that is still open must not touch the next one.
    fn forget_questions(&mut self) {
        (self.asking, self.path_field, self.prompt) = (None, None, None);
        (self.replace, self.change, self.after_save) = (None, None, None);
    }
}

/// Reads the file to begin with; one that does not exist yet is the name of a new planet.
///
/// # Errors
/// What is wrong with the file, or why no planet can be saved under that name.
pub(crate) fn first_document(path: &Path) -> Result<Document, LoadError> {
    match read(path) {
        Err(LoadError::Read { source, .. }) if source.kind() == std::io::ErrorKind::NotFound => {
            let refused = |why: String| LoadError::Read { path: path.to_owned(), source: std::io::Error::other(why) };
            let folder = folder_of(path);
            if !folder.is_dir() {
                return Err(refused(format!("there is no folder {}; make it first or name another", folder.display())));
            }
            if !has_extension(path, PRESET) {
                let name = with_extension(path, PRESET);
                let name = name.file_name().unwrap_or_default().to_string_lossy();
                return Err(refused(format!(
                    "there is no such file; a new planet's name ends in .ron, such as {name}"
                )));
            }
            let planet = Planet { name: readable_stem(path), ..default_planet() };
            Ok(Document::new(planet, Some(path.to_owned())))
        }
        read => read,
    }
}

/// Reads a document without its pictures.
fn read(path: &Path) -> Result<Document, LoadError> {
    let text = read_text(path)?;
    let mut planet = Planet::from_text(&path.display().to_string(), &text)?;
    planet.set_folder(&folder_of(path));
    Ok(Document::opened(planet, path.to_owned(), text))
}

impl EditorApp {
    /// Does it, after asking if unsaved work would be lost.
    pub(super) fn pursue(&mut self, ctx: &egui::Context, goal: Goal) {
        self.files.after_save = None;
        if self.loses_work() {
            self.files.prompt = Some(goal);
        } else {
            self.reach(ctx, goal);
        }
    }

    /// Whether another document in the place of this one would lose something.
    pub(super) fn loses_work(&self) -> bool {
        self.document.is_dirty() || !self.document.rolled_over().is_empty()
    }

    /// Does it, whatever is lost.
    pub(super) fn reach(&mut self, ctx: &egui::Context, goal: Goal) {
        match goal {
            Goal::New => self.replace(Document::new(default_planet(), None)),
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
        self.show_read(path, read(path));
    }

    /// The same for the file to begin with, which need not exist yet.
    pub(super) fn begin_with(&mut self, path: &Path) {
        self.show_read(path, first_document(path));
    }

    fn show_read(&mut self, path: &Path, read: Result<Document, LoadError>) {
        match read {
            Ok(document) => self.replace(document),
            Err(error) => self.messages.push(load_failed(path, &error)),
        }
    }

    /// Puts a planet nobody has seen before in the place of this one: a step that can be undone.
    pub(super) fn roll(&mut self) {
        self.document.roll(random::random(random_seed()), "Random planet");
        self.files.forget_questions();
        self.renaming = None;
        self.panels.new_document();
        let planet = self.document.valid_planet().clone();
        self.viewport.reset_view(&planet);
        self.viewport.edit_clock.edited(&planet, std::time::Instant::now());
    }

    /// Takes over what the open file holds: a step that can be undone.
    pub(super) fn reload(&mut self, planet: Planet, bytes: Vec<u8>) {
        self.document.reload(planet, bytes);
        let planet = self.document.valid_planet().clone();
        self.viewport.edit_clock.edited(&planet, std::time::Instant::now());
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
            Some(path) => self.save_own(ctx, path),
            None => self.save_as(ctx),
        }
    }

    pub(super) fn save_as(&mut self, ctx: &egui::Context) {
        let request =
            DialogRequest::SaveAs { folder: self.document.folder(), file_name: self.document.suggested_file_name() };
        self.ask(ctx, Asking::SaveAs, request);
    }

    /// Opens a dialog, or asks for a path in the window.
    pub(super) fn ask(&mut self, ctx: &egui::Context, asking: Asking, request: DialogRequest) {
        match self.files.dialogs.start(request.clone(), waker(ctx)) {
            Ok(()) => self.files.asking = Some(asking),
            Err(why) => self.files.path_field = Some((asking, PathField::new(request, why))),
        }
    }

    /// Saves to the document's own file, unless somebody else has written there: then that is asked about.
    fn save_own(&mut self, ctx: &egui::Context, path: PathBuf) {
        match disk::look(&path, self.document.disk_bytes()) {
            OnDisk::Changed(bytes) => {
                let theirs = Theirs::read(&path, bytes, self.document.planet());
                self.files.ask_about_change(path, theirs, true);
            }
            // A file that cannot be read may be somebody else's. Where there is none, writing tells what is wrong.
            OnDisk::Unknown if path.is_file() => self.files.replace = Some(Replace::Planet(path)),
            OnDisk::Same | OnDisk::Gone | OnDisk::Unknown => self.write(ctx, path),
        }
    }

    /// Saves to a file that was chosen. `asked` is the file that somebody has agreed to replace, should it exist.
    fn save_chosen(&mut self, ctx: &egui::Context, path: PathBuf, asked: Option<&Path>) {
        if let Some(own) = self.document.path().filter(|own| is_same_file(own, &path)).map(Path::to_owned) {
            self.save_own(ctx, own);
        } else if path.exists() && asked != Some(&path) {
            self.files.replace = Some(Replace::Planet(path));
        } else {
            self.write(ctx, path);
        }
    }

    pub(super) fn write(&mut self, ctx: &egui::Context, path: PathBuf) {
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
                self.say(format!("Saved to {}", path.display()));
                self.document.mark_saved(&planet, path);
                (self.disk.notice, self.disk.put_off) = (None, None);
                if let Some(goal) = self.files.after_save.take() {
                    self.pursue(ctx, goal);
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
        let asking = self.files.asking.take();
        let failed = self.files.dialogs.failed();
        match (asking, answer, failed) {
            (Some(asking), _, Some((request, why))) => {
                self.files.path_field = Some((asking, PathField::new(request, why)));
            }
            (Some(asking), Some(file), None) => {
                let asked = file.clone();
                self.chosen(ctx, asking, file, Some(&asked));
            }
            // Cancelled, or asked about a document that is gone: nothing is to follow.
            (None, ..) | (_, None, _) => self.files.after_save = None,
        }
    }

    /// Takes the answer of the field in the window: the path, or None when the person cancelled.
    pub(super) fn take_path(&mut self, ctx: &egui::Context, path: Option<PathBuf>) {
        match (self.files.path_field.take(), path) {
            (Some((asking, _)), Some(path)) => self.chosen(ctx, asking, path, None),
            _ => self.files.after_save = None,
        }
    }

    fn chosen(&mut self, ctx: &egui::Context, asking: Asking, file: PathBuf, asked: Option<&Path>) {
        match asking {
            Asking::Open => self.pursue(ctx, Goal::OpenPath(file)),
            Asking::SaveAs => {
                // The file that the planet was read from may be called as it likes.
                let own = self.document.path().is_some_and(|own| is_same_file(own, &file));
                let path = if own { file } else { with_extension(&file, PRESET) };
                self.save_chosen(ctx, path, asked);
            }
            Asking::Picture(place) => self.choose_file(&place, &file),
            Asking::ImportTable => self.import_table(&file),
            Asking::ExportTable => {
                let path = with_extension(&file, "png");
                if path.exists() && asked != Some(&path) {
                    self.files.replace = Some(Replace::Table(path));
                } else {
                    self.export_table(&path);
                }
            }
        }
    }

    fn replace(&mut self, document: Document) {
        self.document = document;
        self.files.forget_questions();
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
