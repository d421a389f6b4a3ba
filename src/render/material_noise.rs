//! Noise that repeats without a seam over the unit square, for the patterns of the ground. Each kind is a table of its lattice, so
//! that a million places are a matter of milliseconds.

/// Three numbers in 0..1 for a place of a lattice (the finaliser of murmur3).
pub(super) fn hash([x, y]: [u32; 2], seed: u32) -> [f32; 3] {
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ seed.wrapping_mul(0x27D4_EB2F);
    std::array::from_fn(|_| {
        h = (h ^ (h >> 16)).wrapping_mul(0x85EB_CA6B);
        h = (h ^ (h >> 13)).wrapping_mul(0xC2B2_AE35);
        h ^= h >> 16;
        (h >> 8) as f32 / 16_777_216.0
    })
}

/// From 0 at `from` to 1 at `to`, whichever is greater.
pub(super) fn step(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Numbers on a lattice of `period` cells along a side, with a border that repeats the other side.
struct Lattice {
    period: usize,
    stride: usize,
    numbers: Vec<[f32; 3]>,
}

/// Cells beyond each side.
const BORDER: usize = 1;

impl Lattice {
    fn new(period: usize, seed: u32) -> Self {
        let stride = period + 2 * BORDER + 1;
        let wrapped = |i: usize| ((i + period - BORDER) % period) as u32;
        let numbers = (0..stride * stride).map(|i| hash([wrapped(i % stride), wrapped(i / stride)], seed)).collect();
        Self { period, stride, numbers }
    }

    /// The lattice cell of a place (index of its corner) and the place in it.
    fn find(&self, at: [f32; 2]) -> (usize, [f32; 2]) {
        let q = at.map(|w| (w - w.floor()) * self.period as f32);
        let cell = q.map(|w| (w as usize).min(self.period - 1));
        let index = (cell[1] + BORDER) * self.stride + cell[0] + BORDER;
        (index, [q[0] - cell[0] as f32, q[1] - cell[1] as f32])
    }
}

/// Gradient noise of one octave, about -1..1.
pub(super) struct Smooth(Lattice);

impl Smooth {
    /// With so many cells along a side.
    pub(super) fn new(period: usize, seed: u32) -> Self {
        Self(Lattice::new(period, seed))
    }

    pub(super) fn at(&self, at: [f32; 2]) -> f32 {
        let (index, f) = self.0.find(at);
        let [a, b] = f.map(|f| f * f * f * (f * (f * 6.0 - 15.0) + 10.0));
        let corner = |dx: usize, dy: usize| {
            let [x, y, _] = self.0.numbers[index + dy * self.0.stride + dx];
            (2.0 * x - 1.0) * (f[0] - dx as f32) + (2.0 * y - 1.0) * (f[1] - dy as f32)
        };
        let mix = |p: f32, q: f32, t: f32| p + (q - p) * t;
        1.4 * mix(mix(corner(0, 0), corner(1, 0), a), mix(corner(0, 1), corner(1, 1), a), b)
    }
}

/// Octaves, each twice as fine and half as strong as the one before, about -1..1.
pub(super) struct Fractal(Vec<Smooth>);

impl Fractal {
    /// The first with so many cells along a side.
    pub(super) fn new(period: usize, octaves: u32, seed: u32) -> Self {
        Self((0..octaves).map(|i| Smooth::new(period << i, seed + 31 * i)).collect())
    }

    pub(super) fn at(&self, at: [f32; 2]) -> f32 {
        let octaves = self.0.iter().zip(std::iter::successors(Some(1.0), |weight| Some(weight * 0.5)));
        octaves.map(|(octave, weight): (_, f32)| octave.at(at) * weight).sum()
    }
}

/// Displaces places by soft noise, so that nothing is straight.
pub(super) struct Warp {
    by: f32,
    noise: [Fractal; 2],
}

impl Warp {
    /// By at most about so much, over so many cells along a side.
    pub(super) fn new(period: usize, by: f32, seed: u32) -> Self {
        Self { by, noise: [Fractal::new(period, 3, seed), Fractal::new(period, 3, seed + 7)] }
    }

    pub(super) fn at(&self, at: [f32; 2]) -> [f32; 2] {
        [at[0] + self.by * self.noise[0].at(at), at[1] + self.by * self.noise[1].at(at)]
    }
}

/// What is known of the nearest of scattered points (Worley, A cellular texture basis function, 1996). Lengths in cells.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    /// Distance to it.
    pub(super) nearest: f32,
    /// Distance to the border with the next one.
    pub(super) border: f32,
    /// The way from it.
    pub(super) from: [f32; 2],
    /// Three numbers of its own, 0..1.
    pub(super) own: [f32; 3],
}

/// Scattered points, one in each cell.
pub(super) struct Cells(Lattice);

impl Cells {
    /// With so many cells along a side.
    pub(super) fn new(period: usize, seed: u32) -> Self {
        Self(Lattice::new(period, seed))
    }

    pub(super) fn at(&self, at: [f32; 2]) -> Cell {
        let (index, f) = self.0.find(at);
        let mut ways = [([0.0_f32; 2], 0_usize); 9];
        for (i, way) in ways.iter_mut().enumerate() {
            let cell = index + (i / 3) * self.0.stride + i % 3 - self.0.stride - 1;
            let [x, y, _] = self.0.numbers[cell];
            // Not up to the cell's sides, or its neighbours' neighbours would matter.
            let point = [0.08 + 0.84 * x + (i % 3) as f32 - 1.0, 0.08 + 0.84 * y + (i / 3) as f32 - 1.0];
            *way = ([f[0] - point[0], f[1] - point[1]], cell);
        }
        let square = |[x, y]: [f32; 2]| x * x + y * y;
        let (from, own) = ways.iter().copied().fold(ways[4], |a, b| if square(b.0) < square(a.0) { b } else { a });
        // The border with another point stands halfway, across the line between the two.
        let border = ways.iter().filter(|(_, cell)| *cell != own).map(|(way, _)| {
            let apart = [from[0] - way[0], from[1] - way[1]];
            (square(*way) - square(from)) * 0.5 / square(apart).sqrt().max(1e-6)
        });
        let [x, y, z] = self.0.numbers[own];
        Cell {
            nearest: square(from).sqrt(),
            border: border.fold(f32::MAX, f32::min),
            from,
            // Other numbers than those that say where it lies.
            own: [z, (x * 61.0 + z * 17.0).fract(), (y * 53.0 + z * 29.0).fract()],
        }
    }
}
