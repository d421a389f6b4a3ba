//! The working copy: unsaved work, written beside the layout every few seconds, and offered after a crash.
//!
//! Each running editor owns `recovery-N.ron` and holds a lock on `recovery-N.lock`. A file whose lock nobody holds was
//! left behind by a crash. The documents' own files are never touched.

use super::document::Document;
use crate::planet::Planet;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant};

/// Least time between two writes: the most work that a crash can cost.
const INTERVAL: Duration = Duration::from_secs(2);

/// The working copy of this editor.
pub struct Recovery {
    file: PathBuf,
    /// Held while this editor runs; the system releases it after a crash.
    lock: Option<File>,
    lock_path: PathBuf,
    written: Option<Arc<Planet>>,
    last_write: Option<Instant>,
    writing: Option<JoinHandle<Result<(), String>>>,
    problem: Option<String>,
}

/// A working copy that a crash left behind.
#[derive(Clone, Debug)]
pub struct Orphan {
    /// Its file.
    pub file: PathBuf,
    /// The planet.
    pub planet: Planet,
    /// Held until the question about it is answered: no other editor asks meanwhile.
    _lock: Arc<File>,
}

impl Recovery {
    /// Takes a free number in `folder`, and finds the working copies of crashed editors there.
    pub fn open(folder: &Path) -> io::Result<(Self, Vec<Orphan>)> {
        fs::create_dir_all(folder)?;
        let mut orphans = Vec::new();
        let mut own = None;
        // More than anybody runs at once. A number whose lock is held belongs to another editor.
        for number in 0..64 {
            let file = folder.join(format!("recovery-{number}.ron"));
            if !file.exists() && own.is_some() {
                continue;
            }
            let lock_path = file.with_extension("lock");
            let lock = File::options().create(true).truncate(false).write(true).open(&lock_path)?;
            if lock.try_lock().is_err() {
                continue;
            }
            if file.exists() {
                // A file that cannot be read stays: the user may still repair it.
                if let Ok(planet) = Planet::open(&file) {
                    orphans.push(Orphan { file, planet, _lock: Arc::new(lock) });
                }
            } else {
                own = Some((file, lock, lock_path));
            }
        }
        let (file, lock, lock_path) =
            own.ok_or_else(|| io::Error::other("it holds too many recovery files; remove old ones"))?;
        let lock = Some(lock);
        let recovery = Self { file, lock, lock_path, written: None, last_write: None, writing: None, problem: None };
        Ok((recovery, orphans))
    }

    /// Writes unsaved work on another thread, if it is time; deletes the file if there is none. Gives when to call
    /// again.
    pub fn tick(&mut self, document: &Document) -> Option<Duration> {
        if self.writing.as_ref().is_some_and(|thread| !thread.is_finished()) {
            return Some(INTERVAL / 10);
        }
        self.finish_writing();
        let Some(planet) = document.to_recover() else {
            self.forget();
            return None;
        };
        if self.written.as_ref().is_some_and(|written| Arc::ptr_eq(written, planet)) {
            return None;
        }
        let wait = self.last_write.and_then(|last| INTERVAL.checked_sub(last.elapsed()));
        if wait.is_some() {
            return wait;
        }
        self.last_write = Some(Instant::now());
        self.written = Some(planet.clone());
        let (planet, file) = (planet.clone(), self.file.clone());
        self.writing = Some(std::thread::spawn(move || planet.save(&file).map_err(|error| error.to_string())));
        // The result is looked at then.
        Some(INTERVAL)
    }

    /// Why the working copy could not be written last.
    pub fn problem(&self) -> Option<&str> {
        self.problem.as_deref()
    }

    fn finish_writing(&mut self) {
        let Some(thread) = self.writing.take() else { return };
        match thread.join() {
            Ok(Ok(())) => self.problem = None,
            failed => {
                let error = failed.ok().and_then(Result::err).unwrap_or_else(|| "the writer failed".to_owned());
                log::warn!("unsaved work could not be written to the working copy: {error}");
                // It is tried again.
                (self.problem, self.written) = (Some(error), None);
            }
        }
    }

    /// Writes unsaved work now and leaves it for the next editor, which finds it as after a crash. Whether there is
    /// nothing to lose.
    pub fn leave(&mut self, document: &Document) -> bool {
        self.finish_writing();
        let is_kept = document.to_recover().is_none_or(|planet| planet.save(&self.file).is_ok());
        self.lock = None;
        is_kept
    }

    /// Makes the working copy of a crashed editor this editor's own.
    pub fn adopt(&self, orphan: &Path) {
        if let Err(error) = fs::rename(orphan, &self.file) {
            log::warn!("{}: {error}", orphan.display());
        }
    }

    /// Deletes the working copy: there is no unsaved work.
    pub fn forget(&mut self) {
        self.finish_writing();
        if self.written.take().is_some() | self.problem.take().is_some() {
            remove(&self.file);
        }
    }

    /// Deletes the working copy and the lock: the editor ends regularly. What was left for the next editor stays.
    pub fn close(&mut self) {
        if self.lock.is_some() {
            self.forget();
            remove(&self.lock_path);
        }
    }
}

/// Deletes a working copy.
pub fn remove(file: &Path) {
    if let Err(error) = fs::remove_file(file)
        && error.kind() != io::ErrorKind::NotFound
    {
        log::warn!("{}: {error}", file.display());
    }
}
