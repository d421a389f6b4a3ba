//! Gullies: mountains carved by running water, evaluated at each point by itself, after the gradient-aligned waves of
//! Clay John (2020) and Rune Skovbo Johansen (2025).
//!
//! Smooth noise gets gullies that run down its slope. In each of the jittered cells around a point stands a wave
//! whose crests follow the slope; the waves sum to a phasor (see `dunes`), and the cosine of its phase is the height
//! of the gullies. Each finer octave follows the slope of the noise together with the gullies before it, so that
//! gullies branch. Level ground gets none: summits keep the height of a ridge and valley floors that of a bed, and
//! each octave leaves the ridges and beds of the coarser ones free.
//!
//! Gradients take second derivatives of the noise, which tell how the waves turn from point to point.

use super::fbm::LEAST_POINTS;
use super::octaves::{Weighted, series};
use super::places::{CORNERS, Places, neighbour, unit};
use super::scratch::{Carving, Folded};
use super::varying::{Around, Point};
use super::{Arithmetic, Chunk, Evaluate, Scratch, Scratch64};
use crate::planet;
use crate::simd::for_each_simd;
use crate::terrain::approx;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::{self, Noise, Octave};
use crate::terrain::scalar::Scalar;
use crate::world::noise::mix;
use std::f32::consts::TAU;

/// Greatest total weight of the noise octaves, and greatest total height of the gullies, that are evaluated in f32.
const REST: f64 = 0.09;
/// Gullies per cell.
const WAVES: f32 = 1.0;
/// Reach of a wave, in cells.
const REACH: f32 = 0.8;
/// Greatest distance of a wave's centre from the centre of its cell along each axis, in cells. REACH + JITTER <= 1.
const JITTER: f32 = 0.2;
/// The squared phasor below which gullies fade; where all waves agree it is about 0.4.
const FAINT: f32 = 0.02;
/// Depth of a gully per width at depth 1, in noise heights per wavelength.
const STEEPNESS: f64 = 0.4;
/// The slope at which ground has half its gullies, in noise heights per wavelength.
const FLAT: f32 = 0.35;
/// Least ratio of the wavelength of a noise octave to that of the gullies for it to lead them: gullies cannot follow
/// a slope that turns within their width.
const COARSER: f64 = 2.5;
/// Weight of gullies in the slope that leads the next octave: less keeps finer gullies straighter.
const BRANCH: f32 = 0.6;
/// Roundness of the crests: the square of half the height that is taken off them.
const ROUND: f32 = 0.004;
/// How quickly the next octave sets in beside a crest or bed of the one before.
const CLEAR: f32 = 0.05;
/// The height of the noise, up and down, that counts as summit and valley floor.
const SUMMIT: f32 = 0.6;
/// Points per gully at which it shows in full.
const LEAST_GULLY_POINTS: f64 = 3.0;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Gullies {
    octaves: Vec<Weighted>,
    /// How many noise octaves, the coarsest, lead the gullies.
    leading: usize,
    gullies: Vec<Carved>,
    /// How many octaves of the noise, and how many of the gullies, are evaluated in f64.
    f64_octaves: [usize; 2],
    /// Cells of the coarsest noise octave per planet radius.
    frequency: f64,
}

/// An octave of gullies.
#[derive(Clone, Debug, PartialEq)]
struct Carved {
    lattices: [Octave; 2],
    /// Height of its ridges above the mean.
    height: f32,
    /// The steepest slope of its flanks, in noise heights per wavelength.
    slope: f32,
}

impl Gullies {
    pub(super) fn new(params: &planet::Gullies, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Gullies { wavelength_km, octaves, gain, lacunarity, gully_km, gully_octaves, depth } = *params;
        let frequency = radius_km / wavelength_km;
        let octaves = series(seed, frequency, octaves, gain, lacunarity);
        let waves = series(mix(!seed), radius_km / gully_km, gully_octaves, gain, lacunarity);
        let coarsest = waves.first().map_or(1.0, |wave| f64::from(wave.weight));
        let gullies: Vec<Carved> = waves
            .iter()
            .map(|Weighted { octave, weight }| {
                let height = depth * STEEPNESS * gully_km / wavelength_km * f64::from(*weight) / coarsest;
                let lattice = |shift: f64, salt: u32| Octave {
                    frequency: octave.frequency / f64::from(WAVES),
                    offset: octave.offset.map(|offset| offset + shift),
                    seed: noise::scramble(octave.seed.wrapping_add(salt)),
                };
                Carved {
                    lattices: [lattice(0.0, 1), lattice(0.5, 2)],
                    height: height as f32,
                    slope: (height * octave.frequency / frequency) as f32 * TAU,
                }
            })
            .collect();
        let leading = octaves.iter().filter(|w| COARSER * w.octave.frequency * gully_km < radius_km).count().max(1);
        // Gullies depend on one another and on the noise that leads them.
        let in_f64 = arithmetic.f64_count(gullies.iter().map(|gully| gully.height), REST);
        let noise_in_f64 = arithmetic.f64_octaves(&octaves, REST);
        let f64_octaves = [if in_f64 > 0 { noise_in_f64.max(leading) } else { noise_in_f64 }, in_f64];
        Self { octaves, leading, gullies, f64_octaves, frequency }
    }
}

