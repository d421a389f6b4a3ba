//! The working copy: unsaved work, written beside the layout every few seconds, and offered after a crash.
//!
//! Each running editor owns `recovery-N.ron`, the planet, `recovery-N.system.ron`, the system, and
//! `recovery-N.files.txt`, the files that they belong to. It holds a lock on `recovery-N.lock`. Files whose lock nobody
//! holds were left behind by a crash. The documents' own files are never touched.

use super::document::Document;
use super::system::OpenSystem;
use crate::planet::Planet;
use crate::planet::file::{read_text, write_atomically};
use crate::planet::open::read_whole_text;
use crate::system::System;
use std::fs::{self, File};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::thread::JoinHandle;
use std::time::{Duration, Instant, SystemTime};

/// Least time between two writes: the most work that a crash can cost.
const INTERVAL: Duration = Duration::from_secs(2);

/// Longest list of files that is read.
const MOST_PATH_BYTES: u64 = 1 << 16;

/// The working copy of this editor.
pub struct Recovery {
    file: PathBuf,
    /// Held while this editor runs; the system releases it after a crash.
    lock: Option<File>,
    lock_path: PathBuf,
    written: Option<Written>,
    last_write: Option<Instant>,
    writing: Option<JoinHandle<Result<(), String>>>,
    problem: Option<String>,
}

/// What a working copy holds: the planet and the system as edited.
#[derive(Clone)]
struct Written {
    planet: Option<Arc<Planet>>,
    system: Option<Arc<System>>,
}

impl Written {
    fn same(&self, other: &Self) -> bool {
        fn same<T>(a: &Option<Arc<T>>, b: &Option<Arc<T>>) -> bool {
            a.as_ref().map(Arc::as_ptr) == b.as_ref().map(Arc::as_ptr)
        }
        same(&self.planet, &other.planet) && same(&self.system, &other.system)
    }
}

/// A working copy that a crash left behind.
#[derive(Clone, Debug)]
pub struct Orphan {
    /// Its file.
    pub file: PathBuf,
    /// When it was written last.
    pub kept: Option<SystemTime>,
    /// The planet, and the file that it belongs to.
    pub planet: Option<(Planet, Option<PathBuf>)>,
    /// The system, with whole paths of its presets, and the file that it belongs to.
    pub system: Option<(System, Option<PathBuf>)>,
    /// Held until the question about it is answered: no other editor asks meanwhile.
    _lock: Arc<File>,
}

