//! The window that asks for a location to go to.

use crate::editor::command::{Action, Commands, Window};
use crate::editor::finder::place;
use crate::editor::state::State;
use crate::editor::widgets::select_all;
use eframe::egui;

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("place window")
}

/// The window, and the text in it.
#[derive(Default)]
pub struct PlaceWindow {
    open: bool,
    text: String,
    /// Whether the user has asked to go to this text: what is wrong with it is red from then on.
    asked: bool,
}

impl PlaceWindow {
    /// Shows the window while it is open. The last text stays for the next time.
    pub fn show(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        let opens = state.shows.place && !self.open;
        self.open = state.shows.place;
        let mut open = self.open;
        let window = egui::Window::new("Go to place").id(id()).open(&mut open).collapsible(false).resizable(false);
        window.anchor(egui::Align2::CENTER_TOP, [0.0, 60.0]).show(ctx, |ui| {
            ui.set_width(340.0_f32.min(ctx.content_rect().width() - 60.0));
            self.content(ui, opens, commands);
        });
        if open != self.open {
            commands.push(Action::Close(Window::Place));
        }
    }

    fn content(&mut self, ui: &mut egui::Ui, opens: bool, commands: &mut Commands) {
        let label = ui.label("Latitude, longitude, and the altitude if you like");
        let (field, goes) = ui
            .horizontal(|ui| {
                let edit = egui::TextEdit::singleline(&mut self.text).id(id().with("field"));
                let edit = edit.hint_text("12.5 N 45 W @ 400 km").desired_width(ui.available_width() - 44.0);
                let field = ui.add(edit).labelled_by(label.id);
                (field, ui.button("Go").on_hover_text("Fly there (Enter)").clicked())
            })
            .inner;
        if opens {
            field.request_focus();
            select_all(&field);
        }
        if field.changed() {
            self.asked = false;
        }
        let pressed = |key| ui.input(|input| input.key_pressed(key));
        if field.lost_focus() && pressed(egui::Key::Escape) {
            commands.push(Action::Close(Window::Place));
            return;
        }
        let read = place::read(&self.text);
        if goes || (field.lost_focus() && pressed(egui::Key::Enter)) {
            self.asked = true;
            match &read {
                Ok(place) => commands.push(Action::GoToPlace(*place)),
                Err(_) => field.request_focus(),
            }
        }
        match read {
            Ok(place) => ui.weak(place.to_string()),
            Err(why) if self.asked => ui.colored_label(ui.visuals().error_fg_color, why),
            Err(_) if self.text.trim().is_empty() => ui.weak("Also 12.5, -45 or 12°30'N 45°W"),
            Err(why) => ui.weak(why),
        };
    }
}
