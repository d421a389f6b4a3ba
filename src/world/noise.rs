//! Noise for world maps: gradient noise in f64 on a cubic lattice (Perlin 2002), one point at a time.
//!
//! World maps evaluate it at a few hundred thousand points, so it is plain code. It uses basic operations alone: the
//! same bits on every machine.

use glam::DVec3;

/// Spreads the bits of a number.
pub(crate) fn scramble(bits: u32) -> u32 {
    let h = (bits ^ (bits >> 16)).wrapping_mul(0x7FEB_352D);
    let h = (h ^ (h >> 15)).wrapping_mul(0x846C_A68B);
    h ^ (h >> 16)
}

/// A hash of two numbers.
pub(crate) fn hash(a: u32, b: u32) -> u32 {
    scramble(a ^ scramble(b.wrapping_add(0x9E37_79B9)))
}

/// A number from 0 to 1 (exclusive) out of hashed bits.
pub(crate) fn unit(bits: u32) -> f64 {
    f64::from(bits) * (1.0 / 4_294_967_296.0)
}

/// The gradient of a lattice point: one of 4,096 directions of similar length.
fn gradient(bits: u32) -> DVec3 {
    let part = |shift: u32| f64::from((bits >> shift) & 0xF) * (2.0 / 15.0) - 1.0;
    DVec3::new(part(28), part(24), part(20))
}

fn fade(t: f64) -> f64 {
    t * t * t * (t * (t * 6.0 - 15.0) + 10.0)
}

/// One octave, -1 to 1 with a standard deviation of about 0.33.
pub(crate) fn noise(p: DVec3, seed: u32) -> f64 {
    // Points are near the lattice's origin, and the shift makes them positive, so that a cast rounds down.
    const SHIFT: f64 = 16_777_216.0;
    let whole = |w: f64| (w + SHIFT) as i64;
    let cell = [whole(p.x), whole(p.y), whole(p.z)];
    let f = DVec3::new(p.x, p.y, p.z) - DVec3::from_array(cell.map(|w| w as f64 - SHIFT));
    let [x, y, z] = cell.map(|w| w as u32);
    let plane = |dx: u32, dy: u32, dz: u32| {
        let h = x.wrapping_add(dx).wrapping_mul(0x8DA6_B343)
            ^ y.wrapping_add(dy).wrapping_mul(0xD816_3841)
            ^ z.wrapping_add(dz).wrapping_mul(0xCB1A_B31F);
        let corner = DVec3::new(f64::from(dx), f64::from(dy), f64::from(dz));
        gradient(scramble(h ^ seed)).dot(f - corner)
    };
    let (u, v, w) = (fade(f.x), fade(f.y), fade(f.z));
    let line = |dy: u32, dz: u32| {
        let (a, b) = (plane(0, dy, dz), plane(1, dy, dz));
        a + (b - a) * u
    };
    let face = |dz: u32| {
        let (a, b) = (line(0, dz), line(1, dz));
        a + (b - a) * v
    };
    let (a, b) = (face(0), face(1));
    (a + (b - a) * w) * 1.2
}

/// A sum of octaves: wavelengths fall by 2.03 from `1 / frequency`, amplitudes by `gain` from 1.
pub(crate) fn fbm(p: DVec3, frequency: f64, octaves: u32, gain: f64, seed: u32) -> f64 {
    let (mut sum, mut amplitude, mut frequency) = (0.0, 1.0, frequency);
    for octave in 0..octaves {
        let shift = f64::from(octave) * 17.17 + 5.3;
        sum += amplitude * noise(p * frequency + shift, seed.wrapping_add(octave.wrapping_mul(0x9E37_79B1)));
        amplitude *= gain;
        frequency *= 2.03;
    }
    sum
}

/// A sum of octaves of a vector.
pub(crate) fn fbm3(p: DVec3, frequency: f64, octaves: u32, gain: f64, seed: u32) -> DVec3 {
    let part = |axis: u32| fbm(p, frequency, octaves, gain, hash(seed, axis));
    DVec3::new(part(0), part(1), part(2))
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
    fn ramps_and_bumps_end_where_they_say() {
        assert_eq!([ramp(1.0, 3.0, 0.0), ramp(1.0, 3.0, 2.0), ramp(3.0, 1.0, 0.0)], [0.0, 0.5, 1.0]);
        assert_eq!([bump(2.0, 1.0, 2.0), bump(2.0, 1.0, 3.5)], [1.0, 0.0]);
    }
}
