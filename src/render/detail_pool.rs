//! Detail tiles on the GPU: layers of a few pairs of large texture arrays, keyed by [`DetailTile::serial`], filled once and kept until
//! another needs the room and nobody has drawn them for a while.

use crate::lod::tile::{DETAIL_SIDE, DetailTile};
use std::collections::HashMap;

/// Layers of one pair: 17 MB.
const LAYERS: u32 = 64;

/// Where a detail tile is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct DetailPlace {
    /// Index of the texture array.
    pub(crate) array: usize,
    pub(crate) layer: u32,
}

struct Held {
    place: DetailPlace,
    drawn_in_frame: u64,
}

/// All layers, and a bind group for each array.
pub(crate) struct DetailPool {
    layout: wgpu::BindGroupLayout,
    /// Slopes and heights.
    textures: Vec<[wgpu::Texture; 2]>,
    groups: Vec<wgpu::BindGroup>,
    free: Vec<DetailPlace>,
    held: HashMap<u64, Held>,
    frame: u64,
}

impl DetailPool {
    /// The bind group layout of one array.
    pub(crate) fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor {
            label: Some("detail tiles"),
            entries: &[0, 1].map(|binding| wgpu::BindGroupLayoutEntry {
                binding,
                visibility: wgpu::ShaderStages::FRAGMENT,
                ty: wgpu::BindingType::Texture {
                    sample_type: wgpu::TextureSampleType::Float { filterable: true },
                    view_dimension: wgpu::TextureViewDimension::D2Array,
                    multisampled: false,
                },
                count: None,
            }),
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

    /// Call once a frame, before the first [`DetailPool::place`].
    pub(crate) fn begin_frame(&mut self) {
        self.frame += 1;
    }

    /// The bind group of an array.
    pub(crate) fn group(&self, array: usize) -> Option<&wgpu::BindGroup> {
        self.groups.get(array)
    }

    /// Where a detail tile is; uploads it if it is new. `None` for one that is not a whole grid.
    pub(crate) fn place(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        tile: &DetailTile,
    ) -> Option<DetailPlace> {
        if let Some(held) = self.held.get_mut(&tile.serial) {
            held.drawn_in_frame = self.frame;
            return Some(held.place);
        }
        if tile.slopes.len() != DETAIL_SIDE * DETAIL_SIDE || tile.heights.len() != tile.slopes.len() {
            return None;
        }
        let place = self.take_layer(device)?;
        let [slopes, heights] = self.textures.get(place.array)?;
        let bytes = |texels: &[[half::f16; 4]]| -> Vec<u8> {
            texels.iter().flatten().copied().flat_map(half::f16::to_le_bytes).collect()
        };
        write(queue, slopes, place.layer, &bytes(&tile.slopes));
        write(queue, heights, place.layer, &bytes(&tile.heights));
        self.held.insert(tile.serial, Held { place, drawn_in_frame: self.frame });
        Some(place)
    }

    fn take_layer(&mut self, device: &wgpu::Device) -> Option<DetailPlace> {
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
        let textures = [wgpu::TextureFormat::Rgba16Float; 2].map(|format| {
            device.create_texture(&wgpu::TextureDescriptor {
                label: Some("detail tiles"),
                size: wgpu::Extent3d { depth_or_array_layers: LAYERS, ..EXTENT },
                mip_level_count: 1,
                sample_count: 1,
                dimension: wgpu::TextureDimension::D2,
                format,
                usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
                view_formats: &[],
            })
        });
        let [slopes, heights] = textures.each_ref().map(|texture| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..wgpu::TextureViewDescriptor::default()
            })
        });
        let entry =
            |binding, view| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
        self.groups.push(device.create_bind_group(&wgpu::BindGroupDescriptor {
            label: Some("detail tiles"),
            layout: &self.layout,
            entries: &[entry(0, &slopes), entry(1, &heights)],
        }));
        let array = self.textures.len();
        self.textures.push(textures);
        self.free.extend((0..LAYERS).rev().map(|layer| DetailPlace { array, layer }));
    }
}

/// Size of one tile.
const EXTENT: wgpu::Extent3d =
    wgpu::Extent3d { width: DETAIL_SIDE as u32, height: DETAIL_SIDE as u32, depth_or_array_layers: 1 };

fn write(queue: &wgpu::Queue, texture: &wgpu::Texture, layer: u32, bytes: &[u8]) {
    let bytes_per_row = bytes.len() as u32 / EXTENT.height;
    queue.write_texture(
        wgpu::TexelCopyTextureInfo {
            texture,
            mip_level: 0,
            origin: wgpu::Origin3d { x: 0, y: 0, z: layer },
            aspect: wgpu::TextureAspect::All,
        },
        bytes,
        wgpu::TexelCopyBufferLayout {
            offset: 0,
            bytes_per_row: Some(bytes_per_row),
            rows_per_image: Some(EXTENT.height),
        },
        EXTENT,
    );
}
