//! How long the window's thread took for each frame: whether the window stays responsive while tiles are built.

use std::collections::VecDeque;
use std::time::{Duration, Instant};

/// Most frames that are kept.
const MOST: usize = 600;

/// The times of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct FrameTime {
    /// From the start of the frame to the start of the next. Includes egui's painting, the wait for the screen, and the
    /// time in which nothing had to be drawn.
    pub whole: Duration,
    /// Time of the editor's own code.
    pub editor: Duration,
    /// Part of [`Self::editor`] that uploaded tiles.
    pub upload: Duration,
    /// Part of [`Self::editor`] that encoded and submitted the picture.
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
    /// Notes that a frame begins, so that the one before has been shown.
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

    /// Notes that the editor's code has finished with the frame.
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

    /// The longest of the frames by a measure, and the 95th percentile.
    pub fn worst(&self, measure: impl Fn(&FrameTime) -> Duration) -> (Duration, Duration) {
        let mut times: Vec<Duration> = self.frames.iter().map(measure).collect();
        times.sort_unstable();
        let at = |rank: usize| times.get(rank.saturating_sub(1)).copied().unwrap_or_default();
        (at(times.len()), at((times.len() * 95).div_ceil(100)))
    }
}
