//! Slope-damped fractal noise (Quilez, "More noise", 2008): each octave divided by `1 + damping * slope^2`, where the
//! slope is that of the octaves up to it, undamped. Octaves are raised by 1 first, so that damping pulls slopes down:
//! peaks stand out, valleys widen.
//!
//! Slopes are measured along the ground, in coarsest wavelengths, so that `damping` means the same on every planet.
//! Where the gradient is wanted too, second derivatives of the noise make it exact.

use super::fbm::LEAST_POINTS;
use super::octaves::{Weighted, series};
use super::{Arithmetic, Chunk, Evaluate, Scratch, Wide, place, place_exact};
use crate::planet;
use crate::terrain::jet::{Jet, Jets, Real};
use crate::terrain::noise::{self, CHUNK, Noise};
use crate::terrain::simd::for_each_simd;
use glam::DVec3;

/// Weight of the octaves that f32 is enough for.
const REST: f64 = 0.07;

/// Cells to the radius, and against the coarsest octave, beyond which the square of a slope
/// would leave the range of f32.
const FINEST: f64 = 1e10;
const FINEST_TO_COARSEST: f64 = 1e12;

#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Damped {
    octaves: Vec<Weighted>,
    /// So many of them are found in f64.
    exact: usize,
    damping: f32,
}

impl Damped {
    pub(super) fn new(params: &planet::Damped, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
        let planet::Damped { wavelength_km, octaves, gain, lacunarity, damping } = *params;
        let frequency = radius_km / wavelength_km;
        let mut octaves = series(seed, frequency, octaves, gain, lacunarity);
        octaves.retain(|o| o.octave.frequency < FINEST.min(FINEST_TO_COARSEST * frequency));
        Self { exact: arithmetic.exact_of(&octaves, REST), octaves, damping: damping as f32 }
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
        let skewed = noise::skew(dir_planet.to_array());
        let Some(first) = self.octaves.first() else { return self.bounds() };
        let unit = 1.0 / (first.octave.frequency * f64::from(first.weight));
        // The slope at the direction, and how far from it the slope can be.
        let (mut sum, mut slope, mut spread) = ((0.0, 0.0), DVec3::ZERO, 0.0);
        for Weighted { octave, weight } in &self.octaves {
            let rise = f64::from(*weight) * unit * octave.frequency;
            let (low, high) = noise::range_near(skewed, octave, angle_rad);
            let (_, gradient, off) = noise::slope_near(skewed, octave, angle_rad);
            slope += gradient * rise;
            spread += off * rise;
            let along = slope.reject_from_normalized(dir_planet).length();
            let reach = spread + slope.length() * angle_rad;
            let left = |along: f64| 1.0 / (1.0 + f64::from(self.damping) * along * along);
            let (least, most) = (left(along + reach), left((along - reach).max(0.0)));
            let raised = (low + 1.0, high + 1.0);
            sum.0 += (raised.0 * if raised.0 < 0.0 { most } else { least }) * f64::from(*weight);
            sum.1 += (raised.1 * if raised.1 < 0.0 { least } else { most }) * f64::from(*weight);
        }
        (sum.0 - 1.0 - 1e-5, sum.1 - 1.0 + 1e-5)
    }

    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        let Scratch { sums, noise, jets: [damped, px, py, pz, slope_x, slope_y, slope_z, ..], wide, .. } = scratch;
        let Wide { noise: exact_noise, jets: [exact_damped, ex, ey, ez, exact_slope @ .., _] } = wide;
        let [exact_slope_x, exact_slope_y, exact_slope_z] = exact_slope;
        let exact = chunk.exact(self.exact);
        let n = chunk.len();
        place(chunk, [px, py, pz]);
        let (dir, slope) = ([&*px, &*py, &*pz], &mut [slope_x, slope_y, slope_z]);
        for lane in slope.iter_mut() {
            lane.fill(n, 0.0);
        }
        let exact_slope = &mut [exact_slope_x, exact_slope_y, exact_slope_z];
        if exact > 0 {
            place_exact(chunk, [ex, ey, ez]);
            exact_slope.iter_mut().for_each(|lane| lane.fill(n, 0.0));
        }
        let exact_dir = [&*ex, &*ey, &*ez];
        let Some(first) = self.octaves.first() else { return };
        let unit = 1.0 / (first.octave.frequency * f64::from(first.weight));
        for (k, Weighted { octave, weight }) in self.octaves.iter().enumerate() {
            let rise = (f64::from(*weight) * unit) as f32;
            let fades = chunk.fades(1.0 / octave.frequency, LEAST_POINTS);
            if chunk.skips(&fades) {
                break;
            }
            if k < exact {
                exact_noise.gradients(chunk.simd, chunk.skewed, octave);
                let (noise64, simd) = (&*exact_noise, chunk.simd);
                damp_exact(simd, n, noise64, rise, self.damping, exact_dir, exact_slope, exact_damped);
                sums.add_exact(chunk, &exact_damped.value, f64::from(*weight));
                if !fades.is_unseen() {
                    noise.curvatures(chunk.simd, chunk.skewed, octave);
                    damp_gradients(chunk.simd, n, noise, rise, self.damping, dir, slope, damped);
                    sums.add_gradients(chunk, &damped.gradient, *weight, &fades);
                }
                for (slope, exact) in slope.iter_mut().zip(&*exact_slope) {
                    slope.round_from(n, exact);
                }
                continue;
            }
            // An octave too fine for every band needs no gradient, nor do the finer ones that follow it.
            if fades.is_unseen() {
                noise.gradients(chunk.simd, chunk.skewed, octave);
                damp_values(chunk.simd, n, noise, rise, self.damping, dir, slope, damped);
            } else {
                noise.curvatures(chunk.simd, chunk.skewed, octave);
                damp_gradients(chunk.simd, n, noise, rise, self.damping, dir, slope, damped);
            }
            sums.add(chunk, &damped.value, &damped.gradient, *weight, &fades);
        }
        // Raised octaves sum to about 0..2.
        sums.map(n, |v| (v - 1.0, 1.0));
    }
}

/// Damps an octave, whose gradient times `rise` counts towards the slope.
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
for_each_simd!(fn damp_values(n: usize, noise: &Noise, rise: f32, damping: f32, dir: [&Jets; 3], slope: &mut [&mut Jets; 3], damped: &mut Jets) = damp_body::<f32>);
for_each_simd!(fn damp_exact(n: usize, noise: &Noise<f64>, rise: f32, damping: f32, dir: [&Jets<f64>; 3], slope: &mut [&mut Jets<f64>; 3], damped: &mut Jets<f64>) = damp_body::<f64>);
for_each_simd!(fn damp_gradients(n: usize, noise: &Noise, rise: f32, damping: f32, dir: [&Jets; 3], slope: &mut [&mut Jets; 3], damped: &mut Jets) = damp_body::<Jet>);
