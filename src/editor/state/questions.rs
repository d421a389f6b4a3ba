//! Questions about files, and the actions that wait for the answers.

use super::bake_settings::Product;
use super::shooting::Subject;
use super::templates::Template;
use crate::editor::files::dialogs::{DialogRequest, FileDialogs, Wake};
use crate::editor::files::disk::TheirFile;
use crate::editor::viewport::travel::Arrival;
use crate::planet::Planet;
use crate::planet::param::ParamPath;
use eframe::egui;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// An action that would lose unsaved work.
#[derive(Clone, Debug, PartialEq, Eq)]
#[allow(missing_docs)]
pub enum Goal {
    /// Begin a planet from this template.
    Begin(Template),
    Open,
    OpenPath(PathBuf),
    /// The shipped preset of this index.
    OpenShipped(usize),
    /// The planet of this body of the open system.
    Visit(usize, Arrival),
    /// The shipped system of this index.
    OpenSystem(usize),
    /// A new system around the planet.
    BeginSystem,
    /// Draw the planet alone.
    LeaveSystem,
    Quit,
}

/// What has unsaved changes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Work {
    /// The open planet.
    Planet,
    /// The open system.
    System,
}

/// The use of the file that is asked for.
#[derive(Clone, Debug, PartialEq)]
pub enum Asking {
    /// A preset to open.
    Open,
    /// A file to save the planet to.
    SaveAs,
    /// A picture for the parameter at this path.
    Picture(ParamPath),
    /// A picture of a biome table to import.
    ImportTable,
    /// A file to export the biome table to.
    ExportTable,
    /// A file for a photograph or a film.
    Photograph(Subject),
    /// A folder or a file for what is baked.
    Baked(Product),
    /// A picture for the ground edits of these indices.
    BakedEdits(Vec<usize>),
    /// A file to save the system to.
    SaveSystem,
    /// The preset of a new body about this one.
    Body(usize),
}

/// A file that exists and would be replaced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Replace {
    /// By the planet.
    Planet(PathBuf),
    /// By the picture of the biome table.
    Table(PathBuf),
    /// By a mesh.
    Mesh(PathBuf),
    /// By the system.
    System(PathBuf),
    /// By the picture of ground edits.
    BakedEdits {
        /// Their indices.
        edits: Vec<usize>,
        /// The file that was chosen.
        path: PathBuf,
    },
    /// By a photograph, or by the frames of a film of this name.
    Photograph {
        /// What is taken.
        subject: Subject,
        /// The file that was chosen.
        path: PathBuf,
        /// The first file that would be replaced.
        first: PathBuf,
    },
}

impl Replace {
    /// The file.
    pub fn path(&self) -> &Path {
        match self {
            Replace::Planet(path)
            | Replace::Table(path)
            | Replace::Mesh(path)
            | Replace::System(path)
            | Replace::BakedEdits { path, .. }
            | Replace::Photograph { first: path, .. } => path,
        }
    }
}

/// The open file holds another text than was last read from it or written to it.
pub struct Change {
    /// The file.
    pub path: PathBuf,
    /// Its content now.
    pub theirs: TheirFile,
    /// Whether this was found when the file was about to be saved.
    pub saving: bool,
}

/// A path that the user types, because the desktop shows no dialogs.
#[derive(Clone, Debug, PartialEq)]
pub struct WantedPath {
    /// The use of the file.
    pub asking: Asking,
    /// The dialog that would have been shown.
    pub request: DialogRequest,
    /// Why there is no dialog.
    pub why: String,
}

/// Questions about files that wait for an answer.
pub struct Questions {
    dialogs: Box<dyn FileDialogs>,
    /// The use of the file that a dialog of the desktop asks for.
    in_dialog: Option<Asking>,
    /// "Which path?"
    pub path: Option<WantedPath>,
    /// "Save, discard or cancel?", and the action that waits for the answer.
    pub unsaved: Option<(Work, Goal)>,
    /// "Replace that file?"
    pub replace: Option<Replace>,
    /// "The file has changed on disk: whose planet?"
    pub change: Option<Change>,
    /// The action that follows once the document is saved.
    pub after_save: Option<Goal>,
    /// The picture that was chosen for the brush in hand.
    pub for_brush: Option<PathBuf>,
    /// The planet whose unsaved changes the user gave up for a flight to another body; the flight ends with it.
    pub given_up: Option<Arc<Planet>>,
    /// Whether the window closes without another question.
    pub may_close: bool,
}

impl Questions {
    /// No questions yet; files are asked for through `dialogs`.
    pub fn new(dialogs: Box<dyn FileDialogs>) -> Self {
        Self {
            dialogs,
            in_dialog: None,
            path: None,
            unsaved: None,
            replace: None,
            change: None,
            after_save: None,
            given_up: None,
            for_brush: None,
            may_close: false,
        }
    }

    /// Whether the window shows a question about files.
    pub fn has_question(&self) -> bool {
        self.unsaved.is_some() || self.replace.is_some() || self.change.is_some() || self.path.is_some()
    }

    /// Whether a question about files is open, in the window or in a dialog of the desktop. Shortcuts, dropped files
    /// and changes on disk wait meanwhile.
    pub fn is_asking(&self) -> bool {
        self.has_question() || self.in_dialog.is_some()
    }

    /// Asks for a file: in a dialog of the desktop, or else for a path in the window.
    pub fn ask(&mut self, ctx: &egui::Context, asking: Asking, request: DialogRequest) {
        let ctx = ctx.clone();
        let wake: Wake = Box::new(move || ctx.request_repaint());
        match self.dialogs.start(request.clone(), wake) {
            Ok(()) => self.in_dialog = Some(asking),
            Err(why) => self.path = Some(WantedPath { asking, request, why }),
        }
    }

    /// The file chosen in a dialog, and its use, once. A cancelled dialog cancels the action that was to follow.
    pub fn poll(&mut self) -> Option<(Asking, PathBuf)> {
        let answer = self.dialogs.poll()?;
        let failed = self.dialogs.failed();
        match (self.in_dialog.take(), answer, failed) {
            (Some(asking), _, Some((request, why))) => {
                self.path = Some(WantedPath { asking, request, why });
                None
            }
            (Some(asking), Some(file), None) => Some((asking, file)),
            // Cancelled, or asked about a document that has been replaced since.
            (None, ..) | (_, None, _) => {
                self.after_save = None;
                None
            }
        }
    }

    /// Asks whose planet to keep in the open file.
    pub fn ask_about_change(&mut self, path: PathBuf, theirs: TheirFile, saving: bool) {
        self.change = Some(Change { path, theirs, saving });
    }

    /// Withdraws the question about a changed file unless that file is `path`, the open one.
    pub fn keep_change_of(&mut self, path: Option<&Path>) {
        if self.change.as_ref().is_some_and(|change| Some(change.path.as_path()) != path) {
            self.change = None;
            self.after_save = None;
        }
    }

    /// Withdraws every question: the document was replaced. The answer of a dialog that is still open must not
    /// touch the new document.
    pub fn forget(&mut self) {
        (self.in_dialog, self.path, self.unsaved) = (None, None, None);
        (self.replace, self.change, self.after_save) = (None, None, None);
        (self.given_up, self.for_brush) = (None, None);
    }
}
