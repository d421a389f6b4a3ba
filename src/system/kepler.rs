//! Kepler orbits: position and velocity from elements, exact at any time, and elements from position and velocity.
//!
//! The perifocal frame of an orbit has its x-axis towards the periapsis and its z-axis along the orbit's normal.

use super::Orbit;
use glam::{DMat2, DQuat, DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// An elliptic orbit around a mass.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Ellipse {
    /// Semi-major axis, metres.
    pub semi_major_m: f64,
    /// Eccentricity, 0 to below 1.
    pub eccentricity: f64,
    /// Turns the perifocal frame into the frame of the elements.
    pub frame_from_perifocal: DQuat,
    /// Mean anomaly at time zero, radians.
    pub anomaly_rad: f64,
    /// Mean motion, radians per second.
    pub mean_motion: f64,
}

impl Ellipse {
    /// The ellipse of elements around a mass. `gravity`: the sum of the standard gravitational parameters of both
    /// bodies, m³/s²; not used if the elements have a period.
    pub fn new(orbit: &Orbit, gravity: f64) -> Self {
        let semi_major_m = orbit.semi_major_km * 1000.0;
        let mean_motion = match orbit.period_hours > 0.0 {
            true => TAU / (orbit.period_hours * 3600.0),
            false => (gravity / semi_major_m.powi(3)).sqrt(),
        };
        let about_z = |degrees: f64| DQuat::from_rotation_z(degrees.to_radians());
        let tilted = DQuat::from_rotation_x(orbit.inclination_deg.to_radians());
        Self {
            semi_major_m,
            eccentricity: orbit.eccentricity,
            frame_from_perifocal: about_z(orbit.node_deg) * tilted * about_z(orbit.periapsis_deg),
            anomaly_rad: orbit.anomaly_deg.to_radians(),
            mean_motion,
        }
    }

    /// The ellipse of a body at a position (metres) with a velocity (m/s) relative to a mass, at time zero. None for a
    /// body that escapes or falls straight down. `gravity`: as for [`Ellipse::new`].
    pub fn from_state(position_m: DVec3, velocity: DVec3, gravity: f64) -> Option<Self> {
        let distance_m = position_m.length();
        let energy = 0.5 * velocity.length_squared() - gravity / distance_m;
        let momentum = position_m.cross(velocity);
        if !(energy < 0.0 && momentum.length() > 0.0) {
            return None;
        }
        let semi_major_m = -0.5 * gravity / energy;
        let eccentric = velocity.cross(momentum) / gravity - position_m / distance_m;
        let eccentricity = eccentric.length();
        let normal = momentum.normalize();
        // The periapsis of a circle is where the body is.
        let x = if eccentricity > 1e-11 { eccentric / eccentricity } else { position_m / distance_m };
        let x = (x - normal * x.dot(normal)).normalize();
        let y = normal.cross(x);
        let root = (1.0 - eccentricity * eccentricity).max(0.0).sqrt();
        let sine = position_m.dot(y) / (semi_major_m * root);
        let cosine = position_m.dot(x) / semi_major_m + eccentricity;
        let eccentric_anomaly = libm::atan2(sine, cosine);
        (eccentricity < 1.0).then(|| Self {
            semi_major_m,
            eccentricity,
            frame_from_perifocal: DQuat::from_mat3(&glam::DMat3::from_cols(x, y, normal)),
            anomaly_rad: eccentric_anomaly - eccentricity * libm::sin(eccentric_anomaly),
            mean_motion: (gravity / semi_major_m.powi(3)).sqrt(),
        })
    }

