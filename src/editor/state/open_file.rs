//! The watch over the open file: whether another program may have changed it.

use crate::editor::files::disk::{News, watch};
use crate::planet::picture::folder_of;
use eframe::egui;
use notify::RecommendedWatcher;
use std::ffi::OsStr;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// A file that has not changed for this long is complete: text editors write it in several steps.
const QUIET: Duration = Duration::from_millis(150);

/// A watch over the folder of a file: many programs save by putting a new file in the place of the old one.
struct Watch {
    path: PathBuf,
    news: News,
    /// None where the system cannot watch; the file is then read again when the window gets the focus.
    _watcher: Option<RecommendedWatcher>,
}

impl Watch {
    fn new(path: &Path, ctx: &egui::Context) -> Self {
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| path.to_owned());
        let (news, ctx) = (News::default(), ctx.clone());
        // The file may have changed before the watch began: it is read again once in any case.
        news.note();
        let (noted, name) = (news.clone(), target.file_name().map(ToOwned::to_owned));
        let is_ours = move |found: &OsStr| Some(found) == name.as_deref();
        let watcher = watch(&folder_of(&target), is_ours, move || {
            noted.note();
            ctx.request_repaint_after(QUIET);
        });
        Self { path: path.to_owned(), news, _watcher: watcher }
    }
}

/// The state of the open file.
#[derive(Default)]
pub struct OpenFile {
    watch: Option<Watch>,
    was_focused: bool,
    /// A change on disk about which the user decides later: the question comes again before the file is saved.
    pub put_off: Option<Vec<u8>>,
    /// A notice about the file, shown while it holds.
    pub notice: Option<String>,
}

impl OpenFile {
    /// Watches the file at `path` from now on, instead of another.
    pub fn follow(&mut self, path: Option<&Path>, ctx: &egui::Context) {
        if self.watch.as_ref().map(|watch| watch.path.as_path()) != path {
            let watch = path.map(|path| Watch::new(path, ctx));
            *self = Self { watch, was_focused: self.was_focused, ..Self::default() };
        }
    }

    /// Whether the window has got the focus since the last call.
    pub fn gained_focus(&mut self, ctx: &egui::Context) -> bool {
        let focused = ctx.input(|input| input.viewport().focused.unwrap_or(true));
        focused && !std::mem::replace(&mut self.was_focused, focused)
    }

    /// Whether the system has reported a change since the last call, and the file has been quiet since.
    pub fn may_have_changed(&self, ctx: &egui::Context) -> bool {
        self.watch.as_ref().is_some_and(|watch| watch.news.is_due(QUIET, ctx))
    }

    /// Notes that the file has its known content: no notice holds any more.
    pub fn settle(&mut self) {
        (self.notice, self.put_off) = (None, None);
    }
}
