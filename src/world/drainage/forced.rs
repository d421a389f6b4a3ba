//! Rivers whose courses are drawn by hand. A trench along each, in the surface on which routes are found, gathers the
//! water around it and leads it to the mouth. Heights of beds follow from the routes, as those of all rivers do.

use super::{DISCHARGE_UNIT, flood};
use crate::world::grid::cell_at;
use crate::world::noise::fbm3;
use crate::world::sculpted::Course;
use glam::DVec3;
use std::collections::{HashMap, HashSet};

/// Bends of a course: the largest are as many times longer than it strays.
const WAVES: f64 = 0.2;
/// Steps along a line, in cells.
const STEP: f64 = 0.2;
/// Seconds in a year.
const YEAR_S: f64 = 3.156e7;

/// The courses on one grid.
#[derive(Debug, Default)]
pub(super) struct Forced {
    chains: Vec<Chain>,
    /// Each cell of a course with the next, sorted.
    steps: Vec<(u32, u32)>,
}

/// One course: neighbouring cells from the spring down.
#[derive(Debug)]
struct Chain {
    cells: Vec<u32>,
    end: End,
    spring: u64,
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
    pub(super) fn new(courses: &[Course], side: usize, radius_km: f64, is_sea: &[bool]) -> Self {
        let mut forced = Self::default();
        let mut taken: HashSet<u32> = HashSet::new();
        for course in courses {
            let radius_m = radius_km * 1000.0;
            let spring = course.spring_m3_s * YEAR_S / (radius_m * radius_m) / DISCHARGE_UNIT;
            let mut chain = Chain { cells: Vec::new(), end: End::Land, spring: spring as u64, cut: course.cut };
            // The place of each cell in the chain.
            let mut places: HashMap<u32, usize> = HashMap::new();
            for cell in cells_along(course, side) {
                if is_sea[cell as usize] {
                    // Before the spring, the sea is not the mouth.
                    if chain.cells.is_empty() {
                        continue;
                    }
                    chain.end = End::Sea;
                } else if taken.contains(&cell) {
                    chain.end = End::Joins(cell);
                }
                if chain.end != End::Land {
                    forced.steps.extend(chain.cells.last().map(|last| (*last, cell)));
                    break;
                }
                // A line that comes back to its own cell leaves the loop out.
                if let Some(&first) = places.get(&cell) {
                    chain.cells.drain(first..).for_each(|left_out| drop(places.remove(&left_out)));
                }
                places.insert(cell, chain.cells.len());
                chain.cells.push(cell);
            }
            forced.steps.extend(chain.cells.windows(2).map(|pair| (pair[0], pair[1])));
            taken.extend(&chain.cells);
            if !chain.cells.is_empty() {
                forced.chains.push(chain);
            }
        }
        forced.steps.sort_unstable();
        forced.steps.dedup_by_key(|(cell, _)| *cell);
        forced
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
        for chain in &self.chains {
            source[chain.cells[0] as usize] += chain.spring;
        }
    }

    /// Lets the rivers cut through rock faster than their water would.
    pub(super) fn cut(&self, slowness: &mut [f64]) {
        for chain in &self.chains {
            let left = 1.0 - chain.cut;
            chain.cells.iter().for_each(|cell| slowness[*cell as usize] *= left * left);
        }
    }
}

/// The cells along a course, each next to the one before. It strays from its line, but not at its ends.
fn cells_along(course: &Course, side: usize) -> Vec<u32> {
    let line = line_of(&course.points, STEP * 2.0 / side as f64);
    let mut cells: Vec<u32> = Vec::new();
    let length_rad = line.last().map_or(0.0, |(_, along_rad)| *along_rad);
    for (dir, along_rad) in line {
        let mut dir = dir;
        if course.wander_rad > 0.0 {
            let share = (along_rad.min(length_rad - along_rad) / (2.0 * course.wander_rad)).clamp(0.0, 1.0);
            let aside = fbm3(dir, WAVES / course.wander_rad, 4, 0.5, course.seed);
            dir = (dir + aside * (2.0 * share * course.wander_rad)).normalize_or(dir);
        }
        let cell = cell_at(side, dir) as u32;
        if cells.last() != Some(&cell) {
            cells.push(cell);
        }
    }
    cells
}

/// Points along a line, with the length of the way to each.
fn line_of(points: &[DVec3], step_rad: f64) -> Vec<(DVec3, f64)> {
    let mut line: Vec<(DVec3, f64)> = points.first().map(|dir| (*dir, 0.0)).into_iter().collect();
    let mut begin_rad = 0.0;
    for pair in points.windows(2) {
        let length_rad = pair[0].angle_between(pair[1]);
        let steps = (length_rad / step_rad).ceil().max(1.0);
        for step in 1..=steps as usize {
            let share = step as f64 / steps;
            line.push((pair[0].lerp(pair[1], share).normalize_or(pair[1]), begin_rad + share * length_rad));
        }
        begin_rad += length_rad;
    }
    line
}
