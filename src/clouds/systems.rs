//! Cyclones that are alive at a time: comma-shaped ones of middle latitudes, and tropical ones with an eye.
//!
//! Each slot holds one system after the other; seed, slot and generation say where a system is born and how large it
//! is. Systems grow and die smoothly, so that nothing jumps.

use crate::sphere::LatLon;
use crate::sphere::geo::east_north;
use crate::world::noise::{hash, unit};
use glam::{DVec2, DVec3};
use std::f64::consts::{PI, TAU};

/// Share of each kind in the slots of a hemisphere.
const KINDS: [f64; 2] = [0.75, 0.25];
/// Life in days. A depression of middle latitudes lives for about five days, a hurricane for about nine.
const LIFE_DAYS: [f64; 2] = [5.0, 9.0];
/// Latitudes of birth in degrees: storm tracks, and warm seas off the equator.
const LATITUDES_DEG: [[f64; 2]; 2] = [[36.0, 60.0], [9.0, 22.0]];
/// Radii as angles, for weather systems of the Earth's scale.
const RADII_RAD: [[f64; 2]; 2] = [[0.13, 0.26], [0.06, 0.1]];
/// Drift to the east and towards the pole, radians a day, relative to the wind that carries all clouds.
const DRIFT_RAD: [[f64; 2]; 2] = [[0.05, 0.03], [-0.08, 0.02]];
/// The least and the greatest radius.
const RADIUS_LIMITS_RAD: [f64; 2] = [0.03, 0.5];
/// Reach of a system in radii.
const REACH: f64 = 1.5;
/// Angle by which the middle of a system is wound up.
const WINDING_RAD: [f64; 2] = [2.6, 5.0];
/// Direction of the tail of a comma, from the east counterclockwise: a cold front trails towards the equator.
const TAIL_RAD: f64 = -1.8;

/// A cyclone.
#[derive(Clone, Debug)]
pub(super) struct System {
    center: DVec3,
    /// Axes of its own frame: along its drift, and towards its pole.
    ahead: DVec3,
    poleward: DVec3,
    radius_rad: f64,
    /// 0 to 1.
    strength: f64,
    tropical: bool,
}

/// The effect of systems at a direction. Effects of several systems add up, in any order.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Effect {
    /// From the direction to the one whose noise is here.
    pub(super) moved: DVec3,
    /// Added to the noise, in its standard deviations.
    pub(super) extra: f64,
    /// Share of layered cloud, 0 to 1.
    pub(super) layered: f64,
}

/// What decides the systems of a planet.
#[derive(Clone, Copy, Debug)]
pub(super) struct Climate {
    pub(super) seed: u32,
    /// Radii by those of the Earth's systems.
    pub(super) scale: f64,
    /// 0 to 1.
    pub(super) strength: f64,
    /// Slots of both hemispheres.
    pub(super) cyclones: u32,
    /// Whether the planet turns to the west.
    pub(super) westward: bool,
}

impl Climate {
    /// Slots of a kind on each hemisphere.
    fn slots(&self, kind: usize) -> u32 {
        (f64::from(self.cyclones) * 0.5 * KINDS[kind]).round() as u32
    }
}

/// The systems that are alive `days` after time zero.
pub(super) fn alive(climate: &Climate, days: f64) -> Vec<System> {
    let kinds = (0..2).flat_map(|kind| (0..2 * climate.slots(kind)).map(move |slot| (kind, slot)));
    kinds.filter_map(|(kind, slot)| system(climate, kind, slot, days)).collect()
}

fn system(climate: &Climate, kind: usize, slot: u32, days: f64) -> Option<System> {
    let slot_hash = hash(hash(climate.seed, 0x5107 + kind as u32), slot);
    // Lives of neighbouring slots end at different times.
    let age = days / LIFE_DAYS[kind] + unit(slot_hash);
    let generation = age.floor();
    let age = age - generation;
    let strength = climate.strength * libm::sin(PI * age).powi(2);
    if strength < 0.01 {
        return None;
    }
    let born = hash(slot_hash, generation as i64 as u32);
    let roll = |k: u32| unit(hash(born, k));
    let between = |[low, high]: [f64; 2], k: u32| low + (high - low) * roll(k);
    let side = if slot.is_multiple_of(2) { 1.0 } else { -1.0 };
    let east = if climate.westward { -1.0 } else { 1.0 };
    let drifted = (age - 0.5) * LIFE_DAYS[kind];
    let [along, poleward] = DRIFT_RAD[kind].map(|drift| drift * drifted);
    let lat_rad = side * (between(LATITUDES_DEG[kind], 1).to_radians() + poleward);
    // Slots are spread over the longitudes, so that systems seldom meet.
    let lon_rad = (f64::from(slot / 2) + 0.8 * roll(2)) / f64::from(climate.slots(kind)) * TAU + east * along;
    let center = LatLon { lat_rad, lon_rad }.direction();
    let (to_east, to_north) = east_north(center);
    let [least, most] = RADIUS_LIMITS_RAD;
    Some(System {
        center,
        ahead: to_east * east,
        poleward: to_north * side,
        radius_rad: (between(RADII_RAD[kind], 3) * climate.scale).clamp(least, most),
        strength,
        tropical: kind == 1,
    })
}

impl System {
    #[cfg(feature = "render")]
    /// Whether it reaches into a cap around a direction.
    pub(super) fn reaches(&self, dir: DVec3, angle_rad: f64) -> bool {
        // `act` measures distances on the plane that touches the sphere at the center.
        let reach_rad = libm::asin((REACH * self.radius_rad).min(1.0));
        self.center.dot(dir) > libm::cos((reach_rad + angle_rad).min(PI))
    }

