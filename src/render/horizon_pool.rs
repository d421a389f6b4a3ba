//! Horizon tiles as texture layers: an atlas of all images of a tile. Each texel has the tile's own value and its
//! parent's.

use super::layer_pool::LayerKind;
use crate::lod::horizon::{COARSE_SIDE, HORIZON_IMAGES, HorizonTile};
use crate::lod::tile::{TILE_SIDE, TILE_VERTICES};
use half::f16;

/// Images along a side of the atlas.
pub(crate) const IMAGES_ALONG: usize = 7;
const SIDE_PX: usize = IMAGES_ALONG * TILE_SIDE;

/// An array takes 14 MB.
pub(crate) const HORIZON: LayerKind = LayerKind {
    label: "horizon tiles",
    side_px: SIDE_PX as u32,
    formats: &[wgpu::TextureFormat::Rg16Float],
    extra: None,
    layers: 64,
};

/// Bytes of the atlas; `None` for an incomplete tile.
pub(crate) fn texels(tile: &HorizonTile) -> Option<Vec<Vec<u8>>> {
    const COARSE: usize = COARSE_SIDE * COARSE_SIDE;
    if tile.own.len() != HORIZON_IMAGES * TILE_VERTICES || tile.coarse.len() != HORIZON_IMAGES * COARSE {
        return None;
    }
    let mut bytes = vec![0; SIDE_PX * SIDE_PX * 4];
    for (image, (own, coarse)) in tile.own.chunks(TILE_VERTICES).zip(tile.coarse.chunks(COARSE)).enumerate() {
        let coarse: Vec<f32> = coarse.iter().map(|value| value.to_f32()).collect();
        let at = |x: usize, y: usize| coarse[y * COARSE_SIDE + x];
        for (i, own) in own.iter().enumerate() {
            let (x, y) = (i % TILE_SIDE, i / TILE_SIDE);
            let (x0, x1, y0, y1) = (x / 2, x.div_ceil(2), y / 2, y.div_ceil(2));
            let coarse = 0.25 * (at(x0, y0) + at(x1, y0) + at(x0, y1) + at(x1, y1));
            let column = image % IMAGES_ALONG * TILE_SIDE + x;
            let row = image / IMAGES_ALONG * TILE_SIDE + y;
            let texel = &mut bytes[(row * SIDE_PX + column) * 4..][..4];
            texel[..2].copy_from_slice(&own.to_le_bytes());
            texel[2..].copy_from_slice(&f16::from_f32(coarse).to_le_bytes());
        }
    }
    Some(vec![bytes])
}
