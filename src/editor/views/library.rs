//! The library window: planets and parts with small pictures. A click opens a planet or takes a part; either can be
//! dragged onto the planet, which takes it as an undo step.

use super::look;
use crate::editor::command::{Action, Commands, LibraryAction, Window};
use crate::editor::files::library::{PARTS, read_tags};
use crate::editor::state::State;
use crate::editor::state::shelf::{Item, Origin};
use crate::editor::widgets::menu_button;
use crate::editor::widgets::planet_button::planet_button;
use crate::planet::snippet;
use eframe::egui;

/// Width and height of a picture, points.
const SIDE: f32 = 104.0;
/// Size of the text of a name, points.
const NAME_SIZE: f32 = 11.5;
/// Words that narrow the list down with a click.
const TAGS: [&str; 7] = ["library", "recent", "shipped", "part", "sea", "rivers", "airless"];

/// The item that is dragged.
#[derive(Clone, Copy)]
struct Dragged(usize);

/// The window, with what was typed into it.
#[derive(Default)]
pub struct LibraryWindow {
    text: String,
    naming: Option<Naming>,
}

/// The name and the tags that are being typed for an item.
struct Naming {
    index: usize,
    name: String,
    tags: String,
    begun: bool,
}

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("library window")
}

impl LibraryWindow {
    /// Shows the window while it is open.
    pub fn show(&mut self, ctx: &egui::Context, state: &State, commands: &mut Commands) {
        if !state.shows.library {
            self.naming = None;
            return;
        }
        let mut open = true;
        let window = egui::Window::new("Library").id(id()).open(&mut open).default_pos(look::WINDOW_POS);
        let shown = window.default_size([470.0, 520.0]).min_size([260.0, 200.0]).show(ctx, |ui| {
            self.head(ui, state, commands);
            ui.separator();
            let found = state.shelf.found(&self.text);
            if found.is_empty() {
                ui.weak("Nothing here has all of these words.");
            }
            egui::ScrollArea::vertical().auto_shrink([false, false]).show(ui, |ui| {
                ui.spacing_mut().item_spacing = egui::vec2(8.0, 6.0);
                let columns = ((ui.available_width() + 8.0) / (SIDE + 8.0)).floor().max(1.0) as usize;
                for row in found.chunks(columns) {
                    ui.horizontal_top(|ui| {
                        for index in row {
                            if cell(ui, state, *index, commands) {
                                self.naming = state.shelf.items.get(*index).map(|item| Naming::of(*index, item));
                            }
                        }
                    });
                }
            });
        });
        if let Some(naming) = &mut self.naming {
            let ended = naming.show(ctx);
            if let Some(named) = ended {
                commands.extend(named.map(Action::Library));
                self.naming = None;
            }
        }
        if let Some(shown) = shown {
            drop_on_planet(ctx, state, shown.response.rect, commands);
        }
        if !open {
            commands.push(Action::Close(Window::Library));
        }
    }

    fn head(&mut self, ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
        ui.horizontal(|ui| {
            let width = (ui.available_width() - 110.0).max(80.0);
            let edit = egui::TextEdit::singleline(&mut self.text).hint_text("Search").desired_width(width);
            ui.add(edit).accessible_name("Search the library");
            menu_button(ui, "Keep …", |ui| {
                for (part, label) in PARTS {
                    let has = part.is_empty() || snippet::of_part(state.document.valid_planet(), part).is_some();
                    let text = if part.is_empty() { "This planet".to_owned() } else { format!("Its {label}") };
                    let button = ui.add_enabled(has, egui::Button::new(text));
                    if button.on_disabled_hover_text("This planet has none").clicked() {
                        commands.push(Action::Library(LibraryAction::Keep(part)));
                        ui.close();
                    }
                }
            });
        });
        ui.horizontal_wrapped(|ui| {
            for tag in TAGS.into_iter().chain(state.shelf.own_tags()) {
                let mut words: Vec<&str> = self.text.split_whitespace().collect();
                let on = words.contains(&tag);
                if ui.selectable_label(on, tag).clicked() {
                    if on {
                        words.retain(|word| *word != tag);
                    } else {
                        words.push(tag);
                    }
                    self.text = words.join(" ");
                }
            }
        });
    }
}

impl Naming {
    fn of(index: usize, item: &Item) -> Self {
        Self { index, name: item.name.clone(), tags: item.own_tags.join(", "), begun: false }
    }

