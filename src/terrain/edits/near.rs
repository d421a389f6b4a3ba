//! What is near some points: the arcs of each edit that may act there. All others are farther from every one of the
//! points than they reach, so that leaving them out changes no result.

use super::index::{Walk, may_touch};
use super::roster::{Roster, slot_of};
use glam::DVec3;
use std::ops::Range;

/// Fewer points take all arcs of the pieces that are near.
const LEAST_POINTS: usize = 4;

/// The arcs of one edit, piece by piece.
#[derive(Clone, Debug)]
struct Group {
    slot: u32,
    /// Of the list of spans.
    spans: Range<u32>,
}

/// The arcs of one piece that are near, and its disc.
#[derive(Clone, Debug)]
struct Span {
    middle: DVec3,
    chord2: f64,
    /// Of the list of arcs.
    arcs: Range<u32>,
}

/// The arcs near some points, edit by edit. The memory is used again.
#[derive(Debug, Default)]
pub(crate) struct Near {
    groups: Vec<Group>,
    spans: Vec<Span>,
    /// Arcs by their places in their edits.
    arcs: Vec<u32>,
    /// Points with the addresses of the lists of their leaves; the points of one leaf.
    points: Vec<(usize, u32)>,
    own: Vec<u32>,
}

impl Near {
    /// Looks at the pieces of a leaf of the index, near some points.
    fn refill(&mut self, list: &[u32], roster: &Roster, dirs: &[DVec3], points: &[u32]) {
        self.groups.clear();
        self.spans.clear();
        self.arcs.clear();
        let own = || points.iter().filter_map(|point| dirs.get(*point as usize));
        let Some(&first) = own().next() else { return };
        let middle = own().sum::<DVec3>().normalize_or(first);
        let chord2 = own().map(|dir| dir.distance_squared(middle)).fold(0.0, f64::max);
        let chord = chord2.sqrt() * (1.0 + 1e-9);
        let mut last = None;
        for &number in list {
            let slot = slot_of(number);
            let (Some(piece), Some(edit)) = (roster.piece(number), roster.edit(slot)) else { continue };
            if !may_touch((piece.middle, piece.chord), (middle, chord)) {
                continue;
            }
            let before = self.arcs.len() as u32;
            let all = piece.first..piece.first + piece.count;
            if points.len() < LEAST_POINTS {
                self.arcs.extend(all);
            } else {
                self.arcs.extend(all.filter(|arc| edit.may_reach(*arc, middle, chord)));
            }
            let arcs = before..self.arcs.len() as u32;
            if arcs.is_empty() {
                continue;
            }
            self.spans.push(Span { middle: piece.middle, chord2: piece.chord * piece.chord, arcs });
            let end = self.spans.len() as u32;
            match self.groups.last_mut().filter(|_| last == Some(slot) && !edit.is_stamp()) {
                Some(group) => group.spans.end = end,
                None => self.groups.push(Group { slot, spans: end - 1..end }),
            }
            last = Some(slot);
        }
    }

    /// The edits near, in order, by their slots, each with its arcs. A stamp comes once for each place.
    pub(super) fn groups(&self) -> impl Iterator<Item = (u32, Arcs<'_>)> {
        let spans = |group: &Group| &self.spans[group.spans.start as usize..group.spans.end as usize];
        self.groups.iter().map(move |group| (group.slot, Arcs { spans: spans(group), arcs: &self.arcs }))
    }

    /// Calls `each` with the points of each leaf that has pieces, by their numbers, and with what is near them.
    pub(super) fn each_leaf(
        &mut self,
        mut walk: Walk<'_>,
        roster: &Roster,
        dirs: &[DVec3],
        mut each: impl FnMut(&[u32], &Self),
    ) {
        let mut points = std::mem::take(&mut self.points);
        points.clear();
        for (point, dir) in dirs.iter().enumerate() {
            let list = walk.leaf(*dir);
            if !list.is_empty() {
                points.push((list.as_ptr() as usize, point as u32));
            }
        }
        // Rows of a tile go through the same few leaves again and again. The order of leaves changes no result.
        if points.iter().any(|point| point.0 != points[0].0) {
            points.sort_unstable();
        }
        for own in points.chunk_by(|a, b| a.0 == b.0) {
            let Some(&dir) = own.first().and_then(|(_, point)| dirs.get(*point as usize)) else { continue };
            let list = walk.leaf(dir);
            let mut numbers = std::mem::take(&mut self.own);
            numbers.clear();
            numbers.extend(own.iter().map(|(_, point)| *point));
            self.refill(list, roster, dirs, &numbers);
            if !self.groups.is_empty() {
                each(&numbers, self);
            }
            self.own = numbers;
        }
        self.points = points;
    }
}

/// The arcs of an edit near some points.
#[derive(Clone, Copy, Debug)]
pub(super) struct Arcs<'a> {
    spans: &'a [Span],
    arcs: &'a [u32],
}

impl Arcs<'_> {
    /// Those of the pieces that hold a direction.
    #[inline]
    pub(super) fn at(&self, dir: DVec3) -> impl Iterator<Item = u32> {
        let holding = self.spans.iter().filter(move |span| span.middle.distance_squared(dir) <= span.chord2);
        holding.flat_map(|span| &self.arcs[span.arcs.start as usize..span.arcs.end as usize]).copied()
    }
}
