//! A list with a cursor: the keys move the cursor, Enter and the mouse choose. Only the rows in view are laid out.

use eframe::egui::{self, Key, Modifiers, Rect};

/// The cursor of a list.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PickList {
    cursor: usize,
    /// Whether the list must scroll to the cursor.
    scrolls: bool,
}

impl PickList {
    /// Index of the row with the cursor.
    pub fn cursor(&self) -> usize {
        self.cursor
    }

    /// Moves the cursor to a row.
    pub fn set_cursor(&mut self, cursor: usize) {
        (self.cursor, self.scrolls) = (cursor, true);
    }

    /// Takes the keys of the list: arrows, Page up, Page down, and Home and End if `ends`. A page has `page` rows.
    /// Gives whether Enter was pressed.
    pub fn take_keys(&mut self, ctx: &egui::Context, count: usize, page: usize, ends: bool) -> bool {
        let last = count.saturating_sub(1);
        let before = self.cursor.min(last);
        let pressed = |key| ctx.input_mut(|input| input.count_and_consume_key(Modifiers::NONE, key));
        let mut cursor = before;
        // A single step past an end comes out at the other one.
        for _ in 0..pressed(Key::ArrowDown) {
            cursor = if cursor >= last { 0 } else { cursor + 1 };
        }
        for _ in 0..pressed(Key::ArrowUp) {
            cursor = if cursor == 0 { last } else { cursor - 1 };
        }
        cursor = (cursor + page * pressed(Key::PageDown)).min(last);
        cursor = cursor.saturating_sub(page * pressed(Key::PageUp));
        if ends && pressed(Key::Home) > 0 {
            cursor = 0;
        }
        if ends && pressed(Key::End) > 0 {
            cursor = last;
        }
        if cursor != before {
            self.set_cursor(cursor);
        }
        self.cursor = cursor;
        pressed(Key::Enter) > 0
    }

    /// Shows the list, at most `most_high`. `row` paints the row of an index in a rectangle and names it. Gives the row
    /// that was clicked.
    pub fn show(
        &mut self,
        ui: &mut egui::Ui,
        (count, row_height, most_high): (usize, f32, f32),
        mut row: impl FnMut(&egui::Ui, usize, Rect, &egui::Response),
    ) -> Option<usize> {
        self.cursor = self.cursor.min(count.saturating_sub(1));
        ui.spacing_mut().item_spacing.y = 0.0;
        let moves = ui.input(|input| input.pointer.delta() != egui::Vec2::ZERO);
        let mut clicked = None;
        let area = egui::ScrollArea::vertical().max_height(most_high).min_scrolled_height(most_high);
        area.auto_shrink([false, true]).show_rows(ui, row_height, count, |ui, range| {
            let rows = ui.max_rect();
            let at = |index: usize| {
                let y = rows.top() + (index as f32 - range.start as f32) * row_height;
                Rect::from_min_size(egui::pos2(rows.left(), y), egui::vec2(rows.width(), row_height))
            };
            if std::mem::take(&mut self.scrolls) {
                ui.scroll_to_rect_animation(at(self.cursor), None, egui::style::ScrollAnimation::none());
            }
            for index in range.clone() {
                let rect = at(index);
                let response = ui.allocate_rect(rect, egui::Sense::click());
                if response.hovered() && moves {
                    self.cursor = index;
                }
                let background = if self.cursor == index {
                    Some(ui.visuals().selection.bg_fill)
                } else {
                    response.hovered().then_some(ui.visuals().widgets.hovered.weak_bg_fill)
                };
                if let Some(color) = background {
                    ui.painter().rect_filled(rect, 3.0, color);
                }
                row(ui, index, rect, &response);
                if response.clicked() {
                    clicked = Some(index);
                }
            }
        });
        clicked
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn after(keys: &[Key], from: usize) -> (usize, bool) {
        let ctx = egui::Context::default();
        let event = |key: &Key| egui::Event::Key {
            key: *key,
            physical_key: None,
            pressed: true,
            repeat: false,
            modifiers: Modifiers::NONE,
        };
        let input = egui::RawInput { events: keys.iter().map(event).collect(), ..Default::default() };
        let mut list = PickList { cursor: from, scrolls: false };
        let mut entered = false;
        let mut output = ctx.run_ui(input, |ui| entered = list.take_keys(ui.ctx(), 30, 10, true));
        // Nothing is drawn: egui wants to be told so.
        output.textures_delta.clear();
        (list.cursor(), entered)
    }

    #[test]
    fn keys_move_the_cursor_and_stay_in_the_list() {
        assert_eq!(after(&[Key::ArrowDown], 3), (4, false));
        assert_eq!(after(&[Key::ArrowDown, Key::ArrowDown], 28), (0, false));
        assert_eq!(after(&[Key::ArrowUp], 0), (29, false));
        assert_eq!(after(&[Key::PageDown], 25), (29, false));
        assert_eq!(after(&[Key::PageUp], 25), (15, false));
        assert_eq!(after(&[Key::End, Key::Enter], 2), (29, true));
        assert_eq!(after(&[Key::Home], 25), (0, false));
    }
}
