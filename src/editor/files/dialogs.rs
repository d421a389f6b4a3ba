//! File dialogs that never block the window, behind a trait so that tests can answer them. Where the desktop has no
//! dialogs, the editor asks for a path in its window.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// A dialog that is cancelled faster than this was never shown.
const TOO_FAST: Duration = Duration::from_millis(400);

/// The file that a dialog asks for.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum DialogRequest {
    /// A preset to open.
    Open {
        /// Folder to begin in.
        folder: Option<PathBuf>,
    },
    /// A picture for a height map.
    Picture {
        /// Folder to begin in.
        folder: Option<PathBuf>,
    },
    /// A mesh for a population.
    Model {
        /// Folder to begin in.
        folder: Option<PathBuf>,
    },
    /// A picture of a biome table to read.
    ImportTable {
        /// Folder to begin in.
        folder: Option<PathBuf>,
    },
    /// A file to write the picture of a biome table to.
    ExportTable {
        /// Folder to begin in.
        folder: Option<PathBuf>,
        /// Proposed file name.
        file_name: String,
    },
    /// A file to write a photograph to.
    Photograph {
        /// Folder to begin in.
        folder: Option<PathBuf>,
        /// Proposed file name.
        file_name: String,
    },
    /// A file to write the picture of ground edits to.
    BakedEdits {
        /// Folder to begin in.
        folder: Option<PathBuf>,
        /// Proposed file name.
        file_name: String,
    },
    /// A file to write a mesh to.
    Mesh {
        /// Folder to begin in.
        folder: Option<PathBuf>,
        /// Proposed file name.
        file_name: String,
    },
    /// A folder to write files to.
    Folder {
        /// Folder to begin in.
        folder: Option<PathBuf>,
        /// Proposed name of the folder.
        file_name: String,
    },
    /// A file to save a system to.
    SaveSystem {
        /// Folder to begin in.
        folder: Option<PathBuf>,
        /// Proposed file name.
        file_name: String,
    },
    /// A file to save to.
    SaveAs {
        /// Folder to begin in.
        folder: Option<PathBuf>,
        /// Proposed file name.
        file_name: String,
    },
}

impl DialogRequest {
    /// The heading of the dialog.
    pub fn title(&self) -> &'static str {
        match self {
            DialogRequest::Open { .. } => "Open planet",
            DialogRequest::Picture { .. } => "Choose a height map",
            DialogRequest::Model { .. } => "Choose a mesh",
            DialogRequest::ImportTable { .. } => "Import biome table",
            DialogRequest::ExportTable { .. } => "Export biome table",
            DialogRequest::Photograph { .. } => "Save picture",
            DialogRequest::BakedEdits { .. } => "Bake edits into a height picture",
            DialogRequest::Mesh { .. } => "Save mesh",
            DialogRequest::Folder { .. } => "Choose a folder to bake into",
            DialogRequest::SaveAs { .. } => "Save planet",
            DialogRequest::SaveSystem { .. } => "Save system",
        }
    }

    /// Kind and extensions of the files.
    fn filter(&self) -> (&'static str, &'static [&'static str]) {
        match self {
            DialogRequest::Open { .. } | DialogRequest::SaveAs { .. } => ("Planet presets", &["ron"]),
            DialogRequest::SaveSystem { .. } => ("Systems", &["ron"]),
            DialogRequest::Picture { .. } | DialogRequest::Photograph { .. } => ("Pictures", &["png", "exr"]),
            DialogRequest::ImportTable { .. } | DialogRequest::ExportTable { .. } => ("Pictures", &["png"]),
            DialogRequest::BakedEdits { .. } => ("OpenEXR pictures", &["exr"]),
            DialogRequest::Mesh { .. } => ("Meshes", &["glb", "obj"]),
            DialogRequest::Model { .. } => ("glTF meshes", &["glb", "gltf"]),
            DialogRequest::Folder { .. } => ("Folders", &[]),
        }
    }

    /// Extensions of the files.
    pub fn extensions(&self) -> &'static [&'static str] {
        self.filter().1
    }

    /// The folder to begin in.
    pub fn folder(&self) -> Option<&PathBuf> {
        match self {
            DialogRequest::Open { folder }
            | DialogRequest::Picture { folder }
            | DialogRequest::Model { folder }
            | DialogRequest::ImportTable { folder }
            | DialogRequest::ExportTable { folder, .. }
            | DialogRequest::Photograph { folder, .. }
            | DialogRequest::BakedEdits { folder, .. }
            | DialogRequest::Mesh { folder, .. }
            | DialogRequest::Folder { folder, .. }
            | DialogRequest::SaveSystem { folder, .. }
            | DialogRequest::SaveAs { folder, .. } => folder.as_ref(),
        }
    }

    /// The proposed name of a file to write.
    pub fn file_name(&self) -> Option<&str> {
        match self {
            DialogRequest::ExportTable { file_name, .. }
            | DialogRequest::Photograph { file_name, .. }
            | DialogRequest::BakedEdits { file_name, .. }
            | DialogRequest::Mesh { file_name, .. }
            | DialogRequest::Folder { file_name, .. }
            | DialogRequest::SaveSystem { file_name, .. }
            | DialogRequest::SaveAs { file_name, .. } => Some(file_name),
            _ => None,
        }
    }

    /// Whether it asks for a folder.
    pub fn is_folder(&self) -> bool {
        matches!(self, DialogRequest::Folder { .. })
    }

    /// Whether the file will be written.
    pub fn saves(&self) -> bool {
        self.file_name().is_some()
    }
}

