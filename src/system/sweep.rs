//! How near two bodies come to each other between the ends of a step, and when.

use super::nbody::Mass;
use glam::DVec3;

/// The parts of a path are halved until they are this share of the distance that is asked for.
const FINENESS: f64 = 1e-3;
/// Most halvings of a path.
const DEPTH: u32 = 40;

/// The path of one body as seen from another during a step: a cubic curve through both ends with their velocities, by
/// its four control points. It lies within their hull.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sweep([DVec3; 4]);

impl Sweep {
    /// The path of the second body about the first. `pairs`: both bodies at the start and at the end of the step.
    pub(super) fn new(pairs: [[Mass; 2]; 2], step_secs: f64) -> Self {
        let [from, to] = pairs.map(|[a, b]| (b.position_m - a.position_m, b.velocity - a.velocity));
        let third_secs = step_secs / 3.0;
        Self([from.0, from.0 + from.1 * third_secs, to.0 - to.1 * third_secs, to.0])
    }

    /// The position at a share of the step.
    pub(super) fn at(&self, share: f64) -> DVec3 {
        let [a, b, c, d] = self.0;
        let rest = 1.0 - share;
        a * (rest * rest * rest)
            + (b * (3.0 * rest * rest) + c * (3.0 * rest * share)) * share
            + d * (share * share * share)
    }

    /// The share of the step after which the bodies are nearer than a distance for the first time; None if they never
    /// are.
    pub(super) fn first_within(&self, distance_m: f64) -> Option<f64> {
        self.first(distance_m, [0.0, 1.0], DEPTH)
    }

    fn first(&self, distance_m: f64, [from, to]: [f64; 2], depth: u32) -> Option<f64> {
        let [a, b, c, d] = self.0;
        let middle_m = a.midpoint(d);
        let reach_m = self.0.iter().map(|point| (*point - middle_m).length()).fold(0.0, f64::max);
        if middle_m.length() - reach_m >= distance_m {
            return None;
        }
        if a.length() < distance_m {
            return Some(from);
        }
        let half = 0.5 * (from + to);
        if depth == 0 || reach_m < FINENESS * distance_m {
            return (middle_m.length() < distance_m).then_some(half);
        }
        // De Casteljau's halving.
        let (ab, bc, cd) = (a.midpoint(b), b.midpoint(c), c.midpoint(d));
        let (abc, bcd) = (ab.midpoint(bc), bc.midpoint(cd));
        let on = abc.midpoint(bcd);
        let [before, after] = [Self([a, ab, abc, on]), Self([on, bcd, cd, d])];
        let first = before.first(distance_m, [from, half], depth - 1);
        first.or_else(|| after.first(distance_m, [half, to], depth - 1))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn mass(position_m: DVec3, velocity: DVec3) -> Mass {
        Mass { gravity: 0.0, position_m, velocity }
    }

    #[test]
    fn a_body_that_passes_within_a_step_is_seen() {
        // 100 km/s past a body at rest, 9000 km beside it, far away at both ends.
        let passing = |side_m: f64| {
            let (velocity, rest) = (DVec3::X * 1e5, mass(DVec3::ZERO, DVec3::ZERO));
            let at = |x_m: f64| mass(DVec3::new(x_m, side_m, 0.0), velocity);
            Sweep::new([[rest, at(-1e9)], [rest, at(3e9)]], 4e4)
        };
        let met = passing(9e6).first_within(1e7).unwrap();
        let expected = (1e9 - (1e14_f64 - 8.1e13).sqrt()) / 4e9;
        assert!((met - expected).abs() < 1e-5, "{met} {expected}");
        assert!((passing(9e6).at(met).length() - 1e7).abs() < 2e4);
        assert_eq!(passing(1.1e7).first_within(1e7), None);
        assert_eq!(passing(9e6).first_within(2e9), Some(0.0), "already at the start");
    }

    #[test]
    fn the_path_bends() {
        // A quarter of a circle: the chord comes nearer than the arc.
        let speed = std::f64::consts::FRAC_PI_2;
        let rest = mass(DVec3::ZERO, DVec3::ZERO);
        let arc = [mass(DVec3::X, DVec3::Y * speed), mass(DVec3::Y, -DVec3::X * speed)];
        let sweep = Sweep::new([[rest, arc[0]], [rest, arc[1]]], 1.0);
        assert_eq!(sweep.first_within(0.98), None);
        assert!(sweep.first_within(1.03).is_some());
        assert!((sweep.at(0.5).length() - 1.0).abs() < 0.02);
    }
}
