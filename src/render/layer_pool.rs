//! Cache of tile images on the GPU: layers of a few large texture arrays, keyed by serial number. A layer is filled
//! once and kept until another tile needs it and no frame has requested it for a while.

use super::gpu;
use std::collections::HashMap;

/// Number of frames after which an unrequested tile may lose its layer. More than one, because a surface that is
/// uploaded ahead is drawn only once its last tile is uploaded.
const KEPT_FRAMES: u64 = 4;

/// Format of the images of a tile.
#[derive(Clone, Copy)]
pub(crate) struct LayerKind {
    pub(crate) label: &'static str,
    /// Width and height of each image, pixels.
    pub(crate) side_px: u32,
    /// One image for each format; at most two.
    pub(crate) formats: &'static [wgpu::TextureFormat],
    /// One more image, which only some tiles have. Its texture has a single layer until the first of them comes.
    pub(crate) extra: Option<wgpu::TextureFormat>,
    /// Layers of one texture array.
    pub(crate) layers: u32,
}

/// Location of a tile in the pool.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct LayerPlace {
    /// Index of the texture array.
    pub(crate) array: usize,
    pub(crate) layer: u32,
}

struct Held {
    place: LayerPlace,
    wanted_in_frame: u64,
}

/// All layers, and a bind group for each array.
pub(crate) struct LayerPool {
    kind: LayerKind,
    layout: wgpu::BindGroupLayout,
    /// For each array, a texture for each format, then the extra one.
    textures: Vec<Vec<wgpu::Texture>>,
    groups: Vec<wgpu::BindGroup>,
    free: Vec<LayerPlace>,
    held: HashMap<u64, Held>,
    frame: u64,
    uploaded_bytes: u64,
}

impl LayerKind {
    /// Bind group layout of one array: a texture for each format.
    pub(crate) fn layout(&self, device: &wgpu::Device) -> wgpu::BindGroupLayout {
        let entry = |(binding, _)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::FRAGMENT | wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Texture {
                sample_type: wgpu::TextureSampleType::Float { filterable: true },
                view_dimension: wgpu::TextureViewDimension::D2Array,
                multisampled: false,
            },
            count: None,
        };
        let entries: Vec<_> = (0..).zip(self.all_formats()).map(entry).collect();
        device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some(self.label), entries: &entries })
    }

    fn all_formats(&self) -> impl Iterator<Item = wgpu::TextureFormat> {
        self.formats.iter().copied().chain(self.extra)
    }

    /// Bytes of an image.
    fn image_bytes(&self, format: wgpu::TextureFormat) -> u64 {
        u64::from(self.side_px * self.side_px * format.block_copy_size(None).unwrap_or(0))
    }

    /// Bytes of the images that every tile has.
    pub(crate) fn tile_bytes(&self) -> u64 {
        self.formats.iter().map(|format| self.image_bytes(*format)).sum()
    }

    fn extent(&self) -> wgpu::Extent3d {
        wgpu::Extent3d { width: self.side_px, height: self.side_px, depth_or_array_layers: 1 }
    }

    fn texture(&self, device: &wgpu::Device, format: wgpu::TextureFormat, layers: u32) -> wgpu::Texture {
        let size = wgpu::Extent3d { depth_or_array_layers: layers, ..self.extent() };
        gpu::written_texture(device, self.label, size, format)
    }

    /// The bind group of an array.
    fn group(
        &self,
        device: &wgpu::Device,
        layout: &wgpu::BindGroupLayout,
        textures: &[wgpu::Texture],
    ) -> wgpu::BindGroup {
        let array_view = |texture: &wgpu::Texture| {
            texture.create_view(&wgpu::TextureViewDescriptor {
                dimension: Some(wgpu::TextureViewDimension::D2Array),
                ..wgpu::TextureViewDescriptor::default()
            })
        };
        let views: Vec<_> = textures.iter().map(array_view).collect();
        let entry =
            |(binding, view)| wgpu::BindGroupEntry { binding, resource: wgpu::BindingResource::TextureView(view) };
        let entries: Vec<_> = (0..).zip(&views).map(entry).collect();
        device.create_bind_group(&wgpu::BindGroupDescriptor { label: Some(self.label), layout, entries: &entries })
    }
}

