//! Filling of pits: every cell gets a way down to an outlet (priority flood; Barnes, Lehman and Mulla 2014).
//!
//! Heights are whole numbers of [`UNIT_M`], so that a queue of buckets serves instead of a heap. A cell that is lower
//! than the way to it is raised by one to four units above the cell before it, by a hash: rivers wind over filled
//! flats instead of running straight.

use crate::world::cells::Cells;
use crate::world::map::KeepGoing;
use crate::world::noise::hash;
use rayon::prelude::*;

/// The unit of filled heights, in metres.
pub(super) const UNIT_M: f64 = 1.0 / 16.0;

/// Most units of a filled height: 62 km.
const MOST: u32 = 1_000_000;

/// Marks a cell that the flood has not reached.
const DRY: u32 = 1 << 31;

const NONE: u32 = u32::MAX;

/// Cells waiting, in a list for each height.
struct Buckets {
    first: Vec<u32>,
    next: Vec<u32>,
}

impl Buckets {
    fn push(&mut self, cell: u32, units: u32) {
        let at = units.min(MOST) as usize;
        if at >= self.first.len() {
            self.first.resize((at + 1).next_power_of_two(), NONE);
        }
        self.next[cell as usize] = std::mem::replace(&mut self.first[at], cell);
    }
}

/// A height above the base level in units, of a cell on land that is to be flooded.
pub(super) fn dry_units(above_m: f64) -> u32 {
    (above_m * (1.0 / UNIT_M)).clamp(1.0, f64::from(MOST)) as u32 | DRY
}

/// The height in units of a cell, flooded or not.
pub(super) fn raw(units: u32) -> u32 {
    units & !DRY
}

/// A height in units of a cell that is to be flooded.
pub(super) fn dry(units: u32) -> u32 {
    units | DRY
}

/// Floods heights in units from the cells of the shore and from sinks: afterwards they have no pits. The sea has 0, and
/// land [`dry_units`]. None if `keep_going` said no.
pub(super) fn fill(
    cells: &Cells,
    mut units: Vec<u32>,
    shore: &[u32],
    sinks: &[u32],
    keep_going: &KeepGoing<'_>,
) -> Option<Vec<u32>> {
    let mut waiting = Buckets { first: vec![NONE; 1 << 16], next: vec![NONE; units.len()] };
    for &sink in sinks {
        let units = &mut units[sink as usize];
        if *units & DRY != 0 {
            *units &= !DRY;
            waiting.push(sink, *units);
        }
    }
    let raised = |cell: u32, raw: u32, from: u32| {
        let raw = raw & !DRY;
        // The hash matters only where the cell is not high enough anyway.
        if raw >= from + 4 { raw } else { raw.max(from + 1 + (hash(cell, 77) & 3)) }
    };
    for &cell in shore {
        let units = &mut units[cell as usize];
        if *units & DRY != 0 {
            *units = raised(cell, *units, 0);
            waiting.push(cell, *units);
        }
    }
    let (mut level, mut done) = (0, 0_u32);
    while level < waiting.first.len() {
        let cell = waiting.first[level];
        if cell == NONE {
            level += 1;
            continue;
        }
        waiting.first[level] = waiting.next[cell as usize];
        let here = units[cell as usize];
        done += 1;
        if done & 0xFFFF == 0 && !keep_going() {
            return None;
        }
        for other in cells.around(cell as usize) {
            let units = &mut units[other as usize];
            if *units & DRY != 0 {
                *units = raised(other, *units, here);
                waiting.push(other, *units);
            }
        }
    }
    // Land without any outlet: a planet of land alone whose sinks are none.
    units.par_iter_mut().with_min_len(4096).for_each(|units| *units &= !DRY);
    Some(units)
}