    /// Adds the system to the effect of others at a direction.
    pub(super) fn act(&self, dir: DVec3, effect: &mut Effect) {
        if self.center.dot(dir) <= 0.0 {
            return;
        }
        let at = DVec2::new(dir.dot(self.ahead), dir.dot(self.poleward)) / self.radius_rad;
        let r = at.length();
        if r >= REACH {
            return;
        }
        // Unwinds the spiral. In the system's own frame, cyclones turn counterclockwise on both hemispheres.
        let inside = (1.0 - r / REACH).max(0.0);
        let turn = -self.strength * WINDING_RAD[usize::from(self.tropical)] * inside * inside;
        let (s, c) = (libm::sin(turn), libm::cos(turn));
        let unwound = DVec2::new(c * at.x - s * at.y, s * at.x + c * at.y);
        let moved = (unwound - at) * self.radius_rad;
        effect.moved += self.ahead * moved.x + self.poleward * moved.y;
        let rim = inside * inside * (3.0 - 2.0 * inside);
        let extra = if self.tropical { hurricane(r, unwound) } else { comma(r, unwound) };
        effect.extra += self.strength * extra * rim.min(0.5) * 2.0;
        effect.layered = effect.layered.max(self.strength * rim);
    }
}

fn bell(x: f64) -> f64 {
    libm::exp(-x * x)
}

/// The angle between a place and a direction, -pi to pi.
fn angle_from(at: DVec2, direction_rad: f64) -> f64 {
    let angle = libm::atan2(at.y, at.x) - direction_rad;
    angle - TAU * (angle / TAU).round()
}

/// A head of layered cloud, a narrow cold front as its tail, dry air behind the front.
fn comma(r: f64, unwound: DVec2) -> f64 {
    let off = angle_from(unwound, TAIL_RAD) * r;
    let width = 0.09 + 0.3 * (1.0 - r).max(0.0).powi(2);
    let front = 2.0 * bell(off / width);
    let head = 1.6 * bell(r / 0.24);
    // Dry air follows the front, and winds into the middle.
    let dry = 1.5 * bell((off + 0.33) / 0.22) * (r / 0.25).min(1.0);
    front + head - dry
}

/// A dense disc with an eye, and two arms.
fn hurricane(r: f64, unwound: DVec2) -> f64 {
    let disc = 3.2 * bell(r / 0.42);
    let eye = 7.0 * bell(r / 0.085);
    let arm = bell(angle_from(unwound, 0.0) / 0.7) + bell(angle_from(unwound, PI) / 0.7);
    disc - eye + (2.0 * arm - 0.7) * (r / 0.4).min(1.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    const EARTH: Climate = Climate { seed: 4, scale: 1.0, strength: 1.0, cyclones: 24, westward: false };

    /// A trail of cloud that starts on the equator side of a cyclone is wound up counterclockwise in the north,
    /// clockwise in the south; the other way round on a planet that turns to the west.
    #[test]
    fn cyclones_turn_the_right_way() {
        for (westward, expected) in [(false, 1.0), (true, -1.0)] {
            let systems = alive(&Climate { westward, ..EARTH }, 0.3);
            assert!(systems.len() > 8, "{}", systems.len());
            for system in systems.iter().filter(|system| system.strength > 0.3) {
                let (east, north) = east_north(system.center);
                let near = (system.center + east * (0.3 * system.radius_rad)).normalize();
                let mut effect = Effect::default();
                system.act(near, &mut effect);
                // What is here came from the place before the turn: clockwise from here if it turned counterclockwise.
                let came_from_north = effect.moved.dot(north);
                let hemisphere = system.center.z.signum();
                assert!(came_from_north * hemisphere * expected < -1e-4, "{came_from_north} {}", system.center);
            }
        }
    }

    #[test]
    fn systems_live_and_die_without_jumps() {
        let strengths = |days: f64| -> f64 { alive(&EARTH, days).iter().map(|system| system.strength).sum() };
        let mut seen = Vec::new();
        for hour in 0..480 {
            let (now, next) = (strengths(f64::from(hour) / 24.0), strengths(f64::from(hour + 1) / 24.0));
            assert!((now - next).abs() < 0.5, "hour {hour}: {now} {next}");
            seen.push(now);
        }
        let (least, most) = (seen.iter().fold(f64::MAX, |a, b| a.min(*b)), seen.iter().fold(0.0_f64, |a, b| a.max(*b)));
        assert!(least > 5.0 && most < 20.0, "{least} {most}");
        let centers = |days: f64| -> Vec<[u64; 3]> {
            alive(&EARTH, days).iter().map(|s| s.center.to_array().map(f64::to_bits)).collect()
        };
        assert_ne!(centers(0.0), centers(40.0), "nothing repeats");
    }

    #[test]
    fn as_many_live_as_asked() {
        for (cyclones, expected) in [(0, 0..1), (8, 5..9), (24, 17..25), (80, 60..81)] {
            let count = alive(&Climate { cyclones, ..EARTH }, 3.0).len();
            assert!(expected.contains(&count), "{count} of {cyclones}");
        }
    }

    #[test]
    fn without_strength_nothing_is_alive() {
        assert!(alive(&Climate { strength: 0.0, ..EARTH }, 3.0).is_empty());
    }
}
