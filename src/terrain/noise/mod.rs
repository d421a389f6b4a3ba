//! Gradient noise: the arithmetic below every landform.
//!
//! 3D simplex noise (Perlin 2001, in Gustavson's formulation) with two changes for speed and for planets of true
//! size:
//!
//! - The skew onto the simplex grid is linear, so a point is skewed once ([`skew`]) and each octave only scales it.
//!   Cell and fraction are found in f64, whose rounding on the Earth is below a micrometre; the fraction goes on in
//!   f32. The noise at a point does not depend on which tile asks.
//! - Gradients are three signed 10-bit numbers of an integer hash, uniform in a cube: no table, no preferred axes.
//!
//! The code is branch-free and uses only operations that IEEE 754 rounds correctly, never a fused multiply-add. So
//! the loops over points ([`batch`]) have the same bits for every instruction set (see [`super::simd`]).

mod batch;
pub(crate) mod lattice;
mod near;

use super::scalar::Scalar;
pub(crate) use batch::Noise;
pub(crate) use near::{Nearby, SLOPE_BOUND, near};

/// Bound of `|noise|`: the greatest contributions of the four corners add up to 1.448.
pub(crate) const BOUND: f64 = 1.45;

/// Scales the sum of the corners to a standard deviation of about 0.33.
const SCALE: f32 = 90.0 / 512.0 / GRADIENT_UNIT;

/// The unit of a gradient component. A power of two, so that it changes no bits of the noise.
const GRADIENT_UNIT: f32 = (1 << 22) as f32;

/// Adding and subtracting this rounds an f64 below 2^51 to a whole number and leaves that number in the low bits.
const ROUNDER: f64 = 6_755_399_441_055_744.0;

/// One octave of noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Octave {
    /// Lattice cells per unit of the point's coordinates.
    pub(crate) frequency: f64,
    /// Shift of the lattice in skewed coordinates, so that octaves have no common centre.
    pub(crate) offset: [f64; 3],
    /// Hash seed.
    pub(crate) seed: u32,
}

/// Skews a point onto the simplex grid: adds a third of the sum of its coordinates to each.
#[inline(always)]
pub(crate) fn skew(p: [f64; 3]) -> [f64; 3] {
    let s = (p[0] + p[1] + p[2]) * (1.0 / 3.0);
    [p[0] + s, p[1] + s, p[2] + s]
}

/// Cell number and fraction within the cell, 0 to 1.
#[inline(always)]
pub(crate) fn split<S: Scalar>(q: f64) -> (u32, S) {
    let rounded = (q - 0.5) + ROUNDER;
    (rounded.to_bits() as u32, S::of(q - (rounded - ROUNDER)))
}

/// Large odd numbers that spread cell numbers over the bits of the hash.
const PRIME: [u32; 3] = [0x8DA6_B343, 0xD816_3841, 0xCB1A_B31F];

/// Spreads the bits of a number.
#[inline(always)]
pub(crate) fn scramble(bits: u32) -> u32 {
    let h = bits.wrapping_mul(0x9E37_79B1);
    (h ^ (h >> 15)).wrapping_mul(0x85EB_CA77)
}

/// Random bits of a lattice cell.
#[inline(always)]
pub(crate) fn cell_hash(cell: [u32; 3], seed: u32) -> u32 {
    let spread = |axis: usize| cell[axis].wrapping_mul(PRIME[axis]);
    let h = scramble(spread(0) ^ spread(1) ^ spread(2) ^ seed);
    h ^ (h >> 16)
}

/// The gradient of a corner from its hash: three odd whole numbers from -511 to 511, in units of [`GRADIENT_UNIT`].
///
/// Each takes ten bits, the lowest of which counts as set. The highest ten bits are read in place as an integer. The
/// others are read in place as the mantissa of a float whose exponent makes their lowest bit one unit; the float's
/// implicit 1 and half the range are then subtracted. Shifts would cost more, because the compiler turns them into
/// multiplications.
#[inline(always)]
fn gradient<S: Scalar>(hash: u32) -> [S; 3] {
    let odd = |lowest: u32| 1 << lowest;
    let others = |lowest: u32| 0x3FE << lowest;
    let in_mantissa = |lowest: u32| {
        // The unit is 2^22, and the bit before the mantissa counts 2^(23 - lowest) of it; signs are two's complement.
        let one = f32::from_bits((127 + 22 + 23 - lowest) << 23);
        let number = (hash & others(lowest)) ^ (one.to_bits() | odd(lowest) | 0x200 << lowest);
        S::from_f32(f32::from_bits(number) - (one + 512.0 * GRADIENT_UNIT))
    };
    [S::from_i32((hash & others(22) | odd(22)) as i32), in_mantissa(12), in_mantissa(2)]
}

