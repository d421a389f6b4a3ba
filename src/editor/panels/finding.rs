//! Finding a parameter in the side panel: a filter over each tab, and the parameter that was searched for.

use super::{Draft, PANELS};
use crate::editor::command::Action;
use crate::editor::widgets::icon::{Icon, icon_button};
use crate::editor::widgets::row_view::{Filter, Revealed};
use crate::planet::param::ParamPath;
use eframe::egui;
use std::rc::Rc;

/// Width of the button that clears a filter, inside the field.
const CLEAR_WIDTH: f32 = 22.0;

/// Filters, and the parameter that was searched for.
#[derive(Default)]
pub struct Finding {
    /// What was typed above each tab.
    texts: [String; PANELS.len()],
    revealed: Option<Rc<Revealed>>,
    wants_focus: bool,
}

impl Finding {
    /// The filter of a tab.
    pub fn filter(&self, tab: usize) -> Filter {
        Filter::new(self.texts.get(tab).map_or("", String::as_str))
    }

    /// The parameter that was searched for, while it is highlighted.
    pub fn revealed(&self) -> Option<Rc<Revealed>> {
        self.revealed.clone()
    }

    /// Lets the time of a frame pass. The parameter that was searched for is forgotten once its highlight has gone.
    pub fn pass_time(&mut self, frame_secs: f64) {
        self.revealed = self.revealed.take().filter(|revealed| !revealed.is_over_after(frame_secs));
    }

    /// Highlights a parameter of a tab. The filter of the tab would hide it.
    pub(super) fn reveal(&mut self, tab: usize, path: ParamPath, name: &'static str) {
        self.clear(tab);
        self.revealed = Some(Rc::new(Revealed::new(path, name)));
    }

    /// Moves the focus to the filter field.
    pub fn take_focus(&mut self) {
        self.wants_focus = true;
    }

    /// Removes the filter of a tab.
    pub fn clear(&mut self, tab: usize) {
        if let Some(text) = self.texts.get_mut(tab) {
            text.clear();
        }
    }

    /// Shows the filter field of a tab.
    pub(super) fn field(&mut self, ui: &mut egui::Ui, tab: usize, label: &str, width: f32) {
        let Some(text) = self.texts.get_mut(tab) else { return };
        let id = egui::Id::unique(("filter", tab));
        let escaped = ui.memory(|memory| memory.had_focus_last_frame(id))
            && ui.input(|input| input.key_pressed(egui::Key::Escape));
        if escaped {
            text.clear();
        }
        let hint = format!("Filter {}", label.to_lowercase());
        let margin = egui::Margin { right: CLEAR_WIDTH as i8, ..egui::Margin::symmetric(4, 2) };
        let edit = egui::TextEdit::singleline(text).id(id).hint_text(hint).margin(margin);
        let field = ui.add(edit.desired_width(width));
        let field = field.accessible_name(format!("Filter of {label}"));
        if std::mem::take(&mut self.wants_focus) {
            field.request_focus();
        }
        let told = "Show all parameters again (Escape)";
        let right = egui::Rect::from_min_max(field.rect.right_top() - egui::vec2(CLEAR_WIDTH, 0.0), field.rect.max);
        if !text.is_empty() {
            let mut inside = ui.new_child(egui::UiBuilder::new().max_rect(right));
            if icon_button(&mut inside, Icon::Close, "Clear filter", told).clicked() {
                text.clear();
            }
        }
    }

    /// Says so if the filter of the tab hides every row.
    pub(super) fn tell_if_empty(&self, ui: &mut egui::Ui, tab: usize, draft: &mut Draft<'_>) {
        let filter = draft.shown.filter;
        let (true, 0, Some(text)) = (filter.is_active(), filter.passed(), self.texts.get(tab)) else { return };
        ui.add_space(12.0);
        ui.vertical_centered(|ui| {
            ui.weak(format!("No parameter matches \u{201c}{}\u{201d} here.", text.trim()));
            if ui.button("Search everywhere").on_hover_text("Open the finder").clicked() {
                draft.commands.push(Action::Search(text.clone()));
            }
        });
    }
}
