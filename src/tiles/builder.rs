//! Surfaces in the background: one thread that takes the newest request, works on all cores in slices, and hands over complete
//! sets of tiles.
//!
//! A slice ends when its time is up or as soon as a newer request is there; either way it ends with a complete, perhaps
//! coarser, surface. Only the first slice of a request has a moment of grace, so that a slider that is held shows every edit
//! however heavy the planet is. No stale work is carried on, and no surface is ever made of two planets.

use super::cache::{Cache, DEFAULT_BUDGET_BYTES};
use super::horizon::HorizonFinder;
use super::refine::refine;
use super::{BuildStats, Memory, Surface, find_detail};
use crate::lod::View;
use crate::lod::tile::{DetailTile, Tile};
use crate::planet::{InvalidPlanet, Planet};
use crate::terrain::Terrain;
use crate::terrain::coarse::CellFields;
use crate::world::KeepGoing;
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long the first slice of a request may take before what is there is shown: a frame or two.
const FIRST_SLICE: Duration = Duration::from_millis(30);
/// How long it runs even if a newer request is waiting.
const GRACE: Duration = Duration::from_millis(25);
/// How long detail is sought even if another view is waiting.
const DETAIL_GRACE: Duration = Duration::from_millis(15);
/// How long each further slice may take: something is on screen by then, and fewer steps disturb less.
const NEXT_SLICE: Duration = Duration::from_millis(80);

/// Builds surfaces in the background: the newest planet and view win, stale work is dropped.
pub struct Builder {
    shared: Arc<Shared>,
}

#[derive(Default)]
struct Shared {
    state: Mutex<State>,
    changed: Condvar,
    /// Grows with each request; work asks it whether it is still wanted.
    newest: AtomicU64,
    /// The newest request with another planet than the one before.
    newest_planet: AtomicU64,
}

#[derive(Default)]
struct State {
    request: Option<Request>,
    surface: Option<Arc<Surface>>,
    /// The newest request all of whose tiles are there.
    tiled: u64,
    /// The newest request that is done with.
    finished: u64,
    memory: Memory,
    error: Option<String>,
    closing: bool,
}

#[derive(Clone)]
struct Request {
    planet: Arc<Planet>,
    view: View,
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

    /// Whether what is found of a request's planet will still serve, if perhaps another view.
    fn is_newest_planet(&self, number: u64) -> bool {
        self.newest_planet.load(Ordering::Relaxed) <= number
    }
}

impl State {
    /// The request that is to be worked on.
    fn pending(&self) -> Option<&Request> {
        self.request.as_ref().filter(|request| request.number != self.finished)
    }
}

impl Builder {
    /// Starts the worker. `wake` is called from another thread whenever a new surface is ready.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self::with_budget(DEFAULT_BUDGET_BYTES, wake)
    }

    /// The same with another limit to what is kept for later. With zero every edit is a rebuild from nothing.
    pub fn with_budget(budget_bytes: usize, wake: impl Fn() + Send + Sync + 'static) -> Self {
        Self::start(Worker::new(budget_bytes), wake)
    }

    fn start(mut worker: Worker, wake: impl Fn() + Send + Sync + 'static) -> Self {
        let shared = Arc::new(Shared::default());
        let theirs = shared.clone();
        let spawned = std::thread::Builder::new().name("tellus-build".to_owned()).spawn(move || {
            profiling::register_thread!("tellus-build");
            worker.work(&theirs, &wake);
        });
        if let Err(error) = spawned {
            shared.lock().error = Some(format!("Nothing can be built: no thread could be started: {error}"));
        }
        Self { shared }
    }

    /// Asks for a planet as seen from a view. Cheap when nothing changed since the last call; call it every frame.
    pub fn request(&self, planet: &Arc<Planet>, view: &View) {
        let mut state = self.shared.lock();
        let before = state.request.as_ref();
        let same_planet =
            before.is_some_and(|request| Arc::ptr_eq(&request.planet, planet) || request.planet == *planet);
        if !same_planet || before.is_some_and(|request| request.view != *view) {
            let number = self.shared.newest.fetch_add(1, Ordering::Relaxed) + 1;
            if !same_planet {
                self.shared.newest_planet.store(number, Ordering::Relaxed);
            }
            state.request = Some(Request { planet: planet.clone(), view: *view, asked: Instant::now(), number });
            self.shared.changed.notify_all();
        }
    }

    /// The newest surface, complete or not.
    pub fn surface(&self) -> Option<Arc<Surface>> {
        self.shared.lock().surface.clone()
    }

    /// Whether work is under way.
    pub fn is_busy(&self) -> bool {
        self.shared.lock().pending().is_some()
    }

    /// Whether all tiles of the newest request are there; their detail may follow.
    pub fn has_all_tiles(&self) -> bool {
        let state = self.shared.lock();
        state.pending().is_none_or(|request| request.number == state.tiled)
    }

    /// What is kept for later.
    pub fn memory(&self) -> Memory {
        self.shared.lock().memory
    }

    /// Why the newest request was given up. Another request is another try.
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

