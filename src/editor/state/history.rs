//! Undo and redo: one step for each gesture, each a whole document: a planet, or a system.
//!
//! A gesture (a drag, a stroke, a typed number) changes the document in many frames. [`History::record`] opens a step
//! at its first change; [`History::settle`], called while nobody drags or types, closes it. Documents are shared by
//! `Arc`: a step takes the memory of one.

use crate::editor::files::file_names::is_same_file;
use crate::planet::Planet;
use std::collections::VecDeque;
use std::path::PathBuf;
use std::sync::Arc;

/// Most steps that can be undone; older ones are dropped.
pub const MAX_STEPS: usize = 500;

/// The file of a planet, and its content.
#[derive(Clone, Debug, Default)]
pub struct Home {
    /// The path of the file, if there is one.
    pub path: Option<PathBuf>,
    /// The planet in the file, or the one that a new document began with; None for unsaved work.
    pub saved: Option<Arc<Planet>>,
    /// Content of the file when it was last read or written, UTF-8 or not; None if there is no file yet.
    pub bytes: Option<Vec<u8>>,
    /// The random planet that the document began with: it counts as nobody's work.
    pub rolled: Option<Arc<Planet>>,
}

impl Home {
    /// Whether a planet with this file is unsaved work.
    pub fn lacks(&self, planet: &Arc<Planet>) -> bool {
        let begun = self.saved.as_ref().or(self.rolled.as_ref());
        begun.is_none_or(|begun| !Arc::ptr_eq(begun, planet) && begun != planet)
    }
}

/// An undo step: its name, and the document on its other side.
#[derive(Clone, Debug)]
struct Step<T, H> {
    label: String,
    document: Arc<T>,
    /// The file of the document on the other side, if it is another.
    home: Option<H>,
}

impl<T, H> Step<T, H> {
    /// Takes the step. Gives the document on its other side, and the step back.
    fn turned(self, current: &Arc<T>, home: &mut H) -> (Arc<T>, Self) {
        let back = self.home.map(|other| std::mem::replace(home, other));
        (self.document, Self { label: self.label, document: current.clone(), home: back })
    }
}

/// The steps of a document of type `T` that can be undone and redone; `H` tells its file.
#[derive(Debug)]
pub struct History<T = Planet, H = Home> {
    undo: VecDeque<Step<T, H>>,
    redo: Vec<Step<T, H>>,
    /// Whether the gesture of the newest step is under way.
    open: bool,
}

impl<T, H> Default for History<T, H> {
    fn default() -> Self {
        Self { undo: VecDeque::new(), redo: Vec::new(), open: false }
    }
}

impl<T: PartialEq, H> History<T, H> {
    /// Notes that `before` is about to be replaced. A change with the name of the gesture under way joins its step.
    pub fn record(&mut self, before: &Arc<T>, label: &str) {
        self.redo.clear();
        if self.open && self.undo.back().is_some_and(|step| step.label == label) {
            return;
        }
        self.push(before, None, label);
    }

    /// Notes a change after which the document has another file; `home` is the file before.
    pub fn record_move(&mut self, before: &Arc<T>, home: H, label: &str) {
        self.redo.clear();
        self.push(before, Some(home), label);
    }

    fn push(&mut self, before: &Arc<T>, home: Option<H>, label: &str) {
        self.undo.push_back(Step { label: label.to_owned(), document: before.clone(), home });
        if self.undo.len() > MAX_STEPS {
            self.undo.pop_front();
        }
        self.open = true;
    }

    /// Ends the gesture under way. A gesture that ends with the document of its begin leaves no step.
    pub fn settle(&mut self, current: &Arc<T>) {
        if self.open && self.undo.back().is_some_and(|step| step.document == *current) {
            self.undo.pop_back();
        }
        self.open = false;
    }

    /// Goes one step back. Gives the document before the step, and sets `home` to its file.
    pub fn undo(&mut self, current: &Arc<T>, home: &mut H) -> Option<Arc<T>> {
        self.settle(current);
        let step = self.undo.pop_back()?;
        let (document, step) = step.turned(current, home);
        self.redo.push(step);
        Some(document)
    }

    /// Goes one step forward.
    pub fn redo(&mut self, current: &Arc<T>, home: &mut H) -> Option<Arc<T>> {
        self.open = false;
        let step = self.redo.pop()?;
        let (document, step) = step.turned(current, home);
        self.undo.push_back(step);
        Some(document)
    }

    /// Name of the step that undo takes.
    pub fn undo_label(&self) -> Option<&str> {
        self.undo.back().map(|step| step.label.as_str())
    }

    /// Name of the step that redo takes.
    pub fn redo_label(&self) -> Option<&str> {
        self.redo.last().map(|step| step.label.as_str())
    }

