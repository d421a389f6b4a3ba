//! Settings of the view; no part of the document.

use crate::lod::Quality;
use crate::render::{DebugView, Post, Tone};

/// Which picture of the planet is drawn, and at which time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// Shaded, or a debug view.
    pub debug_view: DebugView,
    /// Quality of the picture.
    pub quality: Quality,
    /// Whether the tiles stay those of the view in which they were frozen.
    pub freeze_detail: bool,
    /// Exposure in stops.
    pub exposure_ev: f64,
    /// Whether the exposure follows the brightness of the picture; [`Self::exposure_ev`] then corrects it.
    pub auto_exposure: bool,
    /// Colour temperature that is shown white, kelvins.
    pub white_k: f64,
    /// How much darker the corners are, 0 to 1.
    pub vignette: f64,
    /// The tone curve.
    pub tone: Tone,
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
            exposure_ev: 0.0,
            auto_exposure: true,
            white_k: Post::DAYLIGHT_K,
            vignette: 0.0,
            tone: Tone::default(),
            time_secs: 0.0,
            playing: false,
            // Ten minutes of the planet for each second: a day of 24 hours takes 2.4 minutes.
            time_speed: 600.0,
        }
    }
}
