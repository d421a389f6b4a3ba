//! Noise that tiles over the unit square, for the patterns of the ground. Each kind stores its lattice, so that a
//! million points take milliseconds. [`Drawn`] evaluates all texels of a pattern row by row, and shares the terms that
//! texels of a row have in common.

/// Texels along a side of a pattern.
pub(crate) use crate::planet::textures::SIDE;

/// A texel of a pattern.
#[derive(Clone, Copy)]
pub(super) struct Texel {
    /// Its index, row by row.
    pub(super) index: usize,
    /// Its middle in the unit square.
    pub(super) at: [f32; 2],
}

impl Texel {
    pub(super) fn new(index: usize) -> Self {
        Self { index, at: [middle(index % SIDE), middle(index / SIDE)] }
    }
}

fn middle(texel: usize) -> f32 {
    (texel as f32 + 0.5) / SIDE as f32
}

/// Three numbers in 0..1 for a point of a lattice (the finaliser of murmur3).
pub(super) fn hash([x, y]: [u32; 2], seed: u32) -> [f32; 3] {
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ seed.wrapping_mul(0x27D4_EB2F);
    std::array::from_fn(|_| {
        h = (h ^ (h >> 16)).wrapping_mul(0x85EB_CA6B);
        h = (h ^ (h >> 13)).wrapping_mul(0xC2B2_AE35);
        h ^= h >> 16;
        (h >> 8) as f32 / 16_777_216.0
    })
}

/// Smooth step from 0 at `from` to 1 at `to`; either may be the greater.
pub(super) fn step(from: f32, to: f32, x: f32) -> f32 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// Numbers on a lattice of `period` cells along a side. A border repeats the opposite side.
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

    /// Row or column of cells of a coordinate, and the position in the cell.
    fn cell(&self, w: f32) -> (usize, f32) {
        // Rounding by integer conversion: `floor` is a function call on processors without an instruction for it.
        let whole = w as i32 as f32;
        let q = (w - if whole > w { whole - 1.0 } else { whole }) * self.period as f32;
        let cell = (q as i32 as usize).min(self.period - 1);
        (cell, q - cell as f32)
    }

    /// Lattice cell of a point (index of its corner), and the position in the cell.
    fn find(&self, at: [f32; 2]) -> (usize, [f32; 2]) {
        let ((column, x), (row, y)) = (self.cell(at[0]), self.cell(at[1]));
        ((row + BORDER) * self.stride + column + BORDER, [x, y])
    }
}

/// Interpolation weight between two corners, with zero derivatives at both.
fn fade(f: f32) -> f32 {
    f * f * f * (f * (f * 6.0 - 15.0) + 10.0)
}

fn mix(p: f32, q: f32, t: f32) -> f32 {
    p + (q - p) * t
}

/// Scales gradient noise to about -1..1.
const SMOOTH: f32 = 1.4;

/// Gradient noise of one octave, about -1..1.
pub(super) struct Smooth(Lattice);

impl Smooth {
    /// `period`: cells along a side.
    pub(super) fn new(period: usize, seed: u32) -> Self {
        Self(Lattice::new(period, seed))
    }

    pub(super) fn at(&self, at: [f32; 2]) -> f32 {
        let (index, [x, y]) = self.0.find(at);
        let corner = |dx: usize, dy: usize| {
            let [gx, gy, _] = self.0.numbers[index + dy * self.0.stride + dx];
            (2.0 * gx - 1.0) * (x - dx as f32) + (2.0 * gy - 1.0) * (y - dy as f32)
        };
        let a = fade(x);
        SMOOTH * mix(mix(corner(0, 0), corner(1, 0), a), mix(corner(0, 1), corner(1, 1), a), fade(y))
    }

    /// For each column of texels: its column of cells, the position in the cell, and its interpolation weight.
    fn columns(&self) -> [(usize, f32, f32); SIDE] {
        std::array::from_fn(|x| {
            let (cell, f) = self.0.cell(middle(x));
            (cell + BORDER, f, fade(f))
        })
    }

