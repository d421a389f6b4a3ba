//! Questions and messages in front of the window.

use super::differences;
use super::path_field::PathField;
use super::rename::RenameField;
use crate::editor::command::{Action, Answer, ChangeAnswer, Commands, RecoverAnswer, ReplaceAnswer, UnsavedAnswer};
use crate::editor::state::document::Document;
use crate::editor::state::questions::{Change, Goal, Work};
use crate::editor::state::recovery::Orphan;
use crate::editor::state::{Message, State};
use eframe::egui;
use std::path::Path;

/// Texts that are being typed into questions.
#[derive(Default)]
pub struct Prompts {
    path: Option<PathField>,
    rename: Option<RenameField>,
}

impl Prompts {
    /// Shows the questions and messages that are open.
    pub fn show(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        commands.extend(self.question(ctx, state).map(Action::Answer));
        if let Some(orphan) = state.orphans.first()
            && !state.document.is_dirty()
            && let Some(answer) = recover(ctx, orphan)
        {
            commands.push(Action::Answer(Answer::Recover(answer)));
        }
        if let Some(message) = state.messages.first()
            && dismissed(ctx, message)
        {
            commands.push(Action::DismissMessage);
        }
        self.rename_bookmark(ctx, state, commands);
    }

    /// The question about files that comes first.
    fn question(&mut self, ctx: &egui::Context, state: &State) -> Option<Answer> {
        let questions = &state.questions;
        self.path = self.path.take().filter(|field| questions.path.as_ref().is_some_and(|wanted| field.is_for(wanted)));
        if let Some((work, goal)) = &questions.unsaved {
            match work {
                Work::Planet => unsaved(ctx, state, goal),
                Work::System => unsaved_system(ctx, state, goal),
            }
            .map(Answer::Unsaved)
        } else if let Some(replace) = &questions.replace {
            replaced(ctx, replace.path()).map(Answer::Replace)
        } else if let Some(change) = &questions.change {
            changed(ctx, &state.document, change).map(Answer::Change)
        } else if let Some(wanted) = &questions.path {
            self.path.get_or_insert_with(|| PathField::new(wanted)).show(ctx).map(Answer::Path)
        } else {
            None
        }
    }

    fn rename_bookmark(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        let bookmark = state.renaming.and_then(|index| Some((index, state.document.bookmarks().get(index)?)));
        let Some((index, bookmark)) = bookmark else {
            self.rename = None;
            return;
        };
        let field = self.rename.take().filter(|field| field.is_for(index));
        let field = self.rename.insert(field.unwrap_or_else(|| RenameField::new(index, &bookmark.name)));
        commands.extend(field.show(ctx).map(Action::Bookmark));
    }
}

/// A question with a button for each answer; closing it answers `cancel`, Enter answers `enter`.
fn question<A: Copy + PartialEq>(
    ctx: &egui::Context,
    id: &'static str,
    (heading, lines): (&str, &[String]),
    answers: &[(&str, A)],
    (enter, cancel): (A, A),
) -> Option<A> {
    let content = |ui: &mut egui::Ui| lines.iter().for_each(|line| drop(ui.label(line)));
    question_about(ctx, id, heading, content, answers, (enter, cancel))
}

/// A question over any content.
fn question_about<A: Copy + PartialEq>(
    ctx: &egui::Context,
    id: &'static str,
    heading: &str,
    content: impl FnOnce(&mut egui::Ui),
    answers: &[(&str, A)],
    (enter, cancel): (A, A),
) -> Option<A> {
    let modal = egui::Modal::new(egui::Id::unique(id)).show(ctx, |ui| {
        ui.set_width(400.0);
        ui.heading(heading);
        ui.add_space(4.0);
        content(ui);
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            let clicked = |(text, meaning): &(&str, A)| {
                let button = ui.button(*text);
                if *meaning == enter {
                    take_enter(&button);
                }
                button.clicked().then_some(*meaning)
            };
            // The fold shows all buttons, also those after the clicked one.
            answers.iter().map(clicked).fold(None, Option::or)
        })
        .inner
    });
    // A click beside the question answers nothing.
    let closes = !modal.backdrop_response.clicked() && modal.should_close();
    if modal.inner.is_none() && closes { Some(cancel) } else { modal.inner }
}

