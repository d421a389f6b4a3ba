//! The kinds of terrain layer, compiled: from a chunk of points to values and gradients. One file each.
//!
//! - `fbm`: octaves summed
//! - `ridged`: octaves folded into crests
//! - `craters`: bowls and rims of many sizes
//! - `terraces`: the waviness of steps cut into the ground
//! - `billow`: octaves folded into rounded hills
//! - `damped`: octaves weaker where the ground is steep
//! - `warped`: octaves at displaced points
//! - `continents`: octaves at displaced points, put through a profile of land and sea floor
//! - `canyons`: valleys along the zero lines of warped noise
//! - `warp`: displaced points
//! - `curve`: a smooth curve through knots
//! - `dunes`: waves that run with the wind
//! - `gullies`: mountains carved by running water
//! - `cells`: plates, cracks and domes around scattered centres
//! - `heightmap`: heights from a picture
//! - `octaves`: what most kinds are made of
//! - `places`: cells of a lattice around points, for kinds that scatter things
//! - `tests`: what every kind must hold;
//!   `precision`: how exact they are; `tightness`: how close their bounds are
//!
//! A kind is a struct made from its parameters in [`crate::planet::shapes`] that implements [`Evaluate`]; the list
//! below is the only other place that knows it. Its value must not depend on the spacing of the points that ask, and
//! every operation that makes it must be correctly rounded by IEEE 754 (`+ - * /`, `sqrt`) or come from `libm`.

mod curve;
mod octaves;
mod places;
#[cfg(test)]
mod precision;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tightness;
mod warp;

use super::jet::Jets;
use super::noise::{CHUNK, Lane, Noise, Points3};
use super::simd::{Simd, for_each_simd};
use crate::planet::Shape;
use glam::DVec3;
pub(crate) use octaves::Arithmetic;
use warp::Displaced;

/// Lists the kinds: `Kind in file`.
macro_rules! landforms {
    ($($kind:ident in $file:ident,)+) => {
        $(mod $file;)+

        /// A layer's noise, compiled: everything its values depend on, and nothing else. Equal landforms have equal
        /// fields, so this is the key under which a field is kept.
        #[derive(Clone, Debug, PartialEq)]
        pub(crate) enum Landform { $($kind($file::$kind),)+ }

        impl Landform {
            /// Compiles a kind of layer for a planet of this radius. `seed` is the planet's and the layer's in one.
            pub(crate) fn new(shape: &Shape, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
                match shape { $(Shape::$kind(params) => Landform::$kind($file::$kind::new(params, seed, radius_km, arithmetic)),)+ }
            }

            fn evaluate(&self) -> &dyn Evaluate {
                match self { $(Landform::$kind(kind) => kind,)+ }
            }
        }
    };
}

landforms! {
    Fbm in fbm,
    Ridged in ridged,
    Craters in craters,
    Terraces in terraces,
    Billow in billow,
    Damped in damped,
    Warped in warped,
    Continents in continents,
    Dunes in dunes,
    Gullies in gullies,
    Canyons in canyons,
    Cells in cells,
    HeightMap in heightmap,
}

impl Landform {
    /// Plain fractal noise with gain 0.5 and lacunarity 2.
    pub(crate) fn fbm(seed: u64, frequency: f64, octaves: u32) -> Self {
        Landform::Fbm(fbm::Fbm::plain(seed, frequency, octaves, Arithmetic::Classic))
    }

    /// How many octaves of noise one point takes.
    pub(crate) fn octave_count(&self) -> usize {
        self.evaluate().octave_count()
    }

    /// Lowest and highest value it can take.
    pub(crate) fn bounds(&self) -> (f64, f64) {
        self.evaluate().bounds()
    }

    /// Lowest and highest value it can take within an angle of a direction; conservative.
    pub(crate) fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let ((least, most), (lo, hi)) = (self.bounds(), self.evaluate().bounds_near(dir_planet, angle_rad));
        (lo.max(least), hi.min(most))
    }

    /// Evaluates it at a chunk: the answer is in `scratch.sums`.
    pub(crate) fn chunk(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        scratch.sums.restart(chunk);
        self.evaluate().add_to(chunk, scratch);
    }
}

