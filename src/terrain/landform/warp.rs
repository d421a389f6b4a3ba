//! Domain warping: a vector noise displaces points before a landform is evaluated at them.
//!
//! The displacement is f64, because a step of f32 in hundreds of kilometres is centimetres. Its Jacobian, which only
//! turns gradients, is f32.

use super::chunk::{Chunk, Sums, add_gradient, add_gradient_f64};
use super::fbm::{LEAST_POINTS, add_octaves};
use super::octaves::{Weighted, series};
use super::scratch::{Displaced, Jacobian64};
use super::varying::{Around, Point, Varying};
use crate::simd::for_each_simd;
use crate::terrain::lane::{CHUNK, Lane, Points3};
use crate::terrain::noise::{self, Noise, lattice};
use crate::terrain::scalar::Scalar;
use crate::world::noise::mix;

/// Least number of octaves of a warped noise in f64, so that it is smooth underfoot: in the coarsest, a step of f32
/// is half a millimetre of 4 km.
const LEAST_F64_OCTAVES: usize = 2;

/// Greatest displacement at a noise of 1, in radii.
const MAX_REACH: f64 = 8.0;

/// Root mean square of the derivative of the noise along one axis of its lattice.
const DERIVATIVE: f64 = 1.2;

#[derive(Clone, Debug, PartialEq)]
pub(super) struct Warp {
    octaves: Vec<Weighted>,
    /// Displacement at a noise of 1, in radii.
    reach: f64,
}

impl Warp {
    /// A vector noise of `octaves` octaves, the coarsest with `frequency` cells per radius, that displaces by `reach`
    /// radii.
    pub(super) fn new(seed: u64, frequency: f64, octaves: u32, reach: f64) -> Self {
        // The lattice must stay within what f64 can split; a few radii away is as good as any distance.
        let reach = reach.min(MAX_REACH);
        // A seed apart from that of the warped noise.
        Self { octaves: series(mix(!seed), frequency, octaves, 0.5, 2.0), reach }
    }

    /// How many octaves of noise one point takes.
    pub(super) fn octave_count(&self) -> usize {
        3 * self.octaves.len()
    }

    /// The images of the directions around one, and their derivatives by the direction:
    /// `[coordinate displaced][coordinate]`.
    pub(super) fn near(&self, around: Around) -> (Point, [[Varying; 3]; 3]) {
        let point = Point::new(around);
        let mut there = point.coordinates;
        let unit = |on: bool| Varying::constant(around, if on { 1.0 } else { 0.0 });
        let mut jacobian = [0, 1, 2].map(|row| [0, 1, 2].map(|column| unit(row == column)));
        for Weighted { octave, weight } in &self.octaves {
            let reach = self.reach * f64::from(*weight);
            for (axis, octave) in lattice::components(octave).iter().enumerate() {
                let (noise, slope) = point.noise_and_slope(octave);
                there[axis] = there[axis] + noise.scale(reach);
                for (derivative, slope) in jacobian[axis].iter_mut().zip(slope) {
                    *derivative = *derivative + slope.scale(reach * octave.frequency);
                }
            }
        }
        (Point::displaced(around, there), jacobian)
    }

    /// Typical factor by which features of the warped noise are squeezed.
    fn squeeze(&self) -> f64 {
        let shear = |o: &Weighted| self.reach * f64::from(o.weight) * o.octave.frequency * DERIVATIVE;
        1.0 + self.octaves.iter().map(|o| shear(o) * shear(o)).sum::<f64>().sqrt()
    }

    /// Adds octaves of noise at the displaced points of a chunk, at least `f64_octaves` of them in f64.
    pub(super) fn add_octaves(
        &self,
        octaves: &[Weighted],
        f64_octaves: usize,
        chunk: &Chunk<'_>,
        noise: &mut Noise,
        displaced: &mut Displaced,
        sums: &mut Sums,
    ) {
        self.displace(chunk, false, noise, displaced);
        let there = Chunk { skewed: displaced.points(chunk.len()), ..*chunk };
        let least_points = LEAST_POINTS * self.squeeze();
        let (coarse, fine) = octaves.split_at(f64_octaves.max(LEAST_F64_OCTAVES).min(octaves.len()));
        for Weighted { octave, weight } in coarse {
            noise.add_f64(chunk.simd, there.skewed, octave, f64::from(*weight), &mut sums.value);
            let fades = chunk.fades(1.0 / octave.frequency, least_points);
            if !fades.is_unseen() {
                noise.gradients(chunk.simd, there.skewed, octave);
                sums.add_gradients(chunk, &noise.gradient, *weight, &fades);
            }
        }
        add_octaves(fine, 0, &there, least_points, noise, sums);
        displaced.pull_back(chunk, sums);
    }

