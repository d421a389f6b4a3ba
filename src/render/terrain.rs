//! The ground (`terrain.wgsl`): culls tiles, uploads new ones, finds how far their vertices have come out, draws them with the index
//! list their neighbours ask for.

use super::detail_pool::{self, DETAIL};
use super::gpu;
use super::horizon_pool::{self, HORIZON};
use super::layer_pool::LayerPool;
use super::morph::{Morph, MorphPass, SHOWN_ATTRIBUTES, SHOWN_BYTES};
use super::pool::{Place, TILE_BYTES, TilePool};
use super::targets::{DEPTH_FORMAT, HDR_FORMAT, SURFACE_FORMAT, Targets};
use super::{DebugView, Frame, FrameStats, RenderError, shaders};
use crate::lod::range::SHADED_AT;
use crate::lod::tile::{DETAIL_SIDE, TILE_QUADS, Tile, Vertex, slope_axis};
use crate::lod::{Culling, Ranges, stitch};
use crate::tiles::{Leaf, Surface};
use std::collections::HashSet;
use std::ops::Range;
use wgpu::util::DeviceExt;

const VERTEX_ATTRIBUTES: [wgpu::VertexAttribute; 7] = wgpu::vertex_attr_array![
    0 => Float32x3, 1 => Float32, 2 => Float32x3, 3 => Float32, 4 => Unorm16x2, 5 => Snorm16x2, 6 => Snorm16x2
];
const INSTANCE_ATTRIBUTES: [wgpu::VertexAttribute; 5] =
    wgpu::vertex_attr_array![7 => Float32x4, 8 => Float32x3, 9 => Float32x4, 10 => Float32x4, 13 => Float32x4];

/// What the shader knows of a tile beside its vertices.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Instance {
    /// Distances in metres between which the parent's normals take over; level; layer of the detail tile, -1 without one.
    fade_level_layer: [f32; 4],
    /// See [`slope_axis`].
    slope_axis: [f32; 3],
    /// Place of the tile in its detail tile: lower left corner, side, each 0 to 1; the height that its heights count from.
    detail_place: [f32; 4],
    /// Distances in metres between which the detail of the detail tile's parent takes over; from texel to texel.
    detail_fade: [f32; 4],
    /// Layer of a horizon tile, -1 without one; width of this tile in that tile's node, and where it lies there.
    horizon: [f32; 4],
}

impl Instance {
    fn new(leaf: &Leaf, ranges: &Ranges, layer: Option<u32>) -> Self {
        let fade = |level: u8| match level {
            // There is no parent to take over.
            0 => [1e30, 2e30],
            level => [SHADED_AT, 1.0].map(|share| (ranges.always_m(level) * share) as f32),
        };
        let id = leaf.tile.id;
        let [begin, end] = fade(id.level);
        let mut instance = Self {
            fade_level_layer: [begin, end, f32::from(id.level), layer.map_or(-1.0, |layer| layer as f32)],
            slope_axis: slope_axis(id.face).as_vec3().to_array(),
            detail_place: [0.0, 0.0, 1.0, 0.0],
            detail_fade: [1e30, 2e30, 1.0, 0.0],
            horizon: [-1.0; 4],
        };
        if let Some(detail) = &leaf.detail {
            let [side, x, y] = id.within(detail.id).map(|part| part as f32);
            let [begin, end] = fade(detail.id.level);
            let texel_m = ranges.spacing_m(detail.id.level) / DETAIL_PER_QUAD;
            instance.detail_place = [x, y, side, detail.base_m];
            instance.detail_fade = [begin, end, texel_m as f32, 0.0];
        }
        instance
    }
}

/// Texels of a detail tile along a quad.
const DETAIL_PER_QUAD: f64 = ((DETAIL_SIDE - 1) / TILE_QUADS) as f64;

/// Pipelines of the ground.
pub(crate) struct TerrainPass {
    filled: wgpu::RenderPipeline,
    wireframe: wgpu::RenderPipeline,
}

