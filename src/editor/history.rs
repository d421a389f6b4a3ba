//! Undo and redo: whole planets, shared, one step for each gesture.
//!
//! A gesture (a drag, a stroke, a typed number) changes the planet in many frames; [`History::record`] opens a step at
//! its first change and [`History::settle`], called while nobody drags or types, closes it. Planets are kept as `Arc`,
//! so a step costs the planet's data once.

use crate::planet::Planet;
use std::collections::VecDeque;
use std::sync::Arc;

/// Most steps that can be undone; the oldest are forgotten.
pub const MAX_STEPS: usize = 500;

/// One change: what to call it, and the planet on its other side.
#[derive(Clone, Debug)]
struct Step {
    label: String,
    planet: Arc<Planet>,
}

/// The steps that can be undone and redone.
#[derive(Debug, Default)]
pub struct History {
    undo: VecDeque<Step>,
    redo: Vec<Step>,
    /// Whether the newest step still grows.
    open: bool,
}

impl History {
    /// Notes that `before` is about to be replaced. A change with the same label as an unfinished gesture joins it.
    pub fn record(&mut self, before: &Arc<Planet>, label: &str) {
        self.redo.clear();
        if self.open && self.undo.back().is_some_and(|step| step.label == label) {
            return;
        }
        self.undo.push_back(Step { label: label.to_owned(), planet: before.clone() });
        if self.undo.len() > MAX_STEPS {
            self.undo.pop_front();
        }
        self.open = true;
    }

    /// Ends the gesture under way; one that came back to where it began leaves no step.
    pub fn settle(&mut self, current: &Arc<Planet>) {
        if self.open && self.undo.back().is_some_and(|step| step.planet == *current) {
            self.undo.pop_back();
        }
        self.open = false;
    }

    /// Goes one step back: gives the planet of then.
    pub fn undo(&mut self, current: &Arc<Planet>) -> Option<Arc<Planet>> {
        self.settle(current);
        let step = self.undo.pop_back()?;
        self.redo.push(Step { label: step.label, planet: current.clone() });
        Some(step.planet)
    }

    /// Takes the last undo back.
    pub fn redo(&mut self, current: &Arc<Planet>) -> Option<Arc<Planet>> {
        self.open = false;
        let step = self.redo.pop()?;
        self.undo.push_back(Step { label: step.label, planet: current.clone() });
        Some(step.planet)
    }

    /// What an undo would undo.
    pub fn undo_label(&self) -> Option<&str> {
        self.undo.back().map(|step| step.label.as_str())
    }

    /// What a redo would redo.
    pub fn redo_label(&self) -> Option<&str> {
        self.redo.last().map(|step| step.label.as_str())
    }

    /// How many steps can be undone.
    pub fn undo_len(&self) -> usize {
        self.undo.len()
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
        let mut history = History::default();
        history.record(&planet(0), "Change seed");
        history.record(&planet(1), "Change seed");
        history.record(&planet(2), "Change seed");
        history.settle(&planet(3));
        assert_eq!(history.undo_len(), 1);
        assert_eq!(history.undo(&planet(3)), Some(planet(0)));
        assert_eq!(history.redo_label(), Some("Change seed"));
        assert_eq!(history.redo(&planet(0)), Some(planet(3)));
        assert_eq!(history.undo_label(), Some("Change seed"));
    }

    #[test]
    fn gestures_that_differ_or_are_settled_between_are_steps_of_their_own() {
        let mut history = History::default();
        history.record(&planet(0), "Change seed");
        history.settle(&planet(1));
        history.record(&planet(1), "Change seed");
        history.record(&planet(2), "Change radius");
        history.settle(&planet(3));
        assert_eq!(history.undo_len(), 3);
    }

    #[test]
    fn a_gesture_that_ends_where_it_began_leaves_nothing() {
        let mut history = History::default();
        history.record(&planet(0), "Change seed");
        history.settle(&planet(0));
        assert_eq!(history.undo_len(), 0);
    }

    #[test]
    fn an_edit_forgets_what_could_be_redone_and_memory_is_bounded() {
        let mut history = History::default();
        for seed in 0..2 * MAX_STEPS as u32 {
            history.record(&planet(seed), "Change seed");
            history.settle(&planet(seed + 1));
        }
        assert_eq!(history.undo_len(), MAX_STEPS);
        assert!(history.undo(&planet(9999)).is_some());
        history.record(&planet(1), "Change radius");
        assert_eq!(history.redo_label(), None);
    }
}
