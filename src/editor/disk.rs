//! The open file on disk: notices when somebody else changes it, and is asked once more before it is written over.
//!
//! What counts are the bytes, not dates: this editor's own saves change nothing, and a change that the system did not
//! report is found all the same when the window gets the focus and when the file is about to be saved.

use super::app::EditorApp;
use crate::planet::Planet;
use crate::planet::file::{self, MAX_FILE_BYTES};
use crate::planet::picture::folder_of;
use eframe::egui;
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher as _};
use std::ffi::OsStr;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// A file that has been quiet for so long is whole: text editors write it in several steps.
const QUIET: Duration = Duration::from_millis(150);

/// What stands in a file, beside what was last read from it or written to it.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OnDisk {
    /// The same, or nothing as before.
    Same,
    /// It cannot be told: something is there that cannot be read, or is no file.
    Unknown,
    /// There was a file, and there is none now.
    Gone,
    /// Something else.
    Changed(Vec<u8>),
}

/// Compares a file with what is known of it.
pub fn look(path: &Path, known: Option<&[u8]>) -> OnDisk {
    match (file::read(path, MAX_FILE_BYTES), known) {
        (Ok(bytes), Some(known)) if known == bytes => OnDisk::Same,
        (Ok(bytes), _) => OnDisk::Changed(bytes),
        (Err(error), known) if error.kind() == io::ErrorKind::NotFound => match known {
            Some(_) => OnDisk::Gone,
            None => OnDisk::Same,
        },
        (Err(_), _) => OnDisk::Unknown,
    }
}

/// What others have written into the open file.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Theirs {
    pub(super) bytes: Vec<u8>,
    /// Their planet, or why it cannot be read.
    pub(super) planet: Result<Planet, String>,
}

impl Theirs {
    /// Reads what was found at `path`; pictures that `ours` has are there at once.
    pub(super) fn read(path: &Path, bytes: Vec<u8>, ours: &Planet) -> Self {
        let Ok(text) = std::str::from_utf8(&bytes) else {
            return Self { bytes, planet: Err("the text is not UTF-8; save it as UTF-8".to_owned()) };
        };
        let planet = match Planet::from_text(&path.display().to_string(), text) {
            Ok(mut planet) => {
                planet.set_folder(&folder_of(path));
                ours.clone().each_picture(|_, file, layout| {
                    if let (Some(key), Some(picture)) = (file.key(layout), file.picture(layout)) {
                        planet.give_picture(&key, picture);
                    }
                });
                Ok(planet)
            }
            Err(error) => Err(error.to_string().lines().next().unwrap_or_default().to_owned()),
        };
        Self { bytes, planet }
    }
}

/// Calls `noted` from another thread when a file in the folder changes whose name is wanted; None where the system
/// cannot watch.
pub(super) fn watch(
    folder: &Path,
    wanted: impl Fn(&OsStr) -> bool + Send + 'static,
    noted: impl Fn() + Send + 'static,
) -> Option<RecommendedWatcher> {
    let handler = move |event: notify::Result<notify::Event>| {
        let is_news = event.is_ok_and(|event| {
            // To look at a file is no change of it.
            !matches!(event.kind, EventKind::Access(_))
                && (event.need_rescan() || event.paths.iter().filter_map(|path| path.file_name()).any(&wanted))
        });
        if is_news {
            noted();
        }
    };
    let watcher = notify::recommended_watcher(handler).and_then(|mut watcher| {
        watcher.watch(folder, RecursiveMode::NonRecursive)?;
        Ok(watcher)
    });
    if let Err(error) = &watcher {
        log::warn!("{}: changes on disk are not noticed at once: {error}", folder.display());
    }
    watcher.ok()
}

/// When something last happened, until that was looked into. Clones share it.
#[derive(Clone, Default)]
pub(super) struct News(Arc<Mutex<Option<Instant>>>);

impl News {
    /// Something has just happened; from any thread.
    pub(super) fn note(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
    }

    /// Whether something has happened and it has been quiet for so long since, once. Asks for a frame at the time.
    pub(super) fn is_due(&self, quiet: Duration, ctx: &egui::Context) -> bool {
        let mut last = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let Some(since) = *last else { return false };
        match quiet.checked_sub(since.elapsed()) {
            Some(wait) if !wait.is_zero() => {
                ctx.request_repaint_after(wait);
                false
            }
            _ => {
                *last = None;
                true
            }
        }
    }
}

/// A watch over the folder of a file: editors put a new file in the place of the old one.
struct Watch {
    path: PathBuf,
    news: News,
    /// None where the system cannot watch; the file is then looked at when the window gets the focus.
    _watcher: Option<RecommendedWatcher>,
}

