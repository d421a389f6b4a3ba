//! Rasters: numbers on grids that cover the whole sphere, sampled smoothly and with exact gradients.
//!
//! Samples are uniform cubic B-splines of the texels (de Boor 1978): twice continuously differentiable, so that
//! shading shows no grid; never outside the range of the texels, so that nothing rings; and softer than the
//! texels by about one of them.
//!
//! - A *globe* is equirectangular: twice as wide as high, north up, longitude 0 in the middle, east to the right. Rows
//!   go on beyond a pole on the opposite meridian. Towards the poles texels are averaged along their row until they are
//!   as wide as high, and around each pole the spline passes into a plane: no pinwheel, no crease.
//! - A *cube* is six square faces in the order of [`super::Face`], each what a camera in the centre sees of the
//!   sphere's inside with an opening angle of 90°, mirrored: seen from outside. North is up; the right edge of the
//!   four around the equator is east; the bottom edge of +Z and the top edge of -Z meet +X. Faces overlap by two
//!   texels and are blended there.
//!
//! Coarser levels, each half as fine, serve what is seen from afar. Everything is f64 with correctly rounded operations
//! and `libm`: the same bits on every machine.

mod near;

use glam::DVec3;
use near::Ranges;
use rayon::prelude::*;
use std::f64::consts::PI;

/// A number as it is stored.
pub trait Texel: Copy + Send + Sync + Default + 'static {
    /// The number.
    fn get(self) -> f64;
    /// The nearest that can be stored.
    fn of(value: f64) -> Self;
}

impl Texel for u16 {
    #[inline(always)]
    fn get(self) -> f64 {
        f64::from(self)
    }
    fn of(value: f64) -> Self {
        (value + 0.5) as u16
    }
}

impl Texel for f32 {
    #[inline(always)]
    fn get(self) -> f64 {
        f64::from(self)
    }
    fn of(value: f64) -> Self {
        value as f32
    }
}

/// A raster and its coarser levels.
pub struct Raster<T> {
    /// The finest first.
    levels: Vec<Level<T>>,
    /// Of the finest level's texels.
    ranges: Ranges<T>,
    bounds: (f64, f64),
}

enum Level<T> {
    Globe(Globe<T>),
    Cube(Cube<T>),
}

/// Coarser levels end before a side has fewer texels than this.
const LEAST_SIDE: usize = 4;

impl<T: Texel> Raster<T> {
    /// An equirectangular raster of `height` rows (at least 4), northernmost first, of `2 * height` texels each.
    pub fn globe(height: usize, texels: Vec<T>) -> Self {
        debug_assert!(height >= LEAST_SIDE && texels.len() == 2 * height * height, "a globe is twice as wide as high");
        let mut levels = vec![(height, texels)];
        while let Some((height, texels)) = levels.last()
            && height / 2 >= LEAST_SIDE
        {
            let half = height / 2;
            levels.push((half, shrunk(texels, [2 * height, *height], [2 * half, half])));
        }
        Self::new(levels.into_iter().map(|(height, texels)| Level::Globe(Globe::new(height, texels))).collect())
    }

    /// A cube of six faces of `side` by `side` texels (at least 4), top row first, one face behind the other.
    pub fn cube(side: usize, texels: Vec<T>) -> Self {
        debug_assert!(side >= LEAST_SIDE && texels.len() == 6 * side * side, "a cube has six square faces");
        let mut levels = vec![(side, texels)];
        while let Some((side, texels)) = levels.last()
            && side / 2 >= LEAST_SIDE
        {
            let half = side / 2;
            let faces = texels.chunks(side * side).flat_map(|face| shrunk(face, [*side; 2], [half; 2])).collect();
            levels.push((half, faces));
        }
        Self::new(levels.into_iter().map(|(side, texels)| Level::Cube(Cube::new(side, &texels))).collect())
    }

