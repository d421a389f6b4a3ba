//! Light on objects and their drawing: pipelines, and the buffers of a view.

use super::models::{ATTRIBUTES, LifeModels, Vertex};
use super::shadow::{Cascades, SKY_MAP, ShadowMap};
use super::view::{Draw, Instance, LifeView};
use crate::render::body_tiles::BodyTiles;
use crate::render::horizon_pool::HORIZON;
use crate::render::screen_pass::Shared;
use crate::render::targets::{RADIANCE_FORMAT, Target};
use crate::render::{FrameStats, RenderError, ShadowCaster, gpu, shaders};
use wgpu::util::DeviceExt;

const ENTRY: &str = "life.wgsl";
const LIGHT_ENTRY: &str = "life_light.wgsl";
const SHADOW_ENTRY: &str = "life_shadow.wgsl";
/// Bytes of the light on an object, as `life_instance.wgsl` describes it.
const LIGHT_BYTES: u64 = 32;
/// Invocations of a workgroup of `life_light.wgsl`.
const GROUP: u32 = 64;

/// Pipelines of objects.
pub(crate) struct LifePass {
    draw: wgpu::RenderPipeline,
    light: wgpu::ComputePipeline,
    shadow: wgpu::RenderPipeline,
    drawn: wgpu::BindGroupLayout,
    lit: wgpu::BindGroupLayout,
    /// A map of shadows, and the objects that are drawn into it.
    caster: wgpu::BindGroupLayout,
    cast: wgpu::BindGroupLayout,
}

/// Buffers of the objects of a view.
pub(super) struct Buffers {
    instances: wgpu::Buffer,
    lights: wgpu::Buffer,
    casting: wgpu::Buffer,
}

impl Buffers {
    /// Writes the objects that are seen and those that cast shadows; buffers that are too small are made anew.
    pub(super) fn write(
        buffers: &mut Option<Self>,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        [instances, casting]: [&[Instance]; 2],
    ) {
        const BYTES: u64 = size_of::<Instance>() as u64;
        let fits = |buffer: &wgpu::Buffer, instances: &[Instance]| buffer.size() >= instances.len() as u64 * BYTES;
        if buffers.as_ref().is_none_or(|all| !fits(&all.instances, instances) || !fits(&all.casting, casting)) {
            let room = |instances: &[Instance]| instances.len().next_power_of_two().max(256) as u64;
            let buffer = |label, size, usage| {
                let usage = wgpu::BufferUsages::STORAGE | usage;
                let descriptor = wgpu::BufferDescriptor { label: Some(label), size, usage, mapped_at_creation: false };
                device.create_buffer(&descriptor)
            };
            let written = wgpu::BufferUsages::COPY_DST;
            *buffers = Some(Self {
                instances: buffer("objects", room(instances) * BYTES, written),
                lights: buffer("light on objects", room(instances) * LIGHT_BYTES, wgpu::BufferUsages::empty()),
                casting: buffer("objects with shadows", room(casting) * BYTES, written),
            });
        }
        if let Some(buffers) = buffers {
            queue.write_buffer(&buffers.instances, 0, bytemuck::cast_slice(instances));
            queue.write_buffer(&buffers.casting, 0, bytemuck::cast_slice(casting));
        }
    }

    pub(super) fn resident_bytes(&self) -> u64 {
        self.instances.size() + self.lights.size() + self.casting.size()
    }
}

/// Where the objects of a body are drawn: over its ground.
pub(crate) struct LifeTargets<'a> {
    pub(crate) radiance: &'a wgpu::TextureView,
    pub(crate) surface: &'a wgpu::TextureView,
    pub(crate) depth: &'a wgpu::TextureView,
    pub(crate) viewport_px: [u32; 4],
}

/// A layout of buffers, storage read or written, or uniform.
fn buffers(
    device: &wgpu::Device,
    visibility: wgpu::ShaderStages,
    kinds: &[wgpu::BufferBindingType],
) -> wgpu::BindGroupLayout {
    let entries: Vec<_> = (0..)
        .zip(kinds)
        .map(|(binding, ty)| wgpu::BindGroupLayoutEntry {
            binding,
            visibility,
            ty: wgpu::BindingType::Buffer { ty: *ty, has_dynamic_offset: false, min_binding_size: None },
            count: None,
        })
        .collect();
    device.create_bind_group_layout(&wgpu::BindGroupLayoutDescriptor { label: Some("life"), entries: &entries })
}

