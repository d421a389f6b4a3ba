//! The biome table as a widget: gestures paint strokes, letters choose biomes.

use super::biome_canvas::{Canvas, Overlay};
use crate::editor::painter::is_chord;
use crate::editor::painter::survey::Survey;
use crate::editor::painter::tools::{Block, Brush, Cell, CellPos, Gesture, Tool, cell_at};
use crate::editor::widgets::{color32, keys_are_taken};
use crate::planet::{Biomes, Table, TableRows};
use crate::render::MarkedCells;
use eframe::egui;

/// The table's id: while it has the focus, letters choose biomes.
pub(super) fn id() -> egui::Id {
    egui::Id::unique("biome table")
}

/// The tool, the brush and the gesture under way. Not part of the document.
#[derive(Default)]
pub struct PainterState {
    /// The tool in hand.
    pub tool: Tool,
    /// The brush.
    pub brush: Brush,
    /// The cells within which tools paint, if not all; their ground lights up on the planet.
    pub selection: Option<Block>,
    gesture: Option<Gesture>,
    /// Whether the gesture began in an earlier frame: the pointer's path in this frame belongs to it.
    moves: bool,
    strokes: u32,
    /// End of the last stroke: Shift draws a line from there.
    last_end: Option<CellPos>,
    /// The cell under the pointer when the table was painted, or changed by an undo. Highlights and previews do not
    /// cover the new cells until the pointer moves to another cell.
    quiet: Option<Cell>,
    /// The table at the end of the last frame.
    left: Option<Table>,
}

/// What the user did with the table in this frame.
#[derive(Clone, Debug, Default)]
pub struct TableOutput {
    /// Name of the undo step, if a stroke is under way.
    pub painted: Option<&'static str>,
    /// The biome that was picked.
    pub picked: Option<usize>,
    /// The cell under the pointer.
    pub hovered: Option<Cell>,
    /// Cells whose ground lights up on the planet.
    pub marked: Option<MarkedCells>,
}

/// What is shown over the table.
pub struct Shown<'a> {
    /// The share of land in each cell, if shown.
    pub survey: Option<&'a Survey>,
    /// The cell of the climate under the pointer on the planet.
    pub here: Option<Cell>,
}

