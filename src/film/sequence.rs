//! Photographs taken one after the other, each into a file.

use super::file::{FileKind, frame_path};
use super::{CameraPath, Shot};
use crate::planet::file::write_atomically;
use crate::render::Renderer;
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
}

/// A photograph, or a film: frames that are computed when their turn comes.
pub struct Sequence {
    kind: FileKind,
    count: usize,
    frame: Box<dyn Fn(usize) -> (Shot, PathBuf) + Send>,
    /// Whether files that are there already stay as they are.
    pub resumes: bool,
}

impl Sequence {
    /// One photograph.
    pub fn picture(shot: Shot, file: PathBuf, kind: FileKind) -> Self {
        Self { kind, count: 1, frame: Box::new(move |_| (shot.clone(), file.clone())), resumes: false }
    }

    /// The frames of a film, each like the first but for the camera and the time; their files are numbered.
    pub fn film(first: Shot, path: CameraPath, film: Film, file: &Path, kind: FileKind) -> Self {
        let (count, file) = (film.frames(), file.to_owned());
        let frame = move |number: usize| {
            let mut shot = first.clone();
            shot.time_secs += film.speed * number as f64 / f64::from(film.fps);
            shot.view.camera = path.camera(&shot.terrain, number as f64 / (count - 1).max(1) as f64);
            (shot, frame_path(&file, number + 1))
        };
        Self { kind, count, frame: Box::new(frame), resumes: false }
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
    /// whether to go on. Gives the number of files that are done.
    ///
    /// # Errors
    /// What went wrong, with the file.
    pub fn take(&self, renderer: &mut Renderer, progress: &mut dyn FnMut(f64) -> bool) -> Result<usize, String> {
        for number in 0..self.count {
            let (mut shot, file) = (self.frame)(number);
            if self.resumes && file.is_file() {
                continue;
            }
            let told = |error: &dyn std::fmt::Display| format!("{}: {error}", file.display());
            shot.photo.develop = self.kind.develop();
            let taken = shot.take(renderer, &mut |done| progress((number as f64 + done) / self.count as f64));
            let Some(pixels) = taken.map_err(|error| told(&error))? else { return Ok(number) };
            let bytes = self.kind.encode(&pixels, shot.view.size_px).map_err(|error| told(&error))?;
            write_atomically(&file, &bytes).map_err(|error| told(&error))?;
        }
        Ok(self.count)
    }
}
