//! Fractal noise that wind has swirled: the points are moved along the level lines of coarser noises first, so that
//! the noise curls without bunching up (curl noise; Bridson, Houriham, Nordenstam 2007).

use crate::simd::Simd;
use crate::terrain::lane::CHUNK;
use crate::terrain::noise::{Noise, Octave, skew};
use crate::world::noise::{hash, unit};
use glam::DVec3;

/// Frequency of each swirl in cells of the coarsest octave, and its reach: weather systems, and their arms.
const SWIRLS: [(f64, f64); 2] = [(0.7, 0.13), (1.9, 0.04)];
/// Octaves of clouds: the last is as fine as the texels of the cube map.
const OCTAVES: usize = 9;
const GAIN: f32 = 0.85;
const LACUNARITY: f64 = 2.03;
/// Fronts are stretched along the parallels.
const STRETCH: DVec3 = DVec3::new(0.85, 0.85, 1.3);
/// Octaves of the veil, and its stretch: streaks along jets.
const VEIL_OCTAVES: usize = 6;
const VEIL_STRETCH: DVec3 = DVec3::new(0.45, 0.45, 2.4);
const VEIL_FREQUENCY: f64 = 1.6;
const VEIL_GAIN: f32 = 0.58;
/// Octaves of the middle clouds, which form bands between both.
const MIDDLE_OCTAVES: usize = 8;
const MIDDLE_STRETCH: DVec3 = DVec3::new(0.7, 0.7, 1.6);
const MIDDLE_FREQUENCY: f64 = 1.2;
const MIDDLE_GAIN: f32 = 0.72;
/// Octaves of fog, which does not move.
const FOG_OCTAVES: usize = 3;
const FOG_FREQUENCY: f64 = 6.0;
const FOG_GAIN: f32 = 0.7;
/// Cells of the coarsest octave that change in a day; finer ones change faster.
const CHANGE_PER_DAY: f64 = 0.22;
/// Octaves whose share is less in the tropics, where clouds are clusters rather than bands.
const BROAD: usize = 2;

/// The octaves of a planet's clouds.
#[derive(Clone, Debug)]
pub(super) struct Swirls {
    simd: Simd,
    cells: f64,
    curl: f64,
    swirls: [Octave; 2],
    octaves: Vec<(Octave, f32)>,
    middle: Vec<(Octave, f32)>,
    veil: Vec<(Octave, f32)>,
    fog: Vec<(Octave, f32)>,
}

/// Noises at a point.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct Noises {
    /// Of the low clouds.
    pub(super) low: f32,
    /// Of the middle clouds.
    pub(super) middle: f32,
    /// Of the veil.
    pub(super) veil: f32,
}

impl Swirls {
    /// `cells`: cells of the coarsest octave along the radius; `finest`: frequency beyond which nothing shows.
    /// `has_middle`: whether the noise of the middle clouds is needed.
    pub(super) fn new(seed: u32, cells: f64, curl: f64, finest: f64, has_middle: bool) -> Self {
        let octave = |k: u32, frequency: f64| {
            let bits = hash(seed, k);
            let offset = [1, 2, 3].map(|axis| unit(hash(bits, axis)) * 512.0);
            Octave { frequency, offset, seed: bits }
        };
        let series = |first: u32, count: usize, frequency: f64, gain: f32| {
            let frequencies = std::iter::successors(Some(frequency), |f| Some(f * LACUNARITY)).take(count);
            let shown = frequencies.enumerate().filter(|(i, f)| *i == 0 || f * cells <= finest);
            let series: Vec<_> = shown.map(|(i, f)| (octave(first + i as u32, f), gain.powi(i as i32))).collect();
            // Simplex noise has a standard deviation of 0.33.
            let deviation = 0.33 * series.iter().map(|(_, weight)| weight * weight).sum::<f32>().sqrt();
            series.into_iter().map(|(octave, weight)| (octave, weight / deviation)).collect()
        };
        Self {
            simd: Simd::detect(),
            cells,
            curl,
            swirls: [0, 1].map(|k| octave(k as u32 + 1, SWIRLS[k].0)),
            octaves: series(10, OCTAVES, 1.0, GAIN),
            middle: series(50, if has_middle { MIDDLE_OCTAVES } else { 0 }, MIDDLE_FREQUENCY, MIDDLE_GAIN),
            veil: series(30, VEIL_OCTAVES, VEIL_FREQUENCY, VEIL_GAIN),
            fog: series(70, FOG_OCTAVES, FOG_FREQUENCY, FOG_GAIN),
        }
    }

