//! The paths of bodies during a trial, about their parents.

use super::nbody::Bodies;
use super::{Ephemeris, System};
use glam::DVec3;
use std::collections::VecDeque;

/// Points that are kept of one period, and of one body.
const A_PERIOD: f64 = 96.0;
const MOST: usize = 600;

/// The last few orbits of each body.
#[derive(Clone, Debug, Default)]
pub struct Trails {
    bodies: Vec<Trail>,
}

#[derive(Clone, Debug)]
struct Trail {
    parent: Option<usize>,
    every_secs: f64,
    next_secs: f64,
    points_m: VecDeque<DVec3>,
}

impl Trails {
    /// Trails without points.
    pub fn new(system: &System) -> Self {
        let ephemeris = Ephemeris::new(system);
        let trail = |(body, parent): (usize, Option<usize>)| Trail {
            parent,
            every_secs: ephemeris.orbit(body).map_or(f64::INFINITY, |orbit| orbit.period_secs() / A_PERIOD),
            next_secs: 0.0,
            points_m: VecDeque::new(),
        };
        Self { bodies: system.parents().into_iter().enumerate().map(trail).collect() }
    }

    /// Notes where the bodies are.
    pub fn note(&mut self, bodies: &Bodies) {
        let masses = bodies.masses();
        for (number, trail) in self.bodies.iter_mut().enumerate() {
            let Some(parent) = trail.parent else { continue };
            if bodies.time_secs() < trail.next_secs {
                continue;
            }
            // Points have no mass and do not move with their children: a pair is seen from the middle of the system.
            let origin_m = if masses[parent].gravity > 0.0 { masses[parent].position_m } else { DVec3::ZERO };
            trail.next_secs = bodies.time_secs() + trail.every_secs;
            trail.points_m.push_back(masses[number].position_m - origin_m);
            if trail.points_m.len() > MOST {
                trail.points_m.pop_front();
            }
        }
    }

    /// The path of a body about its parent, metres, the oldest point first.
    pub fn of(&self, body: usize) -> impl Iterator<Item = DVec3> + '_ {
        self.bodies.get(body).into_iter().flat_map(|trail| trail.points_m.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::nbody::{Scheme, fitting_step_secs, try_out};
    use crate::system::{YEAR_SECS, shipped};

    #[test]
    fn a_trail_lies_on_the_orbit_of_a_body_that_nothing_disturbs() {
        let system = shipped::ALL[0].load().unwrap();
        let radii_m = vec![0.0; system.bodies.len()];
        let mut trails = Trails::new(&system);
        let span = (0.2 * YEAR_SECS, fitting_step_secs(&system));
        try_out(&system, &radii_m, Scheme::Yoshida6, span, &mut |_, bodies| {
            trails.note(bodies);
            true
        });
        let ephemeris = Ephemeris::new(&system);
        let moon = system.find("Pallor").unwrap();
        let orbit = ephemeris.orbit(moon).unwrap();
        let count = trails.of(moon).count() as f64;
        let expected = 0.2 * YEAR_SECS / orbit.period_secs() * A_PERIOD;
        assert!((count - expected).abs() < 0.05 * expected + 2.0, "{count} {expected}");
        for point_m in trails.of(moon) {
            let distance = point_m.length() / orbit.semi_major_m;
            assert!((distance - 1.0).abs() < orbit.eccentricity + 0.03, "{distance}");
        }
        assert_eq!(trails.of(0).count(), 0, "nothing moves about nothing");
    }
}
