//! A parameter as a row: label, a control for its domain, and a reset button if the value differs from the default.
//!
//! The row knows the parameter by its [`Param`] alone. Its widgets have accessible names such as "Amplitude of
//! Continents"; that of the number beside a slider is "Amplitude of Continents as a number".

use super::choice_field::{biome_box, biome_boxes, choice_box, population_box};
use super::color_field::{color_button, hex_field};
use super::curve_edit::CurveEdit;
use super::curve_view::CurveView;
use super::icon::{Icon, icon, icon_button};
use super::number::{format_digits, suffix};
use super::row_view::{LockView, RowView};
use super::typed::{self, Allowed, typed_field};
use super::value_text::{read_value, value_text};
use super::{random_seed, select_all};
use crate::planet::Planet;
use crate::planet::param::{Domain, Param, ParamPath, Unit, Value, ValueMut};
use eframe::egui;

/// The parameter of a row.
pub struct Row<'a> {
    /// Its description.
    pub param: &'static Param,
    /// Its path in the file.
    pub path: &'a ParamPath,
    /// Its owner: "Continents", "climate".
    pub owner: &'a str,
    /// Its default, if it has one.
    pub default: Option<&'a Value>,
    /// What is wrong with its value.
    pub problem: Option<&'a str>,
    /// Why its value has no effect now.
    pub idle: Option<&'static str>,
    /// The planet, for parameters that refer to other parts of it.
    pub planet: &'a Planet,
    /// The biomes of the palette, for a parameter that refers to one.
    pub biomes: &'a [BiomeName],
    /// Whether the field for a number or a text takes the focus now.
    pub takes_focus: bool,
    /// What variations leave as it is.
    pub locks: &'a LockView,
    /// The numbers behind curves.
    pub curves: &'a CurveView<'a>,
}

/// A biome that a parameter may refer to.
pub struct BiomeName {
    /// Its key.
    pub key: char,
    /// Its name.
    pub name: String,
    /// Its colour, linear.
    pub color: [f64; 3],
}

/// Opacity of a row whose value has no effect now.
const IDLE_OPACITY: f32 = 0.5;
const RESET_WIDTH: f32 = 20.0;
const NUMBER_WIDTH: f32 = 86.0;
/// Upper end from which a range with both signs is wide.
const WIDE: f64 = 10_000.0;
/// What a fine drag over the whole slider changes, as a share of the number.
const FINE: f64 = 0.1;
/// Significant digits of a number field, and of each of three fields side by side.
const NUMBER_DIGITS: i32 = 5;
const TRIPLE_DIGITS: i32 = 4;

/// Shows the row. Gives whether the user wants to choose a file.
pub fn param_row(ui: &mut egui::Ui, row: &Row<'_>, mut value: ValueMut<'_>) -> bool {
    let mut browse = false;
    ui.push_id(row.path.to_string(), |ui| {
        if row.idle.is_some() {
            // Faint, but not disabled: one may prepare a value before it counts.
            ui.multiply_opacity(IDLE_OPACITY);
        }
        ui.horizontal(|ui| {
            ui.spacing_mut().item_spacing.x = 6.0;
            let total = ui.available_width();
            let label_width = label_width(total);
            label(ui, row, &mut value, label_width);
            let control_width = (total - label_width - RESET_WIDTH - 14.0).max(60.0);
            ui.allocate_ui_with_layout(
                egui::vec2(control_width, ui.spacing().interact_size.y),
                egui::Layout::left_to_right(egui::Align::Center),
                |ui| {
                    ui.set_min_width(control_width);
                    let number;
                    (browse, number) = control(ui, row, &mut value);
                    if let Some(number) = number {
                        menu_of_number(ui, number, row, &mut value);
                    }
                },
            );
            if let Some(default) = resets_to(row)
                && value.get() != *default
            {
                let tooltip = format!("Back to {}", value_text(row.param, default, value.as_ref().labels()));
                if icon_button(ui, Icon::Reset, &format!("Reset {}", name(row)), &tooltip).clicked() {
                    value.set(default);
                }
            }
        });
        if let (Domain::Triple { max }, ValueMut::Triple(v)) = (row.param.domain, &mut value) {
            triple(ui, &name(row), row.param, v, max);
        }
        if let ValueMut::Curve(curve) = &mut value
            && let Some(edit) = curve_edit(row.param, &name(row)).filter(|_| !curve.is_empty())
        {
            CurveEdit { inputs: row.curves.of(row.path), ..edit }.show(ui, curve);
        }
        if let Some(problem) = row.problem {
            ui.colored_label(ui.visuals().error_fg_color, problem);
        }
    });
    browse
}

