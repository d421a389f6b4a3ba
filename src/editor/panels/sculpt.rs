//! The sculpt tab: the tool in hand, and the parameters of the selected edit. The list of edits is in `edit_list`.

use super::biomes::names;
use super::{Draft, edit_list, edit_points, rest};
use crate::editor::command::{Action, SculptAction};
use crate::editor::state::describe;
use crate::editor::viewport::sculpt::{SculptLink, tidy_km};
use crate::editor::widgets::params_grid::{Grid, params_grid};
use crate::editor::widgets::row_view::{LockView, RowView};
use crate::planet::edits::{Flatten, GroundEdit, LifePaint, MaskPaint, PlacedObject, edit_path};
use crate::planet::param::{Choice, ParamPath};
use crate::planet::{Mask, PaintedMask, Planet, TableRows, Tool};
use eframe::egui;
use std::path::Path;
use std::sync::Arc;

/// The change of the radius by one key.
const STEP: f64 = 1.25;
/// Radius that a brush has at first: a share of the altitude of the eye, so that its mark is seen, and at most a share
/// of the planet's radius.
const FIRST_OF_ALTITUDE: f64 = 0.03;
const FIRST_OF_RADIUS: f64 = 0.04;
/// Least radius at first, kilometres.
const LEAST_FIRST_KM: f64 = 0.005;
/// What the measure tool does.
const MEASURES: &str = "Drag to measure a way and its profile; click point after point for longer ways and areas, Enter \
                        ends one, Escape forgets it.";
/// First step of the paths of the brush's parameters.
pub const BRUSH: &str = "brush";
/// Parameters of an edit that have rows of their own.
const OWN_ROWS: [&str; 3] = ["name", "enabled", "points"];
/// Parameters of an edit that a brush does not have.
const NOT_OF_BRUSH: [&str; 4] = ["name", "enabled", "points", "seed"];
/// Parameters of tools that change the ground alone.
const OF_GROUND: [&str; 4] = ["limit", "blend", "above_m", "below_m"];
/// Parameters of tools that a painted mask limits.
const OF_MASKED: [&str; 2] = ["mask", "outside_mask"];
/// Parameters of stamps alone.
const OF_STAMPS: [&str; 3] = ["copies", "spread_km", "smallest"];

/// The tool in hand and the selection.
#[derive(Default)]
pub struct SculptState {
    /// The brush of each tool that was in hand.
    brushes: Vec<(usize, GroundEdit)>,
    /// Index of the tool.
    tool: usize,
    /// Whether the tool is in hand: then drags on the planet sculpt.
    in_hand: bool,
    /// Whether drags and clicks measure.
    measures: bool,
    /// Index of the edit whose parameters are shown.
    pub selected: Option<usize>,
    /// Altitude of the eye; 0 before the first picture.
    altitude_m: f64,
    /// Words that edits in the list must have.
    pub(super) find: String,
    pub(super) scroll_to: Option<usize>,
    /// Share that is done of edits that are being baked.
    pub(super) baked: Option<f64>,
}

impl SculptState {
    /// What the tab has in hand.
    pub fn link(&self) -> SculptLink {
        let brush = self.brushes.iter().find(|(tool, _)| *tool == self.tool).map(|(_, brush)| brush);
        let brush = brush.filter(|_| self.in_hand).cloned().map(Arc::new);
        SculptLink { brush, selected: self.selected, measures: self.measures }
    }

    /// Notes how high the eye is: a new brush fits the view.
    pub fn note_altitude(&mut self, altitude_m: f64) {
        self.altitude_m = altitude_m;
    }

    /// Notes how far edits are that are being baked; None if none are.
    pub fn note_baking(&mut self, done: Option<f64>) {
        self.baked = done;
    }

    /// Selects an edit.
    pub fn select(&mut self, index: usize) {
        (self.selected, self.scroll_to) = (Some(index), Some(index));
    }

    /// Carries out what a command asks for.
    pub fn act(&mut self, planet: &Planet, action: SculptAction) {
        match action {
            SculptAction::Take(tool) => (self.tool, self.in_hand, self.measures) = (tool, true, false),
            SculptAction::PaintMask { layer, mask } => self.take_mask(planet, layer, mask),
            SculptAction::PaintLife(index) => self.take_life(planet, index),
            SculptAction::Select(index) => self.select(index),
            SculptAction::PutDown => (self.in_hand, self.measures) = (!self.in_hand, false),
            SculptAction::Measure => (self.in_hand, self.measures) = (false, !self.measures),
            SculptAction::Larger => self.brush(planet).radius_km = tidy_km(self.brush(planet).radius_km * STEP),
            SculptAction::Smaller => self.brush(planet).radius_km = tidy_km(self.brush(planet).radius_km / STEP),
        }
        self.brush(planet);
    }

