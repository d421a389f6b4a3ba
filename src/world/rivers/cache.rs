//! Blocks that were built, kept for all threads. What is kept changes no answer.
//!
//! Points that lie close together share blocks. Points that are spread over the planet, such as the people of a game,
//! would need more blocks than memory holds: they have the pieces near their cell alone, a spot of a few kilobytes.

use super::block::Block;
use super::grid::FacePlace;
use super::packet::Packet;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

/// Levels of reaches: those of the solved drainage, and three of tributaries.
pub(crate) const LEVELS: usize = 4;

/// Shelves, each with a lock of its own.
const SHELVES: usize = 16;
/// Bytes that are kept unless a program asks for another number.
const BYTES: usize = 192 << 20;
/// Share of them that is for spots.
const SPOTS: usize = 3;

/// Bytes that the rivers of each planet may keep.
static MOST_BYTES: AtomicUsize = AtomicUsize::new(BYTES);

/// Sets how many bytes the rivers of each planet may keep.
pub(crate) fn keep_bytes(bytes: usize) {
    MOST_BYTES.store(bytes, Ordering::Relaxed);
}

/// The pieces of the first levels near a cell of the last of these.
pub(super) type Spot = [Option<Arc<Block>>; LEVELS];

/// The blocks and spots that were used last.
#[derive(Default)]
pub(super) struct Blocks {
    /// By level and number.
    blocks: Shelves<(usize, u64), Arc<Block>>,
    /// By how many levels they have, and the number of the cell.
    spots: Shelves<(usize, u64), Spot>,
}

impl Blocks {
    /// A block; `build` makes it if it is not there.
    pub(super) fn get(&self, level: usize, number: u64, build: impl FnOnce() -> Block) -> Arc<Block> {
        if let Some(block) = self.blocks.find(number, &(level, number)) {
            return block;
        }
        // Built outside the lock. Another thread may build it too: both are equal.
        let block = Arc::new(build());
        let most = MOST_BYTES.load(Ordering::Relaxed);
        self.blocks.keep(number, (level, number), &block, block.bytes(), most - most / SPOTS);
        block
    }

    /// The spot of a cell, if it is kept.
    pub(super) fn spot(&self, key: (usize, u64)) -> Option<Spot> {
        self.spots.find(key.1, &key)
    }

    pub(super) fn keep_spot(&self, key: (usize, u64), spot: &Spot) {
        let bytes = spot.iter().flatten().map(|block| block.bytes()).sum();
        self.spots.keep(key.1, key, spot, bytes, MOST_BYTES.load(Ordering::Relaxed) / SPOTS);
    }

    /// Whether a block is kept.
    pub(super) fn has(&self, level: usize, number: u64) -> bool {
        self.blocks.find(number, &(level, number)).is_some()
    }

    /// Bytes that are kept.
    pub(super) fn bytes(&self) -> usize {
        self.blocks.bytes() + self.spots.bytes()
    }

    /// How many blocks are kept.
    #[cfg(all(test, feature = "editor"))]
    pub(super) fn count(&self) -> usize {
        self.blocks.0.iter().map(|shelf| shelf.lock().unwrap_or_else(PoisonError::into_inner).kept.len()).sum()
    }
}

struct Shelves<K, V>([Mutex<Shelf<K, V>>; SHELVES]);

/// Values with their bytes and the time of their last use.
struct Shelf<K, V> {
    kept: BTreeMap<K, (V, usize, u64)>,
    bytes: usize,
    clock: u64,
}

impl<K, V> Default for Shelves<K, V> {
    fn default() -> Self {
        let empty = || Shelf { kept: BTreeMap::new(), bytes: 0, clock: 0 };
        Self(std::array::from_fn(|_| Mutex::new(empty())))
    }
}

impl<K: Copy + Ord, V: Clone> Shelves<K, V> {
    fn find(&self, number: u64, key: &K) -> Option<V> {
        self.shelf(number).lock().unwrap_or_else(PoisonError::into_inner).find(key)
    }

    fn keep(&self, number: u64, key: K, value: &V, bytes: usize, most_bytes: usize) {
        let mut shelf = self.shelf(number).lock().unwrap_or_else(PoisonError::into_inner);
        shelf.keep(key, value.clone(), bytes, most_bytes / SHELVES);
    }

    fn bytes(&self) -> usize {
        self.0.iter().map(|shelf| shelf.lock().unwrap_or_else(PoisonError::into_inner).bytes).sum()
    }

    fn shelf(&self, number: u64) -> &Mutex<Shelf<K, V>> {
        &self.0[(number % SHELVES as u64) as usize]
    }
}

impl<K: Copy + Ord, V: Clone> Shelf<K, V> {
    fn find(&mut self, key: &K) -> Option<V> {
        self.clock += 1;
        let (value, _, used) = self.kept.get_mut(key)?;
        *used = self.clock;
        Some(value.clone())
    }

    fn keep(&mut self, key: K, value: V, bytes: usize, most_bytes: usize) {
        self.bytes += bytes;
        if let Some((_, old_bytes, _)) = self.kept.insert(key, (value, bytes, self.clock)) {
            self.bytes -= old_bytes;
        }
        // An eighth at once: few passes over all.
        while self.bytes > most_bytes && !self.kept.is_empty() {
            let mut times: Vec<u64> = self.kept.values().map(|(.., used)| *used).collect();
            let eighth = times.len() / 8;
            let (_, &mut newest, _) = times.select_nth_unstable(eighth);
            let bytes = &mut self.bytes;
            self.kept.retain(|_, (_, size, used)| {
                let stays = *used > newest;
                *bytes -= if stays { 0 } else { *size };
                stays
            });
        }
    }
}

/// How many spots of a thread are remembered, so that a second point near one has the whole block built.
const LATELY: usize = 32;

/// The blocks that one thread uses.
#[derive(Debug, Default)]
pub(crate) struct Cache {
    /// The rivers that the blocks belong to.
    owner: u64,
    /// The block of each level that was used last, or that of a spot, with a number of its own.
    pub(super) current: [Option<(u64, Arc<Block>)>; LEVELS],
    /// The finest blocks around the spots that were made last, with the number of their levels.
    pub(super) lately: [Option<(usize, u64)>; LATELY],
    /// Whether the points of the batch may stand alone.
    pub(super) is_spread: bool,
    /// Memory for the points that are worked on. None while it is in use.
    pub(super) packet: Option<Box<Packet>>,
}

impl Cache {
    pub(super) fn belongs_to(&mut self, owner: u64) {
        if self.owner != owner {
            *self = Self { owner, ..Self::default() };
        }
    }

    /// Whether a place lies in the current blocks of the first levels.
    #[inline(always)]
    pub(super) fn covers(&self, place: &FacePlace, levels: usize) -> bool {
        let mut current = self.current[..levels].iter();
        current.all(|current| current.as_ref().is_some_and(|(_, block)| block.covers(place)))
    }
}
