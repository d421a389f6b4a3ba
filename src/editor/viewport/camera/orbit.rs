//! The orbit camera: a drag holds the ground under the pointer, the wheel moves towards the point under the pointer.
//!
//! The eye is over a location, at a distance from the planet's centre. The pitch follows the height above the ground
//! (straight down from space, towards the horizon below some kilometres) until the user tilts the view.
//! Angles are radians, lengths metres.

use super::{Ground, MAX_RADII};
use crate::lod::Camera;
use crate::lod::pose::{Attitude, Pose};
use crate::sphere::{LatLon, geo};
use glam::{DQuat, DVec3};
use std::f64::consts::{FRAC_PI_2, PI};

/// Least height of the eye above the ground or the sea.
pub const MIN_ALTITUDE_M: f64 = 2.0;
/// Distance from the centre at the start, in planet radii.
const START_RADII: f64 = 1.0 + crate::lod::opening::OPENING_ALTITUDE_RADII;
/// Greatest pitch that a tilt can set.
const MAX_PITCH_RAD: f64 = 0.9;
/// Pitch near the ground, unless tilted.
const GROUND_PITCH_RAD: f64 = -0.12;
/// A point farther away than this many altitudes is ahead of the eye rather than below it.
const FAR_ALTITUDES: f64 = 8.0;
/// Latitude up to which a drag keeps the heading; nearer to the poles the heading turns with the globe.
const KEEP_HEADING_LAT_RAD: f64 = 75.0 * PI / 180.0;

/// The point of the ground that a drag holds: its direction, and its distance from the centre.
#[derive(Clone, Copy, Debug)]
struct Grab {
    dir: DVec3,
    radius_m: f64,
    keep_heading: bool,
}

/// The orbit camera.
#[derive(Clone, Debug)]
pub struct Orbit {
    location: LatLon,
    /// Distance of the eye from the planet's centre.
    radius_m: f64,
    heading_rad: f64,
    /// The pitch that the user has set; None follows the altitude.
    pitch_rad: Option<f64>,
    grab: Option<Grab>,
}

impl Orbit {
    /// Looks at the whole planet from over a location.
    pub fn new(planet_radius_m: f64, over: LatLon) -> Self {
        Self { location: over, radius_m: planet_radius_m * START_RADII, heading_rad: 0.0, pitch_rad: None, grab: None }
    }

    /// Starts from a pose, without its roll. A pitch equal to that of the altitude follows the altitude again.
    pub fn from_pose(pose: &Pose, ground: &dyn Ground) -> Self {
        let attitude = Attitude::of(pose);
        let up = pose.up();
        let mut orbit = Self::new(ground.radius_m(), LatLon::from_direction(up));
        orbit.radius_m = pose.position_planet_m.length();
        orbit.heading_rad = heading(up, attitude.ahead);
        orbit.keep_above(ground);
        let by_hand = (orbit.pitch(ground) - attitude.pitch_rad).abs() > 1e-3;
        orbit.pitch_rad = by_hand.then(|| attitude.pitch_rad.min(MAX_PITCH_RAD));
        orbit
    }

    /// The pose of the eye.
    pub fn pose(&self, ground: &dyn Ground) -> Pose {
        let camera = self.camera(ground);
        Pose { position_planet_m: camera.position_planet_m, planet_from_view: camera.planet_from_view }
    }

    /// The location under the eye.
    pub fn location(&self) -> LatLon {
        self.location
    }

    /// Height of the eye above the ground or the sea.
    pub fn altitude_m(&self, ground: &dyn Ground) -> f64 {
        self.radius_m - ground.surface_radius_m(self.location.direction())
    }

    /// Scales the camera with a planet whose radius has changed.
    pub fn rescale(&mut self, from_radius_m: f64, to_radius_m: f64) {
        self.radius_m *= to_radius_m / from_radius_m;
    }

