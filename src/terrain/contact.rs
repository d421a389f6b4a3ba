//! Spheres and capsules against the ground: where they touch it, and how far they move until they do.
//!
//! Distances are those to the evaluator's ground. It is looked up on a grid under the capsule, [`ACROSS`] cells to
//! either side, then closer around the nearest point of the grid, and there until [`TOLERANCE_M`]. So the point that is
//! found lies on the ground to the bit, and a ridge is overlooked only if it is narrower than a cell. A sweep goes on
//! by [`SAFE`] of the distance that is found: nothing nearer can be met on the way (conservative advancement; Mirtich
//! 1996).

use super::Terrain;
use super::points::unit;
use super::query::{Scratch, with_scratch};
use crate::sphere::Tangent;
use glam::DVec3;

/// Cells of the grid from the axis to either side.
const ACROSS: usize = 6;
/// Most cells along the axis.
const MOST_ALONG: usize = 96;
/// Cells to either side of the nearest point of the grid, each a quarter of a cell of the grid.
const CLOSER: i32 = 4;
/// Most points of the axis whose clearance is looked up.
const AXIS: usize = 9;
/// Steps of the search become no finer than this.
const TOLERANCE_M: f64 = 1e-5;
/// A sweep ends at this distance.
const TOUCH_M: f64 = 1e-4;
/// Share of the distance by which a sweep goes on.
const SAFE: f64 = 0.7;
/// What touches leaves by at least this share of its motion; less counts as sliding along, which stops it.
const LEAVING: f64 = 1e-2;
/// Most steps of a sweep. They are enough for a flight along a slope at the distance of the radius, some hundred radii.
const MAX_STEPS: usize = 400;

/// A capsule: all points within a radius of a segment. A sphere has both ends in one place.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Capsule {
    /// The ends of the segment.
    pub ends_planet_m: [DVec3; 2],
    /// The radius, more than 0.
    pub radius_m: f64,
}

/// Where a capsule and the ground are nearest.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Contact {
    /// Distance between the surfaces. Negative: how far the capsule must move along the normal to be free.
    pub gap_m: f64,
    /// The point of the ground: its height is [`Terrain::height_m`], to the bit or within the deviation.
    pub point_planet_m: DVec3,
    /// Unit vector from the ground to the axis of the capsule; of a capsule whose axis is in the ground, the way out.
    pub normal_planet: DVec3,
    /// How far the ground that was met may lie from the evaluator's: 0 for queries of [`Terrain`].
    pub deviation_m: f64,
}

/// What a capsule that moves meets.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub struct Sweep {
    /// Share of the motion until it touches the ground, 0 to 1.
    pub share: f64,
    /// The place.
    pub contact: Contact,
}

impl Capsule {
    /// A sphere.
    pub fn sphere(center_planet_m: DVec3, radius_m: f64) -> Self {
        Self { ends_planet_m: [center_planet_m; 2], radius_m }
    }

    /// The same capsule elsewhere.
    #[must_use]
    pub fn moved(&self, by_planet_m: DVec3) -> Self {
        Self { ends_planet_m: self.ends_planet_m.map(|end_m| end_m + by_planet_m), radius_m: self.radius_m }
    }

    pub(crate) fn is_valid(&self) -> bool {
        self.ends_planet_m.iter().all(|end_m| end_m.is_finite()) && self.radius_m.is_finite() && self.radius_m > 0.0
    }

    /// The point of the segment that is nearest to a point.
    fn nearest_to(&self, point_m: DVec3) -> DVec3 {
        let [from_m, to_m] = self.ends_planet_m;
        let along = to_m - from_m;
        let length2 = along.length_squared();
        let share = if length2 > 0.0 { ((point_m - from_m).dot(along) / length2).clamp(0.0, 1.0) } else { 0.0 };
        from_m + along * share
    }

    /// Distance of the segment from the planet's centre.
    fn lowest_m(&self) -> f64 {
        self.nearest_to(DVec3::ZERO).length()
    }
}

impl Terrain {
    /// Where a capsule is nearest to the ground; None if that is farther than `within_m`, and for a capsule that is not
    /// finite or has no radius. The sea does not count.
    ///
    /// A ridge or a spire is overlooked if it is narrower than a sixth of the radius and `within_m` together. A capsule
    /// deeper in the ground than it is wide is led straight up.
    pub fn contact(&self, capsule: &Capsule, within_m: f64) -> Option<Contact> {
        with_scratch(|scratch| self.contact_with(capsule, within_m, scratch))
    }

