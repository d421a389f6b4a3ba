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

use super::cache::{Cache, DEFAULT_BUDGET_BYTES};
use super::horizon::HorizonFinder;
use super::refine::{Cut, refine};
use super::{BuildStats, Memory, Surface, find_detail};
use crate::lod::View;
use crate::lod::tile::{DetailTile, Tile};
use crate::planet::{InvalidPlanet, Planet};
use crate::terrain::Terrain;
use crate::terrain::coarse::CellFields;
use crate::world::{KeepGoing, MapStore, World};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, AtomicUsize, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// Time limit of the first slice of a request: about two frames at 60 Hz.
const FIRST_SLICE: Duration = Duration::from_millis(30);
/// Time for which the first slice runs even if a newer request is waiting.
const GRACE: Duration = Duration::from_millis(25);
/// Time for which detail is computed even if another view is waiting.
const DETAIL_GRACE: Duration = Duration::from_millis(15);
/// Time limit of each further slice. Something is on screen by then, and fewer swaps disturb less.
const NEXT_SLICE: Duration = Duration::from_millis(80);

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
}

impl Default for BuilderOptions {
    fn default() -> Self {
        Self { budget_bytes: DEFAULT_BUDGET_BYTES, maps: None }
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
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
    /// Number of the newest request. Work compares its own number to learn whether it is still wanted.
    newest: AtomicU64,
    /// Number of the newest request whose planet differs from the one before.
    newest_planet: AtomicU64,
}

#[derive(Default)]
struct State {
    request: Option<Request>,
    /// As many as the newest request has.
    views: Vec<Progress>,
    memory: Memory,
    error: Option<String>,
    closing: bool,
}

/// What there is for one view. Requests are known by their numbers.
#[derive(Default)]
struct Progress {
    surface: Option<Arc<Surface>>,
    /// The newest request that the view had a slice of.
    begun: u64,
    /// The newest request whose tiles are all built, with final world maps.
    tiled: u64,
    /// The newest request that is finished or was given up.
    finished: u64,
}

#[derive(Clone)]
struct Request {
    planet: Arc<Planet>,
    views: Vec<View>,
    asked: Instant,
    number: u64,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn is_newest(&self, number: u64) -> bool {
        self.newest.load(Ordering::Relaxed) == number
    }

    /// Whether results for the planet of a request still serve, perhaps for another view.
    fn is_newest_planet(&self, number: u64) -> bool {
        self.newest_planet.load(Ordering::Relaxed) <= number
    }
}

impl State {
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
    pub fn request(&self, planet: &Arc<Planet>, view: &View) {
        self.request_views(planet, std::slice::from_ref(view));
    }

