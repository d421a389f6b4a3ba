//! The ground of a body in one view: the visible tiles, their instances, and the morph of their vertices.

use super::body_tiles::BodyTiles;
use super::morph::{Morph, MorphPass, Morphed};
use super::pool::Place;
use super::scene::{Body, height_range_m};
use super::{detail_pool, horizon_pool};
use crate::lod::range::SHADED_AT;
use crate::lod::tile::{DETAIL_SIDE, TILE_QUADS, Tile, slope_axis};
use crate::lod::{Culling, Ranges, View};
use crate::tiles::Leaf;

/// Per-tile data of a draw: an instance in the vertex stream of `terrain.wgsl`.
#[derive(Clone, Copy, bytemuck::Pod, bytemuck::Zeroable)]
#[repr(C)]
struct Instance {
    /// Distances in metres over which the parent's normals take over; level; layer of the detail texture, -1 without
    /// one.
    fade_level_layer: [f32; 4],
    /// First tangent axis of the slopes; see [`slope_axis`].
    slope_axis: [f32; 3],
    /// Position of the tile in its detail texture: lower left corner and side, each 0 to 1; base height of the
    /// texture's heights, metres.
    detail_place: [f32; 4],
    /// Distances in metres over which the parent of the detail texture takes over; metres between texels.
    detail_fade: [f32; 4],
    /// Layer of the horizon tile, -1 without one; width of this tile as a share of that tile's node, and its corner
    /// there.
    horizon: [f32; 4],
}

impl Instance {
    fn new(leaf: &Leaf, ranges: &Ranges, layer: Option<u32>) -> Self {
        let fade = |level: u8, range_m: f64| match level {
            // Level 0 has no parent.
            0 => [1e30, 2e30],
            _ => [SHADED_AT, 1.0].map(|share| (range_m * share) as f32),
        };
        let id = leaf.tile.id;
        let [begin, end] = fade(id.level, ranges.always_m(id.level));
        let mut instance = Self {
            fade_level_layer: [begin, end, f32::from(id.level), layer.map_or(-1.0, |layer| layer as f32)],
            slope_axis: slope_axis(id.face).as_vec3().to_array(),
            detail_place: [0.0, 0.0, 1.0, 0.0],
            detail_fade: [1e30, 2e30, 1.0, 0.0],
            horizon: [-1.0; 4],
        };
        if let Some(detail) = &leaf.detail {
            let [side, x, y] = id.within(detail.id).map(|part| part as f32);
            let [begin, end] = fade(detail.id.level, ranges.shaded_m(detail.id.level));
            let texel_m = ranges.spacing_m(detail.id.level) / DETAIL_PER_QUAD;
            instance.detail_place = [x, y, side, detail.base_m];
            instance.detail_fade = [begin, end, texel_m as f32, 0.0];
        }
        instance
    }
}

/// Bytes of an instance.
pub(crate) const INSTANCE_BYTES: u64 = size_of::<Instance>() as u64;
/// Texels of a detail texture along a quad of the mesh.
const DETAIL_PER_QUAD: f64 = ((DETAIL_SIDE - 1) / TILE_QUADS) as f64;

/// One draw call: a tile.
pub(crate) struct Draw {
    pub(crate) place: Place,
    /// Texture arrays of the detail tile and of the horizon tile.
    pub(crate) arrays: [usize; 2],
    /// Bit mask of parent edges; it selects the index list.
    pub(crate) mask: usize,
}

/// The ground of a body in one view.
pub(crate) struct GroundView {
    morph: Morph,
    instances: wgpu::Buffer,
    draws: Vec<Draw>,
}

