//! Whether another program has changed a file.
//!
//! The bytes decide, not the dates: this editor's own saves are no change. A change that the system did not report is
//! found when the window gets the focus, and again before a save.

use crate::planet::Planet;
use crate::planet::file::{self, MAX_FILE_BYTES};
use eframe::egui;
use notify::{EventKind, RecommendedWatcher, RecursiveMode, Watcher as _};
use std::ffi::OsStr;
use std::io;
use std::path::Path;
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

/// The content of a file, compared with what was last read or written.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum OnDisk {
    /// Equal, or still no file.
    Same,
    /// Unknown: the path cannot be read, or is no regular file.
    Unknown,
    /// The file is gone.
    Gone,
    /// Another content.
    Changed(Vec<u8>),
}

/// Compares a file with its known content.
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

/// The content of the open file as another program has written it.
#[derive(Clone, Debug, PartialEq)]
pub struct TheirFile {
    /// Its text, UTF-8 or not.
    pub bytes: Vec<u8>,
    /// Its planet, or why it cannot be read.
    pub planet: Result<Planet, String>,
}

impl TheirFile {
    /// Reads the content of `path`. Pictures and meshes that `ours` has need not be read again.
    pub fn read(path: &Path, bytes: Vec<u8>, ours: &Planet) -> Self {
        let Ok(text) = std::str::from_utf8(&bytes) else {
            return Self { bytes, planet: Err("the text is not UTF-8; save it as UTF-8".to_owned()) };
        };
        let planet = match Planet::from_text_of(path, text) {
            Ok(mut planet) => {
                for (key, content) in ours.linked_files() {
                    content.iter().for_each(|content| planet.give_file(&key, content));
                }
                Ok(planet)
            }
            Err(error) => Err(error.to_string().lines().next().unwrap_or_default().to_owned()),
        };
        Self { bytes, planet }
    }
}

/// Calls `noted` from another thread when a file of the folder with a wanted name changes. None if the system cannot
/// watch the folder.
pub fn watch(
    folder: &Path,
    wanted: impl Fn(&OsStr) -> bool + Send + 'static,
    noted: impl Fn() + Send + 'static,
) -> Option<RecommendedWatcher> {
    let handler = move |event: notify::Result<notify::Event>| {
        let is_news = event.is_ok_and(|event| {
            // Reading a file is no change.
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

/// The time of the last report, until it is dealt with. Clones share it.
#[derive(Clone, Default)]
pub struct News(Arc<Mutex<Option<Instant>>>);

impl News {
    /// Notes a report; from any thread.
    pub fn note(&self) {
        *self.0.lock().unwrap_or_else(PoisonError::into_inner) = Some(Instant::now());
    }

    /// Whether there was a report and none for the time `quiet` since; once. Asks for a frame when that time has
    /// passed.
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
