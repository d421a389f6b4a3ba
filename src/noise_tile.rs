//! A tiling cube of noise with mip levels: red is billowy (clouds), green is fractal (ground). Both are distributed
//! evenly over 0..1, so that a threshold leaves a known share. Every mip level keeps the mean.

use glam::DVec3;
use rayon::prelude::*;

/// Texels along a side.
pub(crate) const SIDE: usize = 64;
/// Octaves of the macro variation of ground and ice, coarse to fine: their periods in metres.
#[cfg(any(feature = "bake", feature = "render"))]
pub(crate) const VARIATION_PERIODS_M: [f64; 8] = [2.6e6, 330e3, 41e3, 5100.0, 640.0, 80.0, 10.0, 1.25];

/// The mip levels of the tile, the finest first: texels along x, then y, then z.
pub(crate) struct NoiseTile(pub(crate) Vec<Vec<[f32; 2]>>);

impl NoiseTile {
    /// Computes it.
    #[cfg(any(feature = "bake", feature = "render"))]
    pub(crate) fn new() -> Self {
        let mut levels = vec![tile()];
        let mut side = SIDE;
        while side > 1 {
            let next = levels.last().map(|finer| halved(finer, side)).unwrap_or_default();
            levels.push(next);
            side /= 2;
        }
        Self(levels)
    }

    /// The finest level with the noise of the ground alone, which takes a fraction of the time.
    pub(crate) fn of_ground() -> Self {
        let raw: Vec<[f32; 2]> = (0..SIDE * SIDE * SIDE).into_par_iter().map(|i| [0.0, ground(middle(i))]).collect();
        Self(vec![ranks(&raw, 1).into_iter().map(|rank| [0.0, rank]).collect()])
    }

    /// Green at a point in periods, as the GPU samples it: trilinear, and linear between mip levels. `lod`: 0 or more.
    pub(crate) fn ground_at(&self, point: DVec3, lod: f64) -> f64 {
        let last = self.0.len() - 1;
        let lod = lod.min(last as f64);
        let level = lod as usize;
        let finer = self.level_at(point, level);
        let share = lod - level as f64;
        if share > 0.0 { finer + (self.level_at(point, level + 1) - finer) * share } else { finer }
    }

    fn level_at(&self, point: DVec3, level: usize) -> f64 {
        let side = SIDE >> level;
        let at = (point - point.floor()) * side as f64 - 0.5;
        let low = at.floor();
        let f = (at - low).to_array();
        let low = low.to_array().map(|w| w as i64);
        let wrapped = |w: i64| w.rem_euclid(side as i64) as usize;
        let mut sum = 0.0;
        for (dz, dy, dx) in grid(2) {
            let corner = [dx, dy, dz];
            let [x, y, z]: [usize; 3] = std::array::from_fn(|i| wrapped(low[i] + corner[i] as i64));
            let weight: f64 = (0..3).map(|i| if corner[i] == 1 { f[i] } else { 1.0 - f[i] }).product();
            sum += weight * f64::from(self.0[level][(z * side + y) * side + x][1]);
        }
        sum
    }
}

/// Means of blocks of two by two by two texels.
#[cfg(any(feature = "bake", feature = "render"))]
fn halved(data: &[[f32; 2]], side: usize) -> Vec<[f32; 2]> {
    let half = side / 2;
    let mut out = Vec::with_capacity(half * half * half);
    for (z, y, x) in grid(half) {
        let mut sum = [0.0; 2];
        for (dz, dy, dx) in grid(2) {
            let texel = data[((2 * z + dz) * side + 2 * y + dy) * side + 2 * x + dx];
            sum[0] += texel[0] * 0.125;
            sum[1] += texel[1] * 0.125;
        }
        out.push(sum);
    }
    out
}

fn grid(side: usize) -> impl Iterator<Item = (usize, usize, usize)> {
    (0..side).flat_map(move |z| (0..side).flat_map(move |y| (0..side).map(move |x| (z, y, x))))
}

/// Middle of a texel in the unit cube.
fn middle(index: usize) -> [f32; 3] {
    [index % SIDE, index / SIDE % SIDE, index / (SIDE * SIDE)].map(|n| (n as f32 + 0.5) / SIDE as f32)
}

/// Octaves up to the start of the shader's next octave of the ground, whose tile is an eighth as large.
fn ground(p: [f32; 3]) -> f32 {
    gradient_noise(p, 6, 6) + 0.6 * gradient_noise(p, 12, 7) + 0.4 * gradient_noise(p, 24, 8)
}

