//! Lowest and greatest sample of a raster near a direction: from the range of the texels there or, where they are
//! few, from the rise of the spline between them.

use super::cube::{BLEND, Cube, FRAMES, MARGIN, OnFace};
use super::globe::{CAP_ROWS, Globe};
use super::spline::bicubic;
use super::texels::{Texel, range};
use super::{Level, Place, Raster};
use glam::DVec3;
use std::f64::consts::PI;
use std::ops::Range;

/// Texels along a side of the smallest block whose range is stored.
const BLOCK: usize = 8;
/// About the greatest number of blocks along a side that one query reads.
const FEW: usize = 8;
/// Bound of the error of positions, in texels.
const SLACK: f64 = 1e-6;

/// The ranges of square blocks of a grid's texels, and of blocks of blocks, each twice as wide.
pub(super) struct Ranges<T> {
    levels: Vec<Blocks<T>>,
}

struct Blocks<T> {
    columns: usize,
    /// Lowest, greatest.
    ranges: Vec<(T, T)>,
}

fn both(a: (f64, f64), b: (f64, f64)) -> (f64, f64) {
    (a.0.min(b.0), a.1.max(b.1))
}

const NONE: (f64, f64) = (f64::MAX, f64::MIN);

impl<T: Texel> Ranges<T> {
    pub(super) fn new(texels: &[T], width: usize) -> Self {
        let columns = width.div_ceil(BLOCK);
        let band = |rows: &[T]| -> Vec<(T, T)> {
            let block = |column: usize| {
                let parts = rows.chunks(width).map(|row| &row[column * BLOCK..((column + 1) * BLOCK).min(width)]);
                let all = parts.flatten().fold(NONE, |range, texel| both(range, (texel.get(), texel.get())));
                (T::of(all.0), T::of(all.1))
            };
            (0..columns).map(block).collect()
        };
        let mut levels = vec![Blocks { columns, ranges: texels.chunks(width * BLOCK).flat_map(band).collect() }];
        while let Some(Blocks { columns, ranges }) = levels.last()
            && ranges.len() > FEW
        {
            let (wide, high) = (*columns, ranges.len() / columns);
            let at = |row: usize, column: usize| {
                let four = (2 * row..(2 * row + 2).min(high))
                    .flat_map(|row| ranges[row * wide + 2 * column..row * wide + (2 * column + 2).min(wide)].iter());
                let all = four.fold(NONE, |range, (lo, hi)| both(range, (lo.get(), hi.get())));
                (T::of(all.0), T::of(all.1))
            };
            let half = wide.div_ceil(2);
            let ranges = (0..high.div_ceil(2)).flat_map(|row| (0..half).map(move |column| (row, column)));
            let ranges = ranges.map(|(row, column)| at(row, column)).collect();
            levels.push(Blocks { columns: half, ranges });
        }
        Self { levels }
    }

    /// The range of all texels in some rows and columns, or of a few more.
    fn of(&self, texels: &[T], width: usize, rows: Range<usize>, columns: Range<usize>) -> (f64, f64) {
        let side = rows.len().max(columns.len());
        if side <= BLOCK * 2 {
            return rows.fold(NONE, |sum, row| both(sum, range(&texels[row * width..][columns.clone()])));
        }
        let level = (0..self.levels.len() - 1).find(|level| side <= (BLOCK << level) * FEW);
        let level = level.unwrap_or(self.levels.len() - 1);
        let (block, blocks) = (BLOCK << level, &self.levels[level]);
        (rows.start / block..rows.end.div_ceil(block)).fold(NONE, |sum, row| {
            let row = &blocks.ranges[row * blocks.columns..][columns.start / block..columns.end.div_ceil(block)];
            row.iter().fold(sum, |sum, (lo, hi)| both(sum, (lo.get(), hi.get())))
        })
    }
}

/// A spline around a point: its value, its derivatives by x and y, and a bound of its bend, twice the range of its
/// texels.
fn rise((value, by_x, by_y): (f64, f64, f64), reach: [f64; 2], (lo, hi): (f64, f64)) -> (f64, f64) {
    let [x, y] = reach;
    let rise = by_x.abs() * x + by_y.abs() * y + (hi - lo) * (x + y) * (x + y) + 1e-9 * (1.0 + hi.abs().max(lo.abs()));
    (lo.max(value - rise), hi.min(value + rise))
}

/// The texels of a spline between two positions along an axis.
fn reached(from: f64, to: f64) -> (isize, isize) {
    ((from - 0.5 - SLACK).floor() as isize - 1, (to - 0.5 + SLACK).floor() as isize + 3)
}

impl<T: Texel> Raster<T> {
    /// Lowest and greatest sample within an angle of a unit direction. Conservative.
    pub fn bounds_near(&self, dir: DVec3, angle_rad: f64) -> (f64, f64) {
        let (lo, hi) = self.bounds;
        if angle_rad.is_nan() || angle_rad > 0.5 {
            return (lo, hi);
        }
        let (low, high) = match &self.levels[0] {
            Level::Globe(globe) => globe.bounds_near(&self.ranges, dir, angle_rad),
            Level::Cube(cube) => cube.bounds_near(&self.ranges, dir, angle_rad),
            Level::Flat(_) => (lo, hi),
        };
        (low.max(lo), high.min(hi))
    }
}

