//! Notices of the editor: its last action, and other windows on the open file.

use crate::editor::files::claim::{self, Claim};
use crate::editor::files::disk::{self, News};
use eframe::egui;
use notify::RecommendedWatcher;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// Time for which the last action is shown, on egui's clock.
const SHOWN_SECS: f64 = 5.0;
/// Longest time between two looks for other windows while the system reports none.
const LOOK: Duration = Duration::from_secs(1);
/// Pause between a report of the system and the look: a window takes its lock a moment after it makes the file.
const SETTLED: Duration = Duration::from_millis(100);

/// The last action, and whether another window has the open file.
#[derive(Default)]
pub struct Notices {
    /// The last action, and when it was said on egui's clock.
    said: Option<(String, f64)>,
    /// Start of this frame on egui's clock.
    now_secs: f64,
    /// The folder where windows note which files they have open.
    claims: Option<PathBuf>,
    /// The file that was claimed, with None where that failed: it is not tried again in every frame.
    claim: Option<(PathBuf, Option<Claim>)>,
    shared: bool,
    /// Why unsaved work is not kept in a working copy.
    pub unkept: Option<String>,
    looked: Option<Instant>,
    /// Reports windows that come and go while this one draws nothing. The inner None: the system cannot watch.
    watch: Option<Option<RecommendedWatcher>>,
    news: News,
}

impl Notices {
    /// Notes in `folder` which file this window has open.
    pub fn claim_in(&mut self, folder: &Path) {
        self.claims = Some(folder.to_owned());
    }

    /// Notes that a frame begins.
    pub fn begin_frame(&mut self, ctx: &egui::Context) {
        self.now_secs = ctx.input(|input| input.time);
    }

    /// Notes an action to show.
    pub fn say(&mut self, text: String) {
        self.said = Some((text, self.now_secs));
    }

    /// The last action, and the time for which it is still shown.
    pub fn said(&self) -> Option<(&str, Duration)> {
        let (text, since_secs) = self.said.as_ref()?;
        let left_secs = since_secs + SHOWN_SECS - self.now_secs;
        (left_secs > 0.0).then(|| (text.as_str(), Duration::from_secs_f64(left_secs)))
    }

    /// Whether another window has the open file open too.
    pub fn is_shared(&self) -> bool {
        self.shared
    }

    /// Notes that this window has the file at `path` open, and looks for other windows on it.
    pub fn poll(&mut self, path: Option<&Path>, ctx: &egui::Context) {
        let Some(folder) = &self.claims else { return };
        if self.claim.as_ref().map(|(path, _)| path.as_path()) != path {
            self.claim = path.map(|path| (path.to_owned(), Claim::take(folder, path)));
            self.looked = None;
        }
        let claim = self.claim.as_ref().and_then(|(_, claim)| claim.as_ref());
        if self.watch.is_none() && claim.is_some() {
            let (noted, ctx) = (self.news.clone(), ctx.clone());
            self.watch = Some(disk::watch(folder, claim::is_claim, move || {
                noted.note();
                ctx.request_repaint_after(SETTLED);
            }));
        }
        let due = self.news.is_due(SETTLED, ctx);
        if due || self.looked.is_none_or(|looked| looked.elapsed() > LOOK) {
            self.looked = Some(Instant::now());
            self.shared = claim.is_some_and(Claim::is_shared);
        }
    }

    /// Gives up the claim on the open file.
    pub fn drop_claim(&mut self) {
        self.claim = None;
    }
}
