//! A chunk of points at which a landform is evaluated, and the sums that it fills.

use crate::simd::{Simd, for_each_simd};
use crate::terrain::jet::Jets;
use crate::terrain::lane::{CHUNK, Lane, Points3};
use crate::terrain::scalar::Scalar;
use crate::terrain::wet::Water;
use glam::DVec3;

/// Most gradient bands at once: a tile's own spacing, its parent's, and those of slope masks.
pub(crate) const MAX_BANDS: usize = 8;

/// A chunk of points and what is wanted at them.
#[derive(Clone, Copy)]
pub(crate) struct Chunk<'a> {
    pub(crate) simd: Simd,
    /// Coordinates skewed onto the simplex grid (see [`crate::terrain::noise::skew`]).
    pub(crate) skewed: Points3<'a>,
    /// The same points as unit directions.
    pub(crate) dirs: &'a [DVec3],
    /// The distance between neighbouring points, as an angle; 0 for points that stand alone.
    pub(crate) point_spacing_rad: f64,
    /// One gradient is wanted for each of these point spacings (angles in radians), at most [`MAX_BANDS`]. A gradient
    /// holds only the octaves that points so far apart can show; spacing 0 keeps every octave.
    pub(crate) spacings_rad: &'a [f64],
    /// Values may omit octaves that no band shows. For shading and coarse maps, never for heights.
    pub(crate) seen_only: bool,
    /// How much narrower features may be than their landform says: folds displace the points.
    pub(crate) squeeze: f64,
}

impl Chunk<'_> {
    pub(crate) fn len(&self) -> usize {
        self.dirs.len()
    }

    /// Whether the points are to be drawn, so that their water counts: those of a grid, with all detail.
    pub(super) fn is_drawn(&self) -> bool {
        self.point_spacing_rad > 0.0 && !self.seen_only
    }

    /// How many octaves to evaluate in f64: none where millimetres do not count.
    pub(super) fn f64_octaves(&self, octaves: usize) -> usize {
        if self.seen_only { 0 } else { octaves }
    }

    /// Whether an octave with these fades can be omitted.
    pub(crate) fn skips(&self, fades: &Fades) -> bool {
        self.seen_only && fades.is_unseen()
    }

    /// The share of a feature of this size (radians) that each band shows: all of it from `least` points per feature
    /// on, nothing below half as many.
    pub(crate) fn fades(&self, feature_rad: f64, least: f64) -> Fades {
        let mut fades = Fades([0.0; MAX_BANDS]);
        for (share, spacing_rad) in fades.0.iter_mut().zip(self.spacings_rad) {
            let points_per_feature = feature_rad / (spacing_rad.max(1e-30) * self.squeeze);
            *share = (points_per_feature / least - 1.0).clamp(0.0, 1.0) as f32;
        }
        fades
    }

    /// Writes the directions as numbers with gradients.
    pub(super) fn directions(&self, dir: [&mut Jets; 3]) {
        for (axis, jets) in dir.into_iter().enumerate() {
            jets.fill(self.len(), 0.0);
            jets.gradient[axis][..self.len()].fill(1.0);
            for (value, dir) in jets.value.iter_mut().zip(self.dirs) {
                *value = dir[axis] as f32;
            }
        }
    }

    /// Writes the directions in f64, without gradients.
    pub(super) fn directions_f64(&self, dir: [&mut Jets<f64>; 3]) {
        for (axis, jets) in dir.into_iter().enumerate() {
            for (value, dir) in jets.value.iter_mut().zip(self.dirs) {
                *value = dir[axis];
            }
        }
    }
}

/// The share of an octave that each band shows.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fades(pub(super) [f32; MAX_BANDS]);

impl Fades {
    /// No band shows it: its gradient is not needed.
    pub(crate) fn is_unseen(&self) -> bool {
        self.0.iter().all(|share| *share == 0.0)
    }
}

/// The sums of one chunk. Values are summed in f64: it costs little and keeps the millimetres of an 8 km mountain.
pub(crate) struct Sums {
    pub(crate) value: Lane<f64>,
    /// Gradients by the unit direction. Only the first `bands` belong to the chunk.
    gradients: Vec<[Lane<f32>; 3]>,
    bands: usize,
    /// Water at the points; only the structure of a planet fills it, for points of a grid.
    pub(crate) water: Vec<Water>,
}

impl Default for Sums {
    fn default() -> Self {
        Self { value: [0.0; CHUNK], gradients: Vec::new(), bands: 0, water: Vec::new() }
    }
}