impl TerrainPass {
    pub(crate) fn new(
        device: &wgpu::Device,
        globals: &wgpu::BindGroupLayout,
        tables: &wgpu::BindGroupLayout,
    ) -> Result<Self, RenderError> {
        const ENTRY: &str = "terrain.wgsl";
        let module = shaders::module(device, ENTRY)?;
        let layout = device.create_pipeline_layout(&wgpu::PipelineLayoutDescriptor {
            label: Some(ENTRY),
            bind_group_layouts: &[
                Some(globals),
                Some(tables),
                Some(&DETAIL.layout(device)),
                Some(&HORIZON.layout(device)),
            ],
            immediate_size: 0,
        });
        let make = |topology, cull_mode| {
            gpu::checked(device, ENTRY, || {
                device.create_render_pipeline(&wgpu::RenderPipelineDescriptor {
                    label: Some(ENTRY),
                    layout: Some(&layout),
                    vertex: wgpu::VertexState {
                        module: &module,
                        entry_point: Some("vertex"),
                        compilation_options: wgpu::PipelineCompilationOptions::default(),
                        buffers: &[
                            Some(wgpu::VertexBufferLayout {
                                array_stride: size_of::<Vertex>() as u64,
                                step_mode: wgpu::VertexStepMode::Vertex,
                                attributes: &VERTEX_ATTRIBUTES,
                            }),
                            Some(wgpu::VertexBufferLayout {
                                array_stride: size_of::<Instance>() as u64,
                                step_mode: wgpu::VertexStepMode::Instance,
                                attributes: &INSTANCE_ATTRIBUTES,
                            }),
                            Some(wgpu::VertexBufferLayout {
                                array_stride: SHOWN_BYTES,
                                step_mode: wgpu::VertexStepMode::Vertex,
                                attributes: &SHOWN_ATTRIBUTES,
                            }),
                        ],
                    },
                    fragment: Some(wgpu::FragmentState {
                        module: &module,
                        entry_point: Some("fragment"),
                        compilation_options: wgpu::PipelineCompilationOptions::default(),
                        targets: &[Some(HDR_FORMAT.into()), Some(SURFACE_FORMAT.into())],
                    }),
                    primitive: wgpu::PrimitiveState { topology, cull_mode, ..wgpu::PrimitiveState::default() },
                    depth_stencil: Some(wgpu::DepthStencilState {
                        format: DEPTH_FORMAT,
                        depth_write_enabled: Some(true),
                        depth_compare: Some(wgpu::CompareFunction::Greater),
                        stencil: wgpu::StencilState::default(),
                        bias: wgpu::DepthBiasState::default(),
                    }),
                    multisample: wgpu::MultisampleState::default(),
                    multiview_mask: None,
                    cache: None,
                })
            })
        };
        Ok(Self {
            filled: make(wgpu::PrimitiveTopology::TriangleList, Some(wgpu::Face::Back))?,
            wireframe: make(wgpu::PrimitiveTopology::LineList, None)?,
        })
    }
}

/// Index lists of all 16 permutations, one after the other, as triangles and as lines.
struct Indices {
    buffer: wgpu::Buffer,
    triangles: Vec<Range<u32>>,
    lines: Vec<Range<u32>>,
}

