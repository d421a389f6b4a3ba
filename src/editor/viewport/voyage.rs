//! A flight from over one body of a system to over another, without a cut: up from the first, across, down to the
//! second. Pure mathematics.
//!
//! The way is a cubic Bézier curve that leaves and reaches the bodies along the vertical and bends to a side, so that
//! it goes around them. The eye moves along it by equal shares of its distance to the nearest surface: near the ground
//! by metres, between planets by millions of kilometres.

use crate::lod::pose::Pose;
use glam::{DQuat, DVec3};

/// Length of the handles at the ends of the curve: a share of the way, and at least some radii of the body. How far
/// they lean to the side, as a share of their length: a way that begins at the far side goes around the body.
const HANDLE: f64 = 1.0 / 6.0;
const HANDLE_RADII: f64 = 2.0;
const LEAN: f64 = 1.2;
/// The way keeps this distance from the centre of a body, in radii, but for its ends.
const CLEAR_RADII: f64 = 1.25;
/// Share of the curve at each end within which it comes down to the body.
const DESCENT: f64 = 0.05;
/// Least distance to a surface, metres.
const LEAST_M: f64 = 2.0;
/// Step of the curve's table, in distances to the nearest surface.
const STEP: f64 = 0.04;
/// Most steps of the table: a way from a pebble to the next star takes a thousand.
const MOST_STEPS: usize = 20_000;
/// Duration: the least, what each unit of the way adds, and the greatest.
const SHORTEST_SECS: f64 = 2.5;
const SECS_PER_UNIT: f64 = 0.17;
const LONGEST_SECS: f64 = 9.0;
/// Shares of the flight in which the view turns to the goal, and from there to the attitude at the end.
const TURN: f64 = 0.35;

/// A body that the way keeps clear of, in the frame of the first body.
#[derive(Clone, Copy, Debug)]
pub struct Obstacle {
    /// Its centre, metres.
    pub center_m: DVec3,
    /// Its radius, metres.
    pub radius_m: f64,
}

/// The second body as the first one sees it.
#[derive(Clone, Copy, Debug)]
pub struct Relative {
    /// Its centre in the frame of the first, metres.
    pub center_m: DVec3,
    /// Turns its frame into that of the first.
    pub turn: DQuat,
}

/// An end of a flight.
#[derive(Clone, Copy, Debug)]
pub struct End {
    /// The number of the body in its system.
    pub body: usize,
    /// The pose in the body's frame.
    pub pose: Pose,
    /// Distance of the ground below it from the body's centre.
    pub ground_m: f64,
}

/// The curve after equal steps of the way.
#[derive(Clone, Copy, Debug)]
struct Step {
    /// Share of the curve.
    share: f64,
    /// Turns the direction to the goal at the begin into that here, without a roll on the way.
    carried: DQuat,
}

/// A flight under way.
#[derive(Clone, Debug)]
pub struct Voyage {
    from: End,
    to: End,
    table: Vec<Step>,
    elapsed_secs: f64,
    duration_secs: f64,
}

impl Voyage {
    /// A flight between two ends. `relative`: the second body; `others`: further bodies on the way.
    pub fn new(from: End, to: End, relative: &Relative, others: &[Obstacle]) -> Self {
        let mut voyage = Self { from, to, table: Vec::new(), elapsed_secs: 0.0, duration_secs: 0.0 };
        voyage.table = voyage.walk(relative, others);
        let units = voyage.table.len() as f64 * STEP;
        voyage.duration_secs = (SHORTEST_SECS + SECS_PER_UNIT * units).min(LONGEST_SECS);
        voyage
    }

    /// The bodies of its two ends.
    pub fn bodies(&self) -> [usize; 2] {
        [self.from.body, self.to.body]
    }

    /// Advances by a time.
    pub fn advance(&mut self, secs: f64) {
        self.elapsed_secs = (self.elapsed_secs + secs).min(self.duration_secs);
    }

    /// Goes to the end at once.
    pub fn skip(&mut self) {
        self.elapsed_secs = self.duration_secs;
    }

    /// Whether it has arrived.
    pub fn is_over(&self) -> bool {
        self.elapsed_secs >= self.duration_secs
    }

