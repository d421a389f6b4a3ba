//! One octave of noise in f64, for values in which the rounding of f32 would show: the strongest octaves,
//! displacements of hundreds of kilometres, distances to a zero line.
//!
//! Up to rounding it is the same function as the f32 kernel's, so that the gradients of that kernel belong to it too.
//! There are three loops: the lattice in f64, the hashes of the corners in u32, the noise in f64; one loop would take
//! nearly twice as long (see [`super::batch`]). One lattice serves values, gradients and other noises on the same
//! lattice, which differ by their hashes.

use super::{Octave, PRIME, SCALE, dot, falloff, gradient, scramble, split};
use crate::simd::{Simd, for_each_simd};
use crate::terrain::lane::{CHUNK, Lane, Points3};
use crate::terrain::scalar::Scalar;

/// The three components of a vector noise.
pub(crate) fn components(octave: &Octave) -> [Octave; 3] {
    let [x, y] = [octave.seed, scramble(octave.seed)];
    [x, y, scramble(y)].map(|seed| Octave { seed, ..*octave })
}

/// The lattice around a chunk of points.
pub(super) struct Lattice {
    cell: [Lane<u32>; 3],
    fraction: [Lane<f64>; 3],
    /// The tetrahedron of the cell: whether x >= y, y >= z, z > x, from the lowest bit on.
    order: Lane<u32>,
    /// Hashes of the four corners of the tetrahedron, for up to three noises.
    hashes: [Hashes; 3],
}

type Hashes = [Lane<u32>; 4];

impl Default for Lattice {
    fn default() -> Self {
        let none = [0; CHUNK];
        Self { cell: [none; 3], fraction: [[0.0; CHUNK]; 3], order: none, hashes: [[none; 4]; 3] }
    }
}

impl Lattice {
    /// Finds the lattice of an octave at skewed points.
    pub(super) fn find(&mut self, simd: Simd, skewed: Points3<'_>, octave: &Octave) {
        find_lattice(simd, skewed, octave, self);
        hash_corners(simd, skewed[0].len(), octave.seed, 0, self);
    }

    /// Finds the lattice of a vector noise.
    pub(super) fn find_vector(&mut self, simd: Simd, skewed: Points3<'_>, octave: &Octave) {
        find_lattice(simd, skewed, octave, self);
        for (k, octave) in components(octave).iter().enumerate() {
            hash_corners(simd, skewed[0].len(), octave.seed, k, self);
        }
    }

    /// Adds the noise times a weight to a sum.
    pub(super) fn add(&self, simd: Simd, n: usize, weight: f64, sum: &mut Lane<f64>) {
        add_one(simd, n, self, weight, sum);
    }

    /// Adds the vector noise times a weight to sums.
    pub(super) fn add_vector(&self, simd: Simd, n: usize, weight: f64, sums: &mut [Lane<f64>; 3]) {
        add_three(simd, n, self, weight, sums);
    }

    /// Values.
    pub(super) fn values(&self, simd: Simd, n: usize, value: &mut Lane<f64>) {
        fill_values(simd, n, self, value);
    }

    /// Values (the same bits) and gradients of one component of a vector noise.
    pub(super) fn gradients(
        &self,
        simd: Simd,
        n: usize,
        frequency: f64,
        component: usize,
        value: &mut Lane<f64>,
        gradient: &mut [Lane<f64>; 3],
    ) {
        fill_gradients(simd, n, self, frequency, component, value, gradient);
    }

    /// Gradients in f32.
    pub(super) fn rounded_gradients(&self, simd: Simd, n: usize, frequency: f64, gradient: &mut [Lane<f32>; 3]) {
        fill_rounded_gradients(simd, n, self, frequency as f32, gradient);
    }
}

