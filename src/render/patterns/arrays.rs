//! The patterns on the GPU: two texture arrays with a layer for each kind that is shown, and all mip levels.
//!
//! - `tint`: half the factor on the biome's albedo (rgb) and the rank of the height among all heights, 0..1 (a). The
//!   mean factor is 1, so that a biome keeps its colour far away, where only the coarsest level shows. The ranks make a
//!   threshold leave a known share.
//! - `surface`: slopes along both sides (rg), change of roughness (b), glow (a)
//!
//! A pattern is drawn once in the process, when a planet first shows it.

use super::canvas::Spot;
use super::draw;
use super::noise::SIDE;
use crate::planet::Detail;
use crate::render::gpu;
use rayon::prelude::*;
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

/// Largest slope that is stored, rise over run.
pub(crate) const PATTERN_STEEPEST: f32 = 1.25;
/// Largest change of roughness that is stored.
pub(crate) const PATTERN_ROUGHNESS: f32 = 0.5;

type Texels = Vec<[u8; 4]>;

/// All mip levels of one layer, finest first.
struct Layer {
    tint: Vec<Texels>,
    surface: Vec<Texels>,
    /// Range of heights in periods: that of ranks on the line which fits the heights best.
    relief: f32,
}

/// Both texture arrays, with a layer for each kind of pattern that a planet of the device has shown.
#[derive(Clone, PartialEq)]
pub(crate) struct PatternArrays {
    kinds: Arc<[Detail]>,
    pub(crate) tint: wgpu::TextureView,
    pub(crate) surface: wgpu::TextureView,
}

impl PatternArrays {
    /// Without any kind, one empty texel.
    fn new(device: &wgpu::Device, queue: &wgpu::Queue, kinds: Arc<[Detail]>) -> Self {
        let layers: Vec<&Layer> = kinds.par_iter().map(|kind| layer(*kind)).collect();
        let tint = upload(device, queue, "tints of the ground", layers.iter().map(|layer| &layer.tint));
        let surface = upload(device, queue, "surfaces of the ground", layers.iter().map(|layer| &layer.surface));
        Self { kinds, tint, surface }
    }

    /// The kinds, in the order of their layers.
    pub(crate) fn kinds(&self) -> &[Detail] {
        &self.kinds
    }
}

/// The newest arrays of a device. Kinds are only added, so a layer keeps its index.
pub(crate) struct PatternPool(Mutex<PatternArrays>);

impl PatternPool {
    pub(crate) fn new(device: &wgpu::Device, queue: &wgpu::Queue) -> Self {
        Self(Mutex::new(PatternArrays::new(device, queue, [].into())))
    }

    /// Arrays that have these kinds. New kinds make new arrays.
    pub(crate) fn with(&self, device: &wgpu::Device, queue: &wgpu::Queue, kinds: &[Detail]) -> PatternArrays {
        let mut arrays = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        if kinds.iter().any(|kind| !arrays.kinds.contains(kind)) {
            let added = kinds.iter().filter(|kind| !arrays.kinds.contains(kind));
            let all = arrays.kinds.iter().chain(added).copied().collect();
            *arrays = PatternArrays::new(device, queue, all);
        }
        arrays.clone()
    }

    /// Memory of the newest arrays.
    pub(crate) fn resident_bytes(&self) -> u64 {
        let arrays = self.0.lock().unwrap_or_else(PoisonError::into_inner);
        gpu::view_bytes([&arrays.tint, &arrays.surface])
    }
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
    LAYERS[kind as usize].get_or_init(|| Layer::new(&draw(kind)))
}