impl PainterState {
    /// Shows the table; `selected` is the index of the biome to paint.
    pub fn show(&mut self, ui: &mut egui::Ui, biomes: &mut Biomes, selected: usize, shown: &Shown<'_>) -> TableOutput {
        let mut output = TableOutput::default();
        let (columns, rows) = (biomes.table.columns(), biomes.table.rows().len());
        if columns == 0 || rows == 0 {
            return output;
        }
        let (first, last) = match biomes.rows {
            TableRows::Temperature => {
                (format!("hot, {:.0} °C", biomes.hottest_c), format!("cold, {:.0} °C", biomes.coldest_c))
            }
            TableRows::Elevation => {
                (format!("high, {:.0} m", biomes.highest_m), format!("low, {:.0} m", biomes.lowest_m))
            }
        };
        ui.small(first);
        let width = ui.available_width();
        let size = egui::vec2(width, (width * rows as f32 / columns as f32).clamp(64.0, width.min(320.0)));
        let rect = ui.allocate_space(size).1;
        let response = ui.interact(rect, id(), egui::Sense::click_and_drag());
        response.widget_info(|| egui::WidgetInfo::labeled(egui::Role::Canvas, true, "Biome table"));
        let canvas = Canvas::new(rect, biomes);
        let changed_elsewhere = self.left.as_ref().is_some_and(|left| *left != biomes.table);
        self.keys(ui, &response, biomes, &mut output);
        self.pointer(ui, &response, &canvas, biomes, selected, &mut output);
        let hovered = response.hover_pos().filter(|pos| rect.contains(*pos)).map(|pos| canvas.in_cells(pos));
        output.hovered = hovered.map(|at| cell_at(&biomes.table, at));

        if changed_elsewhere {
            self.quiet = output.hovered;
        }
        self.quiet = self.quiet.filter(|quiet| output.hovered == Some(*quiet));
        let previewed = hovered.filter(|_| self.gesture.is_none() && self.quiet.is_none());
        let preview = previewed.map(|at| self.preview(ui, biomes, selected, at)).unwrap_or_default();
        if self.left.as_ref() != Some(&biomes.table) {
            self.left = Some(biomes.table.clone());
        }
        output.marked = self.marked(biomes, output.hovered, &preview);
        let color = biomes.palette.get(selected).map_or(egui::Color32::WHITE, |biome| color32(biome.color));
        let selecting = self.gesture.as_ref().filter(|gesture| gesture.tool() == Tool::Select).map(Gesture::block);
        let selection = selecting.or(self.selection);
        let paints = !matches!(self.tool, Tool::Pick | Tool::Select);
        let overlay = Overlay {
            survey: shown.survey,
            preview: if paints { preview } else { Vec::new() },
            color,
            selection,
            here: shown.here,
        };
        canvas.paint(ui, biomes, &overlay);
        ui.horizontal(|ui| {
            ui.small(last);
            ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
                ui.small("dry to wet: left to right");
            });
        });
        output
    }

    /// The cells that a press here would paint.
    fn preview(&self, ui: &egui::Ui, biomes: &Biomes, selected: usize, at: CellPos) -> Vec<Cell> {
        let Some(biome) = biomes.palette.get(selected) else { return Vec::new() };
        let modifiers = ui.input(|i| i.modifiers);
        if matches!(self.tool, Tool::Pick | Tool::Select) || is_chord(modifiers) {
            return vec![cell_at(&biomes.table, at)];
        }
        let new =
            |from| Gesture::new(self.tool, biome.key, self.brush, self.selection, &biomes.table, from, self.strokes);
        let line_from = self.last_end.filter(|_| self.tool == Tool::Brush && modifiers.shift);
        let mut gesture = new(line_from.unwrap_or(at));
        gesture.go_to(at, false);
        gesture.cells(modifiers.shift)
    }

    /// The cells that light up: none during a stroke, so that its ground is visible; those under the pointer; or else
    /// the selection.
    fn marked(&self, biomes: &Biomes, hovered: Option<Cell>, preview: &[Cell]) -> Option<MarkedCells> {
        let (columns, rows) = (biomes.table.columns(), biomes.table.rows().len());
        let stroke = self.gesture.as_ref().is_some_and(|gesture| gesture.tool() != Tool::Select);
        if stroke || self.quiet.is_some() {
            return None;
        }
        if hovered.is_some() && !preview.is_empty() {
            return Some(MarkedCells::new(columns, rows, |column, row| preview.contains(&[column, row])));
        }
        let selection = self.gesture.as_ref().map(Gesture::block).or(self.selection)?;
        Some(MarkedCells::new(columns, rows, |column, row| selection.contains([column, row])))
    }

    fn keys(&mut self, ui: &egui::Ui, response: &egui::Response, biomes: &Biomes, output: &mut TableOutput) {
        if response.contains_pointer() && !ui.ctx().text_edit_focused() && !ui.input(|i| i.pointer.any_down()) {
            response.request_focus();
        }
        // An open menu takes the keys.
        if !response.has_focus() || keys_are_taken(ui.ctx()) {
            return;
        }
        if ui.input(|i| i.key_pressed(egui::Key::Escape)) {
            self.selection = None;
        }
        let typed: Vec<char> = ui.input(|i| {
            let texts = i.events.iter().filter_map(|event| match event {
                egui::Event::Text(text) => Some(text.as_str()),
                _ => None,
            });
            texts.flat_map(str::chars).collect()
        });
        for letter in typed {
            match (biomes.index_of(letter), letter) {
                (Some(index), _) => output.picked = Some(index),
                (None, '[') => self.brush.size = (self.brush.size - 1).max(1),
                (None, ']') => self.brush.size = (self.brush.size + 1).min(Brush::LARGEST),
                _ => {}
            }
        }
    }

    fn pointer(
        &mut self,
        ui: &egui::Ui,
        response: &egui::Response,
        canvas: &Canvas,
        biomes: &mut Biomes,
        selected: usize,
        output: &mut TableOutput,
    ) {
        let (modifiers, origin, down, secondary) =
            ui.input(|i| (i.modifiers, i.pointer.press_origin(), i.pointer.primary_down(), i.pointer.secondary_down()));
        // The pointer may have left the table when the button is released: the stroke still goes there.
        let still = self.gesture.is_some().then(|| ui.input(|i| i.pointer.interact_pos())).flatten();
        let Some(pos) = response.interact_pointer_pos().or(still) else {
            self.end();
            return;
        };
        let at = canvas.in_cells(pos);
        let held = response.is_pointer_button_down_on();
        let primary = (held && down) || response.clicked() || (self.gesture.is_some() && !secondary);
        let picks = self.tool == Tool::Pick || is_chord(modifiers);
        if self.gesture.is_none() && ((held && secondary) || response.secondary_clicked() || (primary && picks)) {
            let [column, row] = cell_at(&biomes.table, at);
            output.picked = biomes.table.key(column, row).and_then(|key| biomes.index_of(key));
            return;
        }
        if primary && let Some(biome) = biomes.palette.get(selected) {
            let mut gesture = self.gesture.take().unwrap_or_else(|| {
                self.strokes = self.strokes.wrapping_add(1);
                let begin = canvas.in_cells(origin.filter(|_| down).unwrap_or(pos));
                let line_from = self.last_end.filter(|_| self.tool == Tool::Brush && modifiers.shift);
                let from = line_from.unwrap_or(begin);
                // The number of the preview: the stroke paints the cells of the preview.
                let number = self.strokes - 1;
                Gesture::new(self.tool, biome.key, self.brush, self.selection, &biomes.table, from, number)
            });
            // A fill keeps its first cell: the cell under the pointer is filled already.
            if gesture.tool() != Tool::Fill {
                // The whole path since the last frame, not its end alone.
                let path = ui.input(|i| {
                    let moved = i.events.iter().filter_map(|event| match event {
                        egui::Event::PointerMoved(pos) if self.moves => Some(*pos),
                        _ => None,
                    });
                    moved.collect::<Vec<_>>()
                });
                for pos in path {
                    gesture.go_to(canvas.in_cells(pos), modifiers.shift);
                }
                gesture.go_to(at, modifiers.shift);
            }
            if gesture.tool() == Tool::Select {
                let block = gesture.block();
                self.selection = (block.first != block.last).then_some(block);
            } else {
                let table = gesture.table(modifiers.shift);
                if table != biomes.table {
                    biomes.table = table;
                }
                output.painted = Some(gesture.tool().step());
                self.quiet = Some(cell_at(&biomes.table, at));
            }
            self.gesture = Some(gesture);
            self.moves = true;
        }
        if !(held && down) {
            self.end();
        }
    }

    fn end(&mut self) {
        self.moves = false;
        if let Some(gesture) = self.gesture.take() {
            self.last_end = Some(gesture.at());
        }
    }
}
