//! Valleys: the zero lines of warped noise, made into channels.
//!
//! A point's distance from the line is about `|n| / |grad n|`, along the ground; dividing by the gradient is what keeps
//! the width the same everywhere. Each octave is a finer net of valleys, which runs dry with distance from the coarser
//! ones, so that it reads as their tributaries. Where the gradient is wanted too, second derivatives make it exact.

use super::octaves::{Weighted, series};
use super::warp::{ExactJacobian, Warp};
use super::{Arithmetic, Chunk, Evaluate, Scratch, Wide, place, place_exact};
use crate::planet;
use crate::terrain::field::EXACT;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::noise::{self, CHUNK, Noise, precise};
use crate::terrain::simd::for_each_simd;
use glam::DVec3;

/// Weight of the octaves that f32 is enough for.
const REST: f64 = 0.02;

/// Points across a valley's wall from which on it shows in full.
const LEAST_POINTS: f64 = 2.5;

/// Added to the gradient (by the lattice), so that a valley widens no further than this where the noise is level.
const LEAST_GRADIENT: f32 = 0.5;

/// Tributaries run dry between these distances from the valley they lead to, in its wavelengths.
const WET: f32 = 0.08;
const DRY: f32 = 0.4;

/// The meanders' wavelength and displacement (at `meander` 1) against the distance between
/// valleys; octaves of meanders.
const MEANDER_WAVELENGTH: f64 = 0.5;
const MEANDER_REACH: f64 = 0.3;
const MEANDER_OCTAVES: u32 = 2;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Canyons {
    warp: Warp,
    octaves: Vec<Weighted>,
    /// So many of them are found in f64.
    exact: usize,
    channel: Channel,
    /// Width of a valley's wall against the wavelength.
    wall: f64,
}

