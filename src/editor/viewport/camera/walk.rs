//! Walking: gravity, jumps, and a speed that follows the slope. The physics has a fixed time step, so that equal keys
//! lead to equal positions at any frame rate.

use super::Controls;
use crate::lod::pose::{Attitude, Pose};
use glam::DVec3;

/// Height of the eyes above the ground.
pub const EYE_M: f64 = 1.7;
/// Time step of the physics.
const STEP_SECS: f64 = 1.0 / 120.0;
/// Longest time that one frame advances: after a slow frame the rest is dropped.
const MOST_SECS: f64 = 0.25;
const GRAVITY_M_S2: f64 = 9.81;
/// Height of a jump.
const JUMP_M: f64 = 1.2;
/// Speed on level ground.
const PACE_M_S: f64 = 2.5;
/// Factor of Shift on the speed.
const FAST: f64 = 4.0;
/// Least share of the speed on steep ground, so that nobody gets stuck.
const LEAST_PACE: f64 = 0.12;
/// Distance over which the slope ahead is measured.
const SLOPE_OVER_M: f64 = 0.5;
/// Rate at which the speed approaches the one asked for: in the air, and on the ground.
const GRIP_PER_SEC: [f64; 2] = [1.5, 12.0];
/// Greatest drop of the ground below the feet that is followed; below a greater one the walker falls.
const STEP_DOWN_M: f64 = 0.05;
/// Steepest descent (rise over run) that the walker follows without falling.
const STEEPEST_WALKED: f64 = 3.0;
/// A lower speed counts as rest.
const STILL_M_S: f64 = 0.01;

/// State of the feet after a time step.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Feet {
    /// Unit vector from the planet's centre.
    up: DVec3,
    /// Distance from the planet's centre.
    radius_m: f64,
    climb_m_s: f64,
    /// Velocity along the ground.
    pace_m_s: DVec3,
    standing: bool,
}

/// The walking camera.
#[derive(Clone, Copy, Debug)]
pub struct Walk {
    feet: Feet,
    before: Feet,
    /// Orientation of the view.
    pub attitude: Attitude,
    /// Time since the last whole step.
    left_secs: f64,
}

impl Walk {
    /// Starts from a pose; falls if it is above the ground.
    pub fn from_pose(pose: &Pose) -> Self {
        let radius_m = pose.position_planet_m.length() - EYE_M;
        let feet = Feet { up: pose.up(), radius_m, climb_m_s: 0.0, pace_m_s: DVec3::ZERO, standing: false };
        // A walker has no roll.
        let attitude = Attitude { roll_rad: 0.0, ..Attitude::of(pose) };
        Self { feet, before: feet, attitude, left_secs: 0.0 }
    }

    /// The pose of the eye, interpolated between the last two steps.
    pub fn pose(&self) -> Pose {
        let share = self.left_secs / STEP_SECS;
        let up = self.before.up.lerp(self.feet.up, share).normalize();
        let radius_m = self.before.radius_m + (self.feet.radius_m - self.before.radius_m) * share;
        Pose::new(up * (radius_m + EYE_M), &self.attitude)
    }

    /// Whether the feet are on the ground.
    pub fn is_standing(&self) -> bool {
        self.feet.standing
    }

    /// Lifts the feet onto ground that has risen, and lets them fall onto ground that has sunk. `floor_m` is the
    /// distance of the ground from the planet's centre.
    pub fn keep_above(&mut self, floor_m: f64) {
        if self.feet.radius_m < floor_m {
            self.feet = Feet { radius_m: floor_m, climb_m_s: 0.0, standing: true, ..self.feet };
            self.before = self.feet;
        } else if self.feet.radius_m > floor_m + STEP_DOWN_M {
            self.feet.standing = false;
        }
    }

    /// Scales the camera with a planet whose radius has changed.
    pub fn rescale(&mut self, factor: f64) {
        self.feet.radius_m *= factor;
        self.before = self.feet;
    }

    /// Advances by a time; `floor_m` gives the distance of the ground from the planet's centre. Gives whether the
    /// camera moves.
    pub fn advance(&mut self, duration_secs: f64, controls: &Controls, floor_m: impl Fn(DVec3) -> f64) -> bool {
        if self.is_resting() && !controls.moves_feet() {
            self.left_secs = 0.0;
            self.before = self.feet;
            return false;
        }
        self.left_secs += duration_secs.min(MOST_SECS);
        while self.left_secs >= STEP_SECS {
            self.left_secs -= STEP_SECS;
            self.before = self.feet;
            let from = self.feet.up;
            self.feet = step(&self.feet, &self.attitude, controls, &floor_m);
            self.attitude.carry(from, self.feet.up);
        }
        true
    }

    fn is_resting(&self) -> bool {
        self.feet.standing && self.feet.pace_m_s == DVec3::ZERO
    }
}