    /// The camera for drawing.
    pub fn camera(&self, ground: &dyn Ground) -> Camera {
        let pitch = self.pitch(ground);
        Camera::over(self.location, self.radius_m, self.heading_rad, pitch, Camera::DEFAULT_FOV_Y_RAD)
    }

    /// Pitch of the view: the angle above the horizon.
    pub fn pitch(&self, ground: &dyn Ground) -> f64 {
        let radius_m = ground.radius_m();
        let altitude_m = self.altitude_m(ground).max(MIN_ALTITUDE_M);
        let auto = auto_pitch(altitude_m, radius_m);
        match self.pitch_rad {
            // Far from the planet the view turns straight down, so that the planet stays in the picture.
            Some(pitch) => lerp(pitch, -FRAC_PI_2, smoothstep(2.0 * radius_m, 8.0 * radius_m, altitude_m)),
            None => auto,
        }
    }

    /// Keeps the eye above the ground and within [`MAX_RADII`]. Call it whenever the ground may have changed.
    pub fn keep_above(&mut self, ground: &dyn Ground) {
        let lowest_m = ground.surface_radius_m(self.location.direction()) + MIN_ALTITUDE_M;
        let highest_m = (ground.radius_m() * MAX_RADII).max(lowest_m);
        self.radius_m = if self.radius_m.is_finite() { self.radius_m.clamp(lowest_m, highest_m) } else { highest_m };
    }

    /// Starts a drag that holds the ground under the pointer (`x`, `y` from -1 to 1, right and up).
    pub fn grab(&mut self, x: f64, y: f64, aspect: f64, ground: &dyn Ground) {
        let camera = self.camera(ground);
        let (dir, radius_m) = self.point_under(&camera, x, y, aspect, ground, None);
        let keep_heading = self.location.lat_rad.abs() < KEEP_HEADING_LAT_RAD;
        self.grab = Some(Grab { dir, radius_m, keep_heading });
    }

    /// Turns the planet so that the held ground stays under the pointer.
    pub fn drag(&mut self, x: f64, y: f64, aspect: f64, ground: &dyn Ground) {
        if let Some(grab) = self.grab {
            self.bring_under(grab, x, y, aspect, ground);
            self.keep_above(ground);
        }
    }

    /// Ends the drag.
    pub fn release(&mut self) {
        self.grab = None;
    }

    /// Moves nearer (`steps` > 0) or farther; a step is a factor of e in altitude. The ground under the pointer stays
    /// under the pointer.
    pub fn zoom(&mut self, steps: f64, pointer: Option<(f64, f64)>, aspect: f64, ground: &dyn Ground) {
        let camera = self.camera(ground);
        let surface_m = ground.surface_radius_m(self.location.direction());
        let altitude_m = (self.radius_m - surface_m).max(MIN_ALTITUDE_M);
        let hit = pointer.and_then(|(x, y)| {
            let dir = camera.ray_dir_planet(x, y, aspect);
            Some((x, y, dir, ground.raycast(camera.position_planet_m, dir)?))
        });
        let far_m = FAR_ALTITUDES * altitude_m;
        // Towards a far point the eye moves straight: its altitude says little about the distance. Backwards it does
        // not, since it would hardly rise.
        if let Some((_, _, dir, _)) = hit.filter(|(_, _, _, distance_m)| *distance_m > far_m && steps > 0.0) {
            let eye = camera.position_planet_m + dir * far_m * (1.0 - libm::exp(-steps));
            self.location = LatLon::from_direction(eye);
            self.radius_m = eye.length();
            self.keep_above(ground);
            return;
        }
        let anchor = hit.map(|(x, y, dir, distance_m)| (camera.position_planet_m + dir * distance_m, x, y));
        self.radius_m = surface_m + altitude_m * libm::exp(-steps);
        self.keep_above(ground);
        if let Some((hit, x, y)) = anchor {
            let keep_heading = self.location.lat_rad.abs() < KEEP_HEADING_LAT_RAD;
            let grab = Grab { dir: hit.normalize(), radius_m: hit.length(), keep_heading };
            self.bring_under(grab, x, y, aspect, ground);
            self.keep_above(ground);
        }
    }

