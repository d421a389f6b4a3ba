//! The cameras, and how the pointer and the keys move them. Pure mathematics in the planet frame; no egui.
//!
//! - [`orbit`]: around the planet; [`fly`]: free flight; [`walk`]: on foot
//! - [`flight`]: an animated flight from one pose to another
//!
//! [`Cameras`] holds the camera in use. A change of the mode starts from the pose of the camera before, without a jump.
//! The eye never goes below the ground.

pub mod flight;
pub mod fly;
pub mod orbit;
pub mod walk;

use crate::lod::Camera;
use crate::lod::pose::{Attitude, Pose};
use crate::sphere::LatLon;
use flight::Flight;
use fly::Fly;
use glam::{DQuat, DVec3};
use orbit::Orbit;
use walk::Walk;

/// Greatest distance of the eye from the centre, in planet radii.
pub const MAX_RADII: f64 = 20.0;
/// Least height of the eye above the ground, for every camera.
pub const CLEARANCE_M: f64 = 0.5;
/// From a greater height above the ground the camera flies down to walk; from a lower one it falls.
const FALL_M: f64 = 60.0;
/// Time in which the difference to the camera before fades away.
const HANDOVER_SECS: f64 = 0.6;
/// Least and greatest factor that the wheel gives to the speed of free flight.
const SPEED_FACTORS: (f64, f64) = (0.02, 50.0);
/// An eye within this distance of the height of a walker is taken for a walker.
const STANDING_M: f64 = 0.2;
/// A greater roll is taken for free flight: the orbit camera has no roll.
const ROLLED_RAD: f64 = 0.02;

/// The ground below the cameras.
pub trait Ground {
    /// Radius of the reference sphere.
    fn radius_m(&self) -> f64;
    /// Distance from the centre to the ground, including the sea bed.
    fn floor_radius_m(&self, dir_planet: DVec3) -> f64;
    /// Distance from the centre to the ground or the sea, whichever is higher.
    fn surface_radius_m(&self, dir_planet: DVec3) -> f64;
    /// Distance along a ray to the ground or the sea.
    fn raycast(&self, origin_planet_m: DVec3, dir_planet: DVec3) -> Option<f64>;
}

/// The movement that the keys ask for; each number is from -1 to 1.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Controls {
    /// To the right.
    pub right: f64,
    /// Away from the ground.
    pub up: f64,
    /// Along the view.
    pub ahead: f64,
    /// Tilts the head to the right.
    pub roll: f64,
    /// Faster.
    pub fast: bool,
    /// Jumps, if there is ground to jump from.
    pub jump: bool,
}

impl Controls {
    /// Whether any key is held that moves the eye.
    pub fn is_any(&self) -> bool {
        [self.right, self.up, self.ahead, self.roll] != [0.0; 4] || self.jump
    }

    fn moves_feet(&self) -> bool {
        self.right != 0.0 || self.ahead != 0.0 || self.jump
    }
}

/// The modes of movement.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[allow(missing_docs)]
pub enum Mode {
    Orbit,
    Fly,
    Walk,
}

impl Mode {
    /// All of them.
    pub const ALL: [Mode; 3] = [Mode::Orbit, Mode::Fly, Mode::Walk];

    /// The name in menus and in the status bar.
    pub fn label(self) -> &'static str {
        match self {
            Mode::Orbit => "Orbit",
            Mode::Fly => "Fly",
            Mode::Walk => "Walk",
        }
    }
}

#[derive(Clone, Debug)]
enum Rig {
    Orbit(Orbit),
    Fly(Fly),
    Walk(Walk),
}

impl Rig {
    fn from_pose(mode: Mode, pose: &Pose, ground: &dyn Ground) -> Self {
        match mode {
            Mode::Orbit => Rig::Orbit(Orbit::from_pose(pose, ground)),
            Mode::Fly => Rig::Fly(Fly::from_pose(pose)),
            Mode::Walk => Rig::Walk(Walk::from_pose(pose)),
        }
    }

