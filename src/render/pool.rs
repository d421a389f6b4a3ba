//! Tiles on the GPU: slots in a few large vertex buffers, keyed by [`Tile::serial`], filled once and kept until another
//! tile needs the room and nobody has drawn them for a while.

use crate::lod::tile::{TILE_VERTICES, Tile, Vertex};
use std::collections::HashMap;

/// Tiles in one buffer: 12 MB.
const SLOTS: u32 = 256;
/// Frames after which a tile that is not drawn may lose its slot.
const KEPT_FRAMES: u64 = 1;

/// Where a tile's vertices are.
#[derive(Clone, Copy)]
pub(crate) struct Place {
    /// Index of the vertex buffer.
    pub(crate) buffer: usize,
    /// Number of the tile's first vertex in it.
    pub(crate) base_vertex: i32,
}

struct Held {
    place: Place,
    drawn_in_frame: u64,
}

/// All slots.
#[derive(Default)]
pub(crate) struct TilePool {
    buffers: Vec<wgpu::Buffer>,
    free: Vec<Place>,
    held: HashMap<u64, Held>,
    frame: u64,
}

impl TilePool {
    /// Call once a frame, before the first [`TilePool::place`].
    pub(crate) fn begin_frame(&mut self) {
        self.frame += 1;
    }

    /// The vertex buffers.
    pub(crate) fn buffers(&self) -> &[wgpu::Buffer] {
        &self.buffers
    }

    /// Where a tile is; uploads it if it is new. `None` for a tile that is not a whole grid.
    pub(crate) fn place(&mut self, device: &wgpu::Device, queue: &wgpu::Queue, tile: &Tile) -> Option<Place> {
        if let Some(held) = self.held.get_mut(&tile.serial) {
            held.drawn_in_frame = self.frame;
            return Some(held.place);
        }
        if tile.vertices.len() != TILE_VERTICES {
            return None;
        }
        let place = self.take_slot(device)?;
        let offset = place.base_vertex as u64 * size_of::<Vertex>() as u64;
        queue.write_buffer(&self.buffers[place.buffer], offset, bytemuck::cast_slice(&tile.vertices));
        self.held.insert(tile.serial, Held { place, drawn_in_frame: self.frame });
        Some(place)
    }

    fn take_slot(&mut self, device: &wgpu::Device) -> Option<Place> {
        if self.free.is_empty() {
            let frame = self.frame;
            let free = &mut self.free;
            self.held.retain(|_, held| {
                let keep = held.drawn_in_frame + KEPT_FRAMES > frame;
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
                size: u64::from(SLOTS) * (TILE_VERTICES * size_of::<Vertex>()) as u64,
                usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
                mapped_at_creation: false,
            }));
            let first = |slot: u32| slot as i32 * TILE_VERTICES as i32;
            self.free.extend((0..SLOTS).rev().map(|slot| Place { buffer, base_vertex: first(slot) }));
        }
        self.free.pop()
    }
}
