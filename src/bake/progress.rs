//! How much of a bake is done, and whether it goes on.

use super::BakeError;
use crate::terrain::Scratch;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};

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

    /// Does some work for each item in order, on all threads, until somebody says no or it fails.
    ///
    /// Each thread takes the next item. Dividing the list between threads would nest as deep as the list is long, with
    /// the large frames of the evaluator in each level of the stack, and so would items that wait for threads.
    pub(super) fn each<T: Sync>(
        &self,
        items: &[T],
        work: impl Fn(&T, &mut Scratch) -> Result<(), BakeError> + Sync,
    ) -> Result<(), BakeError> {
        let (next, has_failed) = (AtomicUsize::new(0), AtomicBool::new(false));
        let done = rayon::broadcast(|_| {
            let mut scratch = Scratch::default();
            while !self.is_stopped()
                && !has_failed.load(Ordering::Relaxed)
                && let Some(item) = items.get(next.fetch_add(1, Ordering::Relaxed))
            {
                work(item, &mut scratch).inspect_err(|_| has_failed.store(true, Ordering::Relaxed))?;
            }
            Ok(())
        });
        done.into_iter().collect()
    }
}
