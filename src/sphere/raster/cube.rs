//! The cube layout of a raster: six square faces, blended along their edges.

use super::spline::{bicubic, smoothstep};
use super::texels::Texel;
use crate::sphere::Face;
use glam::DVec3;
use rayon::prelude::*;

/// Half the width of the strip along an edge in which two faces are blended, in texels.
pub(super) const BLEND: f64 = 2.0;
/// Texels kept beyond each edge: the reach of a spline at the end of the strip.
pub(super) const MARGIN: usize = 4;

/// Outward, right and up direction of each face, in the order of [`Face`].
pub(super) const FRAMES: [[DVec3; 3]; 6] = [
    [DVec3::X, DVec3::Y, DVec3::Z],
    [DVec3::NEG_X, DVec3::NEG_Y, DVec3::Z],
    [DVec3::Y, DVec3::NEG_X, DVec3::Z],
    [DVec3::NEG_Y, DVec3::X, DVec3::Z],
    [DVec3::Z, DVec3::Y, DVec3::NEG_X],
    [DVec3::NEG_Z, DVec3::Y, DVec3::X],
];

pub(super) struct Cube<T> {
    pub(super) side: usize,
    /// Six faces, each with its margin.
    pub(super) texels: Vec<T>,
}

/// The unit direction through `(x, y)` of a face of `side` by `side` texels, y counted from the top. The point may
/// lie a little beyond the edges.
pub fn cube_direction(face: usize, side: usize, x: f64, y: f64) -> DVec3 {
    let [out, right, up] = FRAMES[face];
    let along = |w: f64| 2.0 * w / side as f64 - 1.0;
    let p = out + right * along(x) - up * along(y);
    p / (p.x * p.x + p.y * p.y + p.z * p.z).sqrt()
}

/// The face that a direction goes through, and the point `(x, y)` on it.
pub fn cube_point(dir: DVec3, side: usize) -> (usize, f64, f64) {
    let face = Face::of_direction(dir) as usize;
    let [out, right, up] = FRAMES[face];
    let depth = dir.dot(out);
    let texels = |w: f64| (w / depth + 1.0) * 0.5 * side as f64;
    (face, texels(dir.dot(right)), texels(-dir.dot(up)))
}

impl<T: Texel> Cube<T> {
    pub(super) fn new(side: usize, faces: &[T]) -> Self {
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
    pub(super) fn sample(&self, dir: DVec3) -> (f64, DVec3) {
        let half = 0.5 * self.side as f64;
        // Most points lie on one face alone.
        let face = Face::of_direction(dir) as usize;
        let on_face = OnFace::new(face, dir);
        let inner = 1.0 - BLEND / half;
        if on_face.s.abs() <= inner && on_face.t.abs() <= inner {
            return self.sample_face(face, &on_face);
        }
        self.sample_blended(dir)
    }

    /// The sample of one face at a point on it.
    #[inline(always)]
    fn sample_face(&self, face: usize, at: &OnFace) -> (f64, DVec3) {
        let half = 0.5 * self.side as f64;
        let (value, by_x, by_y) = self.spline(face, at);
        let [grad_s, grad_t] = at.gradients(face);
        (value, grad_s * (by_x * half) - grad_t * (by_y * half))
    }

    /// The spline of a face, and its derivatives by texels to the right and down.
    #[inline(always)]
    pub(super) fn spline(&self, face: usize, at: &OnFace) -> (f64, f64, f64) {
        let width = self.side + 2 * MARGIN;
        let half = 0.5 * self.side as f64;
        let texels = &self.texels[face * width * width..][..width * width];
        bicubic(half * (1.0 + at.s), half * (1.0 - at.t), |row, column| {
            let at = (row + MARGIN as isize) * width as isize + column + MARGIN as isize;
            let four = &texels[at as usize..][..4];
            [four[0].get(), four[1].get(), four[2].get(), four[3].get()]
        })
    }

    /// The weighted mean of all faces whose strips hold the direction.
    #[inline(never)]
    fn sample_blended(&self, dir: DVec3) -> (f64, DVec3) {
        let half = 0.5 * self.side as f64;
        let (mut sum, mut total) = (0.0, 0.0);
        let (mut sum_gradient, mut total_gradient) = (DVec3::ZERO, DVec3::ZERO);
        for face in 0..FRAMES.len() {
            let at = OnFace::new(face, dir);
            // Beyond this the blend has ended even on the coarsest cube.
            if at.depth < 0.25 {
                continue;
            }
            // Position within the strip, from 0 at its outer end to 1 at its inner end.
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

/// A direction in the coordinates of a face.
pub(super) struct OnFace {
    pub(super) depth: f64,
    /// To the right and up, -1 to 1 on the face.
    pub(super) s: f64,
    pub(super) t: f64,
}

impl OnFace {
    #[inline(always)]
    pub(super) fn new(face: usize, dir: DVec3) -> Self {
        let [out, right, up] = FRAMES[face];
        let depth = dir.dot(out);
        Self { depth, s: dir.dot(right) / depth, t: dir.dot(up) / depth }
    }

    /// Gradients of `s` and `t` by the direction.
    #[inline(always)]
    fn gradients(&self, face: usize) -> [DVec3; 2] {
        let [out, right, up] = FRAMES[face];
        [(right - out * self.s) / self.depth, (up - out * self.t) / self.depth]
    }
}

/// Bilinear interpolation in a square, constant beyond the outermost texels.
fn bilinear<T: Texel>(face: &[T], side: usize, x: f64, y: f64) -> f64 {
    let last = (side - 1) as f64;
    let (x, y) = ((x - 0.5).clamp(0.0, last), (y - 0.5).clamp(0.0, last));
    let (column, row) = ((x as usize).min(side - 2), (y as usize).min(side - 2));
    let (tx, ty) = (x - column as f64, y - row as f64);
    let at = |row: usize, column: usize| face[row * side + column].get();
    let line = |row: usize| at(row, column) * (1.0 - tx) + at(row, column + 1) * tx;
    line(row) * (1.0 - ty) + line(row + 1) * ty
}