    /// As [`Builder::request`], for several views, such as a main picture and a mirror. A view is known by its place in
    /// the list.
    pub fn request_views(&self, planet: &Arc<Planet>, views: &[View]) {
        let mut state = self.shared.lock();
        let before = state.request.as_ref();
        let same_planet =
            before.is_some_and(|request| Arc::ptr_eq(&request.planet, planet) || request.planet == *planet);
        if !same_planet || before.is_some_and(|request| request.views != views) {
            let number = self.shared.newest.fetch_add(1, Ordering::Relaxed) + 1;
            if !same_planet {
                self.shared.newest_planet.store(number, Ordering::Relaxed);
            }
            let (planet, views) = (planet.clone(), views.to_vec());
            state.views.resize_with(views.len(), Progress::default);
            state.request = Some(Request { planet, views, asked: Instant::now(), number });
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

/// The function that builds tiles; tests replace it.
type Refine =
    fn(&Arc<Terrain>, &View, &Cache, &mut Option<Cut>, Instant, BuildStats, &(dyn Fn() -> bool + Sync)) -> Surface;

/// State of the worker thread.
struct Worker {
    cache: Cache,
    budget_bytes: Arc<AtomicUsize>,
    /// Where world maps are kept from one process to the next.
    maps: Option<Arc<MapStore>>,
    terrain: Option<Arc<Terrain>>,
    /// Layer fields at the cells of world maps, kept for the next revision.
    cell_fields: CellFields,
    /// Whether the newest request had a first slice and still lacks a draft.
    owes_draft: bool,
    /// Number of the request that the newest slice worked for.
    request: u64,
    views: Vec<ViewWork>,
    refine: Refine,
}

/// Work on one view.
#[derive(Default)]
struct ViewWork {
    /// Number of the request.
    request: u64,
    /// What it has taken so far.
    stats: BuildStats,
    /// The finished tiles, while their horizon angles and detail textures are computed.
    complete: Option<(Surface, Option<HorizonFinder>)>,
    /// The last finished LOD cut.
    cut: Option<Cut>,
}

impl Worker {
    fn new(options: BuilderOptions) -> Self {
        let budget_bytes = Arc::new(AtomicUsize::new(options.budget_bytes));
        Self {
            cache: Cache::with_budget(budget_bytes.clone()),
            budget_bytes,
            maps: options.maps,
            terrain: None,
            cell_fields: CellFields::default(),
            owes_draft: false,
            request: 0,
            views: Vec::new(),
            refine,
        }
    }

    fn work(&mut self, shared: &Shared, wake: &dyn Fn()) {
        loop {
            let (request, index) = {
                let mut state = shared.lock();
                loop {
                    if state.closing {
                        return;
                    }
                    if let Some((request, index)) = state.pending() {
                        break (request.clone(), index);
                    }
                    state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
                }
            };
            let slice = catch_unwind(AssertUnwindSafe(|| self.slice(shared, &request, index)));
            let mut state = shared.lock();
            let gone_wrong = match slice {
                Ok(Ok((surface, done))) => {
                    // A newer request may have fewer views.
                    if let Some(view) = state.views.get_mut(index) {
                        view.begun = request.number;
                        if surface.complete {
                            view.tiled = request.number;
                        }
                        if done {
                            view.finished = request.number;
                        }
                        view.surface = Some(Arc::new(surface));
                    }
                    None
                }
                Ok(Err(invalid)) => Some(invalid.to_string()),
                Err(panic) => {
                    // The state may be inconsistent.
                    self.cache.clear();
                    self.cell_fields.clear();
                    self.terrain = None;
                    self.views.clear();
                    Some(text_of(panic.as_ref()))
                }
            };
            if gone_wrong.is_some() {
                state.views.iter_mut().for_each(|view| view.finished = request.number);
            }
            state.error = gone_wrong.map(|why| format!("This planet could not be built: {why}"));
            state.memory = self.cache.memory();
            drop(state);
            wake();
        }
    }

    /// Builds a surface of one view. Returns whether it has everything that the request asks for: first all tiles, then
    /// their detail.
    fn slice(&mut self, shared: &Shared, request: &Request, index: usize) -> Result<(Surface, bool), InvalidPlanet> {
        let begun = Instant::now();
        let mut terrain = self.compile(&request.planet)?;
        if std::mem::replace(&mut self.request, request.number) != request.number {
            self.cache.begin_request();
        }
        self.views.resize_with(request.views.len(), ViewWork::default);
        let before = std::mem::take(&mut self.views[index]);
        let is_first = before.request != request.number;
        let mut work = if is_first {
            ViewWork { request: request.number, cut: before.cut, ..ViewWork::default() }
        } else {
            before
        };
        let planet_wanted = || shared.is_newest_planet(request.number);
        let (mut begun, mut limits) = (begun, [Duration::ZERO, NEXT_SLICE]);
        if is_first {
            work.stats.compile_secs = begun.elapsed().as_secs_f64();
            limits = [GRACE, FIRST_SLICE];
        }
        // A draft is short work, and is shown even if a newer request is waiting. The first slice of a request has one
        // if the request before was superseded before its draft.
        let owed = std::mem::replace(&mut self.owes_draft, is_first && terrain.wants_draft());
        let draft = (owed || !is_first).then(|| terrain.with_draft_maps(&self.cell_fields, &mut work.stats.maps));
        if let Some(draft) = draft.flatten() {
            self.owes_draft = false;
            terrain = self.serve(draft);
            (begun, limits) = (Instant::now(), [GRACE, NEXT_SLICE]);
        } else if !is_first {
            terrain = self.solve_maps(terrain, &planet_wanted, &mut work.stats);
        }
        let keep_going = || {
            let (elapsed, [grace, limit]) = (begun.elapsed(), limits);
            elapsed < grace || (elapsed < limit && shared.is_newest(request.number))
        };
        let view = &request.views[index];
        // Once all tiles are built, only their detail is missing.
        let (mut surface, finder) = match work.complete.take() {
            Some(complete) => complete,
            None => {
                let tiles_before = work.stats.tiles_built;
                let (cut, stats) = (&mut work.cut, work.stats);
                let mut surface = (self.refine)(&terrain, view, &self.cache, cut, request.asked, stats, &keep_going);
                surface.complete &= terrain.has_final_maps();
                work.stats = surface.stats;
                // Show the tiles before spending time on their detail.
                if !surface.complete || is_first || surface.stats.tiles_built > tiles_before {
                    work.complete = surface.complete.then(|| (surface.clone(), None));
                    self.views[index] = work;
                    return Ok((surface, false));
                }
                (surface, None)
            }
        };
        let mut finder = finder.unwrap_or_else(|| HorizonFinder::new(&surface, view));
        let (known, keep) = (|id| self.cache.horizon(id), |tile: &Arc<_>| self.cache.keep_horizon(tile));
        // While the camera moves, each view gives some time to detail that serves the next view, too; an edit gives
        // none.
        let keep_going = || keep_going() || (begun.elapsed() < DETAIL_GRACE && planet_wanted());
        let has_horizons = finder.find(&mut surface, &known, &keep, &keep_going, &planet_wanted);
        let keep = |tile: &Tile, detail: &Arc<DetailTile>| self.cache.keep_detail(tile.id, detail);
        let done = find_detail(&mut surface, view, &keep, &keep_going, &planet_wanted) && has_horizons;
        work.stats = surface.stats;
        work.complete = (!done).then(|| (surface.clone(), Some(finder)));
        self.views[index] = work;
        Ok((surface, done))
    }

    /// Compiles a planet. World maps of the revision before serve until [`Worker::solve_maps`].
    fn compile(&mut self, planet: &Arc<Planet>) -> Result<Arc<Terrain>, InvalidPlanet> {
        if let Some(terrain) = self.terrain.as_ref().filter(|terrain| Arc::ptr_eq(terrain.planet(), planet)) {
            return Ok(terrain.clone());
        }
        profiling::scope!("compile");
        let first = || World { store: self.maps.clone(), ..World::default() };
        let world = self.terrain.as_ref().map_or_else(first, |before| before.world().clone());
        Ok(self.serve(Terrain::try_draft(planet.clone(), &world)?))
    }

    /// Solves the next level of the world maps. Returns the same terrain if `wanted` said no.
    fn solve_maps(&mut self, terrain: Arc<Terrain>, wanted: &KeepGoing<'_>, stats: &mut BuildStats) -> Arc<Terrain> {
        let next = terrain.with_next_map(&self.cell_fields, wanted, &mut stats.maps);
        stats.octave_samples += self.cell_fields.take_octave_samples();
        // With a small budget, tiles need the room more.
        if self.cell_fields.bytes() > self.cache.budget_bytes() / 8 {
            self.cell_fields.clear();
        }
        next.map_or(terrain, |next| self.serve(next))
    }

    /// Makes a terrain the current one. Tiles whose content keys stay the same stay valid.
    fn serve(&mut self, terrain: Terrain) -> Arc<Terrain> {
        let terrain = Arc::new(terrain);
        self.cache.serve(&terrain);
        self.cache.set_aside(self.cell_fields.bytes());
        self.terrain = Some(terrain.clone());
        terrain
    }
}

/// The message of a panic.
fn text_of(panic: &(dyn Any + Send)) -> String {
    let text = panic.downcast_ref::<String>().cloned();
    text.or_else(|| panic.downcast_ref::<&str>().map(|text| (*text).to_owned()))
        .unwrap_or_else(|| "an unknown error".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::{Quality, opening};
    use std::sync::atomic::AtomicBool;

    #[test]
    fn a_panic_gives_up_one_planet_and_is_told() {
        static BROKEN: AtomicBool = AtomicBool::new(true);
        let refine_or_panic: Refine = |terrain, view, cache, cut, asked, stats, keep_going| {
            assert!(!BROKEN.load(Ordering::Relaxed), "the ground gave way");
            refine(terrain, view, cache, cut, asked, stats, keep_going)
        };
        let builder =
            Builder::start(Worker { refine: refine_or_panic, ..Worker::new(BuilderOptions::default()) }, || {});
        let planet = Arc::new(Planet::default());
        let view = |side_px| opening::opening_view(&planet, [side_px, 64], Quality::Low);
        let settle = || {
            while builder.is_busy() {
                std::thread::sleep(Duration::from_millis(1));
            }
        };
        builder.request(&planet, &view(64));
        settle();
        assert_eq!(builder.error().as_deref(), Some("This planet could not be built: the ground gave way"));
        assert!(builder.surface().is_none());
        BROKEN.store(false, Ordering::Relaxed);
        builder.request(&planet, &view(65));
        settle();
        assert_eq!(builder.error(), None);
        assert!(builder.surface().is_some_and(|surface| surface.complete));
    }
}
