//! Meshes of forms on the GPU: a vertex and an index buffer for each model.

use crate::life::Model;
use crate::life::form::{self, LEVELS, Mesh};
use crate::planet::Key;
use std::collections::HashMap;
use std::ops::Range;
use wgpu::util::DeviceExt;

/// A vertex, as `life.wgsl` reads it.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
pub(super) struct Vertex {
    position: [f32; 3],
    /// The last number is the logarithm to base 2 of the level's factor of light.
    normal: [i8; 4],
    look: [u8; 4],
    /// Roots of the factors on the colours: 128 is 1.
    tint: [u8; 4],
}

/// The attributes of a vertex.
pub(super) const ATTRIBUTES: [wgpu::VertexAttribute; 4] =
    wgpu::vertex_attr_array![0 => Float32x3, 1 => Snorm8x4, 2 => Unorm8x4, 3 => Unorm8x4];

/// A corner of a mesh of a level. `light`: logarithm of the level's factor of light.
pub(super) fn packed(vertex: &form::Vertex, light: i8, level: usize) -> Vertex {
    let [x, y, z] = vertex.normal.to_array().map(|part| (part * 127.0).round() as i8);
    let look = [vertex.part, vertex.light, vertex.sway].map(|share| (share * 255.0).round() as u8);
    let [r, g, b] = vertex.tint.to_array().map(|part| (part.max(0.0).sqrt() * 128.0).round() as u8);
    Vertex {
        position: vertex.position.to_array(),
        normal: [x, y, z, light],
        look: [look[0], look[1], look[2], (level * 85) as u8],
        tint: [r, g, b, 0],
    }
}

/// A mesh in the buffers of its model.
#[derive(Clone)]
pub(super) struct Part {
    pub(super) indices: Range<u32>,
    pub(super) base_vertex: i32,
}

/// A model on the GPU.
pub(super) struct GpuModel {
    pub(super) vertices: wgpu::Buffer,
    pub(super) indices: wgpu::Buffer,
    /// For each variant and level.
    parts: Vec<[Part; LEVELS]>,
}

impl GpuModel {
    fn new(device: &wgpu::Device, model: &Model) -> Self {
        let (mut vertices, mut indices): (Vec<Vertex>, Vec<u16>) = Default::default();
        let mut add = |level: usize, mesh: &Mesh| {
            let light = (model.level_light[level].log2().clamp(-1.0, 1.0) * 127.0).round() as i8;
            let (base_vertex, first) = (vertices.len() as i32, indices.len() as u32);
            vertices.extend(mesh.vertices.iter().map(|vertex| packed(vertex, light, level)));
            indices.extend(mesh.triangles.iter().flatten());
            Part { indices: first..indices.len() as u32, base_vertex }
        };
        let parts =
            model.variants.iter().map(|levels| std::array::from_fn(|level| add(level, &levels[level]))).collect();
        // Buffers are copied in words.
        if !indices.len().is_multiple_of(2) {
            indices.push(0);
        }
        let buffer = |contents: &[u8], usage| {
            device.create_buffer_init(&wgpu::util::BufferInitDescriptor { label: Some("model"), contents, usage })
        };
        Self {
            vertices: buffer(bytemuck::cast_slice(&vertices), wgpu::BufferUsages::VERTEX),
            indices: buffer(bytemuck::cast_slice(&indices), wgpu::BufferUsages::INDEX),
            parts,
        }
    }

    /// The mesh of a variant and level.
    pub(super) fn part(&self, variant: usize, level: usize) -> Option<&Part> {
        self.parts.get(variant)?.get(level)
    }
}

/// The models that the views of a body draw.
#[derive(Default)]
pub(crate) struct LifeModels(HashMap<Key, GpuModel>);

/// Models that are kept; beyond, those that a frame does not draw are dropped.
const MOST_KEPT: usize = 64;

impl LifeModels {
    /// Uploads the models of a scenery that are not there yet.
    pub(super) fn upload<'a>(&mut self, device: &wgpu::Device, models: impl Iterator<Item = &'a Model> + Clone) {
        if self.0.len() > MOST_KEPT {
            self.0.retain(|key, _| models.clone().any(|model| model.key == *key));
        }
        for model in models {
            self.0.entry(model.key).or_insert_with(|| GpuModel::new(device, model));
        }
    }

    pub(super) fn get(&self, key: Key) -> Option<&GpuModel> {
        self.0.get(&key)
    }

    /// Memory of the buffers.
    pub(crate) fn resident_bytes(&self) -> u64 {
        self.0.values().map(|model| model.vertices.size() + model.indices.size()).sum()
    }
}
