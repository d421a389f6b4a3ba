//! The files of the open system: saving, and what other programs change.

use super::{OpenSystem, Origin, planets_of, presets};
use crate::editor::files::disk;
use crate::planet::Planet;
use crate::planet::file::read_text;
use crate::planet::picture::folder_of;
use crate::system::System;
use crate::system::watch::SystemWatch;
use eframe::egui;
use notify::RecommendedWatcher;
use std::collections::BTreeSet;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::Duration;

/// Time after which a file that changed is read: long enough for a second look, which finds it as it was.
const QUIET: Duration = Duration::from_millis(250);
/// The watch over the file and the presets.
pub(super) struct Watch {
    files: SystemWatch,
    /// They wake the window.
    _watchers: Vec<RecommendedWatcher>,
}

/// What happened to the files of a system.
pub enum News {
    /// The system was read again.
    Reloaded,
    /// Presets of bodies were read again.
    Presets,
    /// The file holds another system, and this one has unsaved changes.
    Theirs,
    /// It cannot be read.
    Broken(String),
}

impl OpenSystem {
    /// Whether a file holds a text that this system has not read or written.
    pub fn would_replace(&self, path: &Path) -> bool {
        let is_own = matches!(&self.origin, Origin::File(own) if own == path);
        match read_text(path) {
            Ok(text) => !is_own || self.text.as_ref() != Some(&text),
            Err(_) => path.exists(),
        }
    }

    /// Saves the system, and the shipped presets that it names beside it.
    ///
    /// # Errors
    /// Why it was not saved.
    pub fn save(&mut self, path: &Path) -> Result<(), String> {
        if let Some((place, problem)) = self.problems.first() {
            return Err(format!("{place}: {problem}"));
        }
        let system = presets::moved(self, &folder_of(path))?;
        system.save(path).map_err(|error| error.to_string())?;
        for (old, new) in self.system.bodies.iter().zip(&system.bodies) {
            if let Some(planet) = self.planets.get(&old.preset).cloned() {
                self.planets.insert(new.preset.clone(), planet);
            }
        }
        let text = system.to_text();
        self.settle();
        self.system = Arc::new(system);
        self.saved = Some(Arc::clone(&self.system));
        (self.text, self.origin) = (Some(text), Origin::File(path.to_owned()));
        self.watch = None;
        self.show();
        Ok(())
    }

    /// Reads files again that other programs have changed.
    pub fn poll(&mut self, ctx: &egui::Context) -> Option<News> {
        let Origin::File(path) = &self.origin else { return None };
        let watch = self
            .watch
            .get_or_insert_with(|| Watch::new(path, &self.system, &planets_of(&self.system, &self.planets), ctx));
        let news = watch.files.poll();
        if watch.files.is_changing() {
            ctx.request_repaint_after(QUIET);
        }
        let (theirs, planets) = match news? {
            Ok(loaded) => loaded,
            Err(error) => return Some(News::Broken(error.to_string())),
        };
        for (body, planet) in theirs.bodies.iter().zip(planets) {
            self.planets.extend(planet.map(|planet| (body.preset.clone(), planet)));
        }
        let is_known = self.saved.as_ref().is_some_and(|saved| **saved == theirs);
        let news = match (is_known, self.is_dirty()) {
            (true, _) => News::Presets,
            (false, true) => News::Theirs,
            (false, false) => {
                self.text = read_text(path).ok();
                self.edit(theirs, "Reload from disk");
                self.settle();
                self.saved = Some(Arc::clone(&self.system));
                self.watch = None;
                News::Reloaded
            }
        };
        self.show();
        Some(news)
    }
}

impl Watch {
    fn new(path: &Path, system: &System, planets: &[Option<Arc<Planet>>], ctx: &egui::Context) -> Self {
        let presets = system.bodies.iter().filter(|body| !body.preset.is_empty());
        let folders: BTreeSet<PathBuf> =
            presets.map(|body| folder_of(&folder_of(path).join(&body.preset))).chain([folder_of(path)]).collect();
        let watcher = |folder: &PathBuf| {
            let ctx = ctx.clone();
            disk::watch(folder, |_| true, move || ctx.request_repaint_after(QUIET))
        };
        Self {
            files: SystemWatch::of_loaded(path, system, planets),
            _watchers: folders.iter().filter_map(watcher).collect(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_saved_system_names_its_presets_from_its_folder_and_is_read_again_when_it_changes() {
        let folder = tempfile::tempdir().unwrap();
        std::fs::create_dir(folder.path().join("worlds")).unwrap();
        let one = folder.path().join("worlds/one.ron");
        let planet = Planet { name: "One".to_owned(), radius_km: 900.0, ..Planet::default() };
        planet.save(&one).unwrap();
        let mut open = OpenSystem::around(one.display().to_string(), Arc::new(planet));
        assert!(!open.is_dirty(), "it was only begun");
        let moon = crate::planet::shipped::ALL.iter().find(|shipped| shipped.file == "pallor.ron").unwrap();
        open.add_planet(1, format!("../planets/{}", moon.file), Arc::new(moon.load().unwrap()));
        assert!(open.is_dirty());
        // Another file has the name of the shipped preset.
        std::fs::write(folder.path().join("pallor.ron"), "mine").unwrap();
        let path = folder.path().join("system.ron");
        open.save(&path).unwrap();
        let presets: Vec<&str> = open.system().bodies.iter().map(|body| body.preset.as_str()).collect();
        assert_eq!(presets, ["", "worlds/one.ron", "pallor-2.ron"]);
        assert_eq!(std::fs::read_to_string(folder.path().join("pallor.ron")).unwrap(), "mine");
        assert!(!open.is_dirty() && !open.would_replace(&path));
        let again = OpenSystem::file(path.clone()).unwrap();
        assert_eq!(again.system(), open.system());
        assert!(again.preset(1).is_some() && again.preset(2).is_some());

        let ctx = egui::Context::default();
        assert!(open.poll(&ctx).is_none());
        let mut theirs = (**open.system()).clone();
        theirs.name = "Theirs".to_owned();
        theirs.save(&path).unwrap();
        let news = || {
            let mut open = OpenSystem::file(path.clone()).unwrap();
            open.text = None;
            open.would_replace(&path)
        };
        assert!(news(), "what others wrote is asked about");
        let wait = |open: &mut OpenSystem| {
            for _ in 0..200 {
                if let Some(news) = open.poll(&ctx) {
                    return Some(news);
                }
                std::thread::sleep(Duration::from_millis(20));
            }
            None
        };
        assert!(matches!(wait(&mut open), Some(News::Reloaded)));
        assert_eq!((open.system().name.as_str(), open.is_dirty()), ("Theirs", false));
        open.undo();
        assert!(open.is_dirty());
        open.poll(&ctx);
        theirs.name = "Theirs again".to_owned();
        theirs.save(&path).unwrap();
        assert!(matches!(wait(&mut open), Some(News::Theirs)));
        assert!(open.would_replace(&path) && open.system().name != theirs.name);
    }
}