/// What a kind of layer must do.
trait Evaluate {
    /// How many octaves of noise one point takes, for figures.
    fn octave_count(&self) -> usize;

    /// Lowest and highest value it can take.
    fn bounds(&self) -> (f64, f64);

    /// Lowest and highest value within an angle of a direction. Conservative: never tighter than the truth.
    fn bounds_near(&self, _dir_planet: DVec3, _angle_rad: f64) -> (f64, f64) {
        self.bounds()
    }

    /// Adds its values at the chunk's points to `scratch.sums.value` (all zero before), and to each of
    /// `scratch.sums.gradients` what points as far apart as `chunk.spacings_rad` can show of its gradient. All else in
    /// `scratch` is free to use, with anything in it. What `chunk.skips` may be left out, with all that is finer. If
    /// `spacings_rad` is empty, values alone are wanted; they must have the same bits.
    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch);
}

/// Most gradients at once: a tile's own, its parent's, those that masks by slope ask for.
pub(crate) const MAX_BANDS: usize = 8;

/// What is asked for.
#[derive(Clone, Copy)]
pub(crate) struct Chunk<'a> {
    pub(crate) simd: Simd,
    /// Coordinates skewed onto the simplex grid (see [`super::noise::skew`]).
    pub(crate) skewed: Points3<'a>,
    /// The same points as unit directions.
    pub(crate) dirs: &'a [DVec3],
    /// The spacings of points (as angles) for which gradients are wanted, at most [`MAX_BANDS`]; 0 wants every octave.
    pub(crate) spacings_rad: &'a [f64],
    /// Whether values may lack what is seen in none of the bands: for shading, which has no use for heights.
    pub(crate) seen_only: bool,
}

impl Chunk<'_> {
    pub(crate) fn len(&self) -> usize {
        self.dirs.len()
    }

    /// How many octaves are to be found in f64, if so many are where heights count.
    fn exact(&self, octaves: usize) -> usize {
        if self.seen_only { 0 } else { octaves }
    }

    /// Whether something with these fades can be left out.
    pub(crate) fn skips(&self, fades: &Fades) -> bool {
        self.seen_only && fades.is_unseen()
    }

    /// What each of the spacings can show of features so large (as an angle): all of it from `least` points for each
    /// feature on, nothing below half as many.
    pub(crate) fn fades(&self, feature_rad: f64, least: f64) -> Fades {
        let mut fades = Fades([0.0; MAX_BANDS]);
        for (share, spacing_rad) in fades.0.iter_mut().zip(self.spacings_rad) {
            let points_per_feature = feature_rad / spacing_rad.max(1e-30);
            *share = (points_per_feature / least - 1.0).clamp(0.0, 1.0) as f32;
        }
        fades
    }
}

/// The share of something that is seen in each band.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Fades([f32; MAX_BANDS]);

impl Fades {
    /// Seen in no band: its gradient need not be found.
    pub(crate) fn is_unseen(&self) -> bool {
        self.0.iter().all(|share| *share == 0.0)
    }
}

/// Room to work in, used again and again.
#[derive(Default)]
pub(crate) struct Scratch {
    pub(crate) sums: Sums,
    noise: Noise,
    jets: [Jets; 8],
    displaced: Displaced,
    wide: Wide,
}

/// Room for what is found in f64.
#[derive(Default)]
struct Wide {
    noise: Noise<f64>,
    jets: [Jets<f64>; 8],
}

/// The coordinates of the chunk's directions.
fn place_exact(chunk: &Chunk<'_>, dir: [&mut Jets<f64>; 3]) {
    for (axis, jets) in dir.into_iter().enumerate() {
        for (value, dir) in jets.value.iter_mut().zip(chunk.dirs) {
            *value = dir[axis];
        }
    }
}

