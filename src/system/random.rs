//! Random orbits and rotations for the bodies of a system: always valid, and within the limits of what lasts.

use super::edit::{Size, readable};
use super::limits;
use super::{Ephemeris, Orbit, Spin, System};
use crate::planet::random::dice::Dice;

/// Orbits that are tried for a body before it keeps its own.
const TRIES: u32 = 60;
/// Means of eccentricity and inclination. Both have a Rayleigh distribution, as orbits of real planets roughly have.
const ECCENTRICITY: f64 = 0.035;
const INCLINATION_DEG: f64 = 1.6;

impl System {
    /// The same bodies on random orbits, with random rotation. A body that `keeps` stays as it is, and so do pairs of
    /// stars about a point. Never less stable than before: a body that finds no room keeps its orbit. The same seed
    /// gives the same system. `radii_m`: radius of each body, 0 where it is unknown.
    pub fn rolled(&self, seed: u64, keeps: &dyn Fn(usize) -> bool, radii_m: &[f64]) -> System {
        let mut dice = Dice(seed);
        let parents = self.parents();
        let mut system = self.clone();
        let mut warned = limits::warnings(self, radii_m).len();
        for body in 0..self.bodies.len() {
            let Some(parent) = parents[body] else { continue };
            let is_of_pair = self.bodies[body].light.is_some() && self.bodies[parent].is_point();
            if keeps(body) || is_of_pair {
                continue;
            }
            system.bodies[body].spin = spin(&self.bodies[body].spin, &mut dice);
            let size = Size {
                mass_earths: self.bodies[body].mass_earths,
                radius_m: radii_m.get(body).copied().unwrap_or(0.0),
            };
            for _ in 0..TRIES {
                let mut tried = system.clone();
                let mut orbit =
                    orbit(&mut dice, system.reach_m(parent, size, radii_m), self.bodies[parent].light.is_some());
                orbit.period_hours = system.forced_period_hours(parent, orbit.semi_major_km * 1000.0);
                (tried.bodies[body].orbit, tried.bodies[body].start) = (Some(orbit), None);
                let now = limits::warnings(&tried, radii_m).len();
                if now <= warned && !crosses(&tried, &parents, body) {
                    (system, warned) = (tried, now);
                    break;
                }
            }
        }
        system
    }
}

fn orbit(dice: &mut Dice, [least_m, most_m]: [f64; 2], is_of_star: bool) -> Orbit {
    // The outer half of what a star or a planet can hold is empty in most systems that are known.
    let (inner_m, outer_m) = match is_of_star {
        true => (least_m.max(most_m * 0.004), most_m * 0.5),
        false => (least_m, (least_m * most_m).sqrt().max(least_m * 6.0).min(most_m)),
    };
    let [node_deg, periapsis_deg, anomaly_deg] = [(); 3].map(|()| dice.between(0.0, 360.0).floor());
    Orbit {
        semi_major_km: dice.rounded_log(inner_m / 1000.0, outer_m.max(inner_m) / 1000.0),
        eccentricity: (rayleigh(dice) * ECCENTRICITY).min(0.3),
        inclination_deg: (rayleigh(dice) * INCLINATION_DEG).min(20.0),
        node_deg,
        periapsis_deg,
        anomaly_deg,
        period_hours: 0.0,
    }
    .rounded()
}

fn spin(old: &Spin, dice: &mut Dice) -> Spin {
    if old.locked {
        return Spin { turn_deg: dice.between(0.0, 360.0).floor(), ..old.clone() };
    }
    Spin {
        locked: false,
        period_hours: dice.rounded_log(8.0, 60.0),
        retrograde: dice.chance(0.1),
        tilt_deg: (rayleigh(dice) * 16.0).min(80.0).round(),
        tilt_direction_deg: dice.between(0.0, 360.0).floor(),
        turn_deg: dice.between(0.0, 360.0).floor(),
    }
}

/// A number of the Rayleigh distribution of scale 0.8, whose mean is 1.
fn rayleigh(dice: &mut Dice) -> f64 {
    0.8 * (-2.0 * libm::log(1.0 - dice.unit())).sqrt()
}

/// Whether the orbit of a body meets that of another child of its parent.
fn crosses(system: &System, parents: &[Option<usize>], body: usize) -> bool {
    let ephemeris = Ephemeris::new(system);
    let reach = |body: usize| {
        let orbit = ephemeris.orbit(body)?;
        Some([1.0 - orbit.eccentricity, 1.0 + orbit.eccentricity].map(|share| share * orbit.semi_major_m))
    };
    let Some([inner_m, outer_m]) = reach(body) else { return false };
    let others = (0..parents.len()).filter(|other| *other != body && parents[*other] == parents[body]);
    others.filter_map(reach).any(|[from_m, to_m]| inner_m < 1.1 * to_m && from_m < 1.1 * outer_m)
}

impl Orbit {
    /// With numbers that read well in a file.
    pub(crate) fn rounded(self) -> Self {
        let thousandth = |value: f64| (value * 1000.0).round() / 1000.0;
        Self {
            semi_major_km: readable(self.semi_major_km),
            eccentricity: thousandth(self.eccentricity),
            inclination_deg: thousandth(self.inclination_deg),
            node_deg: thousandth(self.node_deg),
            periapsis_deg: thousandth(self.periapsis_deg),
            anomaly_deg: thousandth(self.anomaly_deg),
            period_hours: readable(self.period_hours),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{Light, shipped};

    #[test]
    fn random_systems_are_valid_last_and_keep_what_is_locked() {
        for shipped in shipped::ALL {
            let system = shipped.load().unwrap();
            let planets = shipped.planets(&system);
            let radius_m =
                |(body, planet): (&crate::system::Member, &Option<std::sync::Arc<crate::planet::Planet>>)| {
                    planet.as_ref().map_or(body.light.as_ref().map_or(0.0, Light::radius_m), |planet| planet.radius_m())
                };
            let radii_m: Vec<f64> = system.bodies.iter().zip(&planets).map(radius_m).collect();
            let mut moved = 0;
            for seed in 0..60 {
                let kept = (seed % system.bodies.len() as u64) as usize;
                let rolled = system.rolled(seed, &|body| body == kept, &radii_m);
                rolled.check().unwrap_or_else(|problems| panic!("{seed}: {problems:?}"));
                assert_eq!(limits::warnings(&rolled, &radii_m), [], "{} {seed}", shipped.file);
                assert_eq!(rolled.bodies[kept], system.bodies[kept]);
                assert_eq!(rolled, system.rolled(seed, &|body| body == kept, &radii_m), "the same seed");
                moved += rolled.bodies.iter().zip(&system.bodies).filter(|(a, b)| a.orbit != b.orbit).count();
            }
            // Nearly every body that may move finds another orbit.
            let free = system.bodies.iter().filter(|body| body.orbit.is_some() && body.light.is_none()).count();
            assert!(moved * 10 > 60 * free * 7, "{}: {moved} of {}", shipped.file, 60 * free);
        }
    }
}
