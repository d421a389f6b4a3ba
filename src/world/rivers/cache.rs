//! Blocks that were built, kept by one thread.

use super::block::Block;
use std::collections::BTreeMap;
use std::sync::Arc;

/// Levels of reaches: those of the solved drainage, and three of tributaries.
pub(crate) const LEVELS: usize = 4;
/// Blocks kept.
const KEPT: usize = 256;

/// The blocks that one thread used last. What it holds changes no answer.
#[derive(Debug, Default)]
pub(crate) struct Cache {
    /// The rivers that the blocks belong to.
    pub(super) owner: u64,
    blocks: BTreeMap<(usize, u64), (Arc<Block>, u64)>,
    /// The block of each level that was used last.
    pub(super) current: [Option<(u64, Arc<Block>)>; LEVELS],
    clock: u64,
}

impl Cache {
    pub(super) fn belongs_to(&mut self, owner: u64) {
        if self.owner != owner {
            *self = Self { owner, ..Self::default() };
        }
    }

    pub(super) fn get(&mut self, level: usize, block: u64) -> Option<Arc<Block>> {
        self.clock += 1;
        let (found, used) = self.blocks.get_mut(&(level, block))?;
        *used = self.clock;
        Some(found.clone())
    }

    pub(super) fn keep(&mut self, level: usize, number: u64, block: &Arc<Block>) {
        if self.blocks.len() >= KEPT
            && let Some(oldest) = self.blocks.iter().min_by_key(|(_, (_, used))| *used).map(|(key, _)| *key)
        {
            self.blocks.remove(&oldest);
        }
        self.blocks.insert((level, number), (block.clone(), self.clock));
    }
}
