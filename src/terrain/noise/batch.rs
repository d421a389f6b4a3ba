//! One octave of noise at a chunk of points.
//!
//! Two loops: first the lattice in f64 (cell number and fraction of each point), then the noise in f32 and u32. One
//! loop for both takes twice as long, because the widest type in a loop decides how many points the compiler puts
//! into a register.

use super::lattice::Lattice;
use super::{Octave, split, value, value_gradient, value_gradient_curvature};
use crate::simd::{Simd, for_each_simd};
use crate::terrain::lane::{CHUNK, Lane, Points3};
use crate::terrain::scalar::Scalar;

/// The noise of one octave at a chunk of points. Derivatives are by the coordinates of the points, not of the
/// lattice.
pub(crate) struct Noise<S = f32> {
    cell: [Lane<u32>; 3],
    fraction: [Lane<S>; 3],
    pub(crate) value: Lane<S>,
    pub(crate) gradient: [Lane<S>; 3],
    /// Second derivatives xx, yy, zz, yz, zx, xy.
    pub(crate) curvature: [Lane<S>; 6],
    /// For noise in f64.
    lattice: Lattice,
}

impl<S: Scalar> Default for Noise<S> {
    fn default() -> Self {
        let none = [S::default(); CHUNK];
        Self {
            cell: [[0; CHUNK]; 3],
            fraction: [none; 3],
            value: none,
            gradient: [none; 3],
            curvature: [none; 6],
            lattice: Lattice::default(),
        }
    }
}

impl Noise<f64> {
    /// Finds the lattice of a vector noise for [`Noise::vector_gradients`].
    pub(crate) fn find_vector(&mut self, simd: Simd, skewed: Points3<'_>, octave: &Octave) {
        self.lattice.find_vector(simd, skewed, octave);
    }

    /// The gradients of one component of the vector noise.
    pub(crate) fn vector_gradients(&mut self, simd: Simd, n: usize, octave: &Octave, component: usize) {
        self.lattice.gradients(simd, n, octave.frequency, component, &mut self.value, &mut self.gradient);
    }

    /// Values at skewed points.
    pub(crate) fn values(&mut self, simd: Simd, skewed: Points3<'_>, octave: &Octave) {
        self.lattice.find(simd, skewed, octave);
        self.lattice.values(simd, skewed[0].len(), &mut self.value);
    }

    /// Values (the same bits) and gradients.
    pub(crate) fn gradients(&mut self, simd: Simd, skewed: Points3<'_>, octave: &Octave) {
        let Self { value, gradient, lattice, .. } = self;
        lattice.find(simd, skewed, octave);
        lattice.gradients(simd, skewed[0].len(), octave.frequency, 0, value, gradient);
    }
}

impl Noise {
    /// Values at skewed points.
    pub(crate) fn values(&mut self, simd: Simd, skewed: Points3<'_>, octave: &Octave) {
        find_cells(simd, skewed, octave, self);
        fill_values(simd, skewed[0].len(), octave.seed, self);
    }

    /// Values (the same bits) and gradients.
    pub(crate) fn gradients(&mut self, simd: Simd, skewed: Points3<'_>, octave: &Octave) {
        find_cells(simd, skewed, octave, self);
        fill_gradients(simd, skewed[0].len(), octave, self);
    }

    /// Adds the noise in f64 times a weight to a sum.
    pub(crate) fn add_f64(
        &mut self,
        simd: Simd,
        skewed: Points3<'_>,
        octave: &Octave,
        weight: f64,
        sum: &mut Lane<f64>,
    ) {
        self.lattice.find(simd, skewed, octave);
        self.lattice.add(simd, skewed[0].len(), weight, sum);
    }

    /// Gradients in f32 of the noise that [`Noise::add_f64`] evaluated last.
    pub(crate) fn gradients_of_f64(&mut self, simd: Simd, n: usize, octave: &Octave) {
        self.lattice.rounded_gradients(simd, n, octave.frequency, &mut self.gradient);
    }

