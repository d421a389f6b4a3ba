//! Number fields that say why they refuse a text.
//!
//! egui's own fields clamp a number to the range, and silently restore the old number if they cannot read the text.
//! These fields refuse both, and show the reason below the field for some seconds. After Enter the refused text stays,
//! to be corrected.

use super::number::{format_digits, read_number, suffix};
use super::select_all;
use crate::planet::param::Unit;
use eframe::egui;
use std::cell::RefCell;

/// Seconds for which the reason is shown.
const SHOWN_SECS: f64 = 10.0;

/// The numbers that a field takes.
#[derive(Clone, Copy, Debug)]
pub struct Allowed<'a> {
    /// Unit of the number.
    pub unit: Unit,
    /// The suffix of a number without a unit: " %".
    pub mark: &'a str,
    /// Smallest number.
    pub min: f64,
    /// Largest number.
    pub max: f64,
    /// Whether the number must be whole.
    pub whole: bool,
}

impl Allowed<'static> {
    /// Numbers with a unit.
    pub const fn numbers(unit: Unit, min: f64, max: f64) -> Self {
        Self { unit, mark: "", min, max, whole: false }
    }

    /// Whole numbers.
    pub fn whole(min: impl Into<f64>, max: impl Into<f64>) -> Self {
        Self { unit: Unit::None, mark: "", min: min.into(), max: max.into(), whole: true }
    }
}

impl<'a> Allowed<'a> {
    /// The same numbers with a suffix.
    pub const fn marked(self, mark: &'a str) -> Self {
        Self { mark, ..self }
    }

    /// The suffix of the number.
    fn end(&self) -> String {
        if self.mark.is_empty() { suffix(self.unit) } else { self.mark.to_owned() }
    }

    fn range(&self) -> String {
        format!("{} to {}{}", self.min, self.max, self.end())
    }

    /// The number of a text, or why it is not allowed. `now` is the number that is there.
    pub fn read(&self, text: &str, now: Option<f64>) -> Result<f64, String> {
        let text = text.trim();
        let bare = text.strip_suffix(self.mark.trim()).unwrap_or(text);
        let value = read_number(bare, self.unit, now).map_err(|why| format!("{why}; use {}", self.range()))?;
        if value < self.min || value > self.max {
            return Err(format!("{value} is out of range; use {}", self.range()));
        }
        if self.whole && value.fract() != 0.0 {
            return Err(format!("{value} is not a whole number; use {}", self.range()));
        }
        Ok(value)
    }
}

/// The text that was refused last, and its field.
#[derive(Clone)]
struct Refusal {
    field: egui::Id,
    why: String,
    since_secs: f64,
}

fn place() -> egui::Id {
    egui::Id::unique("refused number")
}

/// The text that was taken last.
#[derive(Clone)]
struct Taken {
    text: String,
    frame: u64,
}

fn taken_place() -> egui::Id {
    egui::Id::unique("taken number")
}

/// Shows a field of this size, or as large as it needs. `shown` is the text of the field for its value: a field that
/// still holds this text changes nothing.
pub fn typed_field(
    ui: &mut egui::Ui,
    size: Option<egui::Vec2>,
    number: egui::DragValue<'_>,
    allowed: Allowed<'_>,
    shown: &str,
    value: f64,
) -> egui::Response {
    let refused: RefCell<Option<String>> = RefCell::default();
    let frame = ui.ctx().cumulative_frame_nr();
    let (before, taken) = (ui.data(|data| data.get_temp::<Taken>(taken_place())), RefCell::default());
    let parse = |text: &str| {
        // egui reads a text once more in the frame after it was taken: `*2` would count twice.
        let again = before.as_ref().is_some_and(|taken| taken.text == text && frame <= taken.frame + 1);
        if again || text.trim() == shown {
            return Some(value);
        }
        let read = allowed.read(text, Some(value));
        *refused.borrow_mut() = read.as_ref().err().cloned();
        if read.is_ok() {
            *taken.borrow_mut() = Some(Taken { text: text.to_owned(), frame });
        }
        read.ok()
    };
    // The range holds for dragging alone: to show a loaded value must not clamp it.
    let number = number
        .range(allowed.min..=allowed.max)
        .clamp_existing_to_range(false)
        .custom_parser(parse)
        .clip_text(true)
        .update_while_editing(false);
    let response = match size {
        Some(size) => ui.add_sized(size, number),
        None => ui.add(number),
    };
    tab_to_next(ui, &response);
    if let Some(taken) = taken.take() {
        ui.data_mut(|data| data.insert_temp(taken_place(), taken));
    }
    if let Some(why) = refused.take() {
        refuse(ui, response.id, why);
        if ui.input(|input| input.key_pressed(egui::Key::Enter)) {
            // egui keeps the text of a field that has the focus.
            response.request_focus();
            select_all(&response);
        }
    }
    tell(ui, &response);
    response
}

