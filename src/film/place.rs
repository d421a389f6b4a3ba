//! A planet's place in a system: the other bodies of a photograph.

use crate::planet::{InvalidPlanet, Planet};
use crate::render::{Body, Neighbour, Scene, Worlds};
use crate::terrain::{MapStore, Terrain};
use crate::tiles::build_over;
use glam::DVec3;
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A body of a system, from whose surroundings a photograph is taken.
#[derive(Clone)]
pub struct InSystem {
    worlds: Arc<Worlds>,
    body: usize,
    maps: Option<Arc<MapStore>>,
    /// The ground of the bodies that have been drawn.
    terrains: Arc<Mutex<HashMap<usize, Arc<Terrain>>>>,
}

impl InSystem {
    /// The body with a number. `maps`: where solved world maps are kept.
    pub fn new(worlds: Arc<Worlds>, body: usize, maps: Option<Arc<MapStore>>) -> Self {
        Self { worlds, body, maps, terrains: Arc::default() }
    }

    /// The system.
    pub fn worlds(&self) -> &Arc<Worlds> {
        &self.worlds
    }

    /// The number of the body.
    pub fn body(&self) -> usize {
        self.body
    }

    /// The planet of the body, lit by the system at a time; None for a star or a point.
    pub fn planet(&self, time_secs: f64) -> Option<Planet> {
        self.worlds.lit_planet(self.body, time_secs)
    }

    /// Lights a scene of the camera's own planet, and builds the other bodies that have a surface.
    ///
    /// # Errors
    /// A planet that cannot be evaluated.
    pub(super) fn others(&self, scene: &mut Scene<'_>, time_secs: f64) -> Result<Vec<Neighbour>, InvalidPlanet> {
        let eye_planet_m = scene.bodies.first().map_or(DVec3::ZERO, Body::eye_planet_m);
        let around = self.worlds.around(self.body, eye_planet_m, time_secs);
        let drawn = around.with_surface(&scene.projection, scene.size_px);
        around.light(scene, &drawn);
        let others = drawn.into_iter().filter(|number| *number != self.body);
        let built = others.map(|number| {
            let (position_m, scene_from_body) = around.place(number);
            let surface = build_over(&self.terrain(number)?, &scene.view_of(position_m, scene_from_body));
            Ok(around.neighbour(number, Arc::new(surface)))
        });
        built.collect()
    }

    fn terrain(&self, number: usize) -> Result<Arc<Terrain>, InvalidPlanet> {
        let mut terrains = self.terrains.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(terrain) = terrains.get(&number) {
            return Ok(terrain.clone());
        }
        let planet = self.worlds.planet(number).cloned().unwrap_or_default();
        let loaded = Terrain::load(planet.clone(), self.maps.clone(), &|_| true)?;
        // Nobody gives up.
        let terrain = Arc::new(loaded.map_or_else(|| Terrain::try_new(planet), Ok)?);
        terrains.insert(number, terrain.clone());
        Ok(terrain)
    }
}