    /// Displaces the points of a chunk; with second derivatives if `curved`.
    pub(super) fn displace(&self, chunk: &Chunk<'_>, curved: bool, noise: &mut Noise, displaced: &mut Displaced) {
        let n = chunk.len();
        displaced.restart(n, chunk.spacings_rad.len(), curved);
        for Weighted { octave, weight } in &self.octaves {
            let reach = self.reach * f64::from(*weight);
            noise.add_f64_vector(chunk.simd, chunk.skewed, octave, reach, &mut displaced.skewed);
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            if fades.is_unseen() {
                continue;
            }
            for (row, octave) in lattice::components(octave).iter().enumerate() {
                if curved {
                    noise.curvatures(chunk.simd, chunk.skewed, octave);
                    add_curvature(chunk.simd, n, &noise.curvature, reach as f32, &mut displaced.curvatures[row]);
                } else {
                    noise.gradients(chunk.simd, chunk.skewed, octave);
                }
                for (jacobian, share) in displaced.jacobians[..displaced.bands].iter_mut().zip(fades.0) {
                    add_gradient(chunk.simd, n, &noise.gradient, reach as f32 * share, &mut jacobian[row]);
                }
            }
        }
        add_skewed(chunk.simd, chunk.skewed, &mut displaced.skewed);
    }
}

impl Jacobian64 {
    /// Finds the derivatives at the points of a chunk.
    pub(super) fn find(&mut self, warp: &Warp, chunk: &Chunk<'_>, noise: &mut Noise<f64>) {
        let n = chunk.len();
        identity(n, &mut self.0);
        for Weighted { octave, weight } in &warp.octaves {
            let reach = warp.reach * f64::from(*weight);
            noise.find_vector(chunk.simd, chunk.skewed, octave);
            for (component, sums) in self.0.iter_mut().enumerate() {
                noise.vector_gradients(chunk.simd, n, octave, component);
                add_gradient_f64(chunk.simd, n, &noise.gradient, reach, sums);
            }
        }
    }

    /// Turns the gradient of a noise by the displaced points into the gradient by the points.
    pub(super) fn pull_back(&self, chunk: &Chunk<'_>, noise: &mut Noise<f64>) {
        multiply::<f64>(chunk.simd, chunk.len(), &self.0, &mut noise.gradient);
    }
}

/// Makes a Jacobian the identity at the first `n` points.
fn identity<S: Scalar>(n: usize, jacobian: &mut [[Lane<S>; 3]; 3]) {
    for (row, lanes) in jacobian.iter_mut().enumerate() {
        for (column, lane) in lanes.iter_mut().enumerate() {
            lane[..n].fill(S::of(if row == column { 1.0 } else { 0.0 }));
        }
    }
}

impl Displaced {
    /// Points without displacement.
    pub(super) fn restart(&mut self, n: usize, bands: usize, curved: bool) {
        self.skewed.iter_mut().for_each(|lane| lane[..n].fill(0.0));
        self.bands = bands;
        if self.jacobians.len() < bands {
            self.jacobians.resize(bands, [[[0.0; CHUNK]; 3]; 3]);
        }
        self.jacobians[..bands].iter_mut().for_each(|jacobian| identity(n, jacobian));
        if curved {
            self.curvatures.iter_mut().flatten().for_each(|lane| lane[..n].fill(0.0));
        }
    }