#[cfg(any(feature = "bake", feature = "render"))]
fn tile() -> Vec<[f32; 2]> {
    let raw: Vec<[f32; 2]> = (0..SIDE * SIDE * SIDE)
        .into_par_iter()
        .map(|i| {
            let p = middle(i);
            let cells = 0.55 * cell_noise(p, 4, 1) + 0.28 * cell_noise(p, 9, 2) + 0.17 * cell_noise(p, 18, 3);
            let soft = value_noise(p, 4, 4) + 0.5 * value_noise(p, 8, 5);
            [-cells + 0.18 * soft, ground(p)]
        })
        .collect();
    let (red, green) = (ranks(&raw, 0), ranks(&raw, 1));
    red.into_iter().zip(green).map(|(r, g)| [r, g]).collect()
}

/// Replaces each value by its rank among all values, 0..1.
fn ranks(raw: &[[f32; 2]], channel: usize) -> Vec<f32> {
    let mut order: Vec<u32> = (0..raw.len() as u32).collect();
    order.par_sort_unstable_by(|&a, &b| raw[a as usize][channel].total_cmp(&raw[b as usize][channel]).then(a.cmp(&b)));
    let mut out = vec![0.0; raw.len()];
    for (place, &i) in order.iter().enumerate() {
        out[i as usize] = (place as f32 + 0.5) / raw.len() as f32;
    }
    out
}

/// Hash of a lattice point, repeating after `period` cells: three values in 0..1 (the finaliser of murmur3).
fn lattice(cell: [i32; 3], period: i32, seed: u32) -> [f32; 3] {
    let [x, y, z] = cell.map(|c| c.rem_euclid(period) as u32);
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ z.wrapping_mul(0xC2B2_AE3D);
    h ^= seed.wrapping_mul(0x27D4_EB2F);
    std::array::from_fn(|_| {
        h = (h ^ (h >> 16)).wrapping_mul(0x85EB_CA6B);
        h = (h ^ (h >> 13)).wrapping_mul(0xC2B2_AE35);
        h ^= h >> 16;
        (h >> 8) as f32 / 16_777_216.0
    })
}

/// Distance to the nearest point of a jittered lattice, in cells (Worley, A cellular texture basis function, 1996).
#[cfg(any(feature = "bake", feature = "render"))]
fn cell_noise(p: [f32; 3], period: i32, seed: u32) -> f32 {
    let q = p.map(|x| x * period as f32);
    let base = q.map(|x| x.floor() as i32);
    let mut nearest = f32::MAX;
    for (dz, dy, dx) in grid(3) {
        let cell = [base[0] + dx as i32 - 1, base[1] + dy as i32 - 1, base[2] + dz as i32 - 1];
        let point = lattice(cell, period, seed);
        let away: f32 = (0..3).map(|i| (cell[i] as f32 + point[i] - q[i]).powi(2)).sum();
        nearest = nearest.min(away);
    }
    nearest.sqrt().min(1.0)
}

/// The corners of the lattice cell around a point: lattice cell, interpolation weight, and vector from the corner in
/// cells.
fn corners(p: [f32; 3], period: i32) -> impl Iterator<Item = ([i32; 3], f32, [f32; 3])> {
    let q = p.map(|x| x * period as f32);
    let base = q.map(|x| x.floor() as i32);
    let f: [f32; 3] = std::array::from_fn(|i| q[i] - base[i] as f32);
    let smooth = f.map(|f| f * f * f * (f * (f * 6.0 - 15.0) + 10.0));
    grid(2).map(move |(dz, dy, dx)| {
        let at = [dx, dy, dz];
        let weight = (0..3).map(|i| if at[i] == 1 { smooth[i] } else { 1.0 - smooth[i] }).product();
        (std::array::from_fn(|i| base[i] + at[i] as i32), weight, std::array::from_fn(|i| f[i] - at[i] as f32))
    })
}

/// Value noise: smoothly interpolated lattice values, -1..1.
#[cfg(any(feature = "bake", feature = "render"))]
fn value_noise(p: [f32; 3], period: i32, seed: u32) -> f32 {
    corners(p, period).map(|(cell, weight, _)| weight * (2.0 * lattice(cell, period, seed)[0] - 1.0)).sum()
}

/// Gradient noise: smoothly blended planes with random slopes. It shows its lattice less than value noise (Perlin,
/// Improving Noise, 2002).
fn gradient_noise(p: [f32; 3], period: i32, seed: u32) -> f32 {
    let plane = |(cell, weight, from): ([i32; 3], f32, [f32; 3])| {
        let slope = lattice(cell, period, seed);
        weight * (0..3).map(|i| (2.0 * slope[i] - 1.0) * from[i]).sum::<f32>()
    };
    corners(p, period).map(plane).sum()
}