    fn new(levels: Vec<Level<T>>) -> Self {
        let bounds = levels.first().map_or((0.0, 0.0), |finest| match finest {
            Level::Globe(globe) => globe.bounds(),
            Level::Cube(cube) => range(&cube.texels),
        });
        let ranges = levels.first().map_or_else(
            || Ranges::new(&[], 1),
            |finest| match finest {
                Level::Globe(globe) => Ranges::new(&globe.texels, 2 * globe.height),
                Level::Cube(cube) => Ranges::new(&cube.texels, cube.side + 2 * MARGIN),
            },
        );
        Self { levels, ranges, bounds }
    }

    /// Lowest and greatest number a sample can be.
    pub fn bounds(&self) -> (f64, f64) {
        self.bounds
    }

    /// The finest level whose texels are no closer together than points so far apart (as an
    /// angle); 0 is the raster itself.
    pub fn level_for(&self, spacing_rad: f64) -> usize {
        let too_fine = |level: &&Level<T>| {
            let texel_rad = match level {
                Level::Globe(globe) => PI / globe.height as f64,
                Level::Cube(cube) => 0.5 * PI / cube.side as f64,
            };
            texel_rad < spacing_rad
        };
        self.levels.iter().take_while(too_fine).count().min(self.levels.len() - 1)
    }

    /// Where a unit direction meets the raster, for samples of any level.
    pub fn place(&self, dir: DVec3) -> Place {
        match &self.levels[0] {
            Level::Globe(_) => Place::on_globe(dir),
            Level::Cube(_) => Place { dir, lon_rad: 0.0, from_pole_rad: 0.0 },
        }
    }

    /// The number at a place.
    pub fn value(&self, place: &Place, level: usize) -> f64 {
        self.sample(place, level).0
    }

    /// The number at a place, and its gradient by the direction (its part in the tangent plane is what counts).
    #[inline(always)]
    pub fn sample(&self, place: &Place, level: usize) -> (f64, DVec3) {
        match &self.levels[level] {
            Level::Globe(globe) => globe.sample(place),
            Level::Cube(cube) => cube.sample(place.dir),
        }
    }
}

/// A direction, with what all levels of a raster need of it.
#[derive(Clone, Copy, Debug)]
pub struct Place {
    dir: DVec3,
    /// On a globe alone: the longitude, and the angle from the nearer pole.
    lon_rad: f64,
    from_pole_rad: f64,
}

impl Place {
    fn on_globe(dir: DVec3) -> Self {
        let flat = (dir.x * dir.x + dir.y * dir.y).sqrt();
        Self { dir, lon_rad: libm::atan2(dir.y, dir.x), from_pole_rad: libm::atan2(flat, dir.z.abs()) }
    }
}

/// The same picture with fewer texels, each the mean of those it covers.
fn shrunk<T: Texel>(texels: &[T], from: [usize; 2], to: [usize; 2]) -> Vec<T> {
    let mut out = vec![T::default(); to[0] * to[1]];
    out.par_chunks_mut(to[0]).enumerate().for_each(|(row, out)| {
        let rows = row * from[1] / to[1]..(row + 1) * from[1] / to[1];
        for (column, out) in out.iter_mut().enumerate() {
            let columns = column * from[0] / to[0]..(column + 1) * from[0] / to[0];
            let count = rows.len() * columns.len();
            let row_sum = |r: usize| texels[r * from[0]..][columns.clone()].iter().map(|t| t.get()).sum::<f64>();
            *out = T::of(rows.clone().map(row_sum).sum::<f64>() / count as f64);
        }
    });
    out
}

fn range<T: Texel>(texels: &[T]) -> (f64, f64) {
    let both = |a: (f64, f64), b: (f64, f64)| (a.0.min(b.0), a.1.max(b.1));
    let one = |part: &[T]| part.iter().fold((f64::MAX, f64::MIN), |range, t| both(range, (t.get(), t.get())));
    texels.par_chunks(1 << 16).map(one).reduce(|| (f64::MAX, f64::MIN), both)
}

