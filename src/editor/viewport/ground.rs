//! The ground under the camera: the evaluator of the surface on screen, or a sphere until there is one.

use super::camera::Ground;
use crate::giant::DEEPEST_M;
use crate::planet::Planet;
use crate::terrain::Terrain;
use glam::DVec3;

/// The ground of a planet, with its terrain as soon as there is one.
pub struct PlanetGround<'a> {
    planet: &'a Planet,
    terrain: Option<&'a Terrain>,
}

impl<'a> PlanetGround<'a> {
    /// Uses the terrain's own planet if there is a terrain: `planet` may be newer than the picture on screen.
    pub fn new(planet: &'a Planet, terrain: Option<&'a Terrain>) -> Self {
        Self { planet: terrain.map_or(planet, |terrain| terrain.planet()), terrain }
    }

    fn sea_or_zero_m(&self) -> f64 {
        self.planet.sea_level_m().unwrap_or(0.0)
    }
}

impl Ground for PlanetGround<'_> {
    fn radius_m(&self) -> f64 {
        self.planet.radius_m()
    }

    fn floor_radius_m(&self, dir_planet: DVec3) -> f64 {
        if self.planet.giant.is_some() {
            return self.planet.radius_m() - DEEPEST_M;
        }
        let height_m = self.terrain.map_or_else(|| self.sea_or_zero_m(), |terrain| terrain.height_m(dir_planet));
        self.planet.radius_m() + height_m
    }

    fn surface_radius_m(&self, dir_planet: DVec3) -> f64 {
        if self.planet.giant.is_some() {
            return self.planet.radius_m();
        }
        let sea_m = self.planet.sea_level_m().map_or(f64::MIN, |sea_m| self.planet.radius_m() + sea_m);
        self.floor_radius_m(dir_planet).max(sea_m)
    }

    fn raycast(&self, origin_planet_m: DVec3, dir_planet: DVec3) -> Option<f64> {
        if let Some(terrain) = self.terrain {
            return terrain.raycast(origin_planet_m, dir_planet);
        }
        let radius_m = self.planet.radius_m() + self.sea_or_zero_m();
        let along = -origin_planet_m.dot(dir_planet);
        let half_chord_sq = radius_m * radius_m - (origin_planet_m + dir_planet * along).length_squared();
        (along > 0.0 && half_chord_sq >= 0.0).then(|| along - half_chord_sq.sqrt())
    }
}
