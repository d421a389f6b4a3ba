//! A ray against the ground and the sea: for the pointer, for cameras and for games.

use super::Terrain;
use glam::DVec3;

/// Most steps of a march.
const MAX_STEPS: usize = 400;

impl Terrain {
    /// Distance in metres along a ray from `origin_planet_m` to the ground or the sea's surface, whichever comes first;
    /// `None` when it meets neither. `dir_planet` must be a unit vector.
    ///
    /// Marches with steps in proportion to the height above ground, then bisects: ridges thinner than a step can be missed.
    pub fn raycast(&self, origin_planet_m: DVec3, dir_planet: DVec3) -> Option<f64> {
        let radius_m = self.planet().radius_m();
        let (_, highest_m) = self.height_bounds_m();
        let sea_m = self.planet().sea_level_m().unwrap_or(f64::MIN);
        let (enter_m, leave_m) =
            sphere_hits(origin_planet_m, dir_planet, radius_m + highest_m.max(sea_m).max(0.0) + 1.0)?;
        let clearance_m = |t: f64| {
            let p = origin_planet_m + dir_planet * t;
            p.length() - radius_m - self.height_m(p).max(sea_m)
        };
        let mut t = enter_m.max(0.0);
        let mut above = clearance_m(t);
        if above <= 0.0 {
            return Some(t);
        }
        for _ in 0..MAX_STEPS {
            let step = (above * 0.6).max(0.02 + t * 2e-4);
            let next = t + step;
            let next_above = clearance_m(next);
            if next_above <= 0.0 {
                let (mut lo, mut hi) = (t, next);
                for _ in 0..40 {
                    let middle = 0.5 * (lo + hi);
                    if clearance_m(middle) > 0.0 { lo = middle } else { hi = middle }
                }
                return Some(hi);
            }
            if next > leave_m {
                return None;
            }
            (t, above) = (next, next_above);
        }
        None
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
