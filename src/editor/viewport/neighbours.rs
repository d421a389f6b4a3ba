//! The other bodies of a system around the planet: their tiles, built in the background, and their places. When the
//! camera goes to another body, the two change places, with their tiles.

use super::Viewport;
use super::voyage::{Obstacle, Relative};
use crate::film::InSystem;
use crate::lod::View;
use crate::planet::Planet;
use crate::render::{BodyId, Neighbour, Projection, Scene, Worlds};
use crate::terrain::MapStore;
use crate::tiles::{Builder, BuilderOptions};
use eframe::egui;
use glam::DVec3;
use std::collections::HashMap;
use std::sync::Arc;

/// Memory for the tiles of a neighbour at least. The planet has at least half of all.
const LEAST_BYTES: usize = 8 << 20;
/// Apparent radius from which a neighbour takes as much memory as may be.
const WIDE_RAD: f64 = 0.5;

/// The neighbours of the planet.
pub struct Neighbours {
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
    /// The bodies that are drawn with a surface.
    drawn: Vec<usize>,
    pub(super) bodies: Vec<Neighbour>,
}

/// The planet's place among other bodies.
impl Viewport {
    /// The number of the planet among the bodies of its system; None if it is alone.
    pub fn body(&self) -> Option<usize> {
        self.neighbours.as_ref().map(Neighbours::body)
    }

    /// The id of the planet in scenes.
    pub(super) fn own_id(&self) -> BodyId {
        self.body().map_or_else(BodyId::default, Worlds::id)
    }

    /// The bodies around the planet as a view sees them; None if it is alone.
    pub(super) fn sky(&mut self, view: &View) -> Option<Sky> {
        let (time_secs, bytes) = (self.settings.time_secs, self.settings.cache_bytes());
        let Some(neighbours) = &mut self.neighbours else {
            self.builder.set_budget_bytes(bytes);
            return None;
        };
        Some(neighbours.sky((&self.builder, bytes), view, time_secs, &self.ctx))
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
        let now = self.neighbours.as_ref().map(|neighbours| &neighbours.worlds);
        if now.zip(system.as_ref()).is_some_and(|(now, (worlds, _))| !Arc::ptr_eq(now, worlds)) {
            // The bodies may have other numbers.
            self.cancel_travel();
        }
        match (&mut self.neighbours, system) {
            (Some(neighbours), Some((worlds, body))) => neighbours.set(worlds, body),
            (_, system) => {
                self.neighbours = system.map(|(worlds, body)| Neighbours::new(worlds, body, self.maps.clone()));
            }
        }
    }
}

/// Flights to other bodies: the planet and a neighbour change places.
impl Viewport {
    /// Takes the bodies around the planet out, so that they outlive a change of the document. None if it is alone.
    pub fn take_neighbours(&mut self) -> Option<Neighbours> {
        self.neighbours.take()
    }

    /// Takes the bodies in again. If another `body` is the planet now, it is shown at once if it was on screen.
    pub fn return_neighbours(&mut self, mut neighbours: Neighbours, body: usize) {
        let before = std::mem::replace(&mut neighbours.body, body);
        if before != body {
            let own = neighbours.builders.remove(&body);
            match own.as_ref().and_then(Builder::surface) {
                Some(surface) => self.picture.show_at_once(surface),
                None => self.picture.wait_for_surface(),
            }
            self.panes.wait_for_surfaces();
            let own = own.unwrap_or_else(|| neighbours.builder(&self.ctx));
            neighbours.builders.insert(before, std::mem::replace(&mut self.builder, own));
        }
        self.neighbours = Some(neighbours);
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

    /// A builder for a body that had none.
    fn builder(&self, ctx: &egui::Context) -> Builder {
        let options = BuilderOptions::default().budget_bytes(LEAST_BYTES).maps(self.maps.clone());
        let ctx = ctx.clone();
        Builder::with_options(options, move || ctx.request_repaint())
    }

    /// The number of the planet among the bodies.
    pub fn body(&self) -> usize {
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

    /// Another body as the planet sees it at a time.
    pub(super) fn relative(&self, from: usize, to: usize, time_secs: f64) -> Relative {
        let (center_m, turn) = self.worlds.around(from, DVec3::ZERO, time_secs).place(to);
        Relative { center_m, turn }
    }

    /// The bodies but for two, as the first of them sees them at a time.
    pub(super) fn obstacles(&self, [from, to]: [usize; 2], time_secs: f64) -> Vec<Obstacle> {
        let around = self.worlds.around(from, DVec3::ZERO, time_secs);
        let radii_m = self.worlds.radii_m();
        let others =
            radii_m.into_iter().enumerate().filter(|(body, radius_m)| ![from, to].contains(body) && *radius_m > 0.0);
        others.map(|(body, radius_m)| Obstacle { center_m: around.place(body).0, radius_m }).collect()
    }

    /// The planet of a body in the light of the system, at a time.
    pub(super) fn planet_of(&self, body: usize, time_secs: f64) -> Option<Planet> {
        self.worlds.lit_planet(body, time_secs)
    }

    /// The planet's place in the system, for photographs.
    pub(super) fn place(&self) -> InSystem {
        InSystem::new(self.worlds.clone(), self.body, self.maps.clone())
    }

    /// The bodies as a view sees them at a time. Those whose first tiles are still built are points of light. The
    /// memory of `own`, the builder of the planet, and of the others follows from how large they look; `all_bytes` is
    /// that of all.
    pub(super) fn sky(
        &mut self,
        (own, all_bytes): (&Builder, usize),
        view: &View,
        time_secs: f64,
        ctx: &egui::Context,
    ) -> Sky {
        let worlds = self.worlds.clone();
        let around = worlds.around(self.body, view.camera.position_planet_m, time_secs);
        let projection = Projection::symmetric(view.camera.fov_y_rad, view.aspect());
        let drawn = around.with_surface(&projection, view.size_px);
        let scene = Scene::new(view.camera.planet_from_view, projection, view.size_px, view.quality);
        let (mut bodies, mut left_bytes) = (Vec::new(), all_bytes / 2);
        let mut shown = vec![self.body];
        for number in drawn.iter().copied().filter(|number| *number != self.body) {
            let Some(planet) = worlds.planet(number).cloned() else { continue };
            let (position_m, scene_from_body) = around.place(number);
            if !self.builders.contains_key(&number) {
                self.builders.insert(number, self.builder(ctx));
            }
            let Some(builder) = self.builders.get(&number) else { continue };
            let apparent_rad = (planet.radius_m() / position_m.length()).min(1.0).asin();
            let share = (apparent_rad / WIDE_RAD).min(1.0);
            // Nearest first: the others share what is left.
            let bytes = ((share * left_bytes as f64) as usize).max(LEAST_BYTES);
            left_bytes = left_bytes.saturating_sub(bytes);
            builder.set_budget_bytes(bytes);
            if let Err(error) = builder.request(&planet, &scene.view_of(position_m, scene_from_body)) {
                log::error!("{error}");
            }
            if let Some(surface) = builder.surface() {
                shown.push(number);
                bodies.push(around.neighbour(number, surface));
            }
        }
        own.set_budget_bytes(all_bytes - all_bytes / 2 + left_bytes);
        self.builders.retain(|number, _| drawn.contains(number));
        Sky { worlds: self.worlds.clone(), body: self.body, drawn: shown, bodies }
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
