//! Fields for a linear colour: a button that opens a picker, and the sRGB code.

use super::typed;
use super::{color32, select_all};
use eframe::egui;

/// A button that shows a linear colour and opens a picker.
pub fn color_button(ui: &mut egui::Ui, name: &str, value: &mut [f64; 3]) {
    let mut rgb = value.map(|component| component as f32);
    let response = ui.color_edit_button_rgb(&mut rgb).accessible_name(name);
    if response.changed() {
        // Four decimals are finer than 8 bits, and keep the preset readable.
        *value = rgb.map(|component| (f64::from(component.clamp(0.0, 1.0)) * 1e4).round() / 1e4);
    }
}

/// The colour as its sRGB code, `#5C3A93`, to be typed, copied and pasted.
pub fn hex_field(ui: &mut egui::Ui, name: &str, value: &mut [f64; 3]) {
    let shown = color32(*value);
    let code = format!("#{:02X}{:02X}{:02X}", shown.r(), shown.g(), shown.b());
    let id = ui.scope_id().with("hex");
    let mut text = ui.data(|data| data.get_temp::<String>(id)).unwrap_or_else(|| code.clone());
    let edit = egui::TextEdit::singleline(&mut text).id(id.with("field")).char_limit(9).desired_width(66.0);
    let response = ui.add(edit).on_hover_text("sRGB code of the colour").accessible_name(format!("Code of {name}"));
    if response.gained_focus() {
        select_all(&response);
    }
    if response.has_focus() {
        ui.data_mut(|data| data.insert_temp(id, text));
    } else if response.lost_focus() {
        ui.data_mut(|data| data.remove::<String>(id));
        let typed = text.trim().trim_start_matches('#');
        match egui::Color32::from_hex(&format!("#{typed}")) {
            Ok(color) if color != shown && !ui.input(|input| input.key_pressed(egui::Key::Escape)) => {
                let linear = egui::Rgba::from(color);
                let rounded = |part: f32| (f64::from(part) * 1e4).round() / 1e4;
                *value = [linear.r(), linear.g(), linear.b()].map(rounded);
            }
            Ok(_) => {}
            Err(_) => {
                typed::refuse(ui, response.id, format!("{text:?} is no colour; use a code such as #5C3A93"));
                // The text stays, to be corrected.
                if ui.input(|input| input.key_pressed(egui::Key::Enter)) {
                    ui.data_mut(|data| data.insert_temp(id, text));
                    response.request_focus();
                    select_all(&response);
                }
            }
        }
    }
    typed::tell(ui, &response);
}
