//! Windows over the window: questions about files, messages, the name of a bookmark, the controls.

use super::answers::{ChangeAnswer, PromptAnswer, ReplaceAnswer};
use super::app::EditorApp;
use super::files::Change;
use super::handle::Action;
use super::{bookmarks, controls};
use eframe::egui;
use std::path::Path;

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
    let answer = if app.files.prompt.is_some() {
        unsaved(ctx, app).map(Action::Answer)
    } else if let Some(replace) = &app.files.replace {
        replaced(ctx, replace.path()).map(Action::Replace)
    } else if let Some(change) = &app.files.change {
        changed(ctx, &app.document.title(), change).map(Action::Change)
    } else if let Some((_, field)) = &mut app.files.path_field {
        field.show(ctx).map(Action::Path)
    } else {
        None
    };
    app.actions.extend(answer);
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

/// A question with a button for each answer; to close it is `cancel`.
fn question<A: Copy>(
    ctx: &egui::Context,
    id: &'static str,
    (heading, lines): (&str, &[String]),
    answers: &[(&str, A)],
    cancel: A,
) -> Option<A> {
    let modal = egui::Modal::new(egui::Id::unique(id)).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading(heading);
        ui.add_space(4.0);
        for line in lines {
            ui.label(line);
        }
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            let clicked = |(text, meaning): &(&str, A)| ui.button(*text).clicked().then_some(*meaning);
            // All of them are shown, whichever was clicked.
            answers.iter().map(clicked).fold(None, Option::or)
        })
        .inner
    });
    if modal.inner.is_none() && modal.should_close() { Some(cancel) } else { modal.inner }
}

fn unsaved(ctx: &egui::Context, app: &EditorApp) -> Option<PromptAnswer> {
    let dirty = app.document.is_dirty();
    let title = app.document.title();
    let here = dirty.then(|| format!("{} has changes that are not in any file.", title.trim_start_matches("• ")));
    let before = app
        .document
        .rolled_over()
        .into_iter()
        .map(|name| format!("{name} had such changes before the random planet; undo brings them back."));
    let lines: Vec<String> = here.into_iter().chain(before).collect();
    let save = ("Save changes", PromptAnswer::Save);
    let rest = [("Discard changes", PromptAnswer::Discard), ("Cancel", PromptAnswer::Cancel)];
    let answers: Vec<_> = dirty.then_some(save).into_iter().chain(rest).collect();
    let heading = if dirty { "Save your changes?" } else { "Lose your changes?" };
    question(ctx, "unsaved work", (heading, &lines), &answers, PromptAnswer::Cancel)
}

fn replaced(ctx: &egui::Context, path: &Path) -> Option<ReplaceAnswer> {
    let lines = [format!("{} exists already. What is in it would be lost.", path.display())];
    let answers = [
        ("Replace", ReplaceAnswer::Replace),
        ("Other name…", ReplaceAnswer::OtherName),
        ("Cancel", ReplaceAnswer::Cancel),
    ];
    question(ctx, "replace file", ("Replace the file?", &lines), &answers, ReplaceAnswer::Cancel)
}

fn changed(ctx: &egui::Context, title: &str, change: &Change) -> Option<ChangeAnswer> {
    let mut lines =
        vec![format!("{} was written by another program since it was read here.", title.trim_start_matches("• "))];
    let mut answers = Vec::new();
    match &change.theirs.planet {
        Ok(_) => {
            lines.push("Reload takes theirs over; undo brings yours back.".to_owned());
            answers.push(("Reload", ChangeAnswer::Reload));
        }
        Err(why) => lines.push(format!("It cannot be read now: {why}")),
    }
    let keep = if change.saving { "Save mine over it" } else { "Keep mine" };
    answers.extend([(keep, ChangeAnswer::KeepMine), ("Save mine as…", ChangeAnswer::SaveAs)]);
    let cancel = if change.saving { "Cancel" } else { "Later" };
    answers.push((cancel, ChangeAnswer::Cancel));
    question(ctx, "changed on disk", ("The file has changed on disk", &lines), &answers, ChangeAnswer::Cancel)
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
