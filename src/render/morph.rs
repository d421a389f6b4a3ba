//! Geomorphing of vertices on the GPU (`morph.wgsl`), for all tiles of a frame. Each vertex buffer of the tile pool has
//! a second buffer with the morphed values. Method: [`crate::lod::morph`].

use super::pool::{Place, SLOTS};
use super::scene::split_position;
use super::shared::{MorphEye, SHOWN_BYTES};
use super::wgsl::{self, Uniform as _};
use super::{RenderError, gpu, shaders};
use crate::lod::Ranges;
use crate::lod::range::FULL_AT;
use crate::lod::tile::TILE_VERTICES;
use glam::DVec3;

/// Morphed values of a vertex: vertical shift in metres; then moisture, temperature in °C and height in metres.
pub(crate) const SHOWN_ATTRIBUTES: [wgpu::VertexAttribute; 2] =
    wgpu::vertex_attr_array![11 => Float32, 12 => Float32x3];
/// Bytes of the morphed values for one buffer of the pool.
const PART_BYTES: u64 = SLOTS as u64 * TILE_VERTICES as u64 * SHOWN_BYTES;

/// A tile in the shader's storage buffer.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Job {
    first_vertex: u32,
    spacing_m: f32,
    finer_edges: u32,
    padding: u32,
}

/// A tile to be morphed.
#[derive(Clone, Copy)]
pub(crate) struct Morphed {
    pub(crate) place: Place,
    pub(crate) level: u8,
    /// See [`crate::tiles::Leaf::finer_edges`].
    pub(crate) finer_edges: u8,
}

/// The pipeline of the morph.
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

/// Buffers that belong to one vertex buffer of the pool.
struct Part {
    shown: wgpu::Buffer,
    jobs: wgpu::Buffer,
    group: wgpu::BindGroup,
    count: u32,
}

/// Morphed values of all drawn tiles, on the GPU.
pub(crate) struct Morph {
    layout: wgpu::BindGroupLayout,
    eye: wgpu::Buffer,
    parts: Vec<Part>,
}

impl Morph {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let eye = buffer(device, MorphEye::SIZE as u64, wgpu::BufferUsages::UNIFORM | wgpu::BufferUsages::COPY_DST);
        Self { layout: layout(device), eye, parts: Vec::new() }
    }

    /// Uploads the inputs of a frame: the eye that vertices morph for, and the drawn tiles.
    pub(crate) fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        vertices: &[wgpu::Buffer],
        ranges: &Ranges,
        eye_planet_m: DVec3,
        tiles: &[Morphed],
    ) {
        for vertices in &vertices[self.parts.len().min(vertices.len())..] {
            self.parts.push(Part::new(device, &self.layout, vertices, &self.eye));
        }
        let [high_m, low_m] = split_position(eye_planet_m);
        let eye = MorphEye {
            high_m,
            least_spacings: ranges.least_spacings as f32,
            low_m,
            most_spacings: ranges.most_spacings as f32,
            reach: ranges.reach as f32,
            width_share: (1.0 - FULL_AT) as f32,
        };
        queue.write_buffer(&self.eye, 0, &wgsl::bytes_of(&eye));
        for (number, part) in self.parts.iter_mut().enumerate() {
            let jobs: Vec<Job> = tiles
                .iter()
                .filter(|tile| tile.place.buffer == number)
                .map(|tile| Job {
                    first_vertex: tile.place.base_vertex.unsigned_abs(),
                    spacing_m: ranges.spacing_m(tile.level) as f32,
                    finer_edges: u32::from(tile.finer_edges),
                    padding: 0,
                })
                .collect();
            part.count = jobs.len() as u32;
            queue.write_buffer(&part.jobs, 0, bytemuck::cast_slice(&jobs));
        }
    }

    /// Computes the morph of all tiles given to [`Morph::prepare`].
    pub(crate) fn find(&self, encoder: &mut wgpu::CommandEncoder, pass: &MorphPass) {
        let mut compute = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        compute.set_pipeline(&pass.pipeline);
        for part in self.parts.iter().filter(|part| part.count > 0) {
            compute.set_bind_group(0, &part.group, &[]);
            compute.dispatch_workgroups(part.count, 1, 1);
        }
    }

    /// Memory of the buffers.
    pub(crate) fn resident_bytes(&self) -> u64 {
        self.parts.iter().map(|part| part.shown.size() + part.jobs.size()).sum()
    }

    /// Morphed values for a vertex buffer of the pool.
    pub(crate) fn of(&self, buffer: usize) -> Option<&wgpu::Buffer> {
        self.parts.get(buffer).map(|part| &part.shown)
    }
}

