//! A kept planet beside the one that is edited.

use crate::editor::state::State;
use crate::planet::Planet;
use eframe::egui;

/// Keeps a copy of the planet to compare later edits with, or drops it.
pub fn toggle(state: &mut State, ctx: &egui::Context) {
    let is_on = state.viewport.compare().is_some();
    let kept = (!is_on).then(|| state.document.valid_planet().clone());
    state.viewport.set_compare(kept, ctx);
    if !is_on {
        state.notices.say("This planet is kept as it is: edit on, and drag the line to compare".to_owned());
    }
}

/// Exchanges the planet and the kept one: one undo step.
pub fn swap(state: &mut State) {
    let now = state.document.valid_planet().clone();
    let Some(kept) = state.viewport.swap_compared(now) else { return };
    // Bookmarks and locks stay with the document.
    let editor = state.document.planet().editor.clone();
    state.step(Planet { editor, ..(*kept).clone() }, "Swap with the kept copy".to_owned());
}
