//! Courses of rivers: the reaches of the solved drainage, one after the other from source to mouth.
//!
//! Points of a course lie on the river as queries find it: nodes and cuts of reaches keep their places on all levels.
//! Between two of them the river winds a little.

use super::Rivers;
use super::reach::{Channel, LEAST_RIVER_M3_S, Piece, Stream, depth_m, width_m};
use super::tributaries::PIECES;
use super::trunk::{NONE, Trunks};
use super::winding::refine;
use glam::DVec3;
use rayon::prelude::*;

/// A river from source to mouth.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Course {
    pub(crate) id: u64,
    pub(crate) points: Vec<CoursePoint>,
    pub(crate) end: CourseEnd,
}

/// A point of a river.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct CoursePoint {
    /// Unit direction.
    pub(crate) dir: DVec3,
    /// Height of the bed; across a lake as far below its surface as the river is deep.
    pub(crate) bed_m: f64,
    pub(crate) width_m: f64,
    pub(crate) discharge_m3_s: f64,
}

/// What a river flows into.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum CourseEnd {
    Sea,
    /// The lake, counted from 1.
    Lake(u32),
    /// The id of the river.
    River(u64),
    /// Dry ground, where the water evaporates.
    Ground,
}

impl Rivers {
    /// The courses of all rivers that carry at least this much water at their mouths. Each begins where it carries so
    /// much. By the last cell of the river.
    pub(crate) fn courses(&self, least_m3_s: f64) -> Vec<Course> {
        let least = least_m3_s.max(LEAST_RIVER_M3_S) as f32;
        let trunks = &self.trunks;
        let last_cells = (0..trunks.river.len()).into_par_iter().filter(|&cell| trunks.river[cell] as usize == cell);
        let courses = last_cells.filter_map(|cell| trunks.course(cell, least));
        courses.collect()
    }
}

impl Trunks {
    /// The course of the river with this last cell. None if it carries too little, or if it lies in a lake alone.
    fn course(&self, last: usize, least_m3_s: f32) -> Option<Course> {
        let drainage = &*self.drainage;
        let receiver = &drainage.receiver;
        let is_whole = |cell: usize| receiver[cell] as usize != cell && drainage.discharge_m3_s[cell] >= least_m3_s;
        let mut cells = Vec::new();
        let mut next = Some(last).filter(|&cell| is_whole(cell));
        while let Some(cell) = next {
            cells.push(cell);
            next =
                Some(self.main[cell]).filter(|&main| main != NONE).map(|main| main as usize).filter(|&c| is_whole(c));
        }
        cells.reverse();
        // Within a lake there is no reach. A course begins and ends on its shore.
        let has_reach = |cell: &usize| self.reach(self.grid.cell(*cell as u64)).is_some();
        let first = cells.iter().position(has_reach)?;
        let end = cells.iter().rposition(has_reach)? + 1;
        let last = *cells.get(end - 1)?;
        let mut points = Vec::new();
        for (k, &cell) in cells.iter().enumerate().take(end).skip(first) {
            self.add_points(cell, k + 1 == end, &mut points);
        }
        // The solver's heights are single precision: a bed may seem to rise by their rounding.
        let mut lowest_m = f64::MAX;
        for point in &mut points {
            lowest_m = lowest_m.min(point.bed_m);
            point.bed_m = lowest_m;
        }
        let to = receiver[last] as usize;
        let end = match drainage.lake[to] {
            0 if receiver[to] as usize != to => CourseEnd::River(u64::from(self.river[to])),
            0 if drainage.is_sea[to] && self.sea_level_m.is_some() => CourseEnd::Sea,
            0 => CourseEnd::Ground,
            lake => CourseEnd::Lake(lake),
        };
        Some(Course { id: u64::from(self.river[last]), points, end })
    }

    /// Adds the points of the way from a cell to its receiver. The last point of the way before stands at its start.
    fn add_points(&self, cell: usize, is_last: bool, points: &mut Vec<CoursePoint>) {
        let at = self.grid.cell(cell as u64);
        let Some(reach) = self.reach(at) else {
            let discharge_m3_s = f64::from(self.drainage.discharge_m3_s[cell]);
            let level_m = self.level_of(self.drainage.lake[cell]).unwrap_or_default();
            points.pop_if(|last| last.dir == self.grid.node(at));
            points.push(CoursePoint {
                dir: self.grid.node(at),
                bed_m: level_m - depth_m(discharge_m3_s),
                width_m: width_m(discharge_m3_s),
                discharge_m3_s,
            });
            return;
        };
        // Where it flows into a lake and out again, the bed goes on below the surface.
        let into =
            if is_last { None } else { self.level_of(self.drainage.lake[self.drainage.receiver[cell] as usize]) };
        let floor_m = into.unwrap_or(f64::MIN);
        let (mut whole, mut pieces) = (Vec::with_capacity(PIECES), Vec::new());
        reach.cut(PIECES, self.radius_m, &mut whole);
        whole.iter().for_each(|piece| refine(piece, &mut |piece| pieces.push(piece)));
        points.pop_if(|last| last.dir == reach.from);
        points.extend(pieces.iter().map(|piece| self.point(piece, 0.0, floor_m)));
        points.extend(pieces.last().map(|piece| self.point(piece, 1.0, floor_m)));
    }

    /// The point at a share of a piece. Banks lie no lower than `floor_m`.
    fn point(&self, piece: &Piece, share: f64, floor_m: f64) -> CoursePoint {
        let Piece { line, stream: Stream { channel, .. } } = piece;
        let Channel { depth_m, depth_change_m, discharge_m3_s, discharge_change_m3_s, .. } = channel;
        let bank_m = (line.bank_m + line.bank_change_m * share).max(floor_m);
        CoursePoint {
            dir: if share > 0.0 { line.start + line.along } else { line.start },
            bed_m: bank_m - (depth_m + depth_change_m * share),
            width_m: 2.0 * channel.half_width_rad(share) * self.radius_m,
            discharge_m3_s: discharge_m3_s + discharge_change_m3_s * share,
        }
    }
}
