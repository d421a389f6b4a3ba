//! Exposure that follows what there is to see, as an eye would: pictures go on for a moment after the last change.

use crate::render::Metering;
use std::time::{Duration, Instant};

/// How long after a change exposure goes on adapting.
const LASTS: Duration = Duration::from_millis(1500);
/// From one picture to the next meanwhile.
pub const PAUSE: Duration = Duration::from_millis(16);

/// When things changed last.
pub struct Adaptation {
    by_eye: bool,
    changed: Option<Instant>,
    drawn: Option<Instant>,
}

impl Adaptation {
    /// `by_eye`: bit by bit; otherwise at once.
    pub fn new(by_eye: bool) -> Self {
        Self { by_eye, changed: None, drawn: None }
    }

    /// Whether there is more to come although nothing else changes.
    pub fn is_under_way(&self) -> bool {
        self.by_eye && self.changed.is_some_and(|changed| changed.elapsed() < LASTS)
    }

    /// How the picture that is drawn now is to be metered; `changed`: it shows something new.
    pub fn metering(&mut self, automatic: bool, changed: bool) -> Metering {
        let now = Instant::now();
        if changed {
            self.changed = Some(now);
        }
        // Nothing has been seen yet that the eye could have adapted to.
        let before = self.drawn.replace(now);
        match before.filter(|_| self.by_eye) {
            _ if !automatic => Metering::Manual,
            Some(before) => Metering::Adapting { secs: (now - before).as_secs_f64().min(0.1) },
            None => Metering::Instant,
        }
    }
}
