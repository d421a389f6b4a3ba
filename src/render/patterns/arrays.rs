//! The patterns on the GPU: two texture arrays with a layer for each pattern that is shown, and all mip levels: tints
//! and surfaces, as [`Layer`] has them.
//!
//! A built-in pattern is drawn once in the process, when a planet first shows it. A texture set comes with its planet.

use super::canvas::Spot;
use super::draw;
use super::noise::SIDE;
use crate::planet::Detail;
use crate::planet::textures::TextureSet;
use crate::planet::textures::layer::{Layer, Texel, Texels, slopes_of};
use crate::render::gpu;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError, Weak};

/// A pattern that a biome shows. Sets are equal if their content is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) enum Pattern {
    /// A built-in one.
    Kind(Detail),
    /// The textures of an artist.
    Set(Arc<TextureSet>),
}

impl Pattern {
    /// Range of heights in periods; negative where the heights are the ranks.
    pub(crate) fn relief(&self) -> f64 {
        self.layer().relief.into()
    }

    fn layer(&self) -> &Layer {
        match self {
            Pattern::Kind(kind) => layer(*kind),
            Pattern::Set(set) => set.layer(),
        }
    }
}

/// Both texture arrays, with a layer for each of some patterns.
#[derive(Clone, PartialEq)]
pub(crate) struct PatternArrays {
    patterns: Arc<[Pattern]>,
    pub(crate) tint: wgpu::TextureView,
    pub(crate) surface: wgpu::TextureView,
}

impl PatternArrays {
    /// Without any pattern, one empty texel.
    fn new(device: &wgpu::Device, queue: &wgpu::Queue, patterns: Arc<[Pattern]>) -> Self {
        let layers: Vec<&Layer> = patterns.par_iter().map(Pattern::layer).collect();
        let tint = upload(device, queue, "tints of the ground", layers.iter().map(|layer| &layer.tint));
        let surface = upload(device, queue, "surfaces of the ground", layers.iter().map(|layer| &layer.surface));
        Self { patterns, tint, surface }
    }

    /// The patterns, in the order of their layers.
    pub(crate) fn patterns(&self) -> &[Pattern] {
        &self.patterns
    }
}

/// The newest arrays of a device, and what bodies show of them.
pub(crate) struct PatternPool(Mutex<Pool>);

struct Pool {
    arrays: PatternArrays,
    /// The patterns of each body, as long as it holds them.
    shown: Vec<Weak<[Pattern]>>,
}

impl PatternPool {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self(Mutex::new(Pool { arrays: PatternArrays::new(device, queue, [].into()), shown: Vec::new() }))
    }

    /// Arrays that have the patterns of a body. It holds `shown` as long as it shows them. New patterns make new
    /// arrays, without the sets that no body shows any more; so layers change their indices.
    pub(crate) fn with(&self, device: &wgpu::Device, queue: &wgpu::Queue, shown: &Arc<[Pattern]>) -> PatternArrays {
        let mut pool = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        let most = device.limits().max_texture_array_layers as usize;
        if let Some(patterns) = pool.grown(shown, most) {
            pool.arrays = PatternArrays::new(device, queue, patterns.into());
        }
        pool.arrays.clone()
    }

    /// Memory of the newest arrays.
    pub(crate) fn resident_bytes(&self) -> u64 {
        let pool = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        gpu::view_bytes([&pool.arrays.tint, &pool.arrays.surface])
    }
}

impl Pool {
    /// Notes what a body shows. Gives the patterns of new arrays if it needs them.
    fn grown(&mut self, shown: &Arc<[Pattern]>, most: usize) -> Option<Vec<Pattern>> {
        let weak = Arc::downgrade(shown);
        if !self.shown.iter().any(|other| Weak::ptr_eq(other, &weak)) {
            self.shown.retain(|other| other.strong_count() > 0);
            self.shown.push(weak);
        }
        grown(&self.arrays.patterns, &self.shown, shown, most)
    }
}

/// The patterns of new arrays, if those at hand lack one of `wanted`: built-in ones stay, sets as long as a body shows
/// them. At most `most`: sets beyond have no layer.
fn grown(now: &[Pattern], shown: &[Weak<[Pattern]>], wanted: &[Pattern], most: usize) -> Option<Vec<Pattern>> {
    let lacks = |all: &[Pattern]| wanted.iter().any(|pattern| !all.contains(pattern));
    if !lacks(now) {
        return None;
    }
    let shown: Vec<Arc<[Pattern]>> = shown.iter().filter_map(Weak::upgrade).collect();
    let is_shown = |pattern: &Pattern| shown.iter().any(|patterns| patterns.contains(pattern));
    let stays = |pattern: &&Pattern| matches!(pattern, Pattern::Kind(_)) || is_shown(pattern);
    let mut all: Vec<Pattern> = Vec::new();
    // Built-in ones first: they are the last resort of a biome.
    for is_kind in [true, false] {
        let of_sort = |pattern: &&Pattern| matches!(pattern, Pattern::Kind(_)) == is_kind;
        for pattern in now.iter().filter(stays).chain(wanted).filter(of_sort) {
            if !all.contains(pattern) && all.len() < most {
                all.push(pattern.clone());
            }
        }
    }
    // Nothing is made anew where there is no room.
    (all != now).then_some(all)
}

