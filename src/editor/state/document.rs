//! The planet being edited, its file, and its undo steps. Every change of the planet goes through here.
//!
//! An undo step may change the file too: a random planet has no file, and undo restores the planet before it together
//! with its file.

use super::describe;
use super::history::{History, Home};
use crate::editor::files::file_names::file_name_of;
use crate::planet::param::ParamPath;
use crate::planet::picture::folder_of;
use crate::planet::{Bookmark, FileContent, FileKey, Planet, ground_note, validate};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// A planet with its file and its undo steps.
pub struct Document {
    planet: Arc<Planet>,
    /// The newest planet without problems: the one that is drawn.
    valid: Arc<Planet>,
    home: Home,
    problems: Vec<(ParamPath, String)>,
    history: History,
}

impl Document {
    /// A new document. Its file, if it has a path already, does not exist yet.
    pub fn new(planet: Planet, path: Option<PathBuf>) -> Self {
        let planet = Arc::new(planet);
        let problems = validate::problems(&planet);
        Self {
            valid: if problems.is_empty() { planet.clone() } else { Arc::new(Planet::default()) },
            home: Home { path, saved: Some(planet.clone()), ..Home::default() },
            planet,
            problems,
            history: History::default(),
        }
    }

    /// A document read from `path`, which holds `text`.
    pub fn opened(planet: Planet, path: PathBuf, text: String) -> Self {
        let mut document = Self::new(planet, Some(path));
        document.home.bytes = Some(text.into_bytes());
        document
    }

    /// What to say of the file when it is opened: see [`ground_note`].
    pub fn note(&self) -> Option<String> {
        ground_note(std::str::from_utf8(self.home.bytes.as_deref()?).ok()?)
    }