    /// The elements. The angles of a circle or of an orbit in the plane of reference are those of a limit: the node or
    /// the periapsis is at 0.
    pub fn elements(&self) -> Orbit {
        let axis = |v| self.frame_from_perifocal * v;
        let (x, y, normal) = (axis(DVec3::X), axis(DVec3::Y), axis(DVec3::Z));
        let inclination = libm::atan2(normal.truncate().length(), normal.z);
        let (node, periapsis) = match normal.truncate().length() > 1e-12 {
            true => (libm::atan2(normal.x, -normal.y), libm::atan2(x.z, y.z)),
            false => (0.0, libm::atan2(x.y, x.x) * normal.z.signum()),
        };
        let degrees = |angle: f64| angle.rem_euclid(TAU).to_degrees();
        Orbit {
            semi_major_km: self.semi_major_m / 1000.0,
            eccentricity: self.eccentricity,
            inclination_deg: inclination.to_degrees(),
            node_deg: degrees(node),
            periapsis_deg: degrees(periapsis),
            anomaly_deg: degrees(self.anomaly_rad),
            period_hours: 0.0,
        }
    }

    /// The place in the plane of the orbit, in its perifocal frame, that is seen over `over_m` along the z-axis of the
    /// frame of the elements; metres from the parent. None if the orbit is seen edge on, or the place is the parent's.
    pub fn in_plane_m(&self, over_m: DVec2) -> Option<DVec2> {
        let [x, y] = [DVec3::X, DVec3::Y].map(|axis| (self.frame_from_perifocal * axis).truncate());
        let seen = DMat2::from_cols(x, y);
        if seen.determinant().abs() < 1e-3 {
            return None;
        }
        let in_plane_m = seen.inverse() * over_m;
        (in_plane_m.length() > 0.0 && in_plane_m.is_finite()).then_some(in_plane_m)
    }

    /// The orbit of the same shape and plane that passes through a place: the ellipse is scaled, and the body stands
    /// there at a time. `over_m`: the place, metres from the parent, seen along the z-axis of the frame of the
    /// elements. None if the orbit is seen edge on, or the place is the parent's.
    pub fn through(&self, over_m: DVec2, time_secs: f64) -> Option<Self> {
        let in_plane_m = self.in_plane_m(over_m)?;
        let distance_m = in_plane_m.length();
        let e = self.eccentricity;
        let cosine = in_plane_m.x / distance_m;
        let semi_major_m = distance_m * (1.0 + e * cosine) / (1.0 - e * e);
        let root = (1.0 - e * e).sqrt();
        let eccentric = libm::atan2(in_plane_m.y / distance_m * root, e + cosine);
        let mean = eccentric - e * libm::sin(eccentric);
        // Kepler's third law.
        let mean_motion = self.mean_motion * (self.semi_major_m / semi_major_m).powf(1.5);
        let since_secs = time_secs % (TAU / mean_motion);
        let anomaly_rad = (mean - mean_motion * since_secs).rem_euclid(TAU);
        Some(Self { semi_major_m, anomaly_rad, mean_motion, ..*self })
    }

    /// Period in seconds.
    pub fn period_secs(&self) -> f64 {
        TAU / self.mean_motion
    }

    /// Mean anomaly at a time, 0 to 2 pi.
    pub fn mean_anomaly_rad(&self, time_secs: f64) -> f64 {
        // Whole periods are taken off before the product: it would lose digits that count after a million years.
        let since_secs = time_secs % self.period_secs();
        (self.anomaly_rad + self.mean_motion * since_secs).rem_euclid(TAU)
    }

    /// Position (metres) and velocity (m/s) relative to the parent, in the frame of the elements.
    pub fn state(&self, time_secs: f64) -> (DVec3, DVec3) {
        let e = self.eccentricity;
        let anomaly = eccentric_anomaly(self.mean_anomaly_rad(time_secs), e);
        let (sine, cosine) = libm::sincos(anomaly);
        let speed = self.semi_major_m * self.mean_motion / (1.0 - e * cosine);
        let velocity = DVec3::new(-sine, (1.0 - e * e).sqrt() * cosine, 0.0) * speed;
        (self.at_anomaly(anomaly), self.frame_from_perifocal * velocity)
    }

