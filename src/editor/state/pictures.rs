//! Height maps, texture sets and meshes, read on another thread, and read again when they change on disk. A layer whose
//! picture is missing or cannot be read is flat; a biome without its textures shows its built-in pattern; a population
//! without its mesh stands with a plain form.

use super::document::Document;
use crate::editor::files::disk::{News, watch};
use crate::planet::param::ParamPath;
use crate::planet::picture::{Budget, folder_of};
use crate::planet::{FileContent, FileKey, Planet};
use eframe::egui;
use notify::RecommendedWatcher;
use std::collections::{BTreeMap, BTreeSet};
use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::{Duration, SystemTime};

/// A file that has not changed for this long is complete: programs write it in several steps.
const QUIET: Duration = Duration::from_millis(150);

type Answer = Result<FileContent, String>;

/// Date and length of files; None for one that is not there.
type Stamps = Vec<Option<(SystemTime, u64)>>;

/// The file that is being read, those that were, and those that could not be read.
#[derive(Default)]
pub struct Pictures {
    reading: Option<(FileKey, Stamps, Receiver<Answer>)>,
    failed: Vec<Failure>,
    problems: Vec<(ParamPath, String)>,
    /// The planet whose files are known.
    seen: Option<Arc<Planet>>,
    known: Vec<Known>,
    watched: Watched,
}

/// A file that the planet has read.
struct Known {
    key: FileKey,
    content: FileContent,
    /// As it was when it was read.
    stamps: Stamps,
    is_stale: bool,
}

/// A file that could not be read.
struct Failure {
    key: FileKey,
    /// As it was then: a file written since is read again.
    stamps: Stamps,
    problem: String,
}

impl Pictures {
    /// Problems of the document's pictures, texture sets and meshes. They do not prevent saving.
    pub fn problems(&self) -> &[(ParamPath, String)] {
        &self.problems
    }

    /// Whether a file is being read.
    pub fn is_reading(&self) -> bool {
        self.reading.is_some()
    }

    /// Hands the file that has been read to the document, and starts to read the next that is missing or has changed.
    pub fn poll(&mut self, document: &mut Document, ctx: &egui::Context) {
        if let Some((key, stamps, receiver)) = self.reading.take() {
            let failed = |problem: String| Failure { stamps: stamps.clone(), key: key.clone(), problem };
            match receiver.try_recv() {
                Ok(Ok(content)) => {
                    self.failed.retain(|failure| failure.key != key);
                    self.known.retain(|known| known.key != key);
                    document.give_file(&key, &content);
                    self.known.push(Known { stamps: stamps_of(&key, Some(&content)), key, content, is_stale: false });
                    ctx.request_repaint();
                }
                Ok(Err(problem)) => self.failed.push(failed(problem)),
                Err(TryRecvError::Empty) => self.reading = Some((key, stamps, receiver)),
                Err(TryRecvError::Disconnected) => {
                    self.failed.push(failed(format!("{} could not be read; save it again", key.file().display())));
                }
            }
        }
        self.follow(document, ctx);
        if self.watched.news.is_due(QUIET, ctx) {
            for known in &mut self.known {
                known.is_stale = stamps_of(&known.key, Some(&known.content)) != known.stamps;
            }
        }
        self.problems.clear();
        self.read_next(document, ctx);
    }

    /// Notes the files of another planet. What was read last of a file holds for the planets of all undo steps.
    fn follow(&mut self, document: &mut Document, ctx: &egui::Context) {
        if self.seen.as_ref().is_some_and(|seen| Arc::ptr_eq(seen, document.planet())) {
            return;
        }
        let planet = document.planet().clone();
        let files: Vec<(FileKey, Option<FileContent>)> = planet.linked_files().collect();
        self.known.retain(|known| files.iter().any(|(key, _)| *key == known.key));
        for (key, content) in files {
            match (self.known.iter().find(|known| known.key == key), content) {
                (Some(known), content) if content.as_ref() != Some(&known.content) => {
                    document.give_file(&key, &known.content);
                }
                (None, Some(content)) => {
                    self.known.push(Known { stamps: stamps_of(&key, Some(&content)), key, content, is_stale: false });
                }
                _ => {}
            }
        }
        self.watched.follow(planet.linked_paths(), ctx);
        self.seen = Some(document.planet().clone());
    }

