//! How long the window's own thread took for each frame: whether it stays responsive whatever is being built.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Frames remembered.
const MOST: usize = 600;

/// One frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameTime {
    /// From the start of the frame to the start of the next: with egui's painting, the wait for the screen, and however
    /// long nothing had to be drawn.
    pub whole: Duration,
    /// What the editor itself took.
    pub editor: Duration,
    /// What of that went into uploading tiles.
    pub upload: Duration,
    /// What of that went into encoding and submitting the picture.
    pub draw: Duration,
}

/// The newest frames.
#[derive(Default)]
pub struct FrameLog {
    frames: VecDeque<FrameTime>,
    begun: Option<Instant>,
    current: FrameTime,
}

impl FrameLog {
    /// A frame begins; the one before has been shown.
    pub fn begin(&mut self, now: Instant) {
        if let Some(begun) = self.begun.replace(now) {
            let frame = FrameTime { whole: now.duration_since(begun), ..self.current };
            log::trace!(target: "tellus::frame", "{frame:?}");
            self.frames.push_back(frame);
            if self.frames.len() > MOST {
                self.frames.pop_front();
            }
        }
        self.current = FrameTime::default();
    }

    /// The editor has done its part of the frame.
    pub fn end(&mut self) {
        self.current.editor = self.begun.map_or(Duration::ZERO, |begun| begun.elapsed());
    }

    /// Notes an upload in this frame.
    pub fn uploaded(&mut self, took: Duration) {
        self.current.upload += took;
    }

    /// Notes a picture drawn in this frame.
    pub fn drew(&mut self, took: Duration) {
        self.current.draw += took;
    }

    /// The newest frames, oldest first.
    pub fn frames(&self) -> impl ExactSizeIterator<Item = &FrameTime> {
        self.frames.iter()
    }

    /// The longest of the frames by a measure, and what 95 of 100 do not exceed.
    pub fn worst(&self, measure: impl Fn(&FrameTime) -> Duration) -> (Duration, Duration) {
        let mut times: Vec<Duration> = self.frames.iter().map(measure).collect();
        times.sort_unstable();
        let at = |rank: usize| times.get(rank.saturating_sub(1)).copied().unwrap_or_default();
        (at(times.len()), at((times.len() * 95).div_ceil(100)))
    }
}
