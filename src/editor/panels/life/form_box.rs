//! The form of the selected population beside a person: it turns by itself, and by a drag.

use super::pictures::{FormPictures, fitted};
use crate::editor::widgets::number::{length_text, round_length_m};
use crate::planet::{Form, Population};
use eframe::egui::{self, Align2, Color32, Rect, Stroke, pos2, vec2};
use std::f64::consts::TAU;
use std::time::Duration;

/// Height of the box as a share of that of the window, and its range in points.
const SHARE: f32 = 0.22;
const HEIGHTS: [f32; 2] = [110.0, 210.0];
/// Turn in a second, radians, and time from one picture to the next.
const SPEED_RAD: f64 = 0.5;
const PAUSE: Duration = Duration::from_millis(33);
/// Turn for each point of a drag, radians, and how high and low the eye may be.
const DRAG_RAD: f64 = 0.01;
const RAISED_RAD: [f64; 2] = [0.05, 1.3];
/// Height of a person, and of the lowest form beside which one stands, metres.
const PERSON_M: f64 = 1.8;
const LEAST_M: f64 = 0.6;

/// Content of the box.
pub(super) struct FormBox {
    turn_rad: f64,
    raised_rad: f64,
    variant: u8,
}

impl Default for FormBox {
    fn default() -> Self {
        Self { turn_rad: 0.6, raised_rad: 0.18, variant: 0 }
    }
}

impl FormBox {
    /// Shows the form, if there is a device to draw it.
    pub(super) fn show(&mut self, ui: &mut egui::Ui, pictures: &mut FormPictures, population: &Population) {
        let found = pictures.find(ui.ctx(), population, self.variant);
        if !pictures.can_draw() {
            return;
        }
        let height = (SHARE * ui.ctx().content_rect().height()).clamp(HEIGHTS[0], HEIGHTS[1]);
        let size = vec2(ui.available_width(), height);
        let (rect, response) = ui.allocate_exact_size(size, egui::Sense::drag());
        response
            .widget_info(|| egui::WidgetInfo::labeled(egui::Role::Image, true, format!("Form of {}", population.name)));
        let drag = response.drag_delta();
        self.turn_rad = (self.turn_rad + DRAG_RAD * f64::from(drag.x)).rem_euclid(TAU);
        let raised_rad = self.raised_rad + DRAG_RAD * f64::from(drag.y);
        self.raised_rad = raised_rad.clamp(RAISED_RAD[0], RAISED_RAD[1]);
        let behind = ui.visuals().extreme_bg_color;
        ui.painter().rect_filled(rect, 4.0, behind);
        if let (Some(radius), true) = (found, ui.is_rect_visible(rect)) {
            self.turn(ui, &response, pictures.is_software());
            let scale = Scale::beside(population.height_m, radius);
            let camera = fitted(radius, self.raised_rad, self.turn_rad, [scale.left, scale.top], size);
            let pixels = size * ui.ctx().pixels_per_point();
            if let Some(picture) = pictures.large(pixels, population, camera, behind) {
                let whole = Rect::from_min_max(pos2(0.0, 0.0), pos2(1.0, 1.0));
                ui.painter().image(picture, rect, whole, Color32::WHITE);
                let points = f64::from(rect.height()) / camera.extent[1];
                let at = |right: f64, up: f64| {
                    let [x, y] = [right - camera.middle[0], up * self.raised_rad.cos() - camera.middle[1]];
                    rect.center() + vec2((x * points) as f32, -(y * points) as f32)
                };
                scale.paint(ui, rect, at);
            }
        }
        let ink = ui.visuals().text_color();
        let font = egui::TextStyle::Small.resolve(ui.style());
        ui.painter().text(rect.right_top() + vec2(-8.0, 6.0), Align2::RIGHT_TOP, sizes(population), font, ink);
        self.variants(ui, rect);
        response.on_hover_text("Drag to turn").on_hover_cursor(egui::CursorIcon::Grab);
    }

    /// Turns the form a little: while the window has the focus, on a software adapter only under the pointer.
    fn turn(&mut self, ui: &egui::Ui, response: &egui::Response, is_software: bool) {
        let (is_focused, secs) = ui.input(|input| (input.focused, f64::from(input.stable_dt.min(0.1))));
        if is_focused && !response.dragged() && (response.hovered() || !is_software) {
            self.turn_rad = (self.turn_rad + SPEED_RAD * secs).rem_euclid(TAU);
            ui.ctx().request_repaint_after(PAUSE);
        }
    }

