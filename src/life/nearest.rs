//! The nearest object of some populations.

use super::grid::angle;
use super::placement::Placement;
use super::query::{Instance, TooMany};
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use glam::DVec3;
use std::collections::HashSet;
use std::f64::consts::PI;

/// Objects that may stand in the first ring.
const FIRST: f64 = 400.0;
/// Factor from the radius of a ring to that of the next.
const GROWTH: f64 = 1.6;

/// The object that is nearest to a place.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct NearestObject {
    /// The object.
    pub instance: Instance,
    /// Distance of its place along the reference sphere.
    pub away_m: f64,
}

impl Terrain {
    /// The nearest object to a direction within a distance along the reference sphere, on all cores; None if there is
    /// none. `populations`: indices in [`Planet::life`](crate::planet::Planet::life); empty for all of them. `takes`
    /// says which objects count, such as those that are not hidden.
    ///
    /// It looks at rings of cells, each wider than the one before, until what is found is nearer than all that follow.
    ///
    /// # Errors
    /// [`TooMany`]: none is found among the first [`Terrain::MOST_INSTANCES`] that may stand there.
    pub fn nearest_object(
        &self,
        dir_planet: DVec3,
        within_m: f64,
        populations: &[u16],
        takes: &(dyn Fn(&Instance) -> bool + Sync),
    ) -> Result<Option<NearestObject>, TooMany> {
        let (dir, planet_m) = (dir_planet.normalize_or(DVec3::Z), self.planet().radius_m());
        // Nothing is farther than the other side.
        let within_m = if within_m > 0.0 { within_m.min(PI * planet_m) } else { 0.0 };
        let placements = Placement::of(self.planet(), populations);
        let most_per_m2: f64 = placements.iter().map(Placement::most_per_m2).sum();
        if placements.is_empty() {
            return Ok(None);
        }
        let away_m = |instance: &Instance| angle(instance.dir_planet, dir) * planet_m;
        let mut looked: HashSet<(u16, NodeId)> = HashSet::new();
        let mut best: Option<NearestObject> = None;
        let mut radius_m = (FIRST / (most_per_m2 * PI)).sqrt().max(1.0);
        loop {
            // Beyond what is found already nothing is nearer.
            radius_m = radius_m.min(best.map_or(within_m, |best| best.away_m));
            TooMany::check(&placements, radius_m)?;
            let ring = placements.iter().flat_map(|placement| {
                let cells = placement.grid.cells_within(dir, radius_m).into_iter();
                cells.map(move |cell| (placement, cell))
            });
            let ring = ring.filter(|(placement, cell)| looked.insert((placement.index, *cell))).collect();
            let is_wanted = |instance: &Instance| away_m(instance) <= within_m && takes(instance);
            self.place_cells(ring, &is_wanted, &mut |found| {
                let found = found.into_iter().map(|instance| NearestObject { instance, away_m: away_m(&instance) });
                best = best.into_iter().chain(found).min_by(|a, b| {
                    let name = |one: &NearestObject| (one.instance.population, one.instance.id);
                    a.away_m.total_cmp(&b.away_m).then(name(a).cmp(&name(b)))
                });
            });
            // What stands in cells that are farther is farther than the ring.
            if best.is_some_and(|best| best.away_m <= radius_m) || radius_m >= within_m {
                return Ok(best);
            }
            radius_m *= GROWTH;
        }
    }
}