impl Indices {
    fn new(device: &wgpu::Device) -> Self {
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

struct Draw {
    place: Place,
    /// Texture arrays of the detail and the horizon tile.
    arrays: [usize; 2],
    mask: usize,
}

/// What is kept of the ground from frame to frame.
pub(crate) struct TerrainResources {
    indices: Indices,
    pool: TilePool,
    morph: Morph,
    details: LayerPool,
    horizons: LayerPool,
    instances: wgpu::Buffer,
    draws: Vec<Draw>,
}

impl TerrainResources {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self {
            indices: Indices::new(device),
            pool: TilePool::new(device),
            morph: Morph::new(device),
            details: LayerPool::new(device, DETAIL),
            horizons: LayerPool::new(device, HORIZON),
            instances: instance_buffer(device, 1024),
            draws: Vec::new(),
        }
    }

    /// Uploads tiles of a surface that is to be drawn soon, their horizons and their detail, at most so many bytes (but at least one tile).
    /// Whether all are there now.
    pub(crate) fn upload(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        surface: &Surface,
        budget_bytes: u64,
    ) -> bool {
        self.pool.begin_round();
        let mut left = budget_bytes.max(TILE_BYTES);
        let mut affordable = |bytes| {
            let fits = bytes <= left;
            left = if fits { left - bytes } else { 0 };
            fits
        };
        // No short cut at the first that does not fit: those that are here are to stay.
        let mut done = true;
        for leaf in &surface.leaves {
            if !self.pool.holds(&leaf.tile) {
                if affordable(TILE_BYTES) {
                    self.pool.place(device, encoder, &leaf.tile);
                } else {
                    done = false;
                }
            }
        }
        for tile in surface.leaves.iter().filter_map(|leaf| leaf.horizon.as_deref()) {
            let texels = || horizon_pool::texels(tile);
            done &= self.horizons.place_ahead(device, queue, tile.serial, &mut affordable, texels);
        }
        for tile in surface.leaves.iter().filter_map(|leaf| leaf.detail.as_deref()) {
            let texels = || detail_pool::texels(tile);
            done &= self.details.place_ahead(device, queue, tile.serial, &mut affordable, texels);
        }
        self.pool.end_round(encoder);
        done
    }

    /// Bytes uploaded since the start.
    pub(crate) fn uploaded_bytes(&self) -> u64 {
        self.pool.uploaded_bytes() + self.details.uploaded_bytes() + self.horizons.uploaded_bytes()
    }

    /// Chooses the tiles to draw, uploads those that are not there yet.
    pub(crate) fn prepare(
        &mut self,
        device: &wgpu::Device,
        queue: &wgpu::Queue,
        encoder: &mut wgpu::CommandEncoder,
        frame: &Frame<'_>,
        lowest_m: f64,
    ) {
        let radius_m = frame.surface.terrain.planet().radius_m();
        let chosen = frame.frozen.as_ref().unwrap_or(&frame.view);
        let culling = Culling::new(chosen, (radius_m + lowest_m).max(0.0));
        self.pool.begin_round();
        self.details.begin_frame();
        self.horizons.begin_frame();
        self.draws.clear();
        let mut instances: Vec<Instance> = Vec::new();
        let mut morphed: Vec<(Place, u8)> = Vec::new();
        // Near tiles first: what they hide is not shaded.
        let eye = frame.view.camera.position_planet_m;
        let away_m = |tile: &Tile| tile.center_planet_m.distance(eye) - tile.bounding_radius_m;
        let mut seen: Vec<_> = frame.surface.leaves.iter().filter(|leaf| culling.sees(&leaf.tile)).collect();
        seen.sort_by(|a, b| away_m(&a.tile).total_cmp(&away_m(&b.tile)));
        for leaf in seen {
            let Some(place) = self.pool.place(device, encoder, &leaf.tile) else { continue };
            let detail = leaf
                .detail
                .as_ref()
                .and_then(|tile| self.details.place(device, queue, tile.serial, || detail_pool::texels(tile)));
            let horizon = leaf.horizon.as_ref().and_then(|tile| {
                let place = self.horizons.place(device, queue, tile.serial, || horizon_pool::texels(tile))?;
                Some((place, leaf.tile.id.within(tile.id)))
            });
            instances.push(Instance {
                horizon: horizon
                    .map_or([-1.0; 4], |(place, [width, x, y])| [place.layer as f32, width as f32, x as f32, y as f32]),
                ..Instance::new(leaf, &frame.surface.ranges, detail.map(|place| place.layer))
            });
            morphed.push((place, leaf.tile.id.level));
            let arrays = [detail, horizon.map(|(place, _)| place)].map(|place| place.map_or(0, |place| place.array));
            self.draws.push(Draw { place, arrays, mask: usize::from(leaf.coarser_edges & 15) });
        }
        let bytes: &[u8] = bytemuck::cast_slice(&instances);
        if self.instances.size() < bytes.len() as u64 {
            self.instances = instance_buffer(device, instances.len().next_power_of_two());
        }
        queue.write_buffer(&self.instances, 0, bytes);
        let morphing_eye = frame.surface.morphing_eye_m(chosen.camera.position_planet_m);
        self.morph.prepare(device, queue, self.pool.buffers(), &frame.surface.ranges, morphing_eye, &morphed);
        self.pool.end_round(encoder);
    }

    /// Finds where the vertices are drawn of the tiles chosen by [`TerrainResources::prepare`].
    pub(crate) fn morph(&self, encoder: &mut wgpu::CommandEncoder, pass: &MorphPass) {
        self.morph.find(encoder, pass);
    }

    /// Draws the tiles chosen by [`TerrainResources::prepare`].
    pub(crate) fn draw(
        &self,
        encoder: &mut wgpu::CommandEncoder,
        pass: &TerrainPass,
        groups: [&wgpu::BindGroup; 2],
        targets: &Targets,
        view: DebugView,
    ) -> FrameStats {
        let lines = view == DebugView::Wireframe;
        let cleared = |view| {
            Some(wgpu::RenderPassColorAttachment {
                view,
                depth_slice: None,
                resolve_target: None,
                ops: wgpu::Operations {
                    load: wgpu::LoadOp::Clear(wgpu::Color::TRANSPARENT),
                    store: wgpu::StoreOp::Store,
                },
            })
        };
        let mut draw = encoder.begin_render_pass(&wgpu::RenderPassDescriptor {
            label: Some("terrain"),
            color_attachments: &[cleared(&targets.hdr[0]), cleared(&targets.surface)],
            depth_stencil_attachment: Some(wgpu::RenderPassDepthStencilAttachment {
                view: &targets.depth,
                depth_ops: Some(wgpu::Operations { load: wgpu::LoadOp::Clear(0.0), store: wgpu::StoreOp::Store }),
                stencil_ops: None,
            }),
            ..wgpu::RenderPassDescriptor::default()
        });
        draw.set_pipeline(if lines { &pass.wireframe } else { &pass.filled });
        draw.set_bind_group(0, groups[0], &[]);
        draw.set_bind_group(1, groups[1], &[]);
        draw.set_index_buffer(self.indices.buffer.slice(..), wgpu::IndexFormat::Uint16);
        draw.set_vertex_buffer(1, self.instances.slice(..));
        let (mut bound, mut bound_arrays) = (None, [None; 2]);
        let mut triangles = 0;
        for (i, Draw { place, arrays, mask }) in (0..).zip(&self.draws) {
            for (group, pool, k) in [(2, &self.details, 0), (3, &self.horizons, 1)] {
                if bound_arrays[k] != Some(arrays[k]) {
                    draw.set_bind_group(group, pool.group(arrays[k]), &[]);
                    bound_arrays[k] = Some(arrays[k]);
                }
            }
            if bound != Some(place.buffer) {
                let Some(shown) = self.morph.of(place.buffer) else { continue };
                draw.set_vertex_buffer(0, self.pool.buffers()[place.buffer].slice(..));
                draw.set_vertex_buffer(2, shown.slice(..));
                bound = Some(place.buffer);
            }
            let range = if lines { &self.indices.lines[*mask] } else { &self.indices.triangles[*mask] };
            draw.draw_indexed(range.clone(), place.base_vertex, i..i + 1);
            triangles += self.indices.triangles[*mask].len() / 3;
        }
        FrameStats { tiles_drawn: self.draws.len(), triangles }
    }
}

fn instance_buffer(device: &wgpu::Device, instances: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("tile instances"),
        size: (instances * size_of::<Instance>()) as u64,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