/// How a slice is worked off; tests put another in its place.
type Refine = fn(&Arc<Terrain>, &View, &Cache, Instant, BuildStats, &(dyn Fn() -> bool + Sync)) -> Surface;

/// What the thread has.
struct Worker {
    cache: Cache,
    terrain: Option<Arc<Terrain>>,
    /// Layer fields behind the world maps.
    cell_fields: CellFields,
    /// All tiles of a request whose horizons and detail are being found.
    complete: Option<(u64, Surface, Option<HorizonFinder>)>,
    refine: Refine,
}

impl Worker {
    fn new(budget_bytes: usize) -> Self {
        let cache = Cache::new(budget_bytes);
        Self { cache, terrain: None, cell_fields: CellFields::default(), complete: None, refine }
    }

    fn work(&mut self, shared: &Shared, wake: &dyn Fn()) {
        // The request under way, and what it has taken so far.
        let mut under_way = (0, BuildStats::default());
        loop {
            let request = {
                let mut state = shared.lock();
                loop {
                    if state.closing {
                        return;
                    }
                    if let Some(request) = state.pending() {
                        break request.clone();
                    }
                    state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
                }
            };
            let is_first = under_way.0 != request.number;
            if is_first {
                under_way = (request.number, BuildStats::default());
            }
            let slice = catch_unwind(AssertUnwindSafe(|| self.slice(shared, &request, is_first, under_way.1)));
            let mut state = shared.lock();
            let gone_wrong = match slice {
                Ok(Ok((surface, done))) => {
                    under_way.1 = surface.stats;
                    if surface.complete {
                        state.tiled = request.number;
                    }
                    if done {
                        state.finished = request.number;
                    }
                    state.surface = Some(Arc::new(surface));
                    None
                }
                Ok(Err(invalid)) => Some(invalid.to_string()),
                Err(panic) => {
                    // What it was in the middle of is not to be trusted.
                    self.cache.clear();
                    self.cell_fields.clear();
                    self.terrain = None;
                    self.complete = None;
                    Some(text_of(panic.as_ref()))
                }
            };
            if gone_wrong.is_some() {
                state.finished = request.number;
            }
            state.error = gone_wrong.map(|why| format!("This planet could not be built: {why}"));
            state.memory = self.cache.memory();
            drop(state);
            wake();
        }
    }

