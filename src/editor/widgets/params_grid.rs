//! All parameters of a part, a row for each, in the order of the file. New parameters need no code here.

use super::param_row::{Row, param_row};
use super::problem_at;
use super::row_view::RowView;
use crate::planet::param::{ParamPath, Params, Segment, Value};
use eframe::egui;

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
    /// Key and name of each biome of the palette, if a parameter refers to one.
    pub biomes: &'a [(char, String)],
}

/// Shows the parameters of `part`; their reset buttons restore the values of `default`. Gives the path of the parameter
/// for which the user wants to choose a file.
pub fn params_grid(
    ui: &mut egui::Ui,
    grid: &Grid<'_>,
    part: &mut dyn Params,
    default: &mut dyn Params,
) -> Option<ParamPath> {
    let mut browse = None;
    let defaults = values(default, &grid.base);
    let depth = grid.base.segments().len();
    part.each_param(&mut grid.base.clone(), &mut |path, param, value| {
        if let Some(Segment::Field(field)) = path.segments().get(depth)
            && grid.skip.contains(field)
        {
            return;
        }
        if !grid.shown.passes(path, param) {
            return;
        }
        // The path alone does not tell: the kind of a landform has the path of the part itself.
        let default = defaults.iter().find(|(at, name, _)| at == path && *name == param.name).map(|(_, _, v)| v);
        let problem = problem_at(grid.shown.problems, path);
        let takes_focus = grid.shown.takes_focus(path, param.name);
        let (owner, biomes, locks) = (grid.owner, grid.biomes, grid.shown.locks);
        let row = Row { param, path, owner, default, problem, biomes, takes_focus, locks };
        if grid.shown.marked(ui, path, param.name, |ui| param_row(ui, &row, value)) {
            browse = Some(path.clone());
        }
    });
    browse
}

fn values(part: &mut dyn Params, base: &ParamPath) -> Vec<(ParamPath, &'static str, Value)> {
    let mut values = Vec::new();
    part.each_param(&mut base.clone(), &mut |path, param, value| {
        values.push((path.clone(), param.name, value.get()));
    });
    values
}
