//! Asks for the name of a bookmark.

use crate::editor::command::BookmarkAction;
use eframe::egui;

/// A name that is being typed.
pub(super) struct RenameField {
    index: usize,
    name: String,
}

impl RenameField {
    /// Starts with the name of the bookmark of this index.
    pub(super) fn new(index: usize, name: &str) -> Self {
        Self { index, name: name.to_owned() }
    }

    /// Whether the name is for the bookmark of this index.
    pub(super) fn is_for(&self, index: usize) -> bool {
        self.index == index
    }

    /// Shows the field; gives the action that ends it.
    pub(super) fn show(&mut self, ctx: &egui::Context) -> Option<BookmarkAction> {
        let modal = egui::Modal::new(egui::Id::unique("rename bookmark")).show(ctx, |ui| {
            ui.set_width(280.0);
            let heading = ui.heading("Name of the view");
            ui.add_space(4.0);
            let field = ui.add(egui::TextEdit::singleline(&mut self.name).char_limit(64)).labelled_by(heading.id);
            let entered = field.lost_focus() && ui.input(|input| input.key_pressed(egui::Key::Enter));
            if !field.has_focus() && !entered {
                field.request_focus();
            }
            ui.add_space(8.0);
            ui.horizontal(|ui| {
                let is_name = !self.name.trim().is_empty();
                let named = ui.add_enabled(is_name, egui::Button::new("Rename")).clicked();
                (named || (entered && is_name), ui.button("Cancel").clicked())
            })
            .inner
        });
        let (named, cancelled) = modal.inner;
        if named {
            return Some(BookmarkAction::Rename(self.index, self.name.trim().to_owned()));
        }
        (cancelled || modal.should_close()).then_some(BookmarkAction::CancelName)
    }
}