/// The form of a valley.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Channel {
    /// Half widths to a wavelength.
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
            exact: arithmetic.exact_of(&octaves, REST),
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
        let (there, distance) = self.warp.reach_near(dir_planet, angle_rad);
        let stretch = distance / angle_rad.max(1e-12);
        let step = |x: f64, from: f32, to: f32| {
            let (from, to) = (f64::from(from), f64::from(to));
            let t = ((x - from) / (to - from)).clamp(0.0, 1.0);
            t * t * (3.0 - 2.0 * t)
        };
        let (mut uncut, mut wet, mut carved) = ((1.0, 1.0), (1.0, 1.0), (0.0, 0.0));
        for Weighted { octave, weight } in &self.octaves {
            let depth = f64::from(weight / largest.weight);
            let (low, high) = noise::range_near(there, octave, distance);
            let (_, gradient, off) = noise::slope_near(there, octave, distance);
            let steepest = (gradient.length() + off).min(noise::SLOPE_BOUND) * stretch;
            let least = f64::from(LEAST_GRADIENT);
            let away = (low.max(-high).max(0.0) / steepest.hypot(least), high.max(-low) / least);
            let wall = |away: f64| step(away * f64::from(self.channel.narrowness), self.channel.floor, 1.0);
            let cut = ((1.0 - wall(away.1)) * wet.0 * depth, (1.0 - wall(away.0)) * wet.1 * depth);
            carved = (carved.0 + uncut.0 * cut.0, carved.1 + uncut.1 * cut.1);
            uncut = (uncut.0 * (1.0 - cut.1).max(0.0), uncut.1 * (1.0 - cut.0));
            wet = (wet.0 * (1.0 - step(away.1, WET, DRY)), wet.1 * (1.0 - step(away.0, WET, DRY)));
        }
        (-carved.1 - 1e-5, -carved.0 + 1e-5)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, displaced, jets: [carved, uncut, wet, px, py, pz, ..], wide } = scratch;
        let Wide { noise: exact_noise, jets: [exact_carved, exact_uncut, exact_wet, ex, ey, ez, ..] } = wide;
        let n = chunk.len();
        let Some(largest) = self.octaves.first() else { return };
        place(chunk, [px, py, pz]);
        let dir = [&*px, &*py, &*pz];
        uncut.fill(n, 1.0);
        wet.fill(n, 1.0);
        let fades_of = |octave: &Weighted| chunk.fades(self.wall / octave.octave.frequency, LEAST_POINTS);
        // The distance needs the gradient, whether or not its own is seen.
        let exact = Chunk { spacings_rad: EXACT, ..*chunk };
        self.warp.displace(&exact, !fades_of(largest).is_unseen(), noise, displaced);
        let there = displaced.points(n);
        let exact = chunk.exact(self.exact);
        let jacobian = (exact > 0).then(|| ExactJacobian::new(&self.warp, chunk, exact_noise));
        exact_uncut.fill(n, 1.0);
        exact_wet.fill(n, 1.0);
        place_exact(chunk, [ex, ey, ez]);
        let exact_dir = [&*ex, &*ey, &*ez];
        for (k, weighted) in self.octaves.iter().enumerate() {
            let Weighted { octave, weight } = weighted;
            let (depth, scale) = (weight / largest.weight, (1.0 / octave.frequency) as f32);
            let fades = fades_of(weighted);
            if chunk.skips(&fades) {
                break;
            }
            let jacobian = jacobian.as_ref().filter(|_| k < exact);
            if let Some(jacobian) = jacobian {
                exact_noise.gradients(chunk.simd, there, octave);
                jacobian.pull_back(chunk, exact_noise);
                let state = [&mut *exact_uncut, &mut *exact_wet, &mut *exact_carved];
                carve_exact(chunk.simd, n, exact_noise, scale, depth, self.channel, exact_dir, state);
                sums.add_exact(chunk, &exact_carved.value, -1.0);
                if fades.is_unseen() {
                    uncut.round_from(n, exact_uncut);
                    wet.round_from(n, exact_wet);
                    continue;
                }
            }
            // Lines must lie where they are to the millimetre, though they are hundreds of kilometres apart.
            let mut value = [0.0; CHUNK];
            precise::add(chunk.simd, there, octave, 1.0, &mut value);
            if fades.is_unseen() {
                noise.gradients(chunk.simd, there, octave);
                displaced.pull_back_noise(chunk, false, noise);
                noise.value = value.map(|v| v as f32);
                carve_values(chunk.simd, n, noise, scale, depth, self.channel, dir, [uncut, wet, carved]);
            } else {
                noise.curvatures(chunk.simd, there, octave);
                displaced.pull_back_noise(chunk, true, noise);
                noise.value = value.map(|v| v as f32);
                carve_gradients(chunk.simd, n, noise, scale, depth, self.channel, dir, [uncut, wet, carved]);
            }
            if jacobian.is_some() {
                sums.add_gradients(chunk, &carved.gradient, -1.0, &fades);
                uncut.round_from(n, exact_uncut);
                wet.round_from(n, exact_wet);
            } else {
                sums.add(chunk, &carved.value, &carved.gradient, -1.0, &fades);
            }
        }
    }
}

/// Carves an octave of valleys, at most `depth` deep, out of what coarser ones have left: `uncut`, the share of the
/// rock; `wet`, how near they are. `scale` is the octave's cell in radii.
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
for_each_simd!(fn carve_values(n: usize, noise: &Noise, scale: f32, depth: f32, channel: Channel, dir: [&Jets; 3], state: [&mut Jets; 3]) = carve_body::<f32>);
for_each_simd!(fn carve_exact(n: usize, noise: &Noise<f64>, scale: f32, depth: f32, channel: Channel, dir: [&Jets<f64>; 3], state: [&mut Jets<f64>; 3]) = carve_body::<f64>);
for_each_simd!(fn carve_gradients(n: usize, noise: &Noise, scale: f32, depth: f32, channel: Channel, dir: [&Jets; 3], state: [&mut Jets; 3]) = carve_body::<Jet>);
