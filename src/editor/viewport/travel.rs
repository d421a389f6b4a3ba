//! Flights from body to body in the viewport: where the eye is, and when the goal becomes the planet.

use super::Viewport;
use super::camera::{Cameras, Ground as _};
use super::ground::PlanetGround;
use super::neighbours::Neighbours;
use super::voyage::{End, Voyage};
use crate::lod::opening::opening_place;
use crate::lod::pose::Pose;
use crate::sphere::LatLon;
use eframe::egui;

/// Longest step of a flight in a frame, in seconds of the clock.
const MAX_STEP_SECS: f32 = 0.4;

/// Where a flight to another body ends.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Arrival {
    /// Where the whole body is in the picture.
    Orbit,
    /// Standing on its ground.
    Ground,
}

/// A flight to another body.
pub(super) struct Travel {
    voyage: Voyage,
    /// The place over which it ends.
    place: LatLon,
    arrival: Arrival,
    /// Whether the goal is to become the planet, and whether that was asked for.
    is_due: bool,
    has_asked: bool,
}

impl Viewport {
    /// Flies to another body of the system. False if there is nothing to see of a flight: no picture, no such planet.
    pub fn fly_to_body(&mut self, to: usize, arrival: Arrival) -> bool {
        let (Some(neighbours), Some(surface)) = (&self.neighbours, self.surface()) else { return false };
        let (from, time_secs) = (neighbours.body(), self.settings.time_secs);
        let Some(planet) = neighbours.planet_of(to, time_secs).filter(|_| to != from) else { return false };
        if self.error().is_some() {
            return false;
        }
        let ground = PlanetGround::new(surface.terrain.planet(), Some(&surface.terrain));
        let pose = self.cameras.pose(&ground);
        let place = opening_place(&planet);
        // The ground there is not known yet.
        let there = PlanetGround::new(&planet, None);
        let arrived = Cameras::new(planet.radius_m(), place).pose(&there);
        let start = End { body: from, pose, ground_m: ground.surface_radius_m(pose.up()) };
        let end = End { body: to, pose: arrived, ground_m: there.surface_radius_m(arrived.up()) };
        let relative = neighbours.relative(from, to, time_secs);
        let others = neighbours.obstacles([from, to], time_secs);
        let voyage = Voyage::new(start, end, &relative, &others);
        // A key ends the flight.
        self.wants_focus = true;
        self.is_landing = false;
        self.travel = Some(Travel { voyage, place, arrival, is_due: false, has_asked: false });
        true
    }

    /// Whether a flight to another body is under way.
    pub fn is_travelling(&self) -> bool {
        self.travel.is_some()
    }

    /// The body that is to become the planet now, once.
    pub fn take_hand_over(&mut self) -> Option<(usize, Arrival)> {
        let travel = self.travel.as_mut().filter(|travel| travel.is_due && !travel.has_asked)?;
        travel.has_asked = true;
        Some((travel.voyage.bodies()[1], travel.arrival))
    }

    /// Ends a flight where it began.
    pub fn cancel_travel(&mut self) {
        if self.travel.take().is_some() {
            self.put_down();
        }
    }

    /// The goal of the flight is the planet now: the camera in use is over it from here on.
    pub fn take_over_goal(&mut self, radius_m: f64) {
        if let (Some(travel), Some(neighbours)) = (&mut self.travel, &self.neighbours) {
            self.ground_radius_m = radius_m;
            self.cameras = Cameras::new(radius_m, travel.place);
            self.cameras.carry(travel.step(neighbours, self.settings.time_secs));
        }
    }

    /// Moves the eye. Any key or button ends the flight at its goal.
    pub(super) fn advance_travel(&mut self, ui: &egui::Ui, response: &egui::Response) {
        let (Some(travel), Some(neighbours)) = (&mut self.travel, &self.neighbours) else {
            return self.cancel_travel();
        };
        let (secs, pressed) = ui.input(|input| {
            let is_key = |event: &egui::Event| matches!(event, egui::Event::Key { pressed: true, .. });
            (input.unstable_dt.min(MAX_STEP_SECS), input.events.iter().any(is_key))
        });
        if pressed && response.has_focus() || response.is_pointer_button_down_on() {
            travel.voyage.skip();
        }
        travel.voyage.advance(f64::from(secs));
        let pose = travel.step(neighbours, self.settings.time_secs);
        let has_arrived = travel.voyage.bodies()[1] == neighbours.body();
        if travel.voyage.is_over() && has_arrived {
            self.is_landing = travel.arrival == Arrival::Ground;
            self.travel = None;
            self.cameras.carry(pose);
            self.put_down();
        } else {
            self.cameras.carry(pose);
            self.moving = true;
        }
        ui.ctx().request_repaint();
    }

    fn put_down(&mut self) {
        let surface = self.surface();
        if let Some(surface) = &surface {
            self.cameras.put_down(&PlanetGround::new(surface.terrain.planet(), Some(&surface.terrain)));
        } else {
            self.cameras.drop_carried();
        }
    }
}

impl Travel {
    /// The pose now, in the frame of the body that is the planet.
    fn step(&mut self, neighbours: &Neighbours, time_secs: f64) -> Pose {
        let bodies = self.voyage.bodies();
        let relative = neighbours.relative(bodies[0], bodies[1], time_secs);
        let others = neighbours.obstacles(bodies, time_secs);
        let pose = self.voyage.pose(&relative, &others);
        self.is_due |= self.voyage.is_nearer_to_goal(&pose, &relative);
        if neighbours.body() == bodies[0] { pose } else { relative.from_second(&pose) }
    }
}
