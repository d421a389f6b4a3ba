//! Detail tiles as textures: slopes, and the rise over the mesh.

use super::layer_pool::LayerKind;
use crate::lod::tile::{DETAIL_SIDE, DetailTile};

/// 21 MB an array.
pub(crate) const DETAIL: LayerKind = LayerKind {
    label: "detail tiles",
    side_px: DETAIL_SIDE as u32,
    formats: &[wgpu::TextureFormat::Rgba16Float, wgpu::TextureFormat::R16Float],
    layers: 128,
};

/// The bytes of both textures; nothing for a tile that is not a whole grid.
pub(crate) fn texels(tile: &DetailTile) -> Option<Vec<Vec<u8>>> {
    if tile.slopes.len() != DETAIL_SIDE * DETAIL_SIDE || tile.rise_m.len() != tile.slopes.len() {
        return None;
    }
    let slopes = tile.slopes.iter().flatten().copied().flat_map(half::f16::to_le_bytes).collect();
    Some(vec![slopes, tile.rise_m.iter().copied().flat_map(half::f16::to_le_bytes).collect()])
}
