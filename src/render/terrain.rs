//! The ground (`terrain.wgsl`): pipelines, index lists, and the draw calls of the tiles that a [`GroundView`] chose.

use super::body_tiles::BodyTiles;
use super::detail_pool::DETAIL;
use super::gpu;
use super::ground_view::{GroundView, INSTANCE_BYTES};
use super::horizon_pool::HORIZON;
use super::morph::SHOWN_ATTRIBUTES;
use super::screen_pass::Shared;
use super::shared::SHOWN_BYTES;
use super::targets::{RADIANCE_FORMAT, Target};
use super::variant::Variant;
use super::{FrameStats, RenderError, shaders};
use crate::lod::stitch;
use crate::lod::tile::Vertex;
use std::collections::{HashMap, HashSet};
use std::mem::offset_of;
use std::ops::Range;
use std::sync::{Mutex, PoisonError};
use wgpu::util::DeviceExt;

/// The attributes of a vertex that the shader reads. Height and climate come from morphing.
const VERTEX_ATTRIBUTES: [wgpu::VertexAttribute; 4] = [
    attribute(0, wgpu::VertexFormat::Float32x3, offset_of!(Vertex, position_high_m)),
    attribute(2, wgpu::VertexFormat::Float32x3, offset_of!(Vertex, position_low_m)),
    attribute(5, wgpu::VertexFormat::Snorm16x2, offset_of!(Vertex, normal_oct)),
    attribute(6, wgpu::VertexFormat::Snorm16x2, offset_of!(Vertex, parent_normal_oct)),
];
const INSTANCE_ATTRIBUTES: [wgpu::VertexAttribute; 5] =
    wgpu::vertex_attr_array![7 => Float32x4, 8 => Float32x3, 9 => Float32x4, 10 => Float32x4, 13 => Float32x4];

const fn attribute(shader_location: u32, format: wgpu::VertexFormat, offset: usize) -> wgpu::VertexAttribute {
    wgpu::VertexAttribute { format, offset: offset as u64, shader_location }
}

const ENTRY: &str = "terrain.wgsl";

/// Pipelines of the ground.
pub(crate) struct TerrainPass {
    layout: wgpu::PipelineLayout,
    module: wgpu::ShaderModule,
    /// By whether edges alone are drawn, and by variant.
    pipelines: Mutex<HashMap<(bool, Variant), wgpu::RenderPipeline>>,
}

impl TerrainPass {
    pub(crate) fn new(device: &wgpu::Device, shared: Shared<'_>) -> Result<Self, RenderError> {
        let module = shaders::module(device, ENTRY)?;
        let (detail, horizon) = (DETAIL.layout(device), HORIZON.layout(device));
        let layout = gpu::pipeline_layout(device, ENTRY, &[shared.uniforms, shared.luts, &detail, &horizon]);
        let made = Self { layout, module, pipelines: Mutex::default() };
        made.pipeline(device, false, Variant::FIRST)?;
        Ok(made)
    }

    /// The pipeline for triangles or their edges, and a body.
    fn pipeline(
        &self,
        device: &wgpu::Device,
        lines: bool,
        variant: Variant,
    ) -> Result<wgpu::RenderPipeline, RenderError> {
        let variant = variant.of_ground();
        let mut pipelines = self.pipelines.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(pipeline) = pipelines.get(&(lines, variant)) {
            return Ok(pipeline.clone());
        }
        let buffer = |array_stride, step_mode, attributes| {
            Some(wgpu::VertexBufferLayout { array_stride, step_mode, attributes })
        };
        let buffers = [
            buffer(size_of::<Vertex>() as u64, wgpu::VertexStepMode::Vertex, &VERTEX_ATTRIBUTES[..]),
            buffer(INSTANCE_BYTES, wgpu::VertexStepMode::Instance, &INSTANCE_ATTRIBUTES[..]),
            buffer(SHOWN_BYTES, wgpu::VertexStepMode::Vertex, &SHOWN_ATTRIBUTES[..]),
        ];
        let formats =
            [Target::Radiance, Target::GroundSurface].map(|target| target.format().unwrap_or(RADIANCE_FORMAT));
        let (topology, cull_mode) = match lines {
            false => (wgpu::PrimitiveTopology::TriangleList, Some(wgpu::Face::Back)),
            true => (wgpu::PrimitiveTopology::LineList, None),
        };
        let constants = variant.constants_of_ground();
        let pipeline = gpu::checked(device, ENTRY, || {
            device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                label: Some(ENTRY),
                layout: Some(&self.layout),
                vertex: wgpu::VertexState {
                    module: &self.module,
                    entry_point: Some("vertex"),
                    compilation_options: wgpu::PipelineCompilationOptions::default(),
                    buffers: &buffers,
                },
                fragment: Some(wgpu::FragmentState {
                    module: &self.module,
                    entry_point: Some("fragment"),
                    compilation_options: wgpu::PipelineCompilationOptions {
                        constants: &constants,
                        ..wgpu::PipelineCompilationOptions::default()
                    },
                    targets: &formats.map(|format| Some(format.into())),
                }),
                primitive: wgpu::PrimitiveState { topology, cull_mode, ..wgpu::PrimitiveState::default() },
                depth_stencil: Some(gpu::depth_state(wgpu::CompareFunction::Greater)),
                multisample: wgpu::MultisampleState::default(),
                multiview_mask: None,
                cache: None,
            })
        })?;
        pipelines.insert((lines, variant), pipeline.clone());
        Ok(pipeline)
    }
}

