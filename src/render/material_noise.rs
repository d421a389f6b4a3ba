//! Noise that repeats without a seam over the unit square, for the patterns of the ground.

/// A hash of a lattice point that repeats after `period`: three values in 0..1 (the finaliser of murmur3).
pub(super) fn lattice([x, y]: [i32; 2], period: i32, seed: u32) -> [f32; 3] {
    let (x, y) = (x.rem_euclid(period) as u32, y.rem_euclid(period) as u32);
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ seed.wrapping_mul(0x27D4_EB2F);
    std::array::from_fn(|_| {
        h = (h ^ (h >> 16)).wrapping_mul(0x85EB_CA6B);
        h = (h ^ (h >> 13)).wrapping_mul(0xC2B2_AE35);
        h ^= h >> 16;
        (h >> 8) as f32 / 16_777_216.0
    })
}

/// Smooth noise of one octave with `period` cells along a side, -1..1.
pub(super) fn smooth([u, v]: [f32; 2], period: i32, seed: u32) -> f32 {
    let q = [u * period as f32, v * period as f32];
    let base = q.map(|x| x.floor() as i32);
    let f = [q[0] - base[0] as f32, q[1] - base[1] as f32];
    let [a, b] = f.map(|f| f * f * f * (f * (f * 6.0 - 15.0) + 10.0));
    // Gradients rather than values: no grid shows.
    let corner = |dx: i32, dy: i32| {
        let [x, y, _] = lattice([base[0] + dx, base[1] + dy], period, seed);
        (2.0 * x - 1.0) * (f[0] - dx as f32) + (2.0 * y - 1.0) * (f[1] - dy as f32)
    };
    let mix = |p: f32, q: f32, t: f32| p + (q - p) * t;
    1.4 * mix(mix(corner(0, 0), corner(1, 0), a), mix(corner(0, 1), corner(1, 1), a), b)
}

/// Octaves from `period` cells on, each twice as fine and half as strong, about -1..1.
pub(super) fn fractal(at: [f32; 2], period: i32, octaves: u32, seed: u32) -> f32 {
    (0..octaves).map(|i| smooth(at, period << i, seed + 31 * i) * 0.5_f32.powi(i as i32)).sum()
}

/// What is known of the nearest of scattered points (Worley, A cellular texture basis function, 1996).
#[derive(Clone, Copy)]
pub(super) struct Cell {
    /// Distance to it, in cells.
    pub(super) nearest: f32,
    /// Distance to the border with the next one, in cells.
    pub(super) border: f32,
    /// The way from it, in cells.
    pub(super) from: [f32; 2],
    /// Three numbers of its own, 0..1.
    pub(super) own: [f32; 3],
}

/// One point in each of `period` cells along a side.
pub(super) fn cells([u, v]: [f32; 2], period: i32, seed: u32) -> Cell {
    let q = [u * period as f32, v * period as f32];
    let base = q.map(|x| x.floor() as i32);
    let mut ways = [([0.0_f32; 2], [0_i32; 2]); 25];
    for (i, way) in (0..).zip(&mut ways) {
        let cell = [base[0] + i % 5 - 2, base[1] + i / 5 - 2];
        let [x, y, _] = lattice(cell, period, seed);
        *way = ([q[0] - cell[0] as f32 - x, q[1] - cell[1] as f32 - y], cell);
    }
    let square = |[x, y]: [f32; 2]| x * x + y * y;
    let (from, own) = ways.iter().copied().min_by(|a, b| square(a.0).total_cmp(&square(b.0))).unwrap_or(ways[0]);
    // The border with another point stands halfway, across the line between the two.
    let border = ways.iter().filter(|(_, cell)| *cell != own).map(|(way, _)| {
        let apart = [from[0] - way[0], from[1] - way[1]];
        (square(*way) - square(from)) * 0.5 / square(apart).sqrt().max(1e-6)
    });
    Cell {
        nearest: square(from).sqrt(),
        border: border.fold(f32::MAX, f32::min),
        from,
        own: lattice(own, period, seed ^ 0x5bd1),
    }
}

/// From 0 at `from` to 1 at `to`, whichever is greater.
pub(super) fn step(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}
