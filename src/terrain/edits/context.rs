//! What edits that read the ground depend on besides their own numbers: the edits before them that are near. It is part
//! of their content, so that tiles are built again when one of those changes.

use super::Subject;
use super::compiled::CompiledEdit;
use super::index::{Hash, Index, Piece};
use super::memory::LatticeKey;
use super::path::angle_of;
use super::reading::Reader;
use super::roster::{Changes, Roster, slot_of};
use glam::DVec3;
use std::collections::HashSet;
use std::sync::Arc;

/// Most sources of an edit: a node that none of the latest surrounds is evaluated from the layers on.
const MOST_SOURCES: usize = 64;

/// What an edit that reads the ground depends on besides its own numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Context {
    /// Hash of the edits before it that are near; part of the hashes of its pieces.
    hash: u128,
    /// Slots of those that read the ground at the nodes of the same lattice, the latest first: the ground before the
    /// edit is evaluated from there on.
    pub(super) sources: Vec<u32>,
}

impl CompiledEdit {
    /// The edit in another context, which is part of the content of its pieces. None if that is its context already.
    fn in_context(&self, context: Context) -> Option<Self> {
        if context == self.context {
            return None;
        }
        let (old, new) = (self.context.hash, context.hash);
        let mut next = self.clone();
        next.context = context;
        next.pieces.iter_mut().for_each(|piece| piece.hash ^= old ^ new);
        Some(next)
    }

    /// Tells its lattices from those of other edits and of other ground. Points that are added to a line leave it, as
    /// long as no other edit comes near. Edits at different places may have the same key: see
    /// [`CompiledEdit::surrounds`].
    pub(super) fn lattice_key(&self) -> LatticeKey {
        let (mut key, context) = (Hash(self.own), self.context.hash);
        [context as u64, (context >> 64) as u64].into_iter().for_each(|word| key.add(word));
        key.0
    }

    /// Whether its context holds every earlier edit that reaches a direction.
    pub(super) fn surrounds(&self, dir: DVec3) -> bool {
        let Some(reader) = self.reader() else { return false };
        let reach = 2.0 * libm::sin(0.5 * reader.reach_rad().min(std::f64::consts::PI));
        self.pieces.iter().any(|piece| {
            let wide = piece.chord.min(2.0);
            // The chord of the sum of two angles.
            let within =
                wide * (1.0 - 0.25 * reach * reach).max(0.0).sqrt() + reach * (1.0 - 0.25 * wide * wide).sqrt();
            let is_whole = wide * wide + reach * reach >= 4.0;
            is_whole || piece.middle.distance_squared(dir) < within * within * (1.0 - 1e-9)
        })
    }
}

/// Finds anew the content of the edits that read the ground where something changed. Returns these as changes.
/// `ground`, `masks`: the indices of the roster after `changes`. Painted masks change the layers, so that their order
/// does not count.
pub(super) fn refresh(roster: &mut Roster, [ground, masks]: [&Index; 2], changes: &Changes) -> Changes {
    let reading: Vec<(u32, Arc<CompiledEdit>)> = roster.reading().map(|(slot, edit)| (slot, edit.clone())).collect();
    let mut refreshed = Changes::default();
    if reading.is_empty() {
        return refreshed;
    }
    let new = changes.added.iter().filter_map(|slot| roster.edit(*slot).cloned());
    let old = changes.removed.iter().map(|(_, edit)| edit.clone());
    let mut changed: Vec<Arc<CompiledEdit>> =
        new.chain(old).filter(|edit| edit.changes(Subject::Ground) || edit.changes(Subject::Masks)).collect();
    for (slot, edit) in reading {
        let Some(reach_rad) = edit.reader().map(Reader::reach_rad) else { continue };
        let chord = reach_rad * (1.0 + 1e-9);
        let touches = |piece: &Piece, other: &Piece| other.touches(piece.middle, piece.chord + chord);
        let is_changed = changes.added.contains(&slot)
            || changed
                .iter()
                .any(|other| other.pieces.iter().any(|other| edit.pieces.iter().any(|piece| touches(piece, other))));
        if !is_changed {
            continue;
        }
        let before = near_before(&edit, slot, reach_rad, roster, [ground, masks]);
        let mut context = Hash::default();
        for piece in before.iter().filter_map(|number| roster.piece(*number)) {
            context.add(piece.hash as u64);
            context.add((piece.hash >> 64) as u64);
        }
        let context = Context { hash: context.0, sources: sources_of(&edit, &before, roster) };
        if let Some(next) = edit.in_context(context) {
            let next = Arc::new(next);
            roster.replace(slot, next.clone());
            changed.push(next);
            refreshed.removed.push((slot, edit));
            refreshed.added.push(slot);
        }
    }
    refreshed
}

/// The pieces of edits before an edit, and of masks, that are near it, in order.
fn near_before(
    edit: &CompiledEdit,
    slot: u32,
    reach_rad: f64,
    roster: &Roster,
    [ground, masks]: [&Index; 2],
) -> Vec<u32> {
    let is_before = |number: &u32| roster.rank_of(slot_of(*number)) < roster.rank_of(slot);
    // The pieces of the edit share most leaves, and those most pieces.
    let (mut leaves, mut listed) = (HashSet::new(), Vec::new());
    for piece in &edit.pieces {
        let disc = Some((piece.middle, piece.chord + reach_rad * (1.0 + 1e-9)));
        ground.each_leaf(disc, &mut |numbers| {
            if leaves.insert(numbers.as_ptr()) {
                listed.extend(numbers.iter().copied().filter(is_before));
            }
        });
        masks.each_leaf(disc, &mut |numbers| {
            if leaves.insert(numbers.as_ptr()) {
                listed.extend_from_slice(numbers);
            }
        });
    }
    listed.sort_unstable();
    listed.dedup();
    let own: Vec<(DVec3, f64)> =
        edit.pieces.iter().map(|piece| (piece.middle, radius_rad(piece) + reach_rad)).collect();
    listed.retain(|number| roster.piece(*number).is_some_and(|other| overlaps(&own, other)));
    listed.sort_unstable_by_key(|number| roster.rank(*number));
    listed
}

/// The slots of the sources of an edit among pieces that are near and before it, in order.
fn sources_of(edit: &CompiledEdit, before: &[u32], roster: &Roster) -> Vec<u32> {
    let lattice = edit.reader().map(Reader::lattice);
    let mut slots: Vec<u32> = before.iter().map(|number| slot_of(*number)).collect();
    slots.dedup();
    let is_same = |earlier: &CompiledEdit| lattice.is_some() && earlier.reader().map(Reader::lattice) == lattice;
    slots.retain(|slot| roster.edit(*slot).is_some_and(|earlier| is_same(earlier)));
    slots.into_iter().rev().take(MOST_SOURCES).collect()
}

/// Whether a piece overlaps one of some discs. Exact, unlike the test that the index uses: the cells of the index
/// depend on earlier revisions, and the context must not.
fn overlaps(discs: &[(DVec3, f64)], piece: &Piece) -> bool {
    let own_rad = radius_rad(piece);
    discs.iter().any(|(middle, wide_rad)| angle_of(middle.distance_squared(piece.middle)) <= own_rad + wide_rad)
}

fn radius_rad(piece: &Piece) -> f64 {
    angle_of(piece.chord * piece.chord)
}