    fn variants(&mut self, ui: &mut egui::Ui, rect: Rect) {
        let side = vec2(20.0, 18.0);
        let left = rect.right_bottom() - vec2(8.0 + Form::VARIANTS as f32 * (side.x + 3.0) - 3.0, 6.0 + side.y);
        for variant in 0..Form::VARIANTS as u8 {
            let place = Rect::from_min_size(left + vec2(f32::from(variant) * (side.x + 3.0), 0.0), side);
            let text = egui::RichText::new((variant + 1).to_string()).small();
            let button = ui.put(place, egui::Button::selectable(self.variant == variant, text).min_size(side));
            let button = button.on_hover_text("Another individual of the form");
            if button.clicked() {
                self.variant = variant;
            }
            button.accessible_name(format!("Variant {}", variant + 1));
        }
    }
}

/// The heights of single objects.
fn sizes(population: &Population) -> String {
    let [least, most] = [-1.0, 1.0].map(|side| population.height_m * (1.0 + side * population.height_spread));
    let text = |metres: f64| if metres < 1.0 { format!("{:.0} cm", 100.0 * metres) } else { length_text(metres) };
    if text(least) == text(most) { text(most) } else { format!("{} to {}", text(least), text(most)) }
}

/// A length beside the form: a person, or a bar beside what is lower than a knee.
struct Scale {
    is_person: bool,
    text: String,
    /// Its middle and its left end, from the axis to the right, and its top: in heights of the form.
    middle: f64,
    left: f64,
    top: f64,
}

impl Scale {
    fn beside(height_m: f64, radius: f64) -> Self {
        let is_person = height_m >= LEAST_M;
        let length_m = if is_person { PERSON_M } else { round_length_m(height_m) };
        let top = length_m / height_m.max(1e-6);
        let half = if is_person { 0.17 * top } else { 0.06 };
        let middle = -(radius + half + 0.08);
        let text = if length_m < 1.0 { format!("{:.0} cm", 100.0 * length_m) } else { format!("{length_m} m") };
        Self { is_person, text, middle, left: middle - half - 0.06, top }
    }

    /// `at`: the place in the window of one in the picture, heights of the form to the right and up.
    fn paint(&self, ui: &egui::Ui, within: Rect, at: impl Fn(f64, f64) -> egui::Pos2) {
        let ink = ui.visuals().text_color();
        let painter = ui.painter_at(within);
        let (foot, head) = (at(self.middle, 0.0), at(self.middle, self.top));
        let high = foot.y - head.y;
        if self.is_person && high >= 8.0 {
            let part = |left: f32, top: f32, right: f32, bottom: f32| {
                let corner = |x: f32, y: f32| foot + high * vec2(x, -y);
                painter.rect_filled(
                    Rect::from_min_max(corner(left, top), corner(right, bottom)),
                    (0.05 * high).min(12.0),
                    ink.gamma_multiply(0.75),
                );
            };
            painter.circle_filled(foot + vec2(0.0, -0.925 * high), 0.075 * high, ink.gamma_multiply(0.75));
            part(-0.13, 0.83, 0.13, 0.45);
            part(-0.11, 0.50, -0.015, 0.0);
            part(0.015, 0.50, 0.11, 0.0);
        } else {
            let line = Stroke::new(1.5, ink);
            painter.line_segment([foot, head], line);
            for end in [foot, head] {
                painter.hline(end.x - 3.0..=end.x + 3.0, end.y, line);
            }
        }
        let font = egui::TextStyle::Small.resolve(ui.style());
        let galley = painter.layout_no_wrap(self.text.clone(), font, ink);
        let size = galley.size();
        let place =
            pos2((foot.x - 0.5 * size.x).max(within.left() + 6.0), (head.y - size.y - 3.0).max(within.top() + 4.0));
        painter.galley(place, galley, ink);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_person_stands_beside_what_is_not_lower_than_a_knee() {
        for (height_m, is_person, text) in [(20.0, true, "1.8 m"), (0.6, true, "1.8 m"), (0.3, false, "20 cm")] {
            let scale = Scale::beside(height_m, 0.5);
            assert_eq!((scale.is_person, scale.text.as_str()), (is_person, text), "{height_m}");
            assert!(scale.left < scale.middle && scale.middle < -0.5);
        }
        assert!((Scale::beside(18.0, 0.5).top - 0.1).abs() < 1e-12);
    }

    #[test]
    fn heights_of_objects_are_told_from_the_lowest_to_the_highest() {
        let of = |height_m, height_spread| sizes(&Population { height_m, height_spread, ..Population::default() });
        assert_eq!(of(10.0, 0.3), "7.0 m to 13 m");
        assert_eq!(of(0.2, 0.5), "10 cm to 30 cm");
        assert_eq!(of(2.0, 0.0), "2.0 m");
    }
}
