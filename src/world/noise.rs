//! Noise for world maps: gradient noise in f64 on a cubic lattice (Perlin 2002), one point at a time.
//!
//! It uses basic operations alone: the same bits on every machine, for one point or for a row of points.

use crate::planet::random::dice::{GOLDEN_BITS, mix_bits};
use crate::simd::{Simd, for_each_simd};
use glam::DVec3;

/// Spreads the bits of a number.
#[inline(always)]
pub(crate) fn scramble(bits: u32) -> u32 {
    let h = (bits ^ (bits >> 16)).wrapping_mul(0x7FEB_352D);
    let h = (h ^ (h >> 15)).wrapping_mul(0x846C_A68B);
    h ^ (h >> 16)
}

/// Mixes the bits of a number: the first number of SplitMix64 from a state.
pub(crate) fn mix(state: u64) -> u64 {
    mix_bits(state.wrapping_add(GOLDEN_BITS))
}

/// A hash of two numbers.
pub(crate) fn hash(a: u32, b: u32) -> u32 {
    scramble(a ^ scramble(b.wrapping_add(0x9E37_79B9)))
}

/// A number from 0 to 1 (exclusive) out of hashed bits.
pub(crate) fn unit(bits: u32) -> f64 {
    f64::from(bits) * (1.0 / 4_294_967_296.0)
}

fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// The values of one octave at a point, for some seeds: the corners of the point's cell side by side, so that the
/// compiler makes vectors of them.
#[inline(always)]
fn octave<const SEEDS: usize>(p: DVec3, seeds: [u32; SEEDS]) -> [f64; SEEDS] {
    // Points are near the lattice's origin, and the shift makes them positive, so that a cast rounds down.
    const SHIFT: f64 = 16_777_216.0;
    let whole = |w: f64| (w + SHIFT) as i64;
    let cell = [whole(p.x), whole(p.y), whole(p.z)];
    let f = p - DVec3::from_array(cell.map(|w| w as f64 - SHIFT));
    let [x, y, z] = cell.map(|w| w as u32);
    let along = |w: u32, by: u32| [w.wrapping_mul(by), w.wrapping_add(1).wrapping_mul(by)];
    let (xs, ys, zs) = (along(x, 0x8DA6_B343), along(y, 0xD816_3841), along(z, 0xCB1A_B31F));
    let corners: [u32; 8] = std::array::from_fn(|k| xs[k & 1] ^ ys[k >> 1 & 1] ^ zs[k >> 2]);
    let offset = |axis: f64, bit: usize| -> [f64; 8] { std::array::from_fn(|k| axis - (k >> bit & 1) as f64) };
    let (dx, dy, dz) = (offset(f.x, 0), offset(f.y, 1), offset(f.z, 2));
    let (u, v, w) = (fade(f.x), fade(f.y), fade(f.z));
    seeds.map(|seed| {
        // The gradient of a corner: one of 4,096 directions of similar length.
        let part = |bits: u32, shift: u32| f64::from((bits >> shift & 0xF) as i32) * (2.0 / 15.0) - 1.0;
        let planes: [f64; 8] = std::array::from_fn(|k| {
            let bits = scramble(corners[k] ^ seed);
            part(bits, 28) * dx[k] + part(bits, 24) * dy[k] + part(bits, 20) * dz[k]
        });
        let lines: [f64; 4] = std::array::from_fn(|k| planes[2 * k] + (planes[2 * k + 1] - planes[2 * k]) * u);
        let [a, b] = [lines[0] + (lines[1] - lines[0]) * v, lines[2] + (lines[3] - lines[2]) * v];
        (a + (b - a) * w) * 1.2
    })
}

/// Sums of octaves for some seeds.
#[inline(always)]
fn octaves<const SEEDS: usize>(p: DVec3, shape: [f64; 2], count: u32, seeds: [u32; SEEDS], out: &mut [f64; SEEDS]) {
    let (mut amplitude, [mut frequency, gain]) = (1.0, shape);
    *out = [0.0; SEEDS];
    for k in 0..count {
        let shift = f64::from(k) * 17.17 + 5.3;
        let values = octave(p * frequency + shift, seeds.map(|seed| seed.wrapping_add(k.wrapping_mul(0x9E37_79B1))));
        for (sum, value) in out.iter_mut().zip(values) {
            *sum += amplitude * value;
        }
        amplitude *= gain;
        frequency *= 2.03;
    }
}

