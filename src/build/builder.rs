//! Surfaces in the background: one thread that takes the newest request, works on all cores in slices, and hands over complete
//! sets of tiles.
//!
//! A slice ends when its time is up, or, once a moment of grace has passed, as soon as a newer request is there; either way
//! it ends with a complete, perhaps coarser, surface. So a slider that is held shows every edit at once however heavy the
//! planet is, and no stale work is carried on.

use super::Surface;
use super::cache::Cache;
use super::refine::refine;
use crate::lod::View;
use crate::planet::Planet;
use crate::planet::diff::first_stale_stage;
use crate::planet::param::Stage;
use crate::terrain::Terrain;
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::time::{Duration, Instant};

/// How long a slice may take before what is there is shown.
const SLICE: Duration = Duration::from_millis(60);
/// How long a slice runs even if a newer request is waiting.
const GRACE: Duration = Duration::from_millis(25);

/// Builds surfaces in the background: the newest planet and view win, stale work is dropped.
pub struct Builder {
    shared: Arc<Shared>,
}

struct Shared {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Default)]
struct State {
    request: Option<Request>,
    /// Grows with each request.
    requested: u64,
    surface: Option<Arc<Surface>>,
    /// The request that `surface` answers, in full if `surface.complete`.
    answered: u64,
    closing: bool,
}

#[derive(Clone)]
struct Request {
    planet: Arc<Planet>,
    view: View,
}

impl Shared {
    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }
}

impl State {
    fn is_idle(&self) -> bool {
        self.requested == self.answered && self.surface.as_ref().is_none_or(|surface| surface.complete)
    }
}

impl Builder {
    /// Starts the worker. `wake` is called from another thread whenever a new surface is ready.
    pub fn new(wake: impl Fn() + Send + Sync + 'static) -> Self {
        let shared = Arc::new(Shared { state: Mutex::default(), changed: Condvar::new() });
        let worker = shared.clone();
        let spawned = std::thread::Builder::new().name("tellus-build".to_owned()).spawn(move || work(&worker, &wake));
        // Without a thread there is no builder; the caller sees no surface, and nothing else breaks.
        debug_assert!(spawned.is_ok());
        Self { shared }
    }

    /// Asks for a planet as seen from a view. Cheap when nothing changed since the last call; call it every frame.
    pub fn request(&self, planet: &Arc<Planet>, view: &View) {
        let mut state = self.shared.lock();
        let same = |request: &Request| {
            request.view == *view && (Arc::ptr_eq(&request.planet, planet) || request.planet == *planet)
        };
        if !state.request.as_ref().is_some_and(same) {
            state.request = Some(Request { planet: planet.clone(), view: *view });
            state.requested += 1;
            self.shared.changed.notify_all();
        }
    }

    /// The newest surface, complete or not.
    pub fn surface(&self) -> Option<Arc<Surface>> {
        self.shared.lock().surface.clone()
    }

    /// Whether work is under way.
    pub fn is_busy(&self) -> bool {
        !self.shared.lock().is_idle()
    }
}

impl Drop for Builder {
    fn drop(&mut self) {
        self.shared.lock().closing = true;
        self.shared.changed.notify_all();
    }
}

fn work(shared: &Shared, wake: &dyn Fn()) {
    let cache = Cache::default();
    let mut terrain: Option<Arc<Terrain>> = None;
    loop {
        let (request, number) = {
            let mut state = shared.lock();
            while state.is_idle() && !state.closing {
                state = shared.changed.wait(state).unwrap_or_else(PoisonError::into_inner);
            }
            if state.closing {
                return;
            }
            let Some(request) = state.request.clone() else { continue };
            (request, state.requested)
        };
        let terrain = compile(&mut terrain, &request.planet, &cache);
        cache.begin_request();
        let started = Instant::now();
        let keep_going = || {
            let elapsed = started.elapsed();
            let newer = || {
                let state = shared.lock();
                state.requested != number || state.closing
            };
            elapsed < GRACE || (elapsed < SLICE && !newer())
        };
        let surface = Arc::new(refine(&terrain, &request.view, &cache, &keep_going));
        let mut state = shared.lock();
        state.surface = Some(surface);
        state.answered = number;
        drop(state);
        wake();
    }
}

/// The evaluator of the planet; tiles stay valid when nothing that they hold has changed.
fn compile(current: &mut Option<Arc<Terrain>>, planet: &Arc<Planet>, cache: &Cache) -> Arc<Terrain> {
    let before = current.take();
    if let Some(terrain) = before.as_ref().filter(|terrain| Arc::ptr_eq(terrain.planet(), planet)) {
        *current = Some(terrain.clone());
        return terrain.clone();
    }
    let terrain = Arc::new(match &before {
        Some(before) => Terrain::after(planet.clone(), before),
        None => Terrain::new(planet.clone()),
    });
    if let Some(before) = before {
        let edited = first_stale_stage(before.planet(), planet).filter(|stage| stage.touches_tiles());
        // Heights depend on more than single parameters say: order, number, and which layer a mask's name means.
        let rejoined = (before.stack != terrain.stack).then_some(Stage::Height);
        if let Some(stage) = edited.into_iter().chain(rejoined).min() {
            cache.invalidate(stage);
        }
    }
    *current = Some(terrain.clone());
    terrain
}
