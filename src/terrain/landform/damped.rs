//! Slope-damped fractal noise (Quilez, "More noise", 2008): each octave is divided by `1 + damping * slope^2`, where
//! the slope is that of the undamped octaves up to it. Octaves are raised by 1 first, so that damping lowers slopes:
//! peaks stand out, valleys widen.
//!
//! Slopes are measured along the ground, in coarsest wavelengths, so that `damping` means the same on every planet.
//! Gradients take second derivatives of the noise.

use super::fbm::LEAST_POINTS;
use super::octaves::{Weighted, series};
use super::varying::{Around, Point, Varying};
use super::{Arithmetic, Chunk, Evaluate, Scratch, Scratch64};
use crate::planet;
use crate::simd::for_each_simd;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::{self, Noise};
use glam::DVec3;

/// Greatest total weight of the octaves that are evaluated in f32.
const REST: f64 = 0.07;

/// Greatest frequency in cells per radius, and relative to the coarsest octave: beyond, the square of a slope
/// overflows f32.
const FINEST: f64 = 1e10;
const FINEST_TO_COARSEST: f64 = 1e12;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Damped {
    octaves: Vec<Weighted>,
    /// How many octaves, the coarsest, are evaluated in f64.
    f64_octaves: usize,
    damping: f32,
}

impl Damped {
    pub(super) fn new(params: &planet::Damped, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Damped { wavelength_km, octaves, gain, lacunarity, damping } = *params;
        let frequency = radius_km / wavelength_km;
        let mut octaves = series(seed, frequency, octaves, gain, lacunarity);
        octaves.retain(|o| o.octave.frequency < FINEST.min(FINEST_TO_COARSEST * frequency));
        Self { f64_octaves: arithmetic.f64_octaves(&octaves, REST), octaves, damping: damping as f32 }
    }
}

impl Evaluate for Damped {
    fn octave_count(&self) -> usize {
        self.octaves.len()
    }

    fn bounds(&self) -> (f64, f64) {
        (-noise::BOUND, noise::BOUND)
    }

    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let Some(first) = self.octaves.first() else { return self.bounds() };
        let unit = 1.0 / (first.octave.frequency * f64::from(first.weight));
        let around = Around::new(dir_planet, angle_rad);
        let point = Point::new(around);
        let mut slope = [Varying::constant(around, 0.0); 3];
        let mut sum = Varying::between(around, -1e-5, 1e-5);
        for Weighted { octave, weight } in &self.octaves {
            let weight = f64::from(*weight);
            let (noise, gradient) = point.noise_and_slope(octave);
            for (slope, gradient) in slope.iter_mut().zip(gradient) {
                *slope = *slope + gradient.scale(weight * unit * octave.frequency);
            }
            let ([x, y, z], [px, py, pz]) = (slope, point.coordinates);
            let upward = x * px + y * py + z * pz;
            let along = (x.square() + y.square() + z.square() - upward.square()).at_least(0.0);
            let left = along.scale(f64::from(self.damping)).plus(1.0).recip();
            sum = sum + (noise.plus(1.0) * left).scale(weight);
        }
        sum.plus(-1.0).range()
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, jets: [damped, px, py, pz, slope_x, slope_y, slope_z, ..], in_f64, .. } = scratch;
        let Scratch64 { noise: noise64, jets: [damped64, ex, ey, ez, slope_x_64, slope_y_64, slope_z_64, ..], .. } =
            in_f64;
        let exact = chunk.f64_octaves(self.f64_octaves);
        let n = chunk.len();
        chunk.directions([px, py, pz]);
        let (dir, slope) = ([&*px, &*py, &*pz], &mut [slope_x, slope_y, slope_z]);
        for lane in slope.iter_mut() {
            lane.fill(n, 0.0);
        }
        let slope64 = &mut [slope_x_64, slope_y_64, slope_z_64];
        if exact > 0 {
            chunk.directions_f64([ex, ey, ez]);
            slope64.iter_mut().for_each(|lane| lane.fill(n, 0.0));
        }
        let dir64 = [&*ex, &*ey, &*ez];
        let Some(first) = self.octaves.first() else { return };
        let unit = 1.0 / (first.octave.frequency * f64::from(first.weight));
        for (k, Weighted { octave, weight }) in self.octaves.iter().enumerate() {
            let rise = (f64::from(*weight) * unit) as f32;
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            if chunk.skips(&fades) {
                break;
            }
            if k < exact {
                noise64.gradients(chunk.simd, chunk.skewed, octave);
                let (noise64, simd) = (&*noise64, chunk.simd);
                damp::<f64>(simd, n, noise64, rise, self.damping, dir64, slope64, damped64);
                sums.add_f64(chunk, &damped64.value, f64::from(*weight));
                if !fades.is_unseen() {
                    noise.curvatures(chunk.simd, chunk.skewed, octave);
                    damp::<Jet>(chunk.simd, n, noise, rise, self.damping, dir, slope, damped);
                    sums.add_gradients(chunk, &damped.gradient, *weight, &fades);
                }
                for (slope, exact) in slope.iter_mut().zip(&*slope64) {
                    slope.round_from(n, exact);
                }
                continue;
            }
            // An octave too fine for every band needs no gradient, nor do the finer ones that follow.
            if fades.is_unseen() {
                noise.gradients(chunk.simd, chunk.skewed, octave);
                damp::<f32>(chunk.simd, n, noise, rise, self.damping, dir, slope, damped);
            } else {
                noise.curvatures(chunk.simd, chunk.skewed, octave);
                damp::<Jet>(chunk.simd, n, noise, rise, self.damping, dir, slope, damped);
            }
            sums.add(chunk, &damped.value, &damped.gradient, *weight, &fades);
        }
        // Raised octaves sum to about 0..2.
        sums.map(n, |v| (v - 1.0, 1.0));
    }
}

/// Damps one octave, whose gradient times `rise` is added to the slope.
#[inline(always)]
fn damp_body<R: Real>(
    n: usize,
    noise: &Noise<R::S>,
    rise: f32,
    damping: f32,
    dir: [&Jets<R::S>; 3],
    slope: &mut [&mut Jets<R::S>; 3],
    damped: &mut Jets<R::S>,
) {
    let [px, py, pz] = dir;
    let [sx, sy, sz] = slope;
    for i in 0..n.min(CHUNK) {
        let [gx, gy, gz] = R::noise_gradient(noise, i);
        let x = R::load(sx, i) + gx.scale(rise);
        let y = R::load(sy, i) + gy.scale(rise);
        let z = R::load(sz, i) + gz.scale(rise);
        x.store(sx, i);
        y.store(sy, i);
        z.store(sz, i);
        let upward = x * R::load(px, i) + y * R::load(py, i) + z * R::load(pz, i);
        let along = (x.square() + y.square() + z.square() - upward.square()).at_least(0.0);
        (R::noise(noise, i).plus(1.0) * along.scale(damping).plus(1.0).recip()).store(damped, i);
    }
}
for_each_simd!(fn damp<R: Real>(n: usize, noise: &Noise<R::S>, rise: f32, damping: f32, dir: [&Jets<R::S>; 3], slope: &mut [&mut Jets<R::S>; 3], damped: &mut Jets<R::S>) = damp_body);