/// When a file was written last.
fn modified(file: &Path) -> Option<SystemTime> {
    fs::metadata(file).and_then(|data| data.modified()).ok()
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
            let is_left = file.exists() || system_of(&file).exists();
            if !is_left && own.is_some() {
                continue;
            }
            let lock_path = file.with_extension("lock");
            let lock = File::options().create(true).truncate(false).write(true).open(&lock_path)?;
            if lock.try_lock().is_err() {
                continue;
            }
            if is_left {
                // Files of which one cannot be read stay: the user may still repair it.
                let [planet_file, system_file] = read_files(&file);
                let planet = Planet::open(&file).ok().map(|planet| (planet, planet_file));
                let system = read_system(&system_of(&file)).map(|system| (system, system_file));
                let is_whole = (file.exists(), system_of(&file).exists()) == (planet.is_some(), system.is_some());
                if is_whole {
                    let kept = [file.clone(), system_of(&file)].iter().filter_map(|file| modified(file)).max();
                    orphans.push(Orphan { file, kept, planet, system, _lock: Arc::new(lock) });
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

    /// Writes unsaved work on another thread, if it is time; deletes the files if there is none. Gives when to call
    /// again.
    pub fn tick(&mut self, document: &Document, system: Option<&OpenSystem>) -> Option<Duration> {
        if self.writing.as_ref().is_some_and(|thread| !thread.is_finished()) {
            return Some(INTERVAL / 10);
        }
        self.finish_writing();
        let unsaved = unsaved(document, system);
        if unsaved.planet.is_none() && unsaved.system.is_none() {
            self.forget();
            return None;
        }
        if self.written.as_ref().is_some_and(|written| written.same(&unsaved)) {
            return None;
        }
        let wait = self.last_write.and_then(|last| INTERVAL.checked_sub(last.elapsed()));
        if wait.is_some() {
            return wait;
        }
        self.last_write = Some(Instant::now());
        self.written = Some(unsaved);
        let write = writer(&self.file, document, system);
        self.writing = Some(std::thread::spawn(write));
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
    pub fn leave(&mut self, document: &Document, system: Option<&OpenSystem>) -> bool {
        self.finish_writing();
        let is_kept = writer(&self.file, document, system)().is_ok();
        self.lock = None;
        is_kept
    }

    /// Makes the working copy of a crashed editor this editor's own.
    pub fn adopt(&self, orphan: &Path) {
        for (from, to) in all_files(orphan).iter().zip(all_files(&self.file)) {
            if let Err(error) = fs::rename(from, to)
                && error.kind() != io::ErrorKind::NotFound
            {
                log::warn!("{}: {error}", from.display());
            }
        }
    }

    /// Deletes the working copy: there is no unsaved work.
    pub fn forget(&mut self) {
        self.finish_writing();
        if self.written.take().is_some() | self.problem.take().is_some() {
            remove_all(&self.file);
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

fn unsaved(document: &Document, system: Option<&OpenSystem>) -> Written {
    let system = system.filter(|system| system.is_dirty()).map(|system| system.system().clone());
    Written { planet: document.to_recover().cloned(), system }
}

/// Writes the unsaved work, and deletes what there is no longer. It holds all that it needs.
fn writer(
    file: &Path,
    document: &Document,
    system: Option<&OpenSystem>,
) -> impl FnOnce() -> Result<(), String> + Send + use<> {
    let planet = document.to_recover().cloned();
    let system = system.filter(|system| system.is_dirty());
    let belong = [document.file_to_recover(), system.and_then(OpenSystem::path)];
    let lines = ["planet", "system"]
        .iter()
        .zip(belong)
        .filter_map(|(kind, path)| Some(format!("{kind} {}\n", path?.to_str()?)));
    let (belong, system): (String, _) = (lines.collect(), system.map(OpenSystem::with_whole_paths));
    let file = file.to_owned();
    move || {
        // Work beside the wrong file name would be saved over another planet: better beside none.
        let is_same = read_whole_text(&files_of(&file), MOST_PATH_BYTES).is_ok_and(|held| held == belong);
        if !is_same {
            remove(&files_of(&file));
        }
        match planet {
            Some(planet) => planet.save_in_one(&file).map_err(|error| error.to_string())?,
            None => remove(&file),
        }
        match system {
            Some(system) => system.save(system_of(&file)).map_err(|error| error.to_string())?,
            None => remove(&system_of(&file)),
        }
        if is_same {
            return Ok(());
        }
        write_atomically(&files_of(&file), belong.as_bytes()).map_err(|error| error.to_string())
    }
}

/// The file of the system beside that of the planet, and that of the files that both belong to.
fn system_of(file: &Path) -> PathBuf {
    file.with_extension("system.ron")
}

fn files_of(file: &Path) -> PathBuf {
    file.with_extension("files.txt")
}

fn all_files(file: &Path) -> [PathBuf; 3] {
    [file.to_owned(), system_of(file), files_of(file)]
}

/// The files that a working copy of a planet and of a system belong to.
fn read_files(file: &Path) -> [Option<PathBuf>; 2] {
    let text = read_whole_text(&files_of(file), MOST_PATH_BYTES).unwrap_or_default();
    ["planet ", "system "].map(|kind| text.lines().find_map(|line| line.strip_prefix(kind)).map(PathBuf::from))
}

fn read_system(file: &Path) -> Option<System> {
    System::from_text(&file.display().to_string(), &read_text(file).ok()?).ok()
}

/// Deletes all files of a working copy.
pub fn remove_all(file: &Path) {
    all_files(file).iter().for_each(|file| remove(file));
}

/// Deletes a file.
pub fn remove(file: &Path) {
    if let Err(error) = fs::remove_file(file)
        && error.kind() != io::ErrorKind::NotFound
    {
        log::warn!("{}: {error}", file.display());
    }
}