/// Gives the button of a question the focus, so that Enter presses it, while nothing of the question has it.
fn take_enter(button: &egui::Response) {
    if button.ctx.memory(|memory| memory.focused().is_none()) {
        button.request_focus();
    }
}

fn unsaved(ctx: &egui::Context, state: &State, goal: &Goal) -> Option<UnsavedAnswer> {
    let dirty = state.document.is_dirty();
    let title = state.document.title();
    let here = dirty.then(|| format!("{} has unsaved changes.", title.trim_start_matches("• ")));
    let before = state
        .document
        .rolled_over()
        .into_iter()
        .map(|name| format!("{name} had unsaved changes before the random planet; undo brings them back."));
    let lines: Vec<String> = here.into_iter().chain(before).chain([follows(state, goal)]).collect();
    let save = ("Save changes", UnsavedAnswer::Save);
    let rest = [("Discard changes", UnsavedAnswer::Discard), ("Cancel", UnsavedAnswer::Cancel)];
    let answers: Vec<_> = dirty.then_some(save).into_iter().chain(rest).collect();
    let heading = if dirty { "Save your changes?" } else { "Lose your changes?" };
    let enter = if dirty { UnsavedAnswer::Save } else { UnsavedAnswer::Cancel };
    question(ctx, "unsaved work", (heading, &lines), &answers, (enter, UnsavedAnswer::Cancel))
}

fn unsaved_system(ctx: &egui::Context, state: &State, goal: &Goal) -> Option<UnsavedAnswer> {
    let name = state.system.as_ref().map_or("", |system| &system.system().name);
    let lines = [format!("The system {name} has unsaved changes."), follows(state, goal)];
    let answers = [
        ("Save changes", UnsavedAnswer::Save),
        ("Discard changes", UnsavedAnswer::Discard),
        ("Cancel", UnsavedAnswer::Cancel),
    ];
    let enter_cancel = (UnsavedAnswer::Save, UnsavedAnswer::Cancel);
    question(ctx, "unsaved system", ("Save your changes?", &lines), &answers, enter_cancel)
}

/// What follows the answer.
fn follows(state: &State, goal: &Goal) -> String {
    let body = |body: usize| state.system.as_ref().and_then(|open| open.system().bodies.get(body));
    match goal {
        Goal::Begin(_) => "Then a new planet begins.".to_owned(),
        Goal::Open => "Then a file is chosen.".to_owned(),
        Goal::OpenPath(path) => format!("Then {} opens.", path.file_name().unwrap_or_default().display()),
        Goal::OpenShipped(_) => "Then a planet of the library opens.".to_owned(),
        Goal::Visit(to, _) => match body(*to) {
            Some(body) => format!("Then {} opens.", body.name),
            None => "Then the planet of another body opens.".to_owned(),
        },
        Goal::OpenSystem(_) => "Then another system opens.".to_owned(),
        Goal::BeginSystem => "Then a new system begins.".to_owned(),
        Goal::LeaveSystem => "Then the system closes.".to_owned(),
        Goal::Quit => "Then the editor ends.".to_owned(),
    }
}

fn replaced(ctx: &egui::Context, path: &Path) -> Option<ReplaceAnswer> {
    let lines = [format!("{} exists already. Its content would be lost.", path.display())];
    let answers = [
        ("Replace", ReplaceAnswer::Replace),
        ("Other name…", ReplaceAnswer::OtherName),
        ("Cancel", ReplaceAnswer::Cancel),
    ];
    let enter_cancel = (ReplaceAnswer::Cancel, ReplaceAnswer::Cancel);
    question(ctx, "replace file", ("Replace the file?", &lines), &answers, enter_cancel)
}

