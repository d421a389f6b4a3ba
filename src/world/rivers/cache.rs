//! Blocks that were built, kept for all threads. What is kept changes no answer.

use super::block::Block;
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, PoisonError};

/// Levels of reaches: those of the solved drainage, and three of tributaries.
pub(crate) const LEVELS: usize = 4;

/// Shelves, each with a lock of its own, and bytes kept on each.
const SHELVES: usize = 16;
const SHELF_BYTES: usize = 8 << 20;

/// The blocks that were used last.
#[derive(Default)]
pub(super) struct Blocks {
    shelves: [Mutex<Shelf>; SHELVES],
}

#[derive(Default)]
struct Shelf {
    /// By level and number, with the time of the last use.
    blocks: BTreeMap<(usize, u64), (Arc<Block>, u64)>,
    bytes: usize,
    clock: u64,
}

impl Blocks {
    /// A block; `build` makes it if it is not there.
    pub(super) fn get(&self, level: usize, number: u64, build: impl FnOnce() -> Block) -> Arc<Block> {
        let shelf = || self.shelves[(number % SHELVES as u64) as usize].lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(block) = shelf().find(level, number) {
            return block;
        }
        // Built outside the lock. Another thread may build it too: both are equal.
        let block = Arc::new(build());
        shelf().keep(level, number, &block);
        block
    }

    /// How many are kept.
    #[cfg(all(test, feature = "editor"))]
    pub(super) fn count(&self) -> usize {
        self.shelves.iter().map(|shelf| shelf.lock().unwrap_or_else(PoisonError::into_inner).blocks.len()).sum()
    }
}

impl Shelf {
    fn find(&mut self, level: usize, number: u64) -> Option<Arc<Block>> {
        self.clock += 1;
        let (found, used) = self.blocks.get_mut(&(level, number))?;
        *used = self.clock;
        Some(found.clone())
    }

    fn keep(&mut self, level: usize, number: u64, block: &Arc<Block>) {
        self.bytes += block.bytes();
        if let Some((old, _)) = self.blocks.insert((level, number), (block.clone(), self.clock)) {
            self.bytes -= old.bytes();
        }
        while self.bytes > SHELF_BYTES
            && let Some(oldest) = self.blocks.iter().min_by_key(|(_, (_, used))| *used).map(|(key, _)| *key)
            && let Some((old, _)) = self.blocks.remove(&oldest)
        {
            self.bytes -= old.bytes();
        }
    }
}

/// The blocks that one thread uses.
#[derive(Debug, Default)]
pub(crate) struct Cache {
    /// The rivers that the blocks belong to.
    owner: u64,
    /// The block of each level that was used last.
    pub(super) current: [Option<(u64, Arc<Block>)>; LEVELS],
}

impl Cache {
    pub(super) fn belongs_to(&mut self, owner: u64) {
        if self.owner != owner {
            *self = Self { owner, ..Self::default() };
        }
    }
}