impl Sums {
    pub(super) fn restart(&mut self, chunk: &Chunk<'_>) {
        let n = chunk.len();
        self.value[..n].fill(0.0);
        self.water.clear();
        self.bands = chunk.spacings_rad.len();
        if self.gradients.len() < self.bands {
            self.gradients.resize(self.bands, [[0.0; CHUNK]; 3]);
        }
        self.gradients_mut().iter_mut().flatten().for_each(|lane| lane[..n].fill(0.0));
    }

    /// The gradients, one for each of the chunk's spacings.
    pub(crate) fn gradients(&self) -> &[[Lane<f32>; 3]] {
        &self.gradients[..self.bands]
    }

    /// The gradients, one for each of the chunk's spacings.
    pub(super) fn gradients_mut(&mut self) -> &mut [[Lane<f32>; 3]] {
        &mut self.gradients[..self.bands]
    }

    /// Adds values times a weight, and the share of their gradients that each band shows.
    pub(super) fn add(
        &mut self,
        chunk: &Chunk<'_>,
        value: &Lane<f32>,
        gradient: &[Lane<f32>; 3],
        weight: f32,
        fades: &Fades,
    ) {
        add_value(chunk.simd, chunk.len(), value, weight, &mut self.value);
        self.add_gradients(chunk, gradient, weight, fades);
    }

    /// Adds values found in f64 times a weight.
    pub(super) fn add_f64(&mut self, chunk: &Chunk<'_>, value: &Lane<f64>, weight: f64) {
        add_f64_value(chunk.simd, chunk.len(), value, weight, &mut self.value);
    }

    /// Adds the share of gradients that each band shows, times a weight.
    pub(super) fn add_gradients(&mut self, chunk: &Chunk<'_>, gradient: &[Lane<f32>; 3], weight: f32, fades: &Fades) {
        for (sum, share) in self.gradients_mut().iter_mut().zip(fades.0) {
            if share > 0.0 {
                add_gradient(chunk.simd, chunk.len(), gradient, weight * share, sum);
            }
        }
    }

    /// Scales values up from the octaves summed so far, which have this share of all weight. Without it, leaving out
    /// octaves whose mean is not zero would sink the ground.
    pub(super) fn stand_for_all(&mut self, n: usize, share: f64) {
        if share > 0.0 {
            self.value[..n].iter_mut().for_each(|v| *v /= share);
        }
    }

    /// Replaces each sum by a function of it, which gives value and derivative.
    pub(super) fn map(&mut self, n: usize, function: impl Fn(f64) -> (f64, f64)) {
        for i in 0..n {
            let (value, derivative) = function(self.value[i]);
            self.value[i] = value;
            for lane in self.gradients_mut().iter_mut().flatten() {
                lane[i] *= derivative as f32;
            }
        }
    }
}

#[inline(always)]
fn add_value_body(n: usize, value: &Lane<f32>, weight: f32, sum: &mut Lane<f64>) {
    for i in 0..n.min(CHUNK) {
        sum[i] += f64::from(value[i] * weight);
    }
}
for_each_simd!(fn add_value(n: usize, value: &Lane<f32>, weight: f32, sum: &mut Lane<f64>) = add_value_body);

#[inline(always)]
fn add_f64_body(n: usize, value: &Lane<f64>, weight: f64, sum: &mut Lane<f64>) {
    for i in 0..n.min(CHUNK) {
        sum[i] += value[i] * weight;
    }
}
for_each_simd!(fn add_f64_value(n: usize, value: &Lane<f64>, weight: f64, sum: &mut Lane<f64>) = add_f64_body);

#[inline(always)]
fn add_gradient_body<S: Scalar>(n: usize, gradient: &[Lane<S>; 3], weight: S, sum: &mut [Lane<S>; 3]) {
    for (sum, gradient) in sum.iter_mut().zip(gradient) {
        for i in 0..n.min(CHUNK) {
            sum[i] = sum[i] + gradient[i] * weight;
        }
    }
}
for_each_simd!(pub(super) fn add_gradient(n: usize, gradient: &[Lane<f32>; 3], weight: f32, sum: &mut [Lane<f32>; 3]) = add_gradient_body::<f32>);
for_each_simd!(pub(super) fn add_gradient_f64(n: usize, gradient: &[Lane<f64>; 3], weight: f64, sum: &mut [Lane<f64>; 3]) = add_gradient_body::<f64>);
