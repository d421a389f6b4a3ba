//! The tiling cube of noise on the graphics device; see [`crate::noise_tile`].

use crate::noise_tile::{NoiseTile, SIDE};

/// Computes the tile and uploads it.
pub(crate) fn upload(device: &wgpu::Device, queue: &wgpu::Queue) -> wgpu::TextureView {
    let NoiseTile(levels) = NoiseTile::new();
    let extent =
        |side: usize| wgpu::Extent3d { width: side as u32, height: side as u32, depth_or_array_layers: side as u32 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("noise tile"),
        size: extent(SIDE),
        mip_level_count: levels.len() as u32,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D3,
        format: wgpu::TextureFormat::Rg16Float,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (mip_level, data) in levels.iter().enumerate() {
        let (mip_level, side) = (mip_level as u32, SIDE >> mip_level);
        let bytes: Vec<u8> = data.iter().flatten().flat_map(|&x| half_bits(x).to_le_bytes()).collect();
        queue.write_texture(
            wgpu::TexelCopyTextureInfo { mip_level, ..texture.as_image_copy() },
            &bytes,
            wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(4 * side as u32),
                rows_per_image: Some(side as u32),
            },
            extent(side),
        );
    }
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}

/// A value of 0..1 as a 16-bit float (IEEE 754 binary16), rounded to nearest; subnormal results become 0. Eight bits
/// would show as terraces on bumps seen from near.
fn half_bits(x: f32) -> u16 {
    let bits = x.clamp(0.0, 1.0).to_bits() + (1 << 12);
    (bits >> 13).saturating_sub((127 - 15) << 10) as u16
}
