//! Valleys: the zero lines of warped noise, made into channels.
//!
//! A point's distance from the line is about `|n| / |grad n|` along the ground; dividing by the gradient keeps the
//! width of a valley constant. Each octave is a finer net of valleys. It fades with distance from the coarser valleys
//! and so looks like their tributaries. Gradients take second derivatives of the noise.

use super::octaves::{Weighted, series};
use super::varying::{Around, Point, Varying};
use super::warp::Warp;
use super::{Arithmetic, Chunk, Evaluate, Scratch, Scratch64};
use crate::planet;
use crate::simd::for_each_simd;
use crate::terrain::field::ALL_OCTAVES;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::Noise;
use glam::DVec3;

/// Greatest total weight of the octaves that are evaluated in f32.
const REST: f64 = 0.02;

/// Points across a valley wall at which it shows in full.
const LEAST_POINTS: f64 = 2.5;

/// Added to the gradient (by the lattice): limits the width of a valley where the noise is level.
const LEAST_GRADIENT: f32 = 0.5;

/// Distances from a valley between which its tributaries fade, in its wavelengths.
const WET: f32 = 0.08;
const DRY: f32 = 0.4;

/// Wavelength and displacement (at `meander` 1) of the meanders in distances between valleys, and their octaves.
const MEANDER_WAVELENGTH: f64 = 0.5;
const MEANDER_REACH: f64 = 0.3;
const MEANDER_OCTAVES: u32 = 2;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Canyons {
    warp: Warp,
    octaves: Vec<Weighted>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
    channel: Channel,
    /// Width of a valley wall in wavelengths.
    wall: f64,
}

/// The cross-section of a valley.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Channel {
    /// Half widths per wavelength.
    narrowness: f32,
    /// Share of the width that is flat.
    floor: f32,
}

impl Canyons {
    pub(super) fn new(params: &planet::Canyons, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Canyons { wavelength_km, octaves, gain, lacunarity, width_km, steepness, meander } = *params;
        let frequency = radius_km / wavelength_km;
        let width = width_km / wavelength_km;
        let reach = MEANDER_REACH * meander / frequency;
        let octaves = series(seed, frequency, octaves, gain, lacunarity);
        Self {
            warp: Warp::new(seed, frequency / MEANDER_WAVELENGTH, MEANDER_OCTAVES, reach),
            f64_octaves: arithmetic.f64_octaves(&octaves, REST),
            octaves,
            channel: Channel { narrowness: (2.0 / width) as f32, floor: steepness as f32 },
            wall: 0.5 * width * (1.0 - steepness),
        }
    }
}

