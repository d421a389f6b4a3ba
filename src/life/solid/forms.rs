//! Solid forms of a planet: the shapes of each population that is hit, in all variants, measured once.

use super::shape::Shape;
use crate::life::placement::Placement;
use crate::planet::Form;
use crate::terrain::Terrain;
use crate::terrain::edits::PopulationId;
use rayon::prelude::*;

/// A population that is hit.
pub(super) struct SolidForm {
    pub(super) placement: Placement,
    /// One for each variant.
    pub(super) shapes: Vec<Shape>,
    /// Greatest distance of an object's surface from the ground at its foot.
    pub(super) reach_m: f64,
}

/// The populations of a terrain that are hit: those that are on and solid, and have a shape. On all cores.
pub(super) fn of_terrain(terrain: &Terrain) -> Vec<SolidForm> {
    let placements = Placement::all(terrain.planet()).into_par_iter().filter(|placement| placement.population().solid);
    let forms = placements.map(|placement| {
        let population = placement.population();
        let shapes: Vec<Shape> =
            (0..Form::VARIANTS).into_par_iter().map(|variant| Shape::new(population, variant)).collect();
        let reach = shapes.iter().map(|shape| shape.reach).fold(0.0, f64::max);
        let id = PopulationId::of(&population.name);
        let placed = terrain.life_edits().map_or(0.0, |edits| edits.largest_placed(id, placement.index == 0));
        let largest = (1.0 + population.height_spread).max(placed);
        let reach_m = (reach + population.sunk) * population.height_m * largest;
        SolidForm { placement, shapes, reach_m }
    });
    forms.filter(|form| form.reach_m > 0.0 && form.shapes.iter().any(|shape| !shape.parts.is_empty())).collect()
}
