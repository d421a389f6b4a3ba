//! Systems: stars, planets and moons, their orbits and their rotation.
//!
//! - this file: the data of a system file; [`file`](mod@file): loading and saving
//! - [`kepler`]: orbits from elements, exact at any time
//! - [`ephemeris`]: where all bodies are at a time, and how they are turned
//! - [`nbody`]: the motion under the attraction of all bodies; `radau`: the integrator of 15th order
//! - [`trial`]: runs of a system, to see whether it lasts; `sweep`: how near bodies come within a step
//! - `edit`: bodies that are added, removed and renamed; `random`: random orbits
//! - [`trails`]: the paths of bodies during a trial
//! - [`watch`]: hot reload of a system file
//! - [`limits`]: Hill radii, Roche limits, and what a system violates
//! - [`light`]: starlight and reflected light at a body; which bodies may cover a star
//! - [`shipped`]: the systems that come with the program
//!
//! The frame of a system has its origin in the body at the root; its xy-plane is the plane of reference of the
//! elements, and its z-axis points north. Lengths are metres, times seconds, angles radians, all in
//! f64, unless a name says otherwise.

mod edit;
pub mod ephemeris;
pub mod file;
pub mod kepler;
pub mod light;
pub mod limits;
pub mod nbody;
mod radau;
mod random;
pub mod shipped;
mod sweep;
pub mod trails;
pub mod trial;
pub mod watch;

pub use ephemeris::{Ephemeris, Pose};

use crate::planet::param::{Domain, Stage, Unit, linear, log, params};
use crate::planet::{STAR_KELVIN, star_color};
use glam::DVec3;
use kepler::Ellipse;

/// The version of the system format that this crate writes.
pub const VERSION: u32 = 1;

/// Greatest eccentricity of an orbit.
pub const MAX_ECCENTRICITY: f64 = 0.97;

/// Most bodies of a system.
pub const MAX_BODIES: usize = 64;

/// The constant of gravitation, m³/(kg s²) (CODATA 2018).
pub const GRAVITATION: f64 = 6.674_30e-11;
/// Mass of the Earth, kg: 3.986004418e14 m³/s² (IERS) by the constant of gravitation.
pub const EARTH_MASS_KG: f64 = 3.986_004_418e14 / GRAVITATION;
/// Seconds of a Julian year.
pub const YEAR_SECS: f64 = 365.25 * 86_400.0;
/// The astronomical unit, metres (IAU 2012).
pub const ASTRONOMICAL_UNIT_M: f64 = 149_597_870_700.0;

params! {
    /// A system: stars, planets and moons.
    pub struct System {
        /// Name of the system.
        name: String = "Unnamed".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 64 }, Stage::Label;
    } with {
        /// Stars, planets and moons. A body comes after its parent.
        bodies: Vec<Member> = Vec::new();
    }
}

params! {
    /// A body of a system: a star, a planet, a moon, or a point around which others move.
    pub struct Member {
        /// Name of the body, by which others refer to it.
        name: String = "Unnamed".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 64 }, Stage::Label;
        /// The preset of its surface, as a path from the folder of this file. Empty for a star and for a point.
        preset: String = String::new(), "Preset", Unit::None, Domain::File { max_chars: 1024 }, Stage::Label;
        /// Name of the body that it orbits; empty for the body at the root.
        parent: String = String::new(), "Parent", Unit::None, Domain::Text { max_chars: 64 }, Stage::Label;
        /// Mass in masses of the Earth: the Sun has 332,946, the Moon 0.0123. A point has 0.
        mass_earths: f64 = 1.0, "Mass", Unit::Earths, log(0.0, 1e9), Stage::Uniform;
    } with {
        /// The light of a star; None for a body that does not shine.
        light: Option<Light> = None;
        /// The orbit around the parent; None for the body at the root, and for a body with a start.
        orbit: Option<Orbit> = None;
        /// Position and velocity at time zero, instead of an orbit.
        start: Option<Start> = None;
        /// Rotation about the axis.
        spin: Spin = Spin::default();
    }
}

