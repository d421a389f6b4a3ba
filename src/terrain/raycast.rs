//! A ray against the ground and the sea: for the pointer, for cameras and for games.

use super::Terrain;
use super::points::unit;
use super::query::{Scratch, with_scratch};
use glam::DVec3;

/// Most points evaluated at once. Several cost less than the same number one by one: they share the registers.
const BATCH: usize = 32;
/// Most batches of a march.
const MAX_BATCHES: usize = 200;
/// Step of the march as a share of the height above the ground. A ridge between two points is missed only if its sides
/// are steeper than 4 against the ray.
const STEP: f64 = 0.5;
/// Least step, as a share of the height above the ground at the start of the batch.
const LEAST_STEP: f64 = 0.05;
/// Far above the ground of a structure the march leaves out valleys that points this share of its least step apart
/// would not show: finding rivers takes long where nothing has been drawn.
const SEEN: f64 = 0.25;
/// Steps planned beyond the point at which the ray would meet level ground.
const SPARE_STEPS: usize = 3;
/// The crossing is found to this distance: a hundredth of the millimetre that heights are good for.
const TOLERANCE_M: f64 = 1e-5;
/// Most steps of the search for the crossing; halving any step of a march this often ends below the tolerance.
const MAX_SEARCH: usize = 60;

/// What a ray meets, and how far it goes. By default it meets the ground and the sea at any distance.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct RayLimits {
    /// Metres from the origin at which the ray begins: what is nearer is not met.
    pub from_m: f64,
    /// Metres from the origin at which the ray ends; infinite for no end.
    pub to_m: f64,
    /// Whether the sea's surface stops the ray. If not, it goes on to the ground below.
    pub meets_sea: bool,
}

impl Default for RayLimits {
    fn default() -> Self {
        Self { from_m: 0.0, to_m: f64::INFINITY, meets_sea: true }
    }
}

impl RayLimits {
    /// Limits with another beginning, metres.
    pub fn from_m(mut self, from_m: f64) -> Self {
        self.from_m = from_m;
        self
    }

    /// Limits with another end, metres.
    pub fn to_m(mut self, to_m: f64) -> Self {
        self.to_m = to_m;
        self
    }

    /// Limits of a ray that passes the sea.
    pub fn through_sea(mut self) -> Self {
        self.meets_sea = false;
        self
    }
}

impl Terrain {
    /// Distance in metres along a ray from `origin_planet_m` to the ground or to the sea's surface, whichever is
    /// nearer. `None` if the ray meets neither, if the origin is infinite or NaN, or if the direction is zero, infinite
    /// or NaN. The direction may have any other length. A ray that starts in the ground meets it at 0.
    ///
    /// The march takes steps in proportion to the height above the ground: it can miss a ridge thinner than a step.
    pub fn raycast(&self, origin_planet_m: DVec3, dir_planet: DVec3) -> Option<f64> {
        with_scratch(|scratch| self.raycast_with(origin_planet_m, dir_planet, scratch))
    }

    /// As [`Terrain::raycast`], with the caller's scratch.
    pub fn raycast_with(&self, origin_planet_m: DVec3, dir_planet: DVec3, scratch: &mut Scratch) -> Option<f64> {
        self.raycast_within(origin_planet_m, dir_planet, &RayLimits::default(), scratch)
    }

    /// As [`Terrain::raycast`], within limits and with the caller's scratch. The distance counts from the origin, and
    /// lies between the limits. A ray that begins in the ground meets it there. `None` also where limits are NaN or
    /// end before they begin.
    pub fn raycast_within(
        &self,
        origin_planet_m: DVec3,
        dir_planet: DVec3,
        limits: &RayLimits,
        scratch: &mut Scratch,
    ) -> Option<f64> {
        if !origin_planet_m.is_finite() || !dir_planet.is_finite() || dir_planet == DVec3::ZERO {
            return None;
        }
        let (origin_m, dir) = (origin_planet_m, unit(dir_planet));
        let radius_m = self.planet().radius_m();
        let sea_m = self.planet().sea_level_m().filter(|_| limits.meets_sea).unwrap_or(f64::MIN);
        let top_m = radius_m + self.height_bounds_m().1.max(sea_m).max(0.0) + 1.0;
        let (enter_m, leave_m) = sphere_hits(origin_m, dir, top_m)?;
        let (start_m, end_m) = (enter_m.max(0.0).max(limits.from_m), leave_m.min(limits.to_m));
        if !(limits.from_m <= limits.to_m && start_m <= end_m) {
            return None;
        }
        let mut ray = Ray { terrain: self, origin_m, dir, radius_m, sea_m, scratch };

        let mut above = ray.point(start_m);
        if above.clearance_m <= 0.0 {
            return Some(start_m);
        }
        // Over level ground; later the mean over the last batch.
        let mut fall = -dir.dot(unit(origin_m + dir * start_m));
        for _ in 0..MAX_BATCHES {
            let (last, below) = ray.march(above, fall.max(0.0));
            if let Some(below) = below {
                return Some(ray.crossing(last, below)).filter(|away_m| *away_m <= end_m);
            }
            fall = (above.clearance_m - last.clearance_m) / (last.t_m - above.t_m);
            above = last;
            if above.t_m > end_m {
                return None;
            }
        }
        None
    }
}

