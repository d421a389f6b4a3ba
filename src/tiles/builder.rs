//! Builds surfaces in the background: one thread takes the newest request, works on all cores in slices, and hands over
//! complete sets of tiles.
//!
//! A request is a planet and the views of it. All views share the terrain and the cache. A slice works for one view:
//! for the view that has waited longest, until each has a surface of the request; then tiles come before detail.
//!
//! A slice ends when its time is up or a newer request arrives. It always ends with a complete surface, perhaps a
//! coarser one. Only the first slice of a request has a grace period, so that a slider that is held shows every edit,
//! however heavy the planet is. Stale work is dropped, and no surface mixes two revisions.
//!
//! World maps are solved after the first slice. Until then the maps of the revision before serve; then the climate of
//! the tiles is computed again. A structure that changed has a slice with drafts of its maps first, which has the grace
//! period, too.

use super::cache::DEFAULT_BUDGET_BYTES;
use super::worker::Worker;
use super::{Memory, Surface};
use crate::lod::View;
use crate::planet::{InvalidPlanet, Planet};
use crate::terrain::Revision;
use crate::world::MapStore;
use std::sync::atomic::{AtomicBool, AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Builds surfaces in the background. The newest planet and views win; stale work is dropped.
pub struct Builder {
    shared: Arc<Shared>,
    budget_bytes: Arc<AtomicUsize>,
}

/// Options of a [`Builder`].
#[derive(Clone, Debug)]
#[non_exhaustive]
pub struct BuilderOptions {
    /// Limit of the cache of tiles and fields. With 0 every edit is a rebuild from nothing.
    pub budget_bytes: usize,
    /// Where world maps are kept from one process to the next.
    pub maps: Option<Arc<MapStore>>,
    /// The threads that work, such as a game's own; None for rayon's global pool, which has one for each core. The
    /// builder's own thread only waits for them.
    pub pool: Option<Arc<rayon::ThreadPool>>,
}

impl Default for BuilderOptions {
    fn default() -> Self {
        Self { budget_bytes: DEFAULT_BUDGET_BYTES, maps: None, pool: None }
    }
}

impl BuilderOptions {
    /// Options with this cache budget.
    pub fn budget_bytes(mut self, budget_bytes: usize) -> Self {
        self.budget_bytes = budget_bytes;
        self
    }

    /// Options with this store of world maps, if there is one.
    pub fn maps(mut self, maps: Option<Arc<MapStore>>) -> Self {
        self.maps = maps;
        self
    }

    /// Options with these threads.
    ///
    /// ```
    /// use std::sync::Arc;
    /// use tellus::rayon::ThreadPoolBuilder;
    /// use tellus::tiles::{Builder, BuilderOptions};
    ///
    /// // A game that leaves two threads to the terrain.
    /// let pool = Arc::new(ThreadPoolBuilder::new().num_threads(2).build()?);
    /// let builder = Builder::with_options(BuilderOptions::default().pool(pool), || {});
    /// # Ok::<(), tellus::rayon::ThreadPoolBuildError>(())
    /// ```
    pub fn pool(mut self, pool: Arc<rayon::ThreadPool>) -> Self {
        self.pool = Some(pool);
        self
    }
}

/// How much of the newest request of a [`Builder`] is done.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct BuildProgress {
    /// Share of its world maps that is solved, 0 to 1. A planet without a structure has small ones.
    pub maps: f64,
    /// Its views.
    pub views: usize,
    /// Views that have a surface of it, perhaps a coarse one.
    pub begun: usize,
    /// Views whose tiles are all built.
    pub tiled: usize,
    /// Views that have their horizon angles and detail textures, too.
    pub finished: usize,
}

impl BuildProgress {
    /// Whether nothing is left to do.
    pub fn is_finished(&self) -> bool {
        self.finished == self.views
    }

    /// One number for a bar: the mean of the shares of maps, and of views that are begun, tiled and finished.
    pub fn share(&self) -> f64 {
        if self.is_finished() {
            return 1.0;
        }
        let done = (self.begun + self.tiled + self.finished) as f64 / self.views as f64;
        0.25 * (self.maps + done)
    }
}

