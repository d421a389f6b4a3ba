//! All parameters of a part, a row for each, under the headings of their sections. A filter lists them in the order of
//! the file. A new parameter shows without code here.

use super::param_row::{BiomeName, Row, param_row};
use super::problem_at;
use super::row_view::RowView;
use crate::editor::panels::sections::{Section, sections_of};
use crate::planet::param::{ParamPath, Params, Segment, Value};
use eframe::egui;

/// Radius of the dot that marks a folded section with changed values.
const DOT_RADIUS: f32 = 2.5;

/// The part to show.
pub struct Grid<'a> {
    /// The path of the part in the planet.
    pub base: ParamPath,
    /// The owner of the parameters in accessible names: "Continents", "climate".
    pub owner: &'a str,
    /// Fields that are not shown.
    pub skip: &'a [&'a str],
    /// Problems, the filter, and the row that was searched for.
    pub shown: RowView<'a>,
    /// The biomes of the palette, if a parameter refers to one.
    pub biomes: &'a [BiomeName],
}

/// Shows the parameters of `part`; their reset buttons restore the values of `default`. Gives the path of the parameter
/// for which the user wants to choose a file.
pub fn params_grid(
    ui: &mut egui::Ui,
    grid: &Grid<'_>,
    part: &mut dyn Params,
    default: &mut dyn Params,
) -> Option<ParamPath> {
    params_grid_with(ui, grid, part, default, &mut |_, _| {})
}

/// As [`params_grid`]; `below` adds widgets below the row of the parameter at a path.
pub fn params_grid_with(
    ui: &mut egui::Ui,
    grid: &Grid<'_>,
    part: &mut dyn Params,
    default: &mut dyn Params,
    below: &mut dyn FnMut(&mut egui::Ui, &ParamPath),
) -> Option<ParamPath> {
    let (now, defaults) = (values(part, &grid.base), values(default, &grid.base));
    let mut rows = Rows { grid, now, defaults, browse: None, below };
    let sections = if grid.shown.filter.is_active() { &[] } else { sections_of(&grid.base) };
    rows.show(ui, part, |field| !sections.iter().any(|section| section.fields.contains(&field)));
    for section in sections {
        rows.section(ui, section, part);
    }
    rows.browse
}

/// The value of a parameter. The path alone does not tell: the kind of a landform has the path of the part itself.
type Known = (ParamPath, &'static str, Value);

struct Rows<'a> {
    grid: &'a Grid<'a>,
    /// The values at the start of the frame.
    now: Vec<Known>,
    defaults: Vec<Known>,
    browse: Option<ParamPath>,
    below: &'a mut dyn FnMut(&mut egui::Ui, &ParamPath),
}

impl Rows<'_> {
    /// The field of the part that a path leads through.
    fn field(&self, path: &ParamPath) -> Option<&'static str> {
        match path.segments().get(self.grid.base.segments().len()) {
            Some(Segment::Field(field)) => Some(field),
            _ => None,
        }
    }

    fn section(&mut self, ui: &mut egui::Ui, section: &Section, part: &mut dyn Params) {
        let (mut is_empty, mut is_changed) = (true, false);
        for (path, name, value) in &self.now {
            let field = self.field(path).unwrap_or_default();
            if section.fields.contains(&field) && !self.grid.skip.contains(&field) {
                is_empty = false;
                let is_default = |(at, of, default): &Known| at == path && of == name && default == value;
                is_changed = is_changed || !self.defaults.iter().any(is_default);
            }
        }
        if is_empty {
            return;
        }
        let reveals = section.fields.iter().any(|field| self.grid.shown.reveals_in(&self.grid.base.join(field)));
        let header = egui::CollapsingHeader::new(section.title)
            .id_salt((self.grid.base.part(), section.title))
            .default_open(section.open)
            .open(reveals.then_some(true));
        let shown = header.show(ui, |ui| {
            for field in section.fields {
                self.show(ui, part, |other| other == *field);
            }
        });
        if is_changed && shown.fully_closed() {
            let rect = shown.header_response.rect;
            let center = egui::pos2(rect.right() + 8.0, rect.center().y);
            ui.painter().circle_filled(center, DOT_RADIUS, ui.visuals().hyperlink_color);
            shown.header_response.on_hover_text("Some values here differ from the defaults");
        }
    }

    /// Shows the rows of the fields that are `wanted`.
    fn show(&mut self, ui: &mut egui::Ui, part: &mut dyn Params, wanted: impl Fn(&str) -> bool) {
        let grid = self.grid;
        part.each_param(&mut grid.base.clone(), &mut |path, param, value| {
            let field = self.field(path).unwrap_or_default();
            if grid.skip.contains(&field) || !wanted(field) || !grid.shown.passes(path, param) {
                return;
            }
            let default = self.defaults.iter().find(|(at, name, _)| at == path && *name == param.name);
            let row = Row {
                param,
                path,
                owner: grid.owner,
                default: default.map(|(_, _, value)| value),
                problem: problem_at(grid.shown.problems, path),
                idle: grid.shown.planet.idle(path),
                planet: grid.shown.planet,
                biomes: grid.biomes,
                takes_focus: grid.shown.takes_focus(path, param.name),
                locks: grid.shown.locks,
                curves: grid.shown.curves,
            };
            if grid.shown.marked(ui, path, param.name, |ui| param_row(ui, &row, value)) {
                self.browse = Some(path.clone());
            }
            (self.below)(ui, path);
        });
    }
}

fn values(part: &mut dyn Params, base: &ParamPath) -> Vec<Known> {
    let mut values = Vec::new();
    part.each_param(&mut base.clone(), &mut |path, param, value| {
        values.push((path.clone(), param.name, value.get()));
    });
    values
}
