//! Photographs and films: asks for a file, and takes them in the background.

use crate::editor::files::dialogs::DialogRequest;
use crate::editor::state::State;
use crate::editor::state::questions::{Asking, Replace};
use crate::editor::state::shooting::{Shooting, Subject};
use crate::film::{CameraPath, FileKind, Sequence, Shot, frame_path};
use crate::lod::{Camera, View};
use crate::render::{Lens, Metering, Photo};
use crate::tiles::Surface;
use eframe::egui;
use std::path::Path;
use std::sync::Arc;

/// Asks for the file to write.
pub fn ask(state: &mut State, ctx: &egui::Context, subject: Subject) {
    let folder = state.document.folder();
    let ending = if subject == Subject::Film { "-film.png" } else { ".png" };
    let file_name = state.document.suggested_file_name().replace(".ron", ending);
    state.questions.ask(ctx, Asking::Photograph(subject), DialogRequest::Photograph { folder, file_name });
}

/// Takes what was asked for into a file that was chosen. `agreed` is the file that the user has agreed to replace.
pub fn chosen(state: &mut State, ctx: &egui::Context, subject: Subject, file: &Path, agreed: Option<&Path>) {
    let path = if file.extension().is_some() { file.to_owned() } else { file.with_extension("png") };
    let first = if subject == Subject::Film { frame_path(&path, 1) } else { path.clone() };
    if first.exists() && agreed != Some(&first) {
        state.questions.replace = Some(Replace::Photograph { subject, path, first });
    } else {
        start(state, ctx, subject, &path);
    }
}

/// Begins to take it.
pub fn start(state: &mut State, ctx: &egui::Context, subject: Subject, path: &Path) {
    match sequence(state, subject, path) {
        Ok(sequence) => match state.viewport.second_renderer() {
            Some(renderer) => {
                let ctx = ctx.clone();
                state.shooting = Some(Shooting::start(sequence, renderer, move || ctx.request_repaint()));
            }
            None => state.report("No picture", vec!["There is no graphics device to draw with.".to_owned()]),
        },
        Err(why) => state.report("No picture", vec![why]),
    }
}

fn sequence(state: &State, subject: Subject, path: &Path) -> Result<Sequence, String> {
    let kind = FileKind::of(path, None)?;
    let surface = state.viewport.surface().ok_or("The planet is not there yet: wait until it is drawn.")?;
    let planet = state.document.valid_planet();
    let (settings, photo) = (&state.viewport.settings, &state.photo);
    let here = state.viewport.pose(planet).camera(Camera::DEFAULT_FOV_Y_RAD);
    let shot = |camera: Camera, time_secs: f64| {
        let mut post = settings.post;
        post.metering = if settings.auto_exposure { Metering::Instant } else { Metering::Manual };
        Shot {
            terrain: Arc::clone(&surface.terrain),
            view: View { camera, size_px: photo.size_px, quality: photo.quality },
            sun_dir_planet: planet.star.place(time_secs).direction(),
            time_secs,
            debug_view: settings.debug_view,
            post,
            photo: taken(state, &surface, &camera),
        }
    };
    let shots = match subject {
        Subject::Picture => vec![(shot(here, settings.time_secs), path.to_owned())],
        Subject::Film => {
            let way = CameraPath::over(&surface.terrain, state.document.bookmarks(), here.fov_y_rad)
                .ok_or("There is no bookmark to fly over: add some with Ctrl+B.")?;
            let count = (photo.film_secs * f64::from(photo.fps)).round().max(1.0) as usize;
            let speed = if settings.playing { settings.time_speed } else { 1.0 };
            let frame = |number: usize| {
                let time_secs = settings.time_secs + speed * number as f64 / f64::from(photo.fps);
                let share = number as f64 / (count - 1).max(1) as f64;
                (shot(way.camera(&surface.terrain, share), time_secs), frame_path(path, number + 1))
            };
            (0..count).map(frame).collect()
        }
    };
    Ok(Sequence { shots, kind })
}

/// Samples, and a lens that is in focus where it should be.
fn taken(state: &State, surface: &Surface, camera: &Camera) -> Photo {
    let settings = &state.photo;
    let middle_m = || surface.terrain.raycast(camera.position_planet_m, camera.forward_planet());
    // What is in the middle of the sky is far away.
    let focus_m = || settings.focus_m.or_else(middle_m).unwrap_or(1e9);
    let lens = (settings.aperture_m > 0.0).then(|| Lens { diameter_m: settings.aperture_m, focus_m: focus_m() });
    Photo { samples: settings.samples, lens, ..Photo::default() }
}

/// Says what has become of the photographs, once they are taken.
pub fn poll(state: &mut State) {
    let Some((result, shooting)) = state.shooting.as_ref().and_then(|shooting| Some((shooting.ended()?, shooting)))
    else {
        return;
    };
    let (first, count) = (shooting.first.display().to_string(), shooting.count);
    state.shooting = None;
    match result {
        Ok(written) if written < count => state.notices.say(format!("Cancelled after {written} of {count} pictures")),
        Ok(1) => state.notices.say(format!("Saved {first}")),
        Ok(written) => state.notices.say(format!("Saved {written} frames, the first is {first}")),
        Err(why) => state.report("The picture could not be saved", vec![why]),
    }
}