    fn pose(&self, ground: &dyn Ground) -> Pose {
        match self {
            Rig::Orbit(orbit) => orbit.pose(ground),
            Rig::Fly(fly) => fly.pose(),
            Rig::Walk(walk) => walk.pose(),
        }
    }
}

/// The difference to the pose of the camera before; it fades away.
#[derive(Clone, Copy, Debug)]
struct Handover {
    offset_planet_m: DVec3,
    turn_in_view: DQuat,
    elapsed_secs: f64,
}

/// The camera in use, and its transitions.
#[derive(Clone, Debug)]
pub struct Cameras {
    rig: Rig,
    handover: Option<Handover>,
    /// A flight, and the camera that takes over when it arrives.
    flight: Option<(Flight, Rig)>,
    dive: bool,
    /// Where something else carries the eye, such as a flight between bodies.
    carried: Option<Pose>,
}

impl Cameras {
    /// Looks at the whole planet from over a location.
    pub fn new(planet_radius_m: f64, over: LatLon) -> Self {
        let rig = Rig::Orbit(Orbit::new(planet_radius_m, over));
        Self { rig, handover: None, flight: None, dive: false, carried: None }
    }

    /// The mode of movement, or the one that follows the flight under way.
    pub fn mode(&self) -> Mode {
        match self.flight.as_ref().map_or(&self.rig, |(_, then)| then) {
            Rig::Orbit(_) => Mode::Orbit,
            Rig::Fly(_) => Mode::Fly,
            Rig::Walk(_) => Mode::Walk,
        }
    }

    /// Whether free flight and walking may go under water.
    pub fn dives(&self) -> bool {
        self.dive
    }

    /// Sets whether free flight and walking may go under water.
    pub fn set_dive(&mut self, dive: bool) {
        self.dive = dive;
    }

    /// Carries the eye to a pose, whatever the camera in use does.
    pub fn carry(&mut self, pose: Pose) {
        self.carried = Some(pose);
    }

    /// Gives the eye back to the camera in use. The difference between the two fades away.
    pub fn put_down(&mut self, ground: &dyn Ground) {
        if let Some(pose) = self.carried.take() {
            self.hand_over_from(&pose, ground);
        }
    }

    /// Whether something carries the eye.
    pub fn is_carried(&self) -> bool {
        self.carried.is_some()
    }

    /// Gives the eye back at once.
    pub fn drop_carried(&mut self) {
        self.carried = None;
    }

    /// The pose of the eye.
    pub fn pose(&self, ground: &dyn Ground) -> Pose {
        if let Some(pose) = self.carried {
            return pose;
        }
        let mut pose = match &self.flight {
            Some((flight, _)) => flight.pose(ground, CLEARANCE_M),
            None => self.rig.pose(ground),
        };
        if let Some(handover) = &self.handover {
            let left = 1.0 - smoothstep(handover.elapsed_secs / HANDOVER_SECS);
            pose.position_planet_m += handover.offset_planet_m * left;
            let turn = DQuat::IDENTITY.slerp(handover.turn_in_view, left);
            pose.planet_from_view = (pose.planet_from_view * turn).normalize();
        }
        let up = pose.up();
        let lowest_m = ground.floor_radius_m(up) + CLEARANCE_M;
        if pose.position_planet_m.length() < lowest_m {
            pose.position_planet_m = up * lowest_m;
        }
        pose
    }

    /// The camera for drawing.
    pub fn camera(&self, ground: &dyn Ground) -> Camera {
        self.pose(ground).camera(Camera::DEFAULT_FOV_Y_RAD)
    }