/// The value that the reset button restores. A key has none: not every palette has the default key.
fn resets_to<'a>(row: &Row<'a>) -> Option<&'a Value> {
    row.default.filter(|_| row.param.domain != Domain::BiomeKey)
}

/// Width of the labels in a row of this width.
fn label_width(total: f32) -> f32 {
    (total * 0.34).clamp(84.0, 150.0)
}

/// A row of other widgets, aligned with the rows of parameters. The label's id gives them their accessible names. A
/// filter hides the row unless the label fits.
pub fn labelled_row(ui: &mut egui::Ui, shown: &RowView<'_>, text: &str, add: impl FnOnce(&mut egui::Ui, egui::Id)) {
    if !shown.filter.passes(&[text]) {
        return;
    }
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 6.0;
        let size = egui::vec2(label_width(ui.available_width()), ui.spacing().interact_size.y);
        let layout = egui::Layout::left_to_right(egui::Align::Center);
        let label = ui.allocate_ui_with_layout(size, layout, |ui| {
            ui.set_min_width(size.x);
            ui.add(egui::Label::new(text).truncate())
        });
        add(ui, label.inner.id);
    });
}

fn name(row: &Row<'_>) -> String {
    format!("{} of {}", row.param.label, row.owner)
}

/// The name of the parameter. Its tooltip explains the parameter; its context menu copies, pastes and resets the value.
fn label(ui: &mut egui::Ui, row: &Row<'_>, value: &mut ValueMut<'_>, width: f32) {
    let color = if row.problem.is_some() { ui.visuals().error_fg_color } else { ui.visuals().text_color() };
    let text = egui::RichText::new(row.param.label).color(color);
    let height = ui.spacing().interact_size.y;
    let response = ui
        .allocate_ui_with_layout(egui::vec2(width, height), egui::Layout::left_to_right(egui::Align::Center), |ui| {
            ui.set_min_width(width);
            if row.locks.hold(row.path) {
                padlock(ui, row);
            }
            ui.add(egui::Label::new(text).truncate().sense(egui::Sense::click()))
        })
        .inner;
    let response = response.on_hover_ui(|ui| tooltip(ui, row, value));
    Paste::take(ui, row, value, &response);
    response.context_menu(|ui| menu(ui, row, value));
}

/// A slider and its number have the tooltip and the menu of the label as well. `number` is both.
fn menu_of_number(ui: &egui::Ui, mut number: egui::Response, row: &Row<'_>, value: &mut ValueMut<'_>) {
    // A slider takes no clicks.
    let asked = ui.input(|input| input.pointer.secondary_clicked());
    number.flags.set(egui::response::Flags::CLICKED, asked && number.contains_pointer());
    if !number.has_focus() {
        number = number.on_hover_ui(|ui| tooltip(ui, row, value));
    }
    number.context_menu(|ui| menu(ui, row, value));
}

/// The context menu of a parameter.
fn menu(ui: &mut egui::Ui, row: &Row<'_>, value: &mut ValueMut<'_>) {
    if ui.button("Copy value").clicked() {
        ui.ctx().copy_text(value_text(row.param, &value.get(), value.as_ref().labels()));
        ui.close();
    }
    if ui.button("Paste value").clicked() {
        Paste::ask(ui, row);
        ui.close();
    }
    if ui.button("Copy path").clicked() {
        ui.ctx().copy_text(row.path.to_string());
        ui.close();
    }
    row.locks.entry(ui, row.path);
    if let Some(default) = resets_to(row)
        && ui.button("Reset to default").clicked()
    {
        value.set(default);
        ui.close();
    }
}

/// The mark of a locked parameter. A click unlocks it, unless something that holds it is locked.
fn padlock(ui: &mut egui::Ui, row: &Row<'_>) {
    ui.spacing_mut().item_spacing.x = 0.0;
    if row.locks.is_on(row.path) {
        let told = "Locked: variations and random planets leave it as it is. Click to unlock";
        if icon_button(ui, Icon::Lock, &format!("Unlock {}", name(row)), told).clicked() {
            row.locks.toggle(row.path);
        }
    } else {
        icon(ui, Icon::Lock, "Locked with what it belongs to");
    }
}

