//! A ray against the ground and the sea: for the pointer, for cameras and for games.

use super::{Terrain, unit};
use glam::DVec3;

/// Points asked for at a time: as many as the widest registers hold, so that they cost little more than one.
const BATCH: usize = 16;
/// Most batches of a march.
const MAX_BATCHES: usize = 200;

impl Terrain {
    /// Distance in metres along a ray from `origin_planet_m` to the ground or the sea's surface, whichever comes first;
    /// `None` when it meets neither, or when it begins nowhere (infinite, NaN) or leads nowhere (zero, infinite, NaN).
    /// The direction may have any other length.
    ///
    /// Marches in steps in proportion to the height above ground, then narrows the crossing down: ridges thinner
    /// than a step can be missed.
    pub fn raycast(&self, origin_planet_m: DVec3, dir_planet: DVec3) -> Option<f64> {
        if !origin_planet_m.is_finite() || !dir_planet.is_finite() || dir_planet == DVec3::ZERO {
            return None;
        }
        let dir_planet = unit(dir_planet);
        let radius_m = self.planet().radius_m();
        let (_, highest_m) = self.height_bounds_m();
        let sea_m = self.planet().sea_level_m().unwrap_or(f64::MIN);
        let (enter_m, leave_m) =
            sphere_hits(origin_planet_m, dir_planet, radius_m + highest_m.max(sea_m).max(0.0) + 1.0)?;
        let clearances_m = |distances_m: &[f64; BATCH]| {
            let points = distances_m.map(|t| origin_planet_m + dir_planet * t);
            let heights_m = self.heights_of(points.iter().map(|p| unit(*p)).collect());
            std::array::from_fn::<f64, BATCH, _>(|i| points[i].length() - radius_m - heights_m[i].max(sea_m))
        };

        let mut t = enter_m.max(0.0);
        let mut above_m = clearances_m(&[t; BATCH])[0];
        if above_m <= 0.0 {
            return Some(t);
        }
        for _ in 0..MAX_BATCHES {
            let step_m = (above_m * 0.4).max(0.02 + t * 2e-4);
            let distances_m = std::array::from_fn(|i| t + step_m * (i + 1) as f64);
            let clearances = clearances_m(&distances_m);
            if let Some(i) = clearances.iter().position(|above_m| *above_m <= 0.0) {
                return Some(narrow(distances_m[i] - step_m, distances_m[i], clearances_m));
            }
            (t, above_m) = (distances_m[BATCH - 1], clearances[BATCH - 1]);
            if t > leave_m {
                return None;
            }
        }
        None
    }
}

/// The crossing between a distance that is above the ground and one that is below, to rounding.
fn narrow(mut above_m: f64, mut below_m: f64, clearances_m: impl Fn(&[f64; BATCH]) -> [f64; BATCH]) -> f64 {
    // Each round makes the gap a seventeenth; ten take any step of a march below a nanometre.
    for _ in 0..10 {
        let width_m = (below_m - above_m) / (BATCH + 1) as f64;
        let distances_m = std::array::from_fn(|i| above_m + width_m * (i + 1) as f64);
        let crossing = clearances_m(&distances_m).iter().position(|clearance| *clearance <= 0.0);
        let next_below_m = crossing.map_or(below_m, |i| distances_m[i]);
        above_m = crossing.map_or(distances_m[BATCH - 1], |i| if i == 0 { above_m } else { distances_m[i - 1] });
        below_m = next_below_m;
        if width_m <= below_m * 1e-13 {
            break;
        }
    }
    below_m
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
