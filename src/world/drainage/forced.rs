//! Rivers whose courses are drawn by hand. A trench along each, in the surface on which routes are found, gathers the
//! water around it and leads it to the mouth. Heights of beds follow from the routes, as those of all rivers do.

use super::{DISCHARGE_UNIT, YEAR_S, flood};
use crate::world::cells::Cells;
use crate::world::grid::cell_at;
use crate::world::map::KeepGoing;
use crate::world::noise::fbm3;
use crate::world::sculpted::DrawnCourse;
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// Waves of the largest bends in the distance by which a course strays.
const WAVES: f64 = 0.2;
/// Steps along a line, in cells.
const STEP: f64 = 0.2;
/// How often a step is halved where it leads beyond the next cell.
const HALVINGS: u32 = 12;
/// Most water of all springs: the sums of discharge have room for as much again.
const MOST_UNITS: f64 = (1_u64 << 62) as f64;

/// The courses on one grid.
#[derive(Debug, Default)]
pub(super) struct Forced {
    chains: Vec<Chain>,
    /// The cell of each spring, and its water.
    springs: Vec<(u32, u64)>,
    /// Each cell of a course with the next, sorted.
    steps: Vec<(u32, u32)>,
}

/// One course: neighbouring cells from the spring down.
#[derive(Debug)]
struct Chain {
    cells: Vec<u32>,
    end: End,
    cut: f64,
}

/// What lies beyond the last cell of a course.
#[derive(Clone, Copy, Debug, PartialEq)]
enum End {
    Sea,
    /// A cell of an earlier course.
    Joins(u32),
    Land,
}

impl Forced {
    /// The courses on the grid of these cells. None if `keep_going` said no.
    pub(super) fn new(
        courses: &[DrawnCourse],
        cells: &Cells,
        radius_km: f64,
        is_sea: &[bool],
        keep_going: &KeepGoing<'_>,
    ) -> Option<Self> {
        let mut forced = Self::default();
        let mut taken: HashSet<u32> = HashSet::new();
        let radius_m = radius_km * 1000.0;
        for course in courses {
            if !keep_going() {
                return None;
            }
            let mut chain = Chain { cells: Vec::new(), end: End::Land, cut: course.cut };
            let (mut places, mut met): (HashMap<u32, usize>, Option<u32>) = (HashMap::new(), None);
            for cell in cells_along(course, cells) {
                if chain.cells.is_empty() && is_sea[cell as usize] {
                    // Before the spring, the sea is not the mouth.
                    continue;
                } else if chain.cells.is_empty() && taken.contains(&cell) {
                    // On a coarse grid two springs share a cell.
                    met.get_or_insert(cell);
                    continue;
                } else if is_sea[cell as usize] {
                    chain.end = End::Sea;
                } else if taken.contains(&cell) {
                    chain.end = End::Joins(cell);
                }
                if chain.end != End::Land {
                    forced.steps.extend(chain.cells.last().map(|last| (*last, cell)));
                    break;
                }
                if chain.cells.last().is_some_and(|last| !cells.around(*last as usize).contains(&cell)) {
                    break;
                }
                // A line that comes back to its own cell leaves the loop out.
                if let Some(&first) = places.get(&cell) {
                    chain.cells.drain(first..).for_each(|left_out| {
                        places.remove(&left_out);
                    });
                }
                places.insert(cell, chain.cells.len());
                chain.cells.push(cell);
            }
            let spring = course.spring_m3_s * YEAR_S / (radius_m * radius_m) / DISCHARGE_UNIT;
            let spring = spring.min(MOST_UNITS / courses.len() as f64) as u64;
            forced.springs.extend(chain.cells.first().copied().or(met).map(|cell| (cell, spring)));
            forced.steps.extend(chain.cells.windows(2).map(|pair| (pair[0], pair[1])));
            taken.extend(&chain.cells);
            if !chain.cells.is_empty() {
                forced.chains.push(chain);
            }
        }
        forced.steps.sort_unstable();
        forced.steps.dedup_by_key(|(cell, _)| *cell);
        Some(forced)
    }

    /// Whether there is none.
    pub(super) fn is_empty(&self) -> bool {
        self.chains.is_empty()
    }

    /// Whether one ends on land.
    pub(super) fn ends_inland(&self) -> bool {
        self.chains.iter().any(|chain| chain.end == End::Land)
    }

    /// Digs trenches into heights that are to be flooded. `filled`: the same heights without trenches, flooded; read
    /// where a course ends on land.
    pub(super) fn dig(&self, units: &mut [u32], filled: &[u32]) {
        for chain in &self.chains {
            let end = match (chain.end, chain.cells.last()) {
                (End::Land, Some(&last)) => filled.get(last as usize).copied().unwrap_or(0).saturating_sub(1),
                (End::Joins(cell), _) => flood::raw(units[cell as usize]),
                _ => 0,
            };
            for (above, &cell) in chain.cells.iter().rev().enumerate() {
                let units = &mut units[cell as usize];
                *units = flood::dry(flood::raw(*units).min(end + 1 + above as u32));
            }
        }
    }

    /// The cell to which the water of a cell goes, if it is one of a course and that is lower.
    pub(super) fn receiver(&self, cell: usize, units: &[u32]) -> Option<u32> {
        let at = self.steps.binary_search_by_key(&(cell as u32), |(cell, _)| *cell).ok()?;
        let to = self.steps[at].1;
        (units[to as usize] < units[cell]).then_some(to)
    }

    /// Adds the water of the springs to what each cell adds to its river.
    pub(super) fn add_springs(&self, source: &mut [u64]) {
        self.springs.iter().for_each(|(cell, spring)| source[*cell as usize] += spring);
    }