    /// Sets the mode of movement. From high above the ground, walking starts with a flight down; from walking, the
    /// orbit starts with a flight up.
    pub fn set_mode(&mut self, mode: Mode, ground: &dyn Ground) {
        if mode == self.mode() {
            return;
        }
        let pose = self.pose(ground);
        let up = pose.up();
        let floor_m = self.floor_m(up, ground);
        if mode == Mode::Walk && pose.position_planet_m.length() - floor_m > FALL_M {
            let attitude = Attitude { pitch_rad: 0.0, roll_rad: 0.0, ..Attitude::of(&pose) };
            let landed = Pose::new(up * (floor_m + walk::EYE_M), &attitude);
            self.fly(pose, landed, Rig::Walk(Walk::from_pose(&landed)), ground);
        } else if mode == Mode::Orbit && matches!(self.rig, Rig::Walk(_)) && self.flight.is_none() {
            let over = Rig::Orbit(Orbit::new(ground.radius_m(), LatLon::from_direction(up)));
            self.fly(pose, over.pose(ground), over, ground);
        } else {
            self.take_over(mode, &pose, ground);
        }
    }

    /// Starts a flight to a pose. The mode after it is walking if the pose is that of a walker, and free flight if the
    /// orbit camera cannot hold the pose.
    pub fn fly_to_pose(&mut self, to: Pose, ground: &dyn Ground) {
        let from = self.pose(ground);
        let attitude = Attitude::of(&to);
        let over_m = to.position_planet_m.length() - ground.surface_radius_m(to.up());
        self.dive |= over_m < 0.0;
        let standing_m = to.position_planet_m.length() - self.floor_m(to.up(), ground) - walk::EYE_M;
        let mode = match self.mode() {
            _ if attitude.roll_rad.abs() > ROLLED_RAD => Mode::Fly,
            _ if standing_m.abs() < STANDING_M => Mode::Walk,
            Mode::Orbit if over_m >= orbit::MIN_ALTITUDE_M => Mode::Orbit,
            _ => Mode::Fly,
        };
        self.fly(from, to, Rig::from_pose(mode, &to, ground), ground);
    }

    /// Starts a flight to the ground under the pointer (`x`, `y` from -1 to 1, right and up), in the same mode.
    pub fn fly_to(&mut self, x: f64, y: f64, aspect: f64, ground: &dyn Ground) {
        let from = self.pose(ground);
        let dir = from.camera(Camera::DEFAULT_FOV_Y_RAD).ray_dir_planet(x, y, aspect);
        let Some(distance_m) = ground.raycast(from.position_planet_m, dir) else { return };
        self.stop(ground);
        let hit = from.position_planet_m + dir * distance_m;
        let up = hit.normalize_or(DVec3::Z);
        let mut attitude = Attitude::of(&from);
        attitude.carry(from.up(), up);
        attitude.roll_rad = 0.0;
        let then = match &self.rig {
            Rig::Orbit(orbit) => Rig::Orbit(orbit.near(hit, ground)),
            Rig::Fly(fly) => {
                // Near the ground the eye ends twice as far from the point as it is high; from space, above the point.
                let altitude_m = from.position_planet_m.length() - ground.surface_radius_m(from.up());
                let height_m = (altitude_m * 0.25).max(fly::CLEARANCE_M);
                let back_m = 2.0 * height_m * (1.0 - smoothstep(10.0 * height_m / ground.radius_m()));
                let away = (hit - attitude.ahead * back_m).normalize_or(up);
                let eye = away * (ground.surface_radius_m(away).max(hit.length()) + height_m);
                attitude.carry(up, away);
                attitude.look_at(hit - eye, away);
                Rig::Fly(fly.moved_to(&Pose::new(eye, &attitude)))
            }
            Rig::Walk(_) => {
                let eye = up * (self.floor_m(up, ground) + walk::EYE_M);
                Rig::Walk(Walk::from_pose(&Pose::new(eye, &attitude)))
            }
        };
        self.fly(from, then.pose(ground), then, ground);
    }

    /// Whether a flight is under way.
    pub fn is_flying_to(&self) -> bool {
        self.flight.is_some()
    }

    /// Ends a flight at the current pose. A walker who has not landed goes on in free flight rather than falling.
    pub fn stop(&mut self, ground: &dyn Ground) {
        if self.flight.is_some() {
            let pose = self.pose(ground);
            let mode = self.mode();
            let high = pose.position_planet_m.length() - self.floor_m(pose.up(), ground) > FALL_M;
            self.take_over(if mode == Mode::Walk && high { Mode::Fly } else { mode }, &pose, ground);
        }
    }

