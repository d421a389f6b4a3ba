//! Variations of the planet, and locks on what they leave as it is.

use crate::editor::command::VariationAction;
use crate::editor::state::State;
use crate::editor::state::describe::locked;
use crate::editor::state::thumbnails::Thumbnails;
use crate::editor::state::variations::Around;
use crate::planet::locks;
use crate::planet::param::ParamPath;
use eframe::egui;

/// Changes what varies, or takes a variation: one undo step.
pub fn act(state: &mut State, action: VariationAction) {
    match action {
        VariationAction::Wish(wish) => state.variations.wish = wish,
        VariationAction::Again => state.variations.wish.seed = state.variations.wish.seed.wrapping_add(1),
        VariationAction::Take(number) => {
            let Some(planet) = state.variations.cells.get(number).map(|cell| (*cell.planet).clone()) else { return };
            state.step(planet, format!("Take variation {}", number + 1));
            // The next nine are others: the same dice would move the same numbers on and on.
            state.variations.wish.seed = state.variations.wish.seed.wrapping_add(1);
        }
        VariationAction::UnlockAll => {
            let mut planet = (**state.document.planet()).clone();
            locks::clear(&mut planet);
            state.step(planet, "Unlock everything".to_owned());
        }
    }
}

/// Locks a parameter or a part, or unlocks it: one undo step.
pub fn toggle_lock(state: &mut State, path: &ParamPath) {
    let mut planet = (**state.document.planet()).clone();
    let verb = if locks::toggle(&mut planet, path) { "Lock" } else { "Unlock" };
    let label = format!("{verb} {}", locked(&planet, path));
    state.step(planet, label);
}

/// Keeps the variations on screen up to date while their window is open.
pub fn update(state: &mut State, ctx: &egui::Context) {
    if !state.shows.variations {
        state.variations.close();
        return;
    }
    // A slider that is held would begin nine pictures in each frame.
    if ctx.input(|input| input.pointer.any_down()) && !state.variations.cells.is_empty() {
        return;
    }
    let planet = state.document.valid_planet().clone();
    let around = Around {
        planet: &planet,
        terrain: state.viewport.surface().map(|surface| surface.terrain.clone()),
        eye: state.viewport.eye(&planet).1,
        time_secs: state.viewport.settings.time_secs,
    };
    let renderer = || state.viewport.second_renderer();
    state.variations.update(ctx, &around, || {
        let ctx = ctx.clone();
        Some(Thumbnails::start(renderer()?, move || ctx.request_repaint()))
    });
    if state.variations.missing() > 0 {
        state.viewport.postpone_refinement(ctx.input(|input| input.time));
    }
}