/// Draws kinds on other threads, each once, so that the first frame that shows them does not wait as long.
pub(super) fn draw_ahead(kinds: &[Detail]) {
    /// A bit for each kind that somebody has asked for.
    static ASKED: AtomicU64 = AtomicU64::new(0);
    for &kind in kinds {
        let bit = 1 << kind as u64;
        if ASKED.fetch_or(bit, Ordering::Relaxed) & bit == 0 {
            rayon::spawn(move || {
                layer(kind);
            });
        }
    }
}

/// The layer of a kind, drawn once in the process. Drawing it is the work of one thread: one that waited for others
/// here could take a task that asks for the same layer, and would wait for itself.
fn layer(kind: Detail) -> &'static Layer {
    static LAYERS: [OnceLock<Layer>; Detail::ALL.len()] = [const { OnceLock::new() }; Detail::ALL.len()];
    LAYERS[kind as usize].get_or_init(|| drawn(&draw(kind)))
}

fn upload<'a>(
    device: &wgpu::Device,
    queue: &wgpu::Queue,
    label: &str,
    layers: impl ExactSizeIterator<Item = &'a Vec<Texels>>,
) -> wgpu::TextureView {
    let full = if layers.len() == 0 { 1 } else { SIDE as u32 };
    let extent =
        |side: u32, depth_or_array_layers: u32| wgpu::Extent3d { width: side, height: side, depth_or_array_layers };
    let texture = device.create_texture(&wgpu::TextureDescriptor {
        label: Some(label),
        size: extent(full, layers.len().max(1) as u32),
        mip_level_count: full.ilog2() + 1,
        sample_count: 1,
        dimension: wgpu::TextureDimension::D2,
        format: wgpu::TextureFormat::Rgba8Unorm,
        usage: wgpu::TextureUsages::TEXTURE_BINDING | wgpu::TextureUsages::COPY_DST,
        view_formats: &[],
    });
    for (z, levels) in (0..).zip(layers) {
        for (mip_level, texels) in (0..).zip(levels) {
            let side = SIDE as u32 >> mip_level;
            let origin = wgpu::Origin3d { x: 0, y: 0, z };
            queue.write_texture(
                wgpu::TexelCopyTextureInfo { mip_level, origin, ..texture.as_image_copy() },
                bytemuck::cast_slice(texels),
                wgpu::TexelCopyBufferLayout { offset: 0, bytes_per_row: Some(4 * side), rows_per_image: Some(side) },
                extent(side, 1),
            );
        }
    }
    texture.create_view(&wgpu::TextureViewDescriptor {
        dimension: Some(wgpu::TextureViewDimension::D2Array),
        ..wgpu::TextureViewDescriptor::default()
    })
}

/// The layer of a built-in pattern.
fn drawn(spots: &[Spot]) -> Layer {
    let mut tints: Vec<[f32; 3]> = spots.iter().map(|spot| spot.tint).collect();
    let heights: Vec<f32> = spots.iter().map(|spot| spot.height).collect();
    occlude(&mut tints, &heights);
    let texel = |(spot, tint): (&Spot, [f32; 3])| Texel {
        tint,
        height: spot.height,
        roughness: spot.roughness,
        glow: spot.glow,
    };
    Layer::of_pattern(spots.iter().zip(tints).map(texel).collect(), slopes_of(&heights))
}

/// Darkens hollows and brightens what stands out, at two scales: the share of the sky that the heights around hide.
fn occlude(tints: &mut [[f32; 3]], heights: &[f32]) {
    /// Radii in texels.
    const RADII: [usize; 2] = [3, 14];
    const STRENGTH: f32 = 0.16;
    /// Rise over run from the mean around at which a texel is that much darker or brighter.
    const RISE: f32 = 0.4;
    for radius in RADII {
        let full = RISE * radius as f32 / SIDE as f32;
        let around = mean_around(&mean_around(heights, radius, [1, SIDE]), radius, [SIDE, 1]);
        for ((tint, height), around) in tints.iter_mut().zip(heights).zip(around) {
            let factor = 1.0 + STRENGTH * ((height - around) / full).clamp(-2.5, 1.5);
            *tint = tint.map(|c| c * factor);
        }
    }
}

