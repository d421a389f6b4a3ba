//! The points of the selected edit as numbers: where each is, how wide and how strong the edit is there.

use crate::planet::Tool;
use crate::planet::edits::{EditPoint, GroundEdit, LEAST_WIDTH, MOST_WIDTH};
use eframe::egui::{self, DragValue, Ui};

/// Height of a row, in points of the window.
const ROW: f32 = 20.0;
/// Rows that are seen at once.
const ROWS: f32 = 8.0;
/// Width and strength where a line tapers out.
const TIP: f64 = 0.1;

/// The share of the width of a line at a share of its length.
type Taper = fn(f64) -> f64;

/// Ways to taper a line: the name, what it does, and the taper.
const TAPERS: [(&str, &str, Taper); 3] = [
    ("Even", "As wide and as strong everywhere", |_| 1.0),
    ("Taper end", "Narrow and weak at the last point", |along| 1.0 - along),
    ("Taper both", "Narrow and weak at both ends", |along| (std::f64::consts::PI * along).sin()),
];

/// Shows them, folded at first.
pub fn show(ui: &mut Ui, edit: &mut GroundEdit) {
    let count = edit.points.0.len();
    let title = if count == 1 { "1 point".to_owned() } else { format!("{count} points") };
    egui::CollapsingHeader::new(title).id_salt("points of edit").show(ui, |ui| {
        // Rivers are as wide as their water.
        let tapers = !matches!(edit.tool, Tool::River(_));
        if count > 1 && !edit.tool.is_stamp() && tapers {
            ui.horizontal(|ui| {
                for (label, told, share) in TAPERS {
                    if ui.small_button(label).on_hover_text(told).clicked() {
                        taper(&mut edit.points.0, share);
                    }
                }
            });
        }
        let is_road = matches!(edit.tool, Tool::Road(_));
        ui.horizontal(|ui| {
            let heads = ["Latitude", "Longitude", "Height", "Width", "Strength"];
            for (column, head) in heads.into_iter().enumerate().filter(|(column, _)| match column {
                2 => is_road,
                column => *column < 2 || tapers,
            }) {
                let size = egui::vec2(width_of(column), ROW);
                ui.add_sized(size, egui::Label::new(egui::RichText::new(head).weak().small()));
            }
        });
        let area = egui::ScrollArea::vertical().id_salt("rows of points").max_height(ROWS * ROW);
        area.auto_shrink([false, true]).show_rows(ui, ROW, count, |ui, rows| {
            for number in rows {
                if let Some(point) = edit.points.0.get_mut(number) {
                    row(ui, number, point, (is_road, tapers));
                }
            }
        });
    });
}

/// Room of a column, in points of the window.
fn width_of(column: usize) -> f32 {
    if column < 2 { 74.0 } else { 58.0 }
}

fn row(ui: &mut Ui, number: usize, point: &mut EditPoint, (is_road, tapers): (bool, bool)) {
    ui.horizontal(|ui| {
        let mut field = |column: usize, name: &str, value: &mut f64, drag: fn(DragValue<'_>) -> DragValue<'_>| {
            let response = ui.add_sized(egui::vec2(width_of(column), ROW), drag(DragValue::new(value)));
            response.accessible_name(format!("{name} of point {}", number + 1));
        };
        field(0, "Latitude", &mut point.latitude_deg, |drag| {
            drag.speed(0.01).range(-90.0..=90.0).suffix("°").max_decimals(5)
        });
        field(1, "Longitude", &mut point.longitude_deg, |drag| {
            drag.speed(0.01).range(-180.0..=180.0).suffix("°").max_decimals(5)
        });
        if is_road {
            field(2, "Height", &mut point.height_m, |drag| {
                drag.speed(1.0).range(-1e5..=1e5).suffix(" m").max_decimals(1)
            });
        }
        if !tapers {
            return;
        }
        field(3, "Width", &mut point.width, |drag| drag.speed(0.01).range(LEAST_WIDTH..=MOST_WIDTH).max_decimals(3));
        field(4, "Strength", &mut point.strength, |drag| drag.speed(0.01).range(0.0..=1.0).max_decimals(3));
    });
}

/// Gives the points of a line widths and strengths by their places along it.
fn taper(points: &mut [EditPoint], share: Taper) {
    let dirs: Vec<glam::DVec3> = points.iter().map(EditPoint::direction).collect();
    let steps = dirs.windows(2).map(|pair| pair[0].distance(pair[1]));
    let mut lengths = vec![0.0];
    lengths.extend(steps.scan(0.0, |along, step| {
        *along += step;
        Some(*along)
    }));
    let all = lengths.last().copied().unwrap_or(0.0).max(1e-12);
    for (point, along) in points.iter_mut().zip(lengths) {
        let size = ((TIP + (1.0 - TIP) * share(along / all)).clamp(TIP, 1.0) * 1000.0).round() / 1000.0;
        (point.width, point.strength) = (size, size);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_line_tapers_by_its_length_and_not_by_its_points() {
        let at = |lon_deg: f64| EditPoint { longitude_deg: lon_deg, ..EditPoint::default() };
        let mut points = [0.0, 1.0, 5.0, 10.0].map(at);
        taper(&mut points, TAPERS[1].2);
        let near = |found: [f64; 4], wanted: [f64; 4]| found.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 0.01);
        assert!(near(points.map(|point| point.width), [1.0, 0.91, 0.55, 0.1]), "{points:?}");
        taper(&mut points, TAPERS[2].2);
        assert!(near(points.map(|point| point.strength), [0.1, 0.378, 1.0, 0.1]), "{points:?}");
        taper(&mut points, TAPERS[0].2);
        assert!(points.iter().all(|point| point.width == 1.0 && point.strength == 1.0));
    }
}