    /// A document with unsaved work, of a file if it has one: to close it asks.
    pub fn unsaved(planet: Planet, path: Option<PathBuf>) -> Self {
        // Its pictures were named from the folder of the working copy.
        let planet = match &path {
            Some(path) => planet.moved_to(&folder_of(path)),
            None => planet,
        };
        let mut document = Self::new(planet, path);
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

    /// Problems of the planet as edited.
    pub fn problems(&self) -> &[(ParamPath, String)] {
        &self.problems
    }

    /// The file it was loaded from or saved to.
    pub fn path(&self) -> Option<&Path> {
        self.home.path.as_deref()
    }

    /// Content of the file when it was last read or written; None if there is no file yet.
    pub fn disk_bytes(&self) -> Option<&[u8]> {
        self.home.bytes.as_deref()
    }

    /// The undo steps.
    pub fn history(&self) -> &History {
        &self.history
    }

    /// Whether there is unsaved work.
    pub fn is_dirty(&self) -> bool {
        self.home.saved.as_ref().is_none_or(|saved| !Arc::ptr_eq(&self.planet, saved) && self.planet != *saved)
    }

    /// Planets that a random planet has replaced before their changes were saved, oldest first: the path of each, or
    /// the name if there is no file. Undo restores them.
    pub fn rolled_over(&self) -> Vec<String> {
        let name = |(planet, home): (&Arc<Planet>, &Home)| match &home.path {
            Some(path) => path.display().to_string(),
            None => planet.name.clone(),
        };
        self.work_rolled_over().map(name).collect()
    }

    fn work_rolled_over(&self) -> impl Iterator<Item = (&Arc<Planet>, &Home)> {
        self.history.homes().filter(|(planet, home)| home.lacks(planet))
    }

    /// The planet to keep as the working copy: unsaved work, or else the last that a random planet has replaced, or
    /// else an untouched random planet.
    pub fn to_recover(&self) -> Option<&Arc<Planet>> {
        if self.home.lacks(&self.planet) {
            return Some(&self.valid);
        }
        let rolled_over = self.work_rolled_over().last().map(|(planet, _)| planet);
        rolled_over.or_else(|| self.is_dirty().then_some(&self.valid))
    }

    /// The file that the working copy belongs to.
    pub fn file_to_recover(&self) -> Option<&Path> {
        self.path().filter(|_| self.home.lacks(&self.planet))
    }

    /// The bookmarks of the planet as edited.
    pub fn bookmarks(&self) -> &[Bookmark] {
        self.planet.editor.as_ref().map_or(&[], |notes| &notes.bookmarks)
    }

    /// The folder of the file.
    pub fn folder(&self) -> Option<PathBuf> {
        self.home.path.as_deref().map(folder_of)
    }

    /// Gives a file that has been read to the planet. That is no edit: no parameter changes.
    pub fn give_file(&mut self, key: &FileKey, content: &FileContent) {
        let given = |planet: &Arc<Planet>| {
            let mut planet = (**planet).clone();
            planet.give_file(key, content);
            Arc::new(planet)
        };
        (self.planet, self.valid) = (given(&self.planet), given(&self.valid));
        self.home.saved = self.home.saved.as_ref().map(given);
    }

    /// Replaces the planet. `label` names the undo step; None names it after the changed parameters.
    pub fn edit(&mut self, mut planet: Planet, label: Option<String>) {
        if let Some(folder) = self.folder() {
            planet.set_folder(&folder);
        }
        if planet == *self.planet {
            return;
        }
        let label = label.unwrap_or_else(|| describe::change(&self.planet, &planet));
        // A surface rule that was just switched on gets a biome, within the same step.
        planet.biomes.name_missing(false);
        planet.edits.follow_palette(&self.planet.biomes.palette, &planet.biomes.palette);
        planet.edits.follow_populations(&self.planet.life, &planet.life);
        self.history.record(&self.planet, &label);
        self.show(Arc::new(planet));
    }

    /// Replaces the planet by one that no file holds: one undo step.
    pub fn roll(&mut self, planet: Planet, label: &str) {
        self.settle();
        let planet = Arc::new(planet);
        let home = std::mem::replace(&mut self.home, Home { rolled: Some(planet.clone()), ..Home::default() });
        self.history.record_move(&self.planet, home, label);
        self.show(planet);
        self.settle();
    }

    /// Replaces the planet by the content of its file: one undo step.
    pub fn reload(&mut self, planet: Planet, bytes: Vec<u8>) {
        let planet = Arc::new(planet);
        if planet != self.planet {
            self.settle();
            self.history.record(&self.planet, "Reload from disk");
            self.show(planet.clone());
            self.settle();
        }
        self.note_saved(Some(planet), Some(bytes));
    }

    /// Notes the content of the file, and leaves the planet as it is.
    pub fn note_disk(&mut self, planet: Option<Planet>, bytes: Option<Vec<u8>>) {
        self.note_saved(planet.map(Arc::new), bytes);
    }

    /// Notes the content of the file, here and in the undo steps of the same file.
    fn note_saved(&mut self, saved: Option<Arc<Planet>>, bytes: Option<Vec<u8>>) {
        (self.home.saved, self.home.bytes) = (saved, bytes);
        self.history.note_file(&self.home);
    }

    /// Ends the gesture under way. Call it while nobody drags or types.
    pub fn settle(&mut self) {
        self.history.settle(&self.planet);
    }

    /// Goes one undo step back.
    pub fn undo(&mut self) {
        if let Some(planet) = self.history.undo(&self.planet, &mut self.home) {
            self.show(planet);
        }
    }

    /// Goes one undo step forward.
    pub fn redo(&mut self) {
        if let Some(planet) = self.history.redo(&self.planet, &mut self.home) {
            self.show(planet);
        }
    }

    /// Undoes or redoes until this number of steps is done.
    pub fn jump(&mut self, steps: usize) {
        self.settle();
        while self.history.undo_len() > steps {
            self.undo();
        }
        while self.history.undo_len() < steps && self.history.redo_label().is_some() {
            self.redo();
        }
    }

    /// Notes that the file at `path` holds `planet` as `text`. From now on, paths of pictures are relative to its
    /// folder.
    pub fn mark_saved(&mut self, planet: &Planet, path: PathBuf, text: String) {
        let folder = folder_of(&path);
        let saved = Arc::new(planet.moved_to(&folder));
        for kept in [&mut self.planet, &mut self.valid] {
            *kept = if **kept == *saved { saved.clone() } else { Arc::new(kept.moved_to(&folder)) };
        }
        self.home = Home { path: Some(path), ..Home::default() };
        self.note_saved(Some(saved), Some(text.into_bytes()));
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
        file_name_of(&self.planet.name, "planet")
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
        document.mark_saved(&document.planet().clone(), PathBuf::from("a.ron"), document.planet().to_text());
        assert_eq!(document.title(), "a.ron");
        document.undo();
        assert!(document.is_dirty(), "the file holds the later planet");
    }

    #[test]
    fn a_roll_is_a_step_and_undo_brings_the_file_back() {
        let mut document = Document::new(Planet::default(), None);
        document.mark_saved(&Planet::default(), PathBuf::from("a.ron"), Planet::default().to_text());
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
    fn a_jump_goes_through_the_steps_and_their_files() {
        let mut document = Document::new(seeded(0), None);
        document.mark_saved(&seeded(0), PathBuf::from("a.ron"), seeded(0).to_text());
        for seed in 1..4 {
            document.edit(seeded(seed), None);
            document.settle();
        }
        document.roll(seeded(9), "Random planet");
        let labels: Vec<&str> = document.history().labels().collect();
        assert_eq!(labels, ["Change seed", "Change seed", "Change seed", "Random planet"]);
        for (steps, seed, path) in [(1, 1, Some("a.ron")), (4, 9, None), (0, 0, Some("a.ron")), (99, 9, None)] {
            document.jump(steps);
            assert_eq!((document.planet().seed, document.path()), (seed, path.map(Path::new)), "{steps}");
            assert_eq!(document.history().labels().count(), 4, "a jump forgets nothing");
        }
    }

    fn seeded(seed: u32) -> Planet {
        Planet { seed, ..Planet::default() }
    }

    #[test]
    fn changes_that_were_rolled_over_are_known() {
        let mut document = Document::new(Planet::default(), None);
        document.mark_saved(&Planet::default(), PathBuf::from("a.ron"), Planet::default().to_text());
        document.roll(seeded(5), "Random planet");
        document.roll(seeded(6), "Random planet");
        assert!(document.rolled_over().is_empty(), "a roll is nobody's work");
        document.undo();
        document.undo();
        document.edit(seeded(7), None);
        document.roll(seeded(5), "Random planet");
        assert_eq!(document.rolled_over(), ["a.ron"]);
    }

    #[test]
    fn work_without_a_file_is_known_when_it_is_rolled_over() {
        let name = "My Moon".to_owned();
        let mut document = Document::new(Planet { name: name.clone(), ..Planet::default() }, None);
        document.roll(seeded(5), "Random planet");
        assert!(document.rolled_over().is_empty(), "nobody had touched it");
        document.undo();
        document.edit(Planet { name: name.clone(), ..seeded(7) }, None);
        document.roll(seeded(5), "Random planet");
        assert_eq!(document.rolled_over(), [name]);

        let mut document = Document::unsaved(seeded(3), None);
        document.roll(seeded(5), "Random planet");
        assert_eq!(document.rolled_over().len(), 1, "what a crash had left");
        assert_eq!(document.to_recover().map(|planet| planet.seed), Some(3), "and would leave again");
        document.edit(seeded(6), None);
        assert_eq!(document.to_recover().map(|planet| planet.seed), Some(6), "newer work goes first");
        document.roll(seeded(8), "Random planet");
        assert_eq!(document.rolled_over().len(), 2, "so is a random planet that was edited");

        let mut document = Document::opened(seeded(1), PathBuf::from("a.ron"), String::new());
        document.note_disk(None, None);
        document.roll(seeded(5), "Random planet");
        assert_eq!(document.rolled_over(), ["a.ron"], "its file was gone");
    }

    #[test]
    fn a_file_that_was_saved_over_is_known_to_the_steps_before() {
        let path = PathBuf::from("a.ron");
        let mut document = Document::opened(seeded(1), path.clone(), seeded(1).to_text());
        document.roll(seeded(5), "Random planet");
        document.mark_saved(&seeded(5), std::path::absolute(&path).unwrap(), seeded(5).to_text());
        document.undo();
        assert_eq!((document.path(), document.planet().seed), (Some(path.as_path()), 1));
        assert!(document.is_dirty(), "the file holds the random planet");
        assert_eq!(document.disk_bytes(), Some(seeded(5).to_text().as_bytes()));
    }

    #[test]
    fn what_the_file_holds_is_taken_over_as_a_step_or_noted() {
        let theirs = Planet { seed: 8, ..Planet::default() };
        let mut document = Document::opened(Planet::default(), PathBuf::from("a.ron"), "old".to_owned());
        document.reload(theirs.clone(), b"new".to_vec());
        assert_eq!((document.planet().seed, document.is_dirty(), document.disk_bytes()), (8, false, Some(&b"new"[..])));
        document.undo();
        assert!(document.is_dirty(), "the file holds theirs");
        document.note_disk(None, None);
        assert!(document.is_dirty() && document.disk_bytes().is_none(), "the file is gone");
    }

    #[test]
    fn a_file_name_is_offered() {
        let document = Document::new(Planet { name: "My Moon!".to_owned(), ..Planet::default() }, None);
        assert_eq!(document.suggested_file_name(), "my-moon.ron");
    }
}
