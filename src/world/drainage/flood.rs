//! Filling of pits: every cell gets a way down to an outlet (priority flood; Barnes, Lehman and Mulla 2014).
//!
//! Heights are whole numbers of [`UNIT_M`], so that a queue of buckets serves instead of a heap. A cell that is lower
//! than the way to it is raised by one to four units above the cell before it, by a hash: rivers wind over filled
//! flats instead of running straight.

use crate::world::cells::Cells;
use crate::world::map::KeepGoing;
use crate::world::noise::hash;

/// The unit of filled heights, in metres.
pub(super) const UNIT_M: f64 = 1.0 / 16.0;

/// Most units of a filled height: 62 km.
const MOST: u32 = 1_000_000;

/// A surface without pits.
pub(super) struct Filled {
    /// Height in units above the base level; 0 in the sea.
    pub(super) units: Vec<u32>,
    /// Land cells, the lowest first; each comes after some neighbour that is lower. Sinks are among them.
    pub(super) order: Vec<u32>,
}

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

/// Floods `surface_m` from the sea and from sinks. None if `keep_going` said no.
pub(super) fn fill(
    cells: &Cells,
    base_m: f64,
    surface_m: &[f64],
    is_sea: &[bool],
    sinks: &[u32],
    keep_going: &KeepGoing<'_>,
) -> Option<Filled> {
    let count = surface_m.len();
    let raw = |cell: usize| ((surface_m[cell] - base_m) * (1.0 / UNIT_M)).clamp(1.0, f64::from(MOST)) as u32;
    let mut units = vec![NONE; count];
    let mut order = Vec::with_capacity(count);
    let mut waiting = Buckets { first: vec![NONE; 1 << 16], next: vec![NONE; count] };
    for (cell, sea) in is_sea.iter().enumerate() {
        if *sea {
            units[cell] = 0;
            // Only cells on the coast lead anywhere.
            if cells.neighbours[cell].iter().any(|&other| !is_sea[other as usize]) {
                waiting.push(cell as u32, 0);
            }
        }
    }
    for &sink in sinks {
        if units[sink as usize] == NONE {
            units[sink as usize] = raw(sink as usize);
            waiting.push(sink, units[sink as usize]);
        }
    }
    let mut level = 0;
    while level < waiting.first.len() {
        let cell = waiting.first[level];
        if cell == NONE {
            level += 1;
            continue;
        }
        waiting.first[level] = waiting.next[cell as usize];
        let here = units[cell as usize];
        if !is_sea[cell as usize] {
            order.push(cell);
            if order.len() & 0xFFFF == 0 && !keep_going() {
                return None;
            }
        }
        for &other in &cells.neighbours[cell as usize] {
            if units[other as usize] == NONE {
                let step = 1 + (hash(other, 77) & 3);
                let to = raw(other as usize).max(here + step);
                units[other as usize] = to;
                waiting.push(other, to);
            }
        }
    }
    // Land without any outlet: a planet of land alone whose sinks are none.
    for (cell, units) in units.iter_mut().enumerate() {
        if *units == NONE {
            *units = raw(cell);
        }
    }
    Some(Filled { units, order })
}
