//! Normal tiles on the GPU: layers of a few large texture arrays, keyed by [`NormalTile::serial`], filled once and kept until
//! another needs the room and nobody has drawn them for a while.

use crate::lod::tile::{NORMAL_SIDE, NormalTile};
use std::collections::HashMap;

/// Layers of one array: 17 MB.
const LAYERS: u32 = 128;

/// Where a normal tile is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct NormalPlace {
    /// Index of the texture array.
    pub(crate) array: usize,
    pub(crate) layer: u32,
}

struct Held {
    place: NormalPlace,
    drawn_in_frame: u64,
}

/// All layers, and a bind group for each array.
pub(crate) struct NormalPool {
    layout: wgpu::BindGroupLayout,
    textures: Vec<wgpu::Texture>,
    groups: Vec<wgpu::BindGroup>,
    free: Vec<NormalPlace>,
    held: HashMap<u64, Held>,
    frame: u64,
}

impl NormalPool {
    /// The bind group layout of one array.
    pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("normal tiles"),
            entries: &[wgpu::BindGroupLayoutEntry {
                binding: 0,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: true },
                    view_dimension: wgpu::TextureViewDimension::D2Array,
                    multisampled: false,
                },
                count: None,
            }],
        })
    }

    /// One array, empty.
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let mut pool = Self {
            layout: Self::layout(device),
            textures: Vec::new(),
            groups: Vec::new(),
            free: Vec::new(),
            held: HashMap::new(),
            frame: 0,
        };
        pool.grow(device);
        pool
    }

    /// Call once a frame, before the first [`NormalPool::place`].
    pub(crate) fn begin_frame(&mut self) {
        self.frame += 1;
    }

    /// The bind group of an array.
    pub(crate) fn group(&self, array: usize) -> Option<&wgpu::BindGroup> {
        self.groups.get(array)
    }

    /// Where a normal tile is; uploads it if it is new. `None` for one that is not a whole grid.
    pub(crate) fn place(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        tile: &NormalTile,
    ) -> Option<NormalPlace> {
        if let Some(held) = self.held.get_mut(&tile.serial) {
            held.drawn_in_frame = self.frame;
            return Some(held.place);
        }
        if tile.texels.len() != NORMAL_SIDE * NORMAL_SIDE {
            return None;
        }
        let place = self.take_layer(device)?;
        let side = NORMAL_SIDE as u32;
        // The bits of half floats, as bytes.
        let bytes: Vec<u8> = tile.texels.iter().flatten().flat_map(|half| half.to_le_bytes()).collect();
        queue.write_texture(
            wgpu::TexelCopyTextureInfo {
                texture: self.textures.get(place.array)?,
                mip_level: 0,
                origin: wgpu::Origin3d { x: 0, y: 0, z: place.layer },
                aspect: wgpu::TextureAspect::All,
            },
            &bytes,
            wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(side * 8), rows_per_image: Some(side) },
            wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 1 },
        );
        self.held.insert(tile.serial, Held { place, drawn_in_frame: self.frame });
        Some(place)
    }

    fn take_layer(&mut self, device: &wgpu::Device) -> Option<NormalPlace> {
        if self.free.is_empty() {
            let frame = self.frame;
            let free = &mut self.free;
            self.held.retain(|_, held| {
                let keep = held.drawn_in_frame + 1 > frame;
                if !keep {
                    free.push(held.place);
                }
                keep
            });
        }
        if self.free.is_empty() {
            self.grow(device);
        }
        self.free.pop()
    }

    fn grow(&mut self, device: &wgpu::Device) {
        let side = NORMAL_SIDE as u32;
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("normal tiles"),
            size: wgpu::Extent3d { width: side, height: side, depth_or_array_layers: LAYERS },
            mip_level_count: 1,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let view = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::D2Array),
            ..wgpu::TextureViewDescriptor::default()
        });
        let array = self.textures.len();
        self.groups.push(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("normal tiles"),
            layout: &self.layout,
            entries: &[wgpu::BindGroupEntry { binding: 0, resource: wgpu::BindingResource::TextureView(&view) }],
        }));
        self.textures.push(texture);
        self.free.extend((0..LAYERS).rev().map(|layer| NormalPlace { array, layer }));
    }
}