#[inline(always)]
fn find_body(skewed: Points3<'_>, octave: &Octave, lattice: &mut Lattice) {
    for (axis, p) in skewed.into_iter().enumerate() {
        let (cell, fraction) = (&mut lattice.cell[axis], &mut lattice.fraction[axis]);
        for ((p, cell), fraction) in p.iter().zip(cell).zip(fraction) {
            (*cell, *fraction) = split(p * octave.frequency + octave.offset[axis]);
        }
    }
    let Lattice { fraction: [x, y, z], order, .. } = lattice;
    for i in 0..skewed[0].len().min(CHUNK) {
        order[i] = u32::from(x[i] >= y[i]) | u32::from(y[i] >= z[i]) << 1 | u32::from(z[i] > x[i]) << 2;
    }
}
for_each_simd!(fn find_lattice(skewed: Points3<'_>, octave: &Octave, lattice: &mut Lattice) = find_body);

/// The second and third corner of a tetrahedron: the axes along which they lie in the next cell.
#[inline(always)]
fn steps([xy, yz, zx]: [bool; 3]) -> [[bool; 3]; 2] {
    [[xy & !zx, yz & !xy, zx & !yz], [xy | !zx, yz | !xy, zx | !yz]]
}

#[inline(always)]
fn hash_body(n: usize, seed: u32, k: usize, lattice: &mut Lattice) {
    let Lattice { cell: [cx, cy, cz], order, hashes, .. } = lattice;
    let [h0, h1, h2, h3] = &mut hashes[k];
    for i in 0..n.min(CHUNK) {
        let [first, second] = steps([1, 2, 4].map(|bit| order[i] & bit != 0));
        let base = [cx[i].wrapping_mul(PRIME[0]), cy[i].wrapping_mul(PRIME[1]), cz[i].wrapping_mul(PRIME[2])];
        let next = [base[0].wrapping_add(PRIME[0]), base[1].wrapping_add(PRIME[1]), base[2].wrapping_add(PRIME[2])];
        let pick = |on: bool, axis: usize| if on { next[axis] } else { base[axis] };
        let hash = |o: [bool; 3]| pick(o[0], 0) ^ pick(o[1], 1) ^ pick(o[2], 2);
        h0[i] = scramble(base[0] ^ base[1] ^ base[2] ^ seed);
        h1[i] = scramble(hash(first) ^ seed);
        h2[i] = scramble(hash(second) ^ seed);
        h3[i] = scramble(next[0] ^ next[1] ^ next[2] ^ seed);
    }
}
for_each_simd!(fn hash_corners(n: usize, seed: u32, k: usize, lattice: &mut Lattice) = hash_body);

/// The vectors from the four corners to a point.
#[inline(always)]
fn ways<S: Scalar>([x, y, z]: [S; 3], order: [bool; 3]) -> [[S; 3]; 4] {
    let (half, third, sixth) = (S::of(0.5), S::of(1.0 / 3.0), S::of(1.0 / 6.0));
    let t = (x + y + z) * sixth;
    let d0 = [x - t, y - t, z - t];
    let [first, second] = steps(order);
    let further = [d0[0] - S::of(1.0), d0[1] - S::of(1.0), d0[2] - S::of(1.0)];
    let away = |o: [bool; 3], unskew: S| [0, 1, 2].map(|a| (if o[a] { further[a] } else { d0[a] }) + unskew);
    [d0, away(first, sixth), away(second, third), [d0[0] - half, d0[1] - half, d0[2] - half]]
}

/// The vectors from the four corners to the `i`th point in f64, which compares its coordinates again.
#[inline(always)]
fn ways_f64(lattice: &Lattice, i: usize) -> [[f64; 3]; 4] {
    let [x, y, z] = &lattice.fraction;
    let (x, y, z) = (x[i], y[i], z[i]);
    ways([x, y, z], [x >= y, y >= z, z > x])
}

/// The sum of the contributions of the corners, from vectors that are weighted already.
#[inline(always)]
fn unscaled(weighted: &[[f64; 3]; 4], hashes: &Hashes, i: usize) -> f64 {
    let corner = |k: usize| dot(gradient(hashes[k][i]), weighted[k]);
    corner(0) + corner(1) + (corner(2) + corner(3))
}

#[inline(always)]
fn weighted(d: [f64; 3]) -> [f64; 3] {
    let w = falloff(d);
    let w2 = w * w;
    let w4 = w2 * w2;
    [d[0] * w4, d[1] * w4, d[2] * w4]
}

#[inline(always)]
fn add_body(n: usize, lattice: &Lattice, weight: f64, sum: &mut Lane<f64>) {
    let scale = weight * f64::from(SCALE);
    for (i, sum) in sum.iter_mut().enumerate().take(n) {
        let ways = ways_f64(lattice, i).map(weighted);
        *sum += unscaled(&ways, &lattice.hashes[0], i) * scale;
    }
}
for_each_simd!(fn add_one(n: usize, lattice: &Lattice, weight: f64, sum: &mut Lane<f64>) = add_body);

#[inline(always)]
fn add_vector_body(n: usize, lattice: &Lattice, weight: f64, sums: &mut [Lane<f64>; 3]) {
    let ([x, y, z], [hx, hy, hz]) = (sums, &lattice.hashes);
    let scale = weight * f64::from(SCALE);
    for i in 0..n.min(CHUNK) {
        let ways = ways_f64(lattice, i).map(weighted);
        x[i] += unscaled(&ways, hx, i) * scale;
        y[i] += unscaled(&ways, hy, i) * scale;
        z[i] += unscaled(&ways, hz, i) * scale;
    }
}
for_each_simd!(fn add_three(n: usize, lattice: &Lattice, weight: f64, sums: &mut [Lane<f64>; 3]) = add_vector_body);

#[inline(always)]
fn fill_values_body(n: usize, lattice: &Lattice, value: &mut Lane<f64>) {
    for (i, value) in value.iter_mut().enumerate().take(n) {
        *value = unscaled(&ways_f64(lattice, i).map(weighted), &lattice.hashes[0], i) * f64::from(SCALE);
    }
}
for_each_simd!(fn fill_values(n: usize, lattice: &Lattice, value: &mut Lane<f64>) = fill_values_body);

/// The gradient of a corner's contribution by the lattice: d/dp of w^4 (g.d) = w^4 g - 8 w^3 (g.d) d.
#[inline(always)]
fn corner_gradient<S: Scalar>(d: [S; 3], g: [S; 3]) -> [S; 3] {
    let w = falloff(d);
    let w2 = w * w;
    let w4 = w2 * w2;
    let pull = w2 * w * dot(g, d) * S::of(8.0);
    [w4 * g[0] - pull * d[0], w4 * g[1] - pull * d[1], w4 * g[2] - pull * d[2]]
}

#[inline(always)]
fn gradient_at<S: Scalar>(ways: [[S; 3]; 4], hashes: &Hashes, i: usize, frequency: S) -> [S; 3] {
    let corner = |k: usize| corner_gradient(ways[k], gradient(hashes[k][i]));
    let (a, b, c, d) = (corner(0), corner(1), corner(2), corner(3));
    let sum = |axis: usize| ((a[axis] + b[axis]) + (c[axis] + d[axis])) * S::from_f32(SCALE) * frequency;
    [sum(0), sum(1), sum(2)]
}

#[inline(always)]
fn fill_gradients_body(
    n: usize,
    lattice: &Lattice,
    frequency: f64,
    component: usize,
    value: &mut Lane<f64>,
    [gx, gy, gz]: &mut [Lane<f64>; 3],
) {
    let hashes = &lattice.hashes[component];
    for i in 0..n.min(CHUNK) {
        let ways = ways_f64(lattice, i);
        value[i] = unscaled(&ways.map(weighted), hashes, i) * f64::from(SCALE);
        [gx[i], gy[i], gz[i]] = gradient_at(ways, hashes, i, frequency);
    }
}
for_each_simd!(fn fill_gradients(n: usize, lattice: &Lattice, frequency: f64, component: usize, value: &mut Lane<f64>, gradient: &mut [Lane<f64>; 3]) = fill_gradients_body);

#[inline(always)]
fn fill_rounded_gradients_body(n: usize, lattice: &Lattice, frequency: f32, [gx, gy, gz]: &mut [Lane<f32>; 3]) {
    let mut fraction = [[0.0; CHUNK]; 3];
    for (rounded, fraction) in fraction.iter_mut().zip(&lattice.fraction) {
        for (rounded, fraction) in rounded.iter_mut().zip(fraction).take(n) {
            *rounded = *fraction as f32;
        }
    }
    let ([x, y, z], Lattice { order, hashes, .. }) = (&fraction, lattice);
    for i in 0..n.min(CHUNK) {
        let ways = ways([x[i], y[i], z[i]], [1, 2, 4].map(|bit| order[i] & bit != 0));
        [gx[i], gy[i], gz[i]] = gradient_at(ways, &hashes[0], i, frequency);
    }
}
for_each_simd!(fn fill_rounded_gradients(n: usize, lattice: &Lattice, frequency: f32, gradient: &mut [Lane<f32>; 3]) = fill_rounded_gradients_body);

#[cfg(test)]
mod tests {
    use super::super::{Noise, skew};
    use super::*;

    #[test]
    fn the_same_function_as_in_f32() {
        let octave = Octave { frequency: 7.3, offset: [0.3, 17.7, -4.1], seed: 77 };
        let points: Vec<[f64; 3]> =
            (0..CHUNK).map(|i| skew([0.013 * i as f64 - 1.7, 0.007 * i as f64, 0.5 - 0.011 * i as f64])).collect();
        let axis = |axis: usize| points.iter().map(|p| p[axis]).collect::<Vec<f64>>();
        let (x, y, z) = (axis(0), axis(1), axis(2));
        let skewed: Points3<'_> = [&x, &y, &z];
        let (mut noise, mut wide) = (<Noise>::default(), Noise::<f64>::default());
        let mut sums = [[1.0; CHUNK]; 3];
        noise.add_f64_vector(Simd::detect(), skewed, &octave, 2.0, &mut sums);
        for (octave, sum) in components(&octave).iter().zip(&sums) {
            noise.gradients(Simd::detect(), skewed, octave);
            wide.gradients(Simd::detect(), skewed, octave);
            let (value, gradient) = (noise.value, noise.gradient);
            noise.add_f64(Simd::detect(), skewed, octave, 1.0, &mut [0.0; CHUNK]);
            noise.gradients_of_f64(Simd::detect(), CHUNK, octave);
            for i in 0..CHUNK {
                assert!((1.0 + 2.0 * f64::from(value[i]) - sum[i]).abs() < 2e-6);
                assert!((1.0 + 2.0 * wide.value[i] - sum[i]).abs() < 1e-14);
                for ((plain, exact), wide) in gradient.iter().zip(&noise.gradient).zip(&wide.gradient) {
                    assert!((plain[i] - exact[i]).abs() < 2e-5);
                    assert!((f64::from(plain[i]) - wide[i]).abs() < 2e-5);
                }
            }
            wide.values(Simd::detect(), skewed, octave);
            assert!(wide.value.iter().zip(sum).all(|(v, sum)| (1.0 + 2.0 * v - sum).abs() < 1e-14));
        }
        for simd in Simd::available() {
            let mut same = [[1.0; CHUNK]; 3];
            noise.add_f64_vector(simd, skewed, &octave, 2.0, &mut same);
            assert_eq!(same, sums, "{}", simd.name());
        }
        let mut first = [1.0; CHUNK];
        noise.add_f64(Simd::detect(), skewed, &octave, 2.0, &mut first);
        assert_eq!(first, sums[0]);
    }
}
