//! Notices and problems above the picture, and the last action below it.

use crate::editor::state::State;
use crate::editor::state::recovery::Recovery;
use eframe::egui;

/// Most problems that are listed; the rest are counted.
const MOST_LISTED: usize = 4;

/// Shows notices and problems, if there are any.
pub fn show(ui: &mut egui::Ui, state: &State) {
    let (problems, pictures) = (state.document.problems(), state.pictures.problems());
    let error = state.viewport.error();
    let notices = notices(state);
    if problems.is_empty() && pictures.is_empty() && error.is_none() && notices.is_empty() {
        return;
    }
    egui::Panel::top("problems").resizable(false).show(ui, |ui| {
        let (error_color, warning_color) = (ui.visuals().error_fg_color, ui.visuals().warn_fg_color);
        for notice in notices {
            ui.colored_label(warning_color, notice);
        }
        if let Some(error) = error {
            ui.colored_label(error_color, error);
        }
        if !problems.is_empty() {
            ui.strong("The picture shows the last planet without problems.");
        }
        for (path, message) in problems.iter().take(MOST_LISTED) {
            ui.colored_label(error_color, format!("{path}: {message}"));
        }
        for (path, message) in pictures.iter().take(MOST_LISTED) {
            ui.colored_label(warning_color, format!("{path}: {message}; until then this layer is flat"));
        }
        if problems.len() > MOST_LISTED {
            ui.weak(format!("… and {} more", problems.len() - MOST_LISTED));
        }
    });
}

/// Notices about the open file and the working copy.
fn notices(state: &State) -> Vec<String> {
    let shared = state
        .document
        .path()
        .filter(|_| state.notices.is_shared())
        .map(|path| format!("{} is open in another window too: the last save wins.", path.display()));
    let unkept = state.recovery.as_ref().and_then(Recovery::problem).or(state.notices.unkept.as_deref());
    let unkept =
        unkept.map(|why| format!("Unsaved work would be lost in a crash; save often. No working copy is kept: {why}."));
    shared.into_iter().chain(unkept).chain(state.open_file.notice.clone()).collect()
}

/// Shows the last action of the editor, between the scale and the right edge of the picture.
pub fn show_said(ctx: &egui::Context, state: &State) {
    let Some((text, left)) = state.notices.said() else { return };
    let picture = state.viewport.rect();
    egui::Area::new(egui::Id::unique("said"))
        .pivot(egui::Align2::CENTER_BOTTOM)
        .fixed_pos(picture.center_bottom() - egui::vec2(0.0, 12.0))
        .order(egui::Order::Foreground)
        .interactable(false)
        .show(ctx, |ui| {
            egui::Frame::popup(ui.style()).show(ui, |ui| {
                ui.set_max_width(0.6 * picture.width());
                ui.label(text);
            });
        });
    ctx.request_repaint_after(left);
}
