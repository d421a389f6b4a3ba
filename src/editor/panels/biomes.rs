//! The biomes tab: the biome table with its tools, the palette, the selected biome, and the axes of the table.

use super::biome_palette::PaletteState;
use super::biome_table::{PainterState, Shown, TableOutput};
use super::{Draft, biome_edit, biome_palette, biome_table, owner_box, rest};
use crate::editor::command::{Action, Command};
use crate::editor::commands;
use crate::editor::painter::tools::{Brush, Cell, Tool};
use crate::editor::viewport::pointer::KnownPlace;
use crate::editor::viewport::{Click, TabLink};
use crate::editor::widgets::param_row::{BiomeName, Row, param_row};
use crate::editor::widgets::params_grid::{Grid, params_grid, params_grid_with};
use crate::editor::widgets::typed::{Allowed, typed_field};
use crate::editor::widgets::{color32, menu_button};
use crate::planet::param::{ParamPath, ParamValue, Segment, Unit, Value};
use crate::planet::{Biome, Biomes, Planet, STARTING_TABLES, Table};
use crate::render::MarkedCells;
use eframe::egui;
use std::sync::Arc;

/// Least number of columns and rows that the painter offers; a preset may have fewer.
const LEAST_CELLS: usize = 8;

/// Tools, selections and highlights.
pub struct BiomesState {
    /// The palette, with the biome to paint.
    pub palette: PaletteState,
    /// The tools.
    pub painter: PainterState,
    /// Whether the ground of the cells under the pointer lights up on the planet.
    lights_up: bool,
    /// Whether dots show the share of land in each cell.
    shows_land: bool,
    marked: Option<Arc<MarkedCells>>,
}

impl Default for BiomesState {
    fn default() -> Self {
        Self {
            palette: PaletteState::default(),
            painter: PainterState::default(),
            lights_up: true,
            shows_land: true,
            marked: None,
        }
    }
}

/// Whether the table takes letters and digits now.
pub fn has_keys(ctx: &egui::Context) -> bool {
    ctx.memory(|memory| memory.has_focus(biome_table::id()))
}

impl BiomesState {
    /// What the tab shows on the planet, and which clicks it takes.
    pub fn link(&self) -> TabLink {
        let picks = self.painter.tool == Tool::Pick;
        TabLink { marked: self.marked.clone(), paints: true, picks, ..TabLink::default() }
    }

    /// A click on the planet: chooses the biome there, or paints the cell of the climate there. Gives the name of the
    /// edit.
    pub fn clicked(&mut self, planet: &mut Planet, click: Click, under: &KnownPlace) -> Option<String> {
        match click {
            Click::Pick => {
                self.palette.selected = under.sample.biome;
                None
            }
            Click::Paint => {
                let key = planet.biomes.palette.get(self.palette.selected)?.key;
                let [column, row] = under.sample.cell;
                planet.biomes.table.set_key(column, row, key);
                Some("Paint climate of location".to_owned())
            }
            Click::Plate | Click::Plant(_) => None,
        }
    }

    fn light_up(&mut self, marked: Option<MarkedCells>) {
        let marked = marked.filter(|marked| self.lights_up && marked.count() > 0);
        // Equal cells keep their allocation, so that the picture stays the same.
        if self.marked.as_deref() != marked.as_ref() {
            self.marked = marked.map(Arc::new);
        }
    }
}

/// Shows the tab.
pub fn show(ui: &mut egui::Ui, state: &mut BiomesState, draft: &mut Draft<'_>) {
    let last = draft.planet.biomes.palette.len().saturating_sub(1);
    state.palette.selected = state.palette.selected.min(last);
    if draft.shown.filter.is_active() {
        state.light_up(None);
        let names = draft.planet.biomes.palette.iter().map(|biome| biome.name.as_str());
        owner_box(ui, "Biome", names, &mut state.palette.selected);
        selected(ui, &mut state.palette, draft);
        table_params(ui, draft);
        return;
    }
    toolbar(ui, state, draft);
    let output = table(ui, state, draft);
    ui.separator();
    rest(ui, draft, "palette", |ui, draft| palette_and_rules(ui, state, draft, output));
}

/// The palette, the selected biome, and the rules of table and surface.
fn palette_and_rules(ui: &mut egui::Ui, state: &mut BiomesState, draft: &mut Draft<'_>, output: TableOutput) {
    let hovered = biome_palette::show(ui, &mut state.palette, draft);
    let biomes = &draft.planet.biomes;
    let of_biome = hovered.and_then(|index| biomes.palette.get(index)).map(|biome| {
        let key = Some(biome.key);
        let (columns, rows) = (biomes.table.columns(), biomes.table.rows().len());
        MarkedCells::new(columns, rows, |column, row| biomes.table.key(column, row) == key)
    });
    state.light_up(of_biome.or(output.marked));
    ui.separator();
    selected(ui, &mut state.palette, draft);
    ui.separator();
    ui.strong("Table");
    sides(ui, draft);
    table_params(ui, draft);
}