/// Points that are evaluated side by side.
const LANES: usize = 8;

/// [`octave`] of one seed at some points side by side, to the bit.
#[inline(always)]
fn octave_lanes(p: &[[f64; LANES]; 3], seed: u32) -> [f64; LANES] {
    const SHIFT: f64 = 16_777_216.0;
    let whole = p.map(|axis| axis.map(|w| (w + SHIFT) as i32));
    let near: [[f64; LANES]; 3] =
        std::array::from_fn(|axis| std::array::from_fn(|l| p[axis][l] - (f64::from(whole[axis][l]) - SHIFT)));
    let by = [0x8DA6_B343_u32, 0xD816_3841, 0xCB1A_B31F];
    let side =
        |axis: usize, bit: usize| whole[axis].map(|w| (w as u32).wrapping_add(bit as u32).wrapping_mul(by[axis]));
    let sides: [[[u32; LANES]; 2]; 3] = std::array::from_fn(|axis| [side(axis, 0), side(axis, 1)]);
    let fades = near.map(|axis| axis.map(fade));
    let mut planes = [[0.0; LANES]; 8];
    for (k, plane) in planes.iter_mut().enumerate() {
        let bit = [k & 1, k >> 1 & 1, k >> 2];
        for (l, plane) in plane.iter_mut().enumerate() {
            let bits = scramble(sides[0][bit[0]][l] ^ sides[1][bit[1]][l] ^ sides[2][bit[2]][l] ^ seed);
            let part = |shift: u32| f64::from((bits >> shift & 0xF) as i32) * (2.0 / 15.0) - 1.0;
            let away = |axis: usize| near[axis][l] - bit[axis] as f64;
            *plane = part(28) * away(0) + part(24) * away(1) + part(20) * away(2);
        }
    }
    std::array::from_fn(|l| {
        let line = |k: usize| planes[2 * k][l] + (planes[2 * k + 1][l] - planes[2 * k][l]) * fades[0][l];
        let (a, b) = (line(0) + (line(1) - line(0)) * fades[1][l], line(2) + (line(3) - line(2)) * fades[1][l]);
        (a + (b - a) * fades[2][l]) * 1.2
    })
}

/// [`octaves`] of one seed at a row of points.
#[inline(always)]
fn row(points: &[DVec3], shape: [f64; 2], count: u32, seed: u32, out: &mut [f64]) {
    for (points, out) in points.chunks(LANES).zip(out.chunks_mut(LANES)) {
        let at = |l: usize| points[l.min(points.len() - 1)];
        let p: [[f64; LANES]; 3] =
            [std::array::from_fn(|l| at(l).x), std::array::from_fn(|l| at(l).y), std::array::from_fn(|l| at(l).z)];
        let (mut amplitude, [mut frequency, gain], mut sums) = (1.0, shape, [0.0; LANES]);
        for k in 0..count {
            let shift = f64::from(k) * 17.17 + 5.3;
            let scaled = p.map(|axis| axis.map(|w| w * frequency + shift));
            let values = octave_lanes(&scaled, seed.wrapping_add(k.wrapping_mul(0x9E37_79B1)));
            for (sum, value) in sums.iter_mut().zip(values) {
                *sum += amplitude * value;
            }
            amplitude *= gain;
            frequency *= 2.03;
        }
        out.copy_from_slice(&sums[..out.len()]);
    }
}

#[inline(always)]
fn one(p: DVec3, seed: u32, out: &mut f64) {
    [*out] = octave(p, [seed]);
}

for_each_simd!(fn one_simd(p: DVec3, seed: u32, out: &mut f64) = one);
for_each_simd!(fn fbm_simd(
    p: DVec3, shape: [f64; 2], count: u32, seeds: [u32; 1], out: &mut [f64; 1]
) = octaves::<1>);
for_each_simd!(fn fbm3_simd(
    p: DVec3, shape: [f64; 2], count: u32, seeds: [u32; 3], out: &mut [f64; 3]
) = octaves::<3>);

for_each_simd!(fn row_simd(points: &[DVec3], shape: [f64; 2], count: u32, seed: u32, out: &mut [f64]) = row);

