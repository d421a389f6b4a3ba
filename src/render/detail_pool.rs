//! Detail tiles as texture layers: slopes, heights, and the water of planets with a structure.

use super::layer_pool::LayerKind;
use crate::lod::tile::{DETAIL_IMAGE, DetailTile};

/// An array takes 18 MB, or 27 MB with water.
pub(crate) const DETAIL: LayerKind = LayerKind {
    label: "detail tiles",
    side_px: DETAIL_IMAGE as u32,
    formats: &[wgpu::TextureFormat::Rgba16Float; 2],
    extra: Some(wgpu::TextureFormat::Rgba16Float),
    layers: 64,
};

/// Bytes of slopes and heights, and of the water if the tile has any image of it; `None` for an incomplete grid.
pub(crate) fn texels(tile: &DetailTile) -> Option<Vec<Vec<u8>>> {
    if tile.slopes.len() != DETAIL_IMAGE * DETAIL_IMAGE || tile.heights.len() != tile.slopes.len() {
        return None;
    }
    let bytes = |texels: &[[half::f16; 4]]| texels.iter().flatten().copied().flat_map(half::f16::to_le_bytes).collect();
    let mut images = vec![bytes(&tile.slopes), bytes(&tile.heights)];
    if tile.water.len() == tile.slopes.len() {
        images.push(bytes(&tile.water));
    }
    Some(images)
}
