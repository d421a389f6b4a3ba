//! Photographs and films: what the user set, and the one that is being taken on another thread.

use super::job::{GoOn, Job};
use crate::film::Sequence;
use crate::lod::Quality;
use crate::render::Renderer;
use std::path::PathBuf;

/// What is taken.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Subject {
    /// One photograph.
    Picture,
    /// A flight over the bookmarks.
    Film,
}

/// What a photographer sets, besides the exposure.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PhotoSettings {
    /// Width and height in pixels.
    pub size_px: [u32; 2],
    /// Samples along each side of a pixel, 1 to 16.
    pub samples: u32,
    /// How well the planet is drawn.
    pub quality: Quality,
    /// Diameter of the lens, metres; 0: all is sharp.
    pub aperture_m: f64,
    /// Distance that is in focus, metres; none: what is in the middle of the picture.
    pub focus_m: Option<f64>,
    /// Length of a film, seconds.
    pub film_secs: f64,
    /// Frames of each second of a film.
    pub fps: u32,
}

impl Default for PhotoSettings {
    fn default() -> Self {
        Self {
            size_px: [1920, 1080],
            samples: 1,
            quality: Quality::High,
            aperture_m: 0.0,
            focus_m: None,
            film_secs: 10.0,
            fps: 30,
        }
    }
}

/// The photographs that are being taken.
pub struct Shooting {
    /// The file, or the first one.
    pub first: PathBuf,
    /// How many photographs.
    pub count: usize,
    job: Job<Result<usize, String>>,
}

impl Shooting {
    /// Takes photographs on another thread. `wake` is called when there is progress.
    pub fn start(sequence: Sequence, mut renderer: Renderer, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let (first, count) = (sequence.first_file(), sequence.count());
        let take =
            move |go_on: GoOn<'_>| sequence.take(&mut renderer, &mut |share| go_on(share)).map(|taken| taken.done);
        let job = Job::start(take, wake);
        Self { first, count, job }
    }

    /// Share that is done, 0 to 1.
    pub fn done(&self) -> f64 {
        self.job.done()
    }

    /// Stops after the tile that is being drawn. Files that are written stay.
    pub fn cancel(&self) {
        self.job.stop();
    }

    /// The number of files written, or what went wrong, once it has ended.
    pub fn ended(&self) -> Option<Result<usize, String>> {
        let failed = || Err("the picture could not be drawn; try again".to_owned());
        self.job.ended().map(|result| result.unwrap_or_else(failed))
    }
}
