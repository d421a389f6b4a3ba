//! Photographs and films: asks for a file, and takes them in the background.

use crate::editor::files::dialogs::DialogRequest;
use crate::editor::state::State;
use crate::editor::state::questions::{Asking, Replace};
use crate::editor::state::shooting::{PhotoSettings, Shooting, Subject};
use crate::film::{CameraPath, FileKind, Film, Sequence, Shot, frame_path};
use crate::lod::{Camera, View};
use crate::render::{Lens, Metering, Photo, Post};
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
    let files = match subject {
        Subject::Film => film(&state.photo, 1.0).files(&path),
        Subject::Picture => vec![path.clone()],
    };
    if state.would_lose("The picture could not be saved", &files) {
        return;
    }
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

/// How the film runs. `speed`: seconds of the planet in each second.
fn film(photo: &PhotoSettings, speed: f64) -> Film {
    Film { secs: photo.film_secs, fps: photo.fps, speed }
}

fn sequence(state: &State, subject: Subject, path: &Path) -> Result<Sequence, String> {
    let kind = FileKind::of(path, None)?;
    let (surface, revision) = state.viewport.shown().ok_or("The planet is not there yet: wait until it is drawn.")?;
    let (settings, photo) = (&state.viewport.settings, &state.photo);
    let camera = state.viewport.pose(revision.planet()).camera(Camera::DEFAULT_FOV_Y_RAD);
    let lens = (photo.aperture_m > 0.0)
        .then(|| Lens { diameter_m: photo.aperture_m, focus_m: photo.focus_m.unwrap_or_default() });
    let shot = Shot {
        terrain: Arc::clone(&surface.terrain),
        revision,
        view: View { camera, size_px: photo.size_px, quality: photo.quality },
        time_secs: settings.time_secs,
        sun: None,
        debug_view: settings.debug_view,
        population: settings.population,
        post: Post {
            metering: if settings.auto_exposure { Metering::Instant } else { Metering::Manual },
            ..settings.post
        },
        photo: Photo { samples: photo.samples, lens, ..Photo::default() },
        system: state.viewport.in_system(),
        focuses: photo.focus_m.is_none(),
        ground_secs: None,
        ground_bytes: None,
    };
    match subject {
        Subject::Picture => Ok(Sequence::picture(shot, path.to_owned(), kind)),
        Subject::Film => {
            let way = CameraPath::over(&shot.terrain, state.document.bookmarks(), camera.fov_y_rad)
                .ok_or("There is no bookmark to fly over: add some with Ctrl+B.")?;
            let speed = if settings.playing { settings.time_speed } else { 1.0 };
            Ok(Sequence::film(shot, way, film(photo, speed), path, kind))
        }
    }
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