impl Evaluate for Gullies {
    fn octave_count(&self) -> usize {
        self.octaves.len() + self.gullies.len()
    }

    fn bounds(&self) -> (f64, f64) {
        let bound = noise::BOUND + self.gullies.iter().map(|gully| f64::from(gully.height)).sum::<f64>();
        (-bound, bound)
    }

    /// The gullies may be anywhere in their range; only the noise has tighter bounds nearby.
    fn bounds_around(&self, around: Around) -> (f64, f64) {
        let (low, high) = Point::new(around).sum(&self.octaves).range();
        let carved = self.gullies.iter().map(|gully| f64::from(gully.height)).sum::<f64>() * (1.0 + 1e-5);
        (low - carved, high + carved)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        self.add_with(chunk, None, scratch);
    }

    /// Folds displace the base alone: gullies run down its slopes, whatever steers those.
    fn add_folded(&self, chunk: &Chunk<'_>, folded: &Folded, scratch: &mut Scratch) {
        self.add_with(chunk, Some(folded), scratch);
    }
}

impl Gullies {
    fn add_with(&self, chunk: &Chunk<'_>, folded: Option<&Folded>, scratch: &mut Scratch) {
        let Scratch { sums, noise, places, carving, in_f64, .. } = scratch;
        let Scratch64 { noise: noise64, places: places64, carving: carving64, .. } = in_f64;
        let [noise_in_f64, gullies_in_f64] = self.f64_octaves.map(|octaves| chunk.f64_octaves(octaves));
        let (simd, n) = (chunk.simd, chunk.len());
        let skewed = folded.map_or(chunk.skewed, |folded| folded.displaced.points(n));
        let fades_of = |octave: &Octave| chunk.fades(1.0 / octave.frequency, LEAST_GULLY_POINTS * f64::from(WAVES));
        let shaded = self.gullies.first().is_some_and(|gully| !fades_of(&gully.lattices[0]).is_unseen());
        // Gullies in f64 hand their state to the first in f32. Without gradients nothing reads the f32 state before.
        let leads = shaded || gullies_in_f64 == 0;
        carving.restart(n);
        carving64.restart(n);
        for (i, Weighted { octave, weight }) in self.octaves.iter().enumerate() {
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            let is_leading = i < self.leading;
            if !is_leading && chunk.skips(&fades) {
                break;
            }
            let per_cell = *weight / self.frequency as f32;
            let is_f64 = i < noise_in_f64;
            if is_f64 {
                noise64.gradients(simd, skewed, octave);
                if let Some(folded) = folded {
                    folded.jacobian.pull_back(chunk, noise64);
                }
                if is_leading {
                    lead::<f64>(simd, n, noise64, *weight, per_cell, carving64);
                }
                sums.add_f64(chunk, &noise64.value, f64::from(*weight));
                if fades.is_unseen() && !(is_leading && leads) {
                    continue;
                }
            }
            let is_curved = is_leading && shaded;
            match is_curved {
                true => noise.curvatures(simd, skewed, octave),
                false if !is_leading && fades.is_unseen() => noise.values(simd, skewed, octave),
                false => noise.gradients(simd, skewed, octave),
            }
            if let Some(folded) = folded {
                folded.displaced.pull_back_noise(chunk, is_curved, noise);
            }
            match is_leading {
                true if shaded => lead::<Jet>(simd, n, noise, *weight, per_cell, carving),
                true => lead::<f32>(simd, n, noise, *weight, per_cell, carving),
                false => {}
            }
            if is_f64 {
                sums.add_gradients(chunk, &noise.gradient, *weight, &fades);
            } else {
                sums.add(chunk, &noise.value, &noise.gradient, *weight, &fades);
            }
        }
        if shaded {
            settle::<Jet>(simd, n, carving);
        } else {
            settle::<f32>(simd, n, carving);
        }
        settle::<f64>(simd, n, carving64);
        for (k, gully) in self.gullies.iter().enumerate() {
            let fades = fades_of(&gully.lattices[0]);
            if chunk.skips(&fades) {
                break;
            }
            let unseen = fades.is_unseen();
            let evaluate = if unseen { Carved::evaluate::<f32> } else { Carved::evaluate::<Jet> };
            if k < gullies_in_f64 {
                gully.evaluate::<f64>(chunk, places64, carving64);
                sums.add_f64(chunk, &carving64.gully.value, f64::from(gully.height));
                if !unseen {
                    evaluate(gully, chunk, places, carving);
                    sums.add_gradients(chunk, &carving.gully.gradient, gully.height, &fades);
                }
                carving.round_from(n, carving64);
                continue;
            }
            evaluate(gully, chunk, places, carving);
            sums.add(chunk, &carving.gully.value, &carving.gully.gradient, gully.height, &fades);
        }
    }
}