    /// As [`Terrain::contact`], with the caller's scratch.
    pub fn contact_with(&self, capsule: &Capsule, within_m: f64, scratch: &mut Scratch) -> Option<Contact> {
        if !capsule.is_valid() || within_m.is_nan() || self.is_farther(capsule, within_m) {
            return None;
        }
        let contact = Around::new(self, capsule, within_m.max(0.0), scratch).nearest(true);
        Some(contact).filter(|contact| contact.gap_m <= within_m)
    }

    /// How far a capsule moves along a motion until it touches the ground. None if it does not, and for a capsule or a
    /// motion that is not finite. What touches may leave. A capsule whose axis is in the ground is stopped at 0,
    /// wherever it goes: its contact says the way out.
    ///
    /// It stops up to a tenth of a millimetre before the ground. Near the ground the limits are those of
    /// [`Terrain::contact`] with the radius as distance; farther away it can miss a spire thinner than a sixth of its
    /// distance from it, and meets it when it is nearer.
    pub fn sweep(&self, capsule: &Capsule, motion_planet_m: DVec3) -> Option<Sweep> {
        with_scratch(|scratch| self.sweep_with(capsule, motion_planet_m, 0.0, scratch))
    }

    /// As [`Terrain::sweep`], until it is a skin's width from the ground and with the caller's scratch. A skin that is
    /// no number above 0 counts as none.
    pub fn sweep_with(
        &self,
        capsule: &Capsule,
        motion_planet_m: DVec3,
        skin_m: f64,
        scratch: &mut Scratch,
    ) -> Option<Sweep> {
        if !capsule.is_valid() || !motion_planet_m.is_finite() {
            return None;
        }
        let skin_m = if skin_m.is_finite() { skin_m.max(0.0) } else { 0.0 };
        let touch_m = skin_m + TOUCH_M;
        let length_m = motion_planet_m.length();
        let dir = if length_m > 0.0 { motion_planet_m / length_m } else { DVec3::ZERO };
        let mut gone_m = 0.0;
        let mut last: Option<Sweep> = None;
        for _ in 0..MAX_STEPS {
            let here = capsule.moved(dir * gone_m);
            let share = if length_m > 0.0 { gone_m / length_m } else { 0.0 };
            gone_m += match self.free_m(&here, length_m - gone_m) {
                Some(free_m) => free_m,
                None => {
                    let around = Around::new(self, &here, 0.0, scratch);
                    let reach_m = here.radius_m.max(0.5 * around.clearance_m);
                    let contact = Around::new(self, &here, reach_m, scratch).nearest(false);
                    let leaving = contact.normal_planet.dot(dir);
                    let is_leaving = contact.gap_m > -here.radius_m && leaving > LEAVING;
                    if contact.gap_m <= touch_m && !is_leaving {
                        return Some(Sweep { share, contact });
                    }
                    // What leaves one side of a narrow valley may meet the other: it stops before it is nearer to it
                    // than it was, and nearer than it may be.
                    if let Some(last) = last.filter(|last| contact.gap_m < last.contact.gap_m.min(touch_m)) {
                        return Some(last);
                    }
                    last = Some(Sweep { share, contact });
                    if contact.gap_m > touch_m {
                        (SAFE * (contact.gap_m - skin_m).min(reach_m)).max(0.5 * TOUCH_M)
                    } else {
                        (SAFE * contact.gap_m.abs()).max(TOUCH_M) / leaving
                    }
                }
            };
            if gone_m >= length_m {
                return None;
            }
        }
        // Out of steps, close to the ground: it stops here rather than going through.
        last
    }

    /// Whether the bounds of the ground say that all of it is farther from a capsule than a distance.
    fn is_farther(&self, capsule: &Capsule, distance_m: f64) -> bool {
        let [from_m, to_m] = capsule.ends_planet_m;
        let middle_m = 0.5 * (from_m + to_m);
        let reach_m = 0.5 * from_m.distance(to_m) + capsule.radius_m + distance_m.max(0.0);
        let share = reach_m / middle_m.length();
        let angle_rad = if share < 1.0 { libm::asin(share) } else { std::f64::consts::PI };
        let (_, highest_m) = self.height_bounds_near_m(middle_m, angle_rad);
        capsule.lowest_m() - capsule.radius_m - self.planet().radius_m() - highest_m > distance_m
    }

    /// A distance that a capsule can move whatever the direction, from the bounds of the ground; None near it.
    pub(crate) fn free_m(&self, capsule: &Capsule, wanted_m: f64) -> Option<f64> {
        let tries = std::iter::successors(Some(wanted_m * 1.001), |distance_m| Some(distance_m * 0.25));
        let far = tries.take_while(|distance_m| *distance_m > 2.0 * capsule.radius_m);
        far.take(16).find(|distance_m| self.is_farther(capsule, *distance_m))
    }
}

