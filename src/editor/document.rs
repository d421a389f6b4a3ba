//! The planet being edited, its file, and its history. Everything that changes the planet goes through here.
//!
//! A step of the history may change the file too: a rolled planet has none, and undo brings the planet before it back
//! together with its file.

use super::describe;
use super::history::{History, Home};
use crate::planet::param::ParamPath;
use crate::planet::picture::{Picture, PictureKey, folder_of};
use crate::planet::{Planet, validate};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A planet with its file and its undo steps.
pub struct Document {
    planet: Arc<Planet>,
    /// The newest planet without problems: what is drawn.
    valid: Arc<Planet>,
    home: Home,
    problems: Vec<(ParamPath, String)>,
    history: History,
}

impl Document {
    /// A document that has just been made. Its file, if it has a name already, does not exist yet.
    pub fn new(planet: Planet, path: Option<PathBuf>) -> Self {
        let planet = Arc::new(planet);
        let problems = validate::problems(&planet);
        Self {
            valid: if problems.is_empty() { planet.clone() } else { Arc::new(Planet::default()) },
            home: Home { path, saved: Some(planet.clone()), text: None },
            planet,
            problems,
            history: History::default(),
        }
    }

    /// A document that has just been read from `path`, which holds `text`.
    pub fn opened(planet: Planet, path: PathBuf, text: String) -> Self {
        let mut document = Self::new(planet, Some(path));
        document.home.text = Some(text);
        document
    }

    /// A document that was never saved: closing it asks.
    pub fn unsaved(planet: Planet) -> Self {
        let mut document = Self::new(planet, None);
        document.home.saved = None;
        document
    }

    /// The planet as edited; it may have [`Self::problems`].
    pub fn planet(&self) -> &Arc<Planet> {
        &self.planet
    }

    /// The newest planet that has no problems.
    pub fn valid_planet(&self) -> &Arc<Planet> {
        &self.valid
    }

    /// What is wrong with the planet as edited.
    pub fn problems(&self) -> &[(ParamPath, String)] {
        &self.problems
    }

    /// The file it was loaded from or saved to.
    pub fn path(&self) -> Option<&Path> {
        self.home.path.as_deref()
    }

    /// The text of the file when it was last read or written; None where there is no file yet.
    pub fn disk_text(&self) -> Option<&str> {
        self.home.text.as_deref()
    }

    /// The undo steps.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Whether there is work that no file holds.
    pub fn is_dirty(&self) -> bool {
        self.home.saved.as_ref().is_none_or(|saved| !Arc::ptr_eq(&self.planet, saved) && self.planet != *saved)
    }

    /// The file of a planet that was rolled over before its changes were saved, if there is one: undo brings it back.
    pub fn rolled_over(&self) -> Option<&Path> {
        self.history.homes().find_map(|(planet, home)| {
            let changed = home.saved.as_ref().is_some_and(|saved| saved != planet);
            home.path.as_deref().filter(|_| changed)
        })
    }

    /// The folder of its file.
    pub fn folder(&self) -> Option<PathBuf> {
        self.home.path.as_deref().map(folder_of)
    }

    /// Hands over a picture that has been read. That is no edit: what the planet says stays the same.
    pub fn give_picture(&mut self, key: &PictureKey, picture: &Arc<Picture>) {
        let given = |planet: &Arc<Planet>| {
            let mut planet = (**planet).clone();
            planet.give_picture(key, picture);
            Arc::new(planet)
        };
        (self.planet, self.valid) = (given(&self.planet), given(&self.valid));
        self.home.saved = self.home.saved.as_ref().map(given);
    }

    /// Replaces the planet; `label` names the step, or it is named after what changed.
    pub fn edit(&mut self, mut planet: Planet, label: Option<String>) {
        if let Some(folder) = self.folder() {
            planet.set_folder(&folder);
        }
        if planet == *self.planet {
            return;
        }
        let label = label.unwrap_or_else(|| describe::change(&self.planet, &planet));
        // A rule that has just been switched on is of something, within the same step.
        planet.biomes.name_missing(false);
        self.history.record(&self.planet, &label);
        self.show(Arc::new(planet));
    }

    /// Puts another planet, which no file holds, in the place of this one: one step.
    pub fn roll(&mut self, planet: Planet, label: &str) {
        self.settle();
        let home = std::mem::take(&mut self.home);
        self.history.record_move(&self.planet, home, label);
        self.show(Arc::new(planet));
        self.settle();
    }

    /// Takes over what the file holds now: one step.
    pub fn reload(&mut self, planet: Planet, text: String) {
        let planet = Arc::new(planet);
        if planet != self.planet {
            self.settle();
            self.history.record(&self.planet, "Reload from disk");
            self.show(planet.clone());
            self.settle();
        }
        (self.home.saved, self.home.text) = (Some(planet), Some(text));
    }

    /// Notes what the file holds now, and leaves the planet as it is.
    pub fn note_disk(&mut self, planet: Option<Planet>, text: Option<String>) {
        (self.home.saved, self.home.text) = (planet.map(Arc::new), text);
    }