/// One time step of the physics.
fn step(feet: &Feet, attitude: &Attitude, controls: &Controls, floor_m: &impl Fn(DVec3) -> f64) -> Feet {
    let up = feet.up;
    let floor_here_m = floor_m(up);
    let wished = attitude.ahead * controls.ahead + attitude.right(up) * controls.right;
    let wished = wished.clamp_length_max(1.0);
    let mut wished_m_s = DVec3::ZERO;
    if let Some(dir) = wished.try_normalize() {
        let there = (up * feet.radius_m + dir * SLOPE_OVER_M).normalize();
        let slope = (floor_m(there) - floor_here_m) / SLOPE_OVER_M;
        wished_m_s = wished * PACE_M_S * if controls.fast { FAST } else { 1.0 } * pace_on(slope);
    }
    let grip = GRIP_PER_SEC[usize::from(feet.standing)] * STEP_SECS;
    let mut pace_m_s = feet.pace_m_s + (wished_m_s - feet.pace_m_s) * grip;
    if wished == DVec3::ZERO && feet.standing && pace_m_s.length() < STILL_M_S {
        pace_m_s = DVec3::ZERO;
    }
    let now_up = (up * feet.radius_m + pace_m_s * STEP_SECS).normalize();
    pace_m_s -= now_up * pace_m_s.dot(now_up);
    let floor_now_m = if pace_m_s == DVec3::ZERO { floor_here_m } else { floor_m(now_up) };

    let jumps = controls.jump && feet.standing;
    let climb_m_s =
        if jumps { (2.0 * GRAVITY_M_S2 * JUMP_M).sqrt() } else { feet.climb_m_s - GRAVITY_M_S2 * STEP_SECS };
    let radius_m = feet.radius_m + climb_m_s * STEP_SECS;
    let followed_m = STEP_DOWN_M + pace_m_s.length() * STEP_SECS * STEEPEST_WALKED;
    let follows = feet.standing && !jumps && feet.radius_m - floor_now_m < followed_m;
    if radius_m <= floor_now_m || follows {
        Feet { up: now_up, radius_m: floor_now_m, climb_m_s: 0.0, pace_m_s, standing: true }
    } else {
        Feet { up: now_up, radius_m, climb_m_s, pace_m_s, standing: false }
    }
}

/// Share of the speed on a slope (rise over run): Tobler's hiking function (1993), 1 on level ground.
fn pace_on(slope: f64) -> f64 {
    libm::exp(-3.5 * ((slope + 0.05).abs() - 0.05)).max(LEAST_PACE)
}

#[cfg(test)]
mod tests {
    use super::*;

    const RADIUS_M: f64 = 6_371_000.0;

    fn standing(floor_m: impl Fn(DVec3) -> f64) -> Walk {
        let attitude = Attitude { ahead: DVec3::Y, pitch_rad: 0.0, roll_rad: 0.0 };
        let mut walk = Walk::from_pose(&Pose::new(DVec3::X * (floor_m(DVec3::X) + EYE_M), &attitude));
        walk.advance(0.1, &Controls::default(), floor_m);
        walk
    }

    fn gone_m(walk: &Walk) -> f64 {
        walk.feet.up.distance(DVec3::X) * RADIUS_M
    }

    const AHEAD: Controls = Controls { right: 0.0, up: 0.0, ahead: 1.0, roll: 0.0, fast: false, jump: false };

    #[test]
    fn the_same_keys_lead_to_the_same_place_at_any_frame_rate() {
        let hills = |dir: DVec3| RADIUS_M + 20.0 * libm::sin(dir.y * RADIUS_M / 30.0);
        let ends: Vec<Feet> = [10, 30, 75, 240]
            .map(|frames| {
                let mut walk = standing(hills);
                walk.left_secs = 0.0;
                // A quarter of a step more, so that rounding decides nothing.
                walk.advance(STEP_SECS * 0.25, &AHEAD, hills);
                for _ in 0..frames {
                    walk.advance(2.0 / f64::from(frames), &AHEAD, hills);
                }
                walk.feet
            })
            .to_vec();
        assert!(ends.iter().all(|feet| *feet == ends[0]), "{ends:?}");
    }

    #[test]
    fn one_walks_at_the_pace_and_slower_uphill() {
        let flat = |_: DVec3| RADIUS_M;
        let uphill = |dir: DVec3| RADIUS_M + 0.5 * dir.y * RADIUS_M;
        let mut on = [standing(flat), standing(uphill)];
        for _ in 0..240 {
            on[0].advance(1.0 / 60.0, &AHEAD, flat);
            on[1].advance(1.0 / 60.0, &AHEAD, uphill);
        }
        let (level_m, up_m) = (gone_m(&on[0]), gone_m(&on[1]));
        assert!((9.0..10.0).contains(&level_m), "{level_m}");
        assert!(up_m < 0.3 * level_m && up_m > 0.5, "{up_m}");
    }

    #[test]
    fn feet_follow_the_ground_downhill_and_come_to_rest() {
        let downhill = |dir: DVec3| RADIUS_M - 0.7 * dir.y * RADIUS_M;
        let mut walk = standing(downhill);
        for _ in 0..120 {
            walk.advance(1.0 / 60.0, &Controls { fast: true, ..AHEAD }, downhill);
            assert!(walk.is_standing());
            assert!((walk.feet.radius_m - downhill(walk.feet.up)).abs() < 1e-6);
        }
        let frames = (0..600).take_while(|_| walk.advance(1.0 / 60.0, &Controls::default(), downhill)).count();
        assert!(frames < 120, "comes to rest after {frames} frames");
    }

    #[test]
    fn a_jump_is_as_high_as_it_should_be_and_a_fall_takes_its_time() {
        let flat = |_: DVec3| RADIUS_M;
        let mut walk = standing(flat);
        let mut highest_m = 0.0_f64;
        for frame in 0..120 {
            walk.advance(1.0 / 60.0, &Controls { jump: frame == 0, ..Controls::default() }, flat);
            highest_m = highest_m.max(walk.feet.radius_m - RADIUS_M);
        }
        assert!((highest_m - JUMP_M).abs() < 0.05, "{highest_m}");
        assert!(walk.is_standing());

        let attitude = walk.attitude;
        let mut falling = Walk::from_pose(&Pose::new(DVec3::X * (RADIUS_M + EYE_M + 20.0), &attitude));
        let frames = (0..600).take_while(|_| falling.advance(1.0 / 60.0, &Controls::default(), flat)).count();
        let expected = (2.0 * 20.0 / GRAVITY_M_S2).sqrt() * 60.0;
        assert!((frames as f64 - expected).abs() < 4.0, "{frames} frames, {expected} expected");
    }
}
