//! The parts of the time from an edit to its picture on screen.

use crate::planet::param::Stage;
use crate::tiles::{BuildStats, Surface};
use std::time::{Duration, Instant};

/// A part of the work; times in seconds since the edit.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// Its name in the performance window.
    pub label: &'static str,
    /// Start of its first run.
    pub begin_secs: f64,
    /// End of its last run.
    pub end_secs: f64,
    /// Run time, summed over all threads.
    pub busy_secs: f64,
    /// Number of runs.
    pub runs: usize,
}

/// The work for an edit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timeline {
    /// The parts, in order.
    pub steps: Vec<Step>,
    /// From the edit until the GPU has finished its picture.
    pub total: Duration,
    /// Figures of the build; zero if no tile was rebuilt.
    pub build: BuildStats,
    /// Tiles that were reused.
    pub tiles_reused: usize,
    /// Bytes of tiles uploaded.
    pub uploaded_bytes: u64,
}

/// A span of time.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// Its start.
    pub begin: Instant,
    /// Its end.
    pub end: Instant,
}

impl Span {
    /// From `begin` to now.
    pub fn since(begin: Instant) -> Self {
        Self { begin, end: Instant::now() }
    }
}

/// The work of the window's thread for a picture.
#[derive(Clone, Copy, Debug)]
pub struct Drawing {
    /// The upload of tiles, over one or more frames.
    pub upload: Option<Span>,
    /// Bytes uploaded.
    pub uploaded_bytes: u64,
    /// The encoding and submission of the frame.
    pub draw: Span,
}

impl Timeline {
    /// The timeline of an edit at `edited_at` whose picture has just been drawn, without its total. `surface`: the
    /// surface, if its tiles were built for this edit.
    pub fn new(edited_at: Instant, surface: Option<&Surface>, drawing: &Drawing) -> Self {
        let mut timeline = Timeline { uploaded_bytes: drawing.uploaded_bytes, ..Timeline::default() };
        let secs = |at: Instant| at.saturating_duration_since(edited_at).as_secs_f64();
        if let Some(surface) = surface {
            let (build, asked_secs) = (surface.stats, secs(surface.asked));
            let mut step = |label, begin_secs: f64, end_secs: f64, busy_secs, runs| {
                let (begin_secs, end_secs) = (asked_secs + begin_secs, asked_secs + end_secs);
                timeline.steps.push(Step { label, begin_secs, end_secs, busy_secs, runs });
            };
            step("Compare and compile", 0.0, build.compile_secs, build.compile_secs, 1);
            step("Choose tiles", build.compile_secs, build.duration_secs, build.select_secs, build.slices);
            for (stage, label) in [
                (Stage::Field, "Layer noise"),
                (Stage::Height, "Heights"),
                (Stage::ClimateNoise, "Climate noise"),
                (Stage::Climate, "Vertices"),
            ] {
                let work = build.stage(stage);
                if work.runs > 0 {
                    step(label, work.begin_secs, work.end_secs, work.busy_secs, work.runs);
                }
            }
            timeline.tiles_reused = build.tiles.saturating_sub(build.tiles_built);
            timeline.build = build;
        }
        let mut step = |label, Span { begin, end }: Span| {
            let (begin_secs, end_secs) = (secs(begin), secs(end));
            timeline.steps.push(Step { label, begin_secs, end_secs, busy_secs: end_secs - begin_secs, runs: 1 });
        };
        if let Some(upload) = drawing.upload.filter(|_| drawing.uploaded_bytes > 0) {
            step("Upload", upload);
        }
        step("Draw", drawing.draw);
        timeline
    }

    /// Adds the presentation; `total` is the time until the GPU has finished the picture.
    pub fn finish(&mut self, total: Duration) {
        let begin_secs = self.steps.last().map_or(0.0, |draw| draw.end_secs);
        let end_secs = total.as_secs_f64();
        self.steps.push(Step { label: "Present", begin_secs, end_secs, busy_secs: end_secs - begin_secs, runs: 1 });
        self.total = total;
    }
}