    /// Scales the camera with a planet whose radius has changed.
    pub fn rescale(&mut self, from_radius_m: f64, to_radius_m: f64, ground: &dyn Ground) {
        let factor = to_radius_m / from_radius_m;
        (self.flight, self.handover) = (None, None);
        match &mut self.rig {
            Rig::Orbit(orbit) => orbit.rescale(from_radius_m, to_radius_m),
            Rig::Fly(fly) => {
                let pose = fly.pose();
                let pose = Pose { position_planet_m: pose.position_planet_m * factor, ..pose };
                *fly = fly.moved_to(&pose);
            }
            Rig::Walk(walk) => walk.rescale(factor),
        }
        self.keep_above(ground);
    }

    /// Keeps the eye above the ground and within [`MAX_RADII`]. Call it whenever the ground may have changed.
    pub fn keep_above(&mut self, ground: &dyn Ground) {
        let floor_m = |up: DVec3| if self.dive { ground.floor_radius_m(up) } else { ground.surface_radius_m(up) };
        match &mut self.rig {
            Rig::Orbit(orbit) => orbit.keep_above(ground),
            Rig::Fly(fly) => fly.keep_above(floor_m(fly.pose().up()), ground.radius_m()),
            Rig::Walk(walk) => walk.keep_above(floor_m(walk.pose().up())),
        }
    }

    /// Starts a drag at a point of the picture. The orbit camera holds the ground there.
    pub fn grab(&mut self, x: f64, y: f64, aspect: f64, ground: &dyn Ground) {
        self.settle(ground);
        if let Rig::Orbit(orbit) = &mut self.rig {
            orbit.grab(x, y, aspect, ground);
        }
    }

    /// Goes on with a drag to the point `to`; the pointer moved by `right` and `up`, in shares of the picture's height.
    pub fn drag(&mut self, to: (f64, f64), (right, up): (f64, f64), aspect: f64, ground: &dyn Ground) {
        match &mut self.rig {
            Rig::Orbit(orbit) => orbit.drag(to.0, to.1, aspect, ground),
            Rig::Fly(_) | Rig::Walk(_) => self.look(-right, -up, ground),
        }
    }

    /// Ends a drag.
    pub fn release(&mut self) {
        if let Rig::Orbit(orbit) = &mut self.rig {
            orbit.release();
        }
    }

    /// Turns the view to the right and up, in shares of the picture's height.
    pub fn look(&mut self, right: f64, up: f64, ground: &dyn Ground) {
        self.stop(ground);
        let picture_rad = Camera::DEFAULT_FOV_Y_RAD;
        let (right_rad, up_rad) = (right * picture_rad, up * picture_rad);
        match &mut self.rig {
            // Seen from straight above, the planet would hardly seem to turn without the factor.
            Rig::Orbit(orbit) => orbit.tilt(right * 1.6, up * 1.6, ground),
            Rig::Fly(fly) => {
                let up = fly.pose().up();
                fly.attitude.look(right_rad, up_rad, up);
            }
            Rig::Walk(walk) => {
                let up = walk.pose().up();
                walk.attitude.look(right_rad, up_rad, up);
            }
        }
    }

    /// The wheel: moves the orbit camera towards the point under the pointer, or changes the speed of free flight.
    pub fn zoom(&mut self, steps: f64, pointer: Option<(f64, f64)>, aspect: f64, ground: &dyn Ground) {
        self.stop(ground);
        match &mut self.rig {
            Rig::Orbit(orbit) => {
                self.handover = None;
                orbit.zoom(steps, pointer, aspect, ground);
            }
            Rig::Fly(fly) => {
                fly.speed_factor = (fly.speed_factor * libm::exp(steps)).clamp(SPEED_FACTORS.0, SPEED_FACTORS.1);
            }
            Rig::Walk(_) => {}
        }
    }

    /// The factor that the wheel has given to the speed of free flight.
    pub fn speed_factor(&self) -> f64 {
        if let Rig::Fly(fly) = &self.rig { fly.speed_factor } else { 1.0 }
    }