/// The row that waits for the text of the clipboard: the desktop gives it in a later frame.
#[derive(Clone, PartialEq)]
struct Paste {
    path: String,
    name: &'static str,
}

impl Paste {
    fn of(row: &Row<'_>) -> Self {
        Self { path: row.path.to_string(), name: row.param.name }
    }

    fn place() -> egui::Id {
        egui::Id::unique("paste value")
    }

    /// Asks for the text of the clipboard.
    fn ask(ui: &egui::Ui, row: &Row<'_>) {
        ui.data_mut(|data| data.insert_temp(Self::place(), Self::of(row)));
        ui.ctx().send_viewport_cmd(egui::ViewportCommand::RequestPaste);
    }

    /// Takes the text into the row that has asked for it. What is wrong with the text shows below the label.
    fn take(ui: &egui::Ui, row: &Row<'_>, value: &mut ValueMut<'_>, label: &egui::Response) {
        typed::tell(ui, label);
        let Some(waiting) = ui.data(|data| data.get_temp::<Self>(Self::place())) else { return };
        if waiting != Self::of(row) {
            return;
        }
        let text = ui.input(|input| {
            input.events.iter().find_map(|event| match event {
                egui::Event::Paste(text) => Some(text.clone()),
                _ => None,
            })
        });
        let Some(text) = text else { return };
        ui.data_mut(|data| data.remove::<Self>(Self::place()));
        let keys: Vec<char> = row.biomes.iter().map(|biome| biome.key).collect();
        match read_value(row.param, &value.as_ref(), &text, &keys) {
            Ok(new) => value.set(&new),
            Err(why) => typed::refuse(ui, label.id, why),
        }
    }
}

fn tooltip(ui: &mut egui::Ui, row: &Row<'_>, value: &ValueMut<'_>) {
    ui.set_max_width(320.0);
    ui.label(row.param.doc);
    if let Some(why) = row.idle {
        ui.label(format!("No effect now. {why}."));
    }
    if matches!(row.param.domain, Domain::Number { .. }) {
        ui.weak("Shift drags the slider finely.");
    }
    let range = row.param.range_text();
    if !range.is_empty() {
        ui.weak(format!("Range: {range}"));
    }
    if let Some(default) = resets_to(row) {
        ui.weak(format!("Default: {}", value_text(row.param, default, value.as_ref().labels())));
    }
    ui.weak(egui::RichText::new(row.path.to_string()).monospace());
}