#[derive(Default)]
pub(super) struct Shared {
    state: Mutex<State>,
    pub(super) changed: Condvar,
    /// Number of the newest request. Work compares its own number to learn whether it is still wanted.
    newest: AtomicU64,
    /// Number of the newest request whose planet differs from the one before.
    newest_planet: AtomicU64,
    paused: AtomicBool,
}

#[derive(Default)]
pub(super) struct State {
    request: Option<Request>,
    /// As many as the newest request has.
    pub(super) views: Vec<Progress>,
    pub(super) memory: Memory,
    /// Share of the world maps that is solved.
    pub(super) maps: f64,
    pub(super) error: Option<String>,
    pub(super) closing: bool,
    /// Whether no slice is begun.
    paused: bool,
}

/// What there is for one view. Requests are known by their numbers.
#[derive(Default)]
pub(super) struct Progress {
    pub(super) surface: Option<Arc<Surface>>,
    /// The newest request that the view had a slice of.
    pub(super) begun: u64,
    /// The newest request whose tiles are all built, with final world maps.
    pub(super) tiled: u64,
    /// The newest request that is finished or was given up.
    pub(super) finished: u64,
}

#[derive(Clone)]
pub(super) struct Request {
    pub(super) revision: Revision,
    pub(super) views: Vec<View>,
    pub(super) asked: Instant,
    pub(super) number: u64,
}

impl Shared {
    pub(super) fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    pub(super) fn is_newest(&self, number: u64) -> bool {
        self.newest.load(Ordering::Relaxed) == number
    }

    /// Whether results for the planet of a request still serve, perhaps for another view.
    pub(super) fn is_newest_planet(&self, number: u64) -> bool {
        self.newest_planet.load(Ordering::Relaxed) <= number
    }

    pub(super) fn is_paused(&self) -> bool {
        self.paused.load(Ordering::Relaxed)
    }
}

impl State {
    /// What to do now.
    pub(super) fn next(&self) -> Option<(&Request, usize)> {
        if self.paused { None } else { self.pending() }
    }

    /// The request to work on, and which of its views.
    fn pending(&self) -> Option<(&Request, usize)> {
        let request = self.request.as_ref()?;
        let number = request.number;
        let unfinished = self.views.iter().enumerate().filter(|(_, view)| view.finished != number);
        let next = unfinished.min_by_key(|(_, view)| (view.begun == number, view.tiled == number, view.begun))?;
        Some((request, next.0))
    }
}