/// Index lists of all 16 permutations, one after the other, as triangles and as lines.
pub(crate) struct Indices {
    buffer: wgpu::Buffer,
    triangles: Vec<Range<u32>>,
    lines: Vec<Range<u32>>,
}

impl Indices {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let mut all: Vec<u16> = Vec::new();
        let mut append = |list: &[u16]| {
            let start = all.len() as u32;
            all.extend(list);
            start..all.len() as u32
        };
        let (mut triangles, mut lines) = (Vec::new(), Vec::new());
        for mask in 0..16 {
            let list = stitch::triangle_indices(mask);
            triangles.push(append(&list));
            lines.push(append(&edges(&list)));
        }
        let buffer = device.create_buffer_init(&wgpu::util::BufferInitDescriptor {
            label: Some("tile indices"),
            contents: bytemuck::cast_slice(&all),
            usage: wgpu::BufferUsages::INDEX,
        });
        Self { buffer, triangles, lines }
    }
}

/// Every edge of a triangle list once.
fn edges(triangles: &[u16]) -> Vec<u16> {
    let mut seen = HashSet::new();
    triangles
        .chunks_exact(3)
        .flat_map(|t| [[t[0], t[1]], [t[1], t[2]], [t[2], t[0]]])
        .filter(|&[a, b]| seen.insert((a.min(b), a.max(b))))
        .flatten()
        .collect()
}

/// Where the ground of a body is drawn, and how.
pub(crate) struct GroundTargets<'a> {
    pub(crate) radiance: &'a wgpu::TextureView,
    pub(crate) surface: &'a wgpu::TextureView,
    pub(crate) depth: &'a wgpu::TextureView,
    /// Left, top, width and height in the targets.
    pub(crate) viewport_px: [u32; 4],
    /// Whether radiance and depth keep what they hold; if not they are cleared.
    pub(crate) load: bool,
    /// Edges of triangles alone.
    pub(crate) lines: bool,
    /// What the body needs.
    pub(crate) variant: Variant,
}

impl TerrainPass {
    /// Draws the tiles that `view` chose. `groups`: uniforms and LUTs of the body.
    pub(crate) fn draw(
        &self,
        (device, encoder): (&wgpu::Device, &mut wgpu::CommandEncoder),
        indices: &Indices,
        groups: [&wgpu::BindGroup; 2],
        (tiles, view): (&BodyTiles, &GroundView),
        to: &GroundTargets<'_>,
    ) -> Result<FrameStats, RenderError> {
        let pipeline = self.pipeline(device, to.lines, to.variant)?;
        let attachment = |view, load: bool| {
            let load = if load { wgpu::LoadOp::Load } else { wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT) };
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations { load, store: wgpu::StoreOp::Store },
            })
        };
        let mut draw = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("terrain"),
            color_attachments: &[attachment(to.radiance, to.load), attachment(to.surface, to.load)],
            depth_stencil_attachment: Some(gpu::depth_attachment(to.depth, to.load)),
            ..wgpu::RenderPassDescriptor::default()
        });
        draw.set_pipeline(&pipeline);
        gpu::set_viewport(&mut draw, to.viewport_px);
        draw.set_bind_group(0, groups[0], &[]);
        draw.set_bind_group(1, groups[1], &[]);
        draw.set_index_buffer(indices.buffer.slice(..), wgpu::IndexFormat::Uint16);
        draw.set_vertex_buffer(1, view.instances().slice(..));
        let (mut bound, mut bound_arrays) = (None, [None; 2]);
        let mut stats = FrameStats::default();
        for (i, tile) in (0..).zip(view.draws()) {
            for (group, pool, k) in [(2, &tiles.details, 0), (3, &tiles.horizons, 1)] {
                if bound_arrays[k] != Some(tile.arrays[k]) {
                    draw.set_bind_group(group, pool.group(tile.arrays[k]), &[]);
                    bound_arrays[k] = Some(tile.arrays[k]);
                }
            }
            if bound != Some(tile.place.buffer) {
                let Some(shown) = view.shown(tile.place.buffer) else { continue };
                draw.set_vertex_buffer(0, tiles.pool.buffers()[tile.place.buffer].slice(..));
                draw.set_vertex_buffer(2, shown.slice(..));
                bound = Some(tile.place.buffer);
            }
            let range = if to.lines { &indices.lines[tile.mask] } else { &indices.triangles[tile.mask] };
            draw.draw_indexed(range.clone(), tile.place.base_vertex, i..i + 1);
            stats.tiles_drawn += 1;
            stats.triangles += indices.triangles[tile.mask].len() / 3;
        }
        Ok(stats)
    }
}