/// The ground around a capsule.
struct Around<'a> {
    terrain: &'a Terrain,
    capsule: Capsule,
    reach_m: f64,
    tangent: Tangent,
    middle_m: f64,
    /// Least height of the axis over the ground under it, and where on the axis that is.
    clearance_m: f64,
    lowest_m: DVec3,
    scratch: &'a mut Scratch,
}

/// A point of the ground, its place on the tangent plane and its distance from the axis.
#[derive(Clone, Copy)]
struct Found {
    at_m: [f64; 2],
    ground_m: DVec3,
    away_m: f64,
}

impl<'a> Around<'a> {
    fn new(terrain: &'a Terrain, capsule: &Capsule, reach_m: f64, scratch: &'a mut Scratch) -> Self {
        let [from_m, to_m] = capsule.ends_planet_m;
        let middle_m = 0.5 * (from_m + to_m);
        let tangent = Tangent::new(unit(middle_m));
        let count = if from_m == to_m { 1 } else { AXIS };
        let axis_m: Vec<DVec3> = (0..count).map(|i| from_m.lerp(to_m, i as f64 / (count - 1).max(1) as f64)).collect();
        let mut heights_m = [0.0; AXIS];
        terrain.heights_spaced_into(&axis_m, 0.0, &mut heights_m[..count], scratch);
        let radius_m = terrain.planet().radius_m();
        let (mut clearance_m, mut lowest_m) = (f64::INFINITY, middle_m);
        for (at_m, height_m) in axis_m.iter().zip(heights_m) {
            let clear_m = at_m.length() - radius_m - height_m;
            if clear_m < clearance_m {
                (clearance_m, lowest_m) = (clear_m, *at_m);
            }
        }
        let middle_m = middle_m.length();
        Self { terrain, capsule: *capsule, reach_m, tangent, middle_m, clearance_m, lowest_m, scratch }
    }

    /// The nearest ground. `is_exact`: however far it is.
    fn nearest(mut self, is_exact: bool) -> Contact {
        let is_in = self.clearance_m < 0.0;
        let wide_m = self.capsule.radius_m + self.reach_m;
        let cell_m = wide_m / ACROSS as f64;
        let mut best = self.straight_up();
        for found in self.grid(cell_m, wide_m) {
            if found.away_m < best.away_m {
                best = found;
            }
        }
        if is_exact || is_in || best.away_m < self.capsule.radius_m + 2.0 * cell_m {
            let square = |reach: i32| {
                (-reach..=reach).flat_map(move |x| (-reach..=reach).map(move |y| [f64::from(x), f64::from(y)]))
            };
            let mut step_m = 0.25 * cell_m;
            best = self.better(best, square(CLOSER), step_m);
            while step_m > TOLERANCE_M {
                let next = self.better(best, square(1), step_m);
                if next.away_m < best.away_m {
                    best = next;
                } else {
                    step_m *= 0.5;
                }
            }
        }
        let axis_m = self.axis_at(best.ground_m);
        let out = if is_in { best.ground_m - axis_m } else { axis_m - best.ground_m };
        let normal_planet =
            if best.away_m > 1e-9 { out / best.away_m } else { self.terrain.sample(best.ground_m).normal_planet };
        let away_m = if is_in { -best.away_m } else { best.away_m };
        let gap_m = away_m - self.capsule.radius_m;
        Contact { gap_m, point_planet_m: best.ground_m, normal_planet, deviation_m: 0.0 }
    }

    /// The point of the axis that counts for a point of the ground: the deepest one of an axis that is in the ground.
    fn axis_at(&self, ground_m: DVec3) -> DVec3 {
        if self.clearance_m < 0.0 { self.lowest_m } else { self.capsule.nearest_to(ground_m) }
    }

    /// The ground over or under the lowest point of the axis.
    fn straight_up(&mut self) -> Found {
        let flat = self.tangent.local(self.lowest_m);
        let scale = self.middle_m / flat.z.max(f64::MIN_POSITIVE);
        let mut found = Vec::with_capacity(1);
        self.find(&[[flat.x * scale, flat.y * scale]], &mut found);
        found.swap_remove(0)
    }

