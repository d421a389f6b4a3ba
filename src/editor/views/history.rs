//! The window of the undo steps: each with its name, the current one marked. A click or Enter goes to a step.

use super::{differences, look};
use crate::editor::command::{Action, Commands, Window};
use crate::editor::state::State;
use crate::editor::widgets::pick_list::PickList;
use crate::planet::Planet;
use eframe::egui::{self, Align2, TextStyle};
use std::collections::HashMap;
use std::sync::Arc;

/// Width of the window and height of a row, in points.
const WIDTH: f32 = 350.0;
const ROW_HEIGHT: f32 = 22.0;
/// Most rows in view.
const MOST_ROWS: f32 = 16.0;

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("history window")
}

/// The window.
#[derive(Default)]
pub struct HistoryWindow {
    list: PickList,
    /// Steps done and all steps when the cursor was put on the current one; None while the window is closed.
    seen: Option<(usize, usize)>,
    /// The values before and after each step that was in view, and the planet of now for which they were found.
    values: HashMap<usize, Option<String>>,
    of: Option<Arc<Planet>>,
}

impl HistoryWindow {
    /// Shows the window while it is open.
    pub fn show(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        if !state.shows.history {
            self.seen = None;
            return;
        }
        let opens = self.seen.is_none();
        let history = state.document.history();
        let (done, count) = (history.undo_len(), history.len() + 1);
        // The cursor follows every edit, undo and redo.
        if self.seen != Some((done, count)) {
            self.list.set_cursor(done);
            self.seen = Some((done, count));
            self.values.clear();
        }
        let planet = state.document.planet();
        if self.of.as_ref().is_none_or(|of| !Arc::ptr_eq(of, planet)) {
            self.of = Some(planet.clone());
            // The steps on both sides of it.
            self.values.retain(|step, _| *step != done && *step + 1 != done);
        }
        let known = &mut self.values;
        let mut values_of = |row: usize| {
            let step = row.checked_sub(1)?;
            let find = || history.sides(step, planet).and_then(|(before, after)| differences::values(before, after));
            known.entry(step).or_insert_with(find).clone()
        };
        let mut open = true;
        let window =
            egui::Window::new("History").id(id()).open(&mut open).default_pos(look::WINDOW_POS).default_width(WIDTH);
        window.resizable(false).collapsible(false).show(ctx, |ui| {
            ui.set_width(ui.available_width());
            let rows = MOST_ROWS.min(((ctx.content_rect().height() - 160.0) / ROW_HEIGHT).floor()).max(3.0);
            let focus = ui.interact(ui.max_rect(), id().with("keys"), egui::Sense::focusable_noninteractive());
            focus.widget_info(|| egui::WidgetInfo::labeled(egui::Role::ListBox, true, "Undo steps"));
            if opens {
                focus.request_focus();
            }
            let mut chosen = None;
            if focus.has_focus() {
                let arrows = egui::EventFilter { vertical_arrows: true, ..Default::default() };
                ui.memory_mut(|memory| memory.set_focus_lock_filter(focus.id, arrows));
                let entered = self.list.take_keys(ctx, count, rows as usize - 1, true);
                chosen = entered.then(|| self.list.cursor());
            }
            let has_focus = focus.has_focus();
            let labels: Vec<&str> = std::iter::once("Before all changes").chain(history.labels()).collect();
            let clicked = self.list.show(ui, (count, ROW_HEIGHT, rows * ROW_HEIGHT), |ui, row, rect, response| {
                let label = labels.get(row).copied().unwrap_or_default();
                let values = values_of(row).unwrap_or_default();
                response.widget_info(|| {
                    let name = format!("Step {row}: {label} {values}").trim_end().to_owned();
                    egui::WidgetInfo::selected(egui::Role::ListBoxOption, true, row == done, name)
                });
                let visuals = ui.visuals();
                let color = match row {
                    row if row == done => visuals.strong_text_color(),
                    row if row > done => visuals.text_color().gamma_multiply(0.6),
                    _ => visuals.text_color(),
                };
                let font = TextStyle::Body.resolve(ui.style());
                let painter = ui.painter().with_clip_rect(rect.intersect(ui.clip_rect()));
                if row == done {
                    let dot = rect.left_center() + egui::vec2(10.0, 0.0);
                    painter.circle_filled(dot, 3.0, visuals.hyperlink_color);
                }
                let right = rect.right_center() - egui::vec2(6.0, 0.0);
                let small = TextStyle::Small.resolve(ui.style());
                let taken = painter.text(right, Align2::RIGHT_CENTER, values, small, visuals.weak_text_color());
                let rest = rect.with_max_x(taken.left() - 6.0);
                let painter = painter.with_clip_rect(rest.intersect(ui.clip_rect()));
                painter.text(rect.left_center() + egui::vec2(22.0, 0.0), Align2::LEFT_CENTER, label, font, color);
            });
            if clicked.is_some() {
                focus.request_focus();
            }
            ui.add_space(4.0);
            let hint = if has_focus { "Arrow keys choose, Enter goes there" } else { "Click a step to go there" };
            ui.weak(egui::RichText::new(hint).size(11.5));
            if let Some(steps) = clicked.or(chosen).filter(|steps| *steps != done) {
                commands.push(Action::Jump(steps));
            }
        });
        if !open {
            commands.push(Action::Close(Window::History));
        }
    }
}