    /// Whether the eye is nearer to the second body than to the first, in radii: then the second one is the world that
    /// is drawn, and the first one is in its sky.
    ///
    /// `pose`: that of now, in the frame of the first body.
    pub fn is_nearer_to_goal(&self, pose: &Pose, relative: &Relative) -> bool {
        let eye_m = pose.position_planet_m;
        let radii_away = |center_m: DVec3, end: &End| eye_m.distance(center_m) / end.ground_m;
        self.is_over() || radii_away(relative.center_m, &self.to) < radii_away(DVec3::ZERO, &self.from)
    }

    /// The pose now, in the frame of the first body.
    pub fn pose(&self, relative: &Relative, others: &[Obstacle]) -> Pose {
        let x = (self.elapsed_secs / self.duration_secs).clamp(0.0, 1.0);
        let end = relative.seen(&self.to.pose);
        if x <= 0.0 || x >= 1.0 {
            return if x <= 0.0 { self.from.pose } else { end };
        }
        let eased = smootherstep(x);
        let curve = self.curve(relative);
        let Step { share, carried } = self.step(eased);
        let eye_m = curve.at(share, self, relative, others);
        let facing = |attitude: DQuat, goal: DVec3| DQuat::from_rotation_arc(attitude * DVec3::NEG_Z, goal) * attitude;
        let goal = |eye_m: DVec3| (relative.center_m - eye_m).normalize_or(DVec3::NEG_Z);
        // Both turns go between fixed attitudes, which are carried along the way: targets that move could pass the far
        // side of a turn, where it changes its direction.
        let begin = self.from.pose.planet_from_view;
        let first = facing(begin, goal(self.from.pose.position_planet_m));
        let last = self.step(1.0).carried;
        let turned_in = smootherstep((eased / TURN).min(1.0));
        let turned_out = smootherstep(((eased - 1.0 + TURN) / TURN).max(0.0));
        let turned = if turned_out > 0.0 {
            carried * last.inverse() * (last * first).slerp(end.planet_from_view, turned_out)
        } else {
            carried * begin.slerp(first, turned_in)
        };
        // The bodies move meanwhile.
        let moved = DQuat::from_rotation_arc(carried * first * DVec3::NEG_Z, goal(eye_m));
        let moved = DQuat::IDENTITY.slerp(moved, turned_in * (1.0 - turned_out));
        Pose { position_planet_m: eye_m, planet_from_view: (moved * turned).normalize() }
    }

    /// The curve at a share of the way.
    fn step(&self, way: f64) -> Step {
        let at = way * (self.table.len() - 1) as f64;
        let index = (at as usize).min(self.table.len().saturating_sub(2));
        let [before, after] = [index, index + 1].map(|i| self.table[i.min(self.table.len() - 1)]);
        let part = (at - index as f64).clamp(0.0, 1.0);
        Step {
            share: before.share + (after.share - before.share) * part,
            carried: before.carried.slerp(after.carried, part),
        }
    }

    fn curve(&self, relative: &Relative) -> Curve {
        let [a, d] = [self.from.pose.position_planet_m, relative.seen(&self.to.pose).position_planet_m];
        let way_m = d - a;
        let line = way_m.normalize_or(DVec3::X);
        let across = |dir: DVec3| dir - line * dir.dot(line);
        // To the side on which the eye stands already, or else to its right.
        let (up, right) = (across(self.from.pose.up()), across(self.from.pose.planet_from_view * DVec3::X));
        let side = if up.length() > 0.2 { up } else { right }.normalize_or(line.any_orthonormal_vector());
        let handle_m =
            |end: &End, up: DVec3| (up + side * LEAN) * (HANDLE * way_m.length()).max(HANDLE_RADII * end.ground_m);
        let b = a + handle_m(&self.from, self.from.pose.up());
        let c = d + handle_m(&self.to, relative.turn * self.to.pose.up());
        Curve { points: [a, b, c, d] }
    }

