//! The biome table as two small textures: colour with mottling, and roughness. Row 0 is the hottest (or highest).

use crate::planet::{Biome, Biomes};

/// The textures; made anew when the palette or the table changes.
pub(crate) struct BiomeTextures {
    /// sRGB albedo, alpha: strength of the mottling.
    pub(crate) albedo: wgpu::TextureView,
    /// Roughness.
    pub(crate) roughness: wgpu::TextureView,
}

impl BiomeTextures {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue, biomes: &Biomes) -> Self {
        let (columns, rows) = (biomes.table.columns().max(1), biomes.table.rows().len().max(1));
        let none = Biome::default();
        let cells: Vec<&Biome> = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| {
                let key = biomes.table.key(column, row);
                biomes.palette.iter().find(|biome| Some(biome.key) == key).unwrap_or(&none)
            })
            .collect();
        let albedo: Vec<u8> = cells
            .iter()
            .flat_map(|biome| {
                let [r, g, b] = biome.color.map(srgb_byte);
                [r, g, b, (biome.variation.clamp(0.0, 1.0) * 255.0).round() as u8]
            })
            .collect();
        let roughness: Vec<u8> =
            cells.iter().map(|biome| (biome.roughness.clamp(0.0, 1.0) * 255.0).round() as u8).collect();
        let size = [columns as u32, rows as u32];
        Self {
            albedo: upload(device, queue, size, wgpu::TextureFormat::Rgba8UnormSrgb, 4, &albedo),
            roughness: upload(device, queue, size, wgpu::TextureFormat::R8Unorm, 1, &roughness),
        }
    }
}

/// Encodes a linear value (IEC 61966-2-1).
fn srgb_byte(linear: f64) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let encoded = if x <= 0.003_130_8 { x * 12.92 } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}

fn upload(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    [width, height]: [u32; 2],
    format: wgpu::TextureFormat,
    texel_bytes: u32,
    data: &[u8],
) -> wgpu::TextureView {
    let size = wgpu::Extent3d { width, height, depth_or_array_layers: 1 };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some("biome table"),
        size,
        mip_level_count: 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    let layout = wgpu::TexelCopyBufferLayout {
        offset: 0,
        bytes_per_row: Some(width * texel_bytes),
        rows_per_image: Some(height),
    };
    queue.write_texture(texture.as_image_copy(), data, layout, size);
    texture.create_view(&wgpu::TextureViewDescriptor::default())
}