/// A point of a ray.
#[derive(Clone, Copy, Default)]
struct RayPoint {
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
    /// Finds the heights of points above the ground or the sea, of the ground that points `spacing_m` apart show.
    fn find_clearances(&mut self, points: &mut [RayPoint], spacing_m: f64) {
        let (mut points_m, mut heights_m) = ([DVec3::ZERO; BATCH], [0.0; BATCH]);
        let n = points.len().min(BATCH);
        for (point_m, point) in points_m.iter_mut().zip(&*points) {
            *point_m = self.origin_m + self.dir * point.t_m;
        }
        let (dirs, spacing_rad) = (&points_m[..n], spacing_m / self.radius_m);
        self.terrain.heights_spaced_into(dirs, spacing_rad, &mut heights_m[..n], self.scratch);
        for ((point, point_m), height_m) in points.iter_mut().zip(points_m).zip(heights_m) {
            point.clearance_m = point_m.length() - self.radius_m - height_m.max(self.sea_m);
        }
    }

    fn point(&mut self, t_m: f64) -> RayPoint {
        let mut point = [RayPoint { t_m, clearance_m: 0.0 }];
        self.find_clearances(&mut point, 0.0);
        point[0]
    }

    /// One batch of steps, for a ray that is expected to lose `fall` metres of clearance per metre. Returns the last
    /// point above the ground, and the point below that follows, if the ray meets the ground.
    fn march(&mut self, start: RayPoint, fall: f64) -> (RayPoint, Option<RayPoint>) {
        let mut points = [RayPoint::default(); BATCH];
        let (mut t_m, mut expected_m, mut spare, mut count) = (start.t_m, start.clearance_m, SPARE_STEPS, 0);
        let mut least_m = f64::MAX;
        for point in &mut points {
            let step_m = (expected_m * STEP).max(start.clearance_m * LEAST_STEP).max(0.02 + t_m * 2e-4);
            least_m = least_m.min(step_m);
            (t_m, expected_m) = (t_m + step_m, (expected_m - fall * step_m).max(0.0));
            point.t_m = t_m;
            count += 1;
            if expected_m == 0.0 {
                if spare == 0 {
                    break;
                }
                spare -= 1;
            }
        }
        let points = &mut points[..count];
        if self.terrain.planet().structure.is_some() {
            self.find_clearances(points, SEEN * least_m);
            let (above, below) = first_below(start, points);
            let Some(below) = below else { return (above, None) };
            // The ground of all levels decides, if it agrees about the step.
            let [above, below] = [above, below].map(|point| self.point(point.t_m));
            if above.clearance_m > 0.0 && below.clearance_m <= 0.0 {
                return (above, Some(below));
            }
        }
        self.find_clearances(points, 0.0);
        first_below(start, points)
    }

    /// The distance of the crossing between a point above the ground and one below: by the secant, halving the weight
    /// of an end that stays (the Illinois method; Dowell and Jarratt 1971).
    fn crossing(&mut self, mut above: RayPoint, mut below: RayPoint) -> f64 {
        // Which end moved last: 1 the one above, -1 the one below.
        let mut moved = 0;
        let (mut up, mut down) = (above.clearance_m, below.clearance_m);
        for step in 1..=MAX_SEARCH {
            let width_m = below.t_m - above.t_m;
            if width_m <= TOLERANCE_M.max(below.t_m * 1e-15) || below.clearance_m >= -TOLERANCE_M {
                break;
            }
            // Every fourth step halves the gap, whatever the ground is like.
            let share = if step % 4 == 0 { 0.5 } else { up / (up - down) };
            let middle = self.point(above.t_m + width_m * share);
            let side = if middle.clearance_m > 0.0 { 1 } else { -1 };
            if side > 0 {
                (above, up) = (middle, middle.clearance_m);
                down *= if moved == side { 0.5 } else { 1.0 };
            } else {
                (below, down) = (middle, middle.clearance_m);
                up *= if moved == side { 0.5 } else { 1.0 };
            }
            moved = side;
        }
        below.t_m
    }
}

/// The last point before a ray goes below the ground, and the first one below, if there is one.
fn first_below(start: RayPoint, points: &[RayPoint]) -> (RayPoint, Option<RayPoint>) {
    let below = points.iter().position(|point| point.clearance_m <= 0.0);
    let above = below.unwrap_or(points.len()).checked_sub(1).map_or(start, |last| points[last]);
    (above, below.map(|below| points[below]))
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
