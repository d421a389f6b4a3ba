//! File dialogs that never block the window, behind a trait so that tests answer them.

use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::mpsc::{Receiver, channel};

/// What a dialog asks for.
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
    /// A picture of a biome table to read.
    ImportTable {
        /// Folder to begin in.
        folder: Option<PathBuf>,
    },
    /// A file to write the picture of a biome table to.
    ExportTable {
        /// Folder to begin in.
        folder: Option<PathBuf>,
        /// File name to offer.
        file_name: String,
    },
    /// A file to save to.
    SaveAs {
        /// Folder to begin in.
        folder: Option<PathBuf>,
        /// File name to offer.
        file_name: String,
    },
}

/// Called from any thread when an answer has come.
pub type Wake = Box<dyn Fn() + Send + 'static>;

/// Asks for files. The answer comes later, through [`FileDialogs::poll`].
pub trait FileDialogs {
    /// Opens a dialog. Called on the main thread.
    ///
    /// # Errors
    /// Why this desktop cannot show one, and what to do.
    fn start(&mut self, request: DialogRequest, wake: Wake) -> Result<(), String>;
    /// The answer, once: the file, or None when the person cancelled.
    fn poll(&mut self) -> Option<Option<PathBuf>>;
}

/// The dialogs of the desktop.
#[derive(Default)]
pub struct NativeDialogs {
    answer: Option<Receiver<Option<PathBuf>>>,
}

const NO_DIALOGS: &str = "This desktop has no file dialogs. Install xdg-desktop-portal or zenity; or start Tellus with \
    the file's name (`tellus my.ron`), drop files on the window, and save with Ctrl+S.";

/// Whether anything here can show a file dialog: on Linux that is a portal, reached over the session bus, or zenity.
/// Without either the dialog would be "cancelled" at once, and nobody would know why.
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
        let presets = || rfd::AsyncFileDialog::new().add_filter("Planet presets", &["ron"]);
        let pictures = || rfd::AsyncFileDialog::new().add_filter("Pictures", &["png", "exr"]);
        let tables = || rfd::AsyncFileDialog::new().add_filter("Pictures", &["png"]);
        let with_folder = |dialog: rfd::AsyncFileDialog, folder: Option<PathBuf>| match folder {
            Some(folder) => dialog.set_directory(folder),
            None => dialog,
        };
        // Desktops want dialogs made on the main thread; the waiting is done elsewhere.
        let future: std::pin::Pin<Box<dyn Future<Output = Option<rfd::FileHandle>> + Send>> = match request {
            DialogRequest::Open { folder } => {
                Box::pin(with_folder(presets(), folder).set_title("Open planet").pick_file())
            }
            DialogRequest::Picture { folder } => {
                Box::pin(with_folder(pictures(), folder).set_title("Choose a height map").pick_file())
            }
            DialogRequest::ImportTable { folder } => {
                Box::pin(with_folder(tables(), folder).set_title("Import biome table").pick_file())
            }
            DialogRequest::ExportTable { folder, file_name } => Box::pin(
                with_folder(tables(), folder).set_title("Export biome table").set_file_name(file_name).save_file(),
            ),
            DialogRequest::SaveAs { folder, file_name } => {
                Box::pin(with_folder(presets(), folder).set_title("Save planet").set_file_name(file_name).save_file())
            }
        };
        let (sender, receiver) = channel();
        self.answer = Some(receiver);
        std::thread::spawn(move || {
            let file = pollster::block_on(future).map(|handle| handle.path().to_owned());
            // The receiver is gone when the editor closed meanwhile.
            let _ = sender.send(file);
            wake();
        });
        Ok(())
    }

    fn poll(&mut self) -> Option<Option<PathBuf>> {
        let answer = match self.answer.as_ref()?.try_recv() {
            Ok(answer) => answer,
            Err(std::sync::mpsc::TryRecvError::Empty) => return None,
            // The waiting thread died: the same as a cancelled dialog.
            Err(std::sync::mpsc::TryRecvError::Disconnected) => None,
        };
        self.answer = None;
        Some(answer)
    }
}

/// Answers prepared in advance, for tests.
#[derive(Default)]
pub struct ScriptedDialogs {
    answers: VecDeque<Option<PathBuf>>,
    pending: Option<Option<PathBuf>>,
}

impl ScriptedDialogs {
    /// Gives these answers one after the other; when they run out, every dialog is cancelled.
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
