//! Cache of tile vertices on the GPU: slots in a few large vertex buffers, keyed by [`Tile::serial`]. A slot is filled
//! once and kept until another tile needs it and no round has requested it for a while.

use crate::lod::tile::{TILE_VERTICES, Tile, Vertex};
use std::collections::HashMap;
use std::num::NonZeroU64;
use wgpu::util::StagingBelt;

/// Tiles in one buffer, which takes 14 MB.
pub(crate) const SLOTS: u32 = 256;
/// Number of rounds after which an unrequested tile may lose its slot. A frame that uploads ahead and draws has two
/// rounds.
const KEPT_ROUNDS: u64 = 4;
/// Bytes of one chunk of staging memory.
const STAGING_BYTES: u64 = 4 << 20;
/// Bytes of a tile's vertices.
pub(crate) const TILE_BYTES: u64 = (TILE_VERTICES * size_of::<Vertex>()) as u64;

/// Location of a tile's vertices.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// Index of the vertex buffer.
    pub(crate) buffer: usize,
    /// Index of the tile's first vertex in that buffer.
    pub(crate) base_vertex: i32,
}

struct Held {
    place: Place,
    wanted_in_round: u64,
}

/// All slots.
pub(crate) struct TilePool {
    buffers: Vec<wgpu::Buffer>,
    free: Vec<Place>,
    held: HashMap<u64, Held>,
    /// Staging memory, reused.
    belt: StagingBelt,
    round: u64,
    uploaded_bytes: u64,
}

impl TilePool {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self {
            buffers: Vec::new(),
            free: Vec::new(),
            held: HashMap::new(),
            belt: StagingBelt::new(device.clone(), STAGING_BYTES),
            round: 0,
            uploaded_bytes: 0,
        }
    }

    /// Must be called before the first [`TilePool::place`] of a round.
    pub(crate) fn begin_round(&mut self) {
        self.round += 1;
    }

    /// Must be called after the last [`TilePool::place`] of a round, before the encoder is submitted.
    pub(crate) fn end_round(&mut self, encoder: &wgpu::CommandEncoder) {
        self.belt.finish_and_recall_on_submit(encoder);
    }

    /// Bytes uploaded since the start.
    pub(crate) fn uploaded_bytes(&self) -> u64 {
        self.uploaded_bytes
    }

    /// Memory of the vertex buffers.
    pub(crate) fn resident_bytes(&self) -> u64 {
        self.buffers.iter().map(wgpu::Buffer::size).sum()
    }

    /// Whether a tile has a slot. If so, it is marked as requested in this round.
    pub(crate) fn holds(&mut self, tile: &Tile) -> bool {
        let held = self.held.get_mut(&tile.serial);
        held.map(|held| held.wanted_in_round = self.round).is_some()
    }

    /// The vertex buffers.
    pub(crate) fn buffers(&self) -> &[wgpu::Buffer] {
        &self.buffers
    }

    /// Location of a tile, which is uploaded if it is new. `None` for an incomplete grid.
    pub(crate) fn place(
        &mut self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        tile: &Tile,
    ) -> Option<Place> {
        if let Some(held) = self.held.get_mut(&tile.serial) {
            held.wanted_in_round = self.round;
            return Some(held.place);
        }
        if tile.vertices.len() != TILE_VERTICES {
            return None;
        }
        let place = self.take_slot(device)?;
        let offset = place.base_vertex as u64 * size_of::<Vertex>() as u64;
        let size = NonZeroU64::new(TILE_BYTES)?;
        let mut staged = self.belt.write_buffer(encoder, &self.buffers[place.buffer], offset, size);
        staged.copy_from_slice(bytemuck::cast_slice(&tile.vertices));
        drop(staged);
        self.held.insert(tile.serial, Held { place, wanted_in_round: self.round });
        self.uploaded_bytes += TILE_BYTES;
        Some(place)
    }

    fn take_slot(&mut self, device: &wgpu::Device) -> Option<Place> {
        if self.free.is_empty() {
            let round = self.round;
            let free = &mut self.free;
            self.held.retain(|_, held| {
                let keep = held.wanted_in_round + KEPT_ROUNDS > round;
                if !keep {
                    free.push(held.place);
                }
                keep
            });
        }
        if self.free.is_empty() {
            let buffer = self.buffers.len();
            self.buffers.push(device.create_buffer(&wgpu::BufferDescriptor {
                label: Some("tiles"),
                size: u64::from(SLOTS) * TILE_BYTES,
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
            let first = |slot: u32| slot as i32 * TILE_VERTICES as i32;
            self.free.extend((0..SLOTS).rev().map(|slot| Place { buffer, base_vertex: first(slot) }));
        }
        self.free.pop()
    }
}
