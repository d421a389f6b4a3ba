//! A flight from one pose to another along a great circle: up, across and down again.
//!
//! Height and distance follow van Wijk and Nuij, Smooth and Efficient Zooming and Panning (2003): the ground passes
//! through the picture at an even speed, at every distance and height.

use super::Ground;
use crate::lod::pose::Pose;
use glam::{DQuat, DVec3};

/// ρ of the paper: the balance between climbing and moving across. The authors found 1.4 in a user study.
const RHO: f64 = 1.4;
/// Duration of a flight of length 0, and the time for each unit of its length.
const SHORTEST_SECS: f64 = 1.0;
const SECS_PER_UNIT: f64 = 0.12;
/// Greatest duration of a flight.
const LONGEST_SECS: f64 = 4.0;
/// Least height at the ends of a path: the path depends on the ratio of the heights.
const LEAST_HEIGHT_M: f64 = 0.5;

/// A flight under way.
#[derive(Clone, Copy, Debug)]
pub struct Flight {
    from: Pose,
    to: Pose,
    /// Axis of the great circle between the two locations.
    axis: DVec3,
    angle_rad: f64,
    /// Distance of the ground from the centre at both ends; heights count from there.
    base_m: [f64; 2],
    path: ZoomPath,
    elapsed_secs: f64,
    duration_secs: f64,
}

impl Flight {
    /// A flight from one pose to another. `base_m`: distance of the ground below them from the planet's centre.
    pub fn new(from: Pose, to: Pose, base_m: [f64; 2]) -> Self {
        let (axis, angle_rad) = DQuat::from_rotation_arc(from.up(), to.up()).to_axis_angle();
        let height_m = |pose: &Pose, base_m: f64| (pose.position_planet_m.length() - base_m).max(LEAST_HEIGHT_M);
        let path = ZoomPath::new(height_m(&from, base_m[0]), height_m(&to, base_m[1]), angle_rad * base_m[0]);
        let duration_secs = (SHORTEST_SECS + SECS_PER_UNIT * path.length).min(LONGEST_SECS);
        Self { from, to, axis, angle_rad, base_m, path, elapsed_secs: 0.0, duration_secs }
    }

    /// Advances by a time. Gives whether the flight is still under way.
    pub fn advance(&mut self, duration_secs: f64) -> bool {
        self.elapsed_secs += duration_secs;
        self.elapsed_secs < self.duration_secs
    }

    /// The pose now, at least `clearance_m` above the ground.
    pub fn pose(&self, ground: &dyn Ground, clearance_m: f64) -> Pose {
        let x = (self.elapsed_secs / self.duration_secs).clamp(0.0, 1.0);
        if x >= 1.0 {
            return self.to;
        }
        // Starts and ends at rest and without acceleration (Perlin's smootherstep).
        let eased = x * x * x * (x * (6.0 * x - 15.0) + 10.0);
        let (share, height_m) = self.path.at(eased);
        let along = DQuat::from_axis_angle(self.axis, self.angle_rad * share);
        let up = (along * self.from.up()).normalize();
        let base_m = self.base_m[0] + (self.base_m[1] - self.base_m[0]) * share;
        let radius_m = (base_m + height_m).max(ground.floor_radius_m(up) + clearance_m);
        // The view turns from one attitude to the other while both are carried along the great circle.
        let whole = DQuat::from_axis_angle(self.axis, self.angle_rad);
        let turned = self.from.planet_from_view.slerp(whole.inverse() * self.to.planet_from_view, eased);
        Pose { position_planet_m: up * radius_m, planet_from_view: (along * turned).normalize() }
    }
}

/// The optimal path in the plane of distance and height.
#[derive(Clone, Copy, Debug)]
struct ZoomPath {
    from_height_m: f64,
    to_height_m: f64,
    way_m: f64,
    /// The parameter at the start; r0 of the paper.
    start: f64,
    /// Length of the path in the metric of the paper, where distances count in heights; S of the paper.
    length: f64,
}

impl ZoomPath {
    fn new(from_height_m: f64, to_height_m: f64, way_m: f64) -> Self {
        let (w0, w1, u1) = (from_height_m, to_height_m, way_m);
        let straight = u1 < 1e-6 * w0.min(w1);
        let r = |w: f64, sign: f64| {
            let b = (w1 * w1 - w0 * w0 + sign * RHO.powi(4) * u1 * u1) / (2.0 * w * RHO * RHO * u1);
            -libm::asinh(b)
        };
        let (start, length) = if straight {
            (0.0, libm::log(w1 / w0).abs() / RHO)
        } else {
            (r(w0, 1.0), (r(w1, -1.0) - r(w0, 1.0)) / RHO)
        };
        Self { from_height_m, to_height_m, way_m: if straight { 0.0 } else { u1 }, start, length }
    }

    /// Share of the distance, and height, at a share of the path's length.
    fn at(&self, share: f64) -> (f64, f64) {
        if self.way_m <= 0.0 {
            return (share, self.from_height_m * libm::pow(self.to_height_m / self.from_height_m, share));
        }
        let r = self.start + RHO * self.length * share;
        let height_m = self.from_height_m * libm::cosh(self.start) / libm::cosh(r);
        let way_m =
            self.from_height_m / (RHO * RHO) * (libm::cosh(self.start) * libm::tanh(r) - libm::sinh(self.start));
        ((way_m / self.way_m).clamp(0.0, 1.0), height_m)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_starts_and_ends_where_it_should_and_climbs_for_long_ways() {
        for (w0, w1, u1) in [(2.0, 2.0, 1e7), (1e7, 3e6, 2e6), (100.0, 1e7, 0.0), (2.0, 5e6, 1e7), (50.0, 40.0, 10.0)] {
            let path = ZoomPath::new(w0, w1, u1);
            let ((u_start, w_start), (u_end, w_end)) = (path.at(0.0), path.at(1.0));
            assert!(u_start.abs() < 1e-6 && (w_start / w0 - 1.0).abs() < 1e-6, "{w0} {w1} {u1}");
            assert!((u_end - 1.0).abs() < 1e-6 && (w_end / w1 - 1.0).abs() < 1e-4, "{w0} {w1} {u1}: {u_end} {w_end}");
            assert!(path.length >= 0.0);
        }
        assert!(ZoomPath::new(2.0, 2.0, 1e7).at(0.5).1 > 1e6);
        assert!(ZoomPath::new(1e7, 1e7, 1e3).at(0.5).1 < 1.01e7);
    }
}