    /// The names of all steps, the oldest first: those that are done, then those that can be redone.
    pub fn labels(&self) -> impl Iterator<Item = &str> {
        self.undo.iter().chain(self.redo.iter().rev()).map(|step| step.label.as_str())
    }

    /// The documents before and after the step of this index among [`History::labels`]. `current`: the document now.
    pub fn sides<'a>(&'a self, step: usize, current: &'a Arc<T>) -> Option<(&'a Arc<T>, &'a Arc<T>)> {
        let (done, all) = (self.undo.len(), self.len());
        // The documents in order: before each step that is done, now, after each step that can be redone.
        let document = |at: usize| match at {
            at if at < done => self.undo.get(at).map(|step| &step.document),
            at if at == done => Some(current),
            at => all.checked_sub(at).and_then(|from_end| self.redo.get(from_end)).map(|step| &step.document),
        };
        Some((document(step)?, document(step + 1)?))
    }

    /// Number of all steps.
    pub fn len(&self) -> usize {
        self.undo.len() + self.redo.len()
    }

    /// Whether there is no step.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Number of steps that can be undone.
    pub fn undo_len(&self) -> usize {
        self.undo.len()
    }
}

impl History {
    /// The planets of steps that change the file, with their files.
    pub fn homes(&self) -> impl Iterator<Item = (&Arc<Planet>, &Home)> {
        self.undo.iter().chain(&self.redo).filter_map(|step| Some((&step.document, step.home.as_ref()?)))
    }

    /// Notes the content of a file in every step of that file.
    pub fn note_file(&mut self, now: &Home) {
        let Some(path) = &now.path else { return };
        for home in self.undo.iter_mut().chain(&mut self.redo).filter_map(|step| step.home.as_mut()) {
            if home.path.as_ref().is_some_and(|other| is_same_file(other, path)) {
                (home.saved, home.bytes) = (now.saved.clone(), now.bytes.clone());
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn planet(seed: u32) -> Arc<Planet> {
        Arc::new(Planet { seed, ..Planet::default() })
    }

    #[test]
    fn a_gesture_is_one_step() {
        let mut history = History::<Planet, Home>::default();
        history.record(&planet(0), "Change seed");
        history.record(&planet(1), "Change seed");
        history.record(&planet(2), "Change seed");
        history.settle(&planet(3));
        assert_eq!(history.undo_len(), 1);
        assert_eq!(history.undo(&planet(3), &mut Home::default()), Some(planet(0)));
        assert_eq!(history.redo_label(), Some("Change seed"));
        assert_eq!(history.redo(&planet(0), &mut Home::default()), Some(planet(3)));
        assert_eq!(history.undo_label(), Some("Change seed"));
    }

    #[test]
    fn each_step_has_the_documents_of_its_sides() {
        let mut history = History::<Planet, Home>::default();
        for seed in 0..4 {
            history.record(&planet(seed), "Change seed");
            history.settle(&planet(seed + 1));
        }
        let mut now = planet(4);
        for undone in 0..4 {
            for step in 0..4 {
                let sides = history.sides(step, &now).map(|(before, after)| (before.seed, after.seed));
                assert_eq!(sides, Some((step as u32, step as u32 + 1)), "{undone} undone");
            }
            assert_eq!(history.sides(4, &now), None);
            now = history.undo(&now, &mut Home::default()).unwrap();
        }
    }

    #[test]
    fn gestures_that_differ_or_are_settled_between_are_steps_of_their_own() {
        let mut history = History::<Planet, Home>::default();
        history.record(&planet(0), "Change seed");
        history.settle(&planet(1));
        history.record(&planet(1), "Change seed");
        history.record(&planet(2), "Change radius");
        history.settle(&planet(3));
        assert_eq!(history.undo_len(), 3);
    }

    #[test]
    fn a_gesture_that_ends_where_it_began_leaves_nothing() {
        let mut history = History::<Planet, Home>::default();
        history.record(&planet(0), "Change seed");
        history.settle(&planet(0));
        assert_eq!(history.undo_len(), 0);
    }

    #[test]
    fn an_edit_forgets_what_could_be_redone_and_memory_is_bounded() {
        let mut history = History::<Planet, Home>::default();
        for seed in 0..2 * MAX_STEPS as u32 {
            history.record(&planet(seed), "Change seed");
            history.settle(&planet(seed + 1));
        }
        assert_eq!(history.undo_len(), MAX_STEPS);
        assert!(history.undo(&planet(9999), &mut Home::default()).is_some());
        history.record(&planet(1), "Change radius");
        assert_eq!(history.redo_label(), None);
    }
}
