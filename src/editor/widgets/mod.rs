//! Widgets. They know parameters, but no part of the planet by name.
//!
//! - [`param_row`]: a parameter as a row: label, slider, number, reset
//! - [`params_grid`]: all parameters of a part; [`row_view`]: the filter of a panel, the row that was searched for
//! - [`color_field`], [`choice_field`]: fields for a colour and for a choice
//! - [`curve_edit`]: a curve through points; [`curve_view`]: the numbers behind it
//! - [`drag_row`]: rows that are reordered by dragging
//! - [`icon`]: drawn icons and their buttons
//! - [`pick_list`]: a list with a cursor; [`planet_button`]: the small picture of a planet
//! - [`number`]: numbers as text, with units; [`arithmetic`]: calculations; [`value_text`]: any value as text
//! - [`typed`]: number fields that say why they refuse a text

pub mod arithmetic;
pub mod choice_field;
pub mod color_field;
pub mod curve_edit;
pub mod curve_view;
pub mod drag_row;
pub mod icon;
pub mod number;
pub mod param_row;
pub mod params_grid;
pub mod pick_list;
pub mod planet_button;
pub mod row_view;
pub mod typed;
pub mod value_text;

use crate::planet::param::ParamPath;
use eframe::egui;
use std::hash::{BuildHasher, RandomState};

/// A linear colour as an egui colour.
pub fn color32(linear: [f64; 3]) -> egui::Color32 {
    egui::Rgba::from_rgb(linear[0] as f32, linear[1] as f32, linear[2] as f32).into()
}

/// Black or white: the one that is readable on a colour.
pub fn ink_on(color: egui::Color32) -> egui::Color32 {
    if color.intensity() > 0.5 { egui::Color32::BLACK } else { egui::Color32::WHITE }
}

/// A random seed, from the random keys of the standard library's hash maps.
pub fn random_seed() -> u64 {
    RandomState::new().hash_one(std::time::SystemTime::now().elapsed().ok())
}

/// The keys of a shortcut, as they stand on the keyboard.
pub fn keys_text(ctx: &egui::Context, shortcut: &egui::KeyboardShortcut) -> String {
    let sign = match shortcut.logical_key {
        egui::Key::Minus => "−",
        egui::Key::Plus => "+",
        egui::Key::Equals => "=",
        egui::Key::OpenBracket => "[",
        egui::Key::CloseBracket => "]",
        egui::Key::Comma => ",",
        egui::Key::Period => ".",
        _ => return ctx.format_shortcut(shortcut),
    };
    ctx.format_shortcut(shortcut).replace(shortcut.logical_key.name(), sign)
}

/// Whether an open menu, list or question takes the keys.
pub fn keys_are_taken(ctx: &egui::Context) -> bool {
    egui::Popup::is_any_open(ctx) || ctx.memory(|memory| memory.top_modal_layer().is_some())
}

/// A button that opens a menu. The menu scrolls if the window has no room for all of it.
pub fn menu_button<'a, R>(
    ui: &mut egui::Ui,
    title: impl egui::IntoAtoms<'a>,
    content: impl FnOnce(&mut egui::Ui) -> R,
) -> egui::InnerResponse<Option<R>> {
    let (window, top) = (ui.ctx().content_rect(), ui.cursor().top());
    // The larger room, above or below the button, less the frame of the menu.
    let below = window.bottom() - top - ui.spacing().interact_size.y;
    let room = (below.max(top - window.top()) - 32.0).max(80.0);
    ui.menu_button(title, |ui| {
        // Room for the scroll bar beside the shortcuts of the entries.
        let beside = egui::Frame::new().inner_margin(egui::Margin { right: 10, ..egui::Margin::ZERO });
        // As high as the window allows: without a height, egui scrolls a menu from 400 points on.
        let area = egui::ScrollArea::vertical().max_height(room).min_scrolled_height(room);
        area.show(ui, |ui| beside.show(ui, content).inner).inner
    })
}

/// Selects the text of a field: what is typed next replaces it.
pub fn select_all(field: &egui::Response) {
    let mut state = egui::TextEdit::load_state(&field.ctx, field.id).unwrap_or_default();
    let [begin, end] = [0, usize::MAX].map(egui::text::CCursor::new);
    state.cursor.set_char_range(Some(egui::text::CCursorRange::two(begin, end)));
    state.store(&field.ctx, field.id);
}

/// The first problem of the parameter at `path`.
pub fn problem_at<'a>(problems: &'a [(ParamPath, String)], path: &ParamPath) -> Option<&'a str> {
    problems.iter().find(|(at, _)| at == path).map(|(_, message)| message.as_str())
}
