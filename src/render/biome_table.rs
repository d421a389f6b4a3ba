//! The biome table as two small textures: colour with mottling, and roughness. Row 0 is the hottest (or highest).

use crate::planet::{Biome, Biomes};

/// The texels of both textures, row by row.
#[derive(PartialEq)]
pub(crate) struct BiomeTexels {
    size_px: [u32; 2],
    /// sRGB albedo, alpha: strength of the mottling.
    albedo: Vec<u8>,
    /// Roughness.
    roughness: Vec<u8>,
}

impl BiomeTexels {
    pub(crate) fn new(biomes: &Biomes) -> Self {
        let (columns, rows) = (biomes.table.columns().max(1), biomes.table.rows().len().max(1));
        let none = Biome::default();
        let cells: Vec<&Biome> = (0..rows)
            .flat_map(|row| (0..columns).map(move |column| (column, row)))
            .map(|(column, row)| {
                let key = biomes.table.key(column, row);
                biomes.palette.iter().find(|biome| Some(biome.key) == key).unwrap_or(&none)
            })
            .collect();
        let byte = |share: f64| (share.clamp(0.0, 1.0) * 255.0).round() as u8;
        let albedo = |biome: &&Biome| {
            let [r, g, b] = biome.color.map(srgb_byte);
            [r, g, b, byte(biome.variation)]
        };
        Self {
            size_px: [columns as u32, rows as u32],
            albedo: cells.iter().flat_map(albedo).collect(),
            roughness: cells.iter().map(|biome| byte(biome.roughness)).collect(),
        }
    }
}

/// The textures; rewritten in place while the table keeps its size.
pub(crate) struct BiomeTextures {
    pub(crate) albedo: wgpu::TextureView,
    pub(crate) roughness: wgpu::TextureView,
}

impl BiomeTextures {
    /// Of this size, with nothing in them yet.
    fn new(device: &wgpu::Device, size_px: [u32; 2]) -> Self {
        let make = |format| {
            let texture = device.create_texture(&wgpu::TextureDescriptor {
                label: Some("biome table"),
                size: extent(size_px),
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            });
            texture.create_view(&wgpu::TextureViewDescriptor::default())
        };
        Self { albedo: make(wgpu::TextureFormat::Rgba8UnormSrgb), roughness: make(wgpu::TextureFormat::R8Unorm) }
    }

    /// Textures that hold these texels.
    pub(crate) fn with(device: &wgpu::Device, queue: &wgpu::Queue, texels: &BiomeTexels) -> Self {
        let textures = Self::new(device, texels.size_px);
        textures.write(queue, texels);
        textures
    }

    /// Whether texels fit as they are.
    pub(crate) fn fit(&self, texels: &BiomeTexels) -> bool {
        self.albedo.texture().size() == extent(texels.size_px)
    }

    /// Replaces what is in them.
    pub(crate) fn write(&self, queue: &wgpu::Queue, texels: &BiomeTexels) {
        let [width, height] = texels.size_px;
        for (view, texel_bytes, data) in [(&self.albedo, 4, &texels.albedo), (&self.roughness, 1, &texels.roughness)] {
            let layout = wgpu::TexelCopyBufferLayout {
                offset: 0,
                bytes_per_row: Some(width * texel_bytes),
                rows_per_image: Some(height),
            };
            queue.write_texture(view.texture().as_image_copy(), data, layout, extent(texels.size_px));
        }
    }
}

fn extent([width, height]: [u32; 2]) -> wgpu::Extent3d {
    wgpu::Extent3d { width, height, depth_or_array_layers: 1 }
}

/// Encodes a linear value (IEC 61966-2-1).
fn srgb_byte(linear: f64) -> u8 {
    let x = linear.clamp(0.0, 1.0);
    let encoded = if x <= 0.003_130_8 { x * 12.92 } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
    (encoded * 255.0).round() as u8
}
