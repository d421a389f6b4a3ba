//! The window of the variations: nine small pictures. A click takes one, and the next nine are around it.

use crate::editor::command::{Action, Commands, VariationAction, Window};
use crate::editor::panels::PANELS;
use crate::editor::state::State;
use crate::editor::state::variations::{COUNT, Cell};
use crate::planet::locks::Locks;
use eframe::egui;

/// Width and height of a picture, points: at most and at least.
const MOST: f32 = 150.0;
const LEAST: f32 = 72.0;
/// Height of the window without the pictures.
const BESIDES: f32 = 190.0;
const COLUMNS: usize = 3;

/// The window's layer.
pub fn layer() -> egui::LayerId {
    egui::LayerId::new(egui::Order::Middle, id())
}

fn id() -> egui::Id {
    egui::Id::unique("variations window")
}

/// Shows the window while it is open.
pub fn show(ctx: &egui::Context, state: &State, commands: &mut Commands) {
    let mut open = state.shows.variations;
    let window = egui::Window::new("Variations").id(id()).open(&mut open).resizable(false).collapsible(false);
    window.default_pos([12.0, 40.0]).show(ctx, |ui| {
        let room = (ctx.content_rect().height() - BESIDES) / (COUNT / COLUMNS) as f32;
        let side = room.clamp(LEAST, MOST);
        ui.set_max_width(side * COLUMNS as f32 + 8.0);
        wishes(ui, state, commands);
        grid(ui, state, side, commands);
        ui.add_space(2.0);
        locks(ui, state, commands);
    });
    if open != state.shows.variations {
        commands.push(Action::Close(Window::Variations));
    }
}

fn wishes(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let mut wish = state.variations.wish;
    ui.horizontal(|ui| {
        let label = ui.label("Stray");
        let mut percent = (wish.stray * 100.0).round();
        ui.spacing_mut().slider_width = (ui.available_width() - 150.0).clamp(60.0, 140.0);
        let slider = egui::Slider::new(&mut percent, 2.0..=100.0).suffix(" %").integer();
        let told = "How far numbers may move, as a share of their size; from 50 % on, seeds often change as well";
        if ui.add(slider).labelled_by(label.id).on_hover_text(told).changed() {
            wish.stray = percent / 100.0;
        }
        if ui.button("Again").on_hover_text("Nine other variations").clicked() {
            commands.push(Action::Variation(VariationAction::Again));
        }
    });
    ui.horizontal(|ui| {
        let label = ui.label("Vary");
        let name = |part| PANELS.iter().find(|panel| Some(panel.part) == part).map_or("Everything", |panel| panel.label);
        egui::ComboBox::from_id_salt("what varies")
            .selected_text(name(wish.part))
            .width(120.0)
            .show_ui(ui, |ui| {
                for part in std::iter::once(None).chain(PANELS.iter().map(|panel| Some(panel.part))) {
                    ui.selectable_value(&mut wish.part, part, name(part));
                }
            })
            .response
            .labelled_by(label.id)
            .on_hover_text("The tab whose parameters vary");
        let missing = state.variations.missing();
        if missing > 0 {
            ui.weak(format!("drawing {} of {COUNT}", COUNT - missing + 1));
        }
    });
    if wish != state.variations.wish {
        commands.push(Action::Variation(VariationAction::Wish(wish)));
    }
}

fn grid(ui: &mut egui::Ui, state: &State, side: f32, commands: &mut Commands) {
    ui.spacing_mut().item_spacing = egui::vec2(4.0, 4.0);
    for (row, cells) in state.variations.cells.chunks(COLUMNS).enumerate() {
        ui.horizontal(|ui| {
            for (column, cell) in cells.iter().enumerate() {
                let number = row * COLUMNS + column;
                if picture(ui, cell, number, side).clicked() {
                    commands.push(Action::Variation(VariationAction::Take(number)));
                }
            }
        });
    }
}

/// A picture as a button.
fn picture(ui: &mut egui::Ui, cell: &Cell, number: usize, side: f32) -> egui::Response {
    let (rect, response) = ui.allocate_exact_size(egui::Vec2::splat(side), egui::Sense::click());
    let name = format!("Variation {}", number + 1);
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Button, ui.is_enabled(), &name));
    let visuals = ui.style().interact(&response);
    let painter = ui.painter();
    painter.rect_filled(rect, 3.0, egui::Color32::BLACK);
    let mut told = "Take it; undo goes back".to_owned();
    match &cell.picture {
        Some(Ok(texture)) => {
            let whole = egui::Rect::from_min_max(egui::Pos2::ZERO, egui::pos2(1.0, 1.0));
            painter.image(texture.id(), rect, whole, egui::Color32::WHITE);
        }
        Some(Err(why)) => {
            let color = ui.visuals().error_fg_color;
            let font = egui::TextStyle::Body.resolve(ui.style());
            painter.text(rect.center(), egui::Align2::CENTER_CENTER, "not drawn", font, color);
            told.clone_from(why);
        }
        None => {
            painter.circle_stroke(rect.center(), 0.45 * side, egui::Stroke::new(1.0, egui::Color32::from_gray(60)));
        }
    }
    if response.hovered() || response.has_focus() {
        painter.rect_stroke(rect, 3.0, (2.0, visuals.fg_stroke.color), egui::StrokeKind::Inside);
    }
    response.on_hover_text(told)
}

fn locks(ui: &mut egui::Ui, state: &State, commands: &mut Commands) {
    let count = Locks::of(state.document.planet()).len();
    ui.horizontal(|ui| {
        let told = "Locked parameters stay: right-click the name of a parameter or of a layer, or lock a whole tab with \
                    the padlock beside its filter";
        match count {
            0 => ui.weak("Nothing is locked"),
            1 => ui.weak("1 lock"),
            _ => ui.weak(format!("{count} locks")),
        }
        .on_hover_text(told);
        if count > 0 && ui.button("Unlock all").clicked() {
            commands.push(Action::Variation(VariationAction::UnlockAll));
        }
    });
}
