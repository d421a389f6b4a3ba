//! The plane that touches the sphere at a place: local axes, and distances and bearings from the place.

use super::geo::{LatLon, east_north};
use glam::DVec3;

/// A place and its local axes: east, north and up, right-handed.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Tangent {
    /// Unit direction of the place in the planet frame: up.
    pub up_planet: DVec3,
    /// Unit vector to the east.
    pub east_planet: DVec3,
    /// Unit vector to the north.
    pub north_planet: DVec3,
}

impl Tangent {
    /// The plane at a unit direction in the planet frame.
    pub fn new(up_planet: DVec3) -> Self {
        let (east_planet, north_planet) = east_north(up_planet);
        Self { up_planet, east_planet, north_planet }
    }

    /// The plane at a location.
    pub fn at(place: LatLon) -> Self {
        Self::new(place.direction())
    }

    /// A vector of the planet frame along east, north and up.
    pub fn local(&self, vector_planet: DVec3) -> DVec3 {
        DVec3::new(
            vector_planet.dot(self.east_planet),
            vector_planet.dot(self.north_planet),
            vector_planet.dot(self.up_planet),
        )
    }

    /// A vector along east, north and up in the planet frame.
    pub fn planet(&self, vector_local: DVec3) -> DVec3 {
        self.east_planet * vector_local.x + self.north_planet * vector_local.y + self.up_planet * vector_local.z
    }

    /// Unit direction of the point that lies so far from the place along the great circle whose bearing has these
    /// components: the azimuthal equidistant projection (Snyder 1987, "Map projections: a working manual", chapter 25).
    pub fn direction(&self, east_rad: f64, north_rad: f64) -> DVec3 {
        let away_rad = libm::hypot(east_rad, north_rad);
        if away_rad == 0.0 {
            return self.up_planet;
        }
        let (sin, cos) = libm::sincos(away_rad);
        let along = (self.east_planet * east_rad + self.north_planet * north_rad) * (sin / away_rad);
        (self.up_planet * cos + along).normalize()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn local_vectors_return() {
        let tangent = Tangent::at(LatLon::from_degrees(-35.0, 140.0));
        let vector = DVec3::new(3.0, -4.0, 5.0);
        assert!(tangent.planet(tangent.local(vector)).distance(vector) < 1e-12);
        assert!(tangent.local(tangent.up_planet).distance(DVec3::Z) < 1e-12);
        assert!(tangent.east_planet.cross(tangent.north_planet).distance(tangent.up_planet) < 1e-12);
    }

    #[test]
    fn distances_and_bearings_from_the_place_are_true() {
        let tangent = Tangent::at(LatLon::from_degrees(10.0, 179.0));
        let dir = tangent.direction(0.03, 0.04);
        assert!((dir.dot(tangent.up_planet).acos() - 0.05).abs() < 1e-12);
        let local = tangent.local(dir);
        assert!((local.x / local.y - 0.75).abs() < 1e-12);
        assert_eq!(tangent.direction(0.0, 0.0), tangent.up_planet);
    }
}