    /// Shows the fields. When they end, the action, or an inner None if they were cancelled.
    fn show(&mut self, ctx: &egui::Context) -> Option<Option<LibraryAction>> {
        let modal = egui::Modal::new(egui::Id::unique("name in the library")).show(ctx, |ui| {
            ui.set_width(300.0);
            let label = ui.label("Name");
            let name = ui.add(egui::TextEdit::singleline(&mut self.name).char_limit(64)).labelled_by(label.id);
            let label = ui.label("Tags, between commas");
            let tags = egui::TextEdit::singleline(&mut self.tags).hint_text("moon, for the second act");
            let tags = ui.add(tags.char_limit(200)).labelled_by(label.id);
            if !std::mem::replace(&mut self.begun, true) {
                tags.request_focus();
            }
            let entered = (name.lost_focus() || tags.lost_focus()) && ui.input(|i| i.key_pressed(egui::Key::Enter));
            ui.add_space(8.0);
            ui.horizontal(|ui| (ui.button("Keep").clicked() || entered, ui.button("Cancel").clicked())).inner
        });
        let (keeps, cancels) = modal.inner;
        let named = || LibraryAction::Label(self.index, self.name.clone(), read_tags(&self.tags));
        if keeps {
            return Some(Some(named()));
        }
        (cancels || modal.should_close()).then_some(None)
    }
}

/// Shows an item. Gives whether its name and tags are to be asked for.
fn cell(ui: &mut egui::Ui, state: &State, index: usize, commands: &mut Commands) -> bool {
    let (Some(item), Some(cell)) = (state.shelf.items.get(index), state.shelf.sheet.cells.get(index)) else {
        return false;
    };
    let mut names = false;
    ui.vertical(|ui| {
        ui.set_width(SIDE);
        let button = planet_button(ui, cell, &item.name, &told(item), SIDE);
        button.dnd_set_drag_payload(Dragged(index));
        if button.clicked() {
            commands.push(Action::Library(LibraryAction::Open(index)));
        }
        button.context_menu(|ui| {
            let entries = [
                ("Open", "As a document of its own", LibraryAction::Open(index), item.part.is_empty()),
                ("Take into this planet", "One undo step", LibraryAction::Take(index), true),
                ("Remove from library", "It moves to a folder beside", LibraryAction::Remove(index), is_kept(item)),
            ];
            for (label, told, action, _) in entries.into_iter().filter(|(.., possible)| *possible) {
                if ui.button(label).on_hover_text(told).clicked() {
                    commands.push(Action::Library(action));
                    ui.close();
                }
            }
            if is_kept(item) && ui.button("Name and tags…").on_hover_text("Words that find it").clicked() {
                names = true;
                ui.close();
            }
        });
        let font = egui::FontId { size: NAME_SIZE, ..egui::TextStyle::Body.resolve(ui.style()) };
        let mut name = egui::text::LayoutJob::simple(item.name.clone(), font, ui.visuals().text_color(), SIDE);
        name.wrap.max_rows = 2;
        ui.add(egui::Label::new(name).selectable(false));
    });
    names
}

fn is_kept(item: &Item) -> bool {
    matches!(item.origin, Origin::Library(_))
}

fn told(item: &Item) -> String {
    let place = match &item.origin {
        Origin::Shipped(_) => "Ships with the program".to_owned(),
        Origin::File(path) | Origin::Library(path) => path.display().to_string(),
    };
    let click = if item.part.is_empty() { "A click opens it" } else { "A click takes it into this planet" };
    let tags: Vec<&str> = item.tags.iter().copied().chain(item.own_tags.iter().map(String::as_str)).collect();
    format!("{}\n{place}\n{click}; drag it onto the planet to take it", tags.join(", "))
}

/// Takes an item that is dropped on the picture beside the window.
fn drop_on_planet(ctx: &egui::Context, state: &State, window: egui::Rect, commands: &mut Commands) {
    let Some(dragged) = egui::DragAndDrop::payload::<Dragged>(ctx) else { return };
    let Some(pointer) = ctx.pointer_interact_pos() else { return };
    let Some(item) = state.shelf.items.get(dragged.0) else { return };
    let over = state.viewport.rect().contains(pointer) && !window.contains(pointer);
    let layer = egui::LayerId::new(egui::Order::Tooltip, egui::Id::unique("dragged from library"));
    let text = if over { format!("Take {}", item.name) } else { item.name.clone() };
    let painter = ctx.layer_painter(layer);
    let style = ctx.style_of(ctx.theme());
    let galley = painter.layout_no_wrap(text, egui::FontId::proportional(13.0), style.visuals.strong_text_color());
    let at = pointer + egui::vec2(14.0, 10.0);
    painter.rect_filled(egui::Rect::from_min_size(at, galley.size()).expand(4.0), 3.0, style.visuals.window_fill);
    painter.galley(at, galley, style.visuals.strong_text_color());
    if ctx.input(|input| input.pointer.any_released()) {
        egui::DragAndDrop::clear_payload(ctx);
        if over {
            commands.push(Action::Library(LibraryAction::Take(dragged.0)));
        }
    }
}
