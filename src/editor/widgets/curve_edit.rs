//! A curve through points: drag a point, double-click to add one, right-click to remove one, or type its numbers.

use super::curve_view::columns;
use super::number::format_digits;
use super::typed::{Allowed, plain_field};
use crate::planet::param::{Curve, MAX_CURVE_POINTS, Unit};
use crate::terrain::{CurveInput, curve_at};
use eframe::egui::{self, Pos2, Rect};

const HEIGHT: f32 = 132.0;
/// Greatest distance of the pointer to take a point, in egui points.
const REACH: f32 = 10.0;
const DIGITS: i32 = 3;
/// Columns of the histogram behind the curve.
const COLUMNS: usize = 64;

/// The curve to edit.
pub struct CurveEdit<'a> {
    /// Its accessible name.
    pub name: &'a str,
    /// Unit of both axes.
    pub unit: Unit,
    /// Greatest absolute value of a coordinate.
    pub most: f64,
    /// Least distance between two points along the first axis.
    pub least_step: f64,
    /// The numbers that the planet puts into the curve.
    pub inputs: Option<&'a [CurveInput]>,
}

impl CurveEdit<'_> {
    /// A straight curve, which changes nothing.
    pub fn straight(&self) -> Curve {
        let end = if self.most > 100.0 { 0.1 * self.most } else { 1.0_f64.min(self.most) };
        vec![[-end, -end], [0.0, 0.0], [end, end]]
    }

    /// Shows the curve.
    pub fn show(&self, ui: &mut egui::Ui, curve: &mut Curve) {
        let size = egui::vec2(ui.available_width(), HEIGHT);
        let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click_and_drag());
        let held_id = response.id.with("held");
        // A drag keeps the scale of its begin: else the point would move away from the pointer.
        let span_id = response.id.with("span");
        let kept = ui.data(|data| data.get_temp::<f64>(span_id)).filter(|_| response.dragged());
        let plot = Plot { rect: rect.shrink(4.0), span: kept.unwrap_or_else(|| self.span(curve)) };
        ui.data_mut(|data| data.insert_temp(span_id, plot.span));

        let under = response.interact_pointer_pos().or(response.hover_pos());
        let near = under.and_then(|pos| plot.nearest(curve, pos));
        if response.drag_started() {
            let pressed = ui.input(|input| input.pointer.press_origin()).or(under);
            let taken = pressed.and_then(|pos| plot.nearest(curve, pos));
            ui.data_mut(|data| data.insert_temp(held_id, taken));
        }
        let held = ui.data(|data| data.get_temp::<Option<usize>>(held_id)).flatten().filter(|_| response.dragged());
        if let (Some(index), Some(pos)) = (held, under) {
            self.move_point(curve, index, plot.value(pos));
        } else if response.double_clicked() {
            if let (None, Some(pos)) = (near, under) {
                self.add_point(curve, plot.value(pos));
            }
        } else if response.secondary_clicked()
            && let Some(index) = near
        {
            curve.remove(index);
            // A curve has at least two points.
            if curve.len() < 2 {
                curve.clear();
            }
        }
        self.paint(ui, &plot, curve, held.or(near));
        let shown = held.or(near).and_then(|index| curve.get(index));
        let unit = self.unit.symbol();
        response
            .on_hover_ui(|ui| {
                if let Some([x, y]) = shown {
                    ui.label(format!("{} becomes {} {unit}", format_digits(*x, 5), format_digits(*y, 5)));
                }
                ui.weak("Drag a point; double-click to add one; right-click one to remove it");
                if self.inputs.is_some() {
                    ui.weak("The columns: how often the planet has each number");
                }
            })
            .accessible_name(self.name);
        egui::CollapsingHeader::new("Points").id_salt(self.name).show(ui, |ui| self.points(ui, curve));
    }

    /// The points as numbers.
    fn points(&self, ui: &mut egui::Ui, curve: &mut Curve) {
        let mut typed = None;
        for (index, point) in curve.iter().enumerate() {
            ui.horizontal(|ui| {
                let mut new = *point;
                for (value, axis) in new.iter_mut().zip(["in", "out"]) {
                    let allowed = Allowed::numbers(self.unit, -self.most, self.most);
                    let speed = (0.002 * self.span(curve)).max(1e-4);
                    let field = plain_field(ui, value, speed, 5, allowed);
                    field.accessible_name(format!("Point {} {axis} of {}", index + 1, self.name));
                    if axis == "in" {
                        ui.weak("becomes");
                    }
                }
                if new != *point {
                    typed = Some((index, new));
                }
            });
        }
        if let Some((index, [x, y])) = typed {
            let step = self.least_step * 1.001;
            let low = index.checked_sub(1).and_then(|i| curve.get(i)).map_or(-self.most, |before| before[0] + step);
            let high = curve.get(index + 1).map_or(self.most, |after| after[0] - step);
            if low <= high {
                curve[index] = [x.clamp(low, high), y];
            }
        }
    }

    /// Range of the axes: that of the points, and never too small to use.
    fn span(&self, curve: &Curve) -> f64 {
        let least = if self.most > 100.0 { 0.2 * self.most } else { 1.2 };
        curve.iter().flatten().fold(least.min(self.most), |span, v| span.max(v.abs() * 1.1)).min(self.most)
    }

    /// A number rounded for reading.
    fn rounded(v: f64, span: f64) -> f64 {
        let unit = 10.0_f64.powf((span * 0.004).log10().floor());
        (v / unit).round() * unit
    }

    fn move_point(&self, curve: &mut Curve, index: usize, [x, y]: [f64; 2]) {
        let step = self.least_step * 1.001;
        let low = index.checked_sub(1).and_then(|i| curve.get(i)).map_or(-self.most, |before| before[0] + step);
        let high = curve.get(index + 1).map_or(self.most, |after| after[0] - step);
        let span = self.span(curve);
        if let Some(point) = curve.get_mut(index).filter(|_| low <= high) {
            let tidy = |v: f64, low: f64, high: f64| {
                let near = Self::rounded(v, span);
                if (low..=high).contains(&near) { near } else { v.clamp(low, high) }
            };
            *point = [tidy(x, low, high), tidy(y, -self.most, self.most)];
        }
    }

    fn add_point(&self, curve: &mut Curve, [x, y]: [f64; 2]) {
        let free = curve.iter().all(|point| (point[0] - x).abs() > self.least_step * 2.0);
        if free && curve.len() < MAX_CURVE_POINTS {
            let at = curve.partition_point(|point| point[0] < x);
            curve.insert(at, [x, y]);
            self.move_point(curve, at, [x, y]);
        }
    }

    /// How often each number comes in, as columns from the lower edge.
    fn paint_inputs(&self, painter: &egui::Painter, plot: &Plot, visuals: &egui::Visuals) {
        let Some(inputs) = self.inputs else { return };
        let color = visuals.text_color().gamma_multiply(0.22);
        let (left, width) = (plot.rect.left(), plot.rect.width() / COLUMNS as f32);
        for (number, share) in
            columns(inputs, plot.span, COLUMNS).into_iter().enumerate().filter(|(_, share)| *share > 0.0)
        {
            let x = left + number as f32 * width;
            // What is rare stays visible.
            let top = plot.rect.bottom() - (share * 0.9 * plot.rect.height()).max(1.0);
            let column = Rect::from_min_max(egui::pos2(x, top), egui::pos2(x + width, plot.rect.bottom()));
            painter.rect_filled(column, 0.0, color);
        }
    }

    fn paint(&self, ui: &egui::Ui, plot: &Plot, curve: &Curve, marked: Option<usize>) {
        let visuals = ui.visuals();
        let painter = ui.painter_at(plot.rect.expand(4.0));
        painter.rect_filled(plot.rect.expand(4.0), 3.0, visuals.extreme_bg_color);
        let faint = egui::Stroke::new(1.0, visuals.weak_text_color().gamma_multiply(0.35));
        let at = |x: f64, y: f64| plot.pos([x, y]);
        let span = plot.span;
        self.paint_inputs(&painter, plot, visuals);
        painter.line_segment([at(-span, 0.0), at(span, 0.0)], faint);
        painter.line_segment([at(0.0, -span), at(0.0, span)], faint);
        painter.extend(egui::Shape::dashed_line(&[at(-span, -span), at(span, span)], faint, 4.0, 4.0));
        let steps = 96;
        let line = (0..=steps).map(|i| {
            let x = span * (f64::from(i) / f64::from(steps) * 2.0 - 1.0);
            at(x, curve_at(curve, x))
        });
        let stroke = egui::Stroke::new(1.5, visuals.selection.stroke.color);
        painter.add(egui::Shape::line(line.collect(), stroke));
        for (index, point) in curve.iter().enumerate() {
            let (radius, color) = if marked == Some(index) {
                (5.0, visuals.strong_text_color())
            } else {
                (3.5, visuals.selection.stroke.color)
            };
            painter.circle_filled(plot.pos(*point), radius, color);
        }
        let font = egui::TextStyle::Small.resolve(ui.style());
        let text = format!("{} {}", format_digits(span, DIGITS), self.unit.symbol());
        painter.text(plot.rect.right_bottom(), egui::Align2::RIGHT_BOTTOM, text, font, visuals.weak_text_color());
    }
}

/// Maps values to the screen and back.
struct Plot {
    rect: Rect,
    /// Both axes run from minus this to this.
    span: f64,
}

impl Plot {
    fn pos(&self, [x, y]: [f64; 2]) -> Pos2 {
        let share = |v: f64| (0.5 + 0.5 * v / self.span) as f32;
        self.rect.left_bottom() + egui::vec2(share(x) * self.rect.width(), -share(y) * self.rect.height())
    }

    fn value(&self, pos: Pos2) -> [f64; 2] {
        let share = (pos - self.rect.left_bottom()) / self.rect.size();
        [share.x, -share.y].map(|share| (f64::from(share) * 2.0 - 1.0) * self.span)
    }

    fn nearest(&self, curve: &Curve, pos: Pos2) -> Option<usize> {
        let away = |point: &[f64; 2]| self.pos(*point).distance(pos);
        let nearest = curve.iter().enumerate().min_by(|a, b| away(a.1).total_cmp(&away(b.1)))?;
        (away(nearest.1) < REACH).then_some(nearest.0)
    }
}