/// Shows the control of the parameter's domain. Gives whether the user wants to choose a file, and the slider with its
/// number.
fn control(ui: &mut egui::Ui, row: &Row<'_>, value: &mut ValueMut<'_>) -> (bool, Option<egui::Response>) {
    let name = name(row);
    let focus = |response: egui::Response| {
        if row.takes_focus {
            response.request_focus();
            select_all(&response);
        }
        response
    };
    let mut number = None;
    match (row.param.domain, value) {
        (Domain::Number { min, max, logarithmic }, ValueMut::Number(v)) => {
            // A wide range around zero is logarithmic on both sides: a sea level may be metres or kilometres.
            let is_wide = min < 0.0 && max >= WIDE;
            // A drag with Shift is fine to its end: the slider itself would jump to the pointer. A press is a drag.
            let fine_id = ui.scope_id().with(("fine", &name));
            let is_fine = ui.data(|data| data.get_temp(fine_id).unwrap_or(false)) || ui.input(|i| i.modifiers.shift);
            let before = **v;
            // A logarithmic range that begins at zero needs a least value: a hundred-thousandth of the range is
            // finer than a pixel of the slider.
            let least = max.abs() * if is_wide { 1e-3 } else { 1e-5 };
            let response = {
                let mut set = get_set(v, NUMBER_DIGITS);
                let slider = egui::Slider::from_get_set(min..=max, move |new| set(new.filter(|_| !is_fine)));
                add_slider(ui, &name, slider.logarithmic(logarithmic || is_wide).smallest_positive(least))
            };
            let is_held = response.interact_pointer_pos().is_some();
            if is_held && is_fine {
                let share = f64::from(response.drag_delta().x / response.rect.width());
                get_set(v, NUMBER_DIGITS)(Some(drag_finely(before, share, [min, max], logarithmic)));
            }
            ui.data_mut(|data| data.insert_temp(fine_id, is_held && is_fine));
            let field = focus(number_field(ui, &name, row.param, v, min, max, logarithmic));
            number = Some(field.union(response));
        }
        (Domain::Count { min, max }, ValueMut::Count(v)) => {
            let slider = add_slider(ui, &name, egui::Slider::new(&mut **v, min..=max));
            let field = count_field(ui, v, 0.1, Allowed::whole(min, max));
            number = Some(focus(field.accessible_name(format!("{name} as a number"))).union(slider));
        }
        (Domain::Seed, ValueMut::Count(v)) => {
            // As wide as the longest number, so that the dice button stays under the pointer.
            focus(count_field(ui, v, 1.0, Allowed::whole(0, u32::MAX)).accessible_name(&name));
            if icon_button(ui, Icon::Dice, &format!("Random {name}"), "A random seed").clicked() {
                **v = random_seed() as u32;
            }
        }
        (Domain::Color, ValueMut::Triple(v)) => {
            color_button(ui, &name, v);
            hex_field(ui, &name, v);
        }
        (Domain::Triple { .. }, ValueMut::Triple(_)) => {
            // The three numbers are on a line of their own below.
            ui.weak(row.param.unit.symbol());
        }
        (Domain::BiomeKey, ValueMut::Letter(key)) => biome_box(ui, &name, key, row.biomes),
        (Domain::BiomeKeys, ValueMut::Text(keys)) => biome_boxes(ui, &name, keys, row.biomes),
        (_, ValueMut::Flag(v)) => {
            focus(ui.add(egui::Checkbox::without_text(v)).accessible_name(&name));
        }
        (_, ValueMut::Choice(choice)) => choice_box(ui, &name, *choice),
        (Domain::Letter, ValueMut::Letter(letter)) => {
            let mut text = letter.to_string();
            let edit = egui::TextEdit::singleline(&mut text).desired_width(24.0);
            if ui.add(edit).accessible_name(&name).changed()
                && let Some(typed) = text.chars().find(|c| c != *letter).or_else(|| text.chars().next())
            {
                **letter = typed;
            }
        }
        (Domain::File { max_chars }, ValueMut::Text(text)) => {
            return (file_field(ui, &name, text, max_chars), None);
        }
        (Domain::PopulationName { none, .. }, ValueMut::Text(text)) => {
            population_box(ui, (&name, none), text, row.planet);
        }
        (Domain::MaskName { max_chars }, ValueMut::Text(text)) => {
            focus(mask_field(ui, &name, text, max_chars, row));
        }
        (domain, ValueMut::Text(text)) => {
            let max_chars = if let Domain::Text { max_chars } = domain { max_chars } else { usize::MAX };
            let edit = egui::TextEdit::singleline(&mut **text).char_limit(max_chars).desired_width(f32::INFINITY);
            focus(ui.add(edit).accessible_name(&name));
        }
        (Domain::Curve { .. }, ValueMut::Curve(curve)) => {
            // The curve itself is below the row, over its whole width.
            if !curve.is_empty() {
                ui.weak(format!("{} points", curve.len()));
            } else if ui
                .button("Add curve")
                .on_hover_text(row.param.doc)
                .accessible_name(format!("Add {name}"))
                .clicked()
                && let Some(edit) = curve_edit(row.param, &name)
            {
                **curve = edit.straight();
            }
        }
        _ => {
            ui.weak("cannot be edited here");
        }
    }
    (false, number)
}

/// A path, and a button to choose another. Gives whether the button was clicked.
fn file_field(ui: &mut egui::Ui, name: &str, path: &mut String, max_chars: usize) -> bool {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let browse = ui.button("Browse…").on_hover_text("Choose a file").clicked();
        let edit = egui::TextEdit::singleline(path).char_limit(max_chars).desired_width(ui.available_width());
        ui.add(edit).accessible_name(name);
        browse
    })
    .inner
}

/// The name of a painted mask, and a menu of those that the planet has. Gives the field.
fn mask_field(ui: &mut egui::Ui, name: &str, text: &mut String, max_chars: usize, row: &Row<'_>) -> egui::Response {
    ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
        let menu = ui.menu_button("⏷", |ui| {
            if matches!(row.default, Some(Value::Text(none)) if none.is_empty()) {
                ui.selectable_value(text, String::new(), "None");
            }
            let known = row.planet.painted_masks();
            for known in &known {
                ui.selectable_value(text, (*known).to_owned(), *known);
            }
            if known.is_empty() {
                ui.weak("No mask is painted yet: type a name, and paint it.");
            }
        });
        menu.response.on_hover_text("Choose a painted mask").accessible_name(format!("Choose {name}"));
        let edit = egui::TextEdit::singleline(text).char_limit(max_chars).desired_width(ui.available_width());
        ui.add(edit).accessible_name(name)
    })
    .inner
}

