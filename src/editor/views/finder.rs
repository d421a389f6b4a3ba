//! The finder: one field, and below it everything that fits what is typed. Locations can be typed too.

use crate::editor::command::{Action, Commands, Window};
use crate::editor::finder::entries::{self, Entry, Found};
use crate::editor::finder::place;
use crate::editor::state::State;
use crate::editor::widgets::pick_list::PickList;
use eframe::egui::{self, Color32, FontId, Rect, TextFormat, TextStyle};

/// Most actions that are remembered as used.
const MOST_USED: usize = 8;
/// Width of the window and height of a row, in points.
const WIDTH: f32 = 560.0;
const ROW_HEIGHT: f32 = 24.0;
/// Size of the place and the hint of an entry, in points.
const SMALL: f32 = 11.5;
/// Most rows in view.
const MOST_ROWS: f32 = 14.0;

/// The window. It makes its list when it opens, and searches when the text changes.
#[derive(Default)]
pub struct FinderWindow {
    open: bool,
    text: String,
    /// The text for which `found` was searched.
    searched: Option<String>,
    entries: Vec<Entry>,
    found: Vec<Found>,
    list: PickList,
    /// The keys of what was chosen here, the latest first.
    used: Vec<String>,
}

impl FinderWindow {
    /// A window that knows what was used lately: a key on each line, the latest first.
    pub fn with_used(text: &str) -> Self {
        Self { used: text.lines().take(MOST_USED).map(str::to_owned).collect(), ..Self::default() }
    }

    /// What was used lately, as text to be kept between runs.
    pub fn used(&self) -> String {
        self.used.join("\n")
    }

    /// Shows the window while it is open.
    pub fn show(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        if !state.shows.finder {
            *self = Self { used: std::mem::take(&mut self.used), ..Self::default() };
            return;
        }
        let opens = !std::mem::replace(&mut self.open, true);
        if opens {
            self.text.clone_from(&state.search);
            self.entries = entries::list(state, ctx);
        }
        let escaped = ctx.input_mut(|input| input.consume_key(egui::Modifiers::NONE, egui::Key::Escape));
        self.search();
        let room = ctx.content_rect();
        let rows = MOST_ROWS.min(((room.height() - 140.0) / ROW_HEIGHT).floor()).max(3.0);
        let entered = self.list.take_keys(ctx, self.found.len(), rows as usize - 1, false);
        let area = egui::Area::new(egui::Id::unique("finder"))
            .anchor(egui::Align2::CENTER_TOP, [0.0, 36.0])
            .order(egui::Order::Foreground);
        let shown = area.show(ctx, |ui| {
            let frame = egui::Frame::window(ui.style()).shadow(egui::Shadow {
                offset: [0, 6],
                blur: 24,
                spread: 0,
                color: Color32::from_black_alpha(110),
            });
            frame.show(ui, |ui| {
                ui.set_width(WIDTH.min(room.width() - 40.0));
                self.field(ui);
                self.search();
                ui.add_space(4.0);
                self.rows(ui, rows * ROW_HEIGHT)
            })
        });
        let chosen = shown.inner.inner.or(entered.then(|| self.list.cursor()));
        let action = chosen.and_then(|row| self.found.get(row)).and_then(|found| self.entries.get(found.entry));
        let beside = !opens
            && ctx.input(|input| {
                input.pointer.any_pressed()
                    && input.pointer.interact_pos().is_some_and(|pos| !shown.response.rect.contains(pos))
            });
        if let Some((action, key)) =
            action.filter(|entry| entry.enabled).map(|entry| (entry.action.clone(), entry.key()))
        {
            self.used.retain(|used| *used != key);
            self.used.insert(0, key);
            self.used.truncate(MOST_USED);
            commands.push(Action::Close(Window::Finder));
            commands.push(action);
        } else if escaped || beside || ctx.memory(|memory| memory.top_modal_layer().is_some()) {
            // A question that opens meanwhile needs the focus.
            commands.push(Action::Close(Window::Finder));
        }
    }

    /// The field. It keeps the focus: the keys of the list work while one types.
    fn field(&mut self, ui: &mut egui::Ui) {
        let edit = egui::TextEdit::singleline(&mut self.text)
            .id(egui::Id::unique("finder field"))
            .hint_text("Find a command, planet or parameter; set one: sea level 400; or go: 12.5 N 45 W")
            .font(FontId::proportional(15.0))
            .margin(egui::Margin::symmetric(8, 6))
            .desired_width(f32::INFINITY);
        let field = ui.add(edit).accessible_name("Find anything");
        if !field.has_focus() {
            field.request_focus();
        }
    }

