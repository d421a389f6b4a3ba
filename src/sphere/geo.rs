//! Latitude and longitude, local north and east, and directions spread evenly over the sphere.

use glam::DVec3;
use std::f64::consts::TAU;

/// A location on the globe. Latitude is -π/2 (south pole) to π/2 (north pole), longitude -π to π, east positive.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct LatLon {
    /// Radians north of the equator.
    pub lat_rad: f64,
    /// Radians east of the prime meridian.
    pub lon_rad: f64,
}

impl LatLon {
    /// From degrees.
    pub fn from_degrees(lat_deg: f64, lon_deg: f64) -> Self {
        Self { lat_rad: lat_deg.to_radians(), lon_rad: lon_deg.to_radians() }
    }

    /// The location under a direction of any length.
    pub fn from_direction(dir_planet: DVec3) -> Self {
        let flat = libm::hypot(dir_planet.x, dir_planet.y);
        Self { lat_rad: libm::atan2(dir_planet.z, flat), lon_rad: libm::atan2(dir_planet.y, dir_planet.x) }
    }

    /// Unit vector from the planet's centre.
    pub fn direction(self) -> DVec3 {
        let (sin_lat, cos_lat) = libm::sincos(self.lat_rad);
        let (sin_lon, cos_lon) = libm::sincos(self.lon_rad);
        DVec3::new(cos_lat * cos_lon, cos_lat * sin_lon, sin_lat)
    }

    /// Degrees, latitude first.
    pub fn to_degrees(self) -> (f64, f64) {
        (self.lat_rad.to_degrees(), self.lon_rad.to_degrees())
    }
}

/// Unit vectors to the east and north at a unit direction. At a pole, where neither is defined, longitude 0 lies
/// south.
pub fn east_north(dir_planet: DVec3) -> (DVec3, DVec3) {
    let flat = DVec3::new(-dir_planet.y, dir_planet.x, 0.0);
    let east = if flat.length_squared() > 1e-24 { flat.normalize() } else { DVec3::Y };
    (east, dir_planet.cross(east).normalize())
}

/// `count` unit directions, each of which stands for an equal area (Fibonacci grid; Swinbank and Purser 2006).
pub fn spread(count: usize) -> impl Iterator<Item = DVec3> {
    const GOLDEN: f64 = 0.618_033_988_749_894_9;
    (0..count).map(move |i| {
        let z = 1.0 - (2.0 * i as f64 + 1.0) / count as f64;
        let flat = libm::sqrt(1.0 - z * z);
        let turn = (i as f64 * GOLDEN).fract() * TAU;
        DVec3::new(flat * libm::cos(turn), flat * libm::sin(turn), z)
    })
}
