//! Craters of one size: bowls with a raised rim, scattered without storing any.
//!
//! Space is cut into cells; each holds one jittered centre. Only centres near the sphere's surface count, the fainter the
//! farther they lie off it, which reads as age. Jitter, reach and thickness are chosen so that a crater can only be felt in the
//! eight cells nearest to a point: whatever point asks, it looks at every crater that reaches it.

use super::noise::{self, Octave};

/// Most radius of a crater, in cells.
const RADIUS: f32 = 0.45;
/// How far the ejecta reach, in crater radii.
const REACH: f32 = 1.6;
/// Height of the rim, in depths.
const RIM: f32 = 0.28;
/// Centres up to this far off the surface count, in cells. sqrt((RADIUS * REACH)^2 + THICKNESS^2) + 0.2 (jitter) < 1.
const THICKNESS: f32 = 0.34;

/// Height (-1, the floor of the largest, to [`RIM`]) and gradient by the lattice coordinates, of the craters of an octave at a
/// skewed point. `dir` is the point's unit direction; `density` the share of cells that hold a crater.
#[inline(always)]
pub(crate) fn value_gradient(point_skewed: [f64; 3], dir: [f32; 3], octave: &Octave, density: f32) -> (f32, [f32; 3]) {
    let unskew = (point_skewed[0] + point_skewed[1] + point_skewed[2]) * (1.0 / 6.0);
    let axis = |i: usize| noise::split((point_skewed[i] - unskew) * octave.frequency + octave.offset[i]);
    let ((ix, x), (iy, y), (iz, z)) = (axis(0), axis(1), axis(2));
    // The nearer neighbour along each axis: one cell down in the lower half, one up in the upper.
    let side = |w: f32| if w < 0.5 { (u32::MAX, -1.0) } else { (1, 1.0) };
    let ((sx, ox), (sy, oy), (sz, oz)) = (side(x), side(y), side(z));
    let (mut value, mut gradient) = (0.0_f32, [0.0_f32; 3]);
    for corner in 0..8_u32 {
        let (bx, by, bz) = (corner & 1, corner >> 1 & 1, corner >> 2);
        let cell = [ix.wrapping_add(sx * bx), iy.wrapping_add(sy * by), iz.wrapping_add(sz * bz)];
        let random = noise::cell_hash(cell, octave.seed);
        let unit = |bits: u32| (bits & 1023) as f32 * (1.0 / 1023.0);
        let jitter = |bits: u32| 0.3 + 0.4 * unit(bits);
        let to = [
            ox * bx as f32 + jitter(random) - x,
            oy * by as f32 + jitter(random >> 10) - y,
            oz * bz as f32 + jitter(random >> 20) - z,
        ];
        let more = noise::scramble(random);
        let size = unit(more >> 10);
        let radius = RADIUS * (0.3 + 0.7 * size * size);
        let off = to[0] * dir[0] + to[1] * dir[1] + to[2] * dir[2];
        let flat = [to[0] - off * dir[0], to[1] - off * dir[1], to[2] - off * dir[2]];
        let distance = (flat[0] * flat[0] + flat[1] * flat[1] + flat[2] * flat[2]).sqrt();
        let r = distance / radius;

        let nearness = (1.0 - off.abs() * (1.0 / THICKNESS)).max(0.0);
        let depth =
            if unit(more) < density { nearness * nearness * (3.0 - 2.0 * nearness) * (radius / RADIUS) } else { 0.0 };
        // A bowl up to the rim, then ejecta that run out.
        let inside = r < 1.0;
        let tail = ((REACH - r) * (1.0 / (REACH - 1.0))).max(0.0);
        let height = if inside { (1.0 + RIM) * r * r - 1.0 } else { RIM * tail * tail };
        let slope = if inside { 2.0 * (1.0 + RIM) * r } else { -2.0 * RIM * tail * (1.0 / (REACH - 1.0)) };
        value += depth * height;
        let pull = -depth * slope / (radius * distance.max(1e-6));
        gradient[0] += pull * flat[0];
        gradient[1] += pull * flat[1];
        gradient[2] += pull * flat[2];
    }
    // Overlapping craters dig no deeper than one.
    let keep = if value > -1.0 && value < 1.0 { 1.0 } else { 0.0 };
    (value.clamp(-1.0, 1.0), [gradient[0] * keep, gradient[1] * keep, gradient[2] * keep])
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;

    #[test]
    fn gradients_match_central_differences_and_nothing_jumps() {
        let octave = Octave { frequency: 9.0, offset: [0.3, 17.7, -4.1], seed: 77 };
        let at = |p: DVec3| {
            let p = p.normalize();
            value_gradient(noise::skew(p.to_array()), p.as_vec3().to_array(), &octave, 0.8)
        };
        let (mut off, mut jumps, mut deep) = (0, 0, 0);
        for i in 0..20_000 {
            let angle = f64::from(i) * 1e-3;
            let p = DVec3::new(angle.cos(), angle.sin(), 0.3 * (angle * 0.37).sin()).normalize();
            let along = p.any_orthonormal_vector();
            let step = 1e-4;
            let (lo, hi) = (at(p - along * step), at(p + along * step));
            let difference = f64::from(hi.0 - lo.0) / (2.0 * step) / octave.frequency;
            let (value, gradient) = at(p);
            let exact = DVec3::from_array(gradient.map(f64::from)).dot(along);
            off += i32::from((difference - exact).abs() > 0.3);
            jumps += i32::from((hi.0 - lo.0).abs() > 0.05);
            deep += i32::from(value < -0.3);
        }
        assert!(deep > 200, "there are craters: {deep}");
        assert_eq!(jumps, 0);
        // Differences across a rim's edge are neither side's slope.
        assert!(off < 200, "{off}");
    }
}