/// The four weights of a uniform cubic B-spline and their derivatives, `t` of the way from the
/// second knot to the third.
#[inline(always)]
fn spline(t: f64) -> ([f64; 4], [f64; 4]) {
    let (u, t2) = (1.0 - t, t * t);
    let weights = [
        u * u * u * (1.0 / 6.0),
        (3.0 * t2 * t - 6.0 * t2 + 4.0) * (1.0 / 6.0),
        (3.0 * (t + t2 - t2 * t) + 1.0) * (1.0 / 6.0),
        t2 * t * (1.0 / 6.0),
    ];
    (weights, [-0.5 * u * u, 1.5 * t2 - 2.0 * t, 0.5 + t - 1.5 * t2, 0.5 * t2])
}

/// As `f64::floor`, for small numbers, without a call on machines that have no instruction for it.
#[inline(always)]
fn floor(x: f64) -> f64 {
    let whole = x as isize as f64;
    if whole > x { whole - 1.0 } else { whole }
}

/// The spline at `(x, y)` in texels (texel `i` lies at `i + 0.5`), and its derivatives by x and y. `row(y, x)` gives
/// four texels of row `y` from column `x` on.
#[inline(always)]
fn bicubic(x: f64, y: f64, row: impl Fn(isize, isize) -> [f64; 4]) -> (f64, f64, f64) {
    let (x, y) = (x - 0.5, y - 0.5);
    let (column, line) = (floor(x), floor(y));
    let (wx, dx) = spline(x - column);
    let (wy, dy) = spline(y - line);
    let (mut value, mut by_x, mut by_y) = (0.0, 0.0, 0.0);
    for k in 0..4 {
        let t = row(line as isize - 1 + k as isize, column as isize - 1);
        let along = (t[0] * wx[0] + t[1] * wx[1]) + (t[2] * wx[2] + t[3] * wx[3]);
        let slope = (t[0] * dx[0] + t[1] * dx[1]) + (t[2] * dx[2] + t[3] * dx[3]);
        value += along * wy[k];
        by_x += slope * wy[k];
        by_y += along * dy[k];
    }
    (value, by_x, by_y)
}

/// 0 at `t <= 0`, 1 at `t >= 1`, smooth between; and its derivative.
#[inline(always)]
fn smoothstep(t: f64) -> (f64, f64) {
    let t = t.clamp(0.0, 1.0);
    (t * t * (3.0 - 2.0 * t), 6.0 * t * (1.0 - t))
}

struct Globe<T> {
    height: usize,
    texels: Vec<T>,
    /// North, south.
    poles: [Pole; 2],
}

/// The plane around a pole: `value + slope_x * x + slope_y * y`.
struct Pole {
    value: f64,
    slope_x: f64,
    slope_y: f64,
}

/// Rows over which the spline passes into the plane around a pole.
const CAP_ROWS: f64 = 2.0;

impl<T: Texel> Globe<T> {
    fn new(height: usize, mut texels: Vec<T>) -> Self {
        let width = 2 * height;
        texels.par_chunks_mut(width).enumerate().for_each(|(row, texels)| {
            average_along(texels, 1.0 / libm::sin(PI * (row as f64 + 0.5) / height as f64));
        });
        let row = |row: usize| &texels[row * width..(row + 1) * width];
        let poles = [Pole::new(row(0), row(1)), Pole::new(row(height - 1), row(height - 2))];
        Self { height, texels, poles }
    }

    fn bounds(&self) -> (f64, f64) {
        let cap = libm::sin(CAP_ROWS * PI / self.height as f64);
        self.poles.iter().fold(range(&self.texels), |(lo, hi), pole| {
            let rise = (pole.slope_x * pole.slope_x + pole.slope_y * pole.slope_y).sqrt() * cap;
            (lo.min(pole.value - rise), hi.max(pole.value + rise))
        })
    }