/// The editor of a parameter that is a curve.
fn curve_edit<'a>(param: &Param, name: &'a str) -> Option<CurveEdit<'a>> {
    let Domain::Curve { most, least_step } = param.domain else { return None };
    Some(CurveEdit { name, unit: param.unit, most, least_step, inputs: None })
}

/// A number after a fine drag over a share of the slider. A small one counts as a hundredth of a linear range.
fn drag_finely(value: f64, share: f64, [min, max]: [f64; 2], logarithmic: bool) -> f64 {
    let size = if logarithmic { value.abs().max(1e-7 * max.abs()) } else { value.abs().max(0.01 * (max - min)) };
    (value + FINE * share * size).clamp(min, max)
}

/// A slider that leaves room for the number beside it.
fn add_slider(ui: &mut egui::Ui, name: &str, slider: egui::Slider<'_>) -> egui::Response {
    ui.spacing_mut().slider_width = (ui.available_width() - NUMBER_WIDTH - 8.0).max(32.0);
    ui.add(slider.show_value(false).clamping(egui::SliderClamping::Edits)).accessible_name(name)
}

fn number_field(
    ui: &mut egui::Ui,
    name: &str,
    param: &Param,
    value: &mut f64,
    min: f64,
    max: f64,
    logarithmic: bool,
) -> egui::Response {
    let speed = if logarithmic { (value.abs() * 0.01).max(max.abs() * 1e-7) } else { (max - min) * 0.002 };
    let (now, shown) = (*value, format_digits(*value, NUMBER_DIGITS));
    let number = egui::DragValue::from_get_set(get_set(value, NUMBER_DIGITS))
        .speed(speed)
        .max_decimals(9)
        .suffix(suffix(param.unit))
        .custom_formatter(|v, _| format_digits(v, NUMBER_DIGITS));
    let size = egui::vec2(NUMBER_WIDTH, ui.spacing().interact_size.y);
    typed_field(ui, Some(size), number, Allowed::numbers(param.unit, min, max), &shown, now)
        .accessible_name(format!("{name} as a number"))
}

fn count_field(ui: &mut egui::Ui, value: &mut u32, speed: f64, allowed: Allowed<'_>) -> egui::Response {
    let (now, shown) = (f64::from(*value), value.to_string());
    let size = egui::vec2(NUMBER_WIDTH, ui.spacing().interact_size.y);
    let number = egui::DragValue::new(value).speed(speed).custom_formatter(|v, _| format!("{v:.0}"));
    typed_field(ui, Some(size), number, allowed, &shown, now)
}

/// A field for a number. A number that looks like the old one is no edit: a visit to the field must not round a loaded
/// value to the digits shown.
fn get_set(value: &mut f64, digits: i32) -> impl FnMut(Option<f64>) -> f64 + '_ {
    move |new| {
        if let Some(new) = new
            && new.is_finite()
            && format_digits(new, digits) != format_digits(*value, digits)
        {
            *value = new;
        }
        *value
    }
}

/// Three numbers side by side over the whole width: beside the label they would be too narrow.
fn triple(ui: &mut egui::Ui, name: &str, param: &Param, value: &mut [f64; 3], max: f64) {
    ui.horizontal(|ui| {
        ui.spacing_mut().item_spacing.x = 4.0;
        let size = egui::vec2((ui.available_width() - 8.0) / 3.0, ui.spacing().interact_size.y);
        let unit = param.unit;
        for (component, channel) in value.iter_mut().zip(["R", "G", "B"]) {
            let speed = (component.abs() * 0.01).max(max * 1e-6);
            let (now, shown) = (*component, format_digits(*component, TRIPLE_DIGITS));
            let number = egui::DragValue::from_get_set(get_set(component, TRIPLE_DIGITS))
                .speed(speed)
                .max_decimals(9)
                .custom_formatter(|v, _| format_digits(v, TRIPLE_DIGITS));
            let told = format!("{channel}, in {}", if unit == Unit::None { "parts" } else { unit.symbol() });
            typed_field(ui, Some(size), number, Allowed::numbers(unit, 0.0, max), &shown, now)
                .on_hover_text(told)
                .accessible_name(format!("{channel} of {name}"));
        }
    });
}