    /// A surface, and whether it has all that the request asks for. First come all tiles, then their detail.
    fn slice(
        &mut self,
        shared: &Shared,
        request: &Request,
        is_first: bool,
        mut stats: BuildStats,
    ) -> Result<(Surface, bool), InvalidPlanet> {
        let begun = Instant::now();
        let mut terrain = self.compile(&request.planet)?;
        let planet_wanted = || shared.is_newest_planet(request.number);
        if is_first {
            self.cache.begin_request();
            stats.compile_secs = begun.elapsed().as_secs_f64();
        } else {
            terrain = self.solve_maps(terrain, &planet_wanted, &mut stats);
        }
        let keep_going = || {
            let elapsed = begun.elapsed();
            let wanted = shared.is_newest(request.number);
            if is_first { elapsed < GRACE || (elapsed < FIRST_SLICE && wanted) } else { elapsed < NEXT_SLICE && wanted }
        };
        // Once all tiles are there, only their detail is left to find.
        let (mut surface, finder) = match self.complete.take().filter(|(number, ..)| *number == request.number) {
            Some((_, surface, finder)) => (surface, finder),
            None => {
                let mut surface =
                    (self.refine)(&terrain, &request.view, &self.cache, request.asked, stats, &keep_going);
                surface.complete &= terrain.has_final_maps();
                if !surface.complete {
                    return Ok((surface, false));
                }
                // They are shown before time is spent on their detail.
                if is_first || surface.stats.tiles_built > stats.tiles_built {
                    self.complete = Some((request.number, surface.clone(), None));
                    return Ok((surface, false));
                }
                (surface, None)
            }
        };
        let mut finder = finder.unwrap_or_else(|| HorizonFinder::new(&surface, &request.view));
        let (known, keep) = (|id| self.cache.horizon(id), |tile: &Arc<_>| self.cache.keep_horizon(tile));
        // While the eye moves, a moment of each view goes into what serves the next one, too; after an edit none of it does.
        let keep_going = || keep_going() || (begun.elapsed() < DETAIL_GRACE && planet_wanted());
        let has_horizons = finder.find(&mut surface, &known, &keep, &keep_going, &planet_wanted);
        let keep = |tile: &Tile, detail: &Arc<DetailTile>| self.cache.keep_detail(tile.id, detail);
        let done = find_detail(&mut surface, &request.view, &keep, &keep_going, &planet_wanted) && has_horizons;
        self.complete = (!done).then(|| (request.number, surface.clone(), Some(finder)));
        Ok((surface, done))
    }

    /// The evaluator of a planet. The world maps of the revision before serve until [`Worker::solve_maps`].
    fn compile(&mut self, planet: &Arc<Planet>) -> Result<Arc<Terrain>, InvalidPlanet> {
        if let Some(terrain) = self.terrain.as_ref().filter(|terrain| Arc::ptr_eq(terrain.planet(), planet)) {
            return Ok(terrain.clone());
        }
        profiling::scope!("compile");
        let world = self.terrain.as_ref().map(|before| before.world().clone()).unwrap_or_default();
        Ok(self.serve(Terrain::try_draft(planet.clone(), &world)?))
    }

    /// Solves the next level of the world maps; the terrain as it was if `wanted` said no.
    fn solve_maps(&mut self, terrain: Arc<Terrain>, wanted: &KeepGoing<'_>, stats: &mut BuildStats) -> Arc<Terrain> {
        let next = terrain.with_next_map(&self.cell_fields, wanted, &mut stats.maps);
        stats.octave_samples += self.cell_fields.take_octave_samples();
        // In a small budget, the room is for tiles.
        if self.cell_fields.bytes() > self.cache.budget_bytes() / 8 {
            self.cell_fields.clear();
        }
        next.map_or(terrain, |next| self.serve(next))
    }

    /// From now on, tiles are those of this terrain; tiles whose content is the same stay valid.
    fn serve(&mut self, terrain: Terrain) -> Arc<Terrain> {
        let terrain = Arc::new(terrain);
        self.cache.set_keys(terrain.tile_keys());
        self.cache.set_aside(self.cell_fields.bytes());
        self.terrain = Some(terrain.clone());
        terrain
    }
}

/// What a panic said.
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
        let refine_or_panic: Refine = |terrain, view, cache, asked, stats, keep_going| {
            assert!(!BROKEN.load(Ordering::Relaxed), "the ground gave way");
            refine(terrain, view, cache, asked, stats, keep_going)
        };
        let builder = Builder::start(Worker { refine: refine_or_panic, ..Worker::new(DEFAULT_BUDGET_BYTES) }, || {});
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
