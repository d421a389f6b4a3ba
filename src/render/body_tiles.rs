//! Tiles of a body on the GPU: vertices, detail textures, horizon angles. All views of the body share them.

use super::detail_pool::{self, DETAIL};
use super::horizon_pool::{self, HORIZON};
use super::layer_pool::LayerPool;
use super::pool::{TILE_BYTES, TilePool};
use crate::tiles::Surface;

/// Tiles of a body on the GPU.
pub(crate) struct BodyTiles {
    pub(crate) pool: TilePool,
    pub(crate) details: LayerPool,
    pub(crate) horizons: LayerPool,
}

impl BodyTiles {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self {
            pool: TilePool::new(device),
            details: LayerPool::new(device, DETAIL),
            horizons: LayerPool::new(device, HORIZON),
        }
    }

    /// Begins a frame, in which each view draws once. Tiles that no view has drawn for some frames may be dropped.
    pub(crate) fn begin_frame(&mut self) {
        self.pool.begin_round();
        self.details.begin_frame();
        self.horizons.begin_frame();
    }

    /// Uploads tiles of a surface ahead of its first frame: at most `budget_bytes`, but at least one tile. Returns
    /// whether all tiles are on the GPU now.
    pub(crate) fn upload(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        surface: &Surface,
        budget_bytes: u64,
    ) -> bool {
        self.pool.begin_round();
        let mut left = budget_bytes.max(TILE_BYTES);
        let mut affordable = |bytes| {
            let fits = bytes <= left;
            left = if fits { left - bytes } else { 0 };
            fits
        };
        // All tiles are visited even when the budget is spent, so that tiles already on the GPU keep their slots.
        let mut done = true;
        for leaf in &surface.leaves {
            if !self.pool.holds(&leaf.tile) {
                if affordable(TILE_BYTES) {
                    self.pool.place(device, encoder, &leaf.tile);
                } else {
                    done = false;
                }
            }
        }
        for tile in surface.leaves.iter().filter_map(|leaf| leaf.horizon.as_deref()) {
            let texels = || horizon_pool::texels(tile);
            done &= self.horizons.place_ahead(device, queue, tile.serial, &mut affordable, texels);
        }
        for tile in surface.leaves.iter().filter_map(|leaf| leaf.detail.as_deref()) {
            let texels = || detail_pool::texels(tile);
            done &= self.details.place_ahead(device, queue, tile.serial, &mut affordable, texels);
        }
        self.pool.end_round(encoder);
        done
    }

    /// Memory of all pools.
    pub(crate) fn resident_bytes(&self) -> u64 {
        self.pool.resident_bytes() + self.details.resident_bytes() + self.horizons.resident_bytes()
    }

    /// Bytes uploaded since the start.
    pub(crate) fn uploaded_bytes(&self) -> u64 {
        self.pool.uploaded_bytes() + self.details.uploaded_bytes() + self.horizons.uploaded_bytes()
    }
}