/// The axes of the table, and the surface rules.
fn table_params(ui: &mut egui::Ui, draft: &mut Draft<'_>) {
    let base = ParamPath::from(vec![Segment::Field("biomes")]);
    let names = names(&draft.planet.biomes);
    let skip = &["palette", "table"];
    let grid = Grid { base, owner: "biomes", skip, shown: draft.shown, biomes: &names };
    params_grid(ui, &grid, &mut draft.planet.biomes, &mut Biomes::default());
}

/// The biomes as rows refer to them.
pub(super) fn names(biomes: &Biomes) -> Vec<BiomeName> {
    let named = |biome: &Biome| BiomeName { key: biome.key, name: biome.name.clone(), color: biome.color };
    biomes.palette.iter().map(named).collect()
}

fn toolbar(ui: &mut egui::Ui, state: &mut BiomesState, draft: &mut Draft<'_>) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing.x = 3.0;
        for tool in Tool::ALL {
            let chosen = state.painter.tool == tool;
            if ui.selectable_label(chosen, tool.label()).on_hover_text(tool.tooltip()).clicked() {
                state.painter.tool = tool;
            }
        }
    });
    ui.horizontal(|ui| {
        if matches!(state.painter.tool, Tool::Brush | Tool::Line) {
            let brush = &mut state.painter.brush;
            let (now, shown) = (brush.size as f64, brush.size.to_string());
            let size = egui::DragValue::new(&mut brush.size).speed(0.1).prefix("Size ");
            typed_field(ui, None, size, Allowed::whole(1, Brush::LARGEST as u32), &shown, now)
                .on_hover_text("Cells across; [ and ] make it smaller and larger")
                .accessible_name("Brush size");
            let mut percent = f64::from(brush.softness) * 100.0;
            let (now, shown) = (percent, format!("{percent:.0}"));
            let softness = egui::DragValue::new(&mut percent).fixed_decimals(0).speed(1.0);
            let softness = softness.prefix("Soft ").suffix(" %");
            let allowed = Allowed::numbers(Unit::None, 0.0, 100.0).marked(" %");
            let tooltip = "Width of the soft edge of the brush: there it paints single cells, fewer outwards";
            let field = typed_field(ui, None, softness, allowed, &shown, now);
            if field.on_hover_text(tooltip).accessible_name("Brush softness").changed() {
                brush.softness = (percent / 100.0) as f32;
            }
        }
        ui.toggle_value(&mut state.shows_land, "Land").on_hover_text("Dots show the share of land in each cell");
        let tooltip =
            "The ground of the cells under the pointer, or of the selection, lights up on the planet, without clouds";
        ui.toggle_value(&mut state.lights_up, "Highlight").on_hover_text(tooltip);
        ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), |ui| {
            menu_button(ui, "Tables", |ui| tables(ui, state, draft));
        });
    });
}

fn tables(ui: &mut egui::Ui, state: &mut BiomesState, draft: &mut Draft<'_>) {
    for start in STARTING_TABLES {
        if ui.button(start.name).on_hover_text(start.note).clicked()
            && let Some(biomes) = start.biomes()
        {
            draft.planet.biomes = biomes;
            draft.name_edit(format!("Start from table: {}", start.name));
            state.palette = PaletteState::default();
            state.painter.selection = None;
            ui.close();
        }
    }
    ui.separator();
    for row in [Command::ImportTable, Command::ExportTable].into_iter().filter_map(commands::row) {
        if ui.button(row.label).on_hover_text(row.tooltip).clicked() {
            draft.commands.send(row.command);
            ui.close();
        }
    }
}

fn table(ui: &mut egui::Ui, state: &mut BiomesState, draft: &mut Draft<'_>) -> TableOutput {
    let under = draft.under_pointer;
    let shown = Shown { survey: draft.survey.filter(|_| state.shows_land), here: under.map(|under| under.sample.cell) };
    let output = state.painter.show(ui, &mut draft.planet.biomes, state.palette.selected, &shown);
    if let Some(label) = output.painted {
        draft.name_edit(label);
    }
    if let Some(picked) = output.picked {
        state.palette.selected = picked;
    }
    let biomes = &draft.planet.biomes;
    let described = |[column, row]: Cell| {
        let biome =
            biomes.table.key(column, row).and_then(|key| biomes.index_of(key)).and_then(|i| biomes.palette.get(i));
        let name = biome.map_or("No biome", |biome| biome.name.as_str());
        format!("{name}: {}", biome_edit::cell_range(biomes, column, row))
    };
    // The line is always there, so that nothing moves when the pointer comes and goes.
    let text = match (output.hovered, shown.here) {
        (Some(cell), _) => {
            let land = draft.survey.map_or(0.0, |survey| survey.cell(cell[0], cell[1])) * 100.0;
            format!("{}; {land:.1} % of the land", described(cell))
        }
        (None, Some(cell)) => format!("Here: {}", described(cell)),
        (None, None) => "Right click or a biome's letter picks. Ctrl and click on the planet paints there.".to_owned(),
    };
    ui.add(egui::Label::new(egui::RichText::new(text).small().weak()).truncate());
    for (path, problem) in draft.shown.problems {
        if path.segments().get(1) == Some(&Segment::Field("table")) {
            ui.colored_label(ui.visuals().error_fg_color, problem);
        }
    }
    output
}

