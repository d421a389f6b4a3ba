//! The noise of one octave in f64, values alone, for where the rounding of f32 would show: displacements of hundreds of
//! kilometres, distances to a zero line.
//!
//! It is the same function as the f32 kernel's, up to rounding, whose gradients therefore belong to it too. Several
//! noises on one lattice share its corners and differ by the hash of their gradients.

use super::batch::{CHUNK, Lane, Points3};
use super::{Octave, PRIME, ROUNDER, SCALE, scramble};
use crate::terrain::simd::{Simd, for_each_simd};

/// Adds to `sum` the noise of an octave at skewed points, times a weight.
pub(crate) fn add(simd: Simd, skewed: Points3<'_>, octave: &Octave, weight: f64, sum: &mut Lane<f64>) {
    add_one(simd, skewed, octave, weight, sum);
}

/// Adds to `sums` three noises on the lattice of an octave at skewed points, times a weight; see [`components`].
pub(crate) fn add_vector(simd: Simd, skewed: Points3<'_>, octave: &Octave, weight: f64, sums: &mut [Lane<f64>; 3]) {
    add_three(simd, skewed, octave, components(octave).map(|octave| octave.seed), weight, sums);
}

/// The three noises of a vector noise.
pub(crate) fn components(octave: &Octave) -> [Octave; 3] {
    let [x, y] = [octave.seed, scramble(octave.seed)];
    [x, y, scramble(y)].map(|seed| Octave { seed, ..*octave })
}

#[inline(always)]
fn add_body(skewed: Points3<'_>, octave: &Octave, weight: f64, sum: &mut Lane<f64>) {
    let [x, y, z] = skewed;
    let scale = weight * f64::from(SCALE);
    for i in 0..x.len().min(y.len()).min(z.len()).min(CHUNK) {
        let corners = corners([x[i], y[i], z[i]], octave);
        sum[i] += unscaled(&corners, octave.seed) * scale;
    }
}
for_each_simd!(fn add_one(skewed: Points3<'_>, octave: &Octave, weight: f64, sum: &mut Lane<f64>) = add_body);

#[inline(always)]
fn add_vector_body(skewed: Points3<'_>, octave: &Octave, seeds: [u32; 3], weight: f64, sums: &mut [Lane<f64>; 3]) {
    let ([x, y, z], [sum_x, sum_y, sum_z]) = (skewed, sums);
    let scale = weight * f64::from(SCALE);
    for i in 0..x.len().min(y.len()).min(z.len()).min(CHUNK) {
        let corners = corners([x[i], y[i], z[i]], octave);
        sum_x[i] += unscaled(&corners, seeds[0]) * scale;
        sum_y[i] += unscaled(&corners, seeds[1]) * scale;
        sum_z[i] += unscaled(&corners, seeds[2]) * scale;
    }
}
for_each_simd!(fn add_three(skewed: Points3<'_>, octave: &Octave, seeds: [u32; 3], weight: f64, sums: &mut [Lane<f64>; 3]) = add_vector_body);

/// Cell number and position within the cell, 0 to 1.
#[inline(always)]
fn split(q: f64) -> (u32, f64) {
    let rounded = (q - 0.5) + ROUNDER;
    (rounded.to_bits() as u32, q - (rounded - ROUNDER))
}

/// The four corners of the simplex around a skewed point: distances times weights, hashes of the cells. See
/// `corners` of the f32 kernel.
#[inline(always)]
fn corners(p: [f64; 3], octave: &Octave) -> [([f64; 3], u32); 4] {
    let (ix, x) = split(p[0] * octave.frequency + octave.offset[0]);
    let (iy, y) = split(p[1] * octave.frequency + octave.offset[1]);
    let (iz, z) = split(p[2] * octave.frequency + octave.offset[2]);
    let t = (x + y + z) * (1.0 / 6.0);
    let d0 = [x - t, y - t, z - t];
    let (xy, yz, zx) = (x >= y, y >= z, z > x);
    let first = [xy & !zx, yz & !xy, zx & !yz];
    let second = [xy | !zx, yz | !xy, zx | !yz];
    let step = |on: bool| if on { 1.0 } else { 0.0 };
    let away = |o: [bool; 3], unskew: f64| {
        [d0[0] - step(o[0]) + unskew, d0[1] - step(o[1]) + unskew, d0[2] - step(o[2]) + unskew]
    };
    let weighted = |d: [f64; 3]| {
        let w = (0.5 - (d[0] * d[0] + d[1] * d[1] + d[2] * d[2])).max(0.0);
        let w2 = w * w;
        let w4 = w2 * w2;
        [d[0] * w4, d[1] * w4, d[2] * w4]
    };
    let base = [ix.wrapping_mul(PRIME[0]), iy.wrapping_mul(PRIME[1]), iz.wrapping_mul(PRIME[2])];
    let next = [base[0].wrapping_add(PRIME[0]), base[1].wrapping_add(PRIME[1]), base[2].wrapping_add(PRIME[2])];
    let pick = |on: bool, axis: usize| if on { next[axis] } else { base[axis] };
    let hash = |o: [bool; 3]| pick(o[0], 0) ^ pick(o[1], 1) ^ pick(o[2], 2);
    [
        (weighted(d0), base[0] ^ base[1] ^ base[2]),
        (weighted(away(first, 1.0 / 6.0)), hash(first)),
        (weighted(away(second, 1.0 / 3.0)), hash(second)),
        (weighted([d0[0] - 0.5, d0[1] - 0.5, d0[2] - 0.5]), next[0] ^ next[1] ^ next[2]),
    ]
}

/// The sum of the corners' contributions.
#[inline(always)]
fn unscaled(corners: &[([f64; 3], u32); 4], seed: u32) -> f64 {
    let corner = |k: usize| {
        let (d, hash) = corners[k];
        let h = scramble(hash ^ seed);
        let component = |bits: u32| f64::from((bits as i32 >> 22) | 1);
        component(h) * d[0] + component(h << 10) * d[1] + component(h << 20) * d[2]
    };
    corner(0) + corner(1) + (corner(2) + corner(3))
}

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
        let mut sums = [[1.0; CHUNK]; 3];
        add_vector(Simd::detect(), skewed, &octave, 2.0, &mut sums);
        let mut noise = <Noise>::default();
        for (octave, sum) in components(&octave).iter().zip(&sums) {
            noise.values(Simd::detect(), skewed, octave);
            for (value, sum) in noise.value.iter().zip(sum) {
                assert!((1.0 + 2.0 * f64::from(*value) - sum).abs() < 2e-6);
            }
        }
        for simd in Simd::available() {
            let mut same = [[1.0; CHUNK]; 3];
            add_vector(simd, skewed, &octave, 2.0, &mut same);
            assert_eq!(same, sums, "{}", simd.name());
        }
        let mut first = [1.0; CHUNK];
        add(Simd::detect(), skewed, &octave, 2.0, &mut first);
        assert_eq!(first, sums[0]);
    }
}
