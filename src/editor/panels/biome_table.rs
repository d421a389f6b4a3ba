//! The biome table as a grid to paint on: a click or a drag paints, a right click picks.

use super::biome_edit;
use crate::editor::widgets::color32;
use crate::planet::{Biomes, TableRows};
use eframe::egui;

/// What was done to the table in this frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TableOutput {
    /// Cells changed: a stroke is under way.
    pub painted: bool,
    /// The biome under a right click.
    pub picked: Option<usize>,
    /// The cell under the pointer: column, row.
    pub hovered: Option<(usize, usize)>,
}

/// Shows the table; `selected` is the biome that is painted with.
pub fn show(ui: &mut egui::Ui, biomes: &mut Biomes, selected: usize) -> TableOutput {
    let mut output = TableOutput::default();
    let (columns, rows) = (biomes.table.columns(), biomes.table.rows().len());
    if columns == 0 || rows == 0 {
        return output;
    }
    let (first, last) = match biomes.rows {
        TableRows::Temperature => ("hot", "cold"),
        TableRows::Elevation => ("high", "low"),
    };
    ui.small(first);
    let width = ui.available_width();
    let size = egui::vec2(width, (width * rows as f32 / columns as f32).clamp(48.0, 230.0));
    let (rect, response) = ui.allocate_exact_size(size, egui::Sense::click_and_drag());
    response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Biome table"));
    let cell_size = egui::vec2(rect.width() / columns as f32, rect.height() / rows as f32);
    let cell_at = |pos: egui::Pos2| {
        let at = (pos - rect.min) / cell_size;
        let inside = rect.contains(pos) && at.x >= 0.0 && at.y >= 0.0;
        inside.then(|| ((at.x as usize).min(columns - 1), (at.y as usize).min(rows - 1)))
    };

    output.hovered = response.hover_pos().and_then(cell_at);
    let pointer = response.interact_pointer_pos();
    if let (Some(pos), Some(biome)) = (pointer, biomes.palette.get(selected)) {
        let key = biome.key;
        let primary = ui.input(|i| i.pointer.primary_down()) && response.is_pointer_button_down_on();
        if primary || response.clicked() {
            // A fast stroke skips cells from one frame to the next: paint along its way.
            let way = if response.dragged() { response.drag_delta() } else { egui::Vec2::ZERO };
            for step in 0..=32 {
                if let Some((column, row)) = cell_at(pos - way * (step as f32 / 32.0))
                    && biomes.table.key(column, row) != Some(key)
                {
                    biomes.table.set_key(column, row, key);
                    output.painted = true;
                }
            }
        }
    }
    if response.secondary_clicked()
        && let Some((column, row)) = pointer.and_then(cell_at)
    {
        output.picked = biomes.table.key(column, row).and_then(|key| biome_edit::index_of(biomes, key));
    }

    paint(ui, biomes, rect, cell_size, output.hovered);
    ui.horizontal(|ui| {
        ui.small(last);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            ui.small("dry to wet: left to right");
        });
    });
    output
}

fn paint(ui: &egui::Ui, biomes: &Biomes, rect: egui::Rect, cell_size: egui::Vec2, hovered: Option<(usize, usize)>) {
    let painter = ui.painter_at(rect);
    let cell_rect = |column: usize, row: usize| {
        egui::Rect::from_min_size(rect.min + cell_size * egui::vec2(column as f32, row as f32), cell_size)
    };
    for (row, keys) in biomes.table.rows().iter().enumerate() {
        for (column, key) in keys.chars().enumerate() {
            let color = biome_edit::index_of(biomes, key)
                .and_then(|index| biomes.palette.get(index))
                .map_or(ui.visuals().error_fg_color, |biome| color32(biome.color));
            painter.rect_filled(cell_rect(column, row).shrink(0.5), 0.0, color);
        }
    }
    if let Some((column, row)) = hovered {
        let stroke = egui::Stroke::new(1.5, ui.visuals().strong_text_color());
        painter.rect_stroke(cell_rect(column, row), 0.0, stroke, egui::StrokeKind::Inside);
    }
}
