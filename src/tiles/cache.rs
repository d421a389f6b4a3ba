//! The tiles of earlier requests: valid ones to be shown again, stale ones for the stages whose inputs did not change.
//!
//! One memory budget covers everything. When it is exceeded, entries are dropped in ascending order of the cost to
//! rebuild what is on screen: fields of earlier revisions, the inputs of unseen tiles, unseen tiles, and at last the
//! inputs of tiles on screen. Tiles that the current request needs always stay.

use super::make::{Before, Parts, make_tile};
use super::stats::{Memory, Work};
use crate::lod::horizon::HorizonTile;
use crate::lod::tile::{DetailTile, Tile, Vertex};
use crate::sphere::NodeId;
use crate::terrain::Terrain;
use crate::terrain::kept::KeptFields;
use crate::terrain::revision::TileKeys;
use std::collections::HashMap;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::time::Instant;

/// Default budget: several screens of a planet of ten layers.
pub const DEFAULT_BUDGET_BYTES: usize = 256 << 20;

#[derive(Default)]
struct Entry {
    tile: Option<Arc<Tile>>,
    /// The inputs of the tile.
    parts: Option<Arc<Parts>>,
    fields: KeptFields,
    detail: Option<Arc<DetailTile>>,
    /// Of this revision or of an earlier one.
    horizon: Option<Arc<HorizonTile>>,
    /// Content keys of the tile and its parts.
    keys: TileKeys,
    /// The terrain, by its number, that these keys were found to be those of, or not.
    checked: (u64, bool),
    /// The request that last asked for it.
    used: u64,
}

impl Entry {
    fn bytes(&self) -> usize {
        let tile = self.tile.as_ref().map_or(0, |tile| tile.vertices.len() * size_of::<Vertex>());
        let detail = self.detail.as_ref().map_or(0, |detail| detail.bytes());
        let horizon = self.horizon.as_ref().map_or(0, |horizon| horizon.bytes());
        tile + detail + horizon + self.parts.as_ref().map_or(0, |parts| parts.bytes()) + self.fields.bytes()
    }

    /// Drops everything but the tile.
    fn strip(&mut self) {
        self.detail = None;
        self.horizon = None;
        self.parts = None;
        self.fields.clear();
    }
}

#[derive(Default)]
struct State {
    entries: HashMap<NodeId, Entry>,
    /// The terrain whose tiles are valid, its content keys before edits, and its number.
    terrain: Option<Arc<Terrain>>,
    keys: TileKeys,
    number: u64,
    /// Resident size of all entries.
    bytes: usize,
    /// Number of the current request.
    request: u64,
}

/// A cache of tiles by node, shared between threads.
pub(crate) struct Cache {
    state: Mutex<State>,
    budget_bytes: Arc<AtomicUsize>,
    /// Part of the budget that is used outside of the cache.
    aside_bytes: AtomicUsize,
}

impl Cache {
    /// An empty cache. With a budget of zero only the tiles of the current request are kept.
    pub(crate) fn new(budget_bytes: usize) -> Self {
        Self::with_budget(Arc::new(AtomicUsize::new(budget_bytes)))
    }

    /// An empty cache whose budget may be changed.
    pub(crate) fn with_budget(budget_bytes: Arc<AtomicUsize>) -> Self {
        Self { state: Mutex::default(), budget_bytes, aside_bytes: AtomicUsize::new(0) }
    }

    fn lock(&self) -> MutexGuard<'_, State> {
        self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// The valid tile of a node.
    pub(crate) fn tile(&self, id: NodeId) -> Option<Arc<Tile>> {
        let mut state = self.lock();
        let State { entries, terrain, keys, number, request, .. } = &mut *state;
        let (terrain, entry) = (terrain.as_ref()?, entries.get_mut(&id)?);
        if entry.checked.0 != *number {
            entry.checked = (*number, entry.keys == terrain.with_edits_near(*keys, id));
        }
        let tile = entry.tile.clone().filter(|_| entry.checked.1)?;
        entry.used = *request;
        Some(tile)
    }

    /// The detail texture of a tile, if it was made from the same heights.
    pub(crate) fn detail(&self, tile: &Tile) -> Option<Arc<DetailTile>> {
        let state = self.lock();
        let detail = state.entries.get(&tile.id)?.detail.clone();
        detail.filter(|detail| detail.heights_serial == tile.heights_serial)
    }

    /// Keeps the detail texture of a node.
    pub(crate) fn keep_detail(&self, id: NodeId, detail: &Arc<DetailTile>) {
        self.keep_with(id, |entry| entry.detail = Some(detail.clone()));
    }

    /// The last horizon tile of a node, perhaps of an earlier revision.
    pub(crate) fn horizon(&self, id: NodeId) -> Option<Arc<HorizonTile>> {
        self.lock().entries.get(&id)?.horizon.clone()
    }

    /// The same, or that of the nearest ancestor that has one.
    pub(crate) fn nearest_horizon(&self, id: NodeId) -> Option<Arc<HorizonTile>> {
        let state = self.lock();
        std::iter::successors(Some(id), |id| id.parent()).find_map(|id| state.entries.get(&id)?.horizon.clone())
    }

    /// Keeps the horizon tile of a node.
    pub(crate) fn keep_horizon(&self, horizon: &Arc<HorizonTile>) {
        self.keep_with(horizon.id, |entry| entry.horizon = Some(horizon.clone()));
    }

    /// Adds something to the entry of a node, if there is one.
    fn keep_with(&self, id: NodeId, keep: impl FnOnce(&mut Entry)) {
        let mut state = self.lock();
        let Some(entry) = state.entries.get_mut(&id) else { return };
        let bytes_before = entry.bytes();
        keep(entry);
        let bytes_after = entry.bytes();
        state.bytes = state.bytes + bytes_after - bytes_before;
        if state.bytes > self.room_bytes() {
            state.trim(self.room_bytes());
        }
    }