    fn read_next(&mut self, document: &Document, ctx: &egui::Context) {
        let planet = document.planet();
        let missing = planet.missing_files();
        let is_wanted = |key: &FileKey| {
            missing.iter().any(|(_, other)| other.as_ref() == Ok(key))
                || self.known.iter().any(|known| known.is_stale && known.key == *key)
        };
        let is_same = |failure: &Failure| stamps_of(&failure.key, None)[0] == failure.stamps[0];
        self.failed.retain(|failure| is_wanted(&failure.key) && is_same(failure));
        let stale = self.known.iter().filter(|known| known.is_stale).flat_map(|known| {
            let named = planet.linked_places().filter(|(_, key)| *key == known.key);
            named.map(|(path, key)| (path, Ok(key))).collect::<Vec<_>>()
        });
        for (path, key) in missing.into_iter().chain(stale.collect::<Vec<_>>()) {
            let failed = |key: &FileKey| self.failed.iter().find(|failure| failure.key == *key);
            match key {
                Ok(key) => match failed(&key) {
                    Some(failure) => self.problems.push((path, failure.problem.clone())),
                    None if self.reading.is_none() => {
                        let known = self.known.iter().find(|known| known.key == key);
                        let stamps = stamps_of(&key, known.map(|known| &known.content));
                        let budget = planet.budget_beside(Some(&key));
                        self.reading = Some(read(key, stamps, budget, ctx));
                    }
                    None => {}
                },
                Err(problem) => self.problems.push((path, problem)),
            }
        }
    }
}

/// The files of a source: the one that the planet names, and those that its content names.
fn stamps_of(key: &FileKey, content: Option<&FileContent>) -> Stamps {
    let stamp = |file: &Path| {
        let metadata = std::fs::metadata(file).ok()?;
        Some((metadata.modified().ok()?, metadata.len()))
    };
    let others = content.map(FileContent::others).unwrap_or_default();
    [key.file()].into_iter().chain(others.iter().map(PathBuf::as_path)).map(stamp).collect()
}

fn read(key: FileKey, stamps: Stamps, mut budget: Budget, ctx: &egui::Context) -> (FileKey, Stamps, Receiver<Answer>) {
    let (sender, receiver) = channel();
    let (wanted, ctx) = (key.clone(), ctx.clone());
    std::thread::spawn(move || {
        // The receiver is gone if the editor has closed.
        let _ = sender.send(wanted.load(&mut budget));
        ctx.request_repaint();
    });
    (key, stamps, receiver)
}

/// The watch over the folders of the planet's files: many programs save by putting a new file in the place of the old
/// one.
#[derive(Default)]
struct Watched {
    names: BTreeMap<PathBuf, BTreeSet<OsString>>,
    news: News,
    _watchers: Vec<RecommendedWatcher>,
}

impl Watched {
    /// Watches these files instead of others.
    fn follow(&mut self, files: Vec<PathBuf>, ctx: &egui::Context) {
        let mut names: BTreeMap<PathBuf, BTreeSet<OsString>> = BTreeMap::new();
        for file in files {
            let (folder, name) = (folder_of(&file), file.file_name().map(ToOwned::to_owned));
            if folder.is_dir() {
                names.entry(folder).or_default().extend(name);
            }
        }
        if names == self.names {
            return;
        }
        let news = News::default();
        // A file may have changed before the watch began.
        news.note();
        let start = |(folder, wanted): (&PathBuf, &BTreeSet<OsString>)| {
            let (noted, ctx, wanted) = (news.clone(), ctx.clone(), wanted.clone());
            watch(
                folder,
                move |name| wanted.contains(name),
                move || {
                    noted.note();
                    ctx.request_repaint_after(QUIET);
                },
            )
        };
        self._watchers = names.iter().filter_map(start).collect();
        (self.names, self.news) = (names, news);
    }
}