    /// Points of the ground on a grid along the axis.
    fn grid(&mut self, cell_m: f64, wide_m: f64) -> Vec<Found> {
        let [from, to] = self.capsule.ends_planet_m.map(|end_m| self.tangent.local(end_m).truncate());
        let (middle, half) = (0.5 * (from + to), 0.5 * (to - from));
        let half_m = half.length();
        let along = if half_m > 0.0 { half / half_m } else { glam::DVec2::X };
        let across = along.perp();
        let long_m = half_m + wide_m;
        let count = ((long_m / cell_m).ceil() as usize).clamp(ACROSS, MOST_ALONG / 2) as i32;
        let places: Vec<[f64; 2]> = (-count..=count)
            .flat_map(|i| (-(ACROSS as i32)..=ACROSS as i32).map(move |j| (i, j)))
            .map(|(i, j)| {
                let at = middle + along * (long_m * f64::from(i) / f64::from(count)) + across * (cell_m * f64::from(j));
                at.to_array()
            })
            .collect();
        let mut found = Vec::with_capacity(places.len());
        self.find(&places, &mut found);
        found
    }

    /// The nearest of some points around the best one so far, or that one.
    fn better(&mut self, best: Found, around: impl Iterator<Item = [f64; 2]>, step_m: f64) -> Found {
        let places: Vec<[f64; 2]> =
            around.map(|[x, y]| [best.at_m[0] + x * step_m, best.at_m[1] + y * step_m]).collect();
        let mut found = Vec::with_capacity(places.len());
        self.find(&places, &mut found);
        found.into_iter().fold(best, |best, found| if found.away_m < best.away_m { found } else { best })
    }

    /// The ground at places of the plane that touches the sphere through the middle of the capsule there.
    fn find(&mut self, places_m: &[[f64; 2]], found: &mut Vec<Found>) {
        let dirs: Vec<DVec3> = places_m
            .iter()
            .map(|[x_m, y_m]| self.tangent.planet(DVec3::new(*x_m, *y_m, self.middle_m)).normalize())
            .collect();
        let mut heights_m = vec![0.0; dirs.len()];
        self.terrain.heights_spaced_into(&dirs, 0.0, &mut heights_m, self.scratch);
        let radius_m = self.terrain.planet().radius_m();
        for ((dir, height_m), at_m) in dirs.iter().zip(heights_m).zip(places_m) {
            let ground_m = *dir * (radius_m + height_m);
            found.push(Found { at_m: *at_m, ground_m, away_m: ground_m.distance(self.axis_at(ground_m)) });
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::Planet;
    use crate::sphere::geo::spread;
    use proptest::prelude::*;

    fn terrain() -> Terrain {
        hills(10)
    }

    /// Hills whose narrowest ones are wider than the cells of the grid under a capsule of this radius. The search may
    /// overlook narrower ones.
    fn terrain_for(radius_m: f64) -> Terrain {
        hills(if radius_m < 8.0 { 10 } else { 7 })
    }

    fn hills(octaves: u32) -> Terrain {
        let text = format!(
            r#"(version: 3, name: "Islet", radius_km: 40.0,
            layers: [(name: "Hills", amplitude_m: 800.0, shape: Fbm(wavelength_km: 8.0, octaves: {octaves}))])"#
        );
        Terrain::try_new(Planet::from_text("islet.ron", &text).unwrap().into()).unwrap()
    }

    /// The distance between a capsule above the ground and the points of a fine grid.
    fn brute_m(terrain: &Terrain, capsule: &Capsule, wide_m: f64) -> f64 {
        let middle_m = 0.5 * (capsule.ends_planet_m[0] + capsule.ends_planet_m[1]);
        let tangent = Tangent::new(unit(middle_m));
        let along = |i: i32| f64::from(i) * wide_m / 80.0 / middle_m.length();
        let dirs: Vec<DVec3> = (-80..=80)
            .flat_map(|x| (-80..=80).map(move |y| (x, y)))
            .map(|(x, y)| tangent.direction(along(x), along(y)))
            .collect();
        let ground = dirs.iter().zip(terrain.heights_m(&dirs)).map(|(dir, height_m)| *dir * (40_000.0 + height_m));
        ground.map(|at_m| at_m.distance(capsule.nearest_to(at_m))).fold(f64::INFINITY, f64::min) - capsule.radius_m
    }

    /// A capsule whose middle is at a height over the ground.
    fn capsule(terrain: &Terrain, place: usize, over_m: f64, length_m: f64, radius_m: f64) -> Capsule {
        let dir = spread(100).nth(place).unwrap();
        let tangent = Tangent::new(dir);
        let middle_m = dir * (40_000.0 + terrain.height_m(dir) + over_m);
        let half_m = tangent.planet(DVec3::new(0.6, -0.5, 0.4)).normalize() * (0.5 * length_m);
        Capsule { ends_planet_m: [middle_m - half_m, middle_m + half_m], radius_m }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(24))]

