//! Which pieces of edits are near: a quadtree over the squares of the sphere. Each cell lists the pieces that touch
//! it, in the order in which they act; a leaf has few, or cannot be split with profit. A change of a few edits makes
//! new cells only where they are; all others are shared with the revision before.

use super::compiled::CompiledEdit;
use super::roster::{Changes, Roster, number, slot_of};
use super::widening::Widening;
use crate::planet::Key;
use crate::sphere::NodeId;
use glam::{DVec3, Vec3};
use std::ops::Range;
use std::sync::Arc;

/// Pieces that a leaf may have before it is split.
const LEAF: usize = 16;
/// Finest level of a leaf.
const FINEST: u8 = 18;
/// A cell is not split if its quarters together would list more than this many times its pieces.
const WORTH: usize = 3;
/// Cells count as larger than they are: tiles read the ground a little beyond their edges.
const MARGIN: f64 = 1.1;

/// Some arcs of an edit, within a disc that also holds all ground that they change.
#[derive(Clone, Copy, Debug)]
pub(super) struct Piece {
    /// Its arcs among those of the edit.
    pub(super) first: u32,
    pub(super) count: u32,
    /// Middle of the disc.
    pub(super) middle: DVec3,
    /// Chord from the middle to the edge of the disc.
    pub(super) chord: f64,
    /// Hash of all that the piece does.
    pub(super) hash: u128,
}

impl Piece {
    /// Whether the disc may touch another one.
    pub(super) fn touches(&self, dir: DVec3, chord: f64) -> bool {
        may_touch((self.middle, self.chord), (dir, chord))
    }
}

/// A disc, a little larger, in few bytes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Disc {
    middle: Vec3,
    chord: f32,
}

impl Disc {
    /// More than positions on the unit sphere and sums of squares lose by rounding to f32.
    const ROUNDING: f32 = 1e-6;

    pub(super) fn new(middle: DVec3, chord: f64) -> Self {
        Self { middle: middle.as_vec3(), chord: chord as f32 * (1.0 + Self::ROUNDING) + Self::ROUNDING }
    }

    /// Whether two discs may touch.
    #[inline]
    pub(super) fn may_touch(&self, other: &Self) -> bool {
        let sum = self.chord + other.chord;
        self.middle.distance_squared(other.middle) <= sum * sum
    }
}

/// A piece in a leaf: all that tells whether it is near. Points far apart look at many leaves, and what is not in the
/// leaf itself is not in the cache.
#[derive(Clone, Copy, Debug)]
pub(super) struct Listed {
    pub(super) disc: Disc,
    pub(super) slot: u32,
    /// Its arcs among those of the edit; they are few.
    first: u32,
    count: u16,
    /// Whether the piece acts for itself, as the places of a stamp do.
    pub(super) is_alone: bool,
}

impl Listed {
    fn new(number: u32, roster: &Roster) -> Option<Self> {
        let (edit, piece) = (roster.edit(slot_of(number))?, roster.piece(number)?);
        let disc = Disc::new(piece.middle, piece.chord);
        let (first, count) = (piece.first, piece.count as u16);
        Some(Self { disc, slot: slot_of(number), first, count, is_alone: edit.is_stamp() })
    }

    /// Its arcs among those of the edit.
    pub(super) fn arcs(&self) -> Range<u32> {
        self.first..self.first + u32::from(self.count)
    }
}

/// Chord of an angle, a little larger, for rounding. That of half a turn and more reaches everywhere.
pub(crate) fn chord_of(angle_rad: f64) -> f64 {
    if angle_rad >= std::f64::consts::PI {
        return 3.0;
    }
    2.0 * libm::sin(0.5 * angle_rad) * (1.0 + 1e-9) + 1e-12
}

/// Whether two discs may touch: the chord of a sum of angles is at most the sum of their chords.
pub(super) fn may_touch(a: (DVec3, f64), b: (DVec3, f64)) -> bool {
    let sum = a.1 + b.1;
    a.0.distance_squared(b.0) <= sum * sum
}

/// Whether a piece touches a disc, given by its middle and chord, and belongs to some edits.
fn counts(
    roster: &Roster,
    number: u32,
    (middle, chord): (DVec3, f64),
    wanted: &impl Fn(&CompiledEdit) -> bool,
) -> bool {
    roster.piece(number).is_some_and(|piece| piece.touches(middle, chord))
        && roster.edit(slot_of(number)).is_some_and(|edit| wanted(edit))
}

