//! Ground edits into a height picture: asks for the file, bakes in the background, puts the stamp in their place.

use crate::editor::command::{PanelAction, SculptAction};
use crate::editor::files::dialogs::DialogRequest;
use crate::editor::files::file_names::with_extension;
use crate::editor::state::State;
use crate::editor::state::edit_baking::{Done, EditBaking};
use crate::editor::state::questions::{Asking, Replace};
use crate::editor::widgets::number::length_text;
use eframe::egui;
use std::path::Path;
use std::sync::Arc;

/// What the title of a message says.
const FAILED: &str = "The edits could not be baked";

/// Asks for the file to write, for the edits of these indices.
pub fn ask(state: &mut State, ctx: &egui::Context, edits: Vec<usize>) {
    if state.edit_baking.is_some() {
        return;
    }
    let folder = state.document.folder();
    let stem = state.document.suggested_file_name().replace(".ron", "-edits");
    let is_free = |name: &String| folder.as_ref().is_none_or(|folder| !folder.join(name).exists());
    let mut names = (1..).map(|n| if n == 1 { format!("{stem}.exr") } else { format!("{stem}-{n}.exr") });
    let file_name = names.find(is_free).unwrap_or_default();
    state.questions.ask(ctx, Asking::BakedEdits(edits), DialogRequest::BakedEdits { folder, file_name });
}

/// Goes on with a file that was chosen. `agreed` is the file that the user has agreed to replace.
pub fn chosen(state: &mut State, ctx: &egui::Context, edits: Vec<usize>, file: &Path, agreed: Option<&Path>) {
    let path = with_extension(file, "exr");
    // One that the planet names, but which is not there yet, would be read from then on.
    let is_named = state.document.planet().linked_places().any(|(_, key)| key.file() == path);
    if is_named && !path.exists() {
        state.report(FAILED, vec![format!("The planet names {} already. Choose another name.", path.display())]);
        return;
    }
    if state.would_lose(FAILED, &[&path]) {
        return;
    }
    if path.exists() && agreed != Some(&path) {
        state.questions.replace = Some(Replace::BakedEdits { edits, path });
    } else {
        start(state, ctx, edits, &path);
    }
}

/// Begins to bake.
pub fn start(state: &mut State, ctx: &egui::Context, edits: Vec<usize>, to: &Path) {
    let (planet, folder) = (Arc::clone(state.document.valid_planet()), state.document.folder());
    let (store, ctx) = (state.viewport.map_store(), ctx.clone());
    state.edit_baking = Some(EditBaking::start(planet, edits, (to, folder), store, move || ctx.request_repaint()));
}

/// Puts the stamp in the place of the edits once they are baked: one undo step.
pub fn poll(state: &mut State) {
    let Some((result, baking)) = state.edit_baking.as_ref().and_then(|baking| Some((baking.ended()?, baking))) else {
        return;
    };
    let (to, fits) = (baking.to.clone(), baking.fits(state.document.planet()));
    state.edit_baking = None;
    match result {
        Ok(Some(done)) if fits => take_over(state, done, &to),
        Ok(Some(_)) => {
            let why = "The ground was changed while its edits were baked; they stay as they are. Bake them again.";
            state.report(FAILED, vec![why.to_owned()]);
        }
        Ok(None) => state.notices.say("Stopped; the edits stay as they are".to_owned()),
        Err(why) => state.report(FAILED, vec![why]),
    }
}

fn take_over(state: &mut State, done: Done, to: &Path) {
    let mut planet = (**state.document.planet()).clone();
    planet.edits = done.edits;
    let count = if done.count == 1 { "1 edit".to_owned() } else { format!("{} edits", done.count) };
    state.step(planet, format!("Bake {count}"));
    state.ask_panel(PanelAction::Sculpt(SculptAction::Select(done.index)));
    let file = to.file_name().unwrap_or_default().to_string_lossy();
    let (pixel, greatest, mean) =
        (length_text(done.pixel_m), length_text(done.deviation.greatest_m), length_text(done.deviation.rms_m));
    state.notices.say(format!(
        "Baked {count} into {file}: a pixel is {pixel}; the ground differs by up to {greatest}, {mean} on average"
    ));
}
