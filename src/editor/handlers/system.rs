//! Systems: opens, changes and saves them, and goes from body to body.

use crate::editor::command::{NewBody, SystemAction};
use crate::editor::files::dialogs::DialogRequest;
use crate::editor::files::file_names::{PRESET_EXTENSION, file_name_of, is_same_file, with_extension};
use crate::editor::handlers::opening;
use crate::editor::state::State;
use crate::editor::state::questions::{Asking, Goal, Replace};
use crate::editor::state::system::presets::{name_of_shipped, of_document};
use crate::editor::state::system::trial::TrialRun;
use crate::editor::state::system::{News, OpenSystem, Origin, Preset};
use crate::editor::viewport::travel::Arrival;
use crate::editor::widgets::random_seed;
use crate::planet::file::read_text;
use crate::planet::picture::folder_of;
use crate::planet::{Planet, shipped};
use crate::system::System;
use eframe::egui;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Carries out an action.
pub fn act(state: &mut State, ctx: &egui::Context, action: SystemAction) {
    match action {
        SystemAction::Open(index) => opening::pursue(state, ctx, Goal::OpenSystem(index)),
        SystemAction::Begin => opening::pursue(state, ctx, Goal::BeginSystem),
        // Its planet is open.
        SystemAction::Visit(body, arrival) if state.viewport.body() == Some(body) => visit(state, body, arrival),
        SystemAction::Visit(body, arrival) => opening::pursue(state, ctx, Goal::Visit(body, arrival)),
        SystemAction::Leave => opening::pursue(state, ctx, Goal::LeaveSystem),
        SystemAction::Edit(system, label) => state.change_system(|open| open.edit(*system, &label)),
        SystemAction::Add(parent, NewBody::Star) => state.change_system(|open| open.add_star(parent)),
        SystemAction::Add(parent, NewBody::Shipped(index)) => add_shipped(state, parent, index),
        SystemAction::Add(parent, NewBody::Open) => match of_document(&state.document) {
            Ok((preset, planet)) => state.change_system(|open| open.add_planet(parent, preset, planet)),
            Err(why) => state.notices.say(why),
        },
        SystemAction::Add(parent, NewBody::Ask) => {
            let folder = system_folder(state).or_else(|| state.document.folder());
            state.questions.ask(ctx, Asking::Body(parent), DialogRequest::Open { folder });
        }
        SystemAction::Remove(body) => state.change_system(|open| open.remove(body)),
        SystemAction::Lock(body) => state.change_system(|open| open.toggle_lock(body)),
        SystemAction::Roll => state.change_system(|open| open.roll(random_seed())),
        SystemAction::Undo => state.change_system(OpenSystem::undo),
        SystemAction::Redo => state.change_system(OpenSystem::redo),
        SystemAction::Save => save(state, ctx),
        SystemAction::SaveAs => save_as(state, ctx),
        SystemAction::Try(years) => {
            if let Some(open) = &mut state.system {
                let waker = ctx.clone();
                open.trial = TrialRun::start(open.worlds.clone(), years, move || waker.request_repaint());
            }
        }
        SystemAction::StopTrial => {
            if let Some(open) = &state.system {
                open.trial.stop();
            }
        }
    }
}

/// Whether a file holds a system. A file that cannot be read is no system: who opens it says why.
pub fn is_system(path: &Path) -> bool {
    read_text(path).is_ok_and(|text| System::is_system(&text))
}

/// Opens a system file, and goes to its first planet.
pub fn open_file(state: &mut State, ctx: &egui::Context, path: &Path) {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    open(state, ctx, OpenSystem::file(path));
}

/// Opens the shipped system of an index.
pub fn open_shipped(state: &mut State, ctx: &egui::Context, index: usize) {
    open(state, ctx, OpenSystem::shipped(index));
}

fn open(state: &mut State, ctx: &egui::Context, opened: Result<OpenSystem, String>) {
    match opened {
        Ok(system) => {
            let first = system.first_planet();
            state.shows.system = true;
            state.viewport.set_system(None);
            state.system = Some(system);
            if let Some(first) = first {
                opening::pursue(state, ctx, Goal::Visit(first, Arrival::Orbit));
            }
        }
        Err(why) => state.report("The system could not be opened", why.lines().map(str::to_owned).collect()),
    }
}

/// Begins a system around the open planet, which stays open.
pub fn begin(state: &mut State) {
    match of_document(&state.document) {
        Ok((preset, planet)) => {
            let system = OpenSystem::around(preset, planet);
            state.shows.system = true;
            state.viewport.set_system(Some((system.worlds.clone(), 1)));
            state.system = Some(system);
        }
        Err(why) => state.notices.say(why),
    }
}

/// Draws the planet alone.
pub fn leave(state: &mut State) {
    state.system = None;
    state.viewport.set_system(None);
}

/// Flies to a body, or opens it at once where there is no flight to see.
pub fn visit(state: &mut State, body: usize, arrival: Arrival) {
    if state.viewport.fly_to_body(body, arrival) {
        return;
    }
    if state.viewport.body() != Some(body) {
        arrive(state, body);
    }
    if arrival == Arrival::Ground && state.viewport.body() == Some(body) {
        state.viewport.go_down();
    }
}

/// The flight to a body has come near it: it becomes the planet, and the planet becomes one of its neighbours.
pub fn hand_over(state: &mut State, ctx: &egui::Context, (body, arrival): (usize, Arrival)) {
    let is_given_up = state.questions.given_up.take().is_some_and(|planet| planet == *state.document.planet());
    if state.loses_work() && !is_given_up {
        // The planet was changed during the flight.
        state.viewport.cancel_travel();
        return opening::pursue(state, ctx, Goal::Visit(body, arrival));
    }
    arrive(state, body);
    let radius_m = state.document.valid_planet().radius_m();
    match state.viewport.body() == Some(body) {
        true => state.viewport.take_over_goal(radius_m),
        false => state.viewport.cancel_travel(),
    }
}