    /// Takes the mask tool in hand, for a painted mask of a layer.
    fn take_mask(&mut self, planet: &Planet, layer: usize, mask: usize) {
        let mask = planet.layers.get(layer).and_then(|layer| layer.masks.get(mask));
        if let Some(Mask::Painted(PaintedMask { mask, .. })) = mask {
            self.take_mask_named(planet, mask);
        }
    }

    /// Takes the mask tool in hand, for the mask of this name.
    fn take_mask_named(&mut self, planet: &Planet, mask: &str) {
        let tool = Tool::Mask(MaskPaint::default()).index();
        (self.tool, self.in_hand, self.measures) = (tool, true, false);
        if let Tool::Mask(paint) = &mut self.brush(planet).tool {
            mask.clone_into(&mut paint.mask);
        }
    }

    /// Takes the life tool in hand, for a population.
    fn take_life(&mut self, planet: &Planet, index: usize) {
        let Some(population) = planet.life.get(index) else { return };
        let tool = Tool::Life(LifePaint::default()).index();
        (self.tool, self.in_hand, self.measures) = (tool, true, false);
        if let Tool::Life(paint) = &mut self.brush(planet).tool {
            paint.population.clone_from(&population.name);
        }
    }

    /// Gives the picture tool in hand a picture.
    pub fn set_picture(&mut self, planet: &Planet, file: &Path) {
        if let Tool::Picture(stamp) = &mut self.brush(planet).tool {
            stamp.file = file.to_string_lossy().into_owned().into();
        }
    }

    /// The brush of the tool; a new one fits the planet.
    fn brush(&mut self, planet: &Planet) -> &mut GroundEdit {
        let at = self.brushes.iter().position(|(tool, _)| *tool == self.tool).unwrap_or_else(|| {
            let most_km = FIRST_OF_RADIUS * planet.radius_km;
            let seen_km = if self.altitude_m > 0.0 { FIRST_OF_ALTITUDE * 1e-3 * self.altitude_m } else { most_km };
            let radius_km = tidy_km(seen_km.max(LEAST_FIRST_KM).min(most_km));
            let tool = Tool::of_kind(self.tool).unwrap_or_default();
            self.brushes.push((self.tool, GroundEdit { radius_km, ..GroundEdit::of(tool) }));
            self.brushes.len() - 1
        });
        if let Tool::Biome(paint) = &mut self.brushes[at].1.tool
            && planet.biomes.index_of(paint.biome).is_none()
            && let Some(first) = planet.biomes.palette.first()
        {
            paint.biome = first.key;
        }
        if let Tool::Life(LifePaint { population: name, .. }) | Tool::Object(PlacedObject { population: name, .. }) =
            &mut self.brushes[at].1.tool
            && planet.life.iter().all(|population| population.name != *name)
        {
            name.clear();
        }
        &mut self.brushes[at].1
    }
}

/// Shows the tab.
pub fn show(ui: &mut egui::Ui, state: &mut SculptState, draft: &mut Draft<'_>) {
    state.selected = state.selected.filter(|index| *index < draft.planet.edits.len());
    if !draft.shown.filter.is_active() {
        tools(ui, state, draft);
        ui.separator();
    }
    rest(ui, draft, "sculpt", |ui, draft| {
        if !draft.shown.filter.is_active() {
            if state.in_hand {
                brush(ui, state, draft);
                ui.separator();
            }
            edit_list::show(ui, state, draft);
        }
        selected(ui, state, draft);
    });
}

