//! The paths of bodies during a trial, about their parents.

use super::nbody::{Bodies, Mass};
use super::sweep::Sweep;
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
    /// The masses when they were noted last, and when.
    last: Vec<Mass>,
    last_secs: f64,
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
        let bodies = system.parents().into_iter().enumerate().map(trail).collect();
        Self { bodies, last: Vec::new(), last_secs: 0.0 }
    }

    /// Notes the way of the bodies since the last time, which is a step of the trial.
    pub fn note(&mut self, bodies: &Bodies) {
        let (masses, now_secs) = (bodies.masses(), bodies.time_secs());
        if self.last.len() != masses.len() {
            (self.last, self.last_secs) = (masses.to_vec(), now_secs);
        }
        let step_secs = now_secs - self.last_secs;
        for (number, trail) in self.bodies.iter_mut().enumerate() {
            let Some(parent) = trail.parent else { continue };
            let sweep =
                Sweep::new([[self.last[parent], self.last[number]], [masses[parent], masses[number]]], step_secs);
            while trail.next_secs <= now_secs {
                let share = if step_secs > 0.0 { (trail.next_secs - self.last_secs) / step_secs } else { 1.0 };
                trail.points_m.push_back(sweep.at(share.clamp(0.0, 1.0)));
                trail.next_secs += trail.every_secs.max(step_secs / MOST as f64);
                if trail.points_m.len() > MOST {
                    trail.points_m.pop_front();
                }
            }
        }
        self.last.copy_from_slice(masses);
        self.last_secs = now_secs;
    }

    /// The path of a body about its parent, metres, the oldest point first.
    pub fn of(&self, body: usize) -> impl Iterator<Item = DVec3> + '_ {
        self.bodies.get(body).into_iter().flat_map(|trail| trail.points_m.iter().copied())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::nbody::Scheme;
    use crate::system::trial::Plan;
    use crate::system::{YEAR_SECS, shipped};

    #[test]
    fn a_trail_lies_on_the_orbit_of_a_body_that_nothing_disturbs() {
        let system = shipped::ALL[0].load().unwrap();
        let radii_m = vec![0.0; system.bodies.len()];
        let mut trails = Trails::new(&system);
        let plan = Plan::new(&system, &radii_m, Scheme::default(), 0.2 * YEAR_SECS, None).unwrap();
        plan.run(&mut |_, bodies| {
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