/// Opens the planet of a body, and draws its neighbours.
fn arrive(state: &mut State, body: usize) {
    let Some(preset) = state.system.as_ref().and_then(|system| system.preset(body)) else { return };
    let number = state.document_number;
    let neighbours = state.viewport.take_neighbours();
    match preset {
        Preset::Shipped(index) => opening::open_shipped(state, index),
        Preset::File(path) => opening::open_path(state, &path),
    }
    // A planet that could not be opened left the document as it was.
    let is_open = state.document_number != number;
    let Some(system) = &state.system else { return };
    let worlds = system.worlds.clone();
    if let Some(neighbours) = neighbours {
        let planet = if is_open { body } else { neighbours.body() };
        state.viewport.return_neighbours(neighbours, planet);
    }
    if is_open {
        state.viewport.set_system(Some((worlds, body)));
        state.reset_view();
    }
}

fn add_shipped(state: &mut State, parent: usize, index: usize) {
    let Some((preset, name)) = shipped::ALL.get(index).zip(name_of_shipped(index)) else { return };
    match preset.load() {
        Ok(planet) => state.change_system(|open| open.add_planet(parent, name, Arc::new(planet))),
        Err(error) => state.report("The planet could not be read", vec![error.to_string()]),
    }
}

/// Adds the planet of a file about a body.
pub fn add_file(state: &mut State, parent: usize, path: &Path) {
    let path = std::path::absolute(path).unwrap_or_else(|_| path.to_owned());
    match Planet::load(&path) {
        Ok(planet) => {
            let named = path.display().to_string();
            state.change_system(|open| open.add_planet(parent, named, Arc::new(planet)));
        }
        Err(error) => {
            let lines = error.to_string().lines().map(str::to_owned).collect();
            state.report("The planet could not be read", lines);
        }
    }
}

fn system_folder(state: &State) -> Option<PathBuf> {
    match &state.system.as_ref()?.origin {
        Origin::File(path) => Some(folder_of(path)),
        Origin::Shipped(_) | Origin::New => None,
    }
}

/// Saves the system to its file, or asks for one.
pub fn save(state: &mut State, ctx: &egui::Context) {
    match state.system.as_ref().map(|system| system.origin.clone()) {
        Some(Origin::File(path)) => write_unless_theirs(state, ctx, path, None),
        Some(Origin::Shipped(_) | Origin::New) => save_as(state, ctx),
        None => {}
    }
}

/// Asks for a file to save the system to.
pub fn save_as(state: &mut State, ctx: &egui::Context) {
    let Some(system) = &state.system else { return };
    let file_name = file_name_of(&system.system().name, "system");
    let folder = system_folder(state).or_else(|| state.document.folder());
    state.questions.ask(ctx, Asking::SaveSystem, DialogRequest::SaveSystem { folder, file_name });
}

/// Saves to a file that was chosen. `agreed` is the file that the user has agreed to replace, if it exists.
pub fn save_chosen(state: &mut State, ctx: &egui::Context, file: &Path, agreed: Option<&Path>) {
    let path = with_extension(file, PRESET_EXTENSION);
    let path = std::path::absolute(&path).unwrap_or(path);
    let is_own = state.system.as_ref().and_then(|system| system.path()).is_some_and(|own| is_same_file(own, &path));
    if !is_own && state.would_lose("The system could not be saved", &[&path]) {
        state.questions.after_save = None;
        return;
    }
    write_unless_theirs(state, ctx, path, agreed);
}

fn write_unless_theirs(state: &mut State, ctx: &egui::Context, path: PathBuf, agreed: Option<&Path>) {
    let would_replace = state.system.as_ref().is_some_and(|system| system.would_replace(&path));
    if would_replace && agreed != Some(&path) {
        state.questions.replace = Some(Replace::System(path));
    } else {
        write(state, ctx, &path);
    }
}

/// Writes the file, and goes on with the action that waited for it.
pub fn write(state: &mut State, ctx: &egui::Context, path: &Path) {
    let mut saved = Ok(());
    state.change_system(|open| saved = open.save(path));
    match saved {
        Ok(()) => {
            state.notices.say(format!("Saved to {}", path.display()));
            state.recent.note(path);
            if let Some(goal) = state.questions.after_save.take() {
                opening::pursue_past_planet(state, ctx, goal);
            }
        }
        Err(why) => {
            state.questions.after_save = None;
            state.report("The system could not be saved", why.lines().map(str::to_owned).collect());
        }
    }
}

/// Takes the result of a trial, and what other programs have changed.
pub fn poll(state: &mut State, ctx: &egui::Context) {
    let Some(open) = &mut state.system else { return };
    if open.trial.poll() {
        state.notices.say("The run of the system has failed: its thread stopped".to_owned());
    }
    let Some(open) = &mut state.system else { return };
    let before = Arc::clone(&open.worlds);
    let news = open.poll(ctx);
    // The picture follows.
    if !Arc::ptr_eq(&before, &open.worlds) {
        state.follow_system(&before);
    }
    match news {
        None | Some(News::Presets) => {}
        Some(News::Reloaded) => state.notices.say("The system has changed on disk and was read again".to_owned()),
        Some(News::Theirs) => {
            state.notices.say("The system has changed on disk; yours has unsaved changes and stays".to_owned());
        }
        Some(News::Broken(why)) => {
            let line = why.lines().next().unwrap_or_default();
            state.notices.say(format!("The system has changed on disk and cannot be read: {line}"));
        }
    }
}