    /// Sets the roll of free flight to zero.
    pub fn level(&mut self, ground: &dyn Ground) {
        self.stop(ground);
        let before = self.pose(ground);
        if let Rig::Fly(fly) = &mut self.rig {
            fly.attitude.roll_rad = 0.0;
            self.hand_over_from(&before, ground);
        }
    }

    /// Advances by a time. Gives whether the camera goes on moving.
    pub fn advance(&mut self, duration_secs: f64, controls: &Controls, ground: &dyn Ground) -> bool {
        if let Some(handover) = &mut self.handover {
            handover.elapsed_secs += duration_secs;
            if handover.elapsed_secs >= HANDOVER_SECS {
                self.handover = None;
            }
        }
        if controls.is_any() {
            self.stop(ground);
        }
        if let Some((flight, then)) = &mut self.flight {
            if !flight.advance(duration_secs) {
                let then = then.clone();
                let arrived = self.pose(ground);
                self.flight = None;
                self.rig = then;
                self.keep_above(ground);
                self.hand_over_from(&arrived, ground);
            }
            return true;
        }
        let dive = self.dive;
        let floor_m = |up: DVec3| if dive { ground.floor_radius_m(up) } else { ground.surface_radius_m(up) };
        let moves = match &mut self.rig {
            Rig::Orbit(orbit) => {
                let pace = duration_secs * if controls.fast { 3.0 } else { 1.0 };
                if controls.right != 0.0 || controls.ahead != 0.0 {
                    orbit.travel(controls.right * pace, controls.ahead * pace, ground);
                }
                if controls.up != 0.0 {
                    orbit.zoom(-controls.up * pace * 1.5, None, 1.0, ground);
                }
                controls.is_any()
            }
            Rig::Fly(fly) => fly.advance(duration_secs, controls, ground.radius_m(), floor_m),
            Rig::Walk(walk) => walk.advance(duration_secs, controls, floor_m),
        };
        moves || self.handover.is_some()
    }

    fn floor_m(&self, up: DVec3, ground: &dyn Ground) -> f64 {
        if self.dive { ground.floor_radius_m(up) } else { ground.surface_radius_m(up) }
    }

    fn fly(&mut self, from: Pose, to: Pose, then: Rig, ground: &dyn Ground) {
        let base_m = [self.floor_m(from.up(), ground), self.floor_m(to.up(), ground)];
        self.handover = None;
        self.flight = Some((Flight::new(from, to, base_m), then));
    }

    /// Ends a flight and a fading difference, with the eye at its current pose.
    fn settle(&mut self, ground: &dyn Ground) {
        self.stop(ground);
        if self.handover.is_some() && self.mode() == Mode::Orbit {
            let pose = self.pose(ground);
            self.handover = None;
            self.rig = Rig::from_pose(Mode::Orbit, &pose, ground);
        }
    }

    fn take_over(&mut self, mode: Mode, from: &Pose, ground: &dyn Ground) {
        self.flight = None;
        self.rig = Rig::from_pose(mode, from, ground);
        self.keep_above(ground);
        self.hand_over_from(from, ground);
    }

    /// Starts to fade the difference between a pose and that of the camera in use.
    fn hand_over_from(&mut self, from: &Pose, ground: &dyn Ground) {
        let now = self.rig.pose(ground);
        let offset_planet_m = from.position_planet_m - now.position_planet_m;
        let turn_in_view = (now.planet_from_view.inverse() * from.planet_from_view).normalize();
        let seen = offset_planet_m.length() > 1e-6 || turn_in_view.angle_between(DQuat::IDENTITY) > 1e-6;
        self.handover = seen.then_some(Handover { offset_planet_m, turn_in_view, elapsed_secs: 0.0 });
    }
}

fn smoothstep(x: f64) -> f64 {
    let x = x.clamp(0.0, 1.0);
    x * x * (3.0 - 2.0 * x)
}

#[cfg(test)]
mod tests;
