//! Where the bodies of a system are at a time, and how they are turned.

use super::kepler::Ellipse;
use super::{Spin, System};
use glam::{DQuat, DVec3};
use std::f64::consts::TAU;

/// A body at a time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Its centre, metres, in the frame of the system.
    pub position_m: DVec3,
    /// Its velocity, m/s.
    pub velocity: DVec3,
    /// Turns the planet frame of the body into the frame of the system.
    pub system_from_body: DQuat,
}

/// The motion of a system on rails: each body on its Kepler orbit about its parent, at any time.
#[derive(Clone, Debug)]
pub struct Ephemeris {
    bodies: Vec<Track>,
}

#[derive(Clone, Debug)]
struct Track {
    parent: Option<usize>,
    ellipse: Option<Ellipse>,
    spin: Spin,
}

impl Ephemeris {
    /// The ephemeris of a valid system ([`System::check`]).
    pub fn new(system: &System) -> Self {
        let parents = system.parents();
        let track = |(body, parent): (&super::Member, &Option<usize>)| {
            let about = parent.map_or(0.0, |parent| system.bodies[parent].gravity_m3_s2());
            Track { parent: *parent, ellipse: body.ellipse(about), spin: body.spin.clone() }
        };
        Self { bodies: system.bodies.iter().zip(&parents).map(track).collect() }
    }

    /// The orbit of a body about its parent; None at the root.
    pub fn orbit(&self, body: usize) -> Option<&Ellipse> {
        self.bodies.get(body)?.ellipse.as_ref()
    }

    /// All bodies at a time, in the order of the system.
    pub fn at(&self, time_secs: f64) -> Vec<Pose> {
        let mut poses: Vec<Pose> = Vec::with_capacity(self.bodies.len());
        for track in &self.bodies {
            let (mut position_m, mut velocity) =
                track.ellipse.map_or((DVec3::ZERO, DVec3::ZERO), |ellipse| ellipse.state(time_secs));
            let system_from_body = track.turned(time_secs);
            // A parent comes before its children.
            if let Some(parent) = track.parent.and_then(|parent| poses.get(parent)) {
                position_m += parent.position_m;
                velocity += parent.velocity;
            }
            poses.push(Pose { position_m, velocity, system_from_body });
        }
        poses
    }
}

