//! The run of a system under the attraction of all its bodies, on a thread of its own.

use crate::editor::state::job::Job;
use crate::render::Worlds;
use crate::system::YEAR_SECS;
use crate::system::nbody::Scheme;
use crate::system::trails::Trails;
use crate::system::trial::{Plan, Trial};
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
    Running(Job<Result<Tried, String>>),
    /// It was run.
    Done(Tried),
    /// It cannot be run: why, and what would be right.
    Refused(String),
}

impl TrialRun {
    /// Starts a run of some years. `wake` is called when there is progress.
    pub fn start(worlds: Arc<Worlds>, years: f64, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let work = move |go_on: crate::editor::state::job::GoOn<'_>| {
            let (system, radii_m) = (worlds.system(), worlds.radii_m());
            let plan = Plan::new(system, &radii_m, Scheme::default(), years * YEAR_SECS, None)?;
            let mut trails = Trails::new(system);
            let mut steps = 0_u32;
            let trial = plan.run(&mut |done, bodies| {
                trails.note(bodies);
                steps = steps.wrapping_add(1);
                !steps.is_multiple_of(64) || go_on(done)
            });
            Ok(Tried { trial, trails })
        };
        TrialRun::Running(Job::start(work, wake))
    }

    /// Takes the result when the run has ended. Gives whether its thread has failed.
    pub fn poll(&mut self) -> bool {
        let TrialRun::Running(job) = self else { return false };
        match job.ended() {
            None => false,
            Some(Some(result)) => {
                *self = result.map_or_else(TrialRun::Refused, TrialRun::Done);
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
