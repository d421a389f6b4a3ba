//! What the surface is: the compiled evaluator that everything asks.
use crate::planet::Planet;
use glam::DVec3;
use std::sync::Arc;

/// The compiled evaluator of one planet.
pub struct Terrain {
    planet: Arc<Planet>,
}

/// What the surface is at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Height of the ground above the reference sphere (below the sea too).
    pub height_m: f64,
    /// Unit normal of the ground in the planet frame.
    pub normal_planet: DVec3,
    /// Angle between the ground and the horizontal.
    pub slope_rad: f64,
    /// Temperature at the surface (of the sea, where there is sea).
    pub temperature_c: f64,
    /// Moisture, 0 to 1.
    pub moisture: f64,
    /// Index of the biome in the palette.
    pub biome: usize,
    /// What each layer of the preset adds there, in its order: its output in metres after blend and masks.
    pub layers_m: Vec<f64>,
}

impl Terrain {
    /// Compiles a planet. The planet must be valid (as loaded or checked by `planet::validate`).
    pub fn new(planet: Arc<Planet>) -> Self {
        Self { planet }
    }
    /// The planet it was compiled from.
    pub fn planet(&self) -> &Arc<Planet> {
        &self.planet
    }
    /// The surface under a direction from the planet's centre (of any length but zero).
    pub fn sample(&self, _dir_planet: DVec3) -> Sample {
        Sample {
            height_m: 0.0,
            normal_planet: DVec3::Z,
            slope_rad: 0.0,
            temperature_c: 0.0,
            moisture: 0.0,
            biome: 0,
            layers_m: vec![],
        }
    }
    /// Height alone.
    pub fn height_m(&self, _dir_planet: DVec3) -> f64 {
        0.0
    }
    /// Heights of many directions, on all cores.
    pub fn heights_m(&self, dirs_planet: &[DVec3]) -> Vec<f64> {
        dirs_planet.iter().map(|&d| self.height_m(d)).collect()
    }
    /// Distance along a ray from `origin_planet_m` to the ground or the sea's surface, whichever comes first.
    pub fn raycast(&self, _origin_planet_m: DVec3, _dir_planet: DVec3) -> Option<f64> {
        None
    }
    /// Lowest and highest height the planet can have (conservative).
    pub fn height_bounds_m(&self) -> (f64, f64) {
        (0.0, 0.0)
    }
}