impl GroundView {
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        Self { morph: Morph::new(device), instances: instance_buffer(device, 1024), draws: Vec::new() }
    }

    /// Memory of the buffers.
    pub(crate) fn resident_bytes(&self) -> u64 {
        self.morph.resident_bytes() + self.instances.size()
    }

    /// Selects the tiles that `view` sees, and uploads those that are not on the GPU yet.
    pub(crate) fn prepare(
        &mut self,
        (device, queue): (&wgpu::Device, &wgpu::Queue),
        encoder: &mut wgpu::CommandEncoder,
        tiles: &mut BodyTiles,
        body: &Body<'_>,
        view: &View,
    ) {
        let surface = body.surface;
        let radius_m = surface.terrain.planet().radius_m();
        let chosen = body.frozen.as_ref().unwrap_or(view);
        let culling = Culling::new(chosen, (radius_m + height_range_m(surface).0).max(0.0));
        self.draws.clear();
        let mut instances: Vec<Instance> = Vec::new();
        let mut morphed: Vec<Morphed> = Vec::new();
        // Near tiles first, so that pixels they hide are not shaded.
        let eye = view.camera.position_planet_m;
        let away_m = |tile: &Tile| tile.center_planet_m.distance(eye) - tile.bounding_radius_m;
        let mut seen: Vec<_> = surface.leaves.iter().filter(|leaf| culling.sees(&leaf.tile)).collect();
        seen.sort_by(|a, b| away_m(&a.tile).total_cmp(&away_m(&b.tile)));
        for leaf in seen {
            let Some(place) = tiles.pool.place(device, encoder, &leaf.tile) else { continue };
            let detail = leaf
                .detail
                .as_ref()
                .and_then(|tile| tiles.details.place(device, queue, tile.serial, || detail_pool::texels(tile)));
            let horizon = leaf.horizon.as_ref().and_then(|tile| {
                let place = tiles.horizons.place(device, queue, tile.serial, || horizon_pool::texels(tile))?;
                Some((place, leaf.tile.id.within(tile.id)))
            });
            instances.push(Instance {
                horizon: horizon
                    .map_or([-1.0; 4], |(place, [width, x, y])| [place.layer as f32, width as f32, x as f32, y as f32]),
                ..Instance::new(leaf, &surface.ranges, detail.map(|place| place.layer))
            });
            morphed.push(Morphed { place, level: leaf.tile.id.level, finer_edges: leaf.finer_edges });
            let arrays = [detail, horizon.map(|(place, _)| place)].map(|place| place.map_or(0, |place| place.array));
            self.draws.push(Draw { place, arrays, mask: usize::from(leaf.coarser_edges & 15) });
        }
        let bytes: &[u8] = bytemuck::cast_slice(&instances);
        if self.instances.size() < bytes.len() as u64 {
            self.instances = instance_buffer(device, instances.len().next_power_of_two());
        }
        queue.write_buffer(&self.instances, 0, bytes);
        let eye = surface.morphing_eye_m(chosen.camera.position_planet_m);
        self.morph.prepare(device, queue, tiles.pool.buffers(), &surface.ranges, eye, &morphed);
        tiles.pool.end_round(encoder);
    }

    /// Morphs the vertices of the selected tiles.
    pub(crate) fn morph(&self, encoder: &mut wgpu::CommandEncoder, pass: &MorphPass) {
        self.morph.find(encoder, pass);
    }

    /// The selected tiles, near ones first.
    pub(crate) fn draws(&self) -> &[Draw] {
        &self.draws
    }

    /// One instance for each of [`GroundView::draws`].
    pub(crate) fn instances(&self) -> &wgpu::Buffer {
        &self.instances
    }

    /// Morphed vertices for a vertex buffer of the tile pool.
    pub(crate) fn shown(&self, buffer: usize) -> Option<&wgpu::Buffer> {
        self.morph.of(buffer)
    }
}

fn instance_buffer(device: &wgpu::Device, instances: usize) -> wgpu::Buffer {
    device.create_buffer(&wgpu::BufferDescriptor {
        label: Some("tile instances"),
        size: instances as u64 * INSTANCE_BYTES,
        usage: wgpu::BufferUsages::VERTEX | wgpu::BufferUsages::COPY_DST,
        mapped_at_creation: false,
    })
}
