//! Free flight: along the view, with a speed that grows with the height above the ground.

use super::{Controls, MAX_RADII};
use crate::lod::pose::{Attitude, Pose};
use glam::DVec3;

/// Least height of the eye above the ground.
pub const CLEARANCE_M: f64 = 1.5;
/// Speed per second, as a share of the height above the ground.
const HEIGHTS_PER_SEC: f64 = 0.8;
/// Least speed.
const LEAST_SPEED_M_S: f64 = 5.0;
/// Factor of Shift on the speed.
const FAST: f64 = 5.0;
/// Time constant in which the speed approaches the one asked for.
const INERTIA_SECS: f64 = 0.12;
/// Speed of the roll.
const ROLL_RAD_PER_SEC: f64 = 1.0;
/// A smaller share of the speed counts as rest.
const STILL: f64 = 1e-3;

/// An eye in free flight.
#[derive(Clone, Copy, Debug)]
pub struct Fly {
    position_planet_m: DVec3,
    /// Orientation of the view.
    pub attitude: Attitude,
    /// Velocity to the right, away from the ground, and along the view, in shares of the speed.
    thrust: DVec3,
    /// The factor that the wheel has given to the speed.
    pub speed_factor: f64,
}

impl Fly {
    /// Starts from a pose, at rest.
    pub fn from_pose(pose: &Pose) -> Self {
        let attitude = Attitude::of(pose);
        Self { position_planet_m: pose.position_planet_m, attitude, thrust: DVec3::ZERO, speed_factor: 1.0 }
    }

    /// The same camera at another pose, at rest.
    pub fn moved_to(&self, pose: &Pose) -> Self {
        Self { speed_factor: self.speed_factor, ..Self::from_pose(pose) }
    }

    /// The pose of the eye.
    pub fn pose(&self) -> Pose {
        Pose::new(self.position_planet_m, &self.attitude)
    }

    /// Keeps the eye above `floor_m`, the ground's distance from the centre, and within [`MAX_RADII`].
    pub fn keep_above(&mut self, floor_m: f64, planet_radius_m: f64) {
        let lowest_m = floor_m + CLEARANCE_M;
        let radius_m = self.position_planet_m.length().clamp(lowest_m, lowest_m.max(MAX_RADII * planet_radius_m));
        self.position_planet_m = self.position_planet_m.normalize_or(DVec3::Z) * radius_m;
    }

    /// Advances by a time; `floor_m` gives the distance from the planet's centre to the ground or the sea. Gives
    /// whether the camera moved.
    pub fn advance(
        &mut self,
        duration_secs: f64,
        controls: &Controls,
        planet_radius_m: f64,
        floor_m: impl Fn(DVec3) -> f64,
    ) -> bool {
        let wished = DVec3::new(controls.right, controls.up, controls.ahead).clamp_length_max(1.0);
        let wished = wished * if controls.fast { FAST } else { 1.0 };
        self.thrust = wished + (self.thrust - wished) * libm::exp(-duration_secs / INERTIA_SECS);
        if wished == DVec3::ZERO && self.thrust.length() < STILL {
            self.thrust = DVec3::ZERO;
        }
        self.attitude.roll_rad += controls.roll * ROLL_RAD_PER_SEC * duration_secs;
        if self.thrust == DVec3::ZERO {
            return controls.roll != 0.0;
        }
        let pose = self.pose();
        let up = pose.up();
        let height_m = pose.position_planet_m.length() - floor_m(up);
        let speed_m_s = (height_m * HEIGHTS_PER_SEC).clamp(LEAST_SPEED_M_S, planet_radius_m) * self.speed_factor;
        let right = pose.planet_from_view * DVec3::X;
        let forward = pose.planet_from_view * DVec3::NEG_Z;
        let way = right * self.thrust.x + up * self.thrust.y + forward * self.thrust.z;
        self.position_planet_m += way * speed_m_s * duration_secs;
        let now_up = self.position_planet_m.normalize_or(DVec3::Z);
        self.keep_above(floor_m(now_up), planet_radius_m);
        self.attitude.carry(up, now_up);
        true
    }
}