    /// Ends the gesture under way; call it while nobody drags or types.
    pub fn settle(&mut self) {
        self.history.settle(&self.planet);
    }

    /// Goes one step back.
    pub fn undo(&mut self) {
        if let Some(planet) = self.history.undo(&self.planet, &mut self.home) {
            self.show(planet);
        }
    }

    /// Goes one step forward.
    pub fn redo(&mut self) {
        if let Some(planet) = self.history.redo(&self.planet, &mut self.home) {
            self.show(planet);
        }
    }

    /// Notes that `planet` now stands in the file at `path`. Paths of pictures count from there from now on.
    pub fn mark_saved(&mut self, planet: &Planet, path: PathBuf) {
        let folder = folder_of(&path);
        let saved = Arc::new(planet.moved_to(&folder));
        for kept in [&mut self.planet, &mut self.valid] {
            *kept = if **kept == *saved { saved.clone() } else { Arc::new(kept.moved_to(&folder)) };
        }
        let text = saved.to_text();
        self.home = Home { path: Some(path), saved: Some(saved), text: Some(text) };
    }

    /// The name of the file or of the planet, with a mark when there is unsaved work.
    pub fn title(&self) -> String {
        let mark = if self.is_dirty() { "• " } else { "" };
        match &self.home.path {
            Some(path) => format!("{mark}{}", path.display()),
            None => format!("{mark}{}", self.planet.name),
        }
    }

    /// A file name to offer for saving.
    pub fn suggested_file_name(&self) -> String {
        if let Some(name) = self.home.path.as_deref().and_then(Path::file_name) {
            return name.to_string_lossy().into_owned();
        }
        let stem: String = self
            .planet
            .name
            .to_lowercase()
            .chars()
            .map(|c| if c.is_alphanumeric() { c } else { '-' })
            .collect::<String>()
            .trim_matches('-')
            .to_owned();
        format!("{}.ron", if stem.is_empty() { "planet" } else { &stem })
    }

    fn show(&mut self, planet: Arc<Planet>) {
        self.problems = validate::problems(&planet);
        if self.problems.is_empty() {
            self.valid = planet.clone();
        }
        self.planet = planet;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn dirty_is_a_comparison_of_planets() {
        let mut document = Document::new(Planet::default(), None);
        assert!(!document.is_dirty());
        document.edit(Planet { seed: 5, ..Planet::default() }, None);
        assert!(document.is_dirty());
        assert!(document.title().starts_with('•'));
        document.undo();
        assert!(!document.is_dirty(), "undoing everything leaves nothing to save");
        document.redo();
        document.mark_saved(&document.planet().clone(), PathBuf::from("a.ron"));
        assert_eq!(document.title(), "a.ron");
        document.undo();
        assert!(document.is_dirty(), "the file holds the later planet");
    }

    #[test]
    fn a_roll_is_a_step_and_undo_brings_the_file_back() {
        let mut document = Document::new(Planet::default(), None);
        document.mark_saved(&Planet::default(), PathBuf::from("a.ron"));
        document.roll(Planet { seed: 5, ..Planet::default() }, "Random planet");
        assert_eq!((document.path(), document.is_dirty()), (None, true));
        assert_eq!(document.history().undo_label(), Some("Random planet"));
        document.roll(Planet { seed: 6, ..Planet::default() }, "Random planet");
        assert_eq!(document.history().undo_len(), 2, "each roll is a step of its own");
        document.undo();
        document.undo();
        assert_eq!((document.path(), document.is_dirty()), (Some(Path::new("a.ron")), false));
        document.redo();
        assert_eq!((document.path(), document.planet().seed), (None, 5));
    }

    #[test]
    fn changes_that_were_rolled_over_are_known() {
        let mut document = Document::new(Planet::default(), None);
        document.mark_saved(&Planet::default(), PathBuf::from("a.ron"));
        document.roll(Planet { seed: 5, ..Planet::default() }, "Random planet");
        assert_eq!(document.rolled_over(), None);
        document.undo();
        document.edit(Planet { seed: 7, ..Planet::default() }, None);
        document.roll(Planet { seed: 5, ..Planet::default() }, "Random planet");
        assert_eq!(document.rolled_over(), Some(Path::new("a.ron")));
    }

    #[test]
    fn what_the_file_holds_is_taken_over_as_a_step_or_noted() {
        let theirs = Planet { seed: 8, ..Planet::default() };
        let mut document = Document::opened(Planet::default(), PathBuf::from("a.ron"), "old".to_owned());
        document.reload(theirs.clone(), "new".to_owned());
        assert_eq!((document.planet().seed, document.is_dirty(), document.disk_text()), (8, false, Some("new")));
        document.undo();
        assert!(document.is_dirty(), "the file holds theirs");
        document.note_disk(None, None);
        assert!(document.is_dirty() && document.disk_text().is_none(), "the file is gone");
    }

    #[test]
    fn a_file_name_is_offered() {
        let document = Document::new(Planet { name: "My Moon!".to_owned(), ..Planet::default() }, None);
        assert_eq!(document.suggested_file_name(), "my-moon.ron");
    }
}
