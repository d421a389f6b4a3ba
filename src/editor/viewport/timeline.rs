//! Where the time of an edit went, from the frame in which it was made to the picture on the screen.

use crate::planet::param::Stage;
use crate::tiles::{BuildStats, Surface};
use std::time::{Duration, Instant};

/// One thing that was done; times in seconds from the edit.
#[derive(Clone, Debug, PartialEq)]
pub struct Step {
    /// What a person reads.
    pub label: &'static str,
    /// When it first began.
    pub begin_secs: f64,
    /// When it last ended.
    pub end_secs: f64,
    /// How long it ran, summed over all threads.
    pub busy_secs: f64,
    /// How often it ran.
    pub runs: usize,
}

/// One edit.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Timeline {
    /// What was done, in order.
    pub steps: Vec<Step>,
    /// From the edit until the GPU was done with its picture.
    pub total: Duration,
    /// What the tiles took; nothing if none were touched.
    pub build: BuildStats,
    /// Tiles that were taken as they were.
    pub tiles_reused: usize,
    /// Bytes of tiles uploaded.
    pub uploaded_bytes: u64,
}

/// A stretch of time.
#[derive(Clone, Copy, Debug)]
pub struct Span {
    /// When it began.
    pub begin: Instant,
    /// When it ended.
    pub end: Instant,
}

impl Span {
    /// From `begin` to now.
    pub fn since(begin: Instant) -> Self {
        Self { begin, end: Instant::now() }
    }
}

/// What drawing a picture took on the thread of the window.
#[derive(Clone, Copy, Debug)]
pub struct Drawing {
    /// Uploading tiles, over one or more frames.
    pub upload: Option<Span>,
    /// Bytes uploaded.
    pub uploaded_bytes: u64,
    /// Encoding and submitting the frame.
    pub draw: Span,
}

impl Timeline {
    /// An edit made at `edited_at` that is now drawn; `surface` if its tiles were made for this edit.
    /// The total is not known yet.
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

    /// The GPU is done with the picture.
    pub fn finish(&mut self, total: Duration) {
        let begin_secs = self.steps.last().map_or(0.0, |draw| draw.end_secs);
        let end_secs = total.as_secs_f64();
        self.steps.push(Step { label: "Present", begin_secs, end_secs, busy_secs: end_secs - begin_secs, runs: 1 });
        self.total = total;
    }
}
