//! The planting map of a view on the GPU (`planting.wgsl`).

use crate::life::planting_map::PlantingMap;
use crate::render::scene;
use crate::render::uniforms::Body;
use glam::DVec2;
use std::sync::Arc;
use wgpu::util::DeviceExt;

/// The map of a body in a view, in a buffer of group 0.
pub(crate) struct PlantingBuffer {
    pub(crate) buffer: wgpu::Buffer,
    map: Option<Arc<PlantingMap>>,
}

impl PlantingBuffer {
    /// An empty buffer, which stands in where no edit changes what stands on the ground.
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self { buffer: buffer(device, &[0]), map: None }
    }

    /// Memory of the buffer.
    pub(crate) fn resident_bytes(&self) -> u64 {
        self.buffer.size()
    }

    /// Takes the map of a body's scenery, and writes to the body's uniforms where it lies. Tells whether the buffer is
    /// another one now.
    pub(crate) fn show(&mut self, device: &wgpu::Device, body: &scene::Body<'_>, to: &mut Body) -> bool {
        let (map, eye_m) = (body.surface.scenery.planting.as_ref(), body.eye_planet_m());
        if let Some(map) = map {
            (to.planting_east, to.planting_north) = (map.east.as_vec3(), map.north.as_vec3());
            to.planting_eye_m = DVec2::new(eye_m.dot(map.east), eye_m.dot(map.north)).as_vec2();
            (to.planting_levels, to.planting_texel_m) = (map.levels, map.texel_m as f32);
        }
        let same = match (&self.map, map) {
            (Some(held), Some(map)) => Arc::ptr_eq(held, map),
            (held, map) => held.is_none() && map.is_none(),
        };
        if !same {
            self.buffer = buffer(device, map.map_or(&[0], |map| &map.texels));
            self.map = map.cloned();
        }
        !same
    }
}

fn buffer(device: &wgpu::Device, texels: &[u32]) -> wgpu::Buffer {
    device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
        label: Some("planting map"),
        contents: bytemuck::cast_slice(texels),
        usage: wgpu::BufferUsages::STORAGE,
    })
}
