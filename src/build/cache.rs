//! Tiles kept from one request to the next: valid ones to be shown again, stale ones for the stages that an edit left intact.

use super::make::{Parts, Work, make_tile};
use crate::lod::tile::Tile;
use crate::planet::param::Stage;
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use std::collections::HashMap;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Most bytes kept in tiles and their parts.
const BUDGET_BYTES: usize = 256 << 20;

struct Entry {
    tile: Arc<Tile>,
    parts: Arc<Parts>,
    /// First stage in which the tile's planet differs from the present one; `None` for a tile that is valid.
    stale: Option<Stage>,
    /// The request that last asked for it.
    used: u64,
}

/// A map from nodes to tiles that may be shared between threads.
#[derive(Default)]
pub(crate) struct Cache {
    entries: Mutex<HashMap<NodeId, Entry>>,
    /// Grows with each request.
    request: AtomicU64,
}

impl Cache {
    fn lock(&self) -> MutexGuard<'_, HashMap<NodeId, Entry>> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }

    fn now(&self) -> u64 {
        self.request.load(Ordering::Relaxed)
    }

    /// The valid tile of a node.
    pub(crate) fn tile(&self, id: NodeId) -> Option<Arc<Tile>> {
        let now = self.now();
        let mut entries = self.lock();
        let entry = entries.get_mut(&id).filter(|entry| entry.stale.is_none())?;
        entry.used = now;
        Some(entry.tile.clone())
    }

    /// Builds a node's tile, reusing what the stale one still has.
    pub(crate) fn build(&self, id: NodeId, terrain: &Terrain) -> Work {
        let before = self.lock().get(&id).map(|entry| (entry.parts.clone(), entry.stale.unwrap_or(Stage::Label)));
        let before = before.as_ref().map(|(parts, stale)| (parts.as_ref(), *stale));
        let (tile, parts, work) = make_tile(terrain, id, before);
        let entry = Entry { tile: Arc::new(tile), parts: Arc::new(parts), stale: None, used: self.now() };
        self.lock().insert(id, entry);
        work
    }

    /// The planet changed from this stage on: no tile is valid any more.
    pub(crate) fn invalidate(&self, stage: Stage) {
        for entry in self.lock().values_mut() {
            entry.stale = Some(entry.stale.map_or(stage, |before| before.min(stage)));
        }
    }

    /// A new request begins: drops what was asked for least recently until the rest fits the budget.
    pub(crate) fn begin_request(&self) {
        self.request.fetch_add(1, Ordering::Relaxed);
        let mut entries = self.lock();
        let mut bytes: usize = entries.values().map(|entry| entry.parts.bytes()).sum();
        if bytes <= BUDGET_BYTES {
            return;
        }
        // What the last request showed stays, however much it is: it is most likely wanted again.
        let last = self.now() - 1;
        let mut oldest: Vec<(u64, NodeId)> =
            entries.iter().map(|(id, entry)| (entry.used, *id)).filter(|(used, _)| *used < last).collect();
        oldest.sort_unstable();
        for (_, id) in oldest {
            if bytes <= BUDGET_BYTES {
                break;
            }
            if let Some(entry) = entries.remove(&id) {
                bytes -= entry.parts.bytes();
            }
        }
    }
}