    /// Adds three noises on the lattice of one octave in f64, times a weight; see
    /// [`lattice::components`](super::lattice::components).
    pub(crate) fn add_f64_vector(
        &mut self,
        simd: Simd,
        skewed: Points3<'_>,
        octave: &Octave,
        weight: f64,
        sums: &mut [Lane<f64>; 3],
    ) {
        self.lattice.find_vector(simd, skewed, octave);
        self.lattice.add_vector(simd, skewed[0].len(), weight, sums);
    }

    /// Values and gradients (the same bits), and second derivatives.
    pub(crate) fn curvatures(&mut self, simd: Simd, skewed: Points3<'_>, octave: &Octave) {
        find_cells(simd, skewed, octave, self);
        fill_curvatures(simd, skewed[0].len(), octave, self);
    }
}

#[inline(always)]
fn find_cells_body(skewed: Points3<'_>, octave: &Octave, noise: &mut Noise) {
    for (axis, p) in skewed.into_iter().enumerate() {
        let (cell, fraction) = (&mut noise.cell[axis], &mut noise.fraction[axis]);
        for ((p, cell), fraction) in p.iter().zip(cell).zip(fraction) {
            (*cell, *fraction) = split(p * octave.frequency + octave.offset[axis]);
        }
    }
}
for_each_simd!(fn find_cells(skewed: Points3<'_>, octave: &Octave, noise: &mut Noise) = find_cells_body);

#[inline(always)]
fn fill_values_body(n: usize, seed: u32, noise: &mut Noise) {
    let Noise { cell: [cx, cy, cz], fraction: [x, y, z], value: v, .. } = noise;
    for i in 0..n.min(CHUNK) {
        v[i] = value([cx[i], cy[i], cz[i]], [x[i], y[i], z[i]], seed);
    }
}
for_each_simd!(fn fill_values(n: usize, seed: u32, noise: &mut Noise) = fill_values_body);

#[inline(always)]
fn fill_gradients_body(n: usize, octave: &Octave, noise: &mut Noise) {
    let (seed, frequency) = (octave.seed, octave.frequency as f32);
    let Noise { cell: [cx, cy, cz], fraction: [x, y, z], value: v, gradient: [gx, gy, gz], .. } = noise;
    for i in 0..n.min(CHUNK) {
        let (value, g) = value_gradient([cx[i], cy[i], cz[i]], [x[i], y[i], z[i]], seed);
        v[i] = value;
        gx[i] = g[0] * frequency;
        gy[i] = g[1] * frequency;
        gz[i] = g[2] * frequency;
    }
}
for_each_simd!(fn fill_gradients(n: usize, octave: &Octave, noise: &mut Noise) = fill_gradients_body);

#[inline(always)]
fn fill_curvatures_body(n: usize, octave: &Octave, noise: &mut Noise) {
    let (seed, frequency) = (octave.seed, octave.frequency as f32);
    let square = frequency * frequency;
    let Noise { cell: [cx, cy, cz], fraction: [x, y, z], value: v, gradient: [gx, gy, gz], curvature, .. } = noise;
    let [hxx, hyy, hzz, hyz, hzx, hxy] = curvature;
    for i in 0..n.min(CHUNK) {
        let (value, g, h) = value_gradient_curvature([cx[i], cy[i], cz[i]], [x[i], y[i], z[i]], seed);
        v[i] = value;
        gx[i] = g[0] * frequency;
        gy[i] = g[1] * frequency;
        gz[i] = g[2] * frequency;
        hxx[i] = h[0] * square;
        hyy[i] = h[1] * square;
        hzz[i] = h[2] * square;
        hyz[i] = h[3] * square;
        hzx[i] = h[4] * square;
        hxy[i] = h[5] * square;
    }
}
for_each_simd!(fn fill_curvatures(n: usize, octave: &Octave, noise: &mut Noise) = fill_curvatures_body);