impl Builder {
    /// Starts the worker thread. It calls `wake` whenever a new surface is ready.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self::with_options(BuilderOptions::default(), wake)
    }

    /// The same with options.
    pub fn with_options(options: BuilderOptions, wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self::start(Worker::new(options), wake)
    }

    fn start(mut worker: Worker, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let (shared, budget_bytes) = (Arc::new(Shared::default()), worker.budget_bytes.clone());
        let theirs = shared.clone();
        let spawned = std::thread::Builder::new().name("tellus-build".to_owned()).spawn(move || {
            profiling::register_thread!("tellus-build");
            worker.work(&theirs, &wake);
        });
        if let Err(error) = spawned {
            shared.lock().error = Some(format!("Nothing can be built: no thread could be started: {error}"));
        }
        Self { shared, budget_bytes }
    }

    /// Requests a planet as seen from a view. Cheap if nothing changed since the last call; call it every frame.
    /// Another planet is compiled here.
    ///
    /// # Errors
    /// An invalid planet. The last request stays.
    pub fn request(&self, planet: &Arc<Planet>, view: &View) -> Result<(), InvalidPlanet> {
        let before = self.shared.lock().request.as_ref().map(|request| request.revision.clone());
        self.request_views(&Revision::try_after(planet.clone(), before.as_ref())?, std::slice::from_ref(view));
        Ok(())
    }

    /// Requests a planet that is compiled, as seen from several views, such as a main picture and a mirror. A view is
    /// known by its place in the list.
    pub fn request_views(&self, revision: &Revision, views: &[View]) {
        let mut state = self.shared.lock();
        let before = state.request.as_ref();
        let is_same = |before: &Revision| before.is_same(revision) || before.planet() == revision.planet();
        let same_planet = before.is_some_and(|request| is_same(&request.revision));
        if !same_planet || before.is_some_and(|request| request.views != views) {
            let number = self.shared.newest.fetch_add(1, Ordering::Relaxed) + 1;
            if !same_planet {
                self.shared.newest_planet.store(number, Ordering::Relaxed);
            }
            // An equal planet is compiled already.
            let revision = before.filter(|_| same_planet).map_or(revision, |request| &request.revision);
            let (revision, views) = (revision.clone(), views.to_vec());
            state.views.resize_with(views.len(), Progress::default);
            state.request = Some(Request { revision, views, asked: Instant::now(), number });
            self.shared.changed.notify_all();
        }
    }

    /// The newest surface of the first view, complete or not.
    pub fn surface(&self) -> Option<Arc<Surface>> {
        self.surface_of(0)
    }

    /// The newest surface of a view, complete or not. None if there is none yet, or no such view.
    pub fn surface_of(&self, view: usize) -> Option<Arc<Surface>> {
        self.shared.lock().views.get(view)?.surface.clone()
    }

    /// Whether a request is being worked on.
    pub fn is_busy(&self) -> bool {
        self.shared.lock().pending().is_some()
    }

    /// Whether all tiles of the newest request are built. Their horizon angles and detail textures may follow.
    pub fn has_all_tiles(&self) -> bool {
        let state = self.shared.lock();
        let done = |view: &Progress, number| view.tiled == number || view.finished == number;
        state.request.as_ref().is_none_or(|request| state.views.iter().all(|view| done(view, request.number)))
    }

    /// How much of the newest request is done.
    pub fn progress(&self) -> BuildProgress {
        let state = self.shared.lock();
        let Some(request) = &state.request else { return BuildProgress { maps: 1.0, ..BuildProgress::default() } };
        let count = |is_done: &dyn Fn(&Progress) -> bool| state.views.iter().filter(|view| is_done(view)).count();
        let number = request.number;
        let finished = count(&|view| view.finished == number);
        let begun = count(&|view| view.begun == number);
        // What the worker told last may be of the planet before.
        let maps = if begun > 0 { state.maps } else { 0.0 };
        let tiled = count(&|view| view.tiled == number).max(finished);
        BuildProgress { maps, views: state.views.len(), begun: begun.max(finished), tiled, finished }
    }

    /// Stops work, or lets it go on. Work that is under way ends within some milliseconds, and what it has made is
    /// shown. Requests may be made meanwhile; they are busy until work goes on.
    pub fn set_paused(&self, is_paused: bool) {
        self.shared.paused.store(is_paused, Ordering::Relaxed);
        self.shared.lock().paused = is_paused;
        self.shared.changed.notify_all();
    }

    /// Drops the newest request, finished or not. The surfaces stay; the next request is worked on even if it is the
    /// same.
    pub fn cancel(&self) {
        let mut state = self.shared.lock();
        if state.request.take().is_some() {
            let number = self.shared.newest.fetch_add(1, Ordering::Relaxed) + 1;
            self.shared.newest_planet.store(number, Ordering::Relaxed);
        }
    }

    /// Changes the cache budget. It is kept from the next tile on.
    pub fn set_budget_bytes(&self, budget_bytes: usize) {
        self.budget_bytes.store(budget_bytes, Ordering::Relaxed);
    }

    /// Memory use of the cache.
    pub fn memory(&self) -> Memory {
        self.shared.lock().memory
    }

    /// Why the newest request was given up. The next request tries again.
    pub fn error(&self) -> Option<String> {
        self.shared.lock().error.clone()
    }
}

