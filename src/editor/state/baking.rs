//! Maps, meshes and tiles for other programs: the small picture of a map, and the bake on another thread.

use super::bake_settings::{BakeSettings, Product};
use super::job::{GoOn, Job};
use crate::bake::{Outcome, Preview};
use crate::planet::Planet;
use crate::terrain::{MapStore, Terrain};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Width of the small picture, pixels.
const PREVIEW_PX: u32 = 288;
/// Share of the progress of a bake in which the world maps of a structure are solved.
const SOLVING: f64 = 0.2;

/// The small picture of a map, made on another thread.
#[derive(Default)]
pub struct BakePreview {
    /// The newest one, with a number that tells it from others.
    pub newest: Option<(u64, Preview)>,
    asked: Option<Asked>,
    under_way: Option<Job<Option<Preview>>>,
}

/// What a small picture was asked of.
struct Asked {
    settings: BakeSettings,
    planet: Arc<Planet>,
    time_secs: f64,
}

impl BakePreview {
    /// Whether a picture is being made.
    pub fn is_busy(&self) -> bool {
        self.under_way.is_some()
    }

    /// Asks for the picture of these settings, which are [as shown](BakeSettings::as_shown), if it is not the newest.
    /// One is made at a time.
    pub fn ask(
        &mut self,
        settings: &BakeSettings,
        (planet, store): (&Arc<Planet>, Option<Arc<MapStore>>),
        time_secs: f64,
        wake: impl Fn() + Send + Sync + 'static,
    ) {
        let is_asked = self.asked.as_ref().is_some_and(|asked| {
            asked.settings.previewed == settings.previewed
                && asked.settings.projection() == settings.projection()
                && Arc::ptr_eq(&asked.planet, planet)
                && (!settings.previewed.is_of_clouds() || asked.time_secs == time_secs)
        });
        if let Some(ended) = self.under_way.as_ref().and_then(Job::ended) {
            self.under_way = None;
            if let Some(preview) = ended.flatten() {
                let number = self.newest.as_ref().map_or(0, |(number, _)| number + 1);
                self.newest = Some((number, preview));
            }
        }
        if is_asked || settings.previewed.missing(planet).is_some() {
            return;
        }
        if let Some(stale) = &self.under_way {
            return stale.stop();
        }
        let (asked, planet) = (settings.clone(), Arc::clone(planet));
        self.asked = Some(Asked { settings: settings.clone(), planet: Arc::clone(&planet), time_secs });
        let work = move |go_on: GoOn<'_>| {
            // The document's planet is valid.
            let terrain = Terrain::load(planet, store, go_on).ok().flatten()?;
            asked.bake(Arc::new(terrain), time_secs).preview(asked.previewed, PREVIEW_PX, &|| go_on(0.0))
        };
        self.under_way = Some(Job::start(work, wake));
    }
}

/// A bake that is under way.
pub struct Baking {
    /// What is written.
    pub product: Product,
    /// The folder of maps or tiles, or the file of a mesh.
    pub to: PathBuf,
    job: Job<Result<Outcome, String>>,
}

impl Baking {
    /// Bakes on another thread. `wake` is called when there is progress.
    pub fn start(
        settings: BakeSettings,
        planet: Arc<Planet>,
        store: Option<Arc<MapStore>>,
        (to, time_secs): (&Path, f64),
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Self {
        let (product, path) = (settings.product, to.to_owned());
        let work = move |go_on: GoOn<'_>| {
            let solving = if planet.structure.is_some() { SOLVING } else { 0.0 };
            let solved = |done: f64| go_on(solving * done);
            let terrain = Terrain::load(planet, store, &solved).map_err(|error| error.to_string())?;
            let Some(terrain) = terrain else { return Ok(Outcome::Stopped) };
            let go_on: GoOn<'_> = &|done| go_on(solving + (1.0 - solving) * done);
            let outcome = match settings.product {
                Product::Maps => settings.bake(Arc::new(terrain), time_secs).run(&path, go_on),
                Product::Mesh => settings.mesh(terrain.planet()).run(&terrain, &path, go_on),
                Product::Tiles => settings.tileset().run(&terrain, &path, go_on),
            };
            outcome.map_err(|error| error.to_string())
        };
        Self { product, to: to.to_owned(), job: Job::start(work, wake) }
    }

    /// Share that is done, 0 to 1.
    pub fn done(&self) -> f64 {
        self.job.done()
    }

    /// Stops. The same bake of maps or tiles goes on from there.
    pub fn cancel(&self) {
        self.job.stop();
    }

    /// How it ended, once it has.
    pub fn ended(&self) -> Option<Result<Outcome, String>> {
        let failed = || Err("it could not be computed; try again".to_owned());
        self.job.ended().map(|result| result.unwrap_or_else(failed))
    }
}
