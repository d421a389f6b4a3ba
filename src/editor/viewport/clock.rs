//! Measured times: from an edit to its picture on screen, and from frame to frame.

use super::timeline::{Drawing, Timeline};
use crate::planet::Planet;
use crate::terrain::{Revision, Terrain};
use crate::tiles::Surface;
use std::collections::VecDeque;
use std::sync::Arc;
use std::sync::mpsc::{Receiver, channel};
use std::time::{Duration, Instant};

/// Most edits that wait for their pictures; older ones are dropped.
const MAX_PENDING: usize = 64;

struct Edit {
    planet: Arc<Planet>,
    at: Instant,
}

/// Measures from the start of the frame of an edit until the GPU has finished the first frame that shows the complete
/// surface of that edit.
#[derive(Default)]
pub struct EditClock {
    pending: VecDeque<Edit>,
    /// The edit whose picture was drawn in this frame and is not presented yet.
    drawn: Option<(Instant, Timeline)>,
    finished: Option<Receiver<Timeline>>,
    last: Option<Timeline>,
}

impl EditClock {
    /// Notes an edit in the frame that began at `frame_start`; `planet` is its result.
    pub fn edited(&mut self, planet: &Arc<Planet>, frame_start: Instant) {
        if self.pending.back().is_some_and(|edit| Arc::ptr_eq(&edit.planet, planet)) {
            return;
        }
        self.pending.push_back(Edit { planet: planet.clone(), at: frame_start });
        if self.pending.len() > MAX_PENDING {
            self.pending.pop_front();
        }
    }

    /// Notes that a picture of a revision has been drawn.
    pub fn drawn(&mut self, surface: &Surface, revision: &Revision, drawing: &Drawing) {
        if !surface.complete {
            return;
        }
        let made_for = |edit: &Edit| Arc::ptr_eq(surface.terrain.planet(), &edit.planet);
        let shown = self.pending.iter().rposition(|edit| {
            made_for(edit) || (Arc::ptr_eq(revision.planet(), &edit.planet) && same_tiles(&surface.terrain, revision))
        });
        if let Some(index) = shown {
            let edit = &self.pending[index];
            let timeline = Timeline::new(edit.at, made_for(edit).then_some(surface), drawing);
            self.drawn = Some((edit.at, timeline));
            self.pending.drain(..=index);
        }
    }

    /// Notes that a frame begins, so that the one before has been presented. Another thread waits until the GPU has
    /// finished it, then calls `wake`.
    pub fn frame_began(&mut self, device: &wgpu::Device, wake: impl FnOnce() + Send + 'static) {
        if let Some(receiver) = &self.finished {
            match receiver.try_recv() {
                Ok(timeline) => {
                    self.last = Some(timeline);
                    self.finished = None;
                }
                Err(std::sync::mpsc::TryRecvError::Empty) => return,
                Err(std::sync::mpsc::TryRecvError::Disconnected) => self.finished = None,
            }
        }
        if let Some((edited_at, mut timeline)) = self.drawn.take() {
            let (sender, receiver) = channel();
            self.finished = Some(receiver);
            let device = device.clone();
            std::thread::spawn(move || {
                if device.poll(wgpu::PollType::wait_indefinitely()).is_ok() {
                    timeline.finish(edited_at.elapsed());
                    // The receiver is gone if the editor has closed.
                    let _ = sender.send(timeline);
                }
                wake();
            });
        }
    }

    /// Whether the picture of an edit was drawn and is not presented yet: the next frame completes the measurement.
    pub fn wants_frame(&self) -> bool {
        self.drawn.is_some()
    }

    /// The time since the oldest edit whose picture is not drawn yet.
    pub fn waiting(&self) -> Option<Duration> {
        self.pending.front().map(|edit| edit.at.elapsed())
    }

    /// The newest measurement.
    pub fn last(&self) -> Option<Duration> {
        self.last.as_ref().map(|timeline| timeline.total)
    }

    /// Its parts.
    pub fn timeline(&self) -> Option<&Timeline> {
        self.last.as_ref()
    }
}

/// Whether the tiles of a terrain are those of another revision, too.
pub(super) fn same_tiles(terrain: &Terrain, revision: &Revision) -> bool {
    !revision.keys().changes_since(terrain.keys()).touches_tiles()
}

/// The time from frame to frame while frames follow each other without a pause.
#[derive(Default)]
pub struct FrameMeter {
    last: Option<Instant>,
    interval_secs: Option<f64>,
}

impl FrameMeter {
    /// Longest time between two frames of one movement.
    const IDLE_SECS: f64 = 0.4;

    /// Notes that a picture has been drawn.
    pub fn drawn(&mut self) {
        let now = Instant::now();
        let interval_secs = self.last.map(|last| (now - last).as_secs_f64());
        self.interval_secs = match (interval_secs.filter(|secs| *secs < Self::IDLE_SECS), self.interval_secs) {
            (Some(new), Some(old)) => Some(old + (new - old) * 0.2),
            (new, _) => new,
        };
        self.last = Some(now);
    }

    /// Seconds from frame to frame, while something moves.
    pub fn interval_secs(&self) -> Option<f64> {
        self.interval_secs.filter(|_| self.last.is_some_and(|last| last.elapsed().as_secs_f64() < Self::IDLE_SECS))
    }
}

/// The newest planet if a surface has its tiles, else the surface's own: it gives sea, air, clouds and light.
pub(super) fn revision_over(newest: Option<&Revision>, surface: &Surface) -> Revision {
    let newest = newest.filter(|newest| same_tiles(&surface.terrain, newest));
    newest.cloned().unwrap_or_else(|| surface.terrain.revision().clone())
}