impl Drop for Builder {
    fn drop(&mut self) {
        self.shared.lock().closing = true;
        self.shared.newest.fetch_add(1, Ordering::Relaxed);
        self.shared.newest_planet.store(u64::MAX, Ordering::Relaxed);
        self.shared.changed.notify_all();
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::{Quality, opening};
    use crate::tiles::refine::refine;
    use crate::tiles::worker::Refine;
    use std::time::Duration;

    #[test]
    fn a_panic_gives_up_one_planet_and_is_told() {
        static BROKEN: AtomicBool = AtomicBool::new(true);
        let refine_or_panic: Refine = |terrain, goal, cache, cut, stats, keep_going| {
            assert!(!BROKEN.load(Ordering::Relaxed), "the ground gave way");
            refine(terrain, goal, cache, cut, stats, keep_going)
        };
        let mut worker = Worker::new(BuilderOptions::default());
        worker.refine = refine_or_panic;
        let builder = Builder::start(worker, || {});
        let planet = Arc::new(Planet::default());
        let view = |side_px| opening::opening_view(&planet, [side_px, 64], Quality::Low);
        let settle = || {
            while builder.is_busy() {
                std::thread::sleep(Duration::from_millis(1));
            }
        };
        builder.request(&planet, &view(64)).unwrap();
        settle();
        assert_eq!(builder.error().as_deref(), Some("This planet could not be built: the ground gave way"));
        assert!(builder.surface().is_none());
        BROKEN.store(false, Ordering::Relaxed);
        builder.request(&planet, &view(65)).unwrap();
        settle();
        assert_eq!(builder.error(), None);
        assert!(builder.surface().is_some_and(|surface| surface.complete));
    }

    fn wait_for(is_so: impl Fn() -> bool) {
        let begun = Instant::now();
        while !is_so() {
            assert!(begun.elapsed() < Duration::from_secs(60), "it never came");
            std::thread::sleep(Duration::from_millis(1));
        }
    }

    #[test]
    fn the_games_own_threads_do_the_work_and_rest_when_they_are_told() {
        static STRANGERS: AtomicUsize = AtomicUsize::new(0);
        let refine_here: Refine = |terrain, goal, cache, cut, stats, keep_going| {
            let name = std::thread::current().name().map(str::to_owned);
            let is_own = name.is_some_and(|name| name.starts_with("game-")) && rayon::current_num_threads() == 2;
            STRANGERS.fetch_add(usize::from(!is_own), Ordering::Relaxed);
            refine(terrain, goal, cache, cut, stats, keep_going)
        };
        let pool = rayon::ThreadPoolBuilder::new().num_threads(2).thread_name(|i| format!("game-{i}"));
        let options = BuilderOptions::default().pool(Arc::new(pool.build().unwrap()));
        let mut worker = Worker::new(options);
        worker.refine = refine_here;
        let builder = Builder::start(worker, || {});
        let planet = Arc::new(Planet::default());
        let view = opening::opening_view(&planet, [64, 64], Quality::Low);
        assert!(builder.progress().is_finished() && builder.progress().share() == 1.0);
        builder.set_paused(true);
        builder.request(&planet, &view).unwrap();
        std::thread::sleep(Duration::from_millis(50));
        let progress = builder.progress();
        assert!(builder.is_busy() && builder.surface().is_none(), "it did not rest");
        assert_eq!((progress.views, progress.begun, progress.share()), (1, 0, 0.0));
        builder.set_paused(false);
        wait_for(|| !builder.is_busy());
        let progress = builder.progress();
        assert_eq!((progress.maps, progress.tiled, progress.finished), (1.0, 1, 1));
        assert_eq!(STRANGERS.load(Ordering::Relaxed), 0);
    }

    #[test]
    fn a_request_that_is_cancelled_is_dropped_and_can_be_made_again() {
        let builder = Builder::new(|| {});
        let planet = Arc::new(Planet::default());
        let view = opening::opening_view(&planet, [64, 64], Quality::Low);
        builder.set_paused(true);
        builder.request(&planet, &view).unwrap();
        builder.cancel();
        assert!(!builder.is_busy() && builder.progress().is_finished());
        builder.set_paused(false);
        builder.request(&planet, &view).unwrap();
        wait_for(|| !builder.is_busy());
        assert!(builder.surface().is_some_and(|surface| surface.complete));
    }
}
