//! Photographs taken one after the other, each into a file.
//!
//! The frames of a film are listed beside them with what made each and its CRC-32, so that a film that goes on keeps
//! those that are whole and its own.

use super::file::{FileKind, frame_path};
use super::{CameraPath, Shot};
use crate::made::{Ledger, identity};
use crate::planet::file::write_atomically;
use crate::render::Renderer;
use std::io;
use std::path::{Path, PathBuf};

/// How a film runs.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Film {
    /// Length in seconds.
    pub secs: f64,
    /// Frames of each second.
    pub fps: u32,
    /// Seconds of the planet that pass in each second of the film.
    pub speed: f64,
}

impl Film {
    /// How many frames it has: at least one.
    pub fn frames(&self) -> usize {
        (self.secs * f64::from(self.fps)).round().max(1.0) as usize
    }

    /// The files of its frames.
    pub fn files(&self, film: &Path) -> Vec<PathBuf> {
        (1..=self.frames()).map(|number| frame_path(film, number)).collect()
    }
}

/// A photograph, or a film: frames that are computed when their turn comes.
pub struct Sequence {
    kind: FileKind,
    count: usize,
    frame: Box<dyn Fn(usize) -> (Shot, PathBuf) + Send>,
    /// The list of the frames of a film.
    list: Option<PathBuf>,
    /// Whether frames of a film stay as they are that are whole and made by the same: planet, view and program.
    pub resumes: bool,
}

/// How a sequence ended.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Taken {
    /// Files that are there whole now. Fewer than [`Sequence::count`] if somebody said no.
    pub done: usize,
    /// Frames among them that an earlier run had made.
    pub kept: usize,
}

impl Sequence {
    /// One photograph.
    pub fn picture(shot: Shot, file: PathBuf, kind: FileKind) -> Self {
        Self { kind, count: 1, frame: Box::new(move |_| (shot.clone(), file.clone())), list: None, resumes: false }
    }

    /// The frames of a film, each like the first but for the camera and the time; their files are numbered.
    pub fn film(first: Shot, path: CameraPath, film: Film, file: &Path, kind: FileKind) -> Self {
        let (count, list, file) = (film.frames(), Some(file.with_extension("frames")), file.to_owned());
        let frame = move |number: usize| {
            let mut shot = first.clone();
            shot.time_secs += film.speed * number as f64 / f64::from(film.fps);
            shot.view.camera = path.camera(&shot.terrain, number as f64 / (count - 1).max(1) as f64);
            (shot, frame_path(&file, number + 1))
        };
        Self { kind, count, frame: Box::new(frame), list, resumes: false }
    }

    /// How many files there will be.
    pub fn count(&self) -> usize {
        self.count
    }

    /// The file, or the first of them.
    pub fn first_file(&self) -> PathBuf {
        (self.frame)(0).1
    }

    /// Takes all photographs. A file is there whole or not at all. `progress` hears the share that is done and says
    /// whether to go on.
    ///
    /// # Errors
    /// What went wrong, with the file.
    pub fn take(&self, renderer: &mut Renderer, progress: &mut dyn FnMut(f64) -> bool) -> Result<Taken, String> {
        let ledger = self.ledger()?;
        // The planet and the system of a film are the same in all frames.
        let shared = ledger.as_ref().map(|_| (self.frame)(0).0.shared());
        let mut taken = Taken { done: 0, kept: 0 };
        for number in 0..self.count {
            let (mut shot, file) = (self.frame)(number);
            shot.photo.develop = self.kind.develop();
            let listed = ledger.as_ref().zip(shared.map(|shared| identity(shared, &(self.kind, shot.own()))));
            let name = file.file_name().unwrap_or_default().to_string_lossy();
            taken.done = number + 1;
            if self.resumes && listed.is_some_and(|(ledger, key)| ledger.has(&name, key, &file)) {
                taken.kept += 1;
                continue;
            }
            let told = |error: &dyn std::fmt::Display| format!("{}: {error}", file.display());
            let pixels = shot.take(renderer, &mut |done| progress((number as f64 + done) / self.count as f64));
            let Some(pixels) = pixels.map_err(|error| told(&error))? else {
                return Ok(Taken { done: number, ..taken });
            };
            let bytes = self.kind.encode(&pixels, shot.view.size_px).map_err(|error| told(&error))?;
            write_atomically(&file, &bytes).map_err(|error| told(&error))?;
            if let Some((ledger, key)) = listed {
                ledger.add(&name, key, crc32fast::hash(&bytes)).map_err(|error| told(&error))?;
            }
        }
        Ok(taken)
    }

    /// The list of a film: a new one, unless it goes on.
    fn ledger(&self) -> Result<Option<Ledger>, String> {
        let Some(path) = &self.list else { return Ok(None) };
        let removed = if self.resumes { Ok(()) } else { std::fs::remove_file(path) };
        let opened = match removed {
            Err(error) if error.kind() != io::ErrorKind::NotFound => Err(error),
            _ => Ledger::open(path),
        };
        opened.map(Some).map_err(|error| format!("{}: {error}", path.display()))
    }
}
