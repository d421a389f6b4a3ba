//! Hot reload: a preset that changes on disk while a game runs.

use super::{LoadError, Planet, beside};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant, SystemTime};

/// Watches the file of a preset, and the pictures, texture sets, meshes and the edits file that it refers to.
///
/// It looks at dates and lengths when it is asked, needs no thread, and works on network drives. A game asks in every
/// frame and gives the planet to its [`Builder`](crate::tiles::Builder), which rebuilds what the change touches.
///
/// ```
/// use tellus::planet::{Planet, watch::PresetWatch};
///
/// let mut watch = PresetWatch::new("planets/pallor.ron");
/// match watch.poll() {
///     None => {}                                     // no news
///     Some(Ok(planet)) => println!("{}", planet.name), // give it to the builder
///     Some(Err(error)) => eprintln!("{error}"),      // the planet before stays
/// }
/// ```
#[derive(Debug)]
pub struct PresetWatch {
    path: PathBuf,
    files: FileWatch,
}

impl PresetWatch {
    /// Time between two looks at the disk.
    pub const INTERVAL: Duration = Duration::from_millis(200);

    /// Watches a preset from now on: what it holds now is no news.
    pub fn new(path: impl AsRef<Path>) -> Self {
        Self::every(path, Self::INTERVAL)
    }

    /// The same with another time between two looks at the disk.
    pub fn every(path: impl AsRef<Path>, interval: Duration) -> Self {
        let path = path.as_ref().to_owned();
        // The files of a preset that cannot be read yet are known once it can.
        // Which files belong to a mesh or a texture set shows when it is read.
        let named = Planet::open(&path).map(|mut planet| {
            if planet.meshes().next().is_some() || planet.texture_sets().next().is_some() {
                planet.load_pictures();
            }
            planet.linked_paths()
        });
        let files = FileWatch::new(files_of(&path, named.unwrap_or_default()), interval);
        Self { path, files }
    }

    /// The planet, if its files have changed and then stayed as they are for the time between two looks: a program may
    /// be writing. A preset that is gone is no news until it is back.
    ///
    /// # Errors
    /// What is wrong with the changed preset, once for each change.
    pub fn poll(&mut self) -> Option<Result<Planet, LoadError>> {
        if !self.files.poll(&self.path) {
            return None;
        }
        let planet = Planet::load(&self.path);
        match &planet {
            Ok(planet) => log::info!("{}: loaded again: {}", self.path.display(), planet.name),
            Err(error) => log::warn!("{error}"),
        }
        // The preset may refer to other files now.
        if let Ok(planet) = &planet {
            self.files.follow(files_of(&self.path, planet.linked_paths()));
        }
        Some(planet)
    }
}

/// Watches several files by their dates and lengths.
#[derive(Debug)]
pub(crate) struct FileWatch {
    interval: Duration,
    looked: Option<Instant>,
    /// The files as they were loaded last.
    loaded: Files,
    /// The files at the last look, if they differ.
    changing: Option<Files>,
}

/// Date and length of each file; None for a file that is not there.
type Files = BTreeMap<PathBuf, Option<(SystemTime, u64)>>;

impl FileWatch {
    /// Watches files from now on.
    pub(crate) fn new(files: impl IntoIterator<Item = PathBuf>, interval: Duration) -> Self {
        Self { interval, looked: None, loaded: look(files), changing: None }
    }

    /// Whether the files have changed since they were loaded, and then stayed as they are for the time between two
    /// looks. `main`: a file without which there is no news.
    pub(crate) fn poll(&mut self, main: &Path) -> bool {
        if self.looked.is_some_and(|looked| looked.elapsed() < self.interval) {
            return false;
        }
        self.looked = Some(Instant::now());
        let now = look(self.loaded.keys().cloned());
        if now == self.loaded || now.get(main) == Some(&None) {
            self.changing = None;
            return false;
        }
        if self.changing.as_ref() != Some(&now) {
            self.changing = Some(now);
            return false;
        }
        (self.loaded, self.changing) = (now, None);
        true
    }

