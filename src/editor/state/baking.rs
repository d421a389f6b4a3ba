//! Maps for other programs: what the user chose, the small picture of a map, and the bake on another thread.

use super::job::{GoOn, Job};
use crate::bake::{Bake, Detail, Format, Map, Outcome, Preview, Projection, Region};
use crate::planet::Planet;
use crate::terrain::{MapStore, Terrain};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Width of the small picture, pixels.
const PREVIEW_PX: u32 = 288;

/// How pixels lie on the globe.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// The globe in one picture.
    Globe,
    /// Six faces of a cube.
    Cube,
    /// A square about a place.
    Region,
}

impl Form {
    /// All of them, with the name that a person reads and what it is for.
    pub const ALL: [(Form, &'static str, &'static str); 3] = [
        (Form::Globe, "Globe", "Equirectangular: the whole globe in one picture, twice as wide as high"),
        (Form::Cube, "Cube", "Six faces of a cube texture"),
        (Form::Region, "Region", "A square about a place, as terrain engines take it"),
    ];
}

/// What is to be baked.
#[derive(Clone, Debug, PartialEq)]
pub struct BakeSettings {
    /// The maps, in the order of [`Map::ALL`].
    pub maps: Vec<Map>,
    /// The map in the small picture.
    pub previewed: Map,
    /// How pixels lie on the globe.
    pub form: Form,
    /// The square, for [`Form::Region`].
    pub region: Region,
    /// Width of a picture in pixels.
    pub size: u32,
    /// The kind of file.
    pub format: Format,
    /// How much of a structure is in the maps.
    pub detail: Detail,
}

impl Default for BakeSettings {
    fn default() -> Self {
        Self {
            maps: vec![Map::Height, Map::Normal, Map::Albedo],
            previewed: Map::Height,
            form: Form::Globe,
            region: Region { lat_deg: 0.0, lon_deg: 0.0, side_km: 100.0 },
            size: 4096,
            format: Format::Png16,
            detail: Detail::Pixel,
        }
    }
}

impl BakeSettings {
    /// The projection of the form.
    pub fn projection(&self) -> Projection {
        match self.form {
            Form::Globe => Projection::Equirect,
            Form::Cube => Projection::Cube,
            Form::Region => Projection::Region(self.region),
        }
    }

    /// Width and height of all pictures of one map, and how many there are.
    pub fn pictures(&self) -> ([u32; 2], u64) {
        match self.form {
            Form::Globe => ([self.size, self.size / 2], 1),
            Form::Cube => ([self.size; 2], 6),
            Form::Region => ([self.size; 2], 1),
        }
    }

    fn bake(&self, terrain: Arc<Terrain>, time_secs: f64) -> Bake {
        let mut bake = Bake::new(terrain, self.maps.clone(), self.projection(), self.size, self.format);
        (bake.detail, bake.time_secs) = (self.detail, time_secs);
        bake
    }

    /// Whether the small picture of these settings is that of others.
    fn shows_the_same(&self, other: &Self) -> bool {
        self.previewed == other.previewed && self.projection() == other.projection()
    }
}

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

    /// Asks for the picture of these settings, if it is not the newest. One is made at a time.
    pub fn ask(
        &mut self,
        settings: &BakeSettings,
        (planet, store): (&Arc<Planet>, Option<Arc<MapStore>>),
        time_secs: f64,
        wake: impl Fn() + Send + Sync + 'static,
    ) {
        let is_asked = self.asked.as_ref().is_some_and(|asked| {
            asked.settings.shows_the_same(settings)
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
    /// The folder of the maps.
    pub folder: PathBuf,
    job: Job<Result<Outcome, String>>,
}

impl Baking {
    /// Bakes on another thread. `wake` is called when there is progress.
    pub fn start(
        settings: BakeSettings,
        planet: Arc<Planet>,
        store: Option<Arc<MapStore>>,
        (folder, time_secs): (&Path, f64),
        wake: impl Fn() + Send + Sync + 'static,
    ) -> Self {
        let to = folder.to_owned();
        let work = move |go_on: GoOn<'_>| {
            let terrain = Terrain::load(planet, store, &|_| go_on(0.0)).map_err(|error| error.to_string())?;
            let Some(terrain) = terrain else { return Ok(Outcome::Stopped) };
            settings.bake(Arc::new(terrain), time_secs).run(&to, go_on).map_err(|error| error.to_string())
        };
        Self { folder: folder.to_owned(), job: Job::start(work, wake) }
    }

    /// Share that is done, 0 to 1.
    pub fn done(&self) -> f64 {
        self.job.done()
    }

    /// Stops. The same bake goes on from there.
    pub fn cancel(&self) {
        self.job.stop();
    }

    /// How it ended, once it has.
    pub fn ended(&self) -> Option<Result<Outcome, String>> {
        let failed = || Err("the maps could not be computed; try again".to_owned());
        self.job.ended().map(|result| result.unwrap_or_else(failed))
    }
}