impl Carved {
    /// Carves one octave of gullies.
    fn evaluate<R: Real>(&self, chunk: &Chunk<'_>, places: &mut Places<R::S>, work: &mut Carving<R::S>) {
        let (simd, n) = (chunk.simd, chunk.len());
        work.waves.iter_mut().for_each(|jets| jets.fill(n, R::S::default()));
        for octave in &self.lattices {
            places.find(simd, chunk.skewed, octave);
            turn::<R>(simd, n, places, work);
            for corner in CORNERS {
                send::<R>(simd, n, places, corner, octave, work);
            }
        }
        carve::<R>(simd, n, self, work);
    }
}

impl<S: Scalar> Carving<S> {
    /// The state before the first octave: a level guide, and gullies of full depth.
    fn restart(&mut self, n: usize) {
        self.guide.iter_mut().chain([&mut self.target]).for_each(|jets| jets.fill(n, S::default()));
        self.share.fill(n, S::of(1.0));
    }
}

impl Carving {
    /// Rounds the values of the state in f64.
    fn round_from(&mut self, n: usize, source: &Carving<f64>) {
        for (guide, source) in self.guide.iter_mut().zip(&source.guide) {
            guide.round_from(n, source);
        }
        self.share.round_from(n, &source.share);
        self.target.round_from(n, &source.target);
    }
}

/// Adds a noise octave to the slope that leads, and to the height that summits and valley floors keep.
#[inline(always)]
fn lead_body<R: Real>(n: usize, noise: &Noise<R::S>, weight: f32, per_cell: f32, work: &mut Carving<R::S>) {
    for i in 0..n.min(CHUNK) {
        let slope = R::noise_gradient(noise, i);
        for (slope, guide) in slope.into_iter().zip(&mut work.guide) {
            (R::load(guide, i) + slope.scale(per_cell)).store(guide, i);
        }
        (R::load(&work.target, i) + R::noise(noise, i).scale(weight)).store(&mut work.target, i);
    }
}
for_each_simd!(fn lead<R: Real>(n: usize, noise: &Noise<R::S>, weight: f32, per_cell: f32, work: &mut Carving<R::S>) = lead_body);

/// Maps the height of the noise to that of a ridge (1) on summits and of a bed (-1) on valley floors.
#[inline(always)]
fn settle_body<R: Real>(n: usize, work: &mut Carving<R::S>) {
    for i in 0..n.min(CHUNK) {
        let relief = R::load(&work.target, i);
        relief.smoothstep(-SUMMIT, SUMMIT).scale(2.0).plus(-1.0).store(&mut work.target, i);
    }
}
for_each_simd!(fn settle<R: Real>(n: usize, work: &mut Carving<R::S>) = settle_body);

/// Finds the vector across the slope.
#[inline(always)]
fn turn_body<R: Real>(n: usize, places: &Places<R::S>, work: &mut Carving<R::S>) {
    for i in 0..n.min(CHUNK) {
        let [gx, gy, gz] = [R::load(&work.guide[0], i), R::load(&work.guide[1], i), R::load(&work.guide[2], i)];
        let (on, off) = (R::S::of(1.0), R::S::of(0.0));
        let x = R::of(places.dir[0][i], [on, off, off]);
        let y = R::of(places.dir[1][i], [off, on, off]);
        let z = R::of(places.dir[2][i], [off, off, on]);
        let (sx, sy, sz) = (y * gz - z * gy, z * gx - x * gz, x * gy - y * gx);
        let length = (sx.square() + sy.square() + sz.square()).plus(FLAT * FLAT).sqrt();
        let shorten = length.recip();
        (sx * shorten).store(&mut work.side[0], i);
        (sy * shorten).store(&mut work.side[1], i);
        (sz * shorten).store(&mut work.side[2], i);
    }
}
for_each_simd!(fn turn<R: Real>(n: usize, places: &Places<R::S>, work: &mut Carving<R::S>) = turn_body);

