//! Exposure that adapts gradually, as an eye does: drawing goes on for a moment after the last change.

use crate::render::Metering;
use std::time::{Duration, Instant};

/// Time after a change in which the exposure adapts.
const LASTS: Duration = Duration::from_millis(1500);
/// Time from one picture to the next meanwhile.
pub const PAUSE: Duration = Duration::from_millis(16);

/// When the picture last changed, and was last drawn.
pub struct Adaptation {
    gradual: bool,
    changed: Option<Instant>,
    drawn: Option<Instant>,
}

impl Adaptation {
    /// `gradual`: over some pictures; otherwise at once.
    pub fn new(gradual: bool) -> Self {
        Self { gradual, changed: None, drawn: None }
    }

    /// Whether the exposure still adapts.
    pub fn is_under_way(&self) -> bool {
        self.gradual && self.changed.is_some_and(|changed| changed.elapsed() < LASTS)
    }

    /// The metering of the picture that is drawn now. `changed`: the picture differs from the one before.
    pub fn metering(&mut self, automatic: bool, changed: bool) -> Metering {
        let now = Instant::now();
        if changed {
            self.changed = Some(now);
        }
        // The first picture has no exposure before it to adapt from.
        let before = self.drawn.replace(now);
        match before.filter(|_| self.gradual) {
            _ if !automatic => Metering::Manual,
            Some(before) => Metering::Adapting { secs: (now - before).as_secs_f64().min(0.1) },
            None => Metering::Instant,
        }
    }
}
