//! The other bodies of a system around the planet: their tiles, built in the background, and their places.

use super::Viewport;
use crate::film::InSystem;
use crate::lod::View;
use crate::planet::Planet;
use crate::render::{Neighbour, Projection, Scene, Worlds};
use crate::terrain::MapStore;
use crate::tiles::{Builder, BuilderOptions};
use eframe::egui;
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;

/// Memory for the tiles of one neighbour: it is far away.
const BUDGET_BYTES: usize = 64 << 20;

/// The neighbours of the planet.
pub(super) struct Neighbours {
    worlds: Arc<Worlds>,
    body: usize,
    builders: HashMap<usize, Builder>,
    maps: Option<Arc<MapStore>>,
}

/// The neighbours in one picture.
#[derive(Clone)]
pub(super) struct Sky {
    worlds: Arc<Worlds>,
    body: usize,
    drawn: Vec<usize>,
    pub(super) bodies: Vec<Neighbour>,
}

/// The planet's place among other bodies.
impl Viewport {
    /// The number of the planet among the bodies of its system; None if it is alone.
    pub fn body(&self) -> Option<usize> {
        self.neighbours.as_ref().map(Neighbours::body)
    }

    /// The planet's place in its system; None if it is alone.
    pub fn in_system(&self) -> Option<InSystem> {
        self.neighbours.as_ref().map(Neighbours::place)
    }

    /// The direction of the star over the planet now: that of the system, or of the preset.
    pub fn star_dir_planet(&self, planet: &Planet) -> DVec3 {
        let time_secs = self.settings.time_secs;
        let of_system = self.neighbours.as_ref().and_then(|neighbours| neighbours.star_dir_planet(time_secs));
        of_system.unwrap_or_else(|| planet.star.place(time_secs).direction())
    }

    /// Draws the planet as a body of a system, with the others around it; None draws it alone.
    pub fn set_system(&mut self, system: Option<(Arc<Worlds>, usize)>) {
        match (&mut self.neighbours, system) {
            (Some(neighbours), Some((worlds, body))) => neighbours.set(worlds, body),
            (_, system) => {
                self.neighbours = system.map(|(worlds, body)| Neighbours::new(worlds, body, self.maps.clone()));
            }
        }
    }
}

impl Neighbours {
    pub(super) fn new(worlds: Arc<Worlds>, body: usize, maps: Option<Arc<MapStore>>) -> Self {
        Self { worlds, body, builders: HashMap::new(), maps }
    }

    /// Takes the bodies of a changed system. Tiles that are still right stay.
    pub(super) fn set(&mut self, worlds: Arc<Worlds>, body: usize) {
        (self.worlds, self.body) = (worlds, body);
    }

    /// The number of the planet among the bodies.
    pub(super) fn body(&self) -> usize {
        self.body
    }

    /// The direction of the brightest star over the planet.
    pub(super) fn star_dir_planet(&self, time_secs: f64) -> Option<DVec3> {
        self.worlds.star_dir(self.body, time_secs)
    }

    /// The planet in the light of the system.
    pub(super) fn lit_planet(&self, time_secs: f64) -> Option<Planet> {
        self.worlds.lit_planet(self.body, time_secs)
    }

    /// The planet's place in the system, for photographs.
    pub(super) fn place(&self) -> InSystem {
        InSystem::new(self.worlds.clone(), self.body, self.maps.clone())
    }

    /// The bodies as a view sees them at a time. Those whose tiles are still built are left out.
    pub(super) fn sky(&mut self, view: &View, time_secs: f64, ctx: &egui::Context) -> Sky {
        let worlds = self.worlds.clone();
        let around = worlds.around(self.body, view.camera.position_planet_m, time_secs);
        let projection = Projection::symmetric(view.camera.fov_y_rad, view.aspect());
        let drawn = around.with_surface(&projection, view.size_px);
        let scene = Scene::new(view.camera.planet_from_view, projection, view.size_px, view.quality);
        let mut bodies = Vec::new();
        for number in drawn.iter().copied().filter(|number| *number != self.body) {
            let Some(planet) = worlds.planet(number).cloned() else { continue };
            let (position_m, scene_from_body) = around.place(number);
            let ctx = ctx.clone();
            let options = BuilderOptions::default().budget_bytes(BUDGET_BYTES).maps(self.maps.clone());
            let builder = self
                .builders
                .entry(number)
                .or_insert_with(|| Builder::with_options(options, move || ctx.request_repaint()));
            builder.request(&planet, &scene.view_of(position_m, scene_from_body));
            if let Some(surface) = builder.surface() {
                bodies.push(around.neighbour(number, surface));
            }
        }
        self.builders.retain(|number, _| drawn.contains(number));
        Sky { worlds: self.worlds.clone(), body: self.body, drawn, bodies }
    }
}

impl Sky {
    /// Lights a scene by the system and adds its bodies. `eye_planet_m`: the camera in the planet frame.
    pub(super) fn light<'a>(&'a self, scene: &mut Scene<'a>, eye_planet_m: DVec3, time_secs: f64) {
        self.worlds.around(self.body, eye_planet_m, time_secs).light(scene, &self.drawn);
        scene.bodies.extend(self.bodies.iter().map(Neighbour::body));
    }

    /// Whether another picture has the same bodies with the same tiles.
    pub(super) fn same(&self, other: &Sky) -> bool {
        Arc::ptr_eq(&self.worlds, &other.worlds)
            && self.body == other.body
            && self.bodies.len() == other.bodies.len()
            && self.bodies.iter().zip(&other.bodies).all(|(a, b)| Arc::ptr_eq(&a.surface, &b.surface))
    }
}