    /// Turns the view: `right_rad` to the right, `up_rad` up.
    pub fn tilt(&mut self, right_rad: f64, up_rad: f64, ground: &dyn Ground) {
        self.heading_rad = (self.heading_rad + right_rad).rem_euclid(2.0 * PI);
        if up_rad != 0.0 {
            self.pitch_rad = Some((self.pitch(ground) + up_rad).clamp(-FRAC_PI_2, MAX_PITCH_RAD));
        }
    }

    /// Moves over the ground to the right and ahead in the picture, in shares of the altitude.
    pub fn travel(&mut self, right: f64, ahead: f64, ground: &dyn Ground) {
        let altitude_m = self.altitude_m(ground).max(MIN_ALTITUDE_M);
        let up = self.location.direction();
        let (east, north) = geo::east_north(up);
        let (sin_h, cos_h) = libm::sincos(self.heading_rad);
        let ahead_dir = north * cos_h + east * sin_h;
        let right_dir = east * cos_h - north * sin_h;
        let step = (right_dir * right + ahead_dir * ahead) * (altitude_m / self.radius_m).min(0.6);
        let length = step.length();
        if length > 0.0 {
            let turned = DQuat::from_axis_angle(up.cross(step / length), length);
            self.turn(turned, false);
            self.keep_above(ground);
        }
    }

    /// The same camera at a quarter of the altitude, with a point of the ground in the middle of the picture. If the
    /// middle is near the horizon, the point is below the middle.
    pub fn near(&self, point: DVec3, ground: &dyn Ground) -> Self {
        let up = point.normalize_or(DVec3::Z);
        let altitude_m = (self.altitude_m(ground) * 0.25).max(MIN_ALTITUDE_M);
        let mut near = Self { location: LatLon::from_direction(up), grab: None, ..self.clone() };
        near.radius_m = ground.surface_radius_m(up) + altitude_m;
        let pitch_rad = near.pitch(ground);
        let back_m = altitude_m * (libm::cos(pitch_rad) / libm::sin(-pitch_rad).max(1e-3)).clamp(0.0, 3.0);
        let (east, north) = geo::east_north(up);
        let (sin_h, cos_h) = libm::sincos(self.heading_rad);
        let away = (up * near.radius_m - (north * cos_h + east * sin_h) * back_m).normalize();
        near.location = LatLon::from_direction(away);
        near.radius_m = ground.surface_radius_m(away) + altitude_m;
        near
    }

    /// Direction and distance from the centre of the ground under the pointer. Beside the globe it is the point of the
    /// globe nearest to the ray.
    fn point_under(
        &self,
        camera: &Camera,
        x: f64,
        y: f64,
        aspect: f64,
        ground: &dyn Ground,
        sphere_m: Option<f64>,
    ) -> (DVec3, f64) {
        let ray = camera.ray_dir_planet(x, y, aspect);
        let eye = camera.position_planet_m;
        if sphere_m.is_none()
            && let Some(distance_m) = ground.raycast(eye, ray)
        {
            let hit = eye + ray * distance_m;
            return (hit.normalize(), hit.length());
        }
        let radius_m = sphere_m.unwrap_or_else(|| ground.radius_m()).min(eye.length() - 0.5 * MIN_ALTITUDE_M);
        (sphere_point(eye, ray, radius_m), radius_m)
    }

