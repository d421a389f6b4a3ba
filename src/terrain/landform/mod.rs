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
//! - `varying`: numbers around a direction, for bounds
//! - `places`: cells of a lattice around points, for kinds that scatter things
//! - `tests`: what every kind must hold;
//!   `precision`: how exact they are; `tightness`: how close their bounds are
//!
//! A kind is a struct made from its parameters in [`crate::planet::shapes`] that implements [`Evaluate`]; the list
//! below is the only other place that knows it. Its value must not depend on the spacing of the points that ask, and
//! every operation that makes it must be correctly rounded by IEEE 754 (`+ - * /`, `sqrt`) or come from `libm`.

mod chunk;
mod curve;
mod octaves;
mod places;
#[cfg(test)]
mod precision;
mod scratch;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tightness;
mod varying;
mod warp;

use crate::planet::Shape;
use chunk::Sums;
pub(crate) use chunk::{Chunk, MAX_BANDS};
use glam::DVec3;
pub(crate) use octaves::Arithmetic;
pub(crate) use scratch::Scratch;
use scratch::{JETS, Scratch64};

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