/// The weight of a corner before it is raised to the fourth power, from the vector to the point.
#[inline(always)]
fn falloff<S: Scalar>(d: [S; 3]) -> S {
    (S::of(0.5) - (d[0] * d[0] + d[1] * d[1] + d[2] * d[2])).max(S::of(0.0))
}

/// The four corners of the simplex around a point of a cell: vectors to the point, and gradients.
#[inline(always)]
fn corners<S: Scalar>([ix, iy, iz]: [u32; 3], [x, y, z]: [S; 3], seed: u32) -> ([[S; 3]; 4], [[S; 3]; 4]) {
    let (half, third, sixth) = (S::of(0.5), S::of(1.0 / 3.0), S::of(1.0 / 6.0));
    let t = (x + y + z) * sixth;
    let d0 = [x - t, y - t, z - t];
    // The order of x, y and z tells the tetrahedron of the cell.
    let (xy, yz, zx) = (x >= y, y >= z, z > x);
    let first = [xy & !zx, yz & !xy, zx & !yz];
    let second = [xy | !zx, yz | !xy, zx | !yz];
    let further = [d0[0] - S::of(1.0), d0[1] - S::of(1.0), d0[2] - S::of(1.0)];
    let away = |o: [bool; 3], unskew: S| [0, 1, 2].map(|a| (if o[a] { further[a] } else { d0[a] }) + unskew);
    let d1 = away(first, sixth);
    let d2 = away(second, third);
    let d3 = [d0[0] - half, d0[1] - half, d0[2] - half];

    let base = [ix.wrapping_mul(PRIME[0]), iy.wrapping_mul(PRIME[1]), iz.wrapping_mul(PRIME[2])];
    let next = [base[0].wrapping_add(PRIME[0]), base[1].wrapping_add(PRIME[1]), base[2].wrapping_add(PRIME[2])];
    let pick = |on: bool, axis: usize| if on { next[axis] } else { base[axis] };
    let at = |o: [bool; 3]| gradient(scramble(pick(o[0], 0) ^ pick(o[1], 1) ^ pick(o[2], 2) ^ seed));
    let g0 = gradient(scramble(base[0] ^ base[1] ^ base[2] ^ seed));
    let g3 = gradient(scramble(next[0] ^ next[1] ^ next[2] ^ seed));
    ([d0, d1, d2, d3], [g0, at(first), at(second), g3])
}