/// Means of the values up to `radius` texels before and after each, along lines that wrap. `strides`: from a texel to
/// the next of its line, and from a line to the next.
fn mean_around(values: &[f32], radius: usize, strides: [usize; 2]) -> Vec<f32> {
    let mut means = vec![0.0; values.len()];
    for line in 0..SIDE {
        let index = |i: usize| line * strides[1] + i % SIDE * strides[0];
        let mut sum: f32 = (0..=2 * radius).map(|i| values[index(i + SIDE - radius)]).sum();
        for i in 0..SIDE {
            means[index(i)] = sum / (2 * radius + 1) as f32;
            sum += values[index(i + radius + 1)] - values[index(i + SIDE - radius)];
        }
    }
    means
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The sets of a body stay on the GPU until it shows others and new arrays are made.
    #[test]
    fn sets_that_nobody_shows_leave_with_the_next_arrays() {
        let kind = |detail| Pattern::Kind(detail);
        let set = |grey: f32| Pattern::Set(Arc::new(TextureSet::of_colors(vec![[grey, 0.5, 0.5]; SIDE * SIDE])));
        let (a, b, c) = (set(0.1), set(0.2), set(0.3));
        assert_eq!(a, set(0.1));
        assert_ne!(a, b);
        let body: [Arc<[Pattern]>; 2] = [[kind(Detail::Sand), a.clone()].into(), [b.clone()].into()];
        let shown = body.each_ref().map(Arc::downgrade);
        let first = grown(&[], &shown, &body[0], 9).unwrap();
        assert_eq!(first, [kind(Detail::Sand), a.clone()]);
        assert_eq!(grown(&first, &shown, &body[0], 9), None);
        let second = grown(&first, &shown, &body[1], 9).unwrap();
        assert_eq!(second, [kind(Detail::Sand), a.clone(), b.clone()]);
        let [gone, other] = body;
        drop(gone);
        let wanted = [c.clone(), kind(Detail::Ice)];
        let third = grown(&second, &shown, &wanted, 9).unwrap();
        assert_eq!(third, [kind(Detail::Sand), kind(Detail::Ice), b.clone(), c.clone()]);
        // Where there is no room, built-in patterns come first.
        let fourth = grown(&second, &shown, &wanted, 3).unwrap();
        assert_eq!(fourth, [kind(Detail::Sand), kind(Detail::Ice), b]);
        assert_eq!(grown(&fourth, &shown, &wanted, 3), None);
        drop(other);
    }

    /// Every kind that has a pattern, with its layer.
    fn patterns() -> impl Iterator<Item = (Detail, &'static Layer)> {
        Detail::ALL.iter().filter(|kind| **kind != Detail::None).map(|kind| (*kind, layer(*kind)))
    }

    /// At every mip level, a pattern keeps the mean colour of the biome.
    #[test]
    fn every_pattern_is_neutral_at_every_level() {
        for (kind, layer) in patterns() {
            for (level, texels) in layer.tint.iter().enumerate() {
                for channel in 0..4 {
                    let sum: f64 = texels.iter().map(|texel| f64::from(texel[channel])).sum();
                    let mean = sum / texels.len() as f64 / 127.5;
                    assert!((mean - 1.0).abs() < 0.01, "{kind:?}, level {level}, channel {channel}: {mean}");
                }
            }
            for channel in 0..2 {
                let texels = &layer.surface[0];
                let mean = texels.iter().map(|t| f64::from(t[channel])).sum::<f64>() / texels.len() as f64 - 127.5;
                assert!(mean.abs() < 1.0, "{kind:?} leans by {mean}");
            }
        }
    }

    /// Neighbours across the border differ no more than elsewhere.
    #[test]
    fn every_pattern_repeats_without_a_seam() {
        for (kind, layer) in patterns() {
            let texels = &layer.tint[0];
            let step = |x: usize| -> f64 {
                let away = |y: usize| {
                    let (a, b) = (texels[y * SIDE + x], texels[y * SIDE + (x + 1) % SIDE]);
                    f64::from(a[3].abs_diff(b[3]))
                };
                (0..SIDE).map(away).sum()
            };
            let most = (0..SIDE - 1).map(step).fold(0.0, f64::max);
            assert!(step(SIDE - 1) <= 1.25 * most, "{kind:?}: {} against {most}", step(SIDE - 1));
        }
    }

    /// Stones stand higher than ripples, and nothing higher than it is wide.
    #[test]
    fn reliefs_are_those_of_the_heights() {
        for (kind, layer) in patterns() {
            assert!(layer.relief.abs() > 0.001 && layer.relief.abs() < 0.4, "{kind:?}: {}", layer.relief);
        }
        let [cobbles, beach] = [Detail::Cobbles, Detail::Beach].map(|kind| layer(kind).relief);
        assert!(cobbles > 2.0 * beach, "cobbles {cobbles}, beach {beach}");
    }

    /// The tints of every pattern vary, and only lava glows.
    #[test]
    fn every_pattern_shows_and_only_lava_glows() {
        for (kind, layer) in patterns() {
            let texels = &layer.tint[0];
            let mean = |f: &dyn Fn(&[u8; 4]) -> f64| texels.iter().map(f).sum::<f64>() / texels.len() as f64;
            let variance = mean(&|t| (f64::from(t[1]) / 127.5 - 1.0).powi(2));
            assert!(variance.sqrt() > 0.01, "{kind:?}: {variance}");
            let glows = layer.relief < 0.0 && layer.surface[0].iter().any(|t| t[3] > 0);
            assert_eq!(glows, kind == Detail::Lava, "{kind:?}");
        }
    }
}