fn changed(ctx: &egui::Context, document: &Document, change: &Change) -> Option<ChangeAnswer> {
    let title = document.title();
    let mut lines =
        vec![format!("Another program has written {} since it was opened here.", title.trim_start_matches("• "))];
    let mut answers = Vec::new();
    match &change.theirs.planet {
        Ok(_) => {
            lines.push("Reload takes the file; undo brings yours back.".to_owned());
            answers.push(("Reload", ChangeAnswer::Reload));
        }
        Err(why) => lines.push(format!("The file cannot be read now: {why}")),
    }
    let keep = if change.saving { "Save mine over it" } else { "Keep mine" };
    answers.extend([(keep, ChangeAnswer::KeepMine), ("Save mine as…", ChangeAnswer::SaveAs)]);
    let cancel = if change.saving { "Cancel" } else { "Later" };
    answers.push((cancel, ChangeAnswer::Cancel));
    let content = |ui: &mut egui::Ui| {
        lines.iter().for_each(|line| drop(ui.label(line)));
        if let Ok(theirs) = &change.theirs.planet {
            listed(ui, &differences::lines(document.planet(), theirs));
        }
    };
    let heading = "The file has changed on disk";
    let enter_cancel = (ChangeAnswer::Cancel, ChangeAnswer::Cancel);
    question_about(ctx, "changed on disk", heading, content, &answers, enter_cancel)
}

/// A list that is folded at first.
fn listed(ui: &mut egui::Ui, differences: &[String]) {
    let count = differences.len();
    let heading =
        format!("Show the {}", if count == 1 { "difference".to_owned() } else { format!("{count} differences") });
    egui::CollapsingHeader::new(heading).id_salt("differences").show(ui, |ui| {
        egui::ScrollArea::vertical().max_height(180.0).auto_shrink([false, true]).show(ui, |ui| {
            differences.iter().for_each(|line| drop(ui.add(egui::Label::new(line).wrap())));
        });
    });
}

/// What a working copy holds, in words.
fn named(orphan: &Orphan) -> String {
    let planet = orphan.planet.as_ref().map(|(planet, _)| planet.name.as_str());
    let system = orphan.system.as_ref().map(|(system, _)| format!("the system {}", system.name));
    let names: Vec<String> = planet.map(str::to_owned).into_iter().chain(system).collect();
    names.join(" and ")
}

/// The file that unsaved work belongs to, and the time since it was kept.
fn origin(orphan: &Orphan) -> Vec<String> {
    let planet_file = orphan.planet.as_ref().and_then(|(_, file)| file.as_ref());
    let system_file = orphan.system.as_ref().and_then(|(_, file)| file.as_ref());
    let file = match planet_file.or(system_file) {
        Some(file) => format!("It belongs to {}.", file.display()),
        None => "It belongs to no file yet.".to_owned(),
    };
    let ago = orphan.kept.and_then(|kept| kept.elapsed().ok());
    std::iter::once(file).chain(ago.map(|ago| format!("It was kept {} ago.", time_text(ago)))).collect()
}

/// A time in its largest unit.
fn time_text(time: std::time::Duration) -> String {
    let secs = time.as_secs();
    let (count, unit) = match secs {
        0..60 => (secs, "second"),
        60..3600 => (secs / 60, "minute"),
        3600..86_400 => (secs / 3600, "hour"),
        _ => (secs / 86_400, "day"),
    };
    format!("{count} {unit}{}", if count == 1 { "" } else { "s" })
}

fn recover(ctx: &egui::Context, orphan: &Orphan) -> Option<RecoverAnswer> {
    // Only an answer closes the question: a click beside it must not delete work.
    let modal = egui::Modal::new(egui::Id::unique("recover work")).show(ctx, |ui| {
        ui.set_width(360.0);
        ui.heading("Recover unsaved work?");
        ui.add_space(4.0);
        ui.label(format!("The editor stopped without saving {}.", named(orphan)));
        origin(orphan).iter().for_each(|line| drop(ui.label(line)));
        ui.add_space(12.0);
        ui.horizontal(|ui| {
            let later = "It is offered again at the next start";
            let recover = ui.button("Recover");
            take_enter(&recover);
            if recover.clicked() {
                Some(RecoverAnswer::Recover)
            } else if ui.button("Not now").on_hover_text(later).clicked() {
                Some(RecoverAnswer::Later)
            } else if ui.button("Delete").clicked() {
                Some(RecoverAnswer::Delete)
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
            let dismiss = ui.button("Dismiss");
            take_enter(&dismiss);
            dismiss.clicked()
        })
        .inner
    });
    modal.inner || modal.should_close()
}