/// The tools, to take one in hand.
fn tools(ui: &mut egui::Ui, state: &mut SculptState, draft: &mut Draft<'_>) {
    ui.horizontal_wrapped(|ui| {
        ui.spacing_mut().item_spacing = egui::vec2(4.0, 4.0);
        for (tool, (label, doc)) in Tool::LABELS.iter().zip(Tool::DOCS).enumerate() {
            let is_held = state.in_hand && state.tool == tool;
            let button = ui.selectable_label(is_held, *label).on_hover_text(*doc);
            if button.accessible_name(format!("Tool {label}")).clicked() {
                (state.tool, state.in_hand, state.measures) = (tool, !is_held, false);
                state.brush(draft.planet);
            }
        }
        let measure = ui.selectable_label(state.measures, "Measure").on_hover_text(MEASURES);
        if measure.accessible_name("Tool Measure").clicked() {
            (state.in_hand, state.measures) = (false, !state.measures);
        }
    });
    let told = match (state.in_hand, Tool::of_kind(state.tool)) {
        _ if state.measures => MEASURES,
        (false, _) => {
            "Choose a tool to sculpt. Without one, drags move the camera; points of the selected edit move, with Ctrl the \
             whole edit, with Shift it turns; the square draws its radius and turns a picture."
        }
        (true, Some(tool)) if tool.is_stamp() => {
            "Click to place it; drag to draw its size. Alt and drag moves the camera; [ and ] change the size."
        }
        (true, Some(tool)) if tool.is_line() => {
            "Click point after point, and Enter; a click on the first closes the line. Or drag. Alt and drag moves the \
             camera; [ and ] change the size."
        }
        (true, Some(Tool::Raise(_))) => {
            "Drag to raise, with Shift to lower. Alt and drag moves the camera; [ and ] change the size."
        }
        (true, Some(Tool::Life(_))) => {
            "Drag to plant, with Shift to clear. Alt and drag moves the camera; [ and ] change the size."
        }
        _ => "Drag over the ground. Alt and drag moves the camera; [ and ] change the size.",
    };
    ui.weak(told);
}

/// The parameters of the brush.
fn brush(ui: &mut egui::Ui, state: &mut SculptState, draft: &mut Draft<'_>) {
    let sea_m = draft.planet.sea_level_m();
    let tool = state.tool;
    let brush = state.brush(draft.planet);
    let owner = "brush";
    // A path that no planet has: what is said of parameters of the planet is not said of these.
    let base = ParamPath::default().join(BRUSH);
    let locks = LockView::none();
    let shown = RowView { locks: &locks, ..draft.shown };
    let biomes = names(&draft.planet.biomes);
    let skip = skipped(&NOT_OF_BRUSH, &brush.tool);
    let grid = Grid { base, owner, skip: &skip, shown, biomes: &biomes };
    let default_tool = Tool::of_kind(tool).unwrap_or_default();
    let mut default = GroundEdit { radius_km: brush.radius_km, ..GroundEdit::of(default_tool) };
    let before = brush.tool.index();
    let browse = params_grid(ui, &grid, brush, &mut default);
    draft.commands.extend(browse.map(Action::Browse));
    if let (Tool::Flatten(Flatten { height_m, .. }), Some(sea_m)) = (&mut brush.tool, sea_m) {
        let told = "Flatten to the level of the sea";
        if ui.button("Sea level").on_hover_text(told).accessible_name("Height of brush: sea level").clicked() {
            *height_m = sea_m;
        }
    }
    idle_tool(ui, draft.planet, &brush.tool);
    let mask = paint_mask(ui, brush, owner);
    // The grid also offers the choice of the tool.
    let after = brush.tool.index();
    if after != before {
        let changed = brush.clone();
        state.brushes.retain(|(tool, _)| *tool != after && *tool != before);
        state.brushes.push((after, changed));
        state.tool = after;
    }
    if let Some(mask) = mask {
        state.take_mask_named(draft.planet, &mask);
    }
}