/// Called from any thread when there is an answer.
pub type Wake = Box<dyn Fn() + Send + 'static>;

/// Asks for files. The answer comes later, through [`FileDialogs::poll`].
pub trait FileDialogs {
    /// Opens a dialog. Called on the main thread.
    ///
    /// # Errors
    /// Why this desktop cannot show one.
    fn start(&mut self, request: DialogRequest, wake: Wake) -> Result<(), String>;
    /// The answer, once: the file, or an inner None if the user cancelled.
    fn poll(&mut self) -> Option<Option<PathBuf>>;
    /// After an answer: the request and why its dialog was never shown, if so.
    fn failed(&mut self) -> Option<(DialogRequest, String)> {
        None
    }
}

/// The dialogs of the desktop.
#[derive(Default)]
pub struct NativeDialogs {
    answer: Option<Receiver<Option<PathBuf>>>,
    asked: Option<(DialogRequest, Instant)>,
    failed: Option<(DialogRequest, String)>,
}

const NO_DIALOGS: &str = "This desktop shows no file dialogs (xdg-desktop-portal or zenity would): type the path.";

/// Whether this desktop can show a file dialog. On Linux that needs a portal, reached over the session bus, or zenity.
/// Without either, a dialog would be "cancelled" at once without a reason.
fn can_show_dialogs() -> bool {
    if !cfg!(target_os = "linux") {
        return true;
    }
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    set("DBUS_SESSION_BUS_ADDRESS").is_some()
        || set("XDG_RUNTIME_DIR").is_some_and(|folder| PathBuf::from(folder).join("bus").exists())
        || set("PATH").is_some_and(|path| std::env::split_paths(&path).any(|folder| folder.join("zenity").is_file()))
}

impl FileDialogs for NativeDialogs {
    fn start(&mut self, request: DialogRequest, wake: Wake) -> Result<(), String> {
        if !can_show_dialogs() {
            return Err(NO_DIALOGS.to_owned());
        }
        let (name, extensions) = request.filter();
        let mut dialog = rfd::AsyncFileDialog::new().add_filter(name, extensions).set_title(request.title());
        if let Some(folder) = request.folder() {
            dialog = dialog.set_directory(folder);
        }
        // Some desktops need the dialog made on the main thread. Another thread waits for the answer.
        let future: std::pin::Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>> = match request.file_name()
        {
            _ if request.is_folder() => Box::pin(dialog.pick_folder()),
            Some(file_name) => Box::pin(dialog.set_file_name(file_name).save_file()),
            None => Box::pin(dialog.pick_file()),
        };
        self.asked = Some((request, Instant::now()));
        let (sender, receiver) = channel();
        self.answer = Some(receiver);
        std::thread::spawn(move || {
            let file = pollster::block_on(future).map(|handle| handle.path().to_owned());
            // The receiver is gone if the editor has closed.
            let _ = sender.send(file);
            wake();
        });
        Ok(())
    }

    fn poll(&mut self) -> Option<Option<PathBuf>> {
        let answer = match self.answer.as_ref()?.try_recv() {
            Ok(answer) => answer,
            Err(std::sync::mpsc::TryRecvError::Empty) => return None,
            // The waiting thread has panicked: treated as a cancelled dialog.
            Err(std::sync::mpsc::TryRecvError::Disconnected) => None,
        };
        self.answer = None;
        let asked = self.asked.take().filter(|(_, since)| answer.is_none() && since.elapsed() < TOO_FAST);
        self.failed = asked.map(|(request, _)| (request, NO_DIALOGS.to_owned()));
        Some(answer)
    }

    fn failed(&mut self) -> Option<(DialogRequest, String)> {
        self.failed.take()
    }
}

/// No dialogs at all, for tests.
pub struct NoDialogs;

impl FileDialogs for NoDialogs {
    fn start(&mut self, _request: DialogRequest, _wake: Wake) -> Result<(), String> {
        Err(NO_DIALOGS.to_owned())
    }

    fn poll(&mut self) -> Option<Option<PathBuf>> {
        None
    }
}

/// Prepared answers, for tests.
#[derive(Default)]
pub struct ScriptedDialogs {
    answers: VecDeque<Option<PathBuf>>,
    pending: Option<Option<PathBuf>>,
}

impl ScriptedDialogs {
    /// Gives these answers in order; every later dialog is cancelled.
    pub fn new(answers: impl IntoIterator<Item = Option<PathBuf>>) -> Self {
        Self { answers: answers.into_iter().collect(), pending: None }
    }
}

impl FileDialogs for ScriptedDialogs {
    fn start(&mut self, _request: DialogRequest, wake: Wake) -> Result<(), String> {
        self.pending = Some(self.answers.pop_front().flatten());
        wake();
        Ok(())
    }

    fn poll(&mut self) -> Option<Option<PathBuf>> {
        self.pending.take()
    }
}