    /// The curve after equal steps, each a share of the distance to the nearest surface then.
    fn walk(&self, relative: &Relative, others: &[Obstacle]) -> Vec<Step> {
        let curve = self.curve(relative);
        let away_m = |eye_m: DVec3| {
            let ends = [(DVec3::ZERO, self.from.ground_m), (relative.center_m, self.to.ground_m)];
            let others = others.iter().map(|other| (other.center_m, other.radius_m));
            let away = ends.into_iter().chain(others).map(|(center_m, radius_m)| eye_m.distance(center_m) - radius_m);
            away.fold(f64::INFINITY, f64::min).max(LEAST_M)
        };
        let at = |share: f64| curve.at(share, self, relative, others);
        let goal = |eye_m: DVec3| (relative.center_m - eye_m).normalize_or(DVec3::NEG_Z);
        let (mut share, mut eye_m, mut carried) = (0.0, at(0.0), DQuat::IDENTITY);
        let mut table = vec![Step { share, carried }];
        while share < 1.0 && table.len() < MOST_STEPS {
            let most_m = STEP * away_m(eye_m);
            let mut step = most_m / curve.speed_m(share).max(1e-9);
            // Around a body the eye moves faster than the curve.
            while step > f64::EPSILON && at((share + step).min(1.0)).distance(eye_m) > 1.5 * most_m {
                step *= 0.5;
            }
            share = (share + step).min(1.0);
            let next_m = at(share);
            carried = (DQuat::from_rotation_arc(goal(eye_m), goal(next_m)) * carried).normalize();
            eye_m = next_m;
            table.push(Step { share, carried });
        }
        if let Some(last) = table.last_mut() {
            last.share = 1.0;
        }
        table
    }
}

impl Relative {
    /// A pose in the frame of the second body, seen from the first.
    pub fn seen(&self, pose: &Pose) -> Pose {
        Pose {
            position_planet_m: self.center_m + self.turn * pose.position_planet_m,
            planet_from_view: (self.turn * pose.planet_from_view).normalize(),
        }
    }

    /// A pose in the frame of the first body, seen from the second.
    pub fn from_second(&self, pose: &Pose) -> Pose {
        let back = self.turn.inverse();
        Pose {
            position_planet_m: back * (pose.position_planet_m - self.center_m),
            planet_from_view: (back * pose.planet_from_view).normalize(),
        }
    }
}

/// A cubic Bézier curve in the frame of the first body.
struct Curve {
    points: [DVec3; 4],
}

impl Curve {
    /// The place at a share of the curve, clear of all bodies.
    fn at(&self, share: f64, voyage: &Voyage, relative: &Relative, others: &[Obstacle]) -> DVec3 {
        let [a, b, c, d] = self.points;
        let (q, p) = (share, 1.0 - share);
        // Relative to the nearer end, where a millimetre counts.
        let mut eye_m = if q < 0.5 {
            a + (b - a) * (3.0 * p * p * q) + (c - a) * (3.0 * p * q * q) + (d - a) * (q * q * q)
        } else {
            d + (c - d) * (3.0 * p * q * q) + (b - d) * (3.0 * p * p * q) + (a - d) * (p * p * p)
        };
        for other in others {
            eye_m = pushed_out(eye_m, other.center_m, CLEAR_RADII * other.radius_m);
        }
        let clear_m = |end: &End, share: f64| {
            let end_m = end.pose.position_planet_m.length();
            end_m + (CLEAR_RADII * end.ground_m - end_m).max(0.0) * smootherstep((share / DESCENT).min(1.0))
        };
        eye_m = pushed_out(eye_m, DVec3::ZERO, clear_m(&voyage.from, q));
        pushed_out(eye_m, relative.center_m, clear_m(&voyage.to, p))
    }

    /// Metres for each unit of the share.
    fn speed_m(&self, share: f64) -> f64 {
        let [a, b, c, d] = self.points;
        let (q, p) = (share, 1.0 - share);
        (3.0 * ((b - a) * (p * p) + (c - b) * (2.0 * p * q) + (d - c) * (q * q))).length()
    }
}

/// A place moved away from a centre to at least a distance.
fn pushed_out(place_m: DVec3, center_m: DVec3, least_m: f64) -> DVec3 {
    let away_m = place_m - center_m;
    if away_m.length_squared() >= least_m * least_m {
        return place_m;
    }
    center_m + away_m.normalize_or(DVec3::X) * least_m
}

