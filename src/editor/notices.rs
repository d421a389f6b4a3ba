//! What the editor says by itself: what has just been done, for a few seconds; what is wrong, as long as it is so.

use super::app::EditorApp;
use super::claim::{self, Claim};
use super::disk::{self, News};
use eframe::egui;
use notify::RecommendedWatcher;
use std::path::PathBuf;
use std::time::{Duration, Instant};

/// How long one has to read what has just been done.
const SHOWN: Duration = Duration::from_secs(5);
/// How often other windows are looked for without news of any, at most.
const LOOK: Duration = Duration::from_secs(1);
/// How long after news one looks: a lock is taken a moment after its file is made.
const SETTLED: Duration = Duration::from_millis(100);

/// What is said.
#[derive(Default)]
pub(super) struct Notices {
    said: Option<(String, Instant)>,
    /// Where windows note which files they have open.
    pub(super) claims: Option<PathBuf>,
    /// The file that was claimed; no claim where that failed, so that it is not tried anew in every frame.
    claim: Option<(PathBuf, Option<Claim>)>,
    shared: bool,
    looked: Option<Instant>,
    /// Tells of windows that come and go while this one has nothing to draw, once it was tried to set up.
    watch: Option<Option<RecommendedWatcher>>,
    news: News,
}

impl EditorApp {
    /// Says what has just been done.
    pub(super) fn say(&mut self, text: String) {
        self.notices.said = Some((text, Instant::now()));
    }

    /// What is wrong with the file, as long as it is so.
    pub(super) fn standing_notices(&self) -> Vec<String> {
        let shared = self.document.path().filter(|_| self.notices.shared).map(|path| {
            format!("{} is open in another window, too: what is saved last is what stays.", path.display())
        });
        shared.into_iter().chain(self.disk.notice.clone()).collect()
    }

    /// Notes which file this window has open, and looks for others that have it open, too.
    pub(super) fn poll_claims(&mut self, ctx: &egui::Context) {
        let Notices { claims, claim, shared, looked, watch, news, .. } = &mut self.notices;
        let Some(folder) = claims else { return };
        let path = self.document.path();
        if claim.as_ref().map(|(path, _)| path.as_path()) != path {
            *claim = path.map(|path| (path.to_owned(), Claim::take(folder, path)));
            *looked = None;
        }
        let claim = claim.as_ref().and_then(|(_, claim)| claim.as_ref());
        if watch.is_none() && claim.is_some() {
            let (noted, ctx) = (news.clone(), ctx.clone());
            *watch = Some(disk::watch(folder, claim::is_claim, move || {
                noted.note();
                ctx.request_repaint_after(SETTLED);
            }));
        }
        let due = news.is_due(SETTLED, ctx);
        if due || looked.is_none_or(|looked| looked.elapsed() > LOOK) {
            *looked = Some(Instant::now());
            *shared = claim.is_some_and(Claim::is_shared);
        }
    }

    /// Lets go of the file.
    pub(super) fn drop_claim(&mut self) {
        self.notices.claim = None;
    }

    /// Shows what has just been done.
    pub(super) fn show_said(&mut self, ctx: &egui::Context) {
        let Some((text, since)) = &self.notices.said else { return };
        let Some(left) = SHOWN.checked_sub(since.elapsed()) else {
            self.notices.said = None;
            return;
        };
        egui::Area::new(egui::Id::unique("said"))
            .anchor(egui::Align2::LEFT_BOTTOM, [12.0, -40.0])
            .order(egui::Order::Foreground)
            .interactable(false)
            .show(ctx, |ui| {
                egui::Frame::popup(ui.style()).show(ui, |ui| {
                    ui.set_max_width(0.6 * ctx.content_rect().width());
                    ui.label(text);
                });
            });
        ctx.request_repaint_after(left);
    }
}
