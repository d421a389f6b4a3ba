//! The open file on disk: notices when somebody else changes it, and is asked once more before it is written over.
//!
//! What counts are the bytes, not dates: this editor's own saves change nothing, and a change that the system did not
//! report is found all the same when the window gets the focus and when the file is about to be saved.

use crate::planet::Planet;
use crate::planet::file::{self, MAX_FILE_BYTES};
use crate::planet::picture::folder_of;
use eframe::egui;
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher as _};
use std::ffi::OsStr;
use std::io;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

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
pub struct TheirFile {
    /// Its text, UTF-8 or not.
    pub bytes: Vec<u8>,
    /// Their planet, or why it cannot be read.
    pub planet: Result<Planet, String>,
}

impl TheirFile {
    /// Reads what was found at `path`; pictures that `ours` has are there at once.
    pub fn read(path: &Path, bytes: Vec<u8>, ours: &Planet) -> Self {
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
pub fn watch(
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
pub struct News(Arc<Mutex<Option<Instant>>>);

impl News {
    /// Something has just happened; from any thread.
    pub fn note(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
    }

    /// Whether something has happened and it has been quiet for so long since, once. Asks for a frame at the time.
    pub fn is_due(&self, quiet: Duration, ctx: &egui::Context) -> bool {
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
