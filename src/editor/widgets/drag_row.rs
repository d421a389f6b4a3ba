//! Rows of a list that are reordered by dragging.

use eframe::egui;
use std::any::Any;

/// Makes row `index` of a list draggable, and draws a line in the gap into which a row would be dropped. Gives the row
/// that was dropped on this one, and the gap: `n` is before row `n`. `row` holds the index, in a type of its own for
/// each list, so that rows stay in their list.
pub fn dragged_row<T: Any + Send + Sync + Copy>(
    ui: &egui::Ui,
    response: &egui::Response,
    index: usize,
    row: T,
) -> Option<(T, usize)> {
    response.dnd_set_drag_payload(row);
    gap_under(ui, response, index)
}

/// Draws a line in the gap into which what is dragged would be dropped: before row `index` of a list or behind it.
/// Gives what was dropped, and the gap.
pub fn gap_under<T: Any + Send + Sync + Copy>(
    ui: &egui::Ui,
    response: &egui::Response,
    index: usize,
) -> Option<(T, usize)> {
    let from = *response.dnd_hover_payload::<T>()?;
    let (pointer, rect) = (ui.ctx().pointer_interact_pos()?, response.rect);
    let below = pointer.y > rect.center().y;
    let y = if below { rect.bottom() + 1.0 } else { rect.top() - 1.0 };
    ui.painter().hline(rect.x_range(), y, ui.visuals().selection.stroke);
    response.dnd_release_payload::<T>()?;
    Some((from, index + usize::from(below)))
}
