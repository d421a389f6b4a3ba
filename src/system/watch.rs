//! Hot reload: a system file, or a preset that it names, changes on disk while a program runs.

use super::System;
use crate::planet::picture::folder_of;
use crate::planet::watch::{FileWatch, PresetWatch};
use crate::planet::{LoadError, Planet};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// A system and the planet of each of its bodies, as [`System::load_planets`] gives them.
pub type Loaded = (System, Vec<Option<Arc<Planet>>>);

/// Watches a system file, the presets that it names, and the pictures and meshes that they refer to.
///
/// As [`PresetWatch`], it looks at dates and lengths when it is asked, and needs no thread.
#[derive(Debug)]
pub struct SystemWatch {
    path: PathBuf,
    files: FileWatch,
}

impl SystemWatch {
    /// Watches a system file from now on: what it holds now is no news.
    pub fn new(path: impl AsRef<Path>) -> Self {
        Self::every(path, PresetWatch::INTERVAL)
    }

    /// The same with another time between two looks at the disk.
    pub fn every(path: impl AsRef<Path>, interval: Duration) -> Self {
        let path = path.as_ref().to_owned();
        let files = match load(&path) {
            Ok((system, planets)) => files(&path, &system, &planets),
            Err(_) => vec![path.clone()],
        };
        Self { files: FileWatch::new(files, interval), path }
    }

    /// Watches a system that was loaded already, and is not read once more. `planets`: of its bodies, in their order.
    pub fn of_loaded(path: impl AsRef<Path>, system: &System, planets: &[Option<Arc<Planet>>]) -> Self {
        let path = path.as_ref().to_owned();
        Self { files: FileWatch::new(files(&path, system, planets), PresetWatch::INTERVAL), path }
    }

    /// The system and its planets, if a file has changed and then stayed as it is for the time between two looks.
    ///
    /// # Errors
    /// What is wrong with the changed files, once for each change.
    pub fn poll(&mut self) -> Option<Result<Loaded, LoadError>> {
        if !self.files.poll(&self.path) {
            return None;
        }
        let loaded = load(&self.path);
        if let Ok((system, planets)) = &loaded {
            self.files.follow(files(&self.path, system, planets));
        }
        Some(loaded)
    }

    /// Whether a change waits for the next look.
    pub fn is_changing(&self) -> bool {
        self.files.is_changing()
    }
}

fn load(path: &Path) -> Result<Loaded, LoadError> {
    let system = System::load(path)?;
    let planets = system.load_planets(path)?;
    Ok((system, planets))
}

fn files(path: &Path, system: &System, planets: &[Option<Arc<Planet>>]) -> Vec<PathBuf> {
    let presets = system.bodies.iter().filter(|body| !body.preset.is_empty());
    let presets = presets.map(|body| folder_of(path).join(&body.preset));
    let named = planets.iter().flatten().flat_map(|planet| planet.linked_paths());
    presets.chain(named).chain([path.to_owned()]).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_change_of_the_system_or_of_a_preset_is_told() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        let preset = |name: &str, radius_km: f64| {
            std::fs::write(at(name), format!("(version: 3, name: \"One\", radius_km: {radius_km:?})")).unwrap();
        };
        let system = |preset: &str| {
            let text = format!(
                "(version: 1, name: \"Small\", bodies: [(name: \"S\", mass_earths: 3e5, light: ()), \
                 (name: \"One\", preset: \"{preset}\", parent: \"S\", mass_earths: 0.01, orbit: ())])"
            );
            std::fs::write(at("small.ron"), text).unwrap();
        };
        preset("one.ron", 900.0);
        preset("other.ron", 40.0);
        system("one.ron");
        let mut watch = SystemWatch::every(at("small.ron"), Duration::ZERO);
        // The first look sees that the files differ, the second that they stay.
        let mut news = || {
            assert!(watch.poll().is_none());
            watch.poll()
        };
        assert!(news().is_none());
        preset("one.ron", 1000.0);
        let radius_km =
            |news: Option<Result<Loaded, LoadError>>| news.unwrap().unwrap().1[1].as_ref().unwrap().radius_km;
        assert_eq!(radius_km(news()), 1000.0);
        preset("other.ron", 4.0);
        assert!(news().is_none(), "nobody names it");
        system("other.ron");
        assert_eq!(radius_km(news()), 4.0);
        preset("one.ron", 90.0);
        assert!(news().is_none(), "nobody names it any more");
        preset("other.ron", 55.5);
        assert_eq!(radius_km(news()), 55.5);
        system("gone.ron");
        assert!(news().unwrap().unwrap_err().to_string().contains("gone.ron"));
        assert!(news().is_none(), "an error is told once");
    }
}
