//! The kinds of layer, compiled: from a chunk of points to values and gradients. One file each.
//!
//! - `fbm`: octaves summed
//! - `ridged`: octaves folded into crests
//! - `craters`: bowls and rims of many sizes
//! - `terraces`: the waviness of steps cut into the ground
//! - `billow`: octaves folded into rounded hills
//! - `damped`: octaves that are weaker on steep ground
//! - `warped`: octaves at displaced points
//! - `continents`: octaves at displaced points, mapped to a profile of land and sea floor
//! - `canyons`: valleys along the zero lines of warped noise
//! - `dunes`: waves that run with the wind
//! - `gullies`: mountains carved by running water
//! - `cells`: plates, cracks and domes around scattered centres
//! - `heightmap`: heights from a picture
//! - `structure`: the ground that rivers carve, from world maps; it is no kind of layer
//! - `riverside`: how far layers stand from those rivers; it is no kind of layer
//! - `painted`: a mask that is painted by hand; it is no kind of layer
//! - `folding`: a landform steered by belts of folded rock
//! - `chunk`, `scratch`: the points, sums and memory that all kinds share
//! - `octaves`: series of octaves; `folded`: octaves folded at zero
//! - `warp`: displaced points
//! - `curve`: a smooth curve through knots
//! - `places`: lattice cells around points, for kinds that scatter features
//! - `varying`: affine intervals around a direction, for bounds
//! - `tests`: properties of every kind; `precision`: rounding errors; `tightness`: looseness of bounds
//!
//! A kind is a struct compiled from its parameters in [`crate::planet::shapes`] that implements [`Evaluate`]; the
//! list below is the only other code that names it. Its value must not depend on the spacing of the points. Every
//! operation of the value must be correctly rounded by IEEE 754 (`+ - * /`, `sqrt`) or come from `libm`.

mod billow;
mod canyons;
mod cells;
mod chunk;
mod continents;
mod craters;
mod curve;
mod damped;
mod dunes;
mod fbm;
mod folded;
mod folding;
mod gullies;
mod heightmap;
mod octaves;
mod painted;
mod places;
#[cfg(test)]
mod precision;
mod ridged;
mod riverside;
mod scratch;
mod structure;
mod terraces;
#[cfg(test)]
mod tests;
#[cfg(test)]
mod tightness;
mod varying;
mod warp;
mod warped;

use crate::planet::{Key, Shape};
use crate::terrain::edits::{Edits, MaskId};
use crate::world::carved::Carved;
use crate::world::plates::Plates;
use crate::world::weather::Weather;
use chunk::Sums;
pub(crate) use chunk::{Chunk, MAX_BANDS};
use glam::DVec3;
pub(crate) use octaves::Arithmetic;
pub(crate) use scratch::Scratch;
use scratch::{Folded, JETS, Scratch64};
use std::sync::Arc;
pub(crate) use structure::coarsest_spacing_rad;
pub(crate) use structure::{river_banks, river_points};
use varying::Around;

