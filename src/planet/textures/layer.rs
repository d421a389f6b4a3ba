//! A layer of pattern textures: tints and surfaces with all mip levels. Built-in patterns and the texture sets of
//! artists become such layers.
//!
//! - tint: half the factor on the biome's albedo (rgb) and the rank of the height among all heights, 0..1 (a). The
//!   mean factor is 1, so that a biome keeps its colour far away, where only the coarsest level shows. The ranks make a
//!   threshold leave a known share.
//! - surface: slopes along both sides (rg), change of roughness (b); the height over the mean, as a share of the
//!   relief, or the glow of a pattern that has any (a)

/// Texels along a side of a layer.
pub(crate) const SIDE: usize = 512;
/// Largest slope that is stored, rise over run.
pub(crate) const PATTERN_STEEPEST: f32 = 1.25;
/// Largest change of roughness that is stored.
pub(crate) const PATTERN_ROUGHNESS: f32 = 0.5;

/// Coarse variation of brightness, as a share of the mean, from which that of a set is evened out.
const UNEVEN: f32 = 0.06;

/// The texels of a mip level.
pub(crate) type Texels = Vec<[u8; 4]>;

/// A texel before it is stored.
#[derive(Clone, Copy, Default)]
pub(crate) struct Texel {
    /// Factor on the albedo of the biome; any scale.
    pub(crate) tint: [f32; 3],
    /// Height in any scale.
    pub(crate) height: f32,
    /// Added to the biome's roughness.
    pub(crate) roughness: f32,
    /// Share of the biome's glow.
    pub(crate) glow: f32,
}

/// All mip levels of one layer, finest first.
pub(crate) struct Layer {
    pub(crate) tint: Vec<Texels>,
    pub(crate) surface: Vec<Texels>,
    /// Range of heights in periods. Negative: the heights are the ranks, from the lowest to the highest, because the
    /// surface has the glow in their place.
    pub(crate) relief: f32,
}

impl Layer {
    /// The layer of a built-in pattern, whose coarse variation is evened out. Slopes are rise over run.
    #[cfg(feature = "render")]
    pub(crate) fn of_pattern(mut texels: Vec<Texel>, slopes: Vec<[f32; 2]>) -> Self {
        even_out(&mut texels, 0.0);
        neutralize(&mut texels, 4);
        Self::new(&texels, slopes, 1.0)
    }

    /// The layer of a texture set. Slopes are rise over run. `height`: that of a texel of height 1, in periods.
    pub(super) fn of_set(mut texels: Vec<Texel>, slopes: Vec<[f32; 2]>, height: f32) -> Self {
        scale_to_one(&mut texels);
        even_out(&mut texels, UNEVEN);
        // Pictures may have far more contrast than can be stored.
        neutralize(&mut texels, 40);
        Self::new(&texels, slopes, height)
    }

    fn new(texels: &[Texel], slopes: Vec<[f32; 2]>, height: f32) -> Self {
        let (ranks, slopes) = (ranks(texels), levelled(slopes));
        let glows = texels.iter().any(|texel| texel.glow > 0.0);
        let (heights, range) = over_the_mean(texels);
        let relief = if glows { -height * fitted_range(texels, &ranks) } else { height * range };
        let tint = texels.iter().zip(ranks).map(|(texel, rank)| {
            let [r, g, b] = texel.tint;
            [0.5 * r, 0.5 * g, 0.5 * b, rank]
        });
        let tint = tint.collect();
        let last = texels.iter().zip(&heights).map(|(texel, over)| if relief > 0.0 { *over } else { texel.glow });
        let surface = texels.iter().zip(slopes).zip(last).map(|((texel, [x, y]), last)| {
            let signed = |w: f32, most: f32| 0.5 + 0.5 * (w / most).clamp(-1.0, 1.0);
            [signed(x, PATTERN_STEEPEST), signed(y, PATTERN_STEEPEST), signed(texel.roughness, PATTERN_ROUGHNESS), last]
        });
        Self { tint: levels(tint), surface: levels(surface.collect()), relief }
    }

    /// The finest level of both textures.
    pub(super) fn finest(&self) -> [&Texels; 2] {
        [&self.tint[0], &self.surface[0]]
    }

    /// Memory of all levels.
    pub(super) fn bytes(&self) -> u64 {
        self.tint.iter().chain(&self.surface).map(|texels| texels.as_flattened().len() as u64).sum()
    }
}

/// Removes most of the coarse variation of brightness, because it makes the repetition of a pattern visible from afar.
/// Variation below `least`, as a share of the mean, stays.
fn even_out(texels: &mut [Texel], least: f32) {
    const CELLS: usize = 8;
    const TAKEN: f32 = 0.75;
    let width = SIDE / CELLS;
    let mut means = [0.0_f32; CELLS * CELLS];
    let light = |tint: &[f32; 3]| (tint[0] + tint[1] + tint[2]) / 3.0;
    for (i, texel) in texels.iter().enumerate() {
        means[i / SIDE / width * CELLS + i % SIDE / width] += light(&texel.tint) / (width * width) as f32;
    }
    let all = means.iter().sum::<f32>() / means.len() as f32;
    let variance = means.iter().map(|mean| (mean - all).powi(2)).sum::<f32>() / means.len() as f32;
    if variance.sqrt() < least * all {
        return;
    }
    // Indices and weight for interpolation between the middles of four cells.
    let between: [_; SIDE] = std::array::from_fn(|w| {
        let at = (w as f32 + 0.5) / width as f32 - 0.5 + CELLS as f32;
        (at as usize % CELLS, (at as usize + 1) % CELLS, at.fract())
    });
    for (texels, (y, y_next, v)) in texels.chunks_mut(SIDE).zip(between) {
        let row: [_; CELLS] = std::array::from_fn(|x| means[y * CELLS + x] * (1.0 - v) + means[y_next * CELLS + x] * v);
        for (texel, (x, x_next, u)) in texels.iter_mut().zip(between) {
            let here = row[x] * (1.0 - u) + row[x_next] * u;
            let scale = 1.0 + TAKEN * (all / here.max(1e-3) - 1.0);
            texel.tint = texel.tint.map(|c| c * scale);
        }
    }
}