impl LayerPool {
    /// Creates a pool with one empty array.
    pub(crate) fn new(device: &wgpu::Device, kind: LayerKind) -> Self {
        let mut pool = Self {
            kind,
            layout: kind.layout(device),
            textures: Vec::new(),
            groups: Vec::new(),
            free: Vec::new(),
            held: HashMap::new(),
            frame: 0,
            uploaded_bytes: 0,
        };
        pool.grow(device);
        pool
    }

    /// Must be called once a frame, before the first [`LayerPool::place`] of a drawn tile.
    pub(crate) fn begin_frame(&mut self) {
        self.frame += 1;
    }

    /// The bind group of an array.
    pub(crate) fn group(&self, array: usize) -> Option<&wgpu::BindGroup> {
        self.groups.get(array)
    }

    /// Bytes uploaded since the start.
    pub(crate) fn uploaded_bytes(&self) -> u64 {
        self.uploaded_bytes
    }

    /// Memory of the texture arrays.
    pub(crate) fn resident_bytes(&self) -> u64 {
        self.textures.iter().flatten().map(gpu::texture_bytes).sum()
    }

    /// Uploads a tile ahead of the frame that draws it, if its bytes are `affordable`; a tile already in the pool keeps
    /// its layer. `texels`: as for [`LayerPool::place`]. Returns false if the tile has to wait.
    pub(crate) fn place_ahead(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        serial: u64,
        affordable: &mut dyn FnMut(u64) -> bool,
        texels: impl FnOnce() -> Option<Vec<Vec<u8>>>,
    ) -> bool {
        let fits = self.held.contains_key(&serial) || affordable(self.kind.tile_bytes());
        if fits {
            self.place(device, queue, serial, texels);
        }
        fits
    }

    /// Location of a tile, which is uploaded if it is new. `texels` returns the bytes of each image, the extra one last
    /// if the tile has it, or `None` for a tile that cannot be drawn.
    pub(crate) fn place(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        serial: u64,
        texels: impl FnOnce() -> Option<Vec<Vec<u8>>>,
    ) -> Option<LayerPlace> {
        if let Some(held) = self.held.get_mut(&serial) {
            held.wanted_in_frame = self.frame;
            return Some(held.place);
        }
        let images = texels()?;
        let place = self.take_layer(device)?;
        if let Some(format) = self.kind.extra {
            self.place_extra(device, queue, place, format, images.len() > self.kind.formats.len());
        }
        for (texture, bytes) in self.textures.get(place.array)?.iter().zip(&images) {
            write(queue, texture, place.layer, self.kind.extent(), bytes);
            self.uploaded_bytes += bytes.len() as u64;
        }
        self.held.insert(serial, Held { place, wanted_in_frame: self.frame });
        Some(place)
    }

    /// Makes room for the extra image of a tile that has one; clears the layer's for a tile without.
    fn place_extra(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        place: LayerPlace,
        format: wgpu::TextureFormat,
        has_extra: bool,
    ) {
        let kind = self.kind;
        let Some(textures) = self.textures.get_mut(place.array) else { return };
        let Some(texture) = textures.last_mut() else { return };
        let is_full = texture.depth_or_array_layers() == kind.layers;
        if has_extra && !is_full {
            *texture = kind.texture(device, format, kind.layers);
            self.groups[place.array] = kind.group(device, &self.layout, textures);
        } else if !has_extra && is_full {
            write(queue, texture, place.layer, kind.extent(), &vec![0; kind.image_bytes(format) as usize]);
        }
    }

    fn take_layer(&mut self, device: &wgpu::Device) -> Option<LayerPlace> {
        if self.free.is_empty() {
            let frame = self.frame;
            let free = &mut self.free;
            self.held.retain(|_, held| {
                let keep = held.wanted_in_frame + KEPT_FRAMES > frame;
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
        let kind = self.kind;
        let mut textures: Vec<_> =
            kind.formats.iter().map(|format| kind.texture(device, *format, kind.layers)).collect();
        textures.extend(kind.extra.map(|format| kind.texture(device, format, 1)));
        self.groups.push(kind.group(device, &self.layout, &textures));
        let array = self.textures.len();
        self.textures.push(textures);
        self.free.extend((0..kind.layers).rev().map(|layer| LayerPlace { array, layer }));
    }
}

fn write(queue: &wgpu::Queue, texture: &wgpu::Texture, layer: u32, extent: wgpu::Extent3d, bytes: &[u8]) {
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
            bytes_per_row: Some(bytes.len() as u32 / extent.height),
            rows_per_image: Some(extent.height),
        },
        extent,
    );
}