params! {
    /// The light of a star.
    pub struct Light {
        /// Radius of the star.
        radius_km: f64 = 695_700.0, "Radius", Unit::Kilometres, log(1000.0, 1e9), Stage::Uniform;
        /// Temperature of its surface: it decides the colour.
        kelvin: f64 = 5772.0, "Temperature", Unit::Kelvin, log(*STAR_KELVIN.start(), *STAR_KELVIN.end()), Stage::Uniform;
        /// Luminosity; 1 is the Sun's. A planet has sunlight of brightness 1 at one astronomical unit from 1.
        luminosity_suns: f64 = 1.0, "Luminosity", Unit::None, log(1e-6, 1e6), Stage::Uniform;
    }
}

params! {
    /// An orbit: Kepler elements at time zero. Angles are measured in the plane of reference of the system.
    pub struct Orbit {
        /// Semi-major axis: the mean of the least and the greatest distance.
        semi_major_km: f64 = 149_597_870.7, "Semi-major axis", Unit::Kilometres, log(1.0, 1e12), Stage::Uniform;
        /// Eccentricity: 0 is a circle.
        eccentricity: f64 = 0.0, "Eccentricity", Unit::None, linear(0.0, MAX_ECCENTRICITY), Stage::Uniform;
        /// Inclination to the plane of reference; above 90° the motion is retrograde.
        inclination_deg: f64 = 0.0, "Inclination", Unit::Degrees, linear(0.0, 180.0), Stage::Uniform;
        /// Longitude of the ascending node: where the body rises through the plane of reference.
        node_deg: f64 = 0.0, "Ascending node", Unit::Degrees, linear(0.0, 360.0), Stage::Uniform;
        /// Argument of the periapsis: the angle from the ascending node to the point next to the parent.
        periapsis_deg: f64 = 0.0, "Periapsis", Unit::Degrees, linear(0.0, 360.0), Stage::Uniform;
        /// Mean anomaly at time zero: the share of the period since the periapsis, times 360°.
        anomaly_deg: f64 = 0.0, "Mean anomaly", Unit::Degrees, linear(0.0, 360.0), Stage::Uniform;
        /// Period; 0: that of the masses of both bodies. A body that orbits a point must have one.
        period_hours: f64 = 0.0, "Period", Unit::Hours, log(0.0, 1e10), Stage::Uniform;
    }
}

params! {
    /// Where a body begins: position and velocity from its parent at time zero, in the frame of the system. They decide
    /// its orbit.
    pub struct Start {
        /// Position along the x-axis.
        x_km: f64 = 149_597_870.7, "X", Unit::Kilometres, linear(-1e12, 1e12), Stage::Uniform;
        /// Position along the y-axis.
        y_km: f64 = 0.0, "Y", Unit::Kilometres, linear(-1e12, 1e12), Stage::Uniform;
        /// Position along the z-axis, which points north.
        z_km: f64 = 0.0, "Z", Unit::Kilometres, linear(-1e12, 1e12), Stage::Uniform;
        /// Velocity along the x-axis.
        x_km_s: f64 = 0.0, "Velocity X", Unit::KilometresPerSecond, linear(-1e5, 1e5), Stage::Uniform;
        /// Velocity along the y-axis.
        y_km_s: f64 = 29.784_69, "Velocity Y", Unit::KilometresPerSecond, linear(-1e5, 1e5), Stage::Uniform;
        /// Velocity along the z-axis.
        z_km_s: f64 = 0.0, "Velocity Z", Unit::KilometresPerSecond, linear(-1e5, 1e5), Stage::Uniform;
    }
}

