//! The cloud maps of a body on the GPU: a cube array with the ground map and two keyframes of [`crate::clouds`]. The
//! shaders blend the keyframes; see `cloud_model.wgsl`.
//!
//! A keyframe that is needed at once is solved at once. While time goes on, the one after is solved in the background.

use super::shared::{CLOUD_MAP_LEVELS, CLOUD_MAP_SIDE};
use crate::clouds::{CloudField, Keyframe, Texels, coverages, ground_map, keyframe, keyframes};
use crate::planet::Key;
use crate::terrain::{Revision, Terrain};
use glam::Vec4;
use half::f16;
use rayon::prelude::*;
use std::sync::mpsc::{Receiver, channel};
use std::sync::{Arc, Mutex};

/// Layers of the cube array.
const CUBES: u32 = 3;
const SIDE: usize = CLOUD_MAP_SIDE as usize;
/// The finest mip level of a draft: a sixteenth of the texels.
const DRAFT_LEVEL: u32 = 2;

/// See the module.
pub(crate) struct CloudMaps {
    texture: wgpu::Texture,
    pub(crate) cubes: wgpu::TextureView,
    /// What the field depends on: the planet's key, and that of the structure's weather.
    key: Option<(Key, Option<Key>)>,
    field: Option<Arc<CloudField>>,
    /// The key of the painted clouds in the ground map.
    paint: Option<Key>,
    /// Numbers of the keyframes in the cubes 1 and 2: the even one first.
    held: [Option<i64>; 2],
    /// The finest mip level that is there of keyframes, and of the ground map: 0, or [`DRAFT_LEVEL`].
    least_level: u32,
    ground_level: u32,
    /// The next keyframe. The mutex only makes it shareable: nobody else waits.
    coming: Option<Mutex<Receiver<Keyframe>>>,
    /// Number of times that the maps were made from another field.
    pub(crate) runs: u64,
}

/// Uniforms of clouds at a time that take the whole field.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct CloudFrame {
    /// Offsets of the log-odds of the layers' covers.
    pub(crate) offsets: Vec4,
    /// Share of the odd keyframe.
    pub(crate) odd_share: f32,
    /// The finest mip level of the maps that is there.
    pub(crate) least_level: f32,
}

/// Solves a keyframe, or the draft of one, as a frame does, for benches.
#[cfg(feature = "cli")]
pub(crate) fn cloud_keyframe(field: &CloudField, number: i64, is_draft: bool) {
    let side = if is_draft { SIDE >> DRAFT_LEVEL } else { SIDE };
    std::hint::black_box(keyframe(field, number, side));
}

impl CloudMaps {
    /// Creates maps without content.
    pub(crate) fn new(device: &wgpu::Device) -> Self {
        let size = wgpu::Extent3d { width: CLOUD_MAP_SIDE, height: CLOUD_MAP_SIDE, depth_or_array_layers: 6 * CUBES };
        let texture = device.create_texture(&wgpu::TextureDescriptor {
            label: Some("cloud maps"),
            size,
            mip_level_count: CLOUD_MAP_LEVELS,
            sample_count: 1,
            dimension: wgpu::TextureDimension::D2,
            format: wgpu::TextureFormat::Rgba16Float,
            usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
            view_formats: &[],
        });
        let cubes = texture.create_view(&wgpu::TextureViewDescriptor {
            dimension: Some(wgpu::TextureViewDimension::CubeArray),
            ..wgpu::TextureViewDescriptor::default()
        });
        Self {
            texture,
            cubes,
            key: None,
            field: None,
            paint: None,
            held: [None; 2],
            least_level: 0,
            ground_level: 0,
            coming: None,
            runs: 0,
        }
    }

