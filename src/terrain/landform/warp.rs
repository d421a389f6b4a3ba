//! Domain warping: points displaced by a vector noise before a landform is evaluated at them.
//!
//! The displacement is found in f64, because a step of f32 in hundreds of kilometres is centimetres; its Jacobian, which only
//! turns gradients, in f32.

use super::fbm::{LEAST_POINTS, add_octaves};
use super::octaves::{Weighted, series};
use super::{Chunk, Sums, add_gradient};
use crate::terrain::noise::{self, CHUNK, Lane, Noise, Points3, precise};
use crate::terrain::simd::for_each_simd;

/// So many octaves of a warped noise are summed in f64, so that it is smooth underfoot: in the coarsest, a step of f32 is
/// half a millimetre of 4 km.
const PRECISE: usize = 2;

/// Root mean square of the noise's derivative along one axis of its lattice.
const DERIVATIVE: f64 = 1.2;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Warp {
    octaves: Vec<Weighted>,
    /// Displacement at a noise of 1, in radii.
    reach: f64,
}

/// Where the points of a chunk went.
#[derive(Default)]
pub(crate) struct Displaced {
    skewed: Displacement,
    /// For each band the derivatives of the displaced point by the point: `[coordinate displaced][coordinate]`.
    jacobians: Vec<[[Lane<f32>; 3]; 3]>,
}

struct Displacement([Lane<f64>; 3]);

impl Default for Displacement {
    fn default() -> Self {
        Self([[0.0; CHUNK]; 3])
    }
}

impl Warp {
    /// A vector noise of `octaves` octaves, the coarsest with `frequency` cells to the radius, that displaces by `reach` radii.
    pub(super) fn new(seed: u64, frequency: f64, octaves: u32, reach: f64) -> Self {
        // Another sequence than that of the noise that is warped.
        Self { octaves: series(noise::mix(!seed), frequency, octaves, 0.5, 2.0), reach }
    }

    /// How many octaves of noise it takes at a point.
    pub(super) fn octave_count(&self) -> usize {
        3 * self.octaves.len()
    }

    /// By how much features of the warped noise are typically squeezed.
    fn squeeze(&self) -> f64 {
        let shear = |o: &Weighted| self.reach * f64::from(o.weight) * o.octave.frequency * DERIVATIVE;
        1.0 + self.octaves.iter().map(|o| shear(o) * shear(o)).sum::<f64>().sqrt()
    }

    /// Adds octaves of noise at the displaced points of a chunk.
    pub(super) fn add_octaves(
        &self,
        octaves: &[Weighted],
        chunk: &Chunk<'_>,
        noise: &mut Noise,
        displaced: &mut Displaced,
        sums: &mut Sums,
    ) {
        self.displace(chunk, noise, displaced);
        let there = Chunk { skewed: displaced.points(chunk.len()), ..*chunk };
        let least_points = LEAST_POINTS * self.squeeze();
        let (coarse, fine) = octaves.split_at(PRECISE.min(octaves.len()));
        for Weighted { octave, weight } in coarse {
            precise::add(chunk.simd, there.skewed, octave, f64::from(*weight), &mut sums.value);
            let fades = chunk.fades(1.0 / octave.frequency, least_points);
            if !fades.is_unseen() {
                noise.gradients(chunk.simd, there.skewed, octave);
                sums.add_gradients(chunk, &noise.gradient, *weight, &fades);
            }
        }
        add_octaves(fine, &there, least_points, noise, sums);
        displaced.pull_back(chunk, sums);
    }

    /// Displaces the points of a chunk.
    fn displace(&self, chunk: &Chunk<'_>, noise: &mut Noise, displaced: &mut Displaced) {
        let n = chunk.len();
        displaced.skewed.0 = [[0.0; CHUNK]; 3];
        displaced.jacobians.resize(chunk.spacings_rad.len(), [[[0.0; CHUNK]; 3]; 3]);
        for jacobian in &mut displaced.jacobians {
            for (row, lanes) in jacobian.iter_mut().enumerate() {
                for (column, lane) in lanes.iter_mut().enumerate() {
                    lane.fill(if row == column { 1.0 } else { 0.0 });
                }
            }
        }
        for Weighted { octave, weight } in &self.octaves {
            let reach = self.reach * f64::from(*weight);
            precise::add_vector(chunk.simd, chunk.skewed, octave, reach, &mut displaced.skewed.0);
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            if fades.is_unseen() {
                continue;
            }
            for (row, octave) in precise::components(octave).iter().enumerate() {
                noise.gradients(chunk.simd, chunk.skewed, octave);
                for (jacobian, share) in displaced.jacobians.iter_mut().zip(fades.0) {
                    add_gradient(chunk.simd, n, &noise.gradient, reach as f32 * share, &mut jacobian[row]);
                }
            }
        }
        add_skewed(chunk.simd, chunk.skewed, &mut displaced.skewed.0);
    }
}

impl Displaced {
    /// The displaced points, of which there are `n`.
    fn points(&self, n: usize) -> Points3<'_> {
        self.skewed.0.each_ref().map(|lane| &lane[..n])
    }

    /// Turns gradients by the displaced points into gradients by the points.
    fn pull_back(&self, chunk: &Chunk<'_>, sums: &mut Sums) {
        for (jacobian, gradient) in self.jacobians.iter().zip(&mut sums.gradients) {
            multiply(chunk.simd, chunk.len(), jacobian, gradient);
        }
    }
}

/// Skews displacements and adds the skewed points.
#[inline(always)]
fn add_skewed_body(skewed: Points3<'_>, displaced: &mut [Lane<f64>; 3]) {
    let ([x, y, z], [qx, qy, qz]) = (skewed, displaced);
    for i in 0..x.len().min(y.len()).min(z.len()).min(CHUNK) {
        let [sx, sy, sz] = noise::skew([qx[i], qy[i], qz[i]]);
        qx[i] = x[i] + sx;
        qy[i] = y[i] + sy;
        qz[i] = z[i] + sz;
    }
}
for_each_simd!(fn add_skewed(skewed: Points3<'_>, displaced: &mut [Lane<f64>; 3]) = add_skewed_body);

/// Gradients times the Jacobian.
#[inline(always)]
fn multiply_body(n: usize, jacobian: &[[Lane<f32>; 3]; 3], gradient: &mut [Lane<f32>; 3]) {
    let ([jx, jy, jz], [x, y, z]) = (jacobian, gradient);
    for i in 0..n.min(CHUNK) {
        let (gx, gy, gz) = (x[i], y[i], z[i]);
        x[i] = jx[0][i] * gx + jy[0][i] * gy + jz[0][i] * gz;
        y[i] = jx[1][i] * gx + jy[1][i] * gy + jz[1][i] * gz;
        z[i] = jx[2][i] * gx + jy[2][i] * gy + jz[2][i] * gz;
    }
}
for_each_simd!(fn multiply(n: usize, jacobian: &[[Lane<f32>; 3]; 3], gradient: &mut [Lane<f32>; 3]) = multiply_body);
