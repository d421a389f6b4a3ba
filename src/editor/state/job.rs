//! Work on a thread of its own, with progress and a way to stop it.

use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

/// Told the share of the work that is done, 0 to 1; answers whether to go on.
pub type GoOn<'a> = &'a (dyn Fn(f64) -> bool + Sync);

/// Work that is under way. It is told to stop when the job is dropped.
pub struct Job<T> {
    /// Ten-thousandths that are done.
    done: Arc<AtomicU32>,
    stopped: Arc<AtomicBool>,
    result: Receiver<T>,
}

impl<T: Send + 'static> Job<T> {
    /// Starts work. `wake` is called, from any thread, when there is progress and at the end.
    pub fn start(work: impl FnOnce(GoOn<'_>) -> T + Send + 'static, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let (done, stopped) = (Arc::new(AtomicU32::new(0)), Arc::new(AtomicBool::new(false)));
        let (sender, result) = channel();
        let (told, stop) = (Arc::clone(&done), Arc::clone(&stopped));
        std::thread::spawn(move || {
            let result = work(&|share| {
                let share = (share * 1e4) as u32;
                if told.swap(share, Ordering::Relaxed) != share {
                    wake();
                }
                !stop.load(Ordering::Relaxed)
            });
            // The receiver is gone if nobody waits any more.
            let _ = sender.send(result);
            wake();
        });
        Self { done, stopped, result }
    }
}

impl<T> Job<T> {
    /// Share that is done, 0 to 1.
    pub fn done(&self) -> f64 {
        f64::from(self.done.load(Ordering::Relaxed)) * 1e-4
    }

    /// Asks the work to stop.
    pub fn stop(&self) {
        self.stopped.store(true, Ordering::Relaxed);
    }

    /// The result, once the work has ended; an inner None if its thread has failed.
    pub fn ended(&self) -> Option<Option<T>> {
        match self.result.try_recv() {
            Ok(result) => Some(Some(result)),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(None),
        }
    }
}

impl<T> Drop for Job<T> {
    fn drop(&mut self) {
        self.stop();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::time::Duration;

    fn end<T>(job: &Job<T>) -> Option<T> {
        loop {
            match job.ended() {
                Some(result) => return result,
                None => std::thread::sleep(Duration::from_millis(1)),
            }
        }
    }

    #[test]
    fn work_tells_progress_and_a_job_that_is_stopped_ends() {
        let job = Job::start(|go_on| (0..).take_while(|_| go_on(0.25)).count(), || {});
        while job.done() != 0.25 {
            std::thread::sleep(Duration::from_millis(1));
        }
        assert!(job.ended().is_none());
        job.stop();
        assert!(end(&job).is_some());
    }

    #[test]
    fn a_thread_that_fails_is_told_from_one_that_works() {
        assert_eq!(end(&Job::start(|_| 7, || {})), Some(7));
        assert_eq!(end(&Job::<u32>::start(|_| panic!("as asked"), || {})), None);
    }
}