    /// The first `n` displaced points.
    pub(super) fn points(&self, n: usize) -> Points3<'_> {
        self.skewed.each_ref().map(|lane| &lane[..n])
    }

    /// Turns the gradient of a noise by the displaced points (and second derivatives, if `curved`) into derivatives
    /// by the points, as the first band shows them.
    pub(super) fn pull_back_noise(&self, chunk: &Chunk<'_>, curved: bool, noise: &mut Noise) {
        let Some(jacobian) = self.jacobians[..self.bands].first() else { return };
        if curved {
            bend(chunk.simd, chunk.len(), jacobian, &self.curvatures, noise);
        }
        multiply::<f32>(chunk.simd, chunk.len(), jacobian, &mut noise.gradient);
    }

    /// Turns gradients by the displaced points into gradients by the points.
    pub(super) fn pull_back(&self, chunk: &Chunk<'_>, sums: &mut Sums) {
        for (jacobian, gradient) in self.jacobians[..self.bands].iter().zip(sums.gradients_mut()) {
            multiply::<f32>(chunk.simd, chunk.len(), jacobian, gradient);
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
fn multiply_body<S: Scalar>(n: usize, jacobian: &[[Lane<S>; 3]; 3], gradient: &mut [Lane<S>; 3]) {
    let ([jx, jy, jz], [x, y, z]) = (jacobian, gradient);
    for i in 0..n.min(CHUNK) {
        let (gx, gy, gz) = (x[i], y[i], z[i]);
        x[i] = jx[0][i] * gx + jy[0][i] * gy + jz[0][i] * gz;
        y[i] = jx[1][i] * gx + jy[1][i] * gy + jz[1][i] * gz;
        z[i] = jx[2][i] * gx + jy[2][i] * gy + jz[2][i] * gz;
    }
}
for_each_simd!(fn multiply<S: Scalar>(n: usize, jacobian: &[[Lane<S>; 3]; 3], gradient: &mut [Lane<S>; 3]) = multiply_body);

#[inline(always)]
fn add_curvature_body(n: usize, curvature: &[Lane<f32>; 6], weight: f32, sum: &mut [Lane<f32>; 6]) {
    for (sum, curvature) in sum.iter_mut().zip(curvature) {
        for i in 0..n.min(CHUNK) {
            sum[i] += curvature[i] * weight;
        }
    }
}
for_each_simd!(fn add_curvature(n: usize, curvature: &[Lane<f32>; 6], weight: f32, sum: &mut [Lane<f32>; 6]) = add_curvature_body);

/// Second derivatives of a noise by the points, by the chain rule: `J' H J` plus the gradient times those of the
/// displacement.
#[inline(always)]
fn bend_body(n: usize, jacobian: &[[Lane<f32>; 3]; 3], curvatures: &[[Lane<f32>; 6]; 3], noise: &mut Noise) {
    let ([jx, jy, jz], [cx, cy, cz]) = (jacobian, curvatures);
    let ([x, y, z], [hxx, hyy, hzz, hyz, hzx, hxy]) = (&noise.gradient, &mut noise.curvature);
    for i in 0..n.min(CHUNK) {
        let [xx, yy, zz, yz, zx, xy] = [hxx[i], hyy[i], hzz[i], hyz[i], hzx[i], hxy[i]];
        let half = |k: usize| {
            let (a, b, c) = (jx[k][i], jy[k][i], jz[k][i]);
            [xx * a + xy * b + zx * c, xy * a + yy * b + yz * c, zx * a + yz * b + zz * c]
        };
        let (half_x, half_y, half_z) = (half(0), half(1), half(2));
        let whole = |k: usize, half: [f32; 3], c: usize| {
            jx[k][i] * half[0]
                + jy[k][i] * half[1]
                + jz[k][i] * half[2]
                + (x[i] * cx[c][i] + y[i] * cy[c][i] + z[i] * cz[c][i])
        };
        hxx[i] = whole(0, half_x, 0);
        hyy[i] = whole(1, half_y, 1);
        hzz[i] = whole(2, half_z, 2);
        hyz[i] = whole(1, half_z, 3);
        hzx[i] = whole(2, half_x, 4);
        hxy[i] = whole(0, half_y, 5);
    }
}
for_each_simd!(fn bend(n: usize, jacobian: &[[Lane<f32>; 3]; 3], curvatures: &[[Lane<f32>; 6]; 3], noise: &mut Noise) = bend_body);