    /// Adds a row of texels to `sums`. `columns`: from [`Smooth::columns`]. `sides`: scratch memory.
    fn add_row(
        &self,
        y: usize,
        columns: &[(usize, f32, f32); SIDE],
        weight: f32,
        sides: &mut Vec<[f32; 2]>,
        sums: &mut [f32],
    ) {
        let (cell, f) = self.0.cell(middle(y));
        let (start, b) = ((cell + BORDER) * self.0.stride, fade(f));
        let (below, above) = self.0.numbers[start..start + 2 * self.0.stride].split_at(self.0.stride);
        // Interpolated across the rows, each column of corners gives a plane: a slope along the row and an offset.
        sides.clear();
        sides.extend(below.iter().zip(above).map(|([px, py, _], [qx, qy, _])| {
            let signed = |w: &f32| 2.0 * w - 1.0;
            [mix(signed(px), signed(qx), b), mix(signed(py) * f, signed(qy) * (f - 1.0), b)]
        }));
        for (sum, (column, f, a)) in sums.iter_mut().zip(columns) {
            let ([slope, level], [next_slope, next_level]) = (sides[*column], sides[*column + 1]);
            *sum += weight * SMOOTH * mix(slope * f + level, next_slope * (f - 1.0) + next_level, *a);
        }
    }
}

/// Fractal noise, about -1..1: each octave is twice as fine and half as strong as the octave before.
pub(super) struct Fractal(Vec<Smooth>);

impl Fractal {
    /// `period`: cells of the first octave along a side.
    pub(super) fn new(period: usize, octaves: u32, seed: u32) -> Self {
        Self((0..octaves).map(|i| Smooth::new(period << i, seed + 31 * i)).collect())
    }

    pub(super) fn at(&self, at: [f32; 2]) -> f32 {
        let octaves = self.0.iter().zip(std::iter::successors(Some(1.0), |weight| Some(weight * 0.5)));
        octaves.map(|(octave, weight): (_, f32)| octave.at(at) * weight).sum()
    }
}

/// Fractal noise at all texels of a pattern.
pub(super) struct Drawn(Vec<f32>);

impl Drawn {
    /// As [`Fractal::new`].
    pub(super) fn new(period: usize, octaves: u32, seed: u32) -> Self {
        let fractal = Fractal::new(period, octaves, seed);
        let columns: Vec<_> = fractal.0.iter().map(Smooth::columns).collect();
        let mut values = vec![0.0; SIDE * SIDE];
        let mut sides = Vec::new();
        for (y, row) in values.chunks_mut(SIDE).enumerate() {
            let mut weight = 1.0;
            for (octave, columns) in fractal.0.iter().zip(&columns) {
                octave.add_row(y, columns, weight, &mut sides, row);
                weight *= 0.5;
            }
        }
        Self(values)
    }

    pub(super) fn at(&self, texel: Texel) -> f32 {
        self.0[texel.index]
    }
}

/// Displaces texels by smooth noise, so that nothing is straight.
pub(super) struct Warp {
    by: f32,
    noise: [Drawn; 2],
}

impl Warp {
    /// `by`: largest displacement, approximately. `period`: cells of the noise along a side.
    pub(super) fn new(period: usize, by: f32, seed: u32) -> Self {
        Self { by, noise: [Drawn::new(period, 3, seed), Drawn::new(period, 3, seed + 7)] }
    }

    pub(super) fn at(&self, texel: Texel) -> [f32; 2] {
        std::array::from_fn(|axis| texel.at[axis] + self.by * self.noise[axis].at(texel))
    }
}

/// The nearest of scattered points (Worley, A cellular texture basis function, 1996). Lengths are in cells.
#[derive(Clone, Copy)]
pub(super) struct Cell {
    /// Distance to the nearest point.
    pub(super) nearest: f32,
    /// Vector from the nearest point.
    pub(super) from: [f32; 2],
    /// Three random numbers of the nearest point, 0..1.
    pub(super) own: [f32; 3],
    /// Vectors from the nine points around, x and y apart, and the index of the nearest.
    ways: [[f32; 9]; 2],
    which: usize,
}