impl LifePass {
    pub(crate) fn new(device: &wgpu::Device, shared: Shared<'_>) -> Result<Self, RenderError> {
        let storage = |read_only| wgpu::BufferBindingType::Storage { read_only };
        let drawn = buffers(device, wgpu::ShaderStages::VERTEX, &[storage(true), storage(true)]);
        let kinds = [storage(true), storage(false), wgpu::BufferBindingType::Uniform];
        let lit = buffers(device, wgpu::ShaderStages::COMPUTE, &kinds);
        let caster = buffers(device, wgpu::ShaderStages::VERTEX_FRAGMENT, &[wgpu::BufferBindingType::Uniform]);
        let cast = buffers(device, wgpu::ShaderStages::VERTEX, &[storage(true)]);
        let formats =
            [Target::Radiance, Target::GroundSurface].map(|target| target.format().unwrap_or(RADIANCE_FORMAT));
        let nearer = wgpu::CompareFunction::Greater;
        let draw = mesh_pipeline(device, ENTRY, &[shared.uniforms, &drawn], (&ATTRIBUTES, &formats, nearer))?;
        // Depth from the sun is not reversed.
        let nearer = wgpu::CompareFunction::Less;
        let shadow = mesh_pipeline(device, SHADOW_ENTRY, &[&caster, &cast], (&ATTRIBUTES[..1], &[], nearer))?;
        let light = Self::light_pipeline(device, shared, &lit)?;
        Ok(Self { draw, light, shadow, drawn, lit, caster, cast })
    }

    fn light_pipeline(
        device: &wgpu::Device,
        shared: Shared<'_>,
        lit: &wgpu::BindGroupLayout,
    ) -> Result<wgpu::ComputePipeline, RenderError> {
        let module = shaders::module(device, LIGHT_ENTRY)?;
        let horizon = HORIZON.layout(device);
        let layout = gpu::pipeline_layout(device, LIGHT_ENTRY, &[shared.uniforms, shared.luts, lit, &horizon]);
        gpu::checked(device, LIGHT_ENTRY, || {
            device.create_compute_pipeline(&wgpu::ComputePipelineDescriptor {
                label: Some(LIGHT_ENTRY),
                layout: Some(&layout),
                module: &module,
                entry_point: Some("compute"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                cache: None,
            })
        })
    }

    /// Finds the light on the objects of a view. `groups`: uniforms and LUTs of the body.
    pub(crate) fn light(
        &self,
        device: &wgpu::Device,
        encoder: &mut wgpu::CommandEncoder,
        groups: [&wgpu::BindGroup; 2],
        tiles: &BodyTiles,
        view: &LifeView,
    ) {
        let Some(buffers) = view.buffers.as_ref().filter(|_| !view.instances.is_empty()) else { return };
        let mut pass = encoder.begin_compute_pass(&wgpu::ComputePassDescriptor::default());
        pass.set_pipeline(&self.light);
        pass.set_bind_group(0, groups[0], &[]);
        pass.set_bind_group(1, groups[1], &[]);
        for lit in &view.lit {
            let count = lit.instances.len() as u32;
            let span = [lit.instances.start, count, 0, 0];
            let span = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("span of objects"),
                contents: bytemuck::cast_slice(&span),
                usage: wgpu::BufferUsages::UNIFORM,
            });
            let resources = [&buffers.instances, &buffers.lights, &span].map(wgpu::Buffer::as_entire_binding);
            pass.set_bind_group(2, &gpu::group(device, "light on objects", &self.lit, resources), &[]);
            pass.set_bind_group(3, tiles.horizons.group(lit.array), &[]);
            pass.dispatch_workgroups(count.div_ceil(GROUP), 1, 1);
        }
    }

    /// Layout of the group that tells shaders about a map of shadows.
    pub(crate) fn caster_layout(&self) -> &wgpu::BindGroupLayout {
        &self.caster
    }

    /// Draws the depth of objects and of a game's things from the sun into the maps of shadows of a view.
    pub(crate) fn cast(
        &self,
        (device, encoder): (&wgpu::Device, &mut wgpu::CommandEncoder),
        (models, view, shadows): (&LifeModels, &LifeView, Option<(&Cascades, &ShadowMap)>),
        casters: &[&dyn ShadowCaster],
    ) {
        let Some((cascades, map)) = shadows else { return };
        for (number, (to, layer)) in cascades.views().iter().zip(&map.layers).enumerate() {
            let matrix = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
                label: Some("map of shadows"),
                contents: bytemuck::cast_slice(&to.clip_from_rel_m.to_cols_array()),
                usage: wgpu::BufferUsages::UNIFORM,
            });
            let group = gpu::group(device, "map of shadows", &self.caster, [matrix.as_entire_binding()]);
            let depth_ops = Some(wgpu::Operations { load: wgpu::LoadOp::Clear(1.0), store: wgpu::StoreOp::Store });
            let mut pass = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
                label: Some("shadows"),
                depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                    view: layer,
                    depth_ops,
                    stencil_ops: None,
                }),
                ..wgpu::RenderPassDescriptor::default()
            });
            pass.set_bind_group(0, &group, &[]);
            let draws = view.casts.get(number).filter(|draws| !draws.is_empty());
            if let Some((draws, buffers)) = draws.zip(view.buffers.as_ref()) {
                let objects = gpu::group(device, "casting", &self.cast, [buffers.casting.as_entire_binding()]);
                pass.set_pipeline(&self.shadow);
                pass.set_bind_group(1, &objects, &[]);
                draw_parts(&mut pass, models, draws);
            }
            let is_seen = |caster: &&&dyn ShadowCaster| {
                let (center_planet_m, radius_m) = caster.ball();
                number != SKY_MAP && to.sees(center_planet_m, radius_m)
            };
            for caster in casters.iter().filter(is_seen) {
                pass.set_bind_group(0, &group, &[]);
                caster.draw(&mut pass, to);
            }
        }
    }

    /// Draws the objects of a view over its ground. `group`: uniforms of the body.
    pub(crate) fn draw(
        &self,
        (device, encoder): (&wgpu::Device, &mut wgpu::CommandEncoder),
        group: &wgpu::BindGroup,
        (models, view): (&LifeModels, &LifeView),
        to: &LifeTargets<'_>,
    ) -> FrameStats {
        let mut stats = FrameStats::default();
        let Some(buffers) = view.buffers.as_ref().filter(|_| !view.instances.is_empty()) else { return stats };
        let resources = [&buffers.instances, &buffers.lights].map(wgpu::Buffer::as_entire_binding);
        let objects = gpu::group(device, "objects", &self.drawn, resources);
        let ops = wgpu::Operations { load: wgpu::LoadOp::Load, store: wgpu::StoreOp::Store };
        let attachment =
            |view| Some(wgpu::RenderPassColorAttachment { view, depth_slice: None, resolve_target: None, ops });
        let mut draw = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("life"),
            color_attachments: &[attachment(to.radiance), attachment(to.surface)],
            depth_stencil_attachment: Some(gpu::depth_attachment(to.depth, true)),
            ..wgpu::RenderPassDescriptor::default()
        });
        draw.set_pipeline(&self.draw);
        gpu::set_viewport(&mut draw, to.viewport_px);
        draw.set_bind_group(0, group, &[]);
        draw.set_bind_group(1, &objects, &[]);
        stats.triangles = draw_parts(&mut draw, models, &view.draws);
        stats.objects_drawn = view.count();
        stats
    }
}