    /// Moves the eye so that a point of the globe is under the pointer.
    fn bring_under(&mut self, grab: Grab, x: f64, y: f64, aspect: f64, ground: &dyn Ground) {
        // The pitch stays fixed: else it would change with the ground below the eye during a drag.
        let pitch = self.pitch(ground);
        // With a fixed heading the rotation is found by iteration, which converges fast away from the poles.
        let rounds = if grab.keep_heading { 12 } else { 1 };
        let limit_rad = (20.0 * self.altitude_m(ground).max(MIN_ALTITUDE_M) / self.radius_m).min(0.5);
        for _ in 0..rounds {
            let camera = Camera::over(self.location, self.radius_m, self.heading_rad, pitch, Camera::DEFAULT_FOV_Y_RAD);
            let (under, _) = self.point_under(&camera, x, y, aspect, ground, Some(grab.radius_m));
            let arc = DQuat::from_rotation_arc(under, grab.dir);
            let (axis, angle) = arc.to_axis_angle();
            if angle.abs() < 1e-14 {
                break;
            }
            self.turn(DQuat::from_axis_angle(axis, angle.min(limit_rad)), grab.keep_heading);
        }
    }

    /// Rotates the eye about the planet's centre.
    fn turn(&mut self, rotation: DQuat, keep_heading: bool) {
        let up = self.location.direction();
        let (east, north) = geo::east_north(up);
        let (sin_h, cos_h) = libm::sincos(self.heading_rad);
        let ahead = rotation * (north * cos_h + east * sin_h);
        let dir = (rotation * up).normalize();
        self.location = LatLon::from_direction(dir);
        if keep_heading {
            self.location.lat_rad = self.location.lat_rad.clamp(-1.55, 1.55);
        } else {
            self.heading_rad = heading(dir, ahead);
        }
    }
}

/// The heading of a direction, clockwise from north.
fn heading(up: DVec3, ahead: DVec3) -> f64 {
    let (east, north) = geo::east_north(up);
    libm::atan2(ahead.dot(east), ahead.dot(north)).rem_euclid(2.0 * PI)
}

/// The location under the star after a drag by `right` and `up` (shares of the picture's height): light and shadow
/// follow the pointer in the picture.
pub fn turn_sun(sun_dir_planet: DVec3, camera: &Camera, right: f64, up: f64) -> LatLon {
    let view_right = camera.planet_from_view * DVec3::X;
    let view_up = camera.planet_from_view * DVec3::Y;
    let turn = DQuat::from_axis_angle(view_up, right * PI) * DQuat::from_axis_angle(view_right, -up * PI);
    LatLon::from_direction(turn * sun_dir_planet)
}

/// The pitch for an altitude: straight down from space, towards the horizon near the ground. On a planet of the radius
/// of the Earth it changes between 400 km and 5 km; both scale with the radius.
fn auto_pitch(altitude_m: f64, planet_radius_m: f64) -> f64 {
    let scale = planet_radius_m / 6_371_000.0;
    let (low_m, high_m) = (5_000.0 * scale, 400_000.0 * scale);
    let share = smoothstep(libm::log(low_m), libm::log(high_m), libm::log(altitude_m));
    lerp(GROUND_PITCH_RAD, -FRAC_PI_2, share)
}

/// Direction of the first intersection of a ray with a sphere about the origin. A ray that misses gives the direction
/// of its point nearest to the origin.
pub(in crate::editor::viewport) fn sphere_point(eye: DVec3, ray: DVec3, radius_m: f64) -> DVec3 {
    let along = -eye.dot(ray);
    let nearest = eye + ray * along.max(0.0);
    let half_chord_sq = radius_m * radius_m - (eye + ray * along).length_squared();
    if along > 0.0 && half_chord_sq > 0.0 {
        (eye + ray * (along - half_chord_sq.sqrt())).normalize()
    } else {
        nearest.try_normalize().unwrap_or(DVec3::X)
    }
}

fn lerp(a: f64, b: f64, t: f64) -> f64 {
    a + (b - a) * t
}