/// A field for a number that shows this many significant digits.
pub fn plain_field(
    ui: &mut egui::Ui,
    value: &mut f64,
    speed: f64,
    digits: i32,
    allowed: Allowed<'_>,
) -> egui::Response {
    let (now, shown) = (*value, format_digits(*value, digits));
    let number = egui::DragValue::new(value)
        .speed(speed)
        .suffix(allowed.end())
        .max_decimals(9)
        .custom_formatter(move |v, _| format_digits(v, digits));
    typed_field(ui, None, number, allowed, &shown, now)
}

/// Tab leads from one number to the next, past the slider and the reset button between them.
fn tab_to_next(ui: &egui::Ui, field: &egui::Response) {
    let (place, pass) = (egui::Id::unique("tab to number"), ui.ctx().cumulative_pass_nr());
    let is_asked = ui.data(|data| data.get_temp::<u64>(place)) == Some(pass);
    if is_asked && !field.lost_focus() {
        ui.data_mut(|data| data.remove::<u64>(place));
        field.request_focus();
        select_all(field);
    } else if field.lost_focus() && ui.input(|i| i.key_pressed(egui::Key::Tab) && i.modifiers.is_none()) {
        ui.data_mut(|data| data.insert_temp(place, pass));
    }
}

/// Notes why a field has refused a text.
pub fn refuse(ui: &egui::Ui, field: egui::Id, why: String) {
    let since_secs = ui.input(|input| input.time);
    ui.data_mut(|data| data.insert_temp(place(), Refusal { field, why, since_secs }));
}

/// Shows below a field why it has refused a text.
pub fn tell(ui: &egui::Ui, field: &egui::Response) {
    let Some(refusal) = ui.data(|data| data.get_temp::<Refusal>(place())).filter(|refusal| refusal.field == field.id)
    else {
        return;
    };
    let left_secs = SHOWN_SECS - (ui.input(|input| input.time) - refusal.since_secs);
    // The user types or drags again: the reason has been read.
    let is_typed = left_secs < SHOWN_SECS && field.has_focus() && ui.input(|input| input.events.iter().any(is_typing));
    if left_secs <= 0.0 || is_typed || field.changed() || field.dragged() {
        ui.data_mut(|data| data.remove::<Refusal>(place()));
        return;
    }
    let ctx = ui.ctx().clone();
    ctx.request_repaint_after_secs(left_secs as f32);
    // Not over a question.
    if ctx.memory(egui::Memory::top_modal_layer).is_some_and(|modal| modal != ui.layer_id()) {
        return;
    }
    egui::Tooltip::always_open(ctx, ui.layer_id(), field.id.with("refused"), field.rect).show(|ui| {
        ui.colored_label(ui.visuals().error_fg_color, &refusal.why);
    });
}

fn is_typing(event: &egui::Event) -> bool {
    matches!(event, egui::Event::Text(_) | egui::Event::Paste(_) | egui::Event::Key { pressed: true, .. })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn what_is_refused_is_refused_for_a_reason() {
        let angle = Allowed::numbers(Unit::Degrees, -90.0, 90.0);
        assert_eq!(angle.read(" 12.5° ", None), Ok(12.5));
        assert_eq!(angle.read("abc", None), Err("\"abc\" is not a number; use -90 to 90°".to_owned()));
        assert_eq!(angle.read("5 km", None), Err("\"5 km\" is not in °; use -90 to 90°".to_owned()));
        assert_eq!(angle.read("95", None), Err("95 is out of range; use -90 to 90°".to_owned()));
        assert_eq!(angle.read("", None), Err("nothing was typed; use -90 to 90°".to_owned()));
        let octaves = Allowed::whole(1, 24);
        assert_eq!(octaves.read("3.5", None), Err("3.5 is not a whole number; use 1 to 24".to_owned()));
        assert_eq!(
            octaves.read("3 m", None),
            Err("\"3 m\" has a unit, but this is a plain number; use 1 to 24".to_owned())
        );
        assert_eq!(Allowed::numbers(Unit::None, 0.0, 100.0).marked(" %").read("50 %", None), Ok(50.0));
    }
}