    /// Four texels of a row; rows and columns may lie beyond the edges.
    #[inline(always)]
    fn row(&self, row: isize, column: isize) -> [f64; 4] {
        let (height, width) = (self.height as isize, 2 * self.height as isize);
        let (row, turn) = match row {
            row if row < 0 => (-1 - row, self.height as isize),
            row if row >= height => (2 * height - 1 - row, self.height as isize),
            row => (row, 0),
        };
        let texels = &self.texels[(row * width) as usize..][..width as usize];
        // At most two columns beyond either edge, and half a turn.
        let first = match column + turn {
            first if first < 0 => first + width,
            first if first >= width => first - width,
            first => first,
        };
        if first + 4 <= width {
            let four = &texels[first as usize..][..4];
            [four[0].get(), four[1].get(), four[2].get(), four[3].get()]
        } else {
            std::array::from_fn(|k| texels[((first + k as isize) % width) as usize].get())
        }
    }

    fn sample(&self, place: &Place) -> (f64, DVec3) {
        let dir = place.dir;
        let rows_per_rad = self.height as f64 / PI;
        let pole = &self.poles[usize::from(dir.z < 0.0)];
        let plane = pole.value + pole.slope_x * dir.x + pole.slope_y * dir.y;
        let plane_gradient = DVec3::new(pole.slope_x, pole.slope_y, 0.0);
        let flat2 = dir.x * dir.x + dir.y * dir.y;
        if flat2 < 1e-24 {
            return (plane, plane_gradient);
        }
        let flat = flat2.sqrt();
        let rows_from_pole = place.from_pole_rad * rows_per_rad;
        let y = if dir.z < 0.0 { self.height as f64 - rows_from_pole } else { rows_from_pole };
        let x = (place.lon_rad + PI) * rows_per_rad;
        let (value, by_x, by_y) = bicubic(x, y, |row, column| self.row(row, column));
        // Rows to the south and columns to the east for each step of the direction.
        let south = DVec3::new(dir.z * dir.x / flat, dir.z * dir.y / flat, -flat) * rows_per_rad;
        let east = DVec3::new(-dir.y / flat2, dir.x / flat2, 0.0) * rows_per_rad;
        let gradient = east * by_x + south * by_y;
        if rows_from_pole >= CAP_ROWS {
            return (value, gradient);
        }
        let (share, slope) = smoothstep(rows_from_pole / CAP_ROWS);
        let outwards = if dir.z < 0.0 { -south } else { south };
        let blend = outwards * (slope / CAP_ROWS * (value - plane));
        (plane + (value - plane) * share, plane_gradient * (1.0 - share) + gradient * share + blend)
    }
}

impl Pole {
    /// The plane that fits the two rows next to a pole.
    fn new<T: Texel>(nearest: &[T], next: &[T]) -> Self {
        let width = nearest.len() as f64;
        let radius = libm::sin(1.5 * 2.0 * PI / width);
        let mean = nearest.iter().map(|t| t.get()).sum::<f64>() / width;
        let (mut along_x, mut along_y) = (0.0, 0.0);
        for (column, texel) in next.iter().enumerate() {
            let (sin, cos) = libm::sincos(2.0 * PI * (column as f64 + 0.5) / width - PI);
            along_x += texel.get() * cos;
            along_y += texel.get() * sin;
        }
        let scale = 2.0 / (width * radius);
        Self { value: mean, slope_x: along_x * scale, slope_y: along_y * scale }
    }
}

/// Replaces each texel of a ring by the mean over `width` texels around it (1 or more; ends count by
/// the part that is covered).
fn average_along<T: Texel>(ring: &mut [T], width: f64) {
    let reach = ((width - 1.0) * 0.5).min((ring.len() / 2 - 1) as f64);
    let (whole, part) = (reach.floor() as usize, reach - reach.floor());
    // The ring with its two ends repeated: texel `i` of it stands at `i + whole + 1`.
    let n = ring.len();
    let old: Vec<f64> =
        ring[n - whole - 1..].iter().chain(ring.iter()).chain(&ring[..=whole]).map(|t| t.get()).collect();
    let mut sum: f64 = old[1..2 * whole + 2].iter().sum();
    let full = 1.0 / (1.0 + 2.0 * reach);
    for ((texel, ends), first) in ring.iter_mut().zip(old.windows(2 * whole + 3)).zip(&old[1..]) {
        let (before, after) = (ends[0], ends[2 * whole + 2]);
        *texel = T::of((sum + part * (before + after)) * full);
        sum += after - first;
    }
}