impl<T: Texel> Globe<T> {
    fn bounds_near(&self, ranges: &Ranges<T>, dir: DVec3, angle_rad: f64) -> (f64, f64) {
        let (height, width) = (self.height, 2 * self.height);
        let rows_per_rad = height as f64 / PI;
        let place = Place::on_globe(dir);
        let colatitude_rad = if dir.z < 0.0 { PI - place.from_pole_rad } else { place.from_pole_rad };
        let (y, reach_y) = (colatitude_rad * rows_per_rad, angle_rad * rows_per_rad + SLACK);
        let (first, last) = reached(y - reach_y, y + reach_y);
        // Rows beyond a pole are rows before it, on the opposite meridian.
        let over_pole = first < 0 || last > height as isize || place.from_pole_rad <= angle_rad * 1.01 + 1e-9;
        let mut rows = first.max(0) as usize..(last.max(1) as usize).min(height);
        if first < 0 {
            rows.end = rows.end.max((-first) as usize).min(height);
        }
        if last > height as isize {
            rows.start = rows.start.min((2 * height as isize - last).max(0) as usize);
        }
        let half_turn_rad = match over_pole {
            true => PI,
            false => libm::asin((libm::sin(angle_rad) / libm::sin(place.from_pole_rad)).min(1.0)) * (1.0 + 1e-9),
        };
        let (x, reach_x) = ((place.lon_rad + PI) * rows_per_rad, half_turn_rad * rows_per_rad + SLACK);
        let (first, last) = reached(x - reach_x, x + reach_x);
        let mut found = if last - first >= width as isize {
            ranges.of(&self.texels, width, rows, 0..width)
        } else {
            // From the first column on, and from the left edge on for columns beyond the right one.
            let count = (last - first) as usize;
            let first = first.rem_euclid(width as isize) as usize;
            let last = first + count;
            let here = ranges.of(&self.texels, width, rows.clone(), first..last.min(width));
            if last > width { both(here, ranges.of(&self.texels, width, rows, 0..last - width)) } else { here }
        };
        if place.from_pole_rad * rows_per_rad - reach_y > CAP_ROWS {
            let here = bicubic(x, y, |row, column| self.row(row, column));
            return if over_pole { found } else { rise(here, [reach_x, reach_y], found) };
        }
        for (pole, sign) in self.poles.iter().zip([1.0, -1.0]) {
            let from_pole_rad = if sign > 0.0 { colatitude_rad } else { PI - colatitude_rad };
            if from_pole_rad * rows_per_rad - reach_y <= CAP_ROWS {
                let plane = pole.value + pole.slope_x * dir.x + pole.slope_y * dir.y;
                let rise = libm::hypot(pole.slope_x, pole.slope_y) * angle_rad + 1e-9 * (1.0 + plane.abs());
                // Beyond the cap the plane does not count.
                found = both(found, (plane - rise, plane + rise));
            }
        }
        found
    }
}

impl<T: Texel> Cube<T> {
    fn bounds_near(&self, ranges: &Ranges<T>, dir: DVec3, angle_rad: f64) -> (f64, f64) {
        let (half, width) = (0.5 * self.side as f64, self.side + 2 * MARGIN);
        let (inner, outer) = (1.0 - BLEND / half, 1.0 + BLEND / half);
        let mut found = NONE;
        for (face, [out, right, up]) in FRAMES.into_iter().enumerate() {
            let depth = (dir.dot(out) - angle_rad, dir.dot(out) + angle_rad);
            // Directions farther to the side do not count.
            if depth.1 < 0.25 {
                continue;
            }
            let depth = (depth.0.max(0.25), depth.1);
            let along = |axis: DVec3| {
                let (lo, hi) = (dir.dot(axis) - angle_rad, dir.dot(axis) + angle_rad);
                ((lo / depth.0).min(lo / depth.1), (hi / depth.0).max(hi / depth.1))
            };
            let (s, t) = (along(right), along(up));
            if s.0.max(t.0) > outer || s.1.min(t.1) < -outer {
                continue;
            }
            let texels = |lo: f64, hi: f64| {
                let (first, last) = reached(half * (1.0 + lo.max(-outer)), half * (1.0 + hi.min(outer)));
                let margin = MARGIN as isize;
                (first + margin).max(0) as usize..((last + margin).max(1) as usize).min(width)
            };
            let (columns, rows) = (texels(s.0, s.1), texels(-t.1, -t.0));
            let rows = face * width + rows.start..face * width + rows.end;
            let here = ranges.of(&self.texels, width, rows, columns);
            if s.0.min(t.0) >= -inner && s.1.max(t.1) <= inner {
                // One face alone.
                let at = OnFace::new(face, dir);
                let reach = |(lo, hi): (f64, f64), at: f64| half * (hi - at).max(at - lo) + SLACK;
                return rise(self.spline(face, &at), [reach(s, at.s), reach(t, at.t)], here);
            }
            found = both(found, here);
        }
        found
    }
}