    #[cfg(feature = "render")]
    pub(super) fn has_middle(&self) -> bool {
        !self.middle.is_empty()
    }

    #[cfg(test)]
    pub(super) fn with_simd(self, simd: Simd) -> Self {
        Self { simd, ..self }
    }

    /// Noises at up to [`CHUNK`] directions, `days` after time zero; each of unit standard deviation.
    pub(super) fn evaluate(&self, dirs: &[DVec3], days: f64, noise: &mut Noise, out: &mut [Noises]) {
        let n = dirs.len().min(CHUNK);
        let dirs = &dirs[..n];
        let mut points: Vec<DVec3> = dirs.iter().map(|dir| *dir * self.cells).collect();
        let mut skewed: [Vec<f64>; 3] = std::array::from_fn(|_| vec![0.0; n]);
        let load = |skewed: &mut [Vec<f64>; 3], points: &[DVec3], stretch: DVec3| {
            for (i, point) in points.iter().enumerate() {
                let q = skew((*point * stretch).to_array());
                (0..3).for_each(|axis| skewed[axis][i] = q[axis]);
            }
        };
        for (k, (frequency, reach)) in SWIRLS.into_iter().enumerate() {
            load(&mut skewed, &points, DVec3::ONE);
            noise.gradients(self.simd, skewed.each_ref().map(|axis| &axis[..]), &changed(&self.swirls[k], k, days));
            let reach = self.curl * reach / frequency;
            for (i, (point, dir)) in points.iter_mut().zip(dirs).enumerate() {
                let gradient = DVec3::from_array(noise.gradient.each_ref().map(|lane| f64::from(lane[i])));
                *point += dir.cross(gradient) * reach;
            }
        }
        out[..n].fill(Noises::default());
        load(&mut skewed, &points, STRETCH);
        for (k, (octave, weight)) in self.octaves.iter().enumerate() {
            noise.values(self.simd, skewed.each_ref().map(|axis| &axis[..]), &changed(octave, k, days));
            for (i, dir) in dirs.iter().enumerate() {
                let tropics = (1.0 - (dir.z * dir.z * 12.0) as f32).max(0.0);
                let share = if k < BROAD { 1.0 - 0.4 * tropics } else { 1.0 + 0.45 * tropics };
                out[i].low += weight * share * noise.value[i];
            }
        }
        load(&mut skewed, &points, VEIL_STRETCH);
        for (k, (octave, weight)) in self.veil.iter().enumerate() {
            noise.values(self.simd, skewed.each_ref().map(|axis| &axis[..]), &changed(octave, k, days));
            (0..n).for_each(|i| out[i].veil += weight * noise.value[i]);
        }
        load(&mut skewed, &points, MIDDLE_STRETCH);
        for (k, (octave, weight)) in self.middle.iter().enumerate() {
            noise.values(self.simd, skewed.each_ref().map(|axis| &axis[..]), &changed(octave, k + 1, days));
            (0..n).for_each(|i| out[i].middle += weight * noise.value[i]);
        }
    }

    /// Noise of fog at up to [`CHUNK`] directions.
    pub(super) fn fog(&self, dirs: &[DVec3], noise: &mut Noise, mut out: impl FnMut(usize, f32)) {
        let points = dirs.iter().map(|dir| skew((*dir * self.cells).to_array()));
        let points: Vec<[f64; 3]> = points.take(CHUNK).collect();
        let skewed: [Vec<f64>; 3] = std::array::from_fn(|axis| points.iter().map(|q| q[axis]).collect());
        let mut sums = vec![0.0; points.len()];
        for (octave, weight) in &self.fog {
            noise.values(self.simd, skewed.each_ref().map(|axis| &axis[..]), octave);
            sums.iter_mut().zip(noise.value.iter()).for_each(|(sum, value)| *sum += weight * value);
        }
        sums.into_iter().enumerate().for_each(|(i, sum)| out(i, sum));
    }
}

/// An octave that has drifted through its lattice: the pattern changes. Each octave goes its own way.
fn changed(octave: &Octave, k: usize, days: f64) -> Octave {
    let cells = days * CHANGE_PER_DAY * 1.5_f64.powi(k as i32);
    let way = [[0.6, 0.64, 0.48], [-0.48, 0.6, 0.64], [0.64, -0.48, -0.6]][k % 3];
    Octave { offset: std::array::from_fn(|axis| octave.offset[axis] + cells * way[axis]), ..*octave }
}
