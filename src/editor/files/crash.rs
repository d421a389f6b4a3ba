//! Crash reports: what happened, and what was open, in a file beside the working copy. The next start tells of it.

use crate::planet::picture::is_contained;
use std::backtrace::Backtrace;
use std::collections::VecDeque;
use std::fmt::{Debug, Write as _};
use std::fs;
use std::panic::{self, PanicHookInfo};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{SystemTime, UNIX_EPOCH};

/// Most reports that are kept.
const MOST_KEPT: usize = 8;
/// Most reports that one run writes: a panic may repeat in every frame.
const MOST_WRITTEN: usize = 3;
/// Actions that a report lists.
const MOST_ACTIONS: usize = 30;
/// Characters of an action in a report.
const MOST_CHARS: usize = 160;
const PREFIX: &str = "crash-";
/// The ending of a report of which nobody has been told, and of others.
const NEW: &str = ".new.txt";
const TOLD: &str = ".txt";

/// What a report tells of the editor. Clones share it.
#[derive(Clone, Debug, Default)]
pub struct Doing(Arc<Mutex<Known>>);

#[derive(Debug, Default)]
struct Known {
    file: Option<PathBuf>,
    adapter: String,
    actions: VecDeque<String>,
}

impl Doing {
    /// Notes the open file.
    pub fn note_file(&self, path: Option<&Path>) {
        let mut known = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if known.file.as_deref() != path {
            known.file = path.map(Path::to_owned);
            log::info!("open file: {}", path.map_or("none".into(), Path::to_string_lossy));
        }
    }

    /// Notes the graphics adapter.
    pub fn note_adapter(&self, adapter: &str) {
        log::info!("graphics adapter: {adapter}");
        adapter.clone_into(&mut self.0.lock().unwrap_or_else(PoisonError::into_inner).adapter);
    }

    /// Notes an action of the user.
    pub fn note_action(&self, action: &impl Debug) {
        // Some actions hold a text of any length.
        let action: String = format!("{action:?}").chars().take(MOST_CHARS).collect();
        let actions = &mut self.0.lock().unwrap_or_else(PoisonError::into_inner).actions;
        if actions.len() == MOST_ACTIONS {
            actions.pop_front();
        }
        actions.push_back(action);
    }
}

/// Writes a report of each panic of this process to `folder`, besides what the hook before does. Panics that are caught
/// and answered are left out.
pub fn report_panics(folder: &Path, doing: &Doing) {
    let (folder, doing, before) = (folder.to_owned(), doing.clone(), panic::take_hook());
    let written = AtomicUsize::new(0);
    panic::set_hook(Box::new(move |panic| {
        if !is_contained() && written.fetch_add(1, Ordering::Relaxed) < MOST_WRITTEN {
            // A hook must not panic, and there is nobody to tell of an error but the hook before.
            let _ = write(&folder, &text(&doing, panic));
        }
        before(panic);
    }));
}

fn text(doing: &Doing, panic: &PanicHookInfo<'_>) -> String {
    let thread = std::thread::current();
    let mut text = format!("Tellus {} stopped at an error.\n\n", env!("CARGO_PKG_VERSION"));
    let _ = writeln!(text, "{panic}");
    let _ = writeln!(text, "thread: {}", thread.name().unwrap_or("unnamed"));
    let _ = writeln!(text, "system: {} {}", std::env::consts::OS, std::env::consts::ARCH);
    // The thread that panics may hold the lock.
    if let Ok(known) = doing.0.try_lock() {
        let _ = writeln!(text, "adapter: {}", known.adapter);
        let file = known.file.as_ref().map_or("none".to_owned(), |file| file.display().to_string());
        let _ = writeln!(text, "open file: {file}");
        let _ = writeln!(text, "last actions:");
        for action in &known.actions {
            let _ = writeln!(text, "  {action}");
        }
    }
    let _ = writeln!(text, "\n{}", Backtrace::force_capture());
    text
}

fn write(folder: &Path, text: &str) -> std::io::Result<()> {
    fs::create_dir_all(folder)?;
    let since_epoch = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    let name = format!("{PREFIX}{:020}-{}{NEW}", since_epoch.as_millis(), std::process::id());
    fs::write(folder.join(name), text)
}

/// The reports in `folder` of which nobody has been told, the oldest first. They count as told from now on, and all but
/// the newest few are deleted.
pub fn take_new(folder: &Path) -> Vec<PathBuf> {
    let mut reports: Vec<PathBuf> = fs::read_dir(folder)
        .into_iter()
        .flatten()
        .filter_map(|entry| Some(entry.ok()?.path()))
        .filter(|path| name(path).starts_with(PREFIX) && name(path).ends_with(TOLD))
        .collect();
    reports.sort();
    let kept = reports.split_off(reports.len().saturating_sub(MOST_KEPT));
    for old in reports {
        let _ = fs::remove_file(old);
    }
    let told = |path: PathBuf| {
        let stem = name(&path).strip_suffix(NEW)?.to_owned();
        let told = path.with_file_name(stem + TOLD);
        // Where that fails it is told again next time.
        Some(if fs::rename(&path, &told).is_ok() { told } else { path })
    };
    kept.into_iter().filter_map(told).collect()
}

fn name(path: &Path) -> &str {
    path.file_name().and_then(|name| name.to_str()).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_on_any_thread_leaves_a_report() {
        let folder = tempfile::tempdir().unwrap();
        let doing = Doing::default();
        doing.note_adapter("a graphics card");
        doing.note_file(Some(Path::new("planets/mine.ron")));
        for i in 0..MOST_ACTIONS + 5 {
            doing.note_action(&format!("action {i}"));
        }
        report_panics(folder.path(), &doing);
        let worker = std::thread::Builder::new().name("worker".to_owned());
        let ended = worker.spawn(|| panic!("not a planet")).unwrap().join();
        // Other tests panic on purpose.
        drop(panic::take_hook());
        assert!(ended.is_err());
        let texts = take_new(folder.path()).into_iter().map(|report| fs::read_to_string(report).unwrap());
        let text = texts.filter(|text| text.contains("not a planet")).collect::<String>();
        for words in ["crash.rs:", "thread: worker", "adapter: a graphics card", "open file: planets/mine.ron"] {
            assert!(text.contains(words), "{words}: {text}");
        }
        assert!(text.contains("\"action 34\"") && !text.contains("\"action 4\""), "{text}");
    }

    #[test]
    fn a_report_is_told_once_and_the_oldest_go() {
        let folder = tempfile::tempdir().unwrap();
        let folder = folder.path();
        assert!(take_new(&folder.join("none")).is_empty());
        for i in 0..MOST_KEPT + 2 {
            fs::write(folder.join(format!("{PREFIX}{i:020}-1{NEW}")), "a report").unwrap();
        }
        fs::write(folder.join("recovery-0.ron"), "another file").unwrap();
        let told = take_new(folder);
        assert_eq!(told.len(), MOST_KEPT);
        assert!(told.iter().all(|path| path.is_file() && !name(path).ends_with(NEW)));
        assert!(name(&told[0]).contains("2-1"), "{told:?}");
        assert!(take_new(folder).is_empty());
        assert_eq!(fs::read_dir(folder).unwrap().count(), MOST_KEPT + 1);
    }
}
