//! Craters of many sizes: bowls with a raised rim, scattered without storing any.
//!
//! Space is cut into cells; each holds one jittered centre. Only centres near the sphere's surface count, the fainter the
//! farther they lie off it, which reads as age. Jitter, reach and thickness are chosen so that a crater can only be felt in the
//! eight cells nearest to a point: whatever point asks, it looks at every crater that reaches it.

use super::fbm::LEAST_POINTS;
use super::octaves::{Weighted, coarser_than, series};
use super::{Chunk, Evaluate, Landform, Scratch};
use crate::planet;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::noise::{self, CHUNK, Lane, Octave, Points3};
use crate::terrain::simd::for_each_simd;

/// Most radius of a crater, in cells.
const RADIUS: f32 = 0.45;
/// How far the ejecta reach, in crater radii.
const REACH: f32 = 1.6;
/// Height of the rim, in depths.
const RIM: f32 = 0.28;
/// Centres up to this far off the surface count, in cells. sqrt((RADIUS * REACH)^2 + THICKNESS^2) + 0.2 (jitter) < 1.
const THICKNESS: f32 = 0.34;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Craters {
    octaves: Vec<Weighted>,
    /// Share of cells that hold a crater.
    density: f32,
}

impl Craters {
    pub(super) fn new(params: &planet::Craters, seed: u64, radius_km: f64) -> Self {
        let planet::Craters { diameter_km, octaves, gain, lacunarity, density } = *params;
        // The widest crater is 0.9 cells across.
        let octaves = series(seed, 0.9 * radius_km / diameter_km, octaves, gain, lacunarity);
        Self { octaves, density: density as f32 }
    }
}

impl Evaluate for Craters {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-1.0, 1.0)
    }

    fn coarse(&self, feature_rad: f64) -> Option<Landform> {
        Some(Landform::Craters(Self { octaves: coarser_than(&self.octaves, feature_rad), density: self.density }))
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, jets: [craters, ..], .. } = scratch;
        let n = chunk.len();
        let mut places = Places::default();
        for Weighted { octave, weight } in &self.octaves {
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            find_places(chunk.simd, chunk.skewed, octave, &mut places);
            dig(chunk.simd, n, &places, octave, self.density, craters);
            sums.add(chunk, &craters.value, &craters.gradient, *weight, &fades);
        }
    }
}

/// Where each point stands in a lattice of cubes, and its direction.
struct Places {
    cell: [Lane<u32>; 3],
    fraction: [Lane<f32>; 3],
    dir: [Lane<f32>; 3],
}

impl Default for Places {
    fn default() -> Self {
        Self { cell: [[0; CHUNK]; 3], fraction: [[0.0; CHUNK]; 3], dir: [[0.0; CHUNK]; 3] }
    }
}

#[inline(always)]
fn find_places_body(skewed: Points3<'_>, octave: &Octave, places: &mut Places) {
    let [x, y, z] = skewed;
    let n = x.len().min(y.len()).min(z.len()).min(CHUNK);
    for axis in 0..3 {
        let p = skewed[axis];
        for i in 0..n {
            let unskewed = p[i] - (x[i] + y[i] + z[i]) * (1.0 / 6.0);
            let (cell, fraction) = noise::split(unskewed * octave.frequency + octave.offset[axis]);
            places.cell[axis][i] = cell;
            places.fraction[axis][i] = fraction;
            places.dir[axis][i] = unskewed as f32;
        }
    }
}
for_each_simd!(fn find_places(skewed: Points3<'_>, octave: &Octave, places: &mut Places) = find_places_body);

#[inline(always)]
fn dig_body(n: usize, places: &Places, octave: &Octave, density: f32, craters: &mut Jets) {
    let ([ix, iy, iz], [fx, fy, fz], [dx, dy, dz]) = (&places.cell, &places.fraction, &places.dir);
    let frequency = octave.frequency as f32;
    for i in 0..n.min(CHUNK) {
        let (v, g) =
            value_gradient([ix[i], iy[i], iz[i]], [fx[i], fy[i], fz[i]], [dx[i], dy[i], dz[i]], octave.seed, density);
        Jet { v, d: [g[0] * frequency, g[1] * frequency, g[2] * frequency] }.store(craters, i);
    }
}
for_each_simd!(fn dig(n: usize, places: &Places, octave: &Octave, density: f32, craters: &mut Jets) = dig_body);

/// Height (-1, the floor of the largest, to [`RIM`]) and gradient by the lattice coordinates, of the craters of an octave at a
/// place in a cell. `dir` is the point's unit direction; `density` the share of cells that hold a crater.
#[inline(always)]
fn value_gradient([ix, iy, iz]: [u32; 3], [x, y, z]: [f32; 3], dir: [f32; 3], seed: u32, density: f32) -> (f32, [f32; 3]) {
    // The nearer neighbour along each axis: one cell down in the lower half, one up in the upper.
    let side = |w: f32| if w < 0.5 { (u32::MAX, -1.0) } else { (1, 1.0) };
    let ((sx, ox), (sy, oy), (sz, oz)) = (side(x), side(y), side(z));
    let (mut value, mut gradient) = (0.0_f32, [0.0_f32; 3]);
    for corner in 0..8_u32 {
        let (bx, by, bz) = (corner & 1, corner >> 1 & 1, corner >> 2);
        let cell = [ix.wrapping_add(sx * bx), iy.wrapping_add(sy * by), iz.wrapping_add(sz * bz)];
        let random = noise::cell_hash(cell, seed);
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
            let [(ix, x), (iy, y), (iz, z)] =
                [0, 1, 2].map(|axis| noise::split(p[axis] * octave.frequency + octave.offset[axis]));
            value_gradient([ix, iy, iz], [x, y, z], p.as_vec3().to_array(), octave.seed, 0.8)
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