/// The coordinates of the chunk's directions as numbers with gradients.
fn place(chunk: &Chunk<'_>, dir: [&mut Jets; 3]) {
    for (axis, jets) in dir.into_iter().enumerate() {
        jets.fill(chunk.len(), 0.0);
        jets.gradient[axis][..chunk.len()].fill(1.0);
        for (value, dir) in jets.value.iter_mut().zip(chunk.dirs) {
            *value = dir[axis] as f32;
        }
    }
}

/// Sums of one chunk. Values are summed in f64: it costs little and keeps millimetres of an 8 km mountain.
pub(crate) struct Sums {
    pub(crate) value: Lane<f64>,
    /// Gradients by the unit direction, for each of the spacings.
    pub(crate) gradients: Vec<[Lane<f32>; 3]>,
}

impl Default for Sums {
    fn default() -> Self {
        Self { value: [0.0; CHUNK], gradients: Vec::new() }
    }
}

impl Sums {
    fn restart(&mut self, chunk: &Chunk<'_>) {
        self.value = [0.0; CHUNK];
        self.gradients.resize(chunk.spacings_rad.len(), [[0.0; CHUNK]; 3]);
        self.gradients.fill([[0.0; CHUNK]; 3]);
    }

    /// Adds numbers and, as far as they are seen, their gradients, all times a weight.
    fn add(&mut self, chunk: &Chunk<'_>, value: &Lane<f32>, gradient: &[Lane<f32>; 3], weight: f32, fades: &Fades) {
        add_value(chunk.simd, chunk.len(), value, weight, &mut self.value);
        self.add_gradients(chunk, gradient, weight, fades);
    }

    /// Adds numbers found in f64, times a weight.
    fn add_exact(&mut self, chunk: &Chunk<'_>, value: &Lane<f64>, weight: f64) {
        add_exact_value(chunk.simd, chunk.len(), value, weight, &mut self.value);
    }

    /// Adds gradients alone, as far as they are seen, times a weight.
    fn add_gradients(&mut self, chunk: &Chunk<'_>, gradient: &[Lane<f32>; 3], weight: f32, fades: &Fades) {
        for (sum, share) in self.gradients.iter_mut().zip(fades.0) {
            if share > 0.0 {
                add_gradient(chunk.simd, chunk.len(), gradient, weight * share, sum);
            }
        }
    }

    /// Lets the octaves summed so far, of this share of all weight, stand for those left out, in the values: for
    /// octaves whose mean is not zero, without which the ground would sink.
    fn stand_for_all(&mut self, n: usize, share: f64) {
        if share > 0.0 {
            self.value[..n].iter_mut().for_each(|v| *v /= share);
        }
    }

    /// Replaces each sum by a function of it, which gives its value and derivative.
    fn map(&mut self, n: usize, function: impl Fn(f64) -> (f64, f64)) {
        for i in 0..n {
            let (value, derivative) = function(self.value[i]);
            self.value[i] = value;
            for gradient in &mut self.gradients {
                for lane in gradient {
                    lane[i] *= derivative as f32;
                }
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
#[inline(always)]
fn add_exact_body(n: usize, value: &Lane<f64>, weight: f64, sum: &mut Lane<f64>) {
    for i in 0..n.min(CHUNK) {
        sum[i] += value[i] * weight;
    }
}
for_each_simd!(fn add_exact_value(n: usize, value: &Lane<f64>, weight: f64, sum: &mut Lane<f64>) = add_exact_body);
for_each_simd!(fn add_value(n: usize, value: &Lane<f32>, weight: f32, sum: &mut Lane<f64>) = add_value_body);

#[inline(always)]
fn add_gradient_body(n: usize, gradient: &[Lane<f32>; 3], weight: f32, sum: &mut [Lane<f32>; 3]) {
    for (sum, gradient) in sum.iter_mut().zip(gradient) {
        for i in 0..n.min(CHUNK) {
            sum[i] += gradient[i] * weight;
        }
    }
}
for_each_simd!(fn add_gradient(n: usize, gradient: &[Lane<f32>; 3], weight: f32, sum: &mut [Lane<f32>; 3]) = add_gradient_body);
