//! A ray against the ground and the sea: for the pointer, for cameras and for games.

use super::Terrain;
use super::points::unit;
use super::query::{Scratch, with_scratch};
use glam::DVec3;

/// Points of one step of the march: as many as fill the widest registers.
const BATCH: usize = 16;
/// Most batches of a march.
const MAX_BATCHES: usize = 200;
/// Step of the march against the height above the ground.
const STEP: f64 = 0.4;
/// Rounds of narrowing at most, and the width in metres at which it ends: far below the millimetre that heights are
/// good for.
const MAX_ROUNDS: usize = 40;
const TOLERANCE_M: f64 = 1e-8;
/// Where the crossing is looked for around its estimate, in widths of the gap that it lies in.
const OFFSETS: [f64; 8] = [-0.25, -0.03, -0.003, -0.0003, 0.0003, 0.003, 0.03, 0.25];

impl Terrain {
    /// Distance in metres along a ray from `origin_planet_m` to the ground or to the sea's surface, whichever is nearer.
    /// `None` if the ray meets neither, if the origin is infinite or NaN, or if the direction is zero, infinite or NaN.
    /// The direction may have any other length. A ray that starts in the ground meets it at 0.
    ///
    /// The march takes steps in proportion to the height above the ground: it can miss a ridge thinner than a step.
    pub fn raycast(&self, origin_planet_m: DVec3, dir_planet: DVec3) -> Option<f64> {
        with_scratch(|scratch| self.raycast_with(origin_planet_m, dir_planet, scratch))
    }

    /// As [`Terrain::raycast`], with the caller's scratch.
    pub fn raycast_with(&self, origin_planet_m: DVec3, dir_planet: DVec3, scratch: &mut Scratch) -> Option<f64> {
        if !origin_planet_m.is_finite() || !dir_planet.is_finite() || dir_planet == DVec3::ZERO {
            return None;
        }
        let (origin_m, dir) = (origin_planet_m, unit(dir_planet));
        let radius_m = self.planet().radius_m();
        let sea_m = self.planet().sea_level_m().unwrap_or(f64::MIN);
        let top_m = radius_m + self.height_bounds_m().1.max(sea_m).max(0.0) + 1.0;
        let (enter_m, leave_m) = sphere_hits(origin_m, dir, top_m)?;
        let mut ray = Ray { terrain: self, origin_m, dir, radius_m, sea_m, scratch };

        let mut above = Crossing { t_m: enter_m.max(0.0), clearance_m: 0.0 };
        let [clearance_m] = ray.clearances_m([above.t_m]);
        if clearance_m <= 0.0 {
            return Some(above.t_m);
        }
        above.clearance_m = clearance_m;
        for _ in 0..MAX_BATCHES {
            let step_m = (above.clearance_m * STEP).max(0.02 + above.t_m * 2e-4);
            let distances_m: [f64; BATCH] = std::array::from_fn(|i| above.t_m + step_m * (i + 1) as f64);
            let (last, below) = ray.first_crossing(above, distances_m);
            if let Some(below) = below {
                return Some(ray.narrow(last, below));
            }
            above = last;
            if above.t_m > leave_m {
                return None;
            }
        }
        None
    }
}

/// A point of a ray.
#[derive(Clone, Copy)]
struct Crossing {
    /// Distance from the ray's origin.
    t_m: f64,
    /// Height above the ground or the sea.
    clearance_m: f64,
}

struct Ray<'a> {
    terrain: &'a Terrain,
    origin_m: DVec3,
    dir: DVec3,
    radius_m: f64,
    sea_m: f64,
    scratch: &'a mut Scratch,
}

impl Ray<'_> {
    /// Heights above the ground or the sea at distances along the ray.
    fn clearances_m<const N: usize>(&mut self, distances_m: [f64; N]) -> [f64; N] {
        let points_m = distances_m.map(|t_m| self.origin_m + self.dir * t_m);
        let mut heights_m = [0.0; N];
        self.terrain.heights_into(&points_m, &mut heights_m, self.scratch);
        std::array::from_fn(|i| points_m[i].length() - self.radius_m - heights_m[i].max(self.sea_m))
    }

    /// The last point above the ground before the ray meets it, and the point below that follows, if there is one.
    fn first_crossing<const N: usize>(
        &mut self,
        mut above: Crossing,
        distances_m: [f64; N],
    ) -> (Crossing, Option<Crossing>) {
        for (t_m, clearance_m) in distances_m.into_iter().zip(self.clearances_m(distances_m)) {
            let point = Crossing { t_m, clearance_m };
            if clearance_m <= 0.0 {
                return (above, Some(point));
            }
            above = point;
        }
        (above, None)
    }

    /// The distance of the crossing between a point above the ground and one below. The secant estimates it; points
    /// ever farther from the estimate then enclose it, however wrong the estimate is.
    fn narrow(&mut self, mut above: Crossing, mut below: Crossing) -> f64 {
        for _ in 0..MAX_ROUNDS {
            let width_m = below.t_m - above.t_m;
            if width_m <= TOLERANCE_M.max(below.t_m * 1e-15) {
                break;
            }
            let share = above.clearance_m / (above.clearance_m - below.clearance_m);
            let distances_m = OFFSETS.map(|offset| above.t_m + width_m * (share + offset).clamp(0.0, 1.0));
            let (last, first) = self.first_crossing(above, distances_m);
            (above, below) = (last, first.unwrap_or(below));
        }
        below.t_m
    }
}

/// Distances at which a ray enters and leaves a sphere around the origin, if it meets it ahead of its start.
fn sphere_hits(origin: DVec3, dir: DVec3, radius: f64) -> Option<(f64, f64)> {
    let b = origin.dot(dir);
    let discriminant = b * b - (origin.length_squared() - radius * radius);
    if discriminant < 0.0 {
        return None;
    }
    let root = discriminant.sqrt();
    (root - b > 0.0).then_some((-b - root, root - b))
}
