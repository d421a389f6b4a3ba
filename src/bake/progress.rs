//! How much of a bake is done, and whether it goes on.

use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};

/// Counts the work that is done on all threads.
pub(super) struct Progress<'a> {
    go_on: &'a (dyn Fn(f64) -> bool + Sync),
    total: u64,
    done: AtomicU64,
    stopped: AtomicBool,
}

impl<'a> Progress<'a> {
    /// `total`: all work, in any unit.
    pub(super) fn new(total: u64, go_on: &'a (dyn Fn(f64) -> bool + Sync)) -> Self {
        Self { go_on, total: total.max(1), done: AtomicU64::new(0), stopped: AtomicBool::new(false) }
    }

    /// Adds work that is done. Whether to go on.
    pub(super) fn add(&self, work: u64) -> bool {
        let done = self.done.fetch_add(work, Ordering::Relaxed) + work;
        if !self.is_stopped() && !(self.go_on)(done.min(self.total) as f64 / self.total as f64) {
            self.stopped.store(true, Ordering::Relaxed);
        }
        !self.is_stopped()
    }

    /// Whether somebody said no.
    pub(super) fn is_stopped(&self) -> bool {
        self.stopped.load(Ordering::Relaxed)
    }
}