impl Watch {
    fn new(path: &Path, ctx: &egui::Context) -> Self {
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let (news, ctx) = (News::default(), ctx.clone());
        // It may have changed while nobody watched: it is looked at in any case.
        news.note();
        let (noted, name) = (news.clone(), target.file_name().map(ToOwned::to_owned));
        let is_ours = move |found: &OsStr| Some(found) == name.as_deref();
        let watcher = watch(&folder_of(&target), is_ours, move || {
            noted.note();
            ctx.request_repaint_after(QUIET);
        });
        Self { path: path.to_owned(), news, _watcher: watcher }
    }
}

/// What is known about the open file.
#[derive(Default)]
pub(super) struct DiskState {
    watch: Option<Watch>,
    was_focused: bool,
    /// A change that somebody wants to decide about later: it is asked about again before the file is saved.
    pub(super) put_off: Option<Vec<u8>>,
    /// What is to be said about the file as long as it is so.
    pub(super) notice: Option<String>,
}

impl EditorApp {
    /// Looks at the open file when it may have changed.
    pub(super) fn poll_disk(&mut self, ctx: &egui::Context) {
        if self.disk.watch.as_ref().map(|watch| watch.path.as_path()) != self.document.path() {
            let watch = self.document.path().map(|path| Watch::new(path, ctx));
            self.disk = DiskState { watch, was_focused: self.disk.was_focused, ..DiskState::default() };
        }
        self.files.keep_to(self.document.path());
        let focused = ctx.input(|input| input.viewport().focused.unwrap_or(true));
        let gained = focused && !std::mem::replace(&mut self.disk.was_focused, focused);
        // One question at a time.
        if self.files.is_asking() {
            return;
        }
        let due = self.disk.watch.as_ref().is_some_and(|watch| watch.news.is_due(QUIET, ctx));
        if gained || due {
            self.look_at_disk();
            ctx.request_repaint();
        }
    }

    fn look_at_disk(&mut self) {
        let Some(path) = self.document.path().map(Path::to_owned) else { return };
        match look(&path, self.document.disk_bytes()) {
            OnDisk::Same if self.document.disk_bytes().is_some() => {
                (self.disk.notice, self.disk.put_off) = (None, None);
            }
            // Still gone, or not there yet: what was said about it holds.
            OnDisk::Same | OnDisk::Unknown => {}
            OnDisk::Gone => {
                // Nothing holds the planet any more: closing asks, and saving writes the file anew.
                self.document.note_disk(None, None);
                self.disk.put_off = None;
                self.disk.notice = Some(format!("{} is gone from the disk. Save to write it anew.", path.display()));
            }
            OnDisk::Changed(bytes) => self.take_disk(&path, Theirs::read(&path, bytes, self.document.planet())),
        }
    }

    /// Somebody has written another text into the open file: a document without changes of its own takes it over.
    fn take_disk(&mut self, path: &Path, theirs: Theirs) {
        self.disk.notice = None;
        let dirty = self.document.is_dirty();
        match theirs.planet {
            Err(why) if !dirty => {
                let line = format!("The file has changed on disk, and cannot be read: {why}");
                self.disk.notice = Some(line);
            }
            Ok(planet) if planet == **self.document.planet() => {
                self.document.note_disk(Some(planet), Some(theirs.bytes));
            }
            Ok(planet) if !dirty => {
                self.reload(planet, theirs.bytes);
                self.say(format!("{} has changed on disk and was read again", path.display()));
            }
            _ if self.disk.put_off.as_ref() == Some(&theirs.bytes) => {}
            planet => self.files.ask_about_change(path.to_owned(), Theirs { planet, ..theirs }, false),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_file_is_known_by_its_text() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("a.ron");
        assert_eq!(look(&path, None), OnDisk::Same);
        assert_eq!(look(&path, Some(b"text")), OnDisk::Gone);
        std::fs::write(&path, "text").unwrap();
        assert_eq!(look(&path, Some(b"text")), OnDisk::Same);
        assert_eq!(look(&path, Some(b"other")), OnDisk::Changed(b"text".to_vec()));
        assert_eq!(look(&path, None), OnDisk::Changed(b"text".to_vec()), "nobody had read it");
        assert_eq!(look(folder.path(), Some(b"text")), OnDisk::Unknown);
        #[cfg(unix)]
        assert_eq!(look(Path::new("/dev/zero"), Some(b"text")), OnDisk::Unknown, "a device is not read");
    }
}