    /// Brings the maps to a time, for a planet with clouds, or with a sea over which the solved wind blows. `drafts`:
    /// maps that must be made again may be coarse.
    pub(crate) fn update(
        &mut self,
        queue: &wgpu::Queue,
        (revision, terrain): (&Revision, Option<&Terrain>),
        time_secs: f64,
        drafts: bool,
    ) -> CloudFrame {
        let planet = revision.planet();
        let weather = terrain.and_then(Terrain::weather);
        let key = (revision.keys().cloud_map(), terrain.and_then(Terrain::weather_key));
        let needs_middle = planet.clouds.as_ref().is_some_and(|clouds| clouds.middle > 0.0);
        let is_changed =
            self.key != Some(key) || self.field.as_ref().is_none_or(|field| needs_middle && !field.has_middle());
        // The first maps are never drafts.
        let is_draft = drafts && self.key.is_some() && (is_changed || self.least_level > 0);
        let is_new = is_changed || (self.least_level > 0 && !is_draft);
        if is_new {
            self.least_level = if is_draft { DRAFT_LEVEL } else { 0 };
            let field = match self.field.take().filter(|_| !is_changed) {
                Some(field) => field,
                None => Arc::new(CloudField::with(revision, weather.cloned())),
            };
            (self.key, self.held, self.coming) = (Some(key), [None; 2], None);
            self.field = Some(field);
            self.runs += u64::from(is_changed);
        }
        let Some(field) = &mut self.field else { return CloudFrame::default() };
        // Paint changes the ground map alone.
        let paint = revision.keys().cloud_paint();
        let wanted = match self.paint != paint {
            _ if is_new => Some(self.least_level),
            true => Some(if drafts { DRAFT_LEVEL } else { self.least_level }),
            false => (!drafts && self.ground_level > 0).then_some(self.least_level),
        };
        if let Some(level) = wanted {
            // A new field has it already.
            if self.paint != paint && !is_changed {
                Arc::make_mut(field).set_paint(revision);
            }
            let texels = ground_map(planet, field, SIDE >> level);
            (self.paint, self.ground_level) = (paint, level);
            self.write(queue, 0, level, texels);
        }
        let Some(field) = &mut self.field else { return CloudFrame::default() };
        let Some(clouds) = &planet.clouds else { return CloudFrame::default() };
        let coverages = coverages(clouds);
        if field.coverage() != coverages {
            Arc::make_mut(field).set_coverage(coverages);
        }
        let field = field.clone();
        let (before, share) = keyframes(time_secs);
        // Fog is in the ground map.
        if coverages[..3].iter().any(|coverage| *coverage > 0.0) {
            self.bring(queue, &field, before);
            if share > 0.0 {
                self.bring(queue, &field, before + 1);
            }
        }
        let is_odd = before.rem_euclid(2) == 1;
        let odd_share = if is_odd { 1.0 - share } else { share } as f32;
        let offsets = Vec4::from_array(field.offsets().map(|offset| offset as f32));
        CloudFrame { offsets, odd_share, least_level: self.least_level.max(self.ground_level) as f32 }
    }

    /// Makes sure that a keyframe is in its cube, and asks for the one after it.
    fn bring(&mut self, queue: &wgpu::Queue, field: &Arc<CloudField>, number: i64) {
        let slot = number.rem_euclid(2) as usize;
        if self.held[slot] == Some(number) {
            return;
        }
        let coming = self.coming.take().and_then(|coming| coming.into_inner().ok()?.recv().ok());
        let is_next = coming.as_ref().is_some_and(|frame| frame.number == number);
        let frame = coming.filter(|_| is_next).unwrap_or_else(|| keyframe(field, number, SIDE >> self.least_level));
        self.write(queue, 1 + slot as u32, self.least_level, frame.texels);
        self.held[slot] = Some(number);
        // Time goes on: its neighbour is there already.
        if self.held[1 - slot] == Some(number - 1) && self.least_level == 0 {
            let (field, (send, coming)) = (field.clone(), channel());
            rayon::spawn(move || {
                // Nobody waits any more if the planet has changed.
                let _ = send.send(keyframe(&field, number + 1, SIDE));
            });
            self.coming = Some(Mutex::new(coming));
        }
    }

    /// Writes a cube, from a mip level to the coarsest.
    fn write(&self, queue: &wgpu::Queue, cube: u32, finest: u32, mut level: Texels) {
        for mip_level in finest..CLOUD_MAP_LEVELS {
            let side = CLOUD_MAP_SIDE >> mip_level;
            let bytes: Vec<u8> = level.iter().flatten().flat_map(|x| x.to_le_bytes()).collect();
            let size = wgpu::Extent3d { width: side, height: side, depth_or_array_layers: 6 };
            let layout =
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(8 * side), rows_per_image: Some(side) };
            let origin = wgpu::Origin3d { z: 6 * cube, ..wgpu::Origin3d::ZERO };
            let to = wgpu::TexelCopyTextureInfo { origin, mip_level, ..self.texture.as_image_copy() };
            queue.write_texture(to, &bytes, layout, size);
            level = halved(&level, side as usize);
        }
    }
}

/// The means of blocks of two by two texels of faces with `side` texels along each side.
fn halved(texels: &[[f16; 4]], side: usize) -> Vec<[f16; 4]> {
    let half = side / 2;
    let mean = |i: usize| {
        let first = (i / half) * 2 * side + i % half * 2;
        let block = [first, first + 1, first + side, first + side + 1].map(|at| texels[at]);
        std::array::from_fn(|k| f16::from_f32(block.iter().map(|texel| texel[k].to_f32()).sum::<f32>() * 0.25))
    };
    (0..6 * half * half).into_par_iter().with_min_len(1024).map(mean).collect()
}
