//! The library: takes planets and parts out of it, and keeps some in it.

use crate::editor::command::LibraryAction;
use crate::editor::handlers::opening;
use crate::editor::state::State;
use crate::editor::state::questions::Goal;
use crate::editor::state::shelf::Origin;
use eframe::egui;

/// Carries out an action.
pub fn act(state: &mut State, ctx: &egui::Context, action: LibraryAction) {
    match action {
        LibraryAction::Open(index) => {
            let Some(item) = state.shelf.items.get(index) else { return };
            match item.origin.clone() {
                _ if !item.part.is_empty() => take(state, index),
                Origin::Shipped(number) => opening::pursue(state, ctx, Goal::OpenShipped(number)),
                Origin::File(path) | Origin::Library(path) => opening::pursue(state, ctx, Goal::OpenPath(path)),
            }
        }
        LibraryAction::Take(index) => take(state, index),
        LibraryAction::Keep(part) => keep(state, part),
        LibraryAction::Label(index, name, tags) => label(state, index, &name, &tags),
        LibraryAction::Remove(index) => remove(state, index),
    }
}

/// Takes a planet or a part over into the open one: an undo step.
fn take(state: &mut State, index: usize) {
    let Some(item) = state.shelf.items.get(index) else { return };
    let (part, name) = (item.part, item.name.clone());
    let taken = match &item.planet {
        Ok(from) => {
            let mut planet = (**state.document.planet()).clone();
            planet.take_part(from, part);
            planet
        }
        Err(why) => {
            let why = why.clone();
            return state.report("Nothing was taken from the library", vec![why]);
        }
    };
    state.step(taken, format!("Take {name} from library"));
}

fn keep(state: &mut State, part: &str) {
    let Some(library) = state.shelf.library.clone() else {
        return state.report("Nothing was kept", vec!["There is no folder for a library on this computer.".to_owned()]);
    };
    match library.keep(state.document.valid_planet(), part) {
        Ok(path) => {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            state.notices.say(format!("Kept {name} in the library"));
            state.shelf.forget();
        }
        Err(why) => state.report("Nothing was kept", vec![why]),
    }
}

fn label(state: &mut State, index: usize, name: &str, tags: &[String]) {
    let (Some(library), Some(item)) = (state.shelf.library.clone(), state.shelf.items.get(index)) else { return };
    let Origin::Library(path) = item.origin.clone() else { return };
    if let Err(why) = library.label(&path, name, tags) {
        state.report("The name and the tags were not changed", vec![why]);
    }
    state.shelf.forget();
}

fn remove(state: &mut State, index: usize) {
    let (Some(library), Some(item)) = (state.shelf.library.clone(), state.shelf.items.get(index)) else { return };
    let Origin::Library(path) = item.origin.clone() else { return };
    match library.remove(&path) {
        Ok(to) => {
            state.notices.say(format!("Moved to {}", to.display()));
            state.shelf.forget();
        }
        Err(why) => state.report("Nothing was removed", vec![why]),
    }
}
