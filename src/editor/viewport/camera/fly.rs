//! Free flight: where one looks, faster the higher one is, and never into the ground.

use super::pose::{Attitude, Pose};
use super::{Controls, MAX_RADII};
use glam::DVec3;

/// Nearest one comes to the ground.
pub const CLEARANCE_M: f64 = 1.5;
/// Share of the height above the ground that one flies in a second.
const HEIGHTS_PER_SEC: f64 = 0.8;
/// However low, one flies at least as fast as this.
const LEAST_SPEED_M_S: f64 = 5.0;
/// Shift multiplies the speed.
const FAST: f64 = 5.0;
/// Time in which the speed comes near to what is asked for.
const INERTIA_SECS: f64 = 0.12;
const ROLL_RAD_PER_SEC: f64 = 1.0;
/// Below this share of the speed one stands still.
const STILL: f64 = 1e-3;

/// An eye in free flight.
#[derive(Clone, Copy, Debug)]
pub struct Fly {
    position_planet_m: DVec3,
    /// How the head is turned.
    pub attitude: Attitude,
    /// To the right, away from the ground, and to where one looks, in shares of the speed.
    thrust: DVec3,
    /// What the wheel has made of the speed.
    pub speed_factor: f64,
}

impl Fly {
    /// Goes on from a pose.
    pub fn from_pose(pose: &Pose) -> Self {
        let attitude = Attitude::of(pose);
        Self { position_planet_m: pose.position_planet_m, attitude, thrust: DVec3::ZERO, speed_factor: 1.0 }
    }

    /// The same elsewhere, at rest.
    pub fn moved_to(&self, pose: &Pose) -> Self {
        Self { speed_factor: self.speed_factor, ..Self::from_pose(pose) }
    }

    /// Where the eye is.
    pub fn pose(&self) -> Pose {
        Pose::new(self.position_planet_m, &self.attitude)
    }

    /// Keeps the eye above `floor_m`, the ground's distance from the centre, and within reach of the planet.
    pub fn keep_above(&mut self, floor_m: f64, planet_radius_m: f64) {
        let lowest_m = floor_m + CLEARANCE_M;
        let radius_m = self.position_planet_m.length().clamp(lowest_m, lowest_m.max(MAX_RADII * planet_radius_m));
        self.position_planet_m = self.position_planet_m.normalize_or(DVec3::Z) * radius_m;
    }

    /// Goes on for a while; `floor_m` gives the distance of what lies below from the planet's
    /// centre. Whether anything moved.
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