/// Half the width of the strip along an edge in which two faces are blended, in texels.
const BLEND: f64 = 2.0;
/// Texels kept beyond each edge: what a spline at the end of the strip reaches.
const MARGIN: usize = 4;

/// The directions out of each face, to the right and up on it, in the order of [`super::Face`].
const FRAMES: [[DVec3; 3]; 6] = [
    [DVec3::X, DVec3::Y, DVec3::Z],
    [DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z],
    [DVec3::Y, DVec3::NEG_X, DVec3::Z],
    [DVec3::NEG_Y, DVec3::X, DVec3::Z],
    [DVec3::Z, DVec3::Y, DVec3::NEG_X],
    [DVec3::NEG_Z, DVec3::Y, DVec3::X],
];

struct Cube<T> {
    side: usize,
    /// Six faces, each with its margin.
    texels: Vec<T>,
}

/// The unit direction through `(x, y)` of a face of `side` by `side` texels, y counted from the top; it may lie a
/// little beyond the edges.
pub fn cube_direction(face: usize, side: usize, x: f64, y: f64) -> DVec3 {
    let [out, right, up] = FRAMES[face];
    let along = |w: f64| 2.0 * w / side as f64 - 1.0;
    let p = out + right * along(x) - up * along(y);
    p / (p.x * p.x + p.y * p.y + p.z * p.z).sqrt()
}

/// The face that a direction goes through, and the point `(x, y)` on it.
pub fn cube_point(dir: DVec3, side: usize) -> (usize, f64, f64) {
    let face = super::Face::of_direction(dir) as usize;
    let [out, right, up] = FRAMES[face];
    let depth = dir.dot(out);
    let texels = |w: f64| (w / depth + 1.0) * 0.5 * side as f64;
    (face, texels(dir.dot(right)), texels(-dir.dot(up)))
}

impl<T: Texel> Cube<T> {
    fn new(side: usize, faces: &[T]) -> Self {
        let width = side + 2 * MARGIN;
        let inside = |i: usize| (MARGIN..MARGIN + side).contains(&i);
        let mut texels = vec![T::default(); 6 * width * width];
        texels.par_chunks_mut(width).enumerate().for_each(|(line, out)| {
            let (face, row) = (line / width, line % width);
            for (column, out) in out.iter_mut().enumerate() {
                *out = if inside(row) && inside(column) {
                    faces[(face * side + row - MARGIN) * side + column - MARGIN]
                } else {
                    let centre = |i: usize| i as f64 + 0.5 - MARGIN as f64;
                    let (face, x, y) = cube_point(cube_direction(face, side, centre(column), centre(row)), side);
                    T::of(bilinear(&faces[face * side * side..][..side * side], side, x, y))
                };
            }
        });
        Self { side, texels }
    }

    #[inline(always)]
    fn sample(&self, dir: DVec3) -> (f64, DVec3) {
        let half = 0.5 * self.side as f64;
        // Most points lie where one face alone counts.
        let face = super::Face::of_direction(dir) as usize;
        let on_face = OnFace::new(face, dir);
        let inner = 1.0 - BLEND / half;
        if on_face.s.abs() <= inner && on_face.t.abs() <= inner {
            return self.sample_face(face, &on_face);
        }
        self.sample_blended(dir)
    }