/// The disc around a node: its middle, and the chord to its edge.
fn disc_of(id: NodeId) -> (DVec3, f64) {
    let middle = id.direction(0.5, 0.5);
    let corners = [(0.0, 0.0), (1.0, 0.0), (0.0, 1.0), (1.0, 1.0)];
    let chord2 = corners.map(|(u, v)| id.direction(u, v).distance_squared(middle)).into_iter().fold(0.0, f64::max);
    (middle, chord2.sqrt() * MARGIN)
}

/// A cell and the pieces that touch it. Revisions share the cells that did not change. Points on their way to leaves
/// read the first fields alone.
#[derive(Debug, Default)]
#[repr(C)]
pub(super) struct Cell {
    /// None for a leaf. A cell without pieces is a leaf.
    quarters: Option<[Arc<Cell>; 4]>,
    /// Pieces of a leaf; empty in other cells.
    listed: Vec<Listed>,
    /// Numbers of its pieces, in the order in which they act.
    list: Vec<u32>,
    /// Hash of its pieces.
    hash: u128,
    /// What its pieces do to the bounds of heights: of a leaf in order, else the widest of the quarters.
    range: Widening,
}

/// The quadtree: the cells of the six faces.
#[derive(Clone, Debug, Default)]
pub(super) struct Index {
    faces: [Arc<Cell>; 6],
}