/// Range of heights of a kind in periods; 0 without a pattern. Draws the kind if no planet has shown it.
pub(crate) fn relief_of(kind: Detail) -> f32 {
    if kind == Detail::None { 0.0 } else { layer(kind).relief }
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

impl Layer {
    fn new(spots: &[Spot]) -> Self {
        let mut tints: Vec<[f32; 3]> = spots.iter().map(|spot| spot.tint).collect();
        let heights: Vec<f32> = spots.iter().map(|spot| spot.height).collect();
        occlude(&mut tints, &heights);
        even_out(&mut tints);
        neutralize(&mut tints);
        let (ranks, slopes) = (ranks(&heights), slopes(&heights));
        let relief = relief(&heights, &ranks);
        let tint = tints.iter().zip(ranks).map(|(t, rank)| [0.5 * t[0], 0.5 * t[1], 0.5 * t[2], rank]).collect();
        let surface = spots.iter().zip(slopes).map(|(spot, [x, y])| {
            let signed = |w: f32, most: f32| 0.5 + 0.5 * (w / most).clamp(-1.0, 1.0);
            [
                signed(x, PATTERN_STEEPEST),
                signed(y, PATTERN_STEEPEST),
                signed(spot.roughness, PATTERN_ROUGHNESS),
                spot.glow,
            ]
        });
        Self { tint: levels(tint), surface: levels(surface.collect()), relief }
    }
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

/// Removes most of the coarse variation of brightness, because it makes the repetition of a pattern visible from afar.
fn even_out(tints: &mut [[f32; 3]]) {
    const CELLS: usize = 8;
    const TAKEN: f32 = 0.75;
    let width = SIDE / CELLS;
    let mut means = [0.0_f32; CELLS * CELLS];
    let light = |tint: &[f32; 3]| (tint[0] + tint[1] + tint[2]) / 3.0;
    for (i, tint) in tints.iter().enumerate() {
        means[i / SIDE / width * CELLS + i % SIDE / width] += light(tint) / (width * width) as f32;
    }
    let all = means.iter().sum::<f32>() / means.len() as f32;
    // Indices and weight for interpolation between the middles of four cells.
    let between: [_; SIDE] = std::array::from_fn(|w| {
        let at = (w as f32 + 0.5) / width as f32 - 0.5 + CELLS as f32;
        (at as usize % CELLS, (at as usize + 1) % CELLS, at.fract())
    });
    for (tints, (y, y_next, v)) in tints.chunks_mut(SIDE).zip(between) {
        let row: [_; CELLS] = std::array::from_fn(|x| means[y * CELLS + x] * (1.0 - v) + means[y_next * CELLS + x] * v);
        for (tint, (x, x_next, u)) in tints.iter_mut().zip(between) {
            let here = row[x] * (1.0 - u) + row[x_next] * u;
            let scale = 1.0 + TAKEN * (all / here.max(1e-3) - 1.0);
            *tint = tint.map(|c| c * scale);
        }
    }
}

/// Scales each channel to a mean of 1, with no value above 2, the largest that is stored.
fn neutralize(tints: &mut [[f32; 3]]) {
    for _ in 0..4 {
        let mut sums = [0.0_f64; 3];
        for tint in tints.iter() {
            sums.iter_mut().zip(tint).for_each(|(sum, c)| *sum += f64::from(c.clamp(0.0, 2.0)));
        }
        let scales = sums.map(|sum| (tints.len() as f64 / sum.max(1e-9)) as f32);
        for tint in tints.iter_mut() {
            tint.iter_mut().zip(scales).for_each(|(c, scale)| *c = (*c * scale).clamp(0.0, 2.0));
        }
    }
}

/// Rank of each value among all values, 0..1.
fn ranks(values: &[f32]) -> Vec<f32> {
    const BINS: usize = 1 << 14;
    let (lo, hi) = values.iter().fold((f32::MAX, f32::MIN), |(lo, hi), v| (lo.min(*v), hi.max(*v)));
    let bin = |v: &f32| (((v - lo) / (hi - lo).max(1e-9) * BINS as f32) as usize).min(BINS - 1);
    let bins: Vec<usize> = values.iter().map(bin).collect();
    let mut below = vec![0_u32; BINS + 1];
    bins.iter().for_each(|bin| below[bin + 1] += 1);
    (0..BINS).for_each(|i| below[i + 1] += below[i]);
    let middle = |i: usize| 0.5 * (below[i] + below[i + 1]) as f32 / values.len() as f32;
    bins.into_iter().map(middle).collect()
}

/// Slope of the line through heights over ranks that fits best.
fn relief(heights: &[f32], ranks: &[f32]) -> f32 {
    let sums = heights.iter().zip(ranks).map(|(height, rank)| {
        let off = f64::from(*rank) - 0.5;
        (f64::from(*height) * off, off * off)
    });
    let (product, square) = sums.fold((0.0, 0.0), |(product, square), (p, s)| (product + p, square + s));
    (product / square.max(1e-9)) as f32
}

/// Slopes (rise over run) along both sides, clamped to the stored range, with mean 0: a pattern must not tilt the
/// ground.
fn slopes(heights: &[f32]) -> Vec<[f32; 2]> {
    let row = |y: usize| &heights[y % SIDE * SIDE..][..SIDE];
    let per_run = 0.5 * SIDE as f32;
    let limited = |slope: f32| slope.clamp(-PATTERN_STEEPEST, PATTERN_STEEPEST);
    let mut slopes = Vec::with_capacity(heights.len());
    for y in 0..SIDE {
        let (below, here, above) = (row(y + SIDE - 1), row(y), row(y + 1));
        slopes.extend((0..SIDE).map(|x| {
            let along = here[(x + 1) % SIDE] - here[(x + SIDE - 1) % SIDE];
            [along * per_run, (above[x] - below[x]) * per_run]
        }));
    }
    // Clamping shifts the mean, and correcting the mean leads to more clamping. The change gets small after three
    // rounds.
    for _ in 0..3 {
        let mut sums = [0.0_f64; 2];
        for slope in &slopes {
            sums.iter_mut().zip(slope).for_each(|(sum, slope)| *sum += f64::from(limited(*slope)));
        }
        let means = sums.map(|sum| (sum / slopes.len() as f64) as f32);
        for slope in &mut slopes {
            slope.iter_mut().zip(means).for_each(|(slope, mean)| *slope = limited(*slope) - mean);
        }
    }
    slopes
}

/// Mip levels: means of blocks of two by two, rounded only when stored.
fn levels(mut texels: Vec<[f32; 4]>) -> Vec<Texels> {
    let byte = |share: f32| (share.clamp(0.0, 1.0) * 255.0 + 0.5) as u8;
    let mut levels = Vec::new();
    let mut side = SIDE;
    loop {
        levels.push(texels.iter().map(|texel| texel.map(byte)).collect());
        if side == 1 {
            return levels;
        }
        let half = side / 2;
        let mut means = Vec::with_capacity(half * half);
        for rows in texels.chunks_exact(2 * side) {
            let (below, above) = rows.split_at(side);
            let pairs = below.chunks_exact(2).zip(above.chunks_exact(2));
            means.extend(
                pairs.map(|(b, a)| -> [f32; 4] {
                    std::array::from_fn(|c| 0.25 * (b[0][c] + b[1][c] + a[0][c] + a[1][c]))
                }),
            );
        }
        texels = means;
        side = half;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        let ramp: Vec<f32> = (0..1000).map(|i| 0.3 * i as f32 / 1000.0).collect();
        assert!((relief(&ramp, &ranks(&ramp)) - 0.3).abs() < 1e-3);
        for (kind, layer) in patterns() {
            assert!(layer.relief > 0.001 && layer.relief < 0.3, "{kind:?}: {}", layer.relief);
        }
        let relief = |kind| layer(kind).relief;
        assert!(relief(Detail::Cobbles) > 2.0 * relief(Detail::Beach), "{}", relief(Detail::Beach));
        assert_eq!(relief_of(Detail::None), 0.0);
    }

    /// The tints of every pattern vary, and only lava glows.
    #[test]
    fn every_pattern_shows_and_only_lava_glows() {
        for (kind, layer) in patterns() {
            let texels = &layer.tint[0];
            let mean = |f: &dyn Fn(&[u8; 4]) -> f64| texels.iter().map(f).sum::<f64>() / texels.len() as f64;
            let variance = mean(&|t| (f64::from(t[1]) / 127.5 - 1.0).powi(2));
            assert!(variance.sqrt() > 0.01, "{kind:?}: {variance}");
            let glows = layer.surface[0].iter().any(|t| t[3] > 0);
            assert_eq!(glows, kind == Detail::Lava, "{kind:?}");
        }
    }
}
