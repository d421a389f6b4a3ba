//! Planets to choose from: variations, and locks on what they leave as it is; what a new planet begins as.

use crate::editor::command::VariationAction;
use crate::editor::state::State;
use crate::editor::state::describe::locked;
use crate::editor::state::sheet::Seen;
use crate::editor::state::shelf::Item;
use crate::editor::state::templates;
use crate::editor::state::thumbnails::Thumbnails;
use crate::editor::state::variations::Around;
use crate::planet::locks;
use crate::planet::param::ParamPath;
use crate::render::Renderer;
use eframe::egui;
use std::path::PathBuf;
use std::sync::Arc;

/// Changes what varies, or takes a variation: one undo step.
pub fn act(state: &mut State, action: VariationAction) {
    match action {
        VariationAction::Wish(wish) => state.variations.wish = wish,
        VariationAction::Again => state.variations.wish.seed = state.variations.wish.seed.wrapping_add(1),
        VariationAction::Take(number) => {
            let Some(planet) = state.variations.sheet.cells.get(number).map(|cell| (*cell.planet).clone()) else {
                return;
            };
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

/// Keeps the small pictures on screen up to date while their windows are open.
pub fn update(state: &mut State, ctx: &egui::Context) {
    if state.shows.variations {
        update_variations(state, ctx);
    } else {
        state.variations.close();
    }
    let kept = || state.thumbnails_folder.clone();
    if state.shows.templates {
        if state.templates.cells.is_empty() {
            let planets = templates::ALL.iter().map(|entry| Arc::new(entry.template.shown()));
            let start = || Some(thumbnails(state.viewport.second_renderer()?, kept(), ctx));
            state.templates.set(planets.collect(), &Seen::default(), start);
        }
        state.templates.poll(ctx);
    }
    if state.shows.library {
        let (waker, here) = (ctx.clone(), (state.document.valid_planet(), state.document_number));
        if state.shelf.update(state.recent.paths(), here, move || waker.request_repaint()) {
            // A file that cannot be read has a cell too.
            let planet = |item: &Item| item.planet.as_ref().map_or_else(|_| Arc::default(), Arc::clone);
            let planets = state.shelf.items.iter().map(planet).collect();
            let start = || Some(thumbnails(state.viewport.second_renderer()?, kept(), ctx));
            state.shelf.sheet.set(planets, &Seen::default(), start);
        }
        state.shelf.sheet.poll(ctx);
    }
    let missing = state.variations.sheet.missing() + state.templates.missing() + state.shelf.sheet.missing();
    if missing > 0 {
        state.viewport.postpone_refinement(ctx.input(|input| input.time));
    }
}

/// `kept`: the folder where pictures are kept between runs.
fn thumbnails(renderer: Renderer, kept: Option<PathBuf>, ctx: &egui::Context) -> Thumbnails {
    let ctx = ctx.clone();
    Thumbnails::start(renderer, kept, move || ctx.request_repaint())
}

fn update_variations(state: &mut State, ctx: &egui::Context) {
    // A slider that is held would begin nine pictures in each frame.
    if ctx.input(|input| input.pointer.any_down()) && !state.variations.sheet.cells.is_empty() {
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
    state.variations.update(ctx, &around, || Some(thumbnails(renderer()?, None, ctx)));
}