/// Scales each channel to a mean of 1. One without any light becomes even.
fn scale_to_one(texels: &mut [Texel]) {
    const DARKEST: f32 = 1e-5;
    for channel in 0..3 {
        let sum: f64 = texels.iter().map(|texel| f64::from(texel.tint[channel])).sum();
        let mean = (sum / texels.len().max(1) as f64) as f32;
        for texel in texels.iter_mut() {
            let part = &mut texel.tint[channel];
            *part = if mean < DARKEST { 1.0 } else { *part / mean };
        }
    }
}

/// Scales each channel to a mean of 1, with no value above 2, the largest that is stored. Each of the `rounds` brings
/// the mean nearer to 1 where values were above.
fn neutralize(texels: &mut [Texel], rounds: usize) {
    const NEAR: f64 = 1e-4;
    for round in 0..rounds {
        let mut sums = [0.0_f64; 3];
        for texel in texels.iter() {
            sums.iter_mut().zip(texel.tint).for_each(|(sum, c)| *sum += f64::from(c.clamp(0.0, 2.0)));
        }
        // The first rounds are always made: those of built-in patterns.
        if round >= 4 && sums.iter().all(|sum| (sum / texels.len() as f64 - 1.0).abs() < NEAR) {
            return;
        }
        let scales = sums.map(|sum| (texels.len() as f64 / sum.max(1e-9)) as f32);
        for texel in texels.iter_mut() {
            texel.tint.iter_mut().zip(scales).for_each(|(c, scale)| *c = (*c * scale).clamp(0.0, 2.0));
        }
    }
}

/// Rank of each height among all heights, 0..1.
fn ranks(texels: &[Texel]) -> Vec<f32> {
    const BINS: usize = 1 << 14;
    let heights = || texels.iter().map(|texel| texel.height);
    let (lo, hi) = heights().fold((f32::MAX, f32::MIN), |(lo, hi), v| (lo.min(v), hi.max(v)));
    let bin = |v: f32| (((v - lo) / (hi - lo).max(1e-9) * BINS as f32) as usize).min(BINS - 1);
    let bins: Vec<usize> = heights().map(bin).collect();
    let mut below = vec![0_u32; BINS + 1];
    bins.iter().for_each(|bin| below[bin + 1] += 1);
    (0..BINS).for_each(|i| below[i + 1] += below[i]);
    let middle = |i: usize| 0.5 * (below[i] + below[i + 1]) as f32 / texels.len() as f32;
    bins.into_iter().map(middle).collect()
}

/// Heights about their mean, which is 0.5, as shares of a range, and the range. Few texels are beyond its ends.
fn over_the_mean(texels: &[Texel]) -> (Vec<f32>, f32) {
    /// Share of the texels beyond each end.
    const BEYOND: f32 = 0.04;
    let count = texels.len().max(1);
    let mean = (texels.iter().map(|texel| f64::from(texel.height)).sum::<f64>() / count as f64) as f32;
    let mut away: Vec<f32> = texels.iter().map(|texel| (texel.height - mean).abs()).collect();
    let at = ((1.0 - BEYOND) * (count - 1) as f32) as usize;
    let most = if away.is_empty() { 0.0 } else { *away.select_nth_unstable_by(at, f32::total_cmp).1 };
    let range = 2.0 * most;
    (texels.iter().map(|texel| 0.5 + (texel.height - mean) / range.max(1e-9)).collect(), range)
}

/// Slope of the line through heights over ranks that fits best: the range of heights that ranks stand for.
fn fitted_range(texels: &[Texel], ranks: &[f32]) -> f32 {
    let sums = texels.iter().zip(ranks).map(|(texel, rank)| {
        let off = f64::from(*rank) - 0.5;
        (f64::from(texel.height) * off, off * off)
    });
    let (product, square) = sums.fold((0.0, 0.0), |(product, square), (p, s)| (product + p, square + s));
    (product / square.max(1e-9)) as f32
}

/// Slopes (rise over run) along both sides, of heights as shares of the side length.
pub(crate) fn slopes_of(heights: &[f32]) -> Vec<[f32; 2]> {
    let row = |y: usize| &heights[y % SIDE * SIDE..][..SIDE];
    let per_run = 0.5 * SIDE as f32;
    let mut slopes = Vec::with_capacity(heights.len());
    for y in 0..SIDE {
        let (below, here, above) = (row(y + SIDE - 1), row(y), row(y + 1));
        slopes.extend((0..SIDE).map(|x| {
            let along = here[(x + 1) % SIDE] - here[(x + SIDE - 1) % SIDE];
            [along * per_run, (above[x] - below[x]) * per_run]
        }));
    }
    slopes
}

/// Slopes clamped to the stored range, with mean 0: a pattern must not tilt the ground.
fn levelled(mut slopes: Vec<[f32; 2]>) -> Vec<[f32; 2]> {
    let limited = |slope: f32| slope.clamp(-PATTERN_STEEPEST, PATTERN_STEEPEST);
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
