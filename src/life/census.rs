//! Census: about how many objects of each population stand on a whole planet.

use super::grid::HECTARE_M2;
use super::suitability::Suitability;
use crate::planet::Population;
use crate::sphere::spread;
use crate::terrain::edits::{Planting, PopulationId};
use crate::terrain::{Sample, Scratch, Terrain, Wanted};
use glam::DVec3;
use std::f64::consts::PI;

/// Number of directions. Half of the objects are known to about a hundredth, a hundredth of them to a tenth.
const DIRECTIONS: usize = 24_576;

impl Terrain {
    /// Estimated number of objects of each population of the planet, from samples at directions of equal areas: 0 for
    /// one that is off; None for one that asks for water near, whose belts are narrower than such samples tell. It
    /// takes some tenths of a second.
    pub fn estimated_objects(&self) -> Vec<Option<f64>> {
        let planet = self.planet();
        let dirs: Vec<DVec3> = spread(DIRECTIONS).collect();
        let mut samples = vec![Sample::default(); DIRECTIONS];
        // Single valleys and rivers do not count.
        let spacing_rad = (4.0 * PI / DIRECTIONS as f64).sqrt();
        let wanted = Wanted { water: false, bank: false, ..Wanted::HEIGHT.and_biome().and_for_life(planet) };
        self.samples_spaced_into(&dirs, spacing_rad, wanted, &mut samples, &mut Scratch::default());
        let hectares = 4.0 * PI * planet.radius_m().powi(2) / HECTARE_M2 / DIRECTIONS as f64;
        let (edits, mut planted) = (self.life_edits(), Vec::new());
        let mut count = |population: &Population| {
            if !population.enabled {
                return Some(0.0);
            }
            if population.asks_bank() {
                return None;
            }
            planted.clear();
            if let Some(edits) = edits {
                edits.planted(Some(PopulationId::of(&population.name)), &dirs, &mut planted);
            }
            planted.resize(DIRECTIONS, Planting::NONE);
            let suitability = Suitability::new(planet, population);
            let shares = samples.iter().zip(&planted).map(|(sample, planting)| suitability.planted(sample, *planting));
            Some(shares.sum::<f64>() * population.per_hectare * hectares)
        };
        planet.life.iter().map(&mut count).collect()
    }
}

#[cfg(test)]
mod tests {
    use crate::planet::{Planet, Population};
    use crate::terrain::Terrain;
    use std::f64::consts::PI;
    use std::sync::Arc;

    #[test]
    fn a_sphere_that_suits_everywhere_has_its_density_times_its_area() {
        let everywhere = Population { per_hectare: 20.0, ..Population::default() };
        let life = vec![
            everywhere.clone(),
            Population { height_from_m: 19_000.0, ..everywhere.clone() },
            Population { enabled: false, ..everywhere.clone() },
            Population { bank_to_m: 30.0, ..everywhere },
        ];
        let planet = Planet { life, layers: Vec::new(), radius_km: 100.0, ..Planet::default() };
        let found = Terrain::try_new(Arc::new(planet)).unwrap().estimated_objects();
        let all = 4.0 * PI * 100.0_f64.powi(2) * 100.0 * 20.0;
        assert!((found[0].unwrap() / all - 1.0).abs() < 1e-3, "{found:?} {all}");
        assert_eq!(found[1..], [Some(0.0), Some(0.0), None]);
    }
}
