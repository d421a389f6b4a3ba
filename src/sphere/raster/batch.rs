//! Values of cubes at points near each other. These mostly lie between the same texels, so that a loop over them is
//! vectorised; each value is that of [`Raster::value`], to the bit.

use super::cube::{BLEND, Cube, MARGIN, OnFace};
use super::spline::{floor, spline};
use super::texels::Texel;
use super::{Level, Raster};
use crate::simd::{Simd, for_each_simd};
use crate::sphere::Face;
use glam::DVec3;

/// Unit directions near each other, in the coordinates of the face of a cube that holds them.
#[derive(Debug, Default)]
pub struct NearPoints {
    dirs: Vec<DVec3>,
    /// None if they lie on several faces.
    face: Option<usize>,
    s: Vec<f64>,
    t: Vec<f64>,
}

/// The texels around some points, and the place of the first in texels from the corner of the face.
struct Patch {
    texels: [[f64; 4]; 4],
    corner: [f64; 2],
    half: f64,
}

impl NearPoints {
    /// Other points in the same memory.
    pub fn refill(&mut self, dirs: impl Iterator<Item = DVec3>) {
        let Self { dirs: own, face, s, t } = self;
        own.clear();
        own.extend(dirs);
        s.clear();
        t.clear();
        *face = own.first().map(|first| Face::of_direction(*first) as usize);
        if let Some(number) = *face {
            if own.iter().any(|dir| Face::of_direction(*dir) as usize != number) {
                *face = None;
                return;
            }
            for at in own.iter().map(|dir| OnFace::new(number, *dir)) {
                s.push(at.s);
                t.push(at.t);
            }
        }
    }
}

impl<T: Texel> Raster<T> {
    /// The values at points: one number for each. They replace what `values` holds.
    pub fn values(&self, points: &NearPoints, values: &mut Vec<f64>) {
        values.clear();
        if let (Some(Level::Cube(cube)), Some(face)) = (self.levels.first(), points.face)
            && let Some(patch) = cube.patch(face, points)
        {
            values.resize(points.s.len(), 0.0);
            between(Simd::detect(), &patch, &points.s, &points.t, values);
        } else {
            values.extend(points.dirs.iter().map(|dir| self.value(&self.place(*dir), 0)));
        }
    }
}

impl<T: Texel> Cube<T> {
    /// The texels around points of a face. None if these lie between several, or where faces are blended.
    fn patch(&self, face: usize, points: &NearPoints) -> Option<Patch> {
        let half = 0.5 * self.side as f64;
        let inner = 1.0 - BLEND / half;
        let corner = [half * (1.0 + points.s.first()?), half * (1.0 - points.t.first()?)].map(|at| floor(at - 0.5));
        let is_between = |at: f64, corner: f64| at - 0.5 >= corner && at - 0.5 < corner + 1.0;
        let is_here = points.s.iter().zip(&points.t).fold(true, |all, (s, t)| {
            let is_inner = s.abs() <= inner && t.abs() <= inner;
            let (x, y) = (half * (1.0 + s), half * (1.0 - t));
            all & is_inner & is_between(x, corner[0]) & is_between(y, corner[1])
        });
        let width = self.side + 2 * MARGIN;
        let row = |k: usize| {
            let row = (corner[1] as isize - 1 + (k + MARGIN) as isize) as usize;
            let first = (face * width + row) * width + (corner[0] as isize - 1 + MARGIN as isize) as usize;
            let four = self.texels.get(first..first + 4)?;
            Some([four[0].get(), four[1].get(), four[2].get(), four[3].get()])
        };
        is_here.then_some(Patch { texels: [row(0)?, row(1)?, row(2)?, row(3)?], corner, half })
    }
}

#[inline(always)]
fn between_body(patch: &Patch, s: &[f64], t: &[f64], values: &mut [f64]) {
    let Patch { texels, corner, half } = patch;
    for ((s, t), value) in s.iter().zip(t).zip(values) {
        let (x, y) = (half * (1.0 + s) - 0.5, half * (1.0 - t) - 0.5);
        let ((wx, _), (wy, _)) = (spline(x - corner[0]), spline(y - corner[1]));
        let mut sum = 0.0;
        for (row, wy) in texels.iter().zip(wy) {
            sum += ((row[0] * wx[0] + row[1] * wx[1]) + (row[2] * wx[2] + row[3] * wx[3])) * wy;
        }
        *value = sum;
    }
}
for_each_simd!(fn between(patch: &Patch, s: &[f64], t: &[f64], values: &mut [f64]) = between_body);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::spread;

    #[test]
    fn values_of_many_points_are_those_of_each() {
        let texels = (0..6 * 32 * 32_u32).map(|number| (number.wrapping_mul(2_654_435_761) >> 12) as f32).collect();
        let raster: Raster<f32> = Raster::cube(32, texels);
        let (mut points, mut values) = (NearPoints::default(), Vec::new());
        let edges = [DVec3::new(1.0, 0.97, 0.2), DVec3::ONE, DVec3::X];
        for middle in spread(200).chain(edges).map(DVec3::normalize) {
            for apart in [1e-6, 1e-3, 0.05] {
                let dirs: Vec<DVec3> = spread(37).map(|d| (middle + d * apart).normalize()).collect();
                points.refill(dirs.iter().copied());
                raster.values(&points, &mut values);
                let each: Vec<f64> = dirs.iter().map(|dir| raster.value(&raster.place(*dir), 0)).collect();
                assert_eq!(values, each, "{middle} {apart}");
            }
        }
    }
}
