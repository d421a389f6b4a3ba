//! The equirectangular layout of a raster.

use super::Place;
use super::spline::{bicubic, smoothstep};
use super::texels::{Texel, range};
use glam::DVec3;
use rayon::prelude::*;
use std::f64::consts::PI;

pub(super) struct Globe<T> {
    pub(super) height: usize,
    pub(super) texels: Vec<T>,
    /// North, south.
    pub(super) poles: [Pole; 2],
}

/// The plane around a pole: `value + slope_x * x + slope_y * y`.
pub(super) struct Pole {
    pub(super) value: f64,
    pub(super) slope_x: f64,
    pub(super) slope_y: f64,
}

/// Rows over which the spline blends into the plane around a pole.
pub(super) const CAP_ROWS: f64 = 2.0;

impl<T: Texel> Globe<T> {
    pub(super) fn new(height: usize, mut texels: Vec<T>) -> Self {
        let width = 2 * height;
        texels.par_chunks_mut(width).enumerate().for_each(|(row, texels)| {
            average_along(texels, 1.0 / libm::sin(PI * (row as f64 + 0.5) / height as f64));
        });
        let row = |row: usize| &texels[row * width..(row + 1) * width];
        let poles = [Pole::new(row(0), row(1)), Pole::new(row(height - 1), row(height - 2))];
        Self { height, texels, poles }
    }

    pub(super) fn bounds(&self) -> (f64, f64) {
        let cap = libm::sin(CAP_ROWS * PI / self.height as f64);
        self.poles.iter().fold(range(&self.texels), |(lo, hi), pole| {
            let rise = (pole.slope_x * pole.slope_x + pole.slope_y * pole.slope_y).sqrt() * cap;
            (lo.min(pole.value - rise), hi.max(pole.value + rise))
        })
    }

    /// Four texels of a row. Rows and columns may lie beyond the edges.
    #[inline(always)]
    pub(super) fn row(&self, row: isize, column: isize) -> [f64; 4] {
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

    pub(super) fn sample(&self, place: &Place) -> (f64, DVec3) {
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
        // Gradients of rows to the south and columns to the east by the direction.
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
    pub(super) fn new<T: Texel>(nearest: &[T], next: &[T]) -> Self {
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

/// Replaces each texel of a ring by the mean over `width` texels around it (1 or more); texels at the ends count by
/// their covered part.
fn average_along<T: Texel>(ring: &mut [T], width: f64) {
    let reach = ((width - 1.0) * 0.5).min((ring.len() / 2 - 1) as f64);
    let (whole, part) = (reach.floor() as usize, reach - reach.floor());
    // The ring with both ends repeated: its texel `i` is at `i + whole + 1`.
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