/// A pipeline that draws meshes, seen from both sides as leaves are, into targets of these formats and into depth.
fn mesh_pipeline(
    device: &wgpu::Device,
    entry: &str,
    groups: &[&wgpu::BindGroupLayout],
    (attributes, formats, nearer): (&[wgpu::VertexAttribute], &[wgpu::TextureFormat], wgpu::CompareFunction),
) -> Result<wgpu::RenderPipeline, RenderError> {
    let module = shaders::module(device, entry)?;
    let layout = gpu::pipeline_layout(device, entry, groups);
    let vertices = wgpu::VertexBufferLayout {
        array_stride: size_of::<Vertex>() as u64,
        step_mode: wgpu::VertexStepMode::Vertex,
        attributes,
    };
    let targets: Vec<_> = formats.iter().map(|format| Some((*format).into())).collect();
    gpu::checked(device, entry, || {
        device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
            label: Some(entry),
            layout: Some(&layout),
            vertex: wgpu::VertexState {
                module: &module,
                entry_point: Some("vertex"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                buffers: &[Some(vertices)],
            },
            fragment: Some(wgpu::FragmentState {
                module: &module,
                entry_point: Some("fragment"),
                compilation_options: wgpu::PipelineCompilationOptions::default(),
                targets: &targets,
            }),
            primitive: wgpu::PrimitiveState::default(),
            depth_stencil: Some(gpu::depth_state(nearer)),
            multisample: wgpu::MultisampleState::default(),
            multiview_mask: None,
            cache: None,
        })
    })
}

/// Draws instances of meshes; counts the triangles.
fn draw_parts(pass: &mut wgpu::RenderPass<'_>, models: &LifeModels, draws: &[Draw]) -> usize {
    let mut triangles = 0;
    for part in draws {
        let Some(model) = models.get(part.model) else { continue };
        let Some(mesh) = model.part(part.variant, part.level) else { continue };
        pass.set_vertex_buffer(0, model.vertices.slice(..));
        pass.set_index_buffer(model.indices.slice(..), wgpu::IndexFormat::Uint16);
        pass.draw_indexed(mesh.indices.clone(), mesh.base_vertex, part.instances.clone());
        triangles += part.instances.len() * mesh.indices.len() / 3;
    }
    triangles
}
