//! The menu of a pane: what it shows, and whether it shares its camera with others.

use super::Shows;
use crate::editor::widgets::menu_button;
use eframe::egui::{self, pos2, vec2};

/// Room to the edges of the pane, points.
const ASIDE: f32 = 8.0;
/// Size of the bar, points.
const SIZE: egui::Vec2 = vec2(210.0, 22.0);
/// What linking does.
const LINKS: &str = "Linked views share one camera, that of the active view if it is linked. Others have their own.";

/// Where the bar of a pane is, if it has one.
pub(super) fn place(rect: egui::Rect) -> Option<egui::Rect> {
    let corner = pos2(rect.right() - ASIDE, rect.bottom() - ASIDE);
    let has_room = rect.width() >= SIZE.x && rect.height() >= 3.0 * SIZE.y;
    has_room.then(|| egui::Rect::from_min_max(corner - SIZE, corner))
}

/// Shows the bar in the lower right corner of a pane, which is known by its rectangle and its number.
pub(super) fn show(
    ui: &mut egui::Ui,
    (rect, number): (egui::Rect, usize),
    choices: impl Iterator<Item = Shows>,
    shows: &mut Shows,
    linked: &mut bool,
) {
    let Some(place) = place(rect) else { return };
    let layout = egui::Layout::right_to_left(egui::Align::Center);
    let ui = &mut ui.new_child(egui::UiBuilder::new().id_salt(("bar", number)).max_rect(place).layout(layout));
    let of = number + 1;
    let menu = menu_button(ui, shows.label(), |ui| {
        for choice in choices {
            if ui.selectable_label(*shows == choice, choice.label()).clicked() {
                *shows = choice;
                ui.close();
            }
        }
    });
    let name = format!("View {of} shows: {}", shows.label());
    menu.response.on_hover_text("What this view shows").accessible_name(name);
    if matches!(shows, Shows::Planet(_)) {
        let toggle = ui.toggle_value(linked, "Linked").on_hover_text(LINKS);
        toggle.accessible_name(format!("View {of} linked"));
    }
}