    fn search(&mut self) {
        if self.searched.as_ref() == Some(&self.text) {
            return;
        }
        // The entries of numbers and of a location are made for the text, and come first.
        self.entries.retain(|entry| !matches!(entry.action, Action::GoToPlace(_) | Action::SetNumber(..)));
        self.found = entries::search(&self.entries, &self.text, &self.used);
        for setting in entries::settings(&self.entries, &self.text).into_iter().rev() {
            self.found.insert(0, Found { entry: self.entries.len(), letters: Vec::new() });
            self.entries.push(setting);
        }
        if let Ok(place) = place::read(&self.text) {
            self.found.insert(0, Found { entry: self.entries.len(), letters: Vec::new() });
            self.entries.push(Entry::of_place(place));
        }
        self.searched = Some(self.text.clone());
        self.list.set_cursor(0);
    }

    /// The rows. Gives the one that was clicked.
    fn rows(&mut self, ui: &mut egui::Ui, most_high: f32) -> Option<usize> {
        if self.found.is_empty() {
            ui.add_space(8.0);
            ui.vertical_centered(|ui| ui.weak("Nothing has this name."));
            ui.add_space(8.0);
            return None;
        }
        let (entries, found) = (&self.entries, &self.found);
        let cursor = self.list.cursor();
        self.list.show(ui, (found.len(), ROW_HEIGHT, most_high), |ui, row, rect, response| {
            let Some((found, entry)) = found.get(row).and_then(|found| Some((found, entries.get(found.entry)?))) else {
                return;
            };
            response.widget_info(|| {
                let name = entry.accessible_name();
                egui::WidgetInfo::selected(egui::Role::ListBoxOption, entry.enabled, cursor == row, name)
            });
            paint(ui, entry, &found.letters, rect, cursor == row);
        })
    }
}

/// Paints an entry: its name with the typed letters marked, its place, and its hint at the right. The row with the
/// cursor has a background on which a line marks better than a colour.
fn paint(ui: &egui::Ui, entry: &Entry, letters: &[usize], rect: Rect, has_cursor: bool) {
    let visuals = ui.visuals();
    let (body, small) = (TextStyle::Body.resolve(ui.style()), FontId::proportional(SMALL));
    let weak = if entry.enabled { visuals.text_color().gamma_multiply(0.85) } else { visuals.weak_text_color() };
    let plain = if entry.enabled { visuals.strong_text_color() } else { weak };
    let colored = if visuals.dark_mode { visuals.hyperlink_color } else { visuals.selection.stroke.color };
    let marked = if entry.enabled && !has_cursor { colored } else { plain };
    let line = egui::Stroke::new(if has_cursor { 1.0 } else { 0.0 }, marked);
    let inner = rect.shrink2(egui::vec2(8.0, 0.0));
    let hint = ui.painter().layout_no_wrap(entry.hint.clone(), small.clone(), weak);
    let hint_width = hint.size().x;
    let wrap = egui::text::TextWrapping::truncate_at_width(inner.width() - hint_width - 16.0);
    let mut job = egui::text::LayoutJob { wrap, ..Default::default() };
    let mut buffer = [0; 4];
    let plain_format = TextFormat { valign: egui::Align::Center, ..TextFormat::simple(body, plain) };
    let marked_format = TextFormat { color: marked, underline: line, ..plain_format.clone() };
    for (index, letter) in entry.name.chars().enumerate() {
        let format = if letters.contains(&index) { &marked_format } else { &plain_format };
        job.append(letter.encode_utf8(&mut buffer), 0.0, format.clone());
    }
    let place = TextFormat { valign: egui::Align::Center, ..TextFormat::simple(small, weak) };
    job.append(&entry.place, 10.0, place);
    let text = ui.painter().layout_job(job);
    let middle = |height: f32| inner.center().y - 0.5 * height;
    ui.painter().galley(egui::pos2(inner.left(), middle(text.size().y)), text, plain);
    let left = inner.right() - hint_width;
    ui.painter().galley(egui::pos2(left, middle(hint.size().y)), hint, weak);
}