/// Pieces to be taken out and put in, each in the order in which they act.
struct Change<'a> {
    roster: &'a Roster,
    removed: Vec<(u32, &'a Piece)>,
    added: Vec<(u32, &'a Piece)>,
}

impl<'a> Change<'a> {
    /// The part of the change that touches a disc. None if nothing does.
    fn near(&self, (middle, chord): (DVec3, f64)) -> Option<Change<'a>> {
        let near = |pieces: &[(u32, &'a Piece)]| -> Vec<_> {
            pieces.iter().copied().filter(|(_, piece)| piece.touches(middle, chord)).collect()
        };
        let (removed, added) = (near(&self.removed), near(&self.added));
        let some = !removed.is_empty() || !added.is_empty();
        some.then_some(Change { roster: self.roster, removed, added })
    }

    /// The list after the change.
    fn applied(&self, list: &[u32]) -> Vec<u32> {
        let mut gone: Vec<u32> = self.removed.iter().map(|(number, _)| *number).collect();
        gone.sort_unstable();
        let mut next = Vec::with_capacity(list.len() + self.added.len());
        let mut added = self.added.iter().map(|(number, _)| *number).peekable();
        let stays = |number: &&u32| gone.is_empty() || gone.binary_search(number).is_err();
        for &number in list.iter().filter(stays) {
            while let Some(first) = added.next_if(|first| self.roster.rank(*first) < self.roster.rank(number)) {
                next.push(first);
            }
            next.push(number);
        }
        next.extend(added);
        next
    }
}

impl Index {
    /// The index of the same roster after changes. `wanted`: which edits the index lists.
    pub(super) fn next(&self, roster: &Roster, changes: &Changes, wanted: impl Fn(&CompiledEdit) -> bool) -> Self {
        let mut change = Change { roster, removed: Vec::new(), added: Vec::new() };
        for (slot, edit) in changes.removed.iter().filter(|(_, edit)| wanted(edit)) {
            change.removed.extend(edit.pieces.iter().enumerate().map(|(i, piece)| (number(*slot, i), piece)));
        }
        for slot in &changes.added {
            if let Some(edit) = roster.edit(*slot).filter(|edit| wanted(edit)) {
                change.added.extend(edit.pieces.iter().enumerate().map(|(i, piece)| (number(*slot, i), piece)));
            }
        }
        let mut faces = self.faces.clone();
        for (id, face) in NodeId::roots().into_iter().zip(&mut faces) {
            if let Some(near) = change.near(disc_of(id)) {
                *face = face.next(id, &near);
            }
        }
        Self { faces }
    }

    /// The cell of a face.
    pub(super) fn face(&self, face: usize) -> &Cell {
        &self.faces[face]
    }

    /// Whether it lists no piece.
    pub(super) fn is_empty(&self) -> bool {
        self.faces.iter().all(|face| face.list.is_empty())
    }

    /// What its pieces do to the bounds of heights anywhere.
    pub(super) fn range(&self) -> Widening {
        self.faces.iter().map(|face| face.range).fold(Widening::default(), Widening::or)
    }

    /// The key of all pieces.
    pub(super) fn key_of_all(&self) -> Key {
        Key::of(&self.faces.each_ref().map(|face| face.hash))
    }

    /// The smallest cell that holds a node, and whether it is the node's own.
    fn cell_of(&self, id: NodeId) -> Option<(&Cell, bool)> {
        let mut cell: &Cell = self.faces.get(id.face as usize)?;
        for shift in (0..id.level).rev() {
            let Some(quarters) = &cell.quarters else { return Some((cell, false)) };
            cell = &quarters[(id.x >> shift & 1) as usize + 2 * (id.y >> shift & 1) as usize];
        }
        Some((cell, true))
    }

    /// The key of the pieces that touch a node; None if none does.
    pub(super) fn key_near(&self, id: NodeId, roster: &Roster) -> Option<Key> {
        let (cell, is_own) = self.cell_of(id)?;
        if is_own {
            (!cell.list.is_empty()).then(|| Key::of(&cell.hash))
        } else {
            self.key_of_some(id, roster, |_| true)
        }
    }

    /// The key of those pieces that touch a node and belong to some edits; None if none does.
    pub(super) fn key_of_some(
        &self,
        id: NodeId,
        roster: &Roster,
        wanted: impl Fn(&CompiledEdit) -> bool,
    ) -> Option<Key> {
        let near: Vec<u32> = self.pieces_of_some(id, roster, wanted).collect();
        (!near.is_empty()).then(|| Key::of(&hash(&near, roster)))
    }

    /// The key of those pieces that touch a disc and belong to some edits; None if none does.
    #[cfg(feature = "render")]
    pub(super) fn key_in(
        &self,
        disc: (DVec3, f64),
        roster: &Roster,
        wanted: impl Fn(&CompiledEdit) -> bool,
    ) -> Option<Key> {
        let mut near = Vec::new();
        let counts = |number: &u32| counts(roster, *number, disc, &wanted);
        self.each_leaf(Some(disc), &mut |pieces| near.extend(pieces.iter().copied().filter(counts)));
        near.sort_unstable_by_key(|number| roster.rank(*number));
        near.dedup();
        (!near.is_empty()).then(|| Key::of(&hash(&near, roster)))
    }

    /// The pieces that touch a node and belong to some edits, in the order in which they act.
    pub(super) fn pieces_of_some(
        &self,
        id: NodeId,
        roster: &Roster,
        wanted: impl Fn(&CompiledEdit) -> bool,
    ) -> impl Iterator<Item = u32> {
        let listed = self.cell_of(id).map(|(cell, _)| &cell.list).filter(|list| !list.is_empty());
        let listed = listed.map(|list| (list, disc_of(id))).into_iter();
        let pieces = listed.flat_map(|(list, disc)| list.iter().map(move |number| (*number, disc)));
        pieces.filter(move |(number, disc)| counts(roster, *number, *disc, &wanted)).map(|(number, _)| number)
    }

    /// Calls `found` with the list of each leaf that may touch a disc, given by its middle and chord (None: of every
    /// leaf).
    pub(super) fn each_leaf(&self, near: Option<(DVec3, f64)>, found: &mut dyn FnMut(&[u32])) {
        let mut open: Vec<(NodeId, &Cell)> = NodeId::roots().into_iter().zip(self.faces.iter().map(|c| &**c)).collect();
        while let Some((id, cell)) = open.pop() {
            let is_near = near.is_none_or(|disc| may_touch(disc_of(id), disc));
            if cell.list.is_empty() || !is_near {
                continue;
            }
            match &cell.quarters {
                None => found(&cell.list),
                Some(quarters) => open.extend(id.children().into_iter().zip(quarters.iter().map(|c| &**c))),
            }
        }
    }
}

impl Cell {
    /// The pieces of a leaf, in the order in which they act.
    pub(super) fn listed(&self) -> &[Listed] {
        &self.listed
    }

    /// Its quarters: `s` grows first, then `t`. None for a leaf.
    pub(super) fn quarters(&self) -> Option<&[Arc<Self>; 4]> {
        self.quarters.as_ref()
    }

    /// The cell of a node with these pieces, split as far as that pays.
    fn new(id: NodeId, list: Vec<u32>, roster: &Roster) -> Arc<Self> {
        let hash = hash(&list, roster);
        let mut cell = Self { list, hash, ..Self::default() };
        cell.split(id, roster);
        Arc::new(cell.finished(roster))
    }

    fn split(&mut self, id: NodeId, roster: &Roster) {
        if self.list.len() <= LEAF || id.level >= FINEST {
            return;
        }
        let children = id.children();
        let lists = children.map(|child| {
            let (middle, chord) = disc_of(child);
            let touches = |number: &u32| roster.piece(*number).is_some_and(|piece| piece.touches(middle, chord));
            self.list.iter().copied().filter(touches).collect::<Vec<u32>>()
        });
        if lists.iter().map(Vec::len).sum::<usize>() > WORTH * self.list.len() {
            return;
        }
        let mut quarters = [const { None }; 4];
        for ((child, list), quarter) in children.into_iter().zip(lists).zip(&mut quarters) {
            *quarter = Some(Self::new(child, list, roster));
        }
        if let [Some(a), Some(b), Some(c), Some(d)] = quarters {
            self.quarters = Some([a, b, c, d]);
        }
    }

    /// The cell after a change that touches it.
    fn next(&self, id: NodeId, change: &Change<'_>) -> Arc<Self> {
        let list = change.applied(&self.list);
        let mut next = Self { hash: hash(&list, change.roster), list, ..Self::default() };
        match &self.quarters {
            Some(quarters) if next.list.len() > LEAF => {
                let mut quarters = quarters.clone();
                for (child, quarter) in id.children().into_iter().zip(&mut quarters) {
                    if let Some(near) = change.near(disc_of(child)) {
                        *quarter = quarter.next(child, &near);
                    }
                }
                next.quarters = Some(quarters);
            }
            _ => next.split(id, change.roster),
        }
        Arc::new(next.finished(change.roster))
    }

    /// With what follows from its list and its quarters.
    fn finished(self, roster: &Roster) -> Self {
        if let Some(quarters) = &self.quarters {
            let range = quarters.iter().map(|quarter| quarter.range).fold(Widening::default(), Widening::or);
            return Self { range, ..self };
        }
        let listed = self.list.iter().filter_map(|number| Listed::new(*number, roster)).collect();
        Self { range: range_of(&self.list, roster, |_| true), listed, ..self }
    }
}

/// What pieces in order do to the bounds of heights, of those that are near.
pub(super) fn range_of(list: &[u32], roster: &Roster, is_near: impl Fn(&Piece) -> bool) -> Widening {
    let (mut range, mut last) = (Widening::default(), None);
    for &number in list {
        let slot = slot_of(number);
        let Some(edit) = roster.edit(slot).filter(|_| roster.piece(number).is_some_and(&is_near)) else { continue };
        // The pieces of a line act once.
        if last != Some(slot) || edit.is_stamp() {
            range = range.then(edit.range);
        }
        last = Some(slot);
    }
    range
}

/// A hash of pieces in order, by what they do. Where one edit ends and the next begins counts, too.
fn hash(list: &[u32], roster: &Roster) -> u128 {
    // As a cell that never had a piece.
    if list.is_empty() {
        return 0;
    }
    let (mut hash, mut last) = (Hash::default(), None);
    for &number in list {
        let slot = slot_of(number);
        hash.add(u64::from(last != Some(slot)));
        if let Some(piece) = roster.piece(number) {
            hash.add(piece.hash as u64);
            hash.add((piece.hash >> 64) as u64);
        }
        last = Some(slot);
    }
    hash.0
}

/// A hash of numbers.
#[derive(Clone, Copy, Debug)]
pub(super) struct Hash(pub(super) u128);

impl Default for Hash {
    fn default() -> Self {
        Self(0x6c62_272e_07bb_0142_62b8_2175_6295_c58d)
    }
}

impl Hash {
    /// Adds a number.
    pub(super) fn add(&mut self, word: u64) {
        let mixed = (self.0 ^ u128::from(word)).wrapping_mul(0x2360_ED05_1FC6_5DA4_4385_DF64_9FCC_F645);
        self.0 = mixed ^ (mixed >> 71);
    }

    /// Adds a number by its bits.
    pub(super) fn add_f64(&mut self, value: f64) {
        self.add(value.to_bits());
    }
}