/// Begins and ends at rest and without acceleration (Perlin 2002, Improving Noise).
fn smootherstep(x: f64) -> f64 {
    x * x * x * (x * (6.0 * x - 15.0) + 10.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::lod::pose::Attitude;
    use crate::sphere::LatLon;

    const RADII_M: [f64; 2] = [6.371e6, 1.737e6];

    fn end(body: usize, lat_deg: f64, lon_deg: f64, height_m: f64, pitch_rad: f64) -> End {
        let up = LatLon::from_degrees(lat_deg, lon_deg).direction();
        let attitude = Attitude { ahead: up.any_orthonormal_vector(), pitch_rad, roll_rad: 0.0 };
        End { body, pose: Pose::new(up * (RADII_M[body] + height_m), &attitude), ground_m: RADII_M[body] }
    }

    fn relative(way_m: f64) -> Relative {
        Relative { center_m: DVec3::new(way_m, 0.1 * way_m, 0.05 * way_m), turn: DQuat::from_rotation_z(0.7) }
    }

    /// From the near side, the far side, a pole and the middle of the far side; to the next moon and to another planet.
    fn voyages() -> Vec<(Voyage, Relative)> {
        let mut voyages = Vec::new();
        for way_m in [2.5e7, 3.8e8, 1.5e11] {
            for (lat_deg, lon_deg) in [(10.0, 5.0), (-20.0, 170.0), (89.0, 0.0), (-2.84, -174.29)] {
                for height_m in [2.0, 1.2e7] {
                    let (from, to) = (end(0, lat_deg, lon_deg, height_m, -0.2), end(1, 20.0, 60.0, 3.3e6, -1.5));
                    let relative = relative(way_m);
                    voyages.push((Voyage::new(from, to, &relative, &[]), relative));
                }
            }
        }
        voyages
    }

    #[test]
    fn it_begins_and_ends_where_it_should_within_seconds() {
        for (mut voyage, relative) in voyages() {
            let (begin, end) = (voyage.from.pose, voyage.to.pose);
            assert_eq!(voyage.pose(&relative, &[]), begin);
            assert!((SHORTEST_SECS..=LONGEST_SECS).contains(&voyage.duration_secs), "{}", voyage.duration_secs);
            assert!(voyage.table.len() < MOST_STEPS);
            voyage.skip();
            let seen = voyage.pose(&relative, &[]);
            let arrived = relative.from_second(&seen);
            let off_m = arrived.position_planet_m.distance(end.position_planet_m);
            assert!(off_m < 1e-15 * relative.center_m.length() * 10.0 + 1e-6, "{off_m}");
            assert!(arrived.planet_from_view.angle_between(end.planet_from_view) < 1e-7);
            assert!(voyage.is_over() && voyage.is_nearer_to_goal(&seen, &relative));
        }
    }

    /// At 60 frames a second no frame moves the eye by more than a third of its distance to the nearest surface, nor
    /// turns it by more than a tenth of the picture's height, and the eye is never below the ground.
    #[test]
    fn it_moves_evenly_and_keeps_clear_of_the_ground() {
        let picture_rad = crate::lod::Camera::DEFAULT_FOV_Y_RAD;
        for (mut voyage, relative) in voyages() {
            let mut before = voyage.pose(&relative, &[]);
            let mut handed_over = 0;
            let mut was_nearer = voyage.is_nearer_to_goal(&before, &relative);
            while !voyage.is_over() {
                voyage.advance(1.0 / 60.0);
                let now = voyage.pose(&relative, &[]);
                let eye_m = now.position_planet_m;
                let heights_m = [eye_m.length() - RADII_M[0], eye_m.distance(relative.center_m) - RADII_M[1]];
                let least_m = heights_m[0].min(heights_m[1]);
                assert!(least_m > 1.99, "{heights_m:?} at {}", voyage.elapsed_secs);
                let moved = eye_m.distance(before.position_planet_m) / least_m.max(LEAST_M);
                assert!(moved < 0.34, "{moved} at {} of {}", voyage.elapsed_secs, voyage.duration_secs);
                let turned_rad = now.planet_from_view.angle_between(before.planet_from_view);
                assert!(turned_rad < 0.1 * picture_rad, "{turned_rad} at {}", voyage.elapsed_secs);
                let is_nearer = voyage.is_nearer_to_goal(&now, &relative);
                handed_over += usize::from(is_nearer != was_nearer);
                (before, was_nearer) = (now, is_nearer);
            }
            assert_eq!(handed_over, 1, "the worlds change places once");
        }
    }

    #[test]
    fn a_body_in_the_middle_is_flown_around() {
        let relative = relative(3.8e8);
        let giant = Obstacle { center_m: 0.5 * relative.center_m, radius_m: 6e7 };
        let mut voyage = Voyage::new(end(0, 0.0, 0.0, 1e6, 0.0), end(1, 0.0, 180.0, 1e6, 0.0), &relative, &[giant]);
        while !voyage.is_over() {
            voyage.advance(1.0 / 60.0);
            let eye_m = voyage.pose(&relative, &[giant]).position_planet_m;
            assert!(eye_m.distance(giant.center_m) > 1.2 * giant.radius_m);
        }
    }
}
