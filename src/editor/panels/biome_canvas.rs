//! The picture of the biome table: cells, the share of land in each, the preview of the tool, the selection.

use crate::editor::painter::survey::Survey;
use crate::editor::painter::tools::{Block, Cell};
use crate::editor::widgets::{color32, ink_on};
use crate::planet::Biomes;
use eframe::egui::{self, Color32, Pos2, Rect, Stroke, StrokeKind, Vec2};

/// The table on screen.
#[derive(Clone, Copy, Debug)]
pub(super) struct Canvas {
    pub(super) rect: Rect,
    cell: Vec2,
}

/// Marks over the cells.
#[derive(Default)]
pub(super) struct Overlay<'a> {
    /// The share of land in each cell, if shown.
    pub(super) survey: Option<&'a Survey>,
    /// The cells that the tool would paint.
    pub(super) preview: Vec<Cell>,
    /// The colour that the tool would paint.
    pub(super) color: Color32,
    pub(super) selection: Option<Block>,
    /// The cell of the climate under the pointer on the planet.
    pub(super) here: Option<Cell>,
}

impl Canvas {
    pub(super) fn new(rect: Rect, biomes: &Biomes) -> Self {
        let (columns, rows) = (biomes.table.columns().max(1), biomes.table.rows().len().max(1));
        Self { rect, cell: egui::vec2(rect.width() / columns as f32, rect.height() / rows as f32) }
    }

    /// A point of the window in cells.
    pub(super) fn in_cells(&self, pos: Pos2) -> [f32; 2] {
        let at = (pos - self.rect.min) / self.cell;
        [at.x, at.y]
    }

    fn block(&self, block: Block) -> Rect {
        let corner = |[column, row]: Cell| self.rect.min + self.cell * egui::vec2(column as f32, row as f32);
        Rect::from_min_max(corner(block.first), corner([block.last[0] + 1, block.last[1] + 1]))
    }

    fn cell(&self, cell: Cell) -> Rect {
        self.block(Block { first: cell, last: cell })
    }

    pub(super) fn paint(&self, ui: &egui::Ui, biomes: &Biomes, overlay: &Overlay<'_>) {
        let painter = ui.painter_at(self.rect.expand(2.0));
        let side = self.cell.min_elem();
        // Gaps make large cells countable; small cells would vanish between them.
        let gap = if side >= 9.0 { 0.5 } else { 0.0 };
        for (row, keys) in biomes.table.rows().iter().enumerate() {
            for (column, key) in keys.chars().enumerate() {
                let biome = biomes.index_of(key).and_then(|index| biomes.palette.get(index));
                let color = biome.map_or(ui.visuals().error_fg_color, |biome| color32(biome.color));
                let rect = self.cell([column, row]);
                painter.rect_filled(rect.shrink(gap), 0.0, color);
                let share = overlay.survey.map_or(0.0, |survey| survey.cell(column, row) / survey.most.max(1e-12));
                if share > 0.0 {
                    // The area of the dot is proportional to the share of land.
                    let radius = (0.42 * side * share.sqrt() as f32).max(0.7);
                    painter.circle_filled(rect.center(), radius, ink_on(color).gamma_multiply(0.55));
                }
            }
        }
        for &cell in &overlay.preview {
            let rect = self.cell(cell);
            painter.rect_filled(rect.shrink(gap), 0.0, overlay.color);
            painter.rect_stroke(
                rect,
                0.0,
                Stroke::new(1.0, ink_on(overlay.color).gamma_multiply(0.7)),
                StrokeKind::Inside,
            );
        }
        if let Some(selection) = overlay.selection {
            outline(&painter, self.block(selection), Color32::WHITE);
        }
        if let Some(cell) = overlay.here {
            outline(&painter, self.cell(cell).expand(1.0), Color32::from_rgb(255, 196, 40));
        }
    }
}

/// A bright line between dark ones: visible on every colour.
fn outline(painter: &egui::Painter, rect: Rect, color: Color32) {
    painter.rect_stroke(rect, 0.0, Stroke::new(3.5, Color32::from_black_alpha(200)), StrokeKind::Middle);
    painter.rect_stroke(rect, 0.0, Stroke::new(1.5, color), StrokeKind::Middle);
}
