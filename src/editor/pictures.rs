//! Pictures of height maps, read on another thread. Until one is there, and as long as it cannot be
//! read, its layer is flat.

use super::app::EditorApp;
use crate::planet::param::{Domain, ParamPath, ValueMut};
use crate::planet::picture::{Budget, Picture, PictureKey};
use eframe::egui;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::SystemTime;

type Answer = Result<Arc<Picture>, String>;

/// What is being read, and what could not be.
#[derive(Default)]
pub struct Pictures {
    reading: Option<(PictureKey, Receiver<Answer>)>,
    failed: Vec<Failure>,
    problems: Vec<(ParamPath, String)>,
}

struct Failure {
    key: PictureKey,
    /// Of the file when it was read: a file that has changed is tried again.
    changed: Option<SystemTime>,
    problem: String,
}

impl Pictures {
    /// What is wrong with the document's pictures; no reason not to save it.
    pub fn problems(&self) -> &[(ParamPath, String)] {
        &self.problems
    }

    /// Whether a picture is on its way.
    pub fn is_reading(&self) -> bool {
        self.reading.is_some()
    }
}

fn changed(file: &Path) -> Option<SystemTime> {
    std::fs::metadata(file).and_then(|metadata| metadata.modified()).ok()
}

impl EditorApp {
    /// Hands over what has been read, and begins to read what is missing.
    pub(super) fn poll_pictures(&mut self, ctx: &egui::Context) {
        if let Some((key, receiver)) = self.pictures.reading.take() {
            match receiver.try_recv() {
                Ok(Ok(picture)) => {
                    self.document.give_picture(&key, &picture);
                    ctx.request_repaint();
                }
                Ok(Err(problem)) => {
                    self.pictures.failed.push(Failure { changed: changed(&key.file), key, problem });
                }
                Err(TryRecvError::Empty) => self.pictures.reading = Some((key, receiver)),
                Err(TryRecvError::Disconnected) => {
                    let problem = format!("{} could not be read; save the picture anew", key.file.display());
                    self.pictures.failed.push(Failure { changed: changed(&key.file), key, problem });
                }
            }
        }
        let missing = self.document.planet().missing_pictures();
        let wanted = |key: &PictureKey| missing.iter().any(|(_, other)| other.as_ref() == Ok(key));
        self.pictures.failed.retain(|failure| wanted(&failure.key) && changed(&failure.key.file) == failure.changed);
        self.pictures.problems.clear();
        for (path, key) in missing {
            let failed = |key: &PictureKey| self.pictures.failed.iter().find(|failure| failure.key == *key);
            match key {
                Ok(key) => match failed(&key) {
                    Some(failure) => self.pictures.problems.push((path, failure.problem.clone())),
                    None if self.pictures.reading.is_none() => {
                        let budget = self.document.planet().picture_budget();
                        self.pictures.reading = Some(read(key, budget, ctx));
                    }
                    None => {}
                },
                Err(problem) => self.pictures.problems.push((path, problem)),
            }
        }
    }

    /// Takes a file over that was chosen for the parameter at `path`, if that still stands for a file.
    pub(super) fn choose_file(&mut self, path: &ParamPath, file: &Path) {
        let mut planet = (**self.document.planet()).clone();
        planet.each(&mut |at, param, value| {
            if at == path
                && let (Domain::File { .. }, ValueMut::Text(text)) = (param.domain, value)
            {
                *text = file.to_string_lossy().into_owned();
            }
        });
        if let Some(folder) = self.document.folder() {
            planet = planet.moved_to(&folder);
        }
        self.edit(planet, Some("Choose picture".to_owned()));
    }
}

fn read(key: PictureKey, mut budget: Budget, ctx: &egui::Context) -> (PictureKey, Receiver<Answer>) {
    let (sender, receiver) = channel();
    let (wanted, ctx) = (key.clone(), ctx.clone());
    std::thread::spawn(move || {
        // The receiver is gone when the editor closed meanwhile.
        let _ = sender.send(wanted.load(&mut budget));
        ctx.request_repaint();
    });
    (key, receiver)
}