params! {
    /// Rotation of a body about its axis.
    pub struct Spin {
        /// Whether the same side always faces the parent; the period is then that of the orbit.
        locked: bool = false, "Tidally locked", Unit::None, Domain::Flag, Stage::Uniform;
        /// Time of one turn under the stars; 0: no rotation.
        period_hours: f64 = 24.0, "Period", Unit::Hours, log(0.0, 1e6), Stage::Uniform;
        /// Whether it turns westward.
        retrograde: bool = false, "Retrograde", Unit::None, Domain::Flag, Stage::Uniform;
        /// Angle between the axis and the normal of the orbit; at the root, the normal of the plane of reference.
        tilt_deg: f64 = 0.0, "Axial tilt", Unit::Degrees, linear(0.0, 90.0), Stage::Uniform;
        /// Direction in which the north pole leans, from the periapsis: where the body stands at northern winter.
        tilt_direction_deg: f64 = 0.0, "Direction of tilt", Unit::Degrees, linear(0.0, 360.0), Stage::Uniform;
        /// Turn at time zero. Of a locked body: longitude of the middle of the side that faces the parent.
        turn_deg: f64 = 0.0, "Turn", Unit::Degrees, linear(0.0, 360.0), Stage::Uniform;
    }
}

impl System {
    /// The number of the body with a name.
    pub fn find(&self, name: &str) -> Option<usize> {
        self.bodies.iter().position(|body| body.name == name)
    }

    /// The number of the parent of each body; None at the root, and for a parent that is not there.
    pub fn parents(&self) -> Vec<Option<usize>> {
        self.bodies.iter().map(|body| if body.parent.is_empty() { None } else { self.find(&body.parent) }).collect()
    }

    /// Whether a body goes with another one: it orbits it, or a body that does.
    pub fn carries(&self, body: usize, other: usize) -> bool {
        let parents = self.parents();
        std::iter::successors(parents[other], |above| parents[*above]).any(|above| above == body)
    }
}

impl Member {
    /// Mass in kilograms.
    pub fn mass_kg(&self) -> f64 {
        self.mass_earths * EARTH_MASS_KG
    }

    /// Standard gravitational parameter, m³/s².
    pub fn gravity_m3_s2(&self) -> f64 {
        self.mass_kg() * GRAVITATION
    }

    /// Its ellipse about a parent, from its orbit or its start. `parent_gravity`: of the parent, m³/s². None at the
    /// root, and for a start from which the body escapes or falls straight down.
    pub fn ellipse(&self, parent_gravity: f64) -> Option<Ellipse> {
        let gravity = parent_gravity + self.gravity_m3_s2();
        match (&self.orbit, &self.start) {
            (Some(orbit), _) => Some(Ellipse::new(orbit, gravity)),
            (None, Some(start)) => Ellipse::from_state(start.position_m(), start.velocity(), gravity),
            (None, None) => None,
        }
    }

    /// Whether it is a point: it has no surface and gives no light.
    pub fn is_point(&self) -> bool {
        self.preset.is_empty() && self.light.is_none()
    }
}

impl Start {
    /// Position in metres.
    pub fn position_m(&self) -> DVec3 {
        DVec3::new(self.x_km, self.y_km, self.z_km) * 1000.0
    }

    /// Velocity in m/s.
    pub fn velocity(&self) -> DVec3 {
        DVec3::new(self.x_km_s, self.y_km_s, self.z_km_s) * 1000.0
    }
}

impl Light {
    /// Radius in metres.
    pub fn radius_m(&self) -> f64 {
        self.radius_km * 1000.0
    }

    /// Colour of the light, linear sRGB.
    pub fn color(&self) -> [f64; 3] {
        star_color(self.kelvin)
    }

    /// Brightness at a distance in metres: 1 is the Sun on the Earth, as `star.brightness` of a preset.
    pub fn brightness_at(&self, distance_m: f64) -> f64 {
        self.luminosity_suns * (ASTRONOMICAL_UNIT_M / distance_m.max(self.radius_m())).powi(2)
    }
}
