//! The run of a system under the attraction of all its bodies, on a thread of its own.

use crate::editor::state::job::Job;
use crate::render::Worlds;
use crate::system::nbody::{Scheme, Trial, fitting_step_secs, try_out};
use crate::system::trails::Trails;
use crate::system::{System, YEAR_SECS};
use std::sync::Arc;

/// What a run showed.
pub struct Tried {
    /// Energy error and events.
    pub trial: Trial,
    /// The last orbits of the bodies.
    pub trails: Trails,
}

/// A run, before it, while it goes on and after it.
#[derive(Default)]
pub enum TrialRun {
    /// The system was not run.
    #[default]
    None,
    /// It is being run.
    Running(Job<Tried>),
    /// It was run.
    Done(Tried),
}

impl TrialRun {
    /// Starts a run of some years. `wake` is called when there is progress.
    pub fn start(worlds: Arc<Worlds>, years: f64, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let work = move |go_on: crate::editor::state::job::GoOn<'_>| {
            let system: &System = worlds.system();
            let mut trails = Trails::new(system);
            let span = (years * YEAR_SECS, fitting_step_secs(system));
            let mut steps = 0_u32;
            let trial = try_out(system, &worlds.radii_m(), Scheme::Yoshida6, span, &mut |done, bodies| {
                trails.note(bodies);
                steps = steps.wrapping_add(1);
                !steps.is_multiple_of(64) || go_on(done)
            });
            Tried { trial, trails }
        };
        TrialRun::Running(Job::start(work, wake))
    }

    /// Takes the result when the run has ended. Gives whether its thread has failed.
    pub fn poll(&mut self) -> bool {
        let TrialRun::Running(job) = self else { return false };
        match job.ended() {
            None => false,
            Some(Some(tried)) => {
                *self = TrialRun::Done(tried);
                false
            }
            Some(None) => {
                *self = TrialRun::None;
                true
            }
        }
    }

    /// Ends a run before its time: what was run until then is shown.
    pub fn stop(&self) {
        if let TrialRun::Running(job) = self {
            job.stop();
        }
    }
}