impl Part {
    fn new(device: &wgpu::Device, layout: &wgpu::BindGroupLayout, vertices: &wgpu::Buffer, eye: &wgpu::Buffer) -> Self {
        let usage = wgpu::BufferUsages::STORAGE | wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_SRC;
        let shown = buffer(device, PART_BYTES, usage);
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

#[cfg(all(test, feature = "editor"))]
mod tests {
    use super::*;
    use crate::lod::morph::shifts_m;
    use crate::lod::{Camera, Quality, View};
    use crate::planet::shipped;
    use crate::render::pool::TilePool;
    use crate::sphere::LatLon;
    use crate::terrain::Terrain;
    use crate::tiles::{Leaf, build_now};
    use std::sync::Arc;

    /// Content of a buffer.
    fn read(device: &wgpu::Device, queue: &wgpu::Queue, buffer: &wgpu::Buffer) -> Option<Vec<f32>> {
        let descriptor = wgpu::BufferDescriptor {
            label: Some("read back"),
            size: buffer.size(),
            usage: wgpu::BufferUsages::COPY_DST | wgpu::BufferUsages::MAP_READ,
            mapped_at_creation: false,
        };
        let copy = device.create_buffer(&descriptor);
        let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
        encoder.copy_buffer_to_buffer(buffer, 0, &copy, 0, buffer.size());
        queue.submit([encoder.finish()]);
        copy.slice(..).map_async(wgpu::MapMode::Read, |_| {});
        device.poll(wgpu::PollType::wait_indefinitely()).ok()?;
        let mapped = copy.slice(..).get_mapped_range().ok()?;
        Some(bytemuck::cast_slice(&mapped).to_vec())
    }

    /// The shader puts vertices where `lod::morph` does, to a thousandth of a pixel.
    #[test]
    fn vertices_come_out_on_the_gpu_as_on_the_cpu() {
        let instance = wgpu::Instance::new(wgpu::InstanceDescriptor::new_without_display_handle().with_env());
        let adapter = instance.request_adapter(&wgpu::RequestAdapterOptions::default());
        let adapter = pollster::block_on(adapter).unwrap();
        let (device, queue) = pollster::block_on(adapter.request_device(&wgpu::DeviceDescriptor::default())).unwrap();
        let pass = MorphPass::new(&device).unwrap();
        let mut pool = TilePool::new(&device);
        let mut morph = Morph::new(&device);
        let planet = Arc::new(shipped::layered());
        let place = LatLon::from_degrees(35.0, -5.0);
        let ground_m = planet.radius_m() + Terrain::try_new(planet.clone()).unwrap().height_m(place.direction());
        for (altitude_m, quality) in [(1.7, Quality::Low), (2000.0, Quality::Medium), (1e6, Quality::High)] {
            let camera = Camera::over(place, ground_m + altitude_m, 0.4, -0.4, Camera::DEFAULT_FOV_Y_RAD);
            let view = View { camera, size_px: [320, 200], quality };
            let surface = build_now(&planet, &view).unwrap();
            // The eye is away from the position that the LOD cut was chosen for, as during a flight.
            let eye = surface.morphing_eye_m(camera.position_planet_m * (1.0 + 0.02 * altitude_m / ground_m));
            let mut encoder = device.create_command_encoder(&wgpu::CommandEncoderDescriptor::default());
            pool.begin_round();
            let places: Vec<Place> =
                surface.leaves.iter().map(|leaf| pool.place(&device, &mut encoder, &leaf.tile).unwrap()).collect();
            // All edges as if they had finer neighbours in the last view: there the rule shows.
            let finer_edges = |leaf: &Leaf| if altitude_m > 1e5 { 15 } else { leaf.finer_edges };
            let tiles: Vec<Morphed> = places
                .iter()
                .zip(&surface.leaves)
                .map(|(&place, leaf)| Morphed { place, level: leaf.tile.id.level, finer_edges: finer_edges(leaf) })
                .collect();
            morph.prepare(&device, &queue, pool.buffers(), &surface.ranges, eye, &tiles);
            pool.end_round(&encoder);
            morph.find(&mut encoder, &pass);
            queue.submit([encoder.finish()]);
            let shown: Vec<Vec<f32>> = (0..pool.buffers().len())
                .map(|buffer| read(&device, &queue, morph.of(buffer).unwrap()).unwrap())
                .collect();
            let (mut worst_px, mut on_their_way, mut morphing_tiles) = (0.0_f64, 0, 0);
            for (place, leaf) in places.iter().zip(&surface.leaves) {
                let expected_m = shifts_m(&leaf.tile, finer_edges(leaf), eye, &surface.ranges);
                let moved = |i: &usize| expected_m[*i] != 0.0;
                let many = (0..TILE_VERTICES).filter(moved).count();
                on_their_way += many;
                morphing_tiles += usize::from(many > 0);
                for (i, vertex) in leaf.tile.vertices.iter().enumerate() {
                    let first = place.base_vertex as usize + i;
                    let found_m = shown[place.buffer][first * SHOWN_BYTES as usize / 4];
                    let pixel_m = vertex.position_planet_m().distance(eye) * view.pixel_rad();
                    worst_px = worst_px.max(f64::from((found_m - expected_m[i]).abs()) / pixel_m);
                }
            }
            let name = adapter.get_info().name;
            assert!(morphing_tiles > 10 && on_their_way > 5000, "{altitude_m} m: {on_their_way} in {morphing_tiles}");
            assert!(worst_px < 1e-3, "{altitude_m} m: {worst_px} px on {name}, {on_their_way} on their way");
        }
    }
}
