//! The border-jitter noise as a tiling 3D texture with mip levels. The CPU samples the same tile in queries.

use crate::terrain::border::{TILE_SIDE, tile};
use half::f16;

/// Uploads the tile.
pub(crate) fn upload(device: &wgpu::Device, queue: &wgpu::Queue) -> wgpu::TextureView {
    let extent =
        |side: usize| wgpu::Extent3d { width: side as u32, height: side as u32, depth_or_array_layers: side as u32 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("border tile"),
        size: extent(TILE_SIDE),
        mip_level_count: TILE_SIDE.ilog2() + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D3,
        format: wgpu::TextureFormat::Rg16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let mut texels = tile().to_vec();
    for mip_level in 0..texture.mip_level_count() {
        let side = TILE_SIDE >> mip_level;
        let bytes: Vec<u8> = texels.iter().flatten().flat_map(|&x| f16::from_f32(x).to_le_bytes()).collect();
        let (row, rows) = (Some(4 * side as u32), Some(side as u32));
        queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() },
            &bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: row, rows_per_image: rows },
            extent(side),
        );
        texels = halved(&texels, side);
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// Means of blocks of two by two by two texels; empty for a single texel.
fn halved(texels: &[[f32; 2]], side: usize) -> Vec<[f32; 2]> {
    let half = side / 2;
    let mean = |i: usize| {
        let [x, y, z] = [i % half, i / half % half, i / (half * half)].map(|n| 2 * n);
        let corners = (0..8).map(|c| ((z + (c >> 2)) * side + y + (c >> 1 & 1)) * side + x + (c & 1));
        let sum = corners.map(|at| texels[at]).fold([0.0; 2], |sum, t| [sum[0] + t[0], sum[1] + t[1]]);
        sum.map(|sum| sum * 0.125)
    };
    (0..half * half * half).map(mean).collect()
}