/// [`fbm`] at each point of a row, several times as fast.
pub(crate) fn fbm_row(points: &[DVec3], frequency: f64, octaves: u32, gain: f64, seed: u32) -> Vec<f64> {
    let mut out = vec![0.0; points.len()];
    row_simd(Simd::detect(), points, [frequency, gain], octaves, seed, &mut out);
    out
}

/// [`fbm3`] at each point of a row.
pub(crate) fn fbm3_row(points: &[DVec3], frequency: f64, octaves: u32, gain: f64, seed: u32) -> Vec<DVec3> {
    let [x, y, z] = [0, 1, 2].map(|axis| fbm_row(points, frequency, octaves, gain, hash(seed, axis)));
    (0..points.len()).map(|i| DVec3::new(x[i], y[i], z[i])).collect()
}

/// One octave, -1 to 1 with a standard deviation of about 0.33.
pub(crate) fn noise(p: DVec3, seed: u32) -> f64 {
    let mut out = 0.0;
    one_simd(Simd::detect(), p, seed, &mut out);
    out
}

/// A sum of octaves: wavelengths fall by 2.03 from `1 / frequency`, amplitudes by `gain` from 1.
pub(crate) fn fbm(p: DVec3, frequency: f64, octaves: u32, gain: f64, seed: u32) -> f64 {
    let mut out = [0.0];
    fbm_simd(Simd::detect(), p, [frequency, gain], octaves, [seed], &mut out);
    out[0]
}

/// A sum of octaves of a vector.
pub(crate) fn fbm3(p: DVec3, frequency: f64, octaves: u32, gain: f64, seed: u32) -> DVec3 {
    let mut out = [0.0; 3];
    let seeds = [0, 1, 2].map(|axis| hash(seed, axis));
    fbm3_simd(Simd::detect(), p, [frequency, gain], octaves, seeds, &mut out);
    DVec3::from_array(out)
}

/// 0 at `from` and below, 1 at `to` and above, smooth between. `from` may be the greater one.
pub(crate) fn ramp(from: f64, to: f64, x: f64) -> f64 {
    let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
    t * t * (3.0 - 2.0 * t)
}

/// A bump: 1 at `middle`, 0 from `width` away, smooth.
pub(crate) fn bump(middle: f64, width: f64, x: f64) -> f64 {
    let t = ((x - middle) / width).abs().min(1.0);
    let t = 1.0 - t * t;
    t * t
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn noise_is_continuous_bounded_and_balanced() {
        let (mut sum, mut square, mut most) = (0.0, 0.0, 0.0_f64);
        let count = 20_000;
        for (i, dir) in crate::sphere::spread(count).enumerate() {
            let value = noise(dir * 9.7, 5);
            let near = noise(dir * 9.7 + 1e-6, 5);
            assert!((value - near).abs() < 1e-4, "{i}: {value} {near}");
            sum += value;
            square += value * value;
            most = most.max(value.abs());
        }
        let deviation = (square / count as f64).sqrt();
        assert!(
            (sum / count as f64).abs() < 0.02 && (0.2..0.5).contains(&deviation) && most <= 1.3,
            "{deviation} {most}"
        );
    }

    #[test]
    fn a_row_has_the_bits_of_its_points() {
        let points: Vec<DVec3> = crate::sphere::spread(101).map(|dir| dir * 3.7).collect();
        let one: Vec<f64> = points.iter().map(|p| fbm(*p, 2.1, 4, 0.55, 9)).collect();
        for simd in Simd::available() {
            let mut row = vec![0.0; points.len()];
            row_simd(simd, &points, [2.1, 0.55], 4, 9, &mut row);
            assert_eq!(row, one, "{simd:?}");
        }
        let one: Vec<DVec3> = points.iter().map(|p| fbm3(*p, 1.4, 3, 0.5, 9)).collect();
        assert_eq!(fbm3_row(&points, 1.4, 3, 0.5, 9), one);
    }

    #[test]
    fn ramps_and_bumps_end_where_they_say() {
        assert_eq!([ramp(1.0, 3.0, 0.0), ramp(1.0, 3.0, 2.0), ramp(3.0, 1.0, 0.0)], [0.0, 0.5, 1.0]);
        assert_eq!([bump(2.0, 1.0, 2.0), bump(2.0, 1.0, 3.5)], [1.0, 0.0]);
    }
}