/// The parameters of the selected edit.
fn selected(ui: &mut egui::Ui, state: &mut SculptState, draft: &mut Draft<'_>) {
    let Some(index) = state.selected else { return };
    let Some(before) = draft.planet.edits.get(index) else { return };
    let (mut edit, name) = (before.clone(), before.name.clone());
    if !draft.shown.filter.is_active() {
        ui.add_space(6.0);
        ui.horizontal(|ui| {
            let label = ui.label("Name");
            let field = egui::TextEdit::singleline(&mut edit.name).char_limit(48).desired_width(ui.available_width());
            ui.add(field).labelled_by(label.id).accessible_name("Name of edit");
        });
    }
    let renamed = edit.name != name;
    let tool = Tool::of_kind(edit.tool.index()).unwrap_or_default();
    let mut default = GroundEdit::of(tool);
    let biomes = names(&draft.planet.biomes);
    let skip = skipped(&OWN_ROWS, &edit.tool);
    let grid = Grid { base: edit_path(index), owner: &name, skip: &skip, shown: draft.shown, biomes: &biomes };
    let browse = params_grid(ui, &grid, &mut edit, &mut default);
    draft.commands.extend(browse.map(Action::Browse));
    idle_tool(ui, draft.planet, &edit.tool);
    if let Some(mask) = paint_mask(ui, &edit, &name) {
        state.take_mask_named(draft.planet, &mask);
    }
    if !draft.shown.filter.is_active() {
        edit_points::show(ui, &mut edit);
    }
    // Looked at first: a list that is to be changed is copied.
    let is_changed = draft.planet.edits.get(index) != Some(&edit);
    if is_changed && let Some(now) = draft.planet.edits.get_mut(index) {
        // Planets with this edit alone: the difference of thousands takes long.
        let [was, is] =
            [&*now, &edit].map(|edit| Planet { edits: [edit.clone()].into_iter().collect(), ..Planet::default() });
        let label = if renamed { "Rename edit".to_owned() } else { describe::change(&was, &is) };
        *now = edit;
        draft.name_edit(label);
    }
}

/// The button that paints the mask of an edit. Gives the name of the mask if it was clicked.
fn paint_mask(ui: &mut egui::Ui, edit: &GroundEdit, owner: &str) -> Option<String> {
    let mask = edit.limiting_mask()?;
    let told = if edit.is_scattered() { "Paint where the copies lie" } else { "Paint where the edit acts" };
    let button = ui.button(format!("Paint \u{201C}{mask}\u{201D}")).on_hover_text(format!("{told}; with Shift erase"));
    button.accessible_name(format!("Paint mask of {owner}")).clicked().then(|| mask.to_owned())
}

/// Parameters that are not shown: those of a list, and those that a tool does not read.
fn skipped(list: &[&'static str], tool: &Tool) -> Vec<&'static str> {
    let ground: &[&'static str] = if tool.is_paint() { &OF_GROUND } else { &[] };
    let stamp: &[&'static str] = if tool.is_stamp() { &[] } else { &OF_STAMPS };
    let fades: &[&'static str] = match tool {
        Tool::River(_) => &["softness"],
        Tool::Object(_) => &["radius_km", "softness", "raggedness"],
        _ => &[],
    };
    let mask: &[&'static str] = if tool.reads_mask() { &[] } else { &OF_MASKED };
    [list, ground, stamp, fades, mask].concat()
}

/// Says why a tool does nothing, or not all.
fn idle_tool(ui: &mut egui::Ui, planet: &Planet, tool: &Tool) {
    if let Tool::Picture(stamp) = tool
        && stamp.file.path().is_empty()
    {
        ui.weak("Choose a height picture (PNG or OpenEXR) with Browse: white is high, black is low.");
    }
    if let (Tool::Clouds(_), None) = (tool, &planet.clouds) {
        ui.weak("The planet has no clouds: switch them on in the Clouds tab, or nothing is painted.");
    }
    if matches!(tool, Tool::Life(_) | Tool::Object(_)) && planet.life.is_empty() {
        ui.weak("The planet has no population: add one in the Life tab, or nothing is planted.");
    }
    if tool.is_structural() && planet.structure.is_none() {
        ui.weak("The planet has no structure that could answer: give it one in the Structure tab.");
    }
    if let Tool::Mask(paint) = tool {
        let is_of_layer = |mask: &Mask| matches!(mask, Mask::Painted(painted) if painted.mask == paint.mask);
        let is_of_edit = |edit: &GroundEdit| edit.limiting_mask() == Some(&*paint.mask);
        if !planet.layers.iter().flat_map(|layer| &layer.masks).any(is_of_layer) && !planet.edits.iter().any(is_of_edit)
        {
            ui.weak(
                "No layer and no edit has a mask of this name: give one to a layer in the Terrain tab, or to an edit.",
            );
        }
    }
    let Tool::Biome(paint) = tool else { return };
    let biomes = &planet.biomes;
    if !biomes.table.rows().iter().any(|row| row.contains(paint.biome)) {
        ui.weak("No cell of the biome table has this biome: give it one in the Biomes tab, or nothing is painted.");
    } else if biomes.rows == TableRows::Elevation {
        ui.weak("The rows of the biome table are heights: only moisture is painted.");
    }
}
