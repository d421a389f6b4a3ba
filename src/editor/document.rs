//! The planet being edited, its file, and its history. Everything that changes the planet goes through here.

use super::describe;
use super::history::History;
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
    saved: Arc<Planet>,
    path: Option<PathBuf>,
    problems: Vec<(ParamPath, String)>,
    history: History,
}

impl Document {
    /// A document that has just been loaded from `path`, or made.
    pub fn new(planet: Planet, path: Option<PathBuf>) -> Self {
        let planet = Arc::new(planet);
        let problems = validate::problems(&planet);
        Self {
            valid: if problems.is_empty() { planet.clone() } else { Arc::new(Planet::default()) },
            saved: planet.clone(),
            planet,
            path,
            problems,
            history: History::default(),
        }
    }

    /// A document that was never saved: closing it asks.
    pub fn unsaved(planet: Planet) -> Self {
        let mut document = Self::new(planet, None);
        document.saved = Arc::new(Planet::default());
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
        self.path.as_deref()
    }

    /// The undo steps.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Whether there is work that no file holds.
    pub fn is_dirty(&self) -> bool {
        !Arc::ptr_eq(&self.planet, &self.saved) && self.planet != self.saved
    }

    /// The folder of its file.
    pub fn folder(&self) -> Option<PathBuf> {
        self.path.as_deref().map(folder_of)
    }

    /// Hands over a picture that has been read. That is no edit: what the planet says stays the same.
    pub fn give_picture(&mut self, key: &PictureKey, picture: &Arc<Picture>) {
        let given = |planet: &Arc<Planet>| {
            let mut planet = (**planet).clone();
            planet.give_picture(key, picture);
            Arc::new(planet)
        };
        (self.planet, self.valid, self.saved) = (given(&self.planet), given(&self.valid), given(&self.saved));
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
        self.history.record(&self.planet, &label);
        self.show(Arc::new(planet));
    }

    /// Ends the gesture under way; call it while nobody drags or types.
    pub fn settle(&mut self) {
        self.history.settle(&self.planet);
    }

    /// Goes one step back.
    pub fn undo(&mut self) {
        if let Some(planet) = self.history.undo(&self.planet) {
            self.show(planet);
        }
    }

    /// Goes one step forward.
    pub fn redo(&mut self) {
        if let Some(planet) = self.history.redo(&self.planet) {
            self.show(planet);
        }
    }

    /// Notes that `planet` now stands in the file at `path`. Paths of pictures count from there from now on.
    pub fn mark_saved(&mut self, planet: &Planet, path: PathBuf) {
        let folder = folder_of(&path);
        self.saved = Arc::new(planet.moved_to(&folder));
        self.path = Some(path);
        for kept in [&mut self.planet, &mut self.valid] {
            *kept = if **kept == *self.saved { self.saved.clone() } else { Arc::new(kept.moved_to(&folder)) };
        }
    }

    /// The name of the file or of the planet, with a mark when there is unsaved work.
    pub fn title(&self) -> String {
        let mark = if self.is_dirty() { "• " } else { "" };
        match &self.path {
            Some(path) => format!("{mark}{}", path.display()),
            None => format!("{mark}{}", self.planet.name),
        }
    }

    /// A file name to offer for saving.
    pub fn suggested_file_name(&self) -> String {
        if let Some(name) = self.path.as_deref().and_then(Path::file_name) {
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
    fn a_file_name_is_offered() {
        let document = Document::new(Planet { name: "My Moon!".to_owned(), ..Planet::default() }, None);
        assert_eq!(document.suggested_file_name(), "my-moon.ron");
    }
}
