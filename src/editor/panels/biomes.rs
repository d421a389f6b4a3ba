//! The biomes tab: the table to paint on, the palette, and what the table's axes mean.

use super::{Draft, biome_edit, biome_table};
use crate::editor::widgets::param_row::{Row, color_button, param_row};
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::editor::widgets::{color32, ink_on};
use crate::planet::param::{ParamPath, ParamValue, Segment, Value};
use crate::planet::{Biome, Biomes, MAX_BIOMES, Table};
use eframe::egui;

/// Live state of the tab.
#[derive(Default)]
pub struct BiomesState {
    /// Index of the biome that is painted with.
    pub selected: usize,
}

/// Shows the tab.
pub fn show(ui: &mut egui::Ui, state: &mut BiomesState, draft: &mut Draft<'_>) {
    state.selected = state.selected.min(draft.planet.biomes.palette.len().saturating_sub(1));
    table(ui, state, draft);
    ui.separator();
    palette(ui, state, draft);
    ui.separator();
    selected(ui, state, draft);
    ui.separator();
    ui.strong("Table");
    sides(ui, draft);
    let base = ParamPath::from(vec![Segment::Field("biomes")]);
    let grid = Grid { base, owner: "biomes", skip: &["palette", "table"], problems: draft.problems };
    params_grid(ui, &grid, &mut draft.planet.biomes, &mut Biomes::default());
}

fn table(ui: &mut egui::Ui, state: &mut BiomesState, draft: &mut Draft<'_>) {
    let output = biome_table::show(ui, &mut draft.planet.biomes, state.selected);
    if output.painted {
        draft.name_edit("Paint biomes");
    }
    if let Some(picked) = output.picked {
        state.selected = picked;
    }
    let biomes = &draft.planet.biomes;
    // The line is always there, so that nothing jumps when the pointer comes and goes.
    let text = match output.hovered {
        Some((column, row)) => {
            let key = biomes.table.key(column, row).unwrap_or(' ');
            let biome = biome_edit::index_of(biomes, key).and_then(|index| biomes.palette.get(index));
            let name = biome.map_or("No biome", |biome| biome.name.as_str());
            format!("{name}: {}", biome_edit::cell_range(biomes, column, row))
        }
        None => "Click or drag paints the selected biome, right click picks one.".to_owned(),
    };
    ui.add(egui::Label::new(egui::RichText::new(text).small().weak()).truncate());
    for (path, problem) in draft.problems {
        if path.segments().get(1) == Some(&Segment::Field("table")) {
            ui.colored_label(ui.visuals().error_fg_color, problem);
        }
    }
}

fn palette(ui: &mut egui::Ui, state: &mut BiomesState, draft: &mut Draft<'_>) {
    ui.horizontal(|ui| {
        ui.strong("Palette");
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            let biomes = &mut draft.planet.biomes;
            let mut label = None;
            ui.add_enabled_ui(biomes.palette.len() > 1, |ui| {
                ui.menu_button("Remove", |ui| {
                    ui.weak("Its cells become");
                    for replacement in 0..biomes.palette.len() {
                        let name = biomes.palette[replacement].name.clone();
                        if replacement != state.selected && ui.button(name).clicked() {
                            biome_edit::remove(biomes, state.selected, replacement);
                            label = Some("Remove biome");
                            ui.close();
                            break;
                        }
                    }
                });
            });
            if ui.add_enabled(biomes.palette.len() < MAX_BIOMES, egui::Button::new("Add biome")).clicked() {
                state.selected = biome_edit::add(biomes).unwrap_or(state.selected);
                label = Some("Add biome");
            }
            if let Some(label) = label {
                draft.name_edit(label);
            }
        });
    });
    for (index, biome) in draft.planet.biomes.palette.iter_mut().enumerate() {
        ui.push_id(index, |ui| {
            ui.horizontal(|ui| {
                color_button(ui, &format!("Palette colour of {}", biome.name), &mut biome.color);
                let fill = color32(biome.color);
                let key = egui::RichText::new(format!(" {} ", biome.key)).monospace();
                ui.label(key.background_color(fill).color(ink_on(fill)));
                let chosen = state.selected == index;
                let button = egui::Button::selectable(chosen, (biome.name.as_str(), egui::Atom::grow())).truncate();
                let response = ui.add(button.min_size(egui::vec2(ui.available_width(), 20.0)));
                if response.accessible_name(format!("Biome {}", biome.name)).clicked() {
                    state.selected = index;
                }
            });
        });
    }
}

fn selected(ui: &mut egui::Ui, state: &mut BiomesState, draft: &mut Draft<'_>) {
    let index = state.selected;
    let base = ParamPath::from(vec![Segment::Field("biomes"), Segment::Field("palette"), Segment::Index(index)]);
    let Some(biome) = draft.planet.biomes.palette.get_mut(index) else { return };
    let name = biome.name.clone();
    let mut key = biome.key;
    // The key stands in the table too, so it is changed through both.
    if let Some(param) = Biome::PARAMS.iter().find(|param| param.name == "key") {
        let path = base.join("key");
        let default = Value::Letter(biome.key);
        let row = Row { param, path: &path, owner: &name, default: Some(&default), problem: None };
        param_row(ui, &row, key.value_mut());
    }
    let grid = Grid { base, owner: &name, skip: &["key"], problems: draft.problems };
    let mut default = Biome { name: name.clone(), ..Biome::default() };
    params_grid(ui, &grid, biome, &mut default);
    if key != biome.key && biome_edit::rekey(&mut draft.planet.biomes, index, key) {
        draft.name_edit("Change key of biome");
    }
}

fn sides(ui: &mut egui::Ui, draft: &mut Draft<'_>) {
    let table = &draft.planet.biomes.table;
    let (mut columns, mut rows) = (table.columns(), table.rows().len());
    ui.horizontal(|ui| {
        ui.label("Cells");
        for (side, name, tooltip) in
            [(&mut columns, "Columns", "Steps from dry to wet"), (&mut rows, "Rows", "Steps from first to last row")]
        {
            let range = Table::MIN_SIDE..=Table::MAX_SIDE;
            // Taken over when done, so that typing "16" does not squeeze everything into one column first.
            let number = egui::DragValue::new(side).range(range).speed(0.1).update_while_editing(false);
            ui.add(number).on_hover_text(tooltip).accessible_name(format!("{name} of biome table"));
            ui.weak(name.to_lowercase());
        }
    });
    if (columns, rows) != (table.columns(), table.rows().len()) {
        draft.planet.biomes.table = biome_edit::resized(table, columns, rows);
        draft.name_edit("Resize biome table");
    }
}