impl Cell {
    /// Distance to the border of the cell, which is the bisector between the nearest point and another point.
    pub(super) fn border(&self) -> f32 {
        let ([xs, ys], [fx, fy]) = (&self.ways, self.from);
        let near = fx * fx + fy * fy;
        let mut squares = [0.0_f32; 9];
        for ((square, x), y) in squares.iter_mut().zip(xs).zip(ys) {
            let (ax, ay) = (fx - x, fy - y);
            let farther = x * x + y * y - near;
            *square = farther * farther / (ax * ax + ay * ay + 1e-12);
        }
        squares[self.which] = f32::MAX;
        0.5 * squares.into_iter().fold(f32::MAX, |a, b| if b < a { b } else { a }).sqrt()
    }
}

/// Fractional part of a number that is not negative.
fn fraction(w: f32) -> f32 {
    w - w as i32 as f32
}

/// Scattered points, one in each cell.
pub(super) struct Cells {
    lattice: Lattice,
    /// Position of each point in its cell.
    points: Vec<[f32; 2]>,
}

impl Cells {
    /// `period`: cells along a side.
    pub(super) fn new(period: usize, seed: u32) -> Self {
        let lattice = Lattice::new(period, seed);
        // Points keep a distance from the sides of their cells; otherwise points two cells away could be the nearest.
        let points = lattice.numbers.iter().map(|[x, y, _]| [x, y].map(|w| 0.08 + 0.84 * w)).collect();
        Self { lattice, points }
    }

    pub(super) fn at(&self, at: [f32; 2]) -> Cell {
        let ((index, place), stride) = (self.lattice.find(at), self.lattice.stride);
        let (mut ways, mut squares, start) = ([[0.0_f32; 9]; 2], [0.0_f32; 9], index - stride - 1);
        for row in 0..3 {
            let start = start + row * stride;
            for (column, [x, y]) in self.points[start..start + 3].iter().enumerate() {
                ways[0][3 * row + column] = place[0] - (x + (column as f32 - 1.0));
                ways[1][3 * row + column] = place[1] - (y + (row as f32 - 1.0));
            }
        }
        for (i, square) in squares.iter_mut().enumerate() {
            *square = ways[0][i] * ways[0][i] + ways[1][i] * ways[1][i];
        }
        let (mut which, mut nearest) = (0, f32::MAX);
        for (i, square) in squares.into_iter().enumerate() {
            (which, nearest) = if square < nearest { (i, square) } else { (which, nearest) };
        }
        let [x, y, z] = self.lattice.numbers[start + which / 3 * stride + which % 3];
        Cell {
            nearest: nearest.sqrt(),
            from: ways.map(|ways| ways[which]),
            // Numbers independent of the position of the point.
            own: [z, fraction(x * 61.0 + z * 17.0), fraction(y * 53.0 + z * 29.0)],
            ways,
            which,
        }
    }
}

/// Things that lie scattered: cells with bent outlines, of which a share holds one.
pub(super) struct Scattered {
    /// Cells along a side.
    pub(super) period: f32,
    share: f32,
    bend: Warp,
    cells: Cells,
}

impl Scattered {
    /// `period`: cells along a side. `share`: of the cells that hold a thing. `bend`: noise cells along a cell, and how
    /// far they move its outline, in cells.
    pub(super) fn new(period: usize, share: f32, bend: (usize, f32), seed: u32) -> Self {
        let (across, by) = bend;
        let bend = Warp::new(across * period, by / period as f32, seed + 50);
        Self { period: period as f32, share, bend, cells: Cells::new(period, seed) }
    }

    /// The cell at a texel, if it holds a thing. Its first number is the rarity of the thing, up to the share.
    pub(super) fn at(&self, at: Texel) -> Option<Cell> {
        let cell = self.cells.at(self.bend.at(at));
        (cell.own[0] <= self.share).then_some(cell)
    }

    /// The place of a texel with bent outlines.
    pub(super) fn bent(&self, at: Texel) -> [f32; 2] {
        self.bend.at(at)
    }
}
