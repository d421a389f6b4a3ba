//! Maps for other programs: asks for a folder, and bakes in the background.

use crate::bake::Outcome;
use crate::editor::command::BakeAction;
use crate::editor::files::dialogs::DialogRequest;
use crate::editor::state::State;
use crate::editor::state::baking::Baking;
use crate::editor::state::questions::Asking;
use eframe::egui;
use std::path::Path;
use std::sync::Arc;

/// Carries out an action.
pub fn act(state: &mut State, ctx: &egui::Context, action: BakeAction) {
    match action {
        BakeAction::Set(settings) => state.bake = *settings,
        BakeAction::Ask => {
            let folder = state.document.folder();
            let file_name = state.document.suggested_file_name().replace(".ron", "-maps");
            state.questions.ask(ctx, Asking::Maps, DialogRequest::Folder { folder, file_name });
        }
        BakeAction::Cancel => {
            if let Some(baking) = &state.baking {
                baking.cancel();
            }
        }
    }
}

/// Begins to bake into a folder that was chosen.
pub fn start(state: &mut State, ctx: &egui::Context, folder: &Path) {
    if state.baking.is_some() {
        return;
    }
    let ctx = ctx.clone();
    let planet = Arc::clone(state.document.valid_planet());
    let mut settings = state.bake.clone();
    settings.maps.retain(|map| map.missing(&planet).is_none());
    let to = (folder, state.viewport.settings.time_secs);
    let store = state.viewport.map_store();
    state.baking = Some(Baking::start(settings, planet, store, to, move || ctx.request_repaint()));
}

/// Asks for the small picture while its window is open, and says what has become of a bake once it has ended.
pub fn poll(state: &mut State, ctx: &egui::Context) {
    if state.shows.bake {
        let (waker, time_secs) = (ctx.clone(), state.viewport.settings.time_secs);
        let of = (state.document.valid_planet(), state.viewport.map_store());
        state.bake_preview.ask(&state.bake, of, time_secs, move || waker.request_repaint());
    } else {
        state.bake_preview = Default::default();
    }
    let Some((result, folder)) =
        state.baking.as_ref().and_then(|baking| Some((baking.ended()?, baking.folder.display().to_string())))
    else {
        return;
    };
    state.baking = None;
    match result {
        Ok(Outcome::Done(files)) if files.len() == 1 => state.notices.say(format!("Saved 1 map in {folder}")),
        Ok(Outcome::Done(files)) => state.notices.say(format!("Saved {} maps in {folder}", files.len())),
        Ok(Outcome::Stopped | Outcome::Shard { .. }) => {
            state.notices.say(format!("Stopped; the same bake into {folder} goes on from there"));
        }
        Err(why) => state.report("The maps could not be baked", vec![why]),
    }
}