fn smoothstep(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

#[cfg(test)]
mod tests {
    use super::*;

    struct Ball(f64);

    impl Ground for Ball {
        fn radius_m(&self) -> f64 {
            self.0
        }
        fn floor_radius_m(&self, _dir: DVec3) -> f64 {
            self.0
        }
        fn surface_radius_m(&self, _dir: DVec3) -> f64 {
            self.0
        }
        fn raycast(&self, origin: DVec3, dir: DVec3) -> Option<f64> {
            let along = -origin.dot(dir);
            let half_chord_sq = self.0 * self.0 - (origin + dir * along).length_squared();
            (along > 0.0 && half_chord_sq >= 0.0).then(|| along - half_chord_sq.sqrt())
        }
    }

    const EARTH: Ball = Ball(6_371_000.0);

    fn under(controller: &Orbit, x: f64, y: f64) -> DVec3 {
        let camera = controller.camera(&EARTH);
        let ray = camera.ray_dir_planet(x, y, 1.5);
        let distance = EARTH.raycast(camera.position_planet_m, ray).unwrap_or(f64::NAN);
        (camera.position_planet_m + ray * distance).normalize()
    }

    #[test]
    fn grabbed_ground_stays_under_the_pointer() {
        for (lat, steps) in [(0.0, 0.0), (40.0, 2.0), (-60.0, 4.0), (80.0, 1.0), (88.0, 3.0), (20.0, 9.0)] {
            let mut controller = Orbit::new(EARTH.0, LatLon::from_degrees(lat, 30.0));
            controller.zoom(steps, None, 1.5, &EARTH);
            controller.grab(0.1, -0.2, 1.5, &EARTH);
            let held = under(&controller, 0.1, -0.2);
            for (x, y) in [(0.12, -0.22), (0.2, -0.1), (0.15, -0.25)] {
                controller.drag(x, y, 1.5, &EARTH);
            }
            let camera = controller.camera(&EARTH);
            let miss = (under(&controller, 0.15, -0.25) - held).length() * EARTH.0;
            let distance = (camera.position_planet_m - held * EARTH.0).length();
            assert!(miss < 1e-3 * distance, "latitude {lat}, zoom {steps}: {miss} m off at {distance} m");
        }
    }

    #[test]
    fn zoom_is_exponential_and_stays_in_bounds() {
        let mut controller = Orbit::new(EARTH.0, LatLon::from_degrees(10.0, 20.0));
        let before = controller.altitude_m(&EARTH);
        controller.zoom(1.0, None, 1.5, &EARTH);
        assert!((controller.altitude_m(&EARTH) * std::f64::consts::E / before - 1.0).abs() < 1e-9);
        controller.zoom(100.0, None, 1.5, &EARTH);
        assert!((controller.altitude_m(&EARTH) - MIN_ALTITUDE_M).abs() < 1e-6);
        controller.zoom(-100.0, None, 1.5, &EARTH);
        assert!((controller.altitude_m(&EARTH) + EARTH.0 - MAX_RADII * EARTH.0).abs() < 1.0);
    }

    #[test]
    fn zoom_keeps_what_is_under_the_pointer() {
        let mut controller = Orbit::new(EARTH.0, LatLon::from_degrees(10.0, 20.0));
        let held = under(&controller, 0.2, 0.15);
        for _ in 0..20 {
            controller.zoom(0.1, Some((0.2, 0.15)), 1.5, &EARTH);
        }
        let miss = (under(&controller, 0.2, 0.15) - held).length() * EARTH.0;
        assert!(miss < 1e-3 * controller.altitude_m(&EARTH), "{miss} m off");
    }

    #[test]
    fn zooming_out_keeps_what_is_under_the_pointer() {
        for lat in [10.0, 55.0, -85.0] {
            for (x, y) in [(0.0, 0.0), (0.2, 0.15), (0.5, -0.7)] {
                for steps in [4.0, 8.0, 11.0] {
                    let mut controller = Orbit::new(EARTH.0, LatLon::from_degrees(lat, 20.0));
                    controller.zoom(steps, None, 1.5, &EARTH);
                    let held = under(&controller, x, y);
                    let before_m = controller.altitude_m(&EARTH);
                    // As long as the place is in front of the horizon.
                    while controller.altitude_m(&EARTH) < 1e6 {
                        let altitude_m = controller.altitude_m(&EARTH);
                        controller.zoom(-0.2, Some((x, y)), 1.5, &EARTH);
                        assert!(controller.altitude_m(&EARTH) > 1.1 * altitude_m, "it rises");
                        let away_m = (controller.pose(&EARTH).position_planet_m - held * EARTH.0).length();
                        let miss_m = (under(&controller, x, y) - held).length() * EARTH.0;
                        let at = format!("latitude {lat}, pointer {x} {y}, from {before_m} m to {altitude_m} m");
                        assert!(miss_m < 1e-2 * away_m, "{at}: {miss_m} m off, {away_m} m away");
                    }
                }
            }
        }
    }

    #[test]
    fn zoom_goes_straight_to_what_is_far_ahead() {
        let mut controller = Orbit::new(EARTH.0, LatLon::from_degrees(10.0, 20.0));
        controller.zoom(11.0, None, 1.5, &EARTH);
        let (x, y) = (0.1, 0.15);
        let held = under(&controller, x, y);
        let away_m = |controller: &Orbit| (controller.pose(&EARTH).position_planet_m - held * EARTH.0).length();
        let (before_m, altitude_m) = (away_m(&controller), controller.altitude_m(&EARTH));
        assert!(before_m > FAR_ALTITUDES * altitude_m, "{before_m} m away at {altitude_m} m");
        for _ in 0..10 {
            controller.zoom(0.1, Some((x, y)), 1.5, &EARTH);
        }
        assert!(away_m(&controller) < 0.75 * before_m, "{} of {before_m} m", away_m(&controller));
        let miss_m = (under(&controller, x, y) - held).length() * EARTH.0;
        assert!(miss_m < 0.1 * before_m, "{miss_m} m off");
    }

    #[test]
    fn the_eye_never_goes_under_rising_ground() {
        let mut controller = Orbit::new(EARTH.0, LatLon::from_degrees(0.0, 0.0));
        controller.zoom(100.0, None, 1.5, &EARTH);
        let risen = Ball(EARTH.0 + 8_000.0);
        controller.keep_above(&risen);
        assert!(controller.altitude_m(&risen) >= MIN_ALTITUDE_M - 1e-6);
    }

    #[test]
    fn pitch_follows_the_altitude_until_tilted() {
        let mut controller = Orbit::new(EARTH.0, LatLon::from_degrees(0.0, 0.0));
        assert_eq!(controller.pitch(&EARTH), -FRAC_PI_2);
        controller.zoom(100.0, None, 1.5, &EARTH);
        assert_eq!(controller.pitch(&EARTH), GROUND_PITCH_RAD);
        controller.tilt(0.0, 0.3, &EARTH);
        assert!((controller.pitch(&EARTH) - (GROUND_PITCH_RAD + 0.3)).abs() < 1e-12);
        controller.tilt(0.0, 10.0, &EARTH);
        assert_eq!(controller.pitch(&EARTH), MAX_PITCH_RAD);
        controller.zoom(-100.0, None, 1.5, &EARTH);
        assert_eq!(controller.pitch(&EARTH), -FRAC_PI_2, "from far space the planet is always in the picture");
    }

    #[test]
    fn travel_goes_ahead_and_light_follows_the_pointer() {
        let mut controller = Orbit::new(EARTH.0, LatLon::from_degrees(0.0, 0.0));
        controller.travel(0.0, 0.1, &EARTH);
        assert!(controller.location().lat_rad > 0.0 && controller.location().lon_rad.abs() < 1e-9);
        let camera = Orbit::new(EARTH.0, LatLon::from_degrees(0.0, 0.0)).camera(&EARTH);
        let east = turn_sun(DVec3::X, &camera, 0.1, 0.0);
        assert!((east.lon_rad - 0.1 * PI).abs() < 1e-9 && east.lat_rad.abs() < 1e-9);
        let north = turn_sun(DVec3::X, &camera, 0.0, 0.1);
        assert!((north.lat_rad - 0.1 * PI).abs() < 1e-9);
    }
}
