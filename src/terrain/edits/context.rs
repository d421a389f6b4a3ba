//! What edits that read the ground depend on besides their own numbers: the edits before them that are near. It is part
//! of their content, so that tiles are built again when one of those changes.

use super::compiled::CompiledEdit;
use super::index::{Hash, Index, Piece};
use super::memory::LatticeKey;
use super::paint::Paint;
use super::path::angle_of;
use super::reading::Reader;
use super::roster::{Changes, Roster, slot_of};
use glam::DVec3;
use std::collections::HashSet;
use std::sync::Arc;

/// Most sources of an edit: a node that none of the latest knows is evaluated from the layers on.
const MOST_SOURCES: usize = 64;

/// What an edit that reads the ground depends on besides its own numbers.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Context {
    /// Hash of the edits before it that are near; part of the hashes of its pieces.
    hash: u128,
    /// Those of them that read the ground at the nodes of the same lattice, the latest first.
    pub(super) sources: Vec<Source>,
}

/// An earlier edit. The ground before it, at the nodes that it knows, is where the ground before a later one begins.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Source {
    pub(super) slot: u32,
    pub(super) lattice: LatticeKey,
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
        let Some(reach_rad) = self.reader.as_ref().map(Reader::reach_rad) else { return false };
        self.pieces.iter().any(|piece| {
            let within_rad = (radius_rad(piece) + reach_rad) * (1.0 - 1e-9);
            angle_of(piece.middle.distance_squared(dir)) < within_rad
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
        new.chain(old).filter(|edit| edit.paint().is_none_or(Paint::is_mask)).collect();
    for (slot, edit) in reading {
        let Some(reach_rad) = edit.reader.as_ref().map(Reader::reach_rad) else { continue };
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

/// The sources of an edit among pieces that are near and before it, in order.
fn sources_of(edit: &CompiledEdit, before: &[u32], roster: &Roster) -> Vec<Source> {
    let Some(lattice) = edit.reader.as_ref().map(Reader::lattice) else { return Vec::new() };
    let mut slots: Vec<u32> = before.iter().map(|number| slot_of(*number)).collect();
    slots.dedup();
    let source = |slot: u32| {
        let earlier = roster.edit(slot)?;
        let is_same = earlier.reader.as_ref().map(Reader::lattice) == Some(lattice);
        is_same.then(|| Source { slot, lattice: earlier.lattice_key() })
    };
    slots.into_iter().rev().filter_map(source).take(MOST_SOURCES).collect()
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