fn selected(ui: &mut egui::Ui, state: &mut PaletteState, draft: &mut Draft<'_>) {
    let index = state.selected;
    let names = names(&draft.planet.biomes);
    state.refused = state.refused.take().filter(|(refused, _)| *refused == index);
    let base = ParamPath::from(vec![Segment::Field("biomes"), Segment::Field("palette"), Segment::Index(index)]);
    let Some(biome) = draft.planet.biomes.palette.get_mut(index) else { return };
    let name = biome.name.clone();
    let mut key = biome.key;
    // The table holds the key too, so that a change goes through both.
    if let Some(param) = Biome::PARAMS.iter().find(|param| param.name == "key") {
        let path = base.join("key");
        let default = Value::Letter(biome.key);
        let problem = state.refused.as_ref().map(|(_, why)| why.as_str());
        let takes_focus = draft.shown.takes_focus(&path, param.name);
        let (owner, default, locks) = (name.as_str(), Some(&default), draft.shown.locks);
        let (curves, planet) = (draft.shown.curves, draft.shown.planet);
        let row = Row {
            param,
            path: &path,
            owner,
            default,
            problem,
            idle: None,
            planet,
            biomes: &[],
            takes_focus,
            locks,
            curves,
        };
        if draft.shown.passes(&path, param) {
            draft.shown.marked(ui, &path, param.name, |ui| param_row(ui, &row, key.value_mut()));
        }
    }
    let grid = Grid { base, owner: &name, skip: &["key"], shown: draft.shown, biomes: &names };
    let mut default = Biome { name: name.clone(), ..Biome::default() };
    // What the set is was known before the grid; its path may change within.
    let set = biome.textures.set().cloned();
    let textures = grid.base.join("textures");
    let mut takes_color = false;
    let mut below = |ui: &mut egui::Ui, path: &ParamPath| {
        if let Some(set) = set.as_ref().filter(|_| *path == textures) {
            takes_color |= take_color(ui, set.color);
        }
    };
    let browse = params_grid_with(ui, &grid, biome, &mut default, &mut below);
    draft.commands.extend(browse.map(Action::Browse));
    if let Some(set) = set.filter(|_| takes_color) {
        biome.color = set.color.map(|part| (part * 1e4).round() / 1e4);
        draft.label = Some("Take colour of textures".to_owned());
    }
    if key != biome.key {
        let refused = biome_edit::rekey(draft.planet, index, key).err();
        if refused.is_none() {
            draft.name_edit("Change key of biome");
        }
        state.refused = refused.map(|why| (index, why));
    }
}

/// The mean colour of a texture set. Whether the biome should have it.
fn take_color(ui: &mut egui::Ui, color: [f64; 3]) -> bool {
    let shown = |ui: &mut egui::Ui| {
        let tooltip = "Gives the biome the mean colour of the textures, which only vary the colour that it has";
        let button = ui.button("Take its colour").on_hover_text(tooltip);
        let (rect, _) = ui.allocate_exact_size(egui::Vec2::splat(ui.spacing().interact_size.y), egui::Sense::hover());
        ui.painter().rect_filled(rect.shrink(3.0), 2.0, color32(color));
        button.clicked()
    };
    ui.horizontal(|ui| ui.with_layout(egui::Layout::right_to_left(egui::Align::Center), shown).inner).inner
}

fn sides(ui: &mut egui::Ui, draft: &mut Draft<'_>) {
    let table = &draft.planet.biomes.table;
    let (mut columns, mut rows) = (table.columns(), table.rows().len());
    ui.horizontal(|ui| {
        ui.label("Cells");
        for (side, name, tooltip) in
            [(&mut columns, "Columns", "Steps from dry to wet"), (&mut rows, "Rows", "Steps from first to last row")]
        {
            let allowed = Allowed::whole(LEAST_CELLS.min(*side) as u32, Table::MAX_SIDE as u32);
            let (now, shown) = (*side as f64, side.to_string());
            let number = egui::DragValue::new(side).speed(0.1);
            typed_field(ui, None, number, allowed, &shown, now)
                .on_hover_text(tooltip)
                .accessible_name(format!("{name} of biome table"));
            ui.weak(name.to_lowercase());
        }
    });
    if (columns, rows) != (table.columns(), table.rows().len()) {
        draft.planet.biomes.table = biome_edit::resized(table, columns, rows);
        draft.name_edit("Resize biome table");
    }
}