#[inline(always)]
fn dot<S: Scalar>(a: [S; 3], b: [S; 3]) -> S {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// The noise at a point of a cell of the skewed lattice, about -1 to 1.
#[inline(always)]
pub(crate) fn value<S: Scalar>(cell: [u32; 3], fraction: [S; 3], seed: u32) -> S {
    let (d, g) = corners(cell, fraction, seed);
    let corner = |i: usize| {
        let w = falloff(d[i]);
        let w2 = w * w;
        w2 * w2 * dot(g[i], d[i])
    };
    (corner(0) + corner(1) + (corner(2) + corner(3))) * S::from_f32(SCALE)
}

/// The noise (the same bits as [`value`]) and its gradient by the unskewed lattice coordinates.
#[inline(always)]
pub(crate) fn value_gradient<S: Scalar>(cell: [u32; 3], fraction: [S; 3], seed: u32) -> (S, [S; 3]) {
    let (d, g) = corners(cell, fraction, seed);
    let corner = |i: usize| {
        let w = falloff(d[i]);
        let (w2, slope) = (w * w, dot(g[i], d[i]));
        let w4 = w2 * w2;
        // d/dp of w^4 (g.d) = w^4 g - 8 w^3 (g.d) d
        let pull = w2 * w * slope * S::of(8.0);
        let grad = [w4 * g[i][0] - pull * d[i][0], w4 * g[i][1] - pull * d[i][1], w4 * g[i][2] - pull * d[i][2]];
        (w4 * slope, grad)
    };
    let ((v0, g0), (v1, g1), (v2, g2), (v3, g3)) = (corner(0), corner(1), corner(2), corner(3));
    let scale = S::from_f32(SCALE);
    let sum = |axis: usize| ((g0[axis] + g1[axis]) + (g2[axis] + g3[axis])) * scale;
    ((v0 + v1 + (v2 + v3)) * scale, [sum(0), sum(1), sum(2)])
}

/// The noise, its gradient (the same bits as [`value_gradient`]) and its second derivatives xx, yy, zz, yz, zx, xy by
/// the unskewed lattice coordinates.
#[inline(always)]
pub(crate) fn value_gradient_curvature<S: Scalar>(cell: [u32; 3], fraction: [S; 3], seed: u32) -> (S, [S; 3], [S; 6]) {
    let (v, g) = value_gradient(cell, fraction, seed);
    let (d, corner_gradients) = corners(cell, fraction, seed);
    let corner = |i: usize| {
        let (d, g) = (d[i], corner_gradients[i]);
        let w = falloff(d);
        let (w2, slope) = (w * w, dot(g, d));
        // d/dp of w^4 g - 8 w^3 (g.d) d = -8 w^3 (g d' + d g' + (g.d) 1) + 48 w^2 (g.d) d d'
        let (cubic, square) = (w2 * w * S::of(-8.0), w2 * slope * S::of(48.0));
        let same = |a: usize| cubic * (S::of(2.0) * g[a] * d[a] + slope) + square * (d[a] * d[a]);
        let cross = |a: usize, b: usize| cubic * (g[a] * d[b] + g[b] * d[a]) + square * (d[a] * d[b]);
        [same(0), same(1), same(2), cross(1, 2), cross(2, 0), cross(0, 1)]
    };
    let (c0, c1, c2, c3) = (corner(0), corner(1), corner(2), corner(3));
    let sum = |k: usize| ((c0[k] + c1[k]) + (c2[k] + c3[k])) * S::from_f32(SCALE);
    (v, g, [sum(0), sum(1), sum(2), sum(3), sum(4), sum(5)])
}

#[cfg(test)]
mod tests {
    use super::near::{CURVATURE_BOUND, TWIST_BOUND};
    use super::*;
    use crate::world::noise::mix;
    use proptest::prelude::*;

    /// Cell and fraction of a point on a shifted lattice.
    fn place(point: [f64; 3]) -> ([u32; 3], [f32; 3]) {
        let (skewed, offset) = (skew(point), [0.3, 17.7, -4.1]);
        let [(ix, x), (iy, y), (iz, z)] = [0, 1, 2].map(|axis| split(skewed[axis] + offset[axis]));
        ([ix, iy, iz], [x, y, z])
    }

    fn with_seed<T>(point: [f64; 3], seed: u32, noise: impl Fn([u32; 3], [f32; 3], u32) -> T) -> T {
        let (cell, fraction) = place(point);
        noise(cell, fraction, seed)
    }

    proptest! {
        #[test]
        fn derivatives_match_central_differences(x in -40.0..40.0_f64, y in -40.0..40.0_f64, z in -40.0..40.0_f64) {
            let at = |p: [f64; 3]| with_seed(p, 77, value_gradient);
            let (v, g, h) = with_seed([x, y, z], 77, value_gradient_curvature);
            prop_assert_eq!((v, g), at([x, y, z]));
            prop_assert_eq!(v, with_seed([x, y, z], 77, value));
            let step = 1e-3;
            let second = [[h[0], h[5], h[4]], [h[5], h[1], h[3]], [h[4], h[3], h[2]]];
            for axis in 0..3 {
                let (mut lo, mut hi) = ([x, y, z], [x, y, z]);
                lo[axis] -= step;
                hi[axis] += step;
                let difference = |hi: f32, lo: f32| f64::from(hi - lo) / (2.0 * step);
                let d = difference(at(hi).0, at(lo).0);
                prop_assert!((d - f64::from(g[axis])).abs() < 2e-3, "{} {}", d, g[axis]);
                for (other, second) in second[axis].into_iter().enumerate() {
                    let d = difference(at(hi).1[other], at(lo).1[other]);
                    prop_assert!((d - f64::from(second)).abs() < 2e-2, "{} {}", d, second);
                }
            }
        }

        #[test]
        fn never_beyond_its_bound(x in -1e9..1e9_f64, y in -1e9..1e9_f64, z in -1e9..1e9_f64, seed: u32) {
            prop_assert!(f64::from(with_seed([x, y, z], seed, value).abs()) <= BOUND);
        }
    }

    #[test]
    fn gradients_are_three_odd_numbers_of_ten_bits() {
        for state in 0..100_000 {
            let hash = mix(state) as u32;
            let component = |bits: u32| f64::from((bits as i32 >> 22) | 1) * f64::from(GRADIENT_UNIT);
            assert_eq!(gradient::<f64>(hash), [hash, hash << 10, hash << 20].map(component));
        }
    }

    #[test]
    fn mean_and_spread_are_as_promised() {
        let n = 200_000;
        let values: Vec<f64> = (0..n)
            .map(|i| {
                let r = |k: u64| (mix(i * 3 + k) >> 11) as f64 / (1_u64 << 53) as f64 * 1000.0;
                f64::from(with_seed([r(0), r(1), r(2)], 77, value))
            })
            .collect();
        let mean = values.iter().sum::<f64>() / n as f64;
        let deviation = (values.iter().map(|v| (v - mean) * (v - mean)).sum::<f64>() / n as f64).sqrt();
        assert!(mean.abs() < 0.005, "mean {mean}");
        assert!((0.31..0.35).contains(&deviation), "deviation {deviation}");
    }

    /// How alike the noise of two points is depends on their distance, not on the direction between them: no lattice
    /// shows.
    #[test]
    fn no_direction_is_preferred() {
        let n = 60_000;
        let random = |i: u64, k: u64| (mix(i * 3 + k) >> 11) as f64 / (1_u64 << 53) as f64 * 1000.0;
        let directions = (-1..=1)
            .flat_map(|x| (-1..=1).flat_map(move |y| (-1..=1).map(move |z| [x, y, z])))
            .filter(|d| *d > [0, 0, 0]);
        for distance in [0.3, 0.6, 0.9] {
            let likeness: Vec<f64> = directions
                .clone()
                .map(|d| {
                    let step = distance / f64::from(d.iter().map(|w| w * w).sum::<i32>()).sqrt();
                    let pairs = (0..n).map(|i| {
                        let p = [0, 1, 2].map(|k| random(i, k));
                        let q = [0, 1, 2].map(|k| p[k] + step * f64::from(d[k]));
                        f64::from(with_seed(p, 77, value)) * f64::from(with_seed(q, 77, value))
                    });
                    pairs.sum::<f64>() / n as f64 / (0.33 * 0.33)
                })
                .collect();
            let mean = likeness.iter().sum::<f64>() / likeness.len() as f64;
            assert_eq!(likeness.len(), 13);
            for one in &likeness {
                assert!((one - mean).abs() < 0.08, "at {distance}: {likeness:.3?}");
            }
        }
    }

    /// The greatest sum of corners, over a grid of points in a simplex.
    #[test]
    fn bounds_hold_with_the_worst_of_gradients() {
        let longest = 511.0 * 3.0_f64.sqrt() * f64::from(GRADIENT_UNIT) * f64::from(SCALE);
        let (mut value, mut slope, mut curvature, mut twist) = (0.0_f64, 0.0_f64, 0.0_f64, 0.0_f64);
        let n = 80;
        for (i, j, k) in (0..=n).flat_map(|i| (0..=i).flat_map(move |j| (0..=j).map(move |k| (i, j, k)))) {
            let (d, _) = corners([0; 3], [i, j, k].map(|w| w as f32 / n as f32), 0);
            let sum = |of: &dyn Fn(f64, f64) -> f64| {
                d.iter()
                    .map(|d| {
                        let square = f64::from(dot(*d, *d));
                        of(square.sqrt(), f64::from(falloff(*d)))
                    })
                    .sum::<f64>()
                    * longest
            };
            value = value.max(sum(&|r, w| w.powi(4) * r));
            slope = slope.max(sum(&|r, w| w.powi(4).max((w.powi(4) - 8.0 * w.powi(3) * r * r).abs())));
            curvature = curvature.max(sum(&|r, w| {
                let across = 8.0 * w.powi(3) * r;
                let along = (r * w * w * (24.0 * w - 48.0 * r * r)).abs().max(across);
                along.hypot(across)
            }));
            // Along a unit step u with a = d.u: (144 a w^2 - 192 a^3 w) (g.d) + 3 (48 a^2 w^2 - 8 w^3) (g.u).
            twist = twist.max(sum(&|r, w| {
                let of = |a: f64| {
                    let (p, q) = (144.0 * a * w * w - 192.0 * a.powi(3) * w, 144.0 * a * a * w * w - 24.0 * w.powi(3));
                    (p * p * r * r + 2.0 * p * q * a + q * q).max(0.0).sqrt()
                };
                (0..=16).map(|k| of(r * f64::from(k) / 16.0)).fold(0.0, f64::max)
            }));
        }
        for (found, bound) in [(value, BOUND), (slope, SLOPE_BOUND), (curvature, CURVATURE_BOUND), (twist, TWIST_BOUND)]
        {
            assert!(found <= bound && found > 0.95 * bound, "{found} {bound}");
        }
    }
}
