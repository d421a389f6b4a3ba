//! Settings of the view; no part of the document.

use crate::lod::Quality;
use crate::render::{DebugView, Post};
use crate::tiles::DEFAULT_BUDGET_BYTES;
use std::ops::RangeInclusive;

/// Memory for tiles that may be set, MiB. Less than the least holds no picture of a rugged planet.
pub const CACHE_MIB: RangeInclusive<u32> = 64..=8192;

/// Which picture of the planet is drawn, and at which time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ViewSettings {
    /// Shaded, or a debug view.
    pub debug_view: DebugView,
    /// Index of the population whose density a view shows: the one that is selected.
    pub population: usize,
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
    /// Memory for the tiles of the planet and of its neighbours, MiB.
    pub cache_mib: u32,
}

impl ViewSettings {
    /// The settings at the start: the shaded planet at time zero, paused.
    pub fn new(quality: Quality) -> Self {
        Self {
            debug_view: DebugView::default(),
            population: 0,
            quality,
            freeze_detail: false,
            post: Post::default(),
            auto_exposure: true,
            refine: true,
            time_secs: 0.0,
            playing: false,
            // Ten minutes of the planet for each second: a day of 24 hours takes 2.4 minutes.
            time_speed: 600.0,
            cache_mib: (DEFAULT_BUDGET_BYTES >> 20) as u32,
        }
    }

    /// Takes the memory for tiles of the last run, if that is known and in range.
    pub fn restore_cache(&mut self, kept: Option<&str>) {
        let kept = kept.and_then(|text| text.parse().ok()).filter(|mib| CACHE_MIB.contains(mib));
        self.cache_mib = kept.unwrap_or(self.cache_mib);
    }

    /// The same in bytes.
    pub fn cache_bytes(&self) -> usize {
        (self.cache_mib as usize) << 20
    }
}
