//! Settings of the view; no part of the document.

use crate::lod::Quality;
use crate::render::{DebugView, Post};

/// Which picture of the planet is drawn, and at which time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// Shaded, or a debug view.
    pub debug_view: DebugView,
    /// Quality of the picture.
    pub quality: Quality,
    /// Whether the tiles stay those of the view in which they were frozen.
    pub freeze_detail: bool,
    /// How the picture is developed; the metering is chosen for each picture.
    pub post: Post,
    /// Whether the exposure follows the brightness of the picture; [`Post::exposure_ev`] then corrects it.
    pub auto_exposure: bool,
    /// Whether pictures take something from those before them: clouds while the camera moves, and more samples while
    /// nothing does.
    pub refine: bool,
    /// Seconds since time zero.
    pub time_secs: f64,
    /// Whether time passes.
    pub playing: bool,
    /// Seconds of the planet for each second of the clock.
    pub time_speed: f64,
}

impl ViewSettings {
    /// The settings at the start: the shaded planet at time zero, paused.
    pub fn new(quality: Quality) -> Self {
        Self {
            debug_view: DebugView::default(),
            quality,
            freeze_detail: false,
            post: Post::default(),
            auto_exposure: true,
            refine: true,
            time_secs: 0.0,
            playing: false,
            // Ten minutes of the planet for each second: a day of 24 hours takes 2.4 minutes.
            time_speed: 600.0,
        }
    }
}