/// Adds the waves of one of the eight cells.
#[inline(always)]
fn send_body<R: Real>(n: usize, places: &Places<R::S>, corner: [i32; 3], octave: &Octave, work: &mut Carving<R::S>) {
    let (seed, frequency, scale) = (octave.seed, R::S::of(octave.frequency), R::S::from_f32);
    let (low, span, zero) = (scale(0.5 - JITTER), scale(2.0 * JITTER), R::S::of(0.0));
    let Carving { side, waves: [re, im, re_arm, im_arm], .. } = work;
    for i in 0..n.min(CHUNK) {
        let (cell, step) = neighbour(places, corner, i);
        let random = noise::cell_hash(cell, seed);
        let towards = |axis: usize, bits: u32| step[axis] + low + span * unit(bits) - places.fraction[axis][i];
        let to = [towards(0, random), towards(1, random >> 10), towards(2, random >> 20)];
        let square = to[0] * to[0] + to[1] * to[1] + to[2] * to[2];
        let near = (R::S::of(1.0) - square * scale(1.0 / (REACH * REACH))).max(zero);
        let weight = near * near * near;
        let waves = to[0] * side[0].value[i] + to[1] * side[1].value[i] + to[2] * side[2].value[i];
        let (sin, cos) = approx::sin_cos(waves * scale(-WAVES));
        // The gradient as if all waves ran the same way everywhere, except for the part that is the same for all
        // waves.
        let fall = near * near * scale(6.0 / (REACH * REACH)) * frequency;
        let part = |value: R::S| {
            let fall = fall * value;
            R::of(weight * value, [fall * to[0], fall * to[1], fall * to[2]])
        };
        let arm = |value: R::S| {
            let value = weight * value;
            R::of(zero, [value * to[0], value * to[1], value * to[2]])
        };
        (R::load(re, i) + part(cos)).store(re, i);
        (R::load(im, i) + part(sin)).store(im, i);
        (R::load(re_arm, i) + arm(cos)).store(re_arm, i);
        (R::load(im_arm, i) + arm(sin)).store(im_arm, i);
    }
}
for_each_simd!(fn send<R: Real>(n: usize, places: &Places<R::S>, corner: [i32; 3], octave: &Octave, work: &mut Carving<R::S>) = send_body);

/// From the sum of waves to the height of gullies, and to the state that leads the next octave.
#[inline(always)]
fn carve_body<R: Real>(n: usize, gully: &Carved, work: &mut Carving<R::S>) {
    let (frequency, zero) = (gully.lattices[0].frequency as f32, R::S::of(0.0));
    for i in 0..n.min(CHUNK) {
        let side = [R::load(&work.side[0], i), R::load(&work.side[1], i), R::load(&work.side[2], i)];
        // The angle of each wave grows along the side vector, and turns with it in proportion to the distance of its
        // centre.
        let [re, im, re_arm, im_arm] = &work.waves;
        let along = |k: R::S, axis: usize| k * side[axis].value();
        let turned = |sum: &Jets<R::S>, other: &Jets<R::S>, arm: &Jets<R::S>, sign: f32| {
            let k = other.value[i] * R::S::from_f32(sign * TAU * WAVES * frequency);
            let straight = R::load(sum, i) + R::of(zero, [along(k, 0), along(k, 1), along(k, 2)]);
            let by = |axis: usize| side[axis].chain(zero, arm.gradient[axis][i] * R::S::from_f32(-sign * TAU * WAVES));
            straight + (by(0) + by(1) + by(2))
        };
        let real = turned(re, im, im_arm, -1.0);
        let imaginary = turned(im, re, re_arm, 1.0);
        let shorten = (real.square() + imaginary.square()).plus(FAINT).sqrt().recip();
        let (cos, sin) = (real * shorten, imaginary * shorten);

        // Sharp on the crest and round in the bed: 1 - 2 |sin of half the phase|.
        let half = (-cos).plus(1.0).scale(0.5).plus(ROUND).sqrt();
        let ridge = half.scale(-2.0).plus(1.0);
        let steepness = side[0].square() + side[1].square() + side[2].square();
        let share = R::load(&work.share, i) * steepness;
        let target = R::load(&work.target, i);
        let height = target + (ridge - target) * share;
        height.store(&mut work.gully, i);
        height.store(&mut work.target, i);
        let flank = sin.square();
        (R::load(&work.share, i) * flank * flank.plus(CLEAR).recip().scale(1.0 + CLEAR)).store(&mut work.share, i);
        let slope = (sin * half.recip() * share).scale(-0.5 * BRANCH * gully.slope);
        for (side, guide) in side.into_iter().zip(&mut work.guide) {
            (R::load(guide, i) + side * slope).store(guide, i);
        }
    }
}
for_each_simd!(fn carve<R: Real>(n: usize, gully: &Carved, work: &mut Carving<R::S>) = carve_body);