    /// Position relative to the parent at an eccentric anomaly: even steps of it are spread well over the ellipse.
    pub fn at_anomaly(&self, eccentric_rad: f64) -> DVec3 {
        let (sine, cosine) = libm::sincos(eccentric_rad);
        let (e, root) = (self.eccentricity, (1.0 - self.eccentricity * self.eccentricity).sqrt());
        self.frame_from_perifocal * (DVec3::new(cosine - e, root * sine, 0.0) * self.semi_major_m)
    }
}

/// The eccentric anomaly E of a mean anomaly M = E - e sin E, both in radians; NaN where M is not finite.
///
/// Newton's method from the start of Danby (The solution of Kepler's equation, Celestial Mechanics 31, 1983), safe
/// inside an interval that holds the root.
pub fn eccentric_anomaly(mean_rad: f64, eccentricity: f64) -> f64 {
    if !mean_rad.is_finite() {
        return f64::NAN;
    }
    let turns = (mean_rad / TAU).floor() * TAU;
    let mean = mean_rad - turns;
    // The upper half of the orbit mirrors the lower one.
    let mirrored = mean > PI;
    let mean = if mirrored { TAU - mean } else { mean };
    let (mut low, mut high) = (mean, (mean + eccentricity).min(PI));
    let mut anomaly = (mean + 0.85 * eccentricity).clamp(low, high);
    for _ in 0..60 {
        let off = anomaly - eccentricity * libm::sin(anomaly) - mean;
        if off > 0.0 {
            high = anomaly;
        } else {
            low = anomaly;
        }
        let mut next = anomaly - off / (1.0 - eccentricity * libm::cos(anomaly));
        if !(low..=high).contains(&next) {
            next = 0.5 * (low + high);
        }
        let step = (next - anomaly).abs();
        anomaly = next;
        if step <= 2.0 * f64::EPSILON * anomaly.abs() {
            break;
        }
    }
    turns + if mirrored { TAU - anomaly } else { anomaly }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn keplers_equation_is_solved(mean in -20.0..20.0, e in 0.0..0.97) {
            let anomaly = eccentric_anomaly(mean, e);
            let off = anomaly - e * libm::sin(anomaly) - mean;
            prop_assert!(off.abs() < 1e-14 * mean.abs().max(2.0) , "{off}");
        }

        /// The conserved quantities of the ellipse, and that the elements come back.
        #[test]
        fn states_and_elements_agree(
            semi_major_km in 1e3..1e10, eccentricity in 0.001..0.95, inclination_deg in 0.1..179.9,
            node_deg in 0.0..360.0, periapsis_deg in 0.0..360.0, anomaly_deg in 0.0..360.0, time_secs in -1e9..1e9,
        ) {
            let orbit = Orbit {
                semi_major_km, eccentricity, inclination_deg, node_deg, periapsis_deg, anomaly_deg, period_hours: 0.0,
            };
            let gravity = 1.327e20;
            let ellipse = Ellipse::new(&orbit, gravity);
            let (position_m, velocity) = ellipse.state(time_secs);
            let energy = 0.5 * velocity.length_squared() - gravity / position_m.length();
            let expected = -0.5 * gravity / ellipse.semi_major_m;
            // At the periapsis of a long ellipse both terms are much larger than their difference.
            prop_assert!((energy / expected - 1.0).abs() < 1e-12 / (1.0 - eccentricity), "energy {energy} {expected}");
            let area = position_m.cross(velocity).length();
            let swept = (gravity * ellipse.semi_major_m * (1.0 - eccentricity * eccentricity)).sqrt();
            prop_assert!((area / swept - 1.0).abs() < 1e-12, "area {area} {swept}");
            let (at_zero, velocity) = ellipse.state(0.0);
            let found = Ellipse::from_state(at_zero, velocity, gravity).unwrap();
            let elements = found.elements();
            prop_assert!((elements.semi_major_km / semi_major_km - 1.0).abs() < 1e-10 / (1.0 - eccentricity));
            prop_assert!((elements.eccentricity - eccentricity).abs() < 1e-10);
            prop_assert!((elements.inclination_deg - inclination_deg).abs() < 1e-8);
            let apart = |a: f64, b: f64| ((a - b + 180.0).rem_euclid(360.0) - 180.0).abs();
            prop_assert!(apart(elements.node_deg, node_deg) < 1e-6);
            prop_assert!(apart(elements.periapsis_deg, periapsis_deg) < 1e-4);
            prop_assert!(apart(elements.anomaly_deg, anomaly_deg) < 1e-4);
        }
    }

    /// The closed form: at quarter points of the eccentric anomaly the position is known without solving anything.
    #[test]
    fn positions_are_those_of_the_closed_form() {
        let orbit = Orbit { semi_major_km: 1e8, eccentricity: 0.6, ..Orbit::default() };
        let ellipse = Ellipse::new(&orbit, 1.327e20);
        let (a, e) = (ellipse.semi_major_m, 0.6);
        for number in 0..8 {
            let anomaly = TAU * f64::from(number) / 8.0;
            let time_secs = (anomaly - e * anomaly.sin()) / ellipse.mean_motion;
            let expected = DVec3::new(a * (anomaly.cos() - e), a * 0.8 * anomaly.sin(), 0.0);
            for periods in [0.0, 1.0, -3.0] {
                let (position_m, _) = ellipse.state(time_secs + periods * ellipse.period_secs());
                let off = (position_m - expected).length() / expected.length();
                assert!(off < 1e-12 * (1.0_f64).max(periods.abs() * 4.0), "{number}, {periods}: {off}");
            }
        }
    }

    #[test]
    fn an_orbit_goes_through_a_place_at_a_time() {
        let elements = Orbit {
            semi_major_km: 4e5,
            eccentricity: 0.3,
            inclination_deg: 40.0,
            node_deg: 70.0,
            periapsis_deg: 200.0,
            ..Orbit::default()
        };
        let ellipse = Ellipse::new(&elements, 4e14);
        for (place_m, time_secs) in [(DVec2::new(3e8, 1e8), 0.0), (DVec2::new(-2e7, 9e8), 3e8), (-DVec2::X * 1e6, -5e7)]
        {
            let moved = ellipse.through(place_m, time_secs).unwrap();
            let (position_m, _) = moved.state(time_secs);
            assert!((position_m.truncate() - place_m).length() < 1e-6 * place_m.length(), "{position_m} {place_m}");
            assert_eq!(moved.frame_from_perifocal, ellipse.frame_from_perifocal);
            // The mass is the same.
            let gravity = |ellipse: &Ellipse| ellipse.mean_motion.powi(2) * ellipse.semi_major_m.powi(3);
            assert!((gravity(&moved) / gravity(&ellipse) - 1.0).abs() < 1e-12);
        }
        assert!(ellipse.through(DVec2::ZERO, 0.0).is_none());
        let upright = Ellipse::new(&Orbit { inclination_deg: 90.0, ..elements }, 4e14);
        assert!(upright.through(DVec2::X * 1e8, 0.0).is_none());
    }

    #[test]
    fn angles_without_meaning_are_zero_and_the_position_stays() {
        for (inclination_deg, eccentricity) in [(0.0, 0.0), (0.0, 0.3), (180.0, 0.3), (30.0, 0.0)] {
            let orbit = Orbit {
                inclination_deg,
                eccentricity,
                node_deg: 40.0,
                periapsis_deg: 75.0,
                anomaly_deg: 20.0,
                ..Orbit::default()
            };
            let ellipse = Ellipse::new(&orbit, 1.327e20);
            let (position_m, velocity) = ellipse.state(0.0);
            let again = Ellipse::from_state(position_m, velocity, 1.327e20).unwrap().elements();
            let (back_m, _) = Ellipse::new(&again, 1.327e20).state(0.0);
            assert!((back_m - position_m).length() < 1e-9 * position_m.length(), "{inclination_deg}: {again:?}");
        }
        assert!(Ellipse::from_state(DVec3::X, DVec3::Y * 2.0, 1.0).is_none(), "it escapes");
        assert!(Ellipse::from_state(DVec3::X, DVec3::ZERO, 1.0).is_none(), "it falls");
    }
}
