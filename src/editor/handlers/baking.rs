//! Maps, meshes and tiles for other programs: asks for a folder or a file, and bakes in the background.

use super::edit_baking;
use crate::bake::mesh::MeshFormat;
use crate::bake::{Bake, Outcome};
use crate::editor::command::BakeAction;
use crate::editor::files::dialogs::DialogRequest;
use crate::editor::files::file_names::with_extension;
use crate::editor::state::State;
use crate::editor::state::bake_settings::Product;
use crate::editor::state::baking::Baking;
use crate::editor::state::questions::{Asking, Replace};
use eframe::egui;
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// Shows or hides the window. Until the user sets a region, it is where the camera looks.
pub fn toggle(state: &mut State) {
    state.shows.bake ^= true;
    if state.shows.bake && !state.bake_region_is_set {
        let planet = state.document.valid_planet();
        let (place, away_m) = state.viewport.looked_at(planet);
        let region = &mut state.bake.region;
        (region.lat_deg, region.lon_deg) = place.to_degrees();
        region.side_km = wide_km(away_m, planet.radius_km);
    }
}

/// About as wide as half of the view, 1, 2 or 5 times a power of ten; no more than an engine takes at once.
fn wide_km(away_m: f64, radius_km: f64) -> f64 {
    let most_km = Bake::longest_side_km(radius_km);
    let wide_km = (0.5e-3 * away_m).clamp(0.1, (0.1 * radius_km).max(0.1));
    let power = 10.0_f64.powf(wide_km.log10().floor());
    let round = [5.0, 2.0, 1.0].into_iter().find(|round| round * power <= wide_km).unwrap_or(1.0);
    (round * power).min(most_km)
}

/// Carries out an action.
pub fn act(state: &mut State, ctx: &egui::Context, action: BakeAction) {
    match action {
        BakeAction::Set(settings) => {
            state.bake_region_is_set |= settings.region != state.bake.region;
            state.bake = *settings;
        }
        BakeAction::Ask => ask(state, ctx),
        BakeAction::Edits(edits) => edit_baking::ask(state, ctx, edits),
        BakeAction::CancelEdits => {
            if let Some(baking) = &state.edit_baking {
                baking.cancel();
            }
        }
        BakeAction::Cancel => {
            if let Some(baking) = &state.baking {
                baking.cancel();
            }
        }
    }
}

/// Asks for the folder or the file.
pub fn ask(state: &mut State, ctx: &egui::Context) {
    let (product, folder) = (state.bake.product, state.document.folder());
    let named = |ending: &str| state.document.suggested_file_name().replace(".ron", ending);
    let request = match (product, state.bake.mesh.format) {
        (Product::Maps, _) => DialogRequest::Folder { folder, file_name: named("-maps") },
        (Product::Tiles, _) => DialogRequest::Folder { folder, file_name: named("-tiles") },
        (Product::Mesh, format) => {
            DialogRequest::Mesh { folder, file_name: named(&format!(".{}", format.extension())) }
        }
    };
    state.questions.ask(ctx, Asking::Baked(product), request);
}

/// Goes on with a folder or a file that was chosen. `agreed` is the file that the user has agreed to replace.
pub fn chosen(state: &mut State, ctx: &egui::Context, product: Product, path: &Path, agreed: Option<&Path>) {
    if product != Product::Mesh {
        return start(state, ctx, product, path);
    }
    let ending = state.bake.mesh.format.extension();
    let path = if MeshFormat::of(path).is_some() { path.to_owned() } else { with_extension(path, ending) };
    if path.exists() && agreed != Some(&path) {
        state.questions.replace = Some(Replace::Mesh(path));
    } else {
        start(state, ctx, product, &path);
    }
}

/// Begins to bake. The ending of a mesh's name decides its format.
pub fn start(state: &mut State, ctx: &egui::Context, product: Product, to: &Path) {
    if state.baking.is_some() {
        return;
    }
    let ctx = ctx.clone();
    let planet = Arc::clone(state.document.valid_planet());
    let mut settings = state.bake.clone();
    settings.product = product;
    settings.mesh.format = MeshFormat::of(to).unwrap_or(settings.mesh.format);
    let title = failed(product);
    match settings.outputs(&planet, to) {
        Err(why) => return state.report(title, vec![why]),
        Ok(outputs) if state.would_lose(title, &outputs) => return,
        Ok(_) => {}
    }
    if let Err(why) = settings.check_room(&planet, to) {
        return state.report(title, vec![format!("{}: {why}", to.display())]);
    }
    let to = (to, state.viewport.settings.time_secs);
    let store = state.viewport.map_store();
    state.baking = Some(Baking::start(settings, planet, store, to, move || ctx.request_repaint()));
}

/// What the title of a message says.
fn failed(product: Product) -> &'static str {
    match product {
        Product::Maps => "The maps could not be baked",
        Product::Mesh => "The mesh could not be baked",
        Product::Tiles => "The tiles could not be baked",
    }
}

/// Asks for the small picture while its window is open, and says what has become of a bake once it has ended.
pub fn poll(state: &mut State, ctx: &egui::Context) {
    if state.shows.bake {
        let (waker, time_secs) = (ctx.clone(), state.viewport.settings.time_secs);
        let of = (state.document.valid_planet(), state.viewport.map_store());
        state.bake_preview.ask(&state.bake.as_shown(), of, time_secs, move || waker.request_repaint());
    } else {
        state.bake_preview = Default::default();
    }
    let Some((result, baking)) = state.baking.as_ref().and_then(|baking| Some((baking.ended()?, baking))) else {
        return;
    };
    let (product, to) = (baking.product, baking.to.display().to_string());
    state.baking = None;
    match (result, product) {
        (Ok(Outcome::Kept(_)), _) => state.notices.say(format!("All is there already in {to}; nothing was written")),
        (Ok(Outcome::Done(files)), Product::Maps) if files.len() == 1 => {
            state.notices.say(format!("Saved 1 map in {to}"));
        }
        (Ok(Outcome::Done(files)), Product::Maps) => state.notices.say(format!("Saved {} maps in {to}", files.len())),
        (Ok(Outcome::Done(_)), Product::Mesh) => state.notices.say(format!("Saved {to}")),
        // The other files list them.
        (Ok(Outcome::Done(files)), Product::Tiles) => {
            let is_tile = |file: &&PathBuf| file.extension().is_some_and(|ending| ending == "glb");
            state.notices.say(format!("Saved {} tiles in {to}", files.iter().filter(is_tile).count()));
        }
        (Ok(Outcome::Stopped | Outcome::Shard { .. }), Product::Mesh) => {
            state.notices.say(format!("Stopped; {to} was not written"));
        }
        (Ok(Outcome::Stopped | Outcome::Shard { .. }), _) => {
            state.notices.say(format!("Stopped; the same bake into {to} goes on from there"));
        }
        (Err(why), product) => state.report(failed(product), vec![why]),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_new_region_is_round_and_fits_the_view() {
        for (away_m, radius_km, wanted_km) in
            [(1e7, 6371.0, 500.0), (9000.0, 6371.0, 2.0), (21_000.0, 6371.0, 10.0), (1.0, 6371.0, 0.1)]
        {
            let found_km = wide_km(away_m, radius_km);
            assert!((found_km / wanted_km - 1.0).abs() < 1e-5, "{away_m}: {found_km}");
        }
    }
}
