//! The window of the preset's text: the planet as its file says it. What is wrong is underlined where it is.

use super::look;
use crate::editor::command::{Action, ClipAction, Commands, Window};
use crate::editor::state::State;
use crate::planet::{LoadError, Planet, Problem};
use eframe::egui::text::{LayoutJob, TextFormat};
use eframe::egui::{self, FontId, Stroke};
use std::sync::Arc;

/// Name of the text in messages.
const SOURCE: &str = "preset";
/// Most problems that are listed.
const MOST_LISTED: usize = 4;

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("text window")
}

/// The window, and the text in it.
#[derive(Default)]
pub struct TextWindow {
    text: String,
    /// The planet whose text it is, and whether it was changed since.
    of: Option<Arc<Planet>>,
    is_edited: bool,
    problems: Vec<Problem>,
}

impl TextWindow {
    /// Shows the window while it is open. The text follows the planet until somebody types.
    pub fn show(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        if !state.shows.text {
            *self = Self::default();
            return;
        }
        self.follow(state.document.planet());
        let mut open = true;
        let room = ctx.content_rect().size();
        let window = egui::Window::new("Preset text").id(id()).open(&mut open).collapsible(false);
        let window = window.default_pos(look::WINDOW_POS).default_size([480.0, (room.y - 160.0).min(600.0)]);
        window.max_height(room.y - 80.0).show(ctx, |ui| self.content(ui, commands));
        if !open {
            commands.push(Action::Close(Window::Text));
        }
    }

    fn follow(&mut self, planet: &Arc<Planet>) {
        let is_same = self.of.as_ref().is_some_and(|of| Arc::ptr_eq(of, planet));
        if !is_same && !self.is_edited {
            self.text = planet.to_text();
            self.of = Some(planet.clone());
            self.problems.clear();
        }
    }

    fn content(&mut self, ui: &mut egui::Ui, commands: &mut Commands) {
        ui.horizontal(|ui| {
            let can_apply = self.is_edited && self.problems.is_empty();
            let apply = ui.add_enabled(can_apply, egui::Button::new("Apply"));
            let keys = egui::KeyboardShortcut::new(egui::Modifiers::COMMAND, egui::Key::Enter);
            let told = "Make the planet what the text says: one undo step (Ctrl+Enter)";
            let entered = can_apply && ui.input_mut(|input| input.consume_shortcut(&keys));
            if apply.on_hover_text(told).clicked() || entered {
                commands.push(Action::Clip(ClipAction::TakeText(std::mem::take(&mut self.text))));
                (self.is_edited, self.of) = (false, None);
            }
            let discard = ui.add_enabled(self.is_edited, egui::Button::new("Discard"));
            if discard.on_hover_text("Back to the planet's text").clicked() {
                (self.is_edited, self.of) = (false, None);
            }
            let told = match (self.is_edited, self.problems.len()) {
                (false, _) => "The text follows the planet".to_owned(),
                (true, 0) => "Changed".to_owned(),
                (true, 1) => "1 problem".to_owned(),
                (true, count) => format!("{count} problems"),
            };
            ui.weak(told);
        });
        for problem in self.problems.iter().take(MOST_LISTED) {
            ui.add(
                egui::Label::new(egui::RichText::new(problem.to_string()).color(ui.visuals().error_fg_color)).wrap(),
            );
        }
        let (problems, text) = (&self.problems, &mut self.text);
        let mut layouter = |ui: &egui::Ui, text: &dyn egui::TextBuffer, _wrap_width: f32| {
            ui.fonts_mut(|fonts| fonts.layout_job(job(ui, text.as_str(), problems)))
        };
        let area = egui::ScrollArea::both().auto_shrink([false, false]).show(ui, |ui| {
            let edit = egui::TextEdit::multiline(text).code_editor().desired_width(f32::INFINITY);
            ui.add(edit.layouter(&mut layouter)).accessible_name("Text of the preset").changed()
        });
        if area.inner {
            self.is_edited = true;
            self.problems = problems_of(&self.text);
        }
    }
}

fn problems_of(text: &str) -> Vec<Problem> {
    match Planet::from_text(SOURCE, text) {
        Err(LoadError::Invalid { problems, .. }) => problems,
        Ok(_) | Err(LoadError::Read { .. }) => Vec::new(),
    }
}

/// Comments are faint; a line is underlined from where a problem is.
fn job(ui: &egui::Ui, text: &str, problems: &[Problem]) -> LayoutJob {
    let font = FontId { size: 12.5, ..egui::TextStyle::Monospace.resolve(ui.style()) };
    let plain = TextFormat::simple(font.clone(), ui.visuals().text_color());
    let comment = TextFormat::simple(font, ui.visuals().weak_text_color());
    let wrong = TextFormat { underline: Stroke::new(1.5, ui.visuals().error_fg_color), ..plain.clone() };
    let mut job = LayoutJob::default();
    for (number, line) in text.split_inclusive('\n').enumerate() {
        let columns = problems.iter().filter(|problem| problem.line == number + 1).map(|problem| problem.column);
        let begin = columns.min().and_then(|column| line.char_indices().nth(column.saturating_sub(1)));
        // A problem may be behind the last letter of a line: then all of it is marked.
        let has_problem = problems.iter().any(|problem| problem.line == number + 1);
        let (before, after) = line.split_at(begin.map_or(if has_problem { 0 } else { line.len() }, |(at, _)| at));
        let (code, remark) = before.split_at(before.find("//").unwrap_or(before.len()));
        for (part, format) in [(code, &plain), (remark, &comment), (after, &wrong)] {
            if !part.is_empty() {
                job.append(part, 0.0, format.clone());
            }
        }
    }
    job.wrap.max_width = f32::INFINITY;
    job
}
