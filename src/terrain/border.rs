//! Border jitter: noise that moves the borders between biomes.
//!
//! Moisture and temperature (or height) choose a point of the biome table. Noise moves that point by a share of a
//! cell, so that neither the table's grid nor a line of equal climate shows on the ground. The periods go from a
//! thousand kilometres on a planet like the Earth down to some ten metres, the finer the weaker: borders wind and
//! fray as coasts do. `border.wgsl` samples the same texture with the same octaves, so that queries and pictures
//! agree.

use crate::planet::Planet;
use glam::{DMat3, DVec3};
use std::sync::OnceLock;

/// Octaves of the noise.
pub(crate) const OCTAVES: usize = 5;
/// Period of the first octave, in planet radii.
const COARSEST: f64 = 1.1;
/// Ratio of frequency and of amplitude from one octave to the next.
const FINER: f64 = 11.0;
pub(crate) const GAIN: f64 = 0.25;
/// Texels along a side of the noise texture.
pub(crate) const TILE_SIDE: usize = 32;
/// Rotation from one octave to the next, so that octaves never repeat together along an axis.
pub(crate) const OCTAVE_TURN: DMat3 =
    DMat3::from_cols(DVec3::new(0.36, -0.8, 0.48), DVec3::new(0.48, 0.6, 0.64), DVec3::new(-0.8, 0.0, 0.6));

/// Period of each octave in metres, coarse to fine.
pub(crate) fn periods_m(radius_m: f64) -> [f64; OCTAVES] {
    // Powers of a small whole number are exact in f64.
    std::array::from_fn(|octave| radius_m * COARSEST / FINER.powi(octave as i32))
}

/// The border jitter of a planet.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Border {
    /// How far borders move, in cells of the biome table.
    jitter: f64,
    radius_m: f64,
    periods_m: [f64; OCTAVES],
}

impl Border {
    pub(crate) fn new(planet: &Planet) -> Self {
        let radius_m = planet.radius_m();
        Self { jitter: planet.biomes.border_jitter, radius_m, periods_m: periods_m(radius_m) }
    }

    /// How far the borders move under a unit direction, in columns and rows.
    pub(crate) fn offset_at(&self, dir_planet: DVec3) -> [f64; 2] {
        if self.jitter > 0.0 { self.offset(dir_planet).map(|offset| offset * self.jitter) } else { [0.0; 2] }
    }

    /// The same for a jitter of 1.
    fn offset(&self, dir_planet: DVec3) -> [f64; 2] {
        let mut sum = [0.0; 2];
        let (mut point_m, mut weight) = (dir_planet * self.radius_m, 1.0);
        for period_m in self.periods_m {
            let noise = tile_at(point_m / period_m);
            sum = [sum[0] + weight * noise[0], sum[1] + weight * noise[1]];
            point_m = OCTAVE_TURN * point_m;
            weight *= GAIN;
        }
        sum
    }
}

/// The noise texture at a point in periods, trilinear between texels as the GPU samples it.
fn tile_at(point: DVec3) -> [f64; 2] {
    let tile = tile();
    let at = (point - point.floor()) * TILE_SIDE as f64 - 0.5;
    let low = at.floor();
    let f = at - low;
    let side = TILE_SIDE as i64;
    let index = |x: i64| x.rem_euclid(side) as usize;
    let mut sum = [0.0; 2];
    for corner in 0..8_i64 {
        let d = [corner & 1, corner >> 1 & 1, corner >> 2];
        let weight = |d: i64, f: f64| if d == 1 { f } else { 1.0 - f };
        let w = weight(d[0], f.x) * weight(d[1], f.y) * weight(d[2], f.z);
        let [x, y, z] = [low.x as i64 + d[0], low.y as i64 + d[1], low.z as i64 + d[2]].map(index);
        let texel = tile[(z * TILE_SIDE + y) * TILE_SIDE + x];
        sum = [sum[0] + w * f64::from(texel[0]), sum[1] + w * f64::from(texel[1])];
    }
    sum
}

/// The noise texture: a cube of smooth noise without a seam, two independent channels of about -0.5 to 0.5 with mean
/// 0; x runs fastest.
pub(crate) fn tile() -> &'static [[f32; 2]] {
    static TILE: OnceLock<Vec<[f32; 2]>> = OnceLock::new();
    TILE.get_or_init(|| {
        let mut texels: Vec<[f32; 2]> = (0..TILE_SIDE.pow(3))
            .map(|i| {
                let at = |n: usize| (n as f32 + 0.5) / TILE_SIDE as f32;
                let place = [at(i % TILE_SIDE), at(i / TILE_SIDE % TILE_SIDE), at(i / TILE_SIDE.pow(2))];
                std::array::from_fn(|channel| {
                    let octave = |cells: u32| value_noise(place, cells, 2 * cells + channel as u32);
                    0.62 * (octave(4) + 0.5 * octave(8) + 0.25 * octave(16))
                })
            })
            .collect();
        for channel in 0..2 {
            let mean = texels.iter().map(|texel| texel[channel]).sum::<f32>() / texels.len() as f32;
            texels.iter_mut().for_each(|texel| texel[channel] -= mean);
        }
        texels
    })
}

/// Smoothly interpolated values of a lattice with a period of `cells`, -1 to 1.
fn value_noise(place: [f32; 3], cells: u32, seed: u32) -> f32 {
    let at = place.map(|x| x * cells as f32);
    let low = at.map(|x| x.floor() as u32);
    let f: [f32; 3] = std::array::from_fn(|i| {
        let f = at[i] - low[i] as f32;
        f * f * f * (f * (f * 6.0 - 15.0) + 10.0)
    });
    let mut sum = 0.0;
    for corner in 0..8_u32 {
        let d = [corner & 1, corner >> 1 & 1, corner >> 2];
        let weight = |i: usize| if d[i] == 1 { f[i] } else { 1.0 - f[i] };
        let lattice = std::array::from_fn::<u32, 3, _>(|i| (low[i] + d[i]) % cells);
        sum += hashed(lattice, seed) * weight(0) * weight(1) * weight(2);
    }
    2.0 * sum - 1.0
}

/// A hash of a lattice point, 0 to 1 (the finaliser of MurmurHash3).
fn hashed([x, y, z]: [u32; 3], seed: u32) -> f32 {
    let mut h = x.wrapping_mul(0x9E37_79B1) ^ y.wrapping_mul(0x85EB_CA77) ^ z.wrapping_mul(0xC2B2_AE3D);
    h = (h ^ seed.wrapping_mul(0x27D4_EB2F)).wrapping_mul(0x85EB_CA6B);
    h = (h ^ (h >> 16)).wrapping_mul(0x85EB_CA6B);
    h = (h ^ (h >> 13)).wrapping_mul(0xC2B2_AE35);
    ((h ^ (h >> 16)) >> 8) as f32 / 16_777_216.0
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::sphere::spread;

    #[test]
    fn the_noise_is_even_and_moves_borders_by_about_half_a_cell() {
        let border = Border::new(&Planet::default());
        let offsets: Vec<[f64; 2]> = spread(4000).map(|dir| border.offset(dir)).collect();
        for axis in 0..2 {
            let mean = offsets.iter().map(|o| o[axis]).sum::<f64>() / offsets.len() as f64;
            let deviation = (offsets.iter().map(|o| o[axis].powi(2)).sum::<f64>() / offsets.len() as f64).sqrt();
            assert!(mean.abs() < 0.05, "{mean}");
            assert!((0.15..0.4).contains(&deviation), "{deviation}");
            assert!(offsets.iter().all(|o| o[axis].abs() < 1.2));
        }
    }
}
