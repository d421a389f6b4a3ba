//! How far vertices have come out of the coarser mesh (`morph.wgsl`), for all tiles of a frame: beside each buffer of vertices one of
//! what they show.

use super::pool::{Place, SLOTS};
use super::{RenderError, gpu, shaders};
use crate::lod::Ranges;
use crate::lod::range::FULL_AT;
use crate::lod::tile::TILE_VERTICES;
use glam::DVec3;

/// What a vertex shows: how far it is drawn above its place; moisture, row of the biome table, height and temperature.
pub(crate) const SHOWN_ATTRIBUTES: [wgpu::VertexAttribute; 2] =
    wgpu::vertex_attr_array![11 => Float32, 12 => Float32x3];
/// Bytes of it.
pub(crate) const SHOWN_BYTES: u64 = 4 * 4;
/// Bytes of what belongs to one buffer of the pool.
const PART_BYTES: u64 = SLOTS as u64 * TILE_VERTICES as u64 * SHOWN_BYTES;

/// One tile as the shader knows it.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Job {
    first_vertex: u32,
    spacing_m: f32,
    padding: [u32; 2],
}

/// The pipeline.
pub(crate) struct MorphPass {
    pipeline: wgpu::ComputePipeline,
}

impl MorphPass {
    pub(crate) fn new(device: &wgpu::Device) -> Result<Self, RenderError> {
        const ENTRY: &str = "morph.wgsl";
        let module = shaders::module(device, ENTRY)?;
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(ENTRY),
            bind_group_layouts: &[Some(&layout(device))],
            immediate_size: 0,
        });
        let pipeline = gpu::checked(device, ENTRY, || {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(ENTRY),
                layout: Some(&layout),
                module: &module,
                entry_point: Some("compute"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        })?;
        Ok(Self { pipeline })
    }
}

fn layout(device: &wgpu::Device) -> wgpu::BindGroupLayout {
    let storage = |read_only| wgpu::BufferBindingType::Storage { read_only };
    let kinds = [storage(true), storage(false), storage(true), wgpu::BufferBindingType::Uniform];
    let entries: Vec<_> = (0..)
        .zip(kinds)
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility: wgpu::ShaderStages::COMPUTE,
            ty: wgpu::BindingType::Buffer { ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("morph"), entries: &entries })
}

/// What belongs to one buffer of the pool.
struct Part {
    shown: wgpu::Buffer,
    jobs: wgpu::Buffer,
    group: wgpu::BindGroup,
    count: u32,
}

/// What the vertices of all tiles show, on the GPU.
pub(crate) struct Morph {
    layout: wgpu::BindGroupLayout,
    eye: wgpu::Buffer,
    parts: Vec<Part>,
}

impl Morph {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let eye = buffer(device, 48, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST);
        Self { layout: layout(device), eye, parts: Vec::new() }
    }

    /// Sets what is to be found for a frame: the eye that vertices come out for; where each tile is that is drawn, and its level.
    pub(crate) fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        vertices: &[wgpu::Buffer],
        ranges: &Ranges,
        eye_planet_m: DVec3,
        tiles: &[(Place, u8)],
    ) {
        for vertices in &vertices[self.parts.len().min(vertices.len())..] {
            self.parts.push(Part::new(device, &self.layout, vertices, &self.eye));
        }
        let high = eye_planet_m.as_vec3();
        let low = (eye_planet_m - high.as_dvec3()).as_vec3();
        let numbers = [ranges.least_spacings, ranges.most_spacings, ranges.reach, 1.0 - FULL_AT].map(|x| x as f32);
        let eye = [high.extend(0.0).to_array(), low.extend(0.0).to_array(), numbers];
        queue.write_buffer(&self.eye, 0, bytemuck::cast_slice(&eye));
        for (number, part) in self.parts.iter_mut().enumerate() {
            let jobs: Vec<Job> = tiles
                .iter()
                .filter(|(place, _)| place.buffer == number)
                .map(|(place, level)| Job {
                    first_vertex: place.base_vertex.unsigned_abs(),
                    spacing_m: ranges.spacing_m(*level) as f32,
                    padding: [0; 2],
                })
                .collect();
            part.count = jobs.len() as u32;
            queue.write_buffer(&part.jobs, 0, bytemuck::cast_slice(&jobs));
        }
    }

    /// Finds it for all tiles given to [`Morph::prepare`].
    pub(crate) fn find(&self, encoder: &mut wgpu::CommandEncoder, pass: &MorphPass) {
        let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        compute.set_pipeline(&pass.pipeline);
        for part in self.parts.iter().filter(|part| part.count > 0) {
            compute.set_bind_group(0, &part.group, &[]);
            compute.dispatch_workgroups(part.count, 1, 1);
        }
    }

    /// What stands beside a buffer of the pool.
    pub(crate) fn of(&self, buffer: usize) -> Option<&wgpu::Buffer> {
        self.parts.get(buffer).map(|part| &part.shown)
    }
}

impl Part {
    fn new(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, vertices: &wgpu::Buffer, eye: &wgpu::Buffer) -> Self {
        let shown = buffer(device, PART_BYTES, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX);
        let jobs_bytes = u64::from(SLOTS) * size_of::<Job>() as u64;
        let jobs = buffer(device, jobs_bytes, wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::COPY_DST);
        let buffers = [vertices, &shown, &jobs, eye];
        let entries: Vec<_> = (0..)
            .zip(buffers)
            .map(|(binding, buffer)| wgpu::BindGroupEntry { binding, resource: buffer.as_entire_binding() })
            .collect();
        let descriptor = wgpu::BindGroupDescriptor { label: Some("morph"), layout, entries: &entries };
        let group = device.create_bind_group(&descriptor);
        Self { shown, jobs, group, count: 0 }
    }
}

fn buffer(device: &wgpu::Device, size: u64, usage: wgpu::BufferUsages) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor { label: Some("morph"), size, usage, mapped_at_creation: false })
}
