//! Plates that are changed by hand: moved, turned, grown, given another motion or another crust.
//!
//! The layout of the parameters comes first, and edits change it: so an edit of one plate leaves all others where they
//! are. A plate that is moved keeps a frame of its own, *home*, in which its continents and the noise of their coasts
//! stay as they were laid out.

use super::layout::{Layout, Plate, rotated};
use crate::planet::{PlateByHand, PlateKind};
use crate::sphere::LatLon;
use crate::sphere::geo::east_north;
use crate::world::EARTH_KM;
use glam::{DMat3, DVec3};

/// Places, turns and motions of entries are rounded to this many steps a unit: a preset stays readable.
const STEPS: f64 = 100.0;

/// The rotation that takes a plate from home to its place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Moved {
    to_home: DMat3,
    /// Its motion as it was laid out.
    home_pole: DVec3,
}

/// The shortest way from one unit direction to another.
fn shortest(from: DVec3, to: DVec3) -> DMat3 {
    let axis = from.cross(to);
    let (sin, cos) = (axis.length(), from.dot(to));
    let axis = if sin > 1e-12 { axis * (1.0 / sin) } else { from.any_orthonormal_vector() };
    turned(axis, libm::atan2(sin, cos))
}

/// The rotation about a unit axis.
fn turned(axis: DVec3, angle_rad: f64) -> DMat3 {
    DMat3::from_cols_array_2d(&[DVec3::X, DVec3::Y, DVec3::Z].map(|dir| rotated(dir, axis, angle_rad).to_array()))
}

impl PlateByHand {
    fn center(&self) -> DVec3 {
        LatLon::from_degrees(self.latitude_deg, self.longitude_deg).direction()
    }

    /// The rotation from a home with this middle.
    fn rotation(&self, home_center: DVec3) -> DMat3 {
        let center = self.center();
        turned(center, self.turn_deg.to_radians()) * shortest(home_center, center)
    }
}

impl Plate {
    /// Its middle and its motion as they were laid out.
    fn at_home(&self) -> (DVec3, DVec3) {
        self.moved.map_or((self.center, self.pole), |moved| (moved.to_home * self.center, moved.home_pole))
    }
}

impl Layout {
    /// Changes plates. `spacing_rad` is the mean distance of two plates. Continents of plates that become continental
    /// are there already.
    pub(super) fn change(&mut self, edits: &[PlateByHand], spacing_rad: f64) {
        for edit in edits {
            let Some(plate) = self.plates.get_mut(edit.plate as usize) else { continue };
            let (center, from_home) = (edit.center(), edit.rotation(plate.center));
            let spin = plate.pole.dot(plate.center);
            plate.moved = Some(Moved { to_home: from_home.transpose(), home_pole: plate.pole });
            plate.center = center;
            let (east, north) = east_north(center);
            let (sin, cos) = libm::sincos(edit.heading_deg.to_radians());
            plate.pole = center.cross(east * sin + north * cos) * (edit.drift_mm_yr / EARTH_KM) + center * spin;
            plate.weight += 0.5 * edit.growth * spacing_rad * spacing_rad;
            match edit.kind {
                PlateKind::AsLaidOut => {}
                PlateKind::Continental => plate.is_continental = true,
                PlateKind::Oceanic => {
                    plate.is_continental = false;
                    plate.cratons.clear();
                }
            }
        }
    }

    /// The bent direction at a direction, in the home of a plate. `bent`: the bent direction there.
    pub(super) fn home(&self, plate: usize, dir: DVec3, bent: DVec3) -> DVec3 {
        self.plates[plate].moved.map_or(bent, |moved| self.bent(moved.to_home * dir))
    }

    /// Where a direction at the home of a plate has gone.
    #[cfg(test)]
    pub(super) fn moved_dir(&self, plate: usize, home: DVec3) -> DVec3 {
        self.plates[plate].moved.map_or(home, |moved| moved.to_home.transpose() * home)
    }

    /// A way between two bent directions, in the home of a plate.
    pub(super) fn way_home(&self, plate: usize, way: DVec3) -> DVec3 {
        self.plates[plate].moved.map_or(way, |moved| moved.to_home * way)
    }

    /// Whether any plate has a home of its own.
    pub(super) fn any_moved(&self) -> bool {
        self.plates.iter().any(|plate| plate.moved.is_some())
    }

    /// The entry that leaves a plate as it was laid out, but for rounding.
    pub(crate) fn entry(&self, plate: usize) -> Option<PlateByHand> {
        let (center, pole) = self.plates.get(plate)?.at_home();
        let (latitude_deg, longitude_deg) = LatLon::from_direction(center).to_degrees();
        let (east, north) = east_north(center);
        let motion = pole.cross(center) * EARTH_KM;
        Some(PlateByHand {
            plate: u32::try_from(plate).ok()?,
            latitude_deg: tidy(latitude_deg),
            longitude_deg: tidy(longitude_deg),
            heading_deg: tidy(libm::atan2(motion.dot(east), motion.dot(north)).to_degrees()),
            drift_mm_yr: tidy(motion.length()).min(1000.0),
            ..PlateByHand::default()
        })
    }

    /// The entry of a plate after it was dragged from one unit direction to another: what lay under the first lies
    /// under the second.
    pub(crate) fn dragged(&self, entry: &PlateByHand, from: DVec3, to: DVec3) -> Option<PlateByHand> {
        let (home, _) = self.plates.get(entry.plate as usize)?.at_home();
        let end = shortest(from, to) * entry.rotation(home);
        let center = (end * home).normalize();
        // What is left after the shortest way is the turn about the middle.
        let left = end * shortest(home, center).transpose();
        let (east, north) = east_north(center);
        let turned = left * east;
        let (latitude_deg, longitude_deg) = LatLon::from_direction(center).to_degrees();
        Some(PlateByHand {
            latitude_deg: tidy(latitude_deg),
            longitude_deg: tidy(longitude_deg),
            turn_deg: tidy(libm::atan2(turned.dot(north), turned.dot(east)).to_degrees()),
            ..entry.clone()
        })
    }
}

fn tidy(value: f64) -> f64 {
    // Adding zero makes -0 a 0.
    (value * STEPS).round() / STEPS + 0.0
}
