//! What is near some points: the arcs of each edit that may act there. All others are farther from every one of the
//! points than they reach, so that leaving them out changes no result.

use super::compiled::CompiledEdit;
use super::index::{Cell, Disc, Index};
use super::leaves::Sinking;
use super::nearest::{Nearest, Search};
use super::roster::Roster;
use glam::DVec3;
use std::ops::Range;

/// Fewer points take all arcs of the pieces that are near.
const LEAST_POINTS: usize = 8;

/// The arcs of one edit.
#[derive(Clone, Debug)]
struct Group {
    slot: u32,
    /// Range of its arcs in the list of all.
    arcs: Range<u32>,
}

/// A point within reach of an edit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hit {
    /// Its number among the points.
    pub(super) point: usize,
    pub(super) nearest: Nearest,
}

/// An edit near some points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Touch<'a> {
    pub(super) slot: u32,
    pub(super) edit: &'a CompiledEdit,
    /// Places of the arcs that may act, among those of the edit.
    pub(super) arcs: &'a [u32],
    /// The points within its reach; at least one.
    pub(super) hits: &'a [Hit],
}

/// The arcs near some points, edit by edit. The memory is used again.
#[derive(Debug, Default)]
pub(crate) struct Near {
    groups: Vec<Group>,
    /// Arcs by their places in their edits.
    arcs: Vec<u32>,
    sinking: Sinking,
    search: Search,
    hits: Vec<Hit>,
}

impl Near {
    /// Looks at the pieces of a leaf of the index, near some points.
    fn refill(&mut self, leaf: &Cell, roster: &Roster, dirs: &[DVec3], points: &[u32]) {
        self.groups.clear();
        self.arcs.clear();
        let own = || points.iter().filter_map(|point| dirs.get(*point as usize));
        let Some(&first) = own().next() else { return };
        let middle = own().sum::<DVec3>().normalize_or(first);
        let chord2 = own().map(|dir| dir.distance_squared(middle)).fold(0.0, f64::max);
        let chord = chord2.sqrt() * (1.0 + 1e-9);
        let mut last = None;
        let disc = Disc::new(middle, chord);
        for piece in leaf.listed().iter().filter(|piece| piece.disc.may_touch(&disc)) {
            let (slot, before) = (piece.slot, self.arcs.len() as u32);
            if points.len() < LEAST_POINTS {
                self.arcs.extend(piece.arcs());
            } else if let Some(edit) = roster.edit(slot) {
                self.arcs.extend(piece.arcs().filter(|arc| edit.may_reach(*arc, middle, chord)));
            }
            let end = self.arcs.len() as u32;
            if end == before {
                continue;
            }
            match self.groups.last_mut().filter(|_| last == Some(slot) && !piece.is_alone) {
                Some(group) => group.arcs.end = end,
                None => self.groups.push(Group { slot, arcs: before..end }),
            }
            last = Some(slot);
        }
    }

    /// Calls `each` with the edits that reach some of the points. Those that reach one point come in the order in which
    /// they act; a stamp comes once for each place. `wanted`: which edits count, by slot.
    pub(super) fn each_touch(
        &mut self,
        index: &Index,
        roster: &Roster,
        dirs: &[DVec3],
        wanted: impl Fn(u32, &CompiledEdit) -> bool,
        mut each: impl FnMut(Touch<'_>),
    ) {
        let mut sinking = std::mem::take(&mut self.sinking);
        sinking.each_leaf(index, dirs, |leaf, points| {
            self.refill(leaf, roster, dirs, points);
            if self.groups.is_empty() {
                return;
            }
            let Self { groups, arcs, search, hits, .. } = self;
            search.refill(points.iter().filter_map(|point| dirs.get(*point as usize).copied()));
            for Group { slot, arcs: own } in &*groups {
                let Some(edit) = roster.edit(*slot).filter(|edit| wanted(*slot, edit)) else { continue };
                let Some(arcs) = arcs.get(own.start as usize..own.end as usize) else { continue };
                hits.clear();
                let reach_chord2 = edit.reach_chord2();
                let found = search.find((edit.arcs(), arcs), edit.tapers, reach_chord2);
                let found = found.filter(|(_, nearest)| nearest.chord2 <= reach_chord2);
                hits.extend(found.map(|(own, nearest)| Hit { point: points[own] as usize, nearest }));
                if !hits.is_empty() {
                    each(Touch { slot: *slot, edit, arcs, hits });
                }
            }
        });
        self.sinking = sinking;
    }

    /// Whether a leaf that has pieces holds one of these points.
    pub(super) fn holds_any(&mut self, index: &Index, dirs: &[DVec3]) -> bool {
        let mut holds = false;
        self.sinking.each_leaf(index, dirs, |_, _| holds = true);
        holds
    }
}
