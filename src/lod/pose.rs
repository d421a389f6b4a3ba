//! Position and orientation of the eye. Every camera gives a pose and can start from one.
//! Planet frame, metres, radians.

use super::Camera;
use crate::planet::Bookmark;
use crate::sphere::{LatLon, geo};
use glam::{DMat3, DQuat, DVec3};
use std::f64::consts::FRAC_PI_2;

/// Position and orientation of the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Pose {
    /// Position of the eye, from the planet's centre.
    pub position_planet_m: DVec3,
    /// Rotates view space (looking along -Z, +Y up) into the planet frame.
    pub planet_from_view: DQuat,
}

impl Pose {
    /// The pose of an eye at a position with an attitude.
    pub fn new(position_planet_m: DVec3, attitude: &Attitude) -> Self {
        let planet_from_view = attitude.planet_from_view(position_planet_m.normalize_or(DVec3::Z));
        Self { position_planet_m, planet_from_view }
    }

    /// Unit vector from the planet's centre to the eye.
    pub fn up(&self) -> DVec3 {
        self.position_planet_m.normalize_or(DVec3::Z)
    }

    /// The pose of a bookmark. `surface_radius_m`: distance from the centre to the ground or the water in a direction.
    pub fn of_bookmark(bookmark: &Bookmark, surface_radius_m: impl FnOnce(DVec3) -> f64) -> Self {
        let up = LatLon::from_degrees(bookmark.latitude_deg, bookmark.longitude_deg).direction();
        let (east, north) = geo::east_north(up);
        let (sin_h, cos_h) = libm::sincos(bookmark.heading_deg.to_radians());
        let attitude = Attitude {
            ahead: north * cos_h + east * sin_h,
            pitch_rad: bookmark.pitch_deg.to_radians(),
            roll_rad: bookmark.roll_deg.to_radians(),
        };
        Self::new(up * (surface_radius_m(up) + bookmark.altitude_m), &attitude)
    }

    /// The bookmark of the pose. `surface_radius_m` is the distance from the centre to the ground or the sea below it.
    pub fn bookmark(&self, name: String, surface_radius_m: f64) -> Bookmark {
        let up = self.up();
        let attitude = Attitude::of(self);
        let (east, north) = geo::east_north(up);
        let heading_rad = libm::atan2(attitude.ahead.dot(east), attitude.ahead.dot(north));
        let (latitude_deg, longitude_deg) = LatLon::from_direction(up).to_degrees();
        // Seven decimals of a degree are a centimetre on a planet of the size of the Earth.
        let rounded = |value: f64, decimals: i32| {
            let unit = 10_f64.powi(decimals);
            (value * unit).round() / unit
        };
        Bookmark {
            name,
            latitude_deg: rounded(latitude_deg, 7),
            longitude_deg: rounded(longitude_deg, 7),
            altitude_m: rounded(self.position_planet_m.length() - surface_radius_m, 3),
            heading_deg: rounded(heading_rad.to_degrees().rem_euclid(360.0), 3),
            pitch_deg: rounded(attitude.pitch_rad.to_degrees(), 3),
            roll_deg: rounded(attitude.roll_rad.to_degrees(), 3),
        }
    }

    /// The camera for drawing.
    pub fn camera(&self, fov_y_rad: f64) -> Camera {
        let Self { position_planet_m, planet_from_view } = *self;
        Camera { position_planet_m, planet_from_view, fov_y_rad }
    }
}

/// Orientation of the view against the ground below the eye.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Attitude {
    /// Direction ahead, along the ground.
    pub ahead: DVec3,
    /// Angle above the horizon, -π/2 to π/2.
    pub pitch_rad: f64,
    /// Angle by which the top of the view leans to the right.
    pub roll_rad: f64,
}

impl Attitude {
    /// The attitude of a pose. In a view straight up or down, the top of the picture gives the direction ahead.
    pub fn of(pose: &Pose) -> Self {
        let up = pose.up();
        let forward = pose.planet_from_view * DVec3::NEG_Z;
        let top = pose.planet_from_view * DVec3::Y;
        let sin_pitch = forward.dot(up).clamp(-1.0, 1.0);
        let along = forward - up * sin_pitch;
        // `asin` would lose digits near ±90°.
        let pitch_rad = libm::atan2(sin_pitch, along.length());
        let along = if along.length() > 1e-6 { along } else { top * -sin_pitch.signum() };
        let ahead = level(along, up);
        let unrolled = Self { ahead, pitch_rad, roll_rad: 0.0 }.planet_from_view(up);
        let roll_rad = libm::atan2(top.dot(unrolled * DVec3::X), top.dot(unrolled * DVec3::Y));
        Self { ahead, pitch_rad, roll_rad }
    }

    /// The orientation of an eye whose location is in direction `up`.
    pub fn planet_from_view(&self, up: DVec3) -> DQuat {
        let (sin_p, cos_p) = libm::sincos(self.pitch_rad);
        let forward = self.ahead * cos_p + up * sin_p;
        let top = up * cos_p - self.ahead * sin_p;
        let unrolled = DQuat::from_mat3(&DMat3::from_cols(forward.cross(top), top, -forward));
        (unrolled * DQuat::from_rotation_z(-self.roll_rad)).normalize()
    }

