//! All parameters of a part, one row each, in the order of the file: a new parameter shows up by itself.

use super::param_row::{Row, param_row};
use super::problem_at;
use crate::planet::param::{ParamPath, Params, Segment, Value};
use eframe::egui;

/// What is shown of a part, and how it is called.
pub struct Grid<'a> {
    /// Where the part stands in the planet.
    pub base: ParamPath,
    /// Whose parameters they are, in accessible names: "Continents", "climate".
    pub owner: &'a str,
    /// Fields that are shown elsewhere.
    pub skip: &'a [&'a str],
    /// Everything wrong with the planet.
    pub problems: &'a [(ParamPath, String)],
    /// Key and name of each biome of the palette, where parameters name one.
    pub biomes: &'a [(char, String)],
}

/// Shows the parameters of `part`; `default` is what their reset buttons go back to. Gives the one for
/// which a file is to be chosen.
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
        // Some parameters stand at the path of the part itself, such as the kind of a shape.
        let default = defaults.iter().find(|(at, name, _)| at == path && *name == param.name).map(|(_, _, v)| v);
        let problem = problem_at(grid.problems, path);
        let row = Row { param, path, owner: grid.owner, default, problem, biomes: grid.biomes };
        if param_row(ui, &row, value) {
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
