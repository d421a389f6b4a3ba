//! The worker of a [`Builder`](super::Builder): takes the newest request and works on it slice by slice.

use super::BuilderOptions;
use super::builder::{Request, Shared};
use super::cache::Cache;
use super::horizon::HorizonFinder;
use super::refine::{Cut, Goal, refine};
use super::{BuildStats, Surface, find_detail};
use crate::life::scenery::SceneryCache;
use crate::lod::tile::{DetailTile, Tile};
use crate::terrain::coarse::CellFields;
use crate::terrain::{Revision, Terrain};
use crate::world::{KeepGoing, MapStore, World};
use std::any::Any;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::AtomicUsize;
use std::sync::{Arc, PoisonError};
use std::time::{Duration, Instant};

/// Time limit of the first slice of a request: about two frames at 60 Hz.
const FIRST_SLICE: Duration = Duration::from_millis(30);
/// Time for which the first slice runs even if a newer request is waiting.
const GRACE: Duration = Duration::from_millis(25);
/// Time for which detail is computed even if another view is waiting.
const DETAIL_GRACE: Duration = Duration::from_millis(15);
/// Time limit of each further slice. Something is on screen by then, and fewer swaps disturb less.
const NEXT_SLICE: Duration = Duration::from_millis(80);

/// The function that builds tiles; tests replace it.
pub(super) type Refine =
    fn(&Arc<Terrain>, &Goal, &Cache, &mut Option<Cut>, BuildStats, &(dyn Fn() -> bool + Sync)) -> Surface;

/// State of the worker thread.
pub(super) struct Worker {
    cache: Cache,
    pub(super) budget_bytes: Arc<AtomicUsize>,
    /// The threads that work; None for all cores.
    pool: Option<Arc<rayon::ThreadPool>>,
    /// Where world maps are kept from one process to the next.
    maps: Option<Arc<MapStore>>,
    terrain: Option<Arc<Terrain>>,
    /// Layer fields at the cells of world maps, kept for the next revision.
    cell_fields: CellFields,
    /// Objects on the ground of earlier views.
    scenery: SceneryCache,
    /// Whether the newest request had a first slice and still lacks a draft.
    owes_draft: bool,
    /// Number of the request that the newest slice worked for.
    request: u64,
    views: Vec<ViewWork>,
    pub(super) refine: Refine,
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
    pub(super) fn new(options: BuilderOptions) -> Self {
        let budget_bytes = Arc::new(AtomicUsize::new(options.budget_bytes));
        Self {
            cache: Cache::with_budget(budget_bytes.clone()),
            budget_bytes,
            pool: options.pool,
            maps: options.maps,
            terrain: None,
            cell_fields: CellFields::default(),
            scenery: SceneryCache::default(),
            owes_draft: false,
            request: 0,
            views: Vec::new(),
            refine,
        }
    }

    /// Works until the builder is dropped.
    pub(super) fn work(&mut self, shared: &Shared, wake: &(dyn Fn() + Sync)) {
        loop {
            let (request, index) = {
                let mut state = shared.lock();
                loop {
                    if state.closing {
                        return;
                    }
                    if let Some((request, index)) = state.next() {
                        break (request.clone(), index);
                    }
                    state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
                }
            };
            let pool = self.pool.clone();
            let slice = catch_unwind(AssertUnwindSafe(|| match &pool {
                Some(pool) => pool.install(|| self.slice(shared, &request, index)),
                None => self.slice(shared, &request, index),
            }));
            let mut state = shared.lock();
            let gone_wrong = match slice {
                Ok((surface, done)) => {
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
                Err(panic) => {
                    // The state may be inconsistent.
                    self.cache.clear();
                    self.cell_fields.clear();
                    self.scenery = SceneryCache::default();
                    self.terrain = None;
                    self.views.clear();
                    Some(text_of(panic.as_ref()))
                }
            };
            if gone_wrong.is_some() {
                state.views.iter_mut().for_each(|view| view.finished = request.number);
            }
            if let Some(why) = &gone_wrong {
                log::error!("{} could not be built: {why}", request.revision.planet().name);
            }
            state.error = gone_wrong.map(|why| format!("This planet could not be built: {why}"));
            state.memory = self.cache.memory();
            state.maps = self.terrain.as_ref().map_or(0.0, |terrain| terrain.map_progress());
            drop(state);
            wake();
        }
    }

    /// Builds a surface of one view. Returns whether it has everything that the request asks for: first all tiles, then
    /// their detail.
    fn slice(&mut self, shared: &Shared, request: &Request, index: usize) -> (Surface, bool) {
        let begun = Instant::now();
        let is_compiled = self.terrain.as_ref().is_some_and(|terrain| terrain.revision().is_same(&request.revision));
        let mut terrain = self.compile(&request.revision);
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
        let planet_wanted = || shared.is_newest_planet(request.number) && !shared.is_paused();
        let (mut begun, mut limits) = (begun, [Duration::ZERO, NEXT_SLICE]);
        if is_first {
            let before_secs = if is_compiled { 0.0 } else { request.revision.compile_secs() };
            work.stats.compile_secs = before_secs + begun.elapsed().as_secs_f64();
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
            elapsed < grace || (elapsed < limit && shared.is_newest(request.number) && !shared.is_paused())
        };
        let view = &request.views[index];
        // Once all tiles are built, only their detail is missing.
        let (mut surface, finder) = match work.complete.take() {
            Some(complete) => complete,
            None => {
                let tiles_before = work.stats.tiles_built;
                let (cut, stats, goal) = (&mut work.cut, work.stats, Goal::new(view, request.asked));
                let mut surface = (self.refine)(&terrain, &goal, &self.cache, cut, stats, &keep_going);
                surface.complete &= terrain.has_final_maps();
                work.stats = surface.stats;
                // Show the tiles before spending time on their detail.
                if !surface.complete || is_first || surface.stats.tiles_built > tiles_before {
                    // Objects on ground that did not change. After an edit that changes no tile, the new ones: a hand
                    // that paints them sees them while it moves.
                    let paints = !is_compiled && surface.complete && surface.stats.tiles_built == 0;
                    surface.scenery = self.scenery.find(&terrain, view, &|| paints && keep_going()).0;
                    work.complete = surface.complete.then(|| (surface.clone(), None));
                    self.views[index] = work;
                    return (surface, false);
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
        let has_detail = find_detail(&mut surface, view, &keep, &keep_going, &planet_wanted) && has_horizons;
        let (scenery, has_scenery) = self.scenery.find(&surface.terrain, view, &|| has_detail && keep_going());
        surface.scenery = scenery;
        let done = has_detail && has_scenery;
        work.stats = surface.stats;
        work.complete = (!done).then(|| (surface.clone(), Some(finder)));
        self.views[index] = work;
        (surface, done)
    }

    /// The terrain of a revision. World maps of the revision before serve until [`Worker::solve_maps`].
    fn compile(&mut self, revision: &Revision) -> Arc<Terrain> {
        profiling::scope!("compile");
        let terrain = match &self.terrain {
            Some(terrain) if terrain.revision().is_same(revision) => return terrain.clone(),
            Some(before) => Terrain::draft_after(revision, before),
            None => Terrain::draft(revision, &World { store: self.maps.clone(), ..World::default() }, Arc::default()),
        };
        self.serve(terrain)
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