    /// Turns the view to the right and up in the picture, whatever its roll.
    pub fn look(&mut self, right_rad: f64, up_rad: f64, up: DVec3) {
        let (sin_r, cos_r) = libm::sincos(self.roll_rad);
        let (right_rad, up_rad) = (right_rad * cos_r + up_rad * sin_r, up_rad * cos_r - right_rad * sin_r);
        self.ahead = level(DQuat::from_axis_angle(up, -right_rad) * self.ahead, up);
        self.pitch_rad = (self.pitch_rad + up_rad).clamp(-FRAC_PI_2, FRAC_PI_2);
    }

    /// Turns the view along a vector.
    pub fn look_at(&mut self, way: DVec3, up: DVec3) {
        let climb = way.dot(up);
        let along = way - up * climb;
        self.pitch_rad = libm::atan2(climb, along.length());
        // Straight down, the direction ahead stays.
        if along.length() > 1e-6 * climb.abs() {
            self.ahead = level(along, up);
        }
    }

    /// Keeps the attitude against the ground while the eye moves from over one location to over another.
    pub fn carry(&mut self, from_up: DVec3, to_up: DVec3) {
        self.ahead = level(DQuat::from_rotation_arc(from_up, to_up) * self.ahead, to_up);
    }

    /// Direction to the right, along the ground.
    pub fn right(&self, up: DVec3) -> DVec3 {
        self.ahead.cross(up)
    }
}

/// The direction of the part of a vector along the ground.
fn level(v: DVec3, up: DVec3) -> DVec3 {
    (v - up * v.dot(up)).try_normalize().unwrap_or_else(|| up.any_orthonormal_vector())
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    proptest! {
        #[test]
        fn an_attitude_is_read_back_from_its_pose(
            place in prop::array::uniform3(-1.0..1.0_f64), pitch in -1.57..1.57_f64, roll in -3.1..3.1_f64, turn in -3.0..3.0_f64,
        ) {
            let up = DVec3::from_array(place).normalize_or(DVec3::Z);
            let ahead = DQuat::from_axis_angle(up, turn) * up.any_orthonormal_vector();
            let pose = Pose::new(up * 6e6, &Attitude { ahead, pitch_rad: pitch, roll_rad: roll });
            let read = Attitude::of(&pose);
            prop_assert!((read.pitch_rad - pitch).abs() < 1e-9 && (read.roll_rad - roll).abs() < 1e-6, "{read:?}");
            prop_assert!(Pose::new(pose.position_planet_m, &read).planet_from_view.angle_between(pose.planet_from_view) < 1e-7);
        }
    }

    #[test]
    fn straight_down_is_no_special_case() {
        for pitch_rad in [-FRAC_PI_2, FRAC_PI_2] {
            let attitude = Attitude { ahead: DVec3::Y, pitch_rad, roll_rad: 0.0 };
            let read = Attitude::of(&Pose::new(DVec3::X * 10.0, &attitude));
            assert!(read.ahead.distance(DVec3::Y) < 1e-9 && (read.pitch_rad - pitch_rad).abs() < 1e-7, "{read:?}");
        }
    }

    #[test]
    fn to_look_right_turns_the_picture_right_even_when_rolled() {
        for roll_rad in [0.0, 0.7, -2.0] {
            let mut attitude = Attitude { ahead: DVec3::Y, pitch_rad: 0.0, roll_rad };
            let before = Pose::new(DVec3::X, &attitude).planet_from_view;
            attitude.look(0.01, 0.0, DVec3::X);
            let now = Pose::new(DVec3::X, &attitude).planet_from_view * DVec3::NEG_Z;
            let seen = before.inverse() * now;
            assert!(seen.x > 0.009 && seen.y.abs() < 1e-3, "{roll_rad}: {seen}");
        }
    }

    #[test]
    fn a_bookmark_is_the_pose_it_was_made_of() {
        let radius_m = 6_371_000.0;
        for (lat, lon, altitude_m, pitch_rad, roll_rad) in
            [(10.0, 20.0, 1.7, -0.2, 0.0), (-89.99, 100.0, 5e6, -1.5, 0.4), (90.0, 0.0, 12e6, -1.57, 0.0)]
        {
            let up = LatLon::from_degrees(lat, lon).direction();
            let attitude = Attitude { ahead: geo::east_north(up).0, pitch_rad, roll_rad };
            let before = Pose::new(up * (radius_m + altitude_m), &attitude);
            let kept = before.bookmark("Here".to_owned(), radius_m);
            let after = Pose::of_bookmark(&kept, |_| radius_m);
            let off_m = before.position_planet_m.distance(after.position_planet_m);
            assert!(off_m < 0.02 + 1e-8 * altitude_m, "{off_m} m off");
            assert!(before.planet_from_view.angle_between(after.planet_from_view) < 1e-4);
        }
    }
}