    /// What one face has at a point on it.
    #[inline(always)]
    fn sample_face(&self, face: usize, at: &OnFace) -> (f64, DVec3) {
        let half = 0.5 * self.side as f64;
        let (value, by_x, by_y) = self.spline(face, at);
        let [grad_s, grad_t] = at.gradients(face);
        (value, grad_s * (by_x * half) - grad_t * (by_y * half))
    }

    /// The spline of a face, and its derivatives by texels to the right and down.
    #[inline(always)]
    fn spline(&self, face: usize, at: &OnFace) -> (f64, f64, f64) {
        let width = self.side + 2 * MARGIN;
        let half = 0.5 * self.side as f64;
        let texels = &self.texels[face * width * width..][..width * width];
        bicubic(half * (1.0 + at.s), half * (1.0 - at.t), |row, column| {
            let at = (row + MARGIN as isize) * width as isize + column + MARGIN as isize;
            let four = &texels[at as usize..][..4];
            [four[0].get(), four[1].get(), four[2].get(), four[3].get()]
        })
    }

    /// The mean of all faces that reach so far.
    #[inline(never)]
    fn sample_blended(&self, dir: DVec3) -> (f64, DVec3) {
        let half = 0.5 * self.side as f64;
        let (mut sum, mut total) = (0.0, 0.0);
        let (mut sum_gradient, mut total_gradient) = (DVec3::ZERO, DVec3::ZERO);
        for face in 0..FRAMES.len() {
            let at = OnFace::new(face, dir);
            // Beyond this the blend has ended on the coarsest of cubes.
            if at.depth < 0.25 {
                continue;
            }
            // How far within the strip, from 0 at its outer end to 1 at its inner.
            let within = |w: f64| ((1.0 - w.abs()) * half + BLEND) * (0.5 / BLEND);
            let ((ws, dws), (wt, dwt)) = (smoothstep(within(at.s)), smoothstep(within(at.t)));
            let weight = ws * wt;
            if weight == 0.0 {
                continue;
            }
            let (value, gradient) = self.sample_face(face, &at);
            let [grad_s, grad_t] = at.gradients(face);
            let steep = |w: f64, d: f64| if w < 0.0 { d } else { -d } * half * (0.5 / BLEND);
            let weight_gradient = grad_s * (steep(at.s, dws) * wt) + grad_t * (steep(at.t, dwt) * ws);
            sum += weight * value;
            total += weight;
            sum_gradient += gradient * weight + weight_gradient * value;
            total_gradient += weight_gradient;
        }
        let value = sum / total;
        (value, (sum_gradient - total_gradient * value) / total)
    }
}

/// A direction as a face sees it.
struct OnFace {
    depth: f64,
    /// To the right and up, -1 to 1 on the face.
    s: f64,
    t: f64,
}

impl OnFace {
    #[inline(always)]
    fn new(face: usize, dir: DVec3) -> Self {
        let [out, right, up] = FRAMES[face];
        let depth = dir.dot(out);
        Self { depth, s: dir.dot(right) / depth, t: dir.dot(up) / depth }
    }

    /// Of `s` and `t` by the direction.
    #[inline(always)]
    fn gradients(&self, face: usize) -> [DVec3; 2] {
        let [out, right, up] = FRAMES[face];
        [(right - out * self.s) / self.depth, (up - out * self.t) / self.depth]
    }
}

/// Linear between the four nearest texels of a square, which goes on beyond its edges as it ends there.
fn bilinear<T: Texel>(face: &[T], side: usize, x: f64, y: f64) -> f64 {
    let last = (side - 1) as f64;
    let (x, y) = ((x - 0.5).clamp(0.0, last), (y - 0.5).clamp(0.0, last));
    let (column, row) = ((x as usize).min(side - 2), (y as usize).min(side - 2));
    let (tx, ty) = (x - column as f64, y - row as f64);
    let at = |row: usize, column: usize| face[row * side + column].get();
    let line = |row: usize| at(row, column) * (1.0 - tx) + at(row, column + 1) * tx;
    line(row) * (1.0 - ty) + line(row + 1) * ty
}

#[cfg(test)]
mod tests;