/// Lists the kinds: `Kind in file`.
macro_rules! landforms {
    ($($kind:ident in $file:ident,)+) => {
        /// A compiled landform: everything that its values depend on, and nothing else. Equal landforms have equal
        /// fields, so this is the key of a kept field.
        #[derive(Clone, Debug, PartialEq)]
        pub(crate) enum Landform {
            $($kind($file::$kind),)+
            Structure(structure::Structure),
            Riverside(riverside::Riverside),
            Painted(painted::Painted),
            Folding(Box<folding::Folding>),
        }

        impl Landform {
            /// Compiles a kind of layer for a planet of this radius. `seed` combines the seeds of planet and layer.
            pub(crate) fn new(shape: &Shape, seed: u64, radius_km: f64, arithmetic: Arithmetic) -> Self {
                match shape { $(Shape::$kind(params) => Landform::$kind($file::$kind::new(params, seed, radius_km, arithmetic)),)+ }
            }

            fn evaluate(&self) -> &dyn Evaluate {
                match self {
                    $(Landform::$kind(kind) => kind,)+
                    Landform::Structure(structure) => structure,
                    Landform::Riverside(riverside) => riverside,
                    Landform::Painted(painted) => painted,
                    Landform::Folding(folding) => &**folding,
                }
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
    /// Fractal noise with gain 0.5 and lacunarity 2.
    pub(crate) fn fbm(seed: u64, frequency: f64, octaves: u32) -> Self {
        Landform::Fbm(fbm::Fbm::plain(seed, frequency, octaves, Arithmetic::Classic))
    }

    /// The landform steered by folds, if it can be.
    pub(crate) fn folding(self, strength: f64) -> Self {
        match self {
            Landform::Craters(_) | Landform::Dunes(_) | Landform::HeightMap(_) => self,
            _ if strength <= 0.0 => self,
            _ => Landform::Folding(Box::new(folding::Folding::new(self, strength))),
        }
    }

    /// The world maps that it reads, besides those of the structure.
    pub(crate) fn reads(&self) -> Reads {
        Reads {
            plates: matches!(self, Landform::Folding(_)),
            weather: matches!(self, Landform::Dunes(dunes) if dunes.follows_wind()),
        }
    }

    /// The same landform with the maps that it reads. None if it reads none.
    pub(crate) fn with_maps(&self, maps: &Maps<'_>) -> Option<Self> {
        match self {
            Landform::Folding(folding) => Some(Landform::Folding(Box::new(folding.over(maps.plates)))),
            Landform::Dunes(dunes) if dunes.follows_wind() => Some(Landform::Dunes(dunes.over(maps.weather))),
            _ => None,
        }
    }

    /// The carved ground of a planet; none until its world map is solved.
    pub(crate) fn structure(carved: Option<(Key, &Carved)>) -> Self {
        Landform::Structure(structure::Structure::new(carved))
    }

    /// How far layers stand from the rivers of that ground; everywhere whole until its world map is solved.
    pub(crate) fn riverside(carved: Option<(Key, &Carved)>) -> Self {
        Landform::Riverside(riverside::Riverside::new(carved))
    }

    /// A mask that is painted by hand.
    pub(crate) fn painted(mask: MaskId, edits: Option<&Arc<Edits>>) -> Self {
        Landform::Painted(painted::Painted::new(mask, edits))
    }

    /// The key of the strokes that paint it. None if no stroke does.
    pub(crate) fn painted_key(&self) -> Option<Key> {
        if let Landform::Painted(painted) = self { painted.key() } else { None }
    }

    /// How many octaves of noise one point takes.
    pub(crate) fn octave_count(&self) -> usize {
        self.evaluate().octave_count()
    }

    /// Lowest and highest value it can take.
    pub(crate) fn bounds(&self) -> (f64, f64) {
        self.evaluate().bounds()
    }

    /// Lowest and highest value within an angle of a direction. Conservative.
    pub(crate) fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let ((least, most), (lo, hi)) = (self.bounds(), self.evaluate().bounds_near(dir_planet, angle_rad));
        (lo.max(least), hi.min(most))
    }

    /// Evaluates a chunk; the result is in `scratch.sums`.
    pub(crate) fn chunk(&self, chunk: &Chunk<'_>, scratch: &mut Scratch) {
        scratch.sums.restart(chunk);
        self.evaluate().add_to(chunk, scratch);
    }
}

/// Which world maps a landform reads, besides those of the structure.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(crate) struct Reads {
    pub(crate) plates: bool,
    pub(crate) weather: bool,
}

/// World maps that landforms read, with their keys.
#[derive(Clone, Copy, Default)]
pub(crate) struct Maps<'a> {
    pub(crate) plates: Option<(Key, &'a Plates)>,
    pub(crate) weather: Option<(Key, &'a Arc<Weather>)>,
}

/// What every kind implements.
trait Evaluate {
    /// How many octaves of noise one point takes, for statistics.
    fn octave_count(&self) -> usize;

    /// Lowest and highest value it can take.
    fn bounds(&self) -> (f64, f64);

    /// Lowest and highest value within an angle of a direction. Conservative.
    fn bounds_near(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        self.bounds_around(Around::new(dir_planet, angle_rad))
    }

    /// The same at points that folds displace.
    fn bounds_around(&self, _around: Around) -> (f64, f64) {
        self.bounds()
    }

    /// Adds the values at the points of a chunk to `scratch.sums.value`, and to each gradient of `scratch.sums` the
    /// part that its spacing shows. All other scratch memory is free to use and holds anything. Octaves that
    /// `chunk.skips` may be left out, with all finer ones. Without spacings only values are wanted; they must have
    /// the same bits.
    fn add_to(&self, chunk: &Chunk<'_>, scratch: &mut Scratch);

    /// The same with points that folds displace.
    fn add_folded(&self, chunk: &Chunk<'_>, folded: &Folded, scratch: &mut Scratch) {
        self.add_to(&Chunk { skewed: folded.displaced.points(chunk.len()), ..*chunk }, scratch);
        folded.displaced.pull_back(chunk, &mut scratch.sums);
    }
}
