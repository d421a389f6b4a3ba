//! The edits that are on, compiled, in the order in which they act. Each has a slot, which it keeps from one revision
//! to the next, so that the index changes only where edits changed.

use super::compiled::CompiledEdit;
use super::index::Piece;
use crate::planet::GroundEdits;
use crate::planet::edits::Shared;
use std::collections::HashMap;
use std::sync::Arc;

/// Bits of the number of a piece that tell its place in its edit; the others tell the slot.
const PIECE_BITS: u32 = 12;
/// Most pieces of an edit.
pub(super) const MOST_PIECES: usize = 1 << PIECE_BITS;

/// An edit of the list that is on.
#[derive(Clone, Debug)]
struct Entry {
    shared: Arc<Shared>,
    slot: u32,
    /// Whether it reads the ground around a point.
    reads: bool,
    /// Whether a mask decides where its copies lie.
    scatters: bool,
}

/// The edits that are on.
#[derive(Clone, Debug, Default)]
pub(super) struct Roster {
    /// In the order in which they act.
    entries: Vec<Entry>,
    slots: Vec<Option<Arc<CompiledEdit>>>,
    /// The place in the order, for each slot.
    ranks: Vec<u32>,
    free: Vec<u32>,
}

/// What is different from one roster to the next. An edit that was moved is removed and added.
#[derive(Debug, Default)]
pub(super) struct Changes {
    /// The edits that are gone, with the slots that they had.
    pub(super) removed: Vec<(u32, Arc<CompiledEdit>)>,
    /// Slots of new edits, in order.
    pub(super) added: Vec<u32>,
}

/// The number of a piece: its slot and its place in the edit.
pub(super) fn number(slot: u32, piece: usize) -> u32 {
    slot << PIECE_BITS | piece as u32
}

/// The slot of a piece.
pub(super) fn slot_of(number: u32) -> u32 {
    number >> PIECE_BITS
}

impl Changes {
    /// Whether there are none.
    pub(super) fn is_empty(&self) -> bool {
        self.removed.is_empty() && self.added.is_empty()
    }
}

impl Roster {
    /// The roster of the edits that are on, and what is different from the one before.
    pub(super) fn next(
        &self,
        list: &GroundEdits,
        compile: impl Fn(&Arc<Shared>) -> Arc<CompiledEdit>,
    ) -> (Self, Changes) {
        let acts = |shared: &&Arc<Shared>| shared.edit.enabled && !shared.edit.points.0.is_empty();
        let list: Vec<&Arc<Shared>> = list.shared().iter().filter(acts).collect();
        // Most edits are the same ones in the same order.
        let same = |(entry, shared): &(&Entry, &&Arc<Shared>)| Arc::ptr_eq(&entry.shared, shared);
        let before = self.entries.iter().zip(&list).take_while(same).count();
        let most_after = self.entries.len().min(list.len()) - before;
        let pairs = self.entries.iter().rev().zip(list.iter().rev());
        let after = pairs.take(most_after).take_while(same).count();
        let old = before..self.entries.len() - after;
        let known: HashMap<usize, usize> = old.clone().map(|at| (address(&self.entries[at].shared), at)).collect();
        let new: Vec<(&Arc<Shared>, Option<usize>)> = list[before..list.len() - after]
            .iter()
            .map(|shared| (*shared, known.get(&address(shared)).copied()))
            .collect();
        let in_order = rising(&new.iter().map(|(_, at)| *at).collect::<Vec<_>>());

        let mut next = self.clone();
        let mut changes = Changes::default();
        let mut stays = vec![false; old.len()];
        for at in new.iter().zip(&in_order).filter(|(_, stays)| **stays).filter_map(|((_, at), _)| *at) {
            stays[at - before] = true;
        }
        for at in old.clone().filter(|at| !stays[at - before]) {
            let slot = self.entries[at].slot;
            if let Some(edit) = next.slots[slot as usize].take() {
                changes.removed.push((slot, edit));
            }
        }
        let middle: Vec<Entry> = new
            .iter()
            .zip(&in_order)
            .map(|((shared, at), stays)| match (at, stays) {
                (Some(at), true) => self.entries[*at].clone(),
                _ => {
                    let moved = at.and_then(|at| self.slots[self.entries[at].slot as usize].clone());
                    let slot = next.take_slot(moved.unwrap_or_else(|| compile(shared)));
                    changes.added.push(slot);
                    let (reads, scatters) = (shared.edit.tool.reads_ground(), shared.edit.is_scattered());
                    Entry { shared: (*shared).clone(), slot, reads, scatters }
                }
            })
            .collect();
        // Slots become free after the new ones are taken: the index tells removed pieces by their numbers.
        next.free.extend(changes.removed.iter().map(|(slot, _)| *slot));
        next.entries.splice(old, middle);
        next.ranks.resize(next.slots.len(), 0);
        for (rank, entry) in next.entries.iter().enumerate() {
            next.ranks[entry.slot as usize] = rank as u32;
        }
        (next, changes)
    }

