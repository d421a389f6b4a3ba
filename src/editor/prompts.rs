//! Windows over the window: unsaved work, messages, the name of a bookmark, the controls.

use super::app::EditorApp;
use super::files::PromptAnswer;
use super::handle::Action;
use super::{bookmarks, controls};
use eframe::egui;

/// Something went wrong; shown until dismissed.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Message {
    /// What happened.
    pub title: String,
    /// Everything there is to say about it.
    pub lines: Vec<String>,
}

/// Shows whatever is open.
pub fn show(ctx: &egui::Context, app: &mut EditorApp) {
    if app.files.prompt.is_some()
        && let Some(answer) = unsaved(ctx, &app.document.title())
    {
        app.actions.push(Action::Answer(answer));
    }
    if let Some(orphan) = app.orphans.first()
        && !app.document.is_dirty()
        && let Some(keep) = recover(ctx, &orphan.planet.name)
    {
        app.actions.push(Action::Recover(keep));
    }
    if let Some(message) = app.messages.first()
        && dismissed(ctx, message)
    {
        app.messages.remove(0);
        ctx.request_repaint();
    }
    bookmarks::rename_window(ctx, app);
    controls::show(ctx, &mut app.show_controls);
}

fn unsaved(ctx: &egui::Context, title: &str) -> Option<PromptAnswer> {
    let modal = egui::Modal::new(egui::Id::unique("unsaved work")).show(ctx, |ui| {
        ui.set_width(360.0);
        ui.heading("Save your changes?");
        ui.add_space(4.0);
        ui.label(format!("{} has changes that are not in any file.", title.trim_start_matches("• ")));
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            let mut answer = None;
            for (text, meaning) in [
                ("Save changes", PromptAnswer::Save),
                ("Discard changes", PromptAnswer::Discard),
                ("Cancel", PromptAnswer::Cancel),
            ] {
                if ui.button(text).clicked() {
                    answer = Some(meaning);
                }
            }
            answer
        })
        .inner
    });
    if modal.inner.is_none() && modal.should_close() { Some(PromptAnswer::Cancel) } else { modal.inner }
}

fn recover(ctx: &egui::Context, name: &str) -> Option<bool> {
    // No way out but an answer: a click beside it must not throw work away.
    let modal = egui::Modal::new(egui::Id::unique("recover work")).show(ctx, |ui| {
        ui.set_width(360.0);
        ui.heading("Recover unsaved work?");
        ui.add_space(4.0);
        ui.label(format!("{name} was being edited when the editor stopped without saving it."));
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            if ui.button("Recover").clicked() {
                Some(true)
            } else if ui.button("Throw away").clicked() {
                Some(false)
            } else {
                None
            }
        })
        .inner
    });
    modal.inner
}

fn dismissed(ctx: &egui::Context, message: &Message) -> bool {
    let modal = egui::Modal::new(egui::Id::unique("message")).show(ctx, |ui| {
        ui.set_width(560.0);
        ui.heading(&message.title);
        ui.add_space(4.0);
        egui::ScrollArea::vertical().max_height(280.0).show(ui, |ui| {
            for line in &message.lines {
                ui.add(egui::Label::new(egui::RichText::new(line).monospace()).wrap().selectable(true));
            }
        });
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            if ui.button("Copy").clicked() {
                ctx.copy_text(message.lines.join("\n"));
            }
            ui.button("Dismiss").clicked()
        })
        .inner
    });
    modal.inner || modal.should_close()
}