impl Track {
    /// The rotation at a time.
    fn turned(&self, time_secs: f64) -> DQuat {
        let spin = &self.spin;
        let about_z = |angle: f64| DQuat::from_rotation_z(angle);
        let system_from_orbit = self.ellipse.map_or(DQuat::IDENTITY, |ellipse| ellipse.frame_from_perifocal);
        // The pole leans towards +x.
        let tilted = DQuat::from_rotation_y(spin.tilt_deg.to_radians());
        let direction = spin.tilt_direction_deg.to_radians();
        let system_from_axis = system_from_orbit * about_z(direction) * tilted * about_z(-direction);
        let turn = spin.turn_deg.to_radians();
        match &self.ellipse {
            Some(ellipse) if spin.locked => {
                // One turn in each orbit, and at the periapsis the side faces the parent: elsewhere it librates.
                system_from_axis * about_z(ellipse.mean_anomaly_rad(time_secs) + 0.5 * TAU - turn)
            }
            _ => {
                let period_secs = spin.period_hours * 3600.0;
                let turned = if period_secs > 0.0 { (time_secs % period_secs) / period_secs * TAU } else { 0.0 };
                system_from_axis * about_z(turn + if spin.retrograde { -turned } else { turned })
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::{Light, Member, Orbit};

    fn system() -> System {
        let body = |name: &str, parent: &str, mass_earths: f64, orbit: Option<Orbit>| Member {
            name: name.to_owned(),
            parent: parent.to_owned(),
            mass_earths,
            orbit,
            ..Member::default()
        };
        let around = |semi_major_km: f64| Some(Orbit { semi_major_km, eccentricity: 0.05, ..Orbit::default() });
        let mut system = System {
            name: "Test".to_owned(),
            bodies: vec![
                Member { light: Some(Light::default()), ..body("Star", "", 332_946.0, None) },
                body("Planet", "Star", 1.0, around(1.5e8)),
                body("Moon", "Planet", 0.0123, around(384_400.0)),
            ],
        };
        system.bodies[1].spin = Spin { tilt_deg: 23.4, tilt_direction_deg: 90.0, ..Spin::default() };
        system.bodies[2].spin = Spin { locked: true, turn_deg: 30.0, ..Spin::default() };
        system
    }

    #[test]
    fn children_move_with_their_parents() {
        let ephemeris = Ephemeris::new(&system());
        let year_secs = ephemeris.orbit(1).unwrap().period_secs();
        assert!((year_secs / 86_400.0 - 366.7).abs() < 0.1, "{} days", year_secs / 86_400.0);
        for time_secs in [0.0, 1e6, -3e7] {
            let poses = ephemeris.at(time_secs);
            assert_eq!(poses[0].position_m, DVec3::ZERO);
            let apart_m = (poses[2].position_m - poses[1].position_m).length();
            assert!((3.65e8..4.04e8).contains(&apart_m), "{apart_m}");
            // The velocity is the change of the position.
            let step_secs = 10.0;
            let after = ephemeris.at(time_secs + step_secs);
            let before = ephemeris.at(time_secs - step_secs);
            for ((pose, after), before) in poses.iter().zip(&after).zip(&before) {
                let measured = (after.position_m - before.position_m) / (2.0 * step_secs);
                assert!((measured - pose.velocity).length() < 1e-4 * (1.0 + pose.velocity.length()));
            }
        }
    }

    #[test]
    fn a_locked_moon_shows_one_side_and_librates() {
        let ephemeris = Ephemeris::new(&system());
        let period_secs = ephemeris.orbit(2).unwrap().period_secs();
        let mut most_deg: f64 = 0.0;
        for number in 0..24 {
            let poses = ephemeris.at(period_secs * f64::from(number) / 24.0 + 7.0 * period_secs);
            let to_parent = (poses[1].position_m - poses[2].position_m).normalize();
            let seen = poses[2].system_from_body.inverse() * to_parent;
            let lon_deg = libm::atan2(seen.y, seen.x).to_degrees();
            most_deg = most_deg.max((lon_deg - 30.0).abs());
        }
        // Twice the eccentricity, in radians.
        assert!((4.0..7.0).contains(&most_deg), "{most_deg}");
    }

    #[test]
    fn a_tilted_axis_keeps_its_direction_and_makes_seasons() {
        let ephemeris = Ephemeris::new(&system());
        let year_secs = ephemeris.orbit(1).unwrap().period_secs();
        let star_lat_deg = |time_secs: f64| {
            let pose = ephemeris.at(time_secs)[1];
            let to_star = pose.system_from_body.inverse() * -pose.position_m.normalize();
            libm::asin(to_star.z).to_degrees()
        };
        let all: Vec<f64> = (0..100).map(|part| star_lat_deg(year_secs * f64::from(part) / 100.0)).collect();
        let (least, most) = (all.iter().copied().fold(90.0, f64::min), all.iter().copied().fold(-90.0, f64::max));
        assert!((least + 23.4).abs() < 0.05 && (most - 23.4).abs() < 0.05, "{least} to {most}");
        // The pole leans away from the star at 90 degrees from the periapsis.
        assert!(all[25] < -23.0 && all[75] > 23.0, "{} {}", all[25], all[75]);
        // A day later the same side is under the star, but for the way along the orbit.
        let facing = |time_secs: f64| {
            let pose = ephemeris.at(time_secs)[1];
            let seen = pose.system_from_body.inverse() * -pose.position_m;
            libm::atan2(seen.y, seen.x).to_degrees()
        };
        let moved_deg = (facing(86_400.0) - facing(0.0) + 180.0).rem_euclid(360.0) - 180.0;
        assert!((0.8..1.3).contains(&moved_deg), "{moved_deg}");
    }
}