    /// Builds a node's tile from what is known of the node and its parent, and adds what that took to `work`. Returns
    /// false if `keep_going`, asked before each layer, said no; the fields found until then are kept.
    pub(crate) fn build(&self, id: NodeId, terrain: &Terrain, work: &mut Work, keep_going: &dyn Fn() -> bool) -> bool {
        let (parent, parts, tile, keys, mut fields) = {
            let state = self.lock();
            let parent = id.parent().and_then(|id| state.entries.get(&id)?.parts.clone());
            let known = state
                .entries
                .get(&id)
                .map(|entry| (entry.parts.clone(), entry.tile.clone(), entry.keys, entry.fields.clone()));
            let (parts, tile, keys, fields) = known.unwrap_or_default();
            (parent, parts, tile, keys, fields)
        };
        let before =
            Before { parent: parent.as_deref(), parts: parts.as_deref(), tile: tile.as_deref(), keys, fields: &fields };
        let (found, made) = make_tile(terrain, id, &before, work, keep_going);
        fields.adopt(&terrain.stack.layers, &found, Instant::now());

        let mut state = self.lock();
        let request = state.request;
        let entry = state.entries.entry(id).or_default();
        let bytes_before = entry.bytes();
        entry.fields = fields;
        entry.used = request;
        let done = made.is_some();
        if let Some((tile, parts)) = made {
            entry.tile = Some(Arc::new(tile));
            entry.parts = parts.map(Arc::new);
            entry.keys = terrain.tile_keys_at(id);
            entry.checked = (0, false);
            work.tiles += 1;
        }
        let bytes_after = entry.bytes();
        state.bytes = state.bytes + bytes_after - bytes_before;
        if state.bytes > self.room_bytes() {
            state.trim(self.room_bytes());
        }
        done
    }

    /// From now on, only tiles with the content keys of this terrain are valid.
    pub(crate) fn serve(&self, terrain: &Arc<Terrain>) {
        let mut state = self.lock();
        (state.keys, state.terrain) = (terrain.tile_keys(), Some(terrain.clone()));
        state.number += 1;
    }

    /// Begins a new request: entries that it does not ask for may be dropped.
    pub(crate) fn begin_request(&self) {
        self.lock().request += 1;
    }

    /// Forgets everything.
    pub(crate) fn clear(&self) {
        let mut state = self.lock();
        state.entries.clear();
        state.bytes = 0;
    }

    /// The budget.
    pub(crate) fn budget_bytes(&self) -> usize {
        self.budget_bytes.load(Ordering::Relaxed)
    }

    /// Sets the part of the budget that is used outside of the cache.
    pub(crate) fn set_aside(&self, bytes: usize) {
        self.aside_bytes.store(bytes, Ordering::Relaxed);
    }

    /// The budget that is left for entries.
    fn room_bytes(&self) -> usize {
        self.budget_bytes().saturating_sub(self.aside_bytes.load(Ordering::Relaxed))
    }

    /// Memory use, including what is used outside of the cache.
    pub(crate) fn memory(&self) -> Memory {
        let state = self.lock();
        Memory {
            used_bytes: state.bytes + self.aside_bytes.load(Ordering::Relaxed),
            budget_bytes: self.budget_bytes(),
            tiles: state.entries.values().filter(|entry| entry.tile.is_some()).count(),
            horizons: state.entries.values().filter(|entry| entry.horizon.is_some()).count(),
            fields: state.entries.values().map(|entry| entry.fields.len()).sum(),
        }
    }
}

impl State {
    /// Drops entries until an eighth of the budget is free, so that trimming is rare.
    fn trim(&mut self, budget_bytes: usize) {
        let target = budget_bytes - budget_bytes / 8;
        let now = Instant::now();
        let mut past: Vec<(f64, usize)> = self.entries.values().flat_map(|entry| entry.fields.past(now)).collect();
        past.sort_by(|a, b| a.0.total_cmp(&b.0));
        let mut excess = self.bytes.saturating_sub(target);
        let kept_from = past.iter().find(|(_, bytes)| {
            let fits = excess == 0;
            excess = excess.saturating_sub(*bytes);
            fits
        });
        let worth = kept_from.map_or(f64::INFINITY, |(worth, _)| *worth);
        if !past.is_empty() {
            self.entries.values_mut().for_each(|entry| entry.fields.forget_below(worth, now));
            self.bytes = self.entries.values().map(Entry::bytes).sum();
        }

        let mut oldest: Vec<(u64, NodeId)> = self.entries.iter().map(|(id, entry)| (entry.used, *id)).collect();
        oldest.sort_unstable();
        // The tiles of the previous request are still on screen.
        let unseen = oldest.partition_point(|(used, _)| used + 1 < self.request);
        let unneeded = oldest.partition_point(|(used, _)| *used < self.request);
        self.drop_while_over(target, &oldest[..unseen], Entry::strip);
        self.drop_while_over(target, &oldest[..unseen], |entry| entry.tile = None);
        self.drop_while_over(target, &oldest, Entry::strip);
        self.drop_while_over(target, &oldest[..unneeded], |entry| entry.tile = None);
        self.entries.retain(|_, entry| entry.tile.is_some() || entry.fields.len() > 0);
    }

    fn drop_while_over(&mut self, target: usize, order: &[(u64, NodeId)], drop: impl Fn(&mut Entry)) {
        for (_, id) in order {
            if self.bytes <= target {
                return;
            }
            if let Some(entry) = self.entries.get_mut(id) {
                let before = entry.bytes();
                drop(entry);
                self.bytes -= before - entry.bytes();
            }
        }
    }
}
