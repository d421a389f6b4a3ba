//! A planet's place in a system: the other bodies of a photograph.

use crate::planet::Planet;
use crate::render::{Body, BodyId, RenderError, Scene, Worlds};
use crate::terrain::{Revision, Terrain};
use crate::tiles::{Surface, build_over};
use glam::{DQuat, DVec3};
use std::collections::HashMap;
use std::sync::{Arc, Mutex, PoisonError};

/// A body of a system, from whose surroundings a photograph is taken.
#[derive(Clone)]
pub struct InSystem {
    worlds: Arc<Worlds>,
    body: usize,
    /// The ground of the bodies that have been drawn.
    terrains: Arc<Mutex<HashMap<usize, Arc<Terrain>>>>,
}

/// Another body of the photograph.
pub(super) struct Other {
    id: BodyId,
    surface: Surface,
    revision: Revision,
    position_m: DVec3,
    scene_from_body: DQuat,
}

impl Other {
    /// The body, for a scene.
    pub(super) fn body(&self) -> Body<'_> {
        let mut body = Body::new(self.id, &self.surface, self.position_m);
        (body.revision, body.scene_from_body) = (self.revision.clone(), self.scene_from_body);
        body
    }
}

impl InSystem {
    /// The body with a number.
    pub fn new(worlds: Arc<Worlds>, body: usize) -> Self {
        Self { worlds, body, terrains: Arc::default() }
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

    /// Lights a scene of the camera's own planet, names that planet's body, and builds the others that have a surface.
    ///
    /// # Errors
    /// [`RenderError::Planet`]: a planet that cannot be evaluated.
    pub(super) fn others(&self, scene: &mut Scene<'_>, time_secs: f64) -> Result<Vec<Other>, RenderError> {
        let eye_planet_m = scene.bodies.first().map_or(DVec3::ZERO, Body::eye_planet_m);
        let around = self.worlds.around(self.body, eye_planet_m, time_secs);
        let drawn = around.with_surface(&scene.projection, scene.size_px);
        for own in &mut scene.bodies {
            own.id = BodyId(self.body as u32);
        }
        around.light(scene, &drawn);
        let mut others = Vec::new();
        for number in drawn.into_iter().filter(|number| *number != self.body) {
            let (position_m, scene_from_body) = around.place(number);
            let Some(lit) = self.worlds.lit_planet(number, time_secs) else { continue };
            let terrain = self.terrain(number)?;
            let revision = Revision::try_new(Arc::new(lit))?;
            let surface = build_over(&terrain, &scene.view_of(position_m, scene_from_body));
            others.push(Other { id: BodyId(number as u32), surface, revision, position_m, scene_from_body });
        }
        Ok(others)
    }

    fn terrain(&self, number: usize) -> Result<Arc<Terrain>, RenderError> {
        let mut terrains = self.terrains.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(terrain) = terrains.get(&number) {
            return Ok(terrain.clone());
        }
        let planet = self.worlds.planet(number).cloned().unwrap_or_default();
        let terrain = Terrain::try_new(planet)?;
        Ok(terrains.entry(number).or_insert(Arc::new(terrain)).clone())
    }
}
