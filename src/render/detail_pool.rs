//! Detail tiles as texture layers: slopes and heights.

use super::layer_pool::LayerKind;
use crate::lod::tile::{DETAIL_IMAGE, DetailTile};

/// An array takes 18 MB.
pub(crate) const DETAIL: LayerKind = LayerKind {
    label: "detail tiles",
    side_px: DETAIL_IMAGE as u32,
    formats: &[wgpu::TextureFormat::Rgba16Float; 2],
    layers: 64,
};

/// Bytes of both textures; `None` for an incomplete grid.
pub(crate) fn texels(tile: &DetailTile) -> Option<Vec<Vec<u8>>> {
    if tile.slopes.len() != DETAIL_IMAGE * DETAIL_IMAGE || tile.heights.len() != tile.slopes.len() {
        return None;
    }
    let bytes = |texels: &[[half::f16; 4]]| texels.iter().flatten().copied().flat_map(half::f16::to_le_bytes).collect();
    Some(vec![bytes(&tile.slopes), bytes(&tile.heights)])
}
