//! Maps for other programs: what the user chose, the small picture of a map, and the bake on another thread.

use crate::bake::{Bake, Detail, Format, Map, Outcome, Preview, Projection, Region};
use crate::planet::Planet;
use crate::terrain::{MapStore, Terrain};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::mpsc::{Receiver, TryRecvError, channel};

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

    /// What the small picture shows: another value needs another picture.
    fn shown(&self) -> (Map, Form, Region) {
        let region = if self.form == Form::Region { self.region } else { Self::default().region };
        (self.previewed, self.form, region)
    }
}

/// The small picture of a map, made on another thread.
#[derive(Default)]
pub struct BakePreview {
    /// The newest one, with a number that tells it from others.
    pub newest: Option<(u64, Preview)>,
    wanted: Option<Wanted>,
    under_way: Option<Receiver<Option<Preview>>>,
}

#[derive(Clone)]
struct Wanted {
    shown: (Map, Form, Region),
    terrain: Arc<Terrain>,
    time_secs: f64,
}

impl Wanted {
    fn is_same(&self, other: &Self) -> bool {
        let clouds = matches!(self.shown.0, Map::CloudCover | Map::MiddleCover | Map::VeilCover | Map::FogCover);
        self.shown == other.shown
            && Arc::ptr_eq(&self.terrain, &other.terrain)
            && (!clouds || self.time_secs == other.time_secs)
    }
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
        terrain: &Arc<Terrain>,
        time_secs: f64,
        wake: impl Fn() + Send + 'static,
    ) {
        if let Some(receiver) = &self.under_way {
            match receiver.try_recv() {
                Err(TryRecvError::Empty) => return,
                Ok(Some(preview)) => {
                    let number = self.newest.as_ref().map_or(0, |(number, _)| number + 1);
                    self.newest = Some((number, preview));
                }
                Ok(None) | Err(TryRecvError::Disconnected) => {}
            }
            self.under_way = None;
        }
        let wanted = Wanted { shown: settings.shown(), terrain: Arc::clone(terrain), time_secs };
        if self.wanted.as_ref().is_some_and(|asked| asked.is_same(&wanted)) {
            return;
        }
        let bake = settings.bake(Arc::clone(terrain), time_secs);
        let map = settings.previewed;
        self.wanted = Some(wanted);
        let (sender, receiver) = channel();
        self.under_way = Some(receiver);
        rayon::spawn(move || {
            let preview = map.missing(bake.terrain.planet()).is_none().then(|| bake.preview(map, PREVIEW_PX, &|| true));
            // The receiver is gone if the editor has closed.
            let _ = sender.send(preview.flatten());
            wake();
        });
    }
}

/// A bake that is under way.
pub struct Baking {
    /// The folder of the maps.
    pub folder: PathBuf,
    /// Ten-thousandths that are done.
    done: Arc<AtomicU32>,
    cancelled: Arc<AtomicBool>,
    result: Receiver<Result<Outcome, String>>,
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
        let (done, cancelled) = (Arc::new(AtomicU32::new(0)), Arc::new(AtomicBool::new(false)));
        let (sender, result) = channel();
        let (told, stop, to) = (Arc::clone(&done), Arc::clone(&cancelled), folder.to_owned());
        std::thread::spawn(move || {
            let goes_on = || !stop.load(Ordering::Relaxed);
            let baked = Terrain::load(planet, store, &|_| goes_on()).map_err(|error| error.to_string());
            let baked = baked.and_then(|terrain| match terrain {
                Some(terrain) => {
                    let bake = settings.bake(Arc::new(terrain), time_secs);
                    let baked = bake.run(&to, &|share| {
                        let share = (share * 1e4) as u32;
                        if told.swap(share, Ordering::Relaxed) / 50 != share / 50 {
                            wake();
                        }
                        goes_on()
                    });
                    baked.map_err(|error| error.to_string())
                }
                None => Ok(Outcome::Stopped),
            });
            // The receiver is gone if the editor has closed.
            let _ = sender.send(baked);
            wake();
        });
        Self { folder: folder.to_owned(), done, cancelled, result }
    }

    /// Share that is done, 0 to 1.
    pub fn done(&self) -> f64 {
        f64::from(self.done.load(Ordering::Relaxed)) * 1e-4
    }

    /// Stops. The same bake goes on from there.
    pub fn cancel(&self) {
        self.cancelled.store(true, Ordering::Relaxed);
    }

    /// How it ended, once it has.
    pub fn ended(&self) -> Option<Result<Outcome, String>> {
        match self.result.try_recv() {
            Ok(result) => Some(result),
            Err(TryRecvError::Empty) => None,
            Err(TryRecvError::Disconnected) => Some(Err("the maps could not be computed; try again".to_owned())),
        }
    }
}

impl Drop for Baking {
    fn drop(&mut self) {
        self.cancel();
    }
}