    /// Lets the rivers cut through rock faster than their water would.
    pub(super) fn cut(&self, slowness: &mut [f64]) {
        for chain in &self.chains {
            let left = 1.0 - chain.cut;
            chain.cells.iter().for_each(|cell| slowness[*cell as usize] *= left * left);
        }
    }
}

/// A course between two of its points.
struct Segment<'a> {
    course: &'a DrawnCourse,
    ends: [DVec3; 2],
    /// Length of the course before the first end, of the segment, and of the whole course, as angles.
    before_rad: f64,
    length_rad: f64,
    whole_rad: f64,
}

impl Segment<'_> {
    /// The direction at a share of the segment. The course strays from its line, but not at its ends.
    fn at(&self, share: f64) -> DVec3 {
        let dir = self.ends[0].lerp(self.ends[1], share).normalize_or(self.ends[1]);
        let wander_rad = self.course.wander_rad;
        if wander_rad <= 0.0 {
            return dir;
        }
        let along_rad = self.before_rad + share * self.length_rad;
        let free = (along_rad.min(self.whole_rad - along_rad) / (2.0 * wander_rad)).clamp(0.0, 1.0);
        let aside = fbm3(dir, WAVES / wander_rad, 4, 0.5, self.course.seed);
        (dir + aside * (2.0 * free * wander_rad)).normalize_or(dir)
    }
}

/// The cells along a course, each beside the one before.
fn cells_along(course: &DrawnCourse, cells: &Cells) -> Vec<u32> {
    let Some(&first) = course.points.first() else { return Vec::new() };
    let lengths_rad: Vec<f64> = course.points.windows(2).map(|pair| angle(pair[0], pair[1])).collect();
    let whole_rad: f64 = lengths_rad.iter().sum();
    let step_rad = STEP * 2.0 / cells.side as f64;
    let (mut along, mut before_rad) = (vec![cell_at(cells.side, first) as u32], 0.0);
    for (pair, &length_rad) in course.points.windows(2).zip(&lengths_rad) {
        let segment = Segment { course, ends: [pair[0], pair[1]], before_rad, length_rad, whole_rad };
        let steps = (length_rad / step_rad).ceil().max(1.0);
        for step in 0..steps as usize {
            walk(&segment, cells, [step as f64 / steps, (step + 1) as f64 / steps], HALVINGS, &mut along);
        }
        before_rad += length_rad;
    }
    along
}

/// Goes on to the end of a part of a segment, cell by cell.
fn walk(segment: &Segment<'_>, cells: &Cells, [from, to]: [f64; 2], halvings: u32, along: &mut Vec<u32>) {
    let cell = cell_at(cells.side, segment.at(to)) as u32;
    let Some(&last) = along.last() else { return };
    if cell == last {
        return;
    }
    if halvings == 0 || cells.around(last as usize).contains(&cell) {
        along.push(cell);
        return;
    }
    let middle = 0.5 * (from + to);
    walk(segment, cells, [from, middle], halvings - 1, along);
    walk(segment, cells, [middle, to], halvings - 1, along);
}

/// The angle between two unit directions.
fn angle(a: DVec3, b: DVec3) -> f64 {
    2.0 * libm::asin((0.5 * a.distance(b)).min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::LatLon;

    #[test]
    fn cells_of_a_course_are_neighbours_however_it_strays_and_wherever_it_runs() {
        let at = |lat, lon| LatLon::from_degrees(lat, lon).direction();
        // Over edges and corners of the cube, a pole, long segments, points that coincide, one point.
        let lines = [
            vec![at(35.2, 44.0), at(35.3, 46.0), at(-35.0, 136.0)],
            vec![at(80.0, 10.0), at(85.0, -170.0), at(20.0, -120.0)],
            vec![at(0.0, 0.0), at(0.0, 119.0)],
            vec![at(5.0, 5.0), at(5.0, 5.0), at(5.5, 5.0)],
            vec![at(-12.0, 70.0)],
        ];
        for side in [16, 64, 256] {
            let cells = Cells::of(side);
            for points in &lines {
                for wander_rad in [0.0, 0.003, 0.02, 0.1, 0.5] {
                    let course =
                        DrawnCourse { points: points.clone(), wander_rad, seed: 7, spring_m3_s: 1.0, cut: 0.5 };
                    let along = cells_along(&course, &cells);
                    assert_eq!(along[0], cell_at(side, points[0]) as u32);
                    assert_eq!(along[along.len() - 1], cell_at(side, points[points.len() - 1]) as u32);
                    for pair in along.windows(2) {
                        let around = cells.around(pair[0] as usize);
                        assert!(around.contains(&pair[1]), "{side} {wander_rad} {points:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn springs_that_share_a_cell_keep_their_water_and_the_greatest_do_not_overflow() {
        let cells = Cells::of(16);
        let land = vec![false; 6 * 16 * 16];
        let course = |lat: f64, spring_m3_s: f64| {
            let points = [10.0, 40.0].map(|lon| LatLon::from_degrees(lat, lon).direction()).to_vec();
            DrawnCourse { points, wander_rad: 0.0, seed: 1, spring_m3_s, cut: 0.0 }
        };
        let water = |courses: &[DrawnCourse], radius_km: f64| {
            let mut source = vec![0_u64; land.len()];
            Forced::new(courses, &cells, radius_km, &land, &|| true).unwrap().add_springs(&mut source);
            source.into_iter().map(u128::from).sum::<u128>()
        };
        let one = water(&[course(5.0, 1000.0)], 6371.0);
        assert!(one > 0 && water(&[course(5.0, 1000.0), course(5.5, 1000.0)], 6371.0) == 2 * one);
        let many: Vec<DrawnCourse> = (0..300).map(|k| course(f64::from(k) * 0.2, 5e5)).collect();
        assert!(water(&many, 1.0) < 1 << 63);
    }
}
