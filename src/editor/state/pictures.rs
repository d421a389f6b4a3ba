//! Height maps, read on another thread. A layer whose picture is missing or cannot be read is flat.

use super::document::Document;
use crate::planet::param::ParamPath;
use crate::planet::picture::{Budget, Picture, PictureKey};
use eframe::egui;
use std::path::Path;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, TryRecvError, channel};
use std::time::SystemTime;

type Answer = Result<Arc<Picture>, String>;

/// The picture that is being read, and those that could not be read.
#[derive(Default)]
pub struct Pictures {
    reading: Option<(PictureKey, Receiver<Answer>)>,
    failed: Vec<Failure>,
    problems: Vec<(ParamPath, String)>,
}

struct Failure {
    key: PictureKey,
    /// When the file was last written: a file written since is read again.
    written: Option<SystemTime>,
    problem: String,
}

impl Failure {
    fn new(key: PictureKey, problem: String) -> Self {
        Self { written: last_write(&key.file), key, problem }
    }
}

impl Pictures {
    /// Problems of the document's pictures. They do not prevent saving.
    pub fn problems(&self) -> &[(ParamPath, String)] {
        &self.problems
    }

    /// Whether a picture is being read.
    pub fn is_reading(&self) -> bool {
        self.reading.is_some()
    }

    /// Hands the picture that has been read to the document, and starts to read the next that is missing.
    pub fn poll(&mut self, document: &mut Document, ctx: &egui::Context) {
        if let Some((key, receiver)) = self.reading.take() {
            match receiver.try_recv() {
                Ok(Ok(picture)) => {
                    document.give_picture(&key, &picture);
                    ctx.request_repaint();
                }
                Ok(Err(problem)) => self.failed.push(Failure::new(key, problem)),
                Err(TryRecvError::Empty) => self.reading = Some((key, receiver)),
                Err(TryRecvError::Disconnected) => {
                    let problem = format!("{} could not be read; save the picture again", key.file.display());
                    self.failed.push(Failure::new(key, problem));
                }
            }
        }
        let missing = document.planet().missing_pictures();
        let wanted = |key: &PictureKey| missing.iter().any(|(_, other)| other.as_ref() == Ok(key));
        self.failed.retain(|failure| wanted(&failure.key) && last_write(&failure.key.file) == failure.written);
        self.problems.clear();
        for (path, key) in missing {
            let failed = |key: &PictureKey| self.failed.iter().find(|failure| failure.key == *key);
            match key {
                Ok(key) => match failed(&key) {
                    Some(failure) => self.problems.push((path, failure.problem.clone())),
                    None if self.reading.is_none() => {
                        self.reading = Some(read(key, document.planet().picture_budget(), ctx));
                    }
                    None => {}
                },
                Err(problem) => self.problems.push((path, problem)),
            }
        }
    }
}

fn last_write(file: &Path) -> Option<SystemTime> {
    std::fs::metadata(file).and_then(|metadata| metadata.modified()).ok()
}

fn read(key: PictureKey, mut budget: Budget, ctx: &egui::Context) -> (PictureKey, Receiver<Answer>) {
    let (sender, receiver) = channel();
    let (wanted, ctx) = (key.clone(), ctx.clone());
    std::thread::spawn(move || {
        // The receiver is gone if the editor has closed.
        let _ = sender.send(wanted.load(&mut budget));
        ctx.request_repaint();
    });
    (key, receiver)
}