        #[test]
        fn contacts_are_no_farther_than_brute_force_finds_them(
            place in 0..100_usize, over in 0.7..4.0_f64, long in 0.0..2.0_f64, radius_m in 0.5..40.0_f64,
        ) {
            let terrain = terrain_for(radius_m);
            let capsule = capsule(&terrain, place, (over + 0.3 * long) * radius_m, long * radius_m, radius_m);
            let brute_m = brute_m(&terrain, &capsule, 6.0 * radius_m);
            match terrain.contact(&capsule, 2.0 * radius_m) {
                Some(contact) if contact.gap_m > -radius_m => {
                    prop_assert!(contact.gap_m < brute_m + 1e-6 * radius_m, "{} {brute_m}", contact.gap_m);
                    prop_assert!(contact.gap_m > brute_m - 0.06 * radius_m, "{} {brute_m}", contact.gap_m);
                    let ground_m = contact.point_planet_m.length() - 40_000.0;
                    prop_assert!((ground_m - terrain.height_m(contact.point_planet_m)).abs() < 1e-6);
                    let axis_m = contact.point_planet_m + contact.normal_planet * (contact.gap_m + radius_m);
                    prop_assert!(axis_m.distance(capsule.nearest_to(axis_m)) < 1e-6);
                }
                Some(_) => {}
                None => prop_assert!(brute_m > 2.0 * radius_m - 1e-6, "{brute_m}"),
            }
        }

        #[test]
        fn a_sweep_ends_where_the_capsule_touches_and_not_later(
            place in 0..100_usize, over_m in 50.0..3000.0_f64, side in -1.0..1.0_f64, long in 0.0..2.0_f64, radius_m in 0.5..40.0_f64,
        ) {
            let terrain = terrain();
            let capsule = capsule(&terrain, place, over_m + 2.0 * radius_m, long * radius_m, radius_m);
            let up = unit(capsule.ends_planet_m[0]);
            let motion_m = (Tangent::new(up).east_planet * side - up) * (over_m * 2.0 + 500.0);
            let sweep = terrain.sweep(&capsule, motion_m).unwrap();
            prop_assert!(sweep.share > 0.0 && sweep.share < 1.0);
            let at_end = terrain.contact(&capsule.moved(motion_m * sweep.share), radius_m).unwrap();
            prop_assert!(at_end.gap_m.abs() < 2e-3 * radius_m, "{}", at_end.gap_m);
            for step in 0..8 {
                let before = capsule.moved(motion_m * (sweep.share * f64::from(step) / 8.0));
                let brute_m = brute_m(&terrain, &before, 4.0 * radius_m);
                prop_assert!(brute_m > -0.02 * radius_m, "{step}: {brute_m}");
            }
        }
    }

    #[test]
    fn a_capsule_in_the_ground_is_led_out_of_it() {
        let terrain = terrain();
        for place in 0..20 {
            let capsule = capsule(&terrain, place, -1.0, 4.0, 3.0);
            let contact = terrain.contact(&capsule, 0.0).unwrap();
            assert!(contact.gap_m < -3.0, "{}", contact.gap_m);
            let freed = capsule.moved(contact.normal_planet * -contact.gap_m);
            let after = terrain.contact(&freed, 10.0).unwrap();
            assert!(after.gap_m > -0.7 && after.gap_m < 1.5, "{place}: {}", after.gap_m);
            let stuck = terrain.sweep(&capsule, DVec3::X).unwrap();
            assert!(stuck.share == 0.0 && stuck.contact.gap_m < 0.0);
        }
    }

    #[test]
    fn what_is_far_or_not_finite_touches_nothing() {
        let terrain = terrain();
        let far = Capsule::sphere(DVec3::X * 60_000.0, 10.0);
        assert_eq!(terrain.contact(&far, 1000.0), None);
        assert_eq!(terrain.sweep(&far, DVec3::Y * 1e6), None);
        assert_eq!(terrain.sweep(&far, DVec3::ZERO), None);
        let fall = terrain.sweep(&far, DVec3::X * -30_000.0).unwrap();
        assert!(
            (fall.contact.point_planet_m.length() - 40_000.0 - terrain.height_m(fall.contact.point_planet_m)).abs()
                < 1e-6
        );
        for bad in [f64::NAN, f64::INFINITY] {
            assert_eq!(terrain.contact(&Capsule::sphere(DVec3::splat(bad), 1.0), 1.0), None);
            assert_eq!(terrain.sweep(&far, DVec3::splat(bad)), None);
        }
        assert_eq!(terrain.contact(&Capsule::sphere(DVec3::X * 40_000.0, 0.0), 1.0), None);
    }
}