    fn take_slot(&mut self, edit: Arc<CompiledEdit>) -> u32 {
        match self.free.pop() {
            Some(slot) => {
                self.slots[slot as usize] = Some(edit);
                slot
            }
            None => {
                self.slots.push(Some(edit));
                self.slots.len() as u32 - 1
            }
        }
    }

    /// The edits that are on, in order.
    pub(super) fn shared(&self) -> impl Iterator<Item = &Arc<Shared>> {
        self.entries.iter().map(|entry| &entry.shared)
    }

    /// How many edits are on.
    pub(super) fn len(&self) -> usize {
        self.entries.len()
    }

    /// The edit of a slot.
    #[inline]
    pub(super) fn edit(&self, slot: u32) -> Option<&Arc<CompiledEdit>> {
        self.slots.get(slot as usize)?.as_ref()
    }

    /// Puts another form of an edit into its slot.
    pub(super) fn replace(&mut self, slot: u32, edit: Arc<CompiledEdit>) {
        if let Some(place) = self.slots.get_mut(slot as usize) {
            *place = Some(edit);
        }
    }

    /// The place in the order of the edit in a slot.
    #[inline]
    pub(super) fn rank_of(&self, slot: u32) -> u32 {
        self.ranks.get(slot as usize).copied().unwrap_or(0)
    }

    /// The edits whose copies are scattered over a mask, in order, with their slots.
    pub(super) fn scattered(&self) -> Vec<(u32, Arc<Shared>)> {
        let scattered = self.entries.iter().filter(|entry| entry.scatters);
        scattered.map(|entry| (entry.slot, entry.shared.clone())).collect()
    }

    /// The edits that are on, compiled, in order.
    pub(super) fn edits(&self) -> impl Iterator<Item = &Arc<CompiledEdit>> {
        self.entries.iter().filter_map(|entry| self.edit(entry.slot))
    }

    /// The edits that read the ground around a point, in order, with their slots.
    pub(super) fn reading(&self) -> impl Iterator<Item = (u32, &Arc<CompiledEdit>)> {
        let reading = self.entries.iter().filter(|entry| entry.reads);
        reading.filter_map(|entry| Some((entry.slot, self.edit(entry.slot)?)))
    }

    /// A piece by its number.
    #[inline]
    pub(super) fn piece(&self, number: u32) -> Option<&Piece> {
        let place = number as usize & (MOST_PIECES - 1);
        self.edit(slot_of(number))?.pieces.get(place)
    }

    /// What pieces are sorted by.
    pub(super) fn rank(&self, number: u32) -> (u32, u32) {
        (self.rank_of(slot_of(number)), number & (MOST_PIECES as u32 - 1))
    }
}

fn address(shared: &Arc<Shared>) -> usize {
    Arc::as_ptr(shared) as usize
}

/// Marks a longest rising series of numbers.
fn rising(numbers: &[Option<usize>]) -> Vec<bool> {
    // The places that end the best series of each length (patience sorting); what comes before each place.
    let (mut ends, mut before): (Vec<usize>, Vec<Option<usize>>) = (Vec::new(), vec![None; numbers.len()]);
    for (place, number) in numbers.iter().enumerate().filter(|(_, number)| number.is_some()) {
        let length = ends.partition_point(|end| numbers[*end] < *number);
        before[place] = length.checked_sub(1).map(|shorter| ends[shorter]);
        match ends.get_mut(length) {
            Some(end) => *end = place,
            None => ends.push(place),
        }
    }
    let mut marked = vec![false; numbers.len()];
    let mut place = ends.last().copied();
    while let Some(at) = place {
        marked[at] = true;
        place = before[at];
    }
    marked
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_longest_rising_series_is_found() {
        let marked = |numbers: &[usize]| {
            let numbers: Vec<Option<usize>> = numbers.iter().map(|n| (*n < 90).then_some(*n)).collect();
            rising(&numbers).iter().filter(|marked| **marked).count()
        };
        assert_eq!(marked(&[]), 0);
        assert_eq!(marked(&[1, 2, 3, 4]), 4);
        assert_eq!(marked(&[2, 3, 4, 1]), 3);
        assert_eq!(marked(&[4, 1, 99, 2, 3]), 3);
        assert_eq!(marked(&[4, 3, 2, 1]), 1);
    }
}