    /// Whether the files have changed, but may still be written.
    pub(crate) fn is_changing(&self) -> bool {
        self.changing.is_some()
    }

    /// Watches these files instead of others. One that was watched before and has changed meanwhile is found at the
    /// next look.
    pub(crate) fn follow(&mut self, files: impl IntoIterator<Item = PathBuf>) {
        let before = std::mem::take(&mut self.loaded);
        self.loaded = look(files);
        for (file, stamp) in before {
            self.loaded.entry(file).and_modify(|now| *now = stamp);
        }
    }
}

/// A preset, the files that it names, and that of its edits if it has one.
fn files_of(preset: &Path, named: Vec<PathBuf>) -> impl Iterator<Item = PathBuf> {
    named.into_iter().chain([preset.to_owned()]).chain(beside::of_preset(preset))
}

fn look(files: impl IntoIterator<Item = PathBuf>) -> Files {
    let stamp = |path: &Path| {
        let metadata = std::fs::metadata(path).ok()?;
        Some((metadata.modified().unwrap_or(SystemTime::UNIX_EPOCH), metadata.len()))
    };
    files.into_iter().map(|path| (path.clone(), stamp(&path))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn preset(radius_km: f64) -> String {
        format!("(version: 3, name: \"Islet\", radius_km: {radius_km:?})")
    }

    #[test]
    fn changes_are_told_once_they_hold_still() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("islet.ron");
        std::fs::write(&path, preset(40.0)).unwrap();
        let mut watch = PresetWatch::every(&path, Duration::ZERO);
        assert!(watch.poll().is_none());
        std::fs::write(&path, preset(4.0)).unwrap();
        // It may still be written.
        assert!(watch.poll().is_none());
        assert_eq!(watch.poll().unwrap().unwrap().radius_km, 4.0);
        assert!(watch.poll().is_none() && watch.poll().is_none());
        // A file that grows between looks.
        for end in 0..3 {
            std::fs::write(&path, &preset(500.0)[..20 + end]).unwrap();
            assert!(watch.poll().is_none());
        }
        std::fs::write(&path, preset(500.0)).unwrap();
        assert!(watch.poll().is_none());
        assert_eq!(watch.poll().unwrap().unwrap().radius_km, 500.0);
        // A broken one is told once, and a gone one is no news.
        std::fs::write(&path, "(version: 3, radius_km: -1.0)").unwrap();
        assert!(watch.poll().is_none());
        assert!(watch.poll().unwrap().unwrap_err().to_string().contains("radius_km"));
        assert!(watch.poll().is_none());
        std::fs::remove_file(&path).unwrap();
        assert!(watch.poll().is_none() && watch.poll().is_none());
        std::fs::write(&path, preset(7.0)).unwrap();
        assert!(watch.poll().is_none());
        assert_eq!(watch.poll().unwrap().unwrap().radius_km, 7.0);
    }

    #[test]
    fn pictures_belong_to_the_preset() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let save = |name: &str, side: u32| {
            let file = std::fs::File::create(at(name)).unwrap();
            let mut encoder = png::Encoder::new(file, 2 * side, side);
            encoder.set_color(png::ColorType::Grayscale);
            let bytes = vec![90; (2 * side * side) as usize];
            encoder.write_header().unwrap().write_image_data(&bytes).unwrap();
        };
        save("one.png", 4);
        save("two.png", 4);
        let preset = |picture: &str| {
            let layer = format!("(name: \"Map\", shape: HeightMap(file: \"{picture}\"))");
            std::fs::write(at("map.ron"), format!("(version: 3, layers: [{layer}])")).unwrap();
        };
        preset("one.png");
        let mut watch = PresetWatch::every(at("map.ron"), Duration::ZERO);
        let mut is_news = || watch.poll().is_none() && watch.poll().is_some_and(|planet| planet.is_ok());
        assert!(!is_news());
        save("one.png", 8);
        assert!(is_news());
        preset("../two.png");
        preset("two.png");
        assert!(is_news());
        save("one.png", 16);
        assert!(!is_news());
        save("two.png", 16);
        assert!(is_news());
    }
}
