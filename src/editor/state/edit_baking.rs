//! Ground edits on their way into a height picture, on another thread.

use super::job::{GoOn, Job};
use crate::bake::{Deviation, EditBake};
use crate::planet::edits::edit_path;
use crate::planet::param::Stage;
use crate::planet::{GroundEdits, Planet};
use crate::terrain::{MapStore, Revision};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Share of the progress in which the edits are evaluated; the rest compares the picture with them.
const EVALUATING: f64 = 0.9;

/// Edits that are being baked.
pub struct EditBaking {
    /// The picture.
    pub to: PathBuf,
    /// The planet that it was asked of.
    asked: Arc<Planet>,
    job: Job<Result<Option<Done>, String>>,
}

/// What has become of them.
#[derive(Debug)]
pub struct Done {
    /// The edits of the planet with the stamp in the place of those that were baked.
    pub edits: GroundEdits,
    /// The index of the stamp.
    pub index: usize,
    /// How many were baked.
    pub count: usize,
    /// Size of a pixel on the ground, metres.
    pub pixel_m: f64,
    /// How far the new ground is from the old.
    pub deviation: Deviation,
}

impl EditBaking {
    /// Bakes on another thread. `wake` is called when there is progress.
    pub fn start(
        planet: Arc<Planet>,
        chosen: Vec<usize>,
        (to, folder): (&Path, Option<PathBuf>),
        store: Option<Arc<MapStore>>,
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Self {
        let (path, asked) = (to.to_owned(), planet.clone());
        let work = move |go_on: GoOn<'_>| {
            let why = |error: crate::bake::BakeError| error.to_string();
            let bake = EditBake::new(&planet, chosen).map_err(why)?;
            let Some(baked) = bake.run(store.as_ref(), &|done| go_on(EVALUATING * done)).map_err(why)? else {
                return Ok(None);
            };
            baked.write(&path).map_err(why)?;
            let compared = bake.compare(&baked, &path, store.as_ref(), &|_| go_on(EVALUATING)).map_err(why)?;
            let Some(deviation) = compared else { return Ok(None) };
            let mut stamped = baked.replace(&planet, &path);
            if let Some(folder) = folder {
                stamped = stamped.moved_to(&folder);
            }
            let own = edit_path(baked.index());
            let why = stamped.load_pictures().into_iter().find(|(at, _)| at.starts_with(&own));
            if let Some((_, why)) = why {
                return Err(format!("{}: {why}", path.display()));
            }
            let (index, count, pixel_m) = (baked.index(), bake.count(), bake.pixel_m());
            Ok(Some(Done { edits: stamped.edits, index, count, pixel_m, deviation }))
        };
        Self { to: to.to_owned(), asked, job: Job::start(work, wake) }
    }

    /// Whether a planet has the edits and the ground of the one that it was asked of.
    pub fn fits(&self, planet: &Arc<Planet>) -> bool {
        let same_ground = || {
            let Ok(before) = Revision::try_new(self.asked.clone()) else { return false };
            let Ok(after) = Revision::try_after(planet.clone(), Some(&before)) else { return false };
            let changed = after.changes_since(&before);
            !changed.contains(Stage::Height) && !changed.contains(Stage::Field)
        };
        Arc::ptr_eq(&self.asked, planet) || (self.asked.edits == planet.edits && same_ground())
    }

    /// Share that is done, 0 to 1.
    pub fn done(&self) -> f64 {
        self.job.done()
    }

    /// Stops.
    pub fn cancel(&self) {
        self.job.stop();
    }

    /// How it ended, once it has; an inner None if it was stopped.
    pub fn ended(&self) -> Option<Result<Option<Done>, String>> {
        let failed = || Err("it could not be computed; try again".to_owned());
        self.job.ended().map(|result| result.unwrap_or_else(failed))
    }
}