impl Evaluate for Canyons {
    fn octave_count(&self) -> usize {
        self.warp.octave_count() + self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-1.0 - 1e-5, 1e-5)
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let Some(largest) = self.octaves.first() else { return self.bounds() };
        let around = Around::new(dir_planet, angle_rad);
        let (there, jacobian) = self.warp.near(around);
        let [px, py, pz] = Point::new(around).coordinates;
        let one = Varying::constant(around, 1.0);
        let (mut uncut, mut wet, mut carved) = (one, one, Varying::between(around, -1e-5, 1e-5));
        for Weighted { octave, weight } in &self.octaves {
            let (noise, slope) = there.noise_and_slope(octave);
            let by = |axis: usize| {
                slope[0] * jacobian[0][axis] + slope[1] * jacobian[1][axis] + slope[2] * jacobian[2][axis]
            };
            let (x, y, z) = (by(0), by(1), by(2));
            let upward = x * px + y * py + z * pz;
            let along = (x.square() + y.square() + z.square() - upward.square()).at_least(0.0);
            let steepness = along.plus(f64::from(LEAST_GRADIENT * LEAST_GRADIENT));
            let distance = noise.abs() * steepness.recip_sqrt();
            let wall =
                distance.scale(f64::from(self.channel.narrowness)).smoothstep(f64::from(self.channel.floor), 1.0);
            let cut = (one - wall) * wet.scale(f64::from(weight / largest.weight));
            carved = carved + uncut * cut;
            uncut = uncut * (one - cut);
            wet = wet * (one - distance.smoothstep(f64::from(WET), f64::from(DRY)));
        }
        (-carved).range()
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, displaced, jets: [carved, uncut, wet, px, py, pz, ..], in_f64, .. } = scratch;
        let Scratch64 { noise: noise64, jets: [carved64, uncut64, wet64, ex, ey, ez, ..], jacobian, .. } = in_f64;
        let n = chunk.len();
        let Some(largest) = self.octaves.first() else { return };
        chunk.directions([px, py, pz]);
        let dir = [&*px, &*py, &*pz];
        uncut.fill(n, 1.0);
        wet.fill(n, 1.0);
        let fades_of = |octave: &Weighted| chunk.fades(self.wall / octave.octave.frequency, LEAST_POINTS);
        let f64_octaves = chunk.f64_octaves(self.f64_octaves);
        let unseen = fades_of(largest).is_unseen();
        // In f32, distances need the Jacobian of every octave, whatever the bands show.
        let needs_f32 = !unseen || f64_octaves < self.octaves.len();
        let warped = Chunk { spacings_rad: if needs_f32 { ALL_OCTAVES } else { &[] }, ..*chunk };
        self.warp.displace(&warped, !unseen, noise, displaced);
        let there = displaced.points(n);
        if f64_octaves > 0 {
            jacobian.find(&self.warp, chunk, noise64);
        }
        uncut64.fill(n, 1.0);
        wet64.fill(n, 1.0);
        chunk.directions_f64([ex, ey, ez]);
        let dir64 = [&*ex, &*ey, &*ez];
        for (k, weighted) in self.octaves.iter().enumerate() {
            let Weighted { octave, weight } = weighted;
            let (depth, scale) = (weight / largest.weight, (1.0 / octave.frequency) as f32);
            let fades = fades_of(weighted);
            if chunk.skips(&fades) {
                break;
            }
            let is_f64 = k < f64_octaves;
            if is_f64 {
                noise64.gradients(chunk.simd, there, octave);
                jacobian.pull_back(chunk, noise64);
                let state = [&mut *uncut64, &mut *wet64, &mut *carved64];
                carve::<f64>(chunk.simd, n, noise64, scale, depth, self.channel, dir64, state);
                sums.add_f64(chunk, &carved64.value, -1.0);
                if fades.is_unseen() {
                    uncut.round_from(n, uncut64);
                    wet.round_from(n, wet64);
                    continue;
                }
            }
            // Zero lines must be right to a millimetre, though they are hundreds of kilometres apart.
            let mut value = [0.0; CHUNK];
            noise.add_f64(chunk.simd, there, octave, 1.0, &mut value);
            let carve = if fades.is_unseen() {
                noise.gradients(chunk.simd, there, octave);
                carve::<f32>
            } else {
                noise.curvatures(chunk.simd, there, octave);
                carve::<Jet>
            };
            displaced.pull_back_noise(chunk, !fades.is_unseen(), noise);
            for (rounded, value) in noise.value.iter_mut().zip(value).take(n) {
                *rounded = value as f32;
            }
            carve(chunk.simd, n, noise, scale, depth, self.channel, dir, [uncut, wet, carved]);
            if is_f64 {
                sums.add_gradients(chunk, &carved.gradient, -1.0, &fades);
                uncut.round_from(n, uncut64);
                wet.round_from(n, wet64);
            } else {
                sums.add(chunk, &carved.value, &carved.gradient, -1.0, &fades);
            }
        }
    }
}

/// Carves one octave of valleys, at most `depth` deep. `state` is the share of rock that coarser octaves left, the
/// nearness of their valleys, and the depth carved now. `scale` is a lattice cell in radii.
#[inline(always)]
fn carve_body<R: Real>(
    n: usize,
    noise: &Noise<R::S>,
    scale: f32,
    depth: f32,
    channel: Channel,
    dir: [&Jets<R::S>; 3],
    state: [&mut Jets<R::S>; 3],
) {
    let [px, py, pz] = dir;
    let [uncut, wet, carved] = state;
    for i in 0..n.min(CHUNK) {
        let [gx, gy, gz] = R::noise_gradient(noise, i);
        let (x, y, z) = (gx.scale(scale), gy.scale(scale), gz.scale(scale));
        let upward = x * R::load(px, i) + y * R::load(py, i) + z * R::load(pz, i);
        let along = (x.square() + y.square() + z.square() - upward.square()).at_least(0.0);
        let distance = R::noise(noise, i).abs() * along.plus(LEAST_GRADIENT * LEAST_GRADIENT).sqrt().recip();
        let wall = distance.scale(channel.narrowness).smoothstep(channel.floor, 1.0);
        let cut = (R::constant(1.0) - wall) * R::load(wet, i).scale(depth);
        let left = R::load(uncut, i);
        let taken = left * cut;
        taken.store(carved, i);
        (left - taken).store(uncut, i);
        (R::load(wet, i) * (R::constant(1.0) - distance.smoothstep(WET, DRY))).store(wet, i);
    }
}
for_each_simd!(fn carve<R: Real>(n: usize, noise: &Noise<R::S>, scale: f32, depth: f32, channel: Channel, dir: [&Jets<R::S>; 3], state: [&mut Jets<R::S>; 3]) = carve_body);
