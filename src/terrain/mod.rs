//! The evaluator: from a planet to the height, normal, climate and biome of any point of its surface.
//!
//! - [`simd`]: the instruction sets that the loops are compiled for
//! - `scalar`, `lane`, `jet`: the numbers of the loops, chunks of them, and numbers with gradients
//! - `approx`: sine, cosine and arctangent for the loops
//! - `noise`: gradient noise of one octave
//! - `landform`: the kinds of layer, one file each
//! - `points`, `field`: a batch of points; the value and gradient of a landform there
//! - `height`: layers joined by amplitude, curves, blends and masks
//! - `climate`: temperature and moisture
//! - `relief`: biome relief
//! - `evaluate`: the pipeline that makes a height from all of these, for queries and tiles
//! - `biome`, `border`: the biome of a point; border jitter
//! - `query`, `raycast`: the queries of [`Terrain`]
//! - `kept`: the fields that a tile keeps from one edit to the next
//! - `coast`, `coarse`: distance to the coast, and the coarse heights that it is made from
//! - `bench`: noise alone, for measuring
//!
//! [`Terrain`] is the public interface. Tiles and queries take the same pipeline, and every query has a finite
//! answer.

mod approx;
pub mod bench;
pub(crate) mod biome;
pub(crate) mod border;
pub(crate) mod climate;
mod coarse;
pub(crate) mod coast;
pub(crate) mod evaluate;
pub(crate) mod field;
pub(crate) mod height;
mod jet;
pub(crate) mod kept;
pub(crate) mod landform;
pub(crate) mod lane;
pub(crate) mod noise;
pub(crate) mod points;
mod query;
mod raycast;
pub(crate) mod relief;
mod scalar;
pub mod simd;

use crate::planet::{InvalidPlanet, Planet};
pub use height::curve_at;

use biome::CompiledBiomes;
use climate::{CompiledClimate, Rules};
use coarse::{CoarseFields, coarse_heights_m};
use coast::Coast;
use glam::DVec3;
use height::LayerStack;
use landform::Landform;
use points::unit;
pub use query::{Sample, Scratch, Wanted};
use relief::Relief;
use simd::Simd;
use std::f64::consts::PI;
use std::sync::Arc;

/// The compiled evaluator of one planet.
///
/// The same planet has bit-identical heights on every machine, instruction set and number of threads.
#[derive(Clone, Debug)]
pub struct Terrain {
    planet: Arc<Planet>,
    simd: Simd,
    pub(crate) stack: LayerStack,
    pub(crate) climate: CompiledClimate,
    /// Biome relief, if any biome has one.
    pub(crate) relief: Option<Relief>,
    /// What the shores were found with, if they matter.
    coarse: CoarseFields,
    rules: Rules,
    biomes: CompiledBiomes,
    height_bounds_m: (f64, f64),
}

impl Terrain {
    /// Compiles a planet.
    ///
    /// # Errors
    /// A planet that was changed to something that no preset may say: all that is wrong with it. One that was loaded
    /// and not changed since is valid.
    pub fn try_new(planet: Arc<Planet>) -> Result<Self, InvalidPlanet> {
        planet.check()?;
        Ok(Self::compile(planet, None))
    }

    /// As [`Terrain::try_new`], but takes over from the terrain of a similar planet what is the same and took time to
    /// find.
    ///
    /// # Errors
    /// As [`Terrain::try_new`].
    pub fn try_after(planet: Arc<Planet>, before: &Terrain) -> Result<Self, InvalidPlanet> {
        planet.check()?;
        Ok(Self::compile(planet, Some(before)))
    }

    /// The planet must be valid: numbers out of their ranges break what the evaluator takes for granted.
    fn compile(planet: Arc<Planet>, before: Option<&Terrain>) -> Self {
        let stack = LayerStack::new(&planet);
        let climate = CompiledClimate::new(&planet);
        let relief = Relief::new(&planet, &climate, stack.limits_m());
        let coarse = CoarseFields::default();
        let simd = Simd::detect();
        let (rules, biomes) = (Rules::new(&planet), CompiledBiomes::new(&planet));
        let mut terrain =
            Self { planet, simd, stack, climate, relief, coarse, rules, biomes, height_bounds_m: (0.0, 0.0) };
        terrain.height_bounds_m = terrain.with_relief(terrain.stack.bounds_m());
        // Found here rather than when first asked for: asked on a worker of a thread pool, it
        // would wait for its own pool.
        if let Some(sea_m) = terrain.planet.sea_level_m().filter(|_| CompiledClimate::needs_coast(&terrain.planet)) {
            let known = before.filter(|before| before.climate.coast.is_some());
            if let Some(before) = known.filter(|before| before.has_coast_of(&terrain)) {
                terrain.climate.coast = before.climate.coast.clone();
                terrain.coarse = before.coarse.as_known();
            } else {
                let (points, known) = (Coast::points(), known.map(|before| &before.coarse));
                let (heights_m, coarse) =
                    coarse_heights_m(&terrain.stack, terrain.simd, points, 0.5 * coast::CELL_RAD, known);
                terrain.climate.coast = Some(Arc::new(Coast::new(sea_m, &heights_m)));
                terrain.coarse = coarse;
            }
        }
        terrain
    }

    /// Resident size of what the shores were found with.
    pub(crate) fn coarse_bytes(&self) -> usize {
        self.coarse.bytes()
    }

    /// Forgets what the shores were found with: the next planet finds it anew.
    pub(crate) fn forget_coarse(&mut self) {
        self.coarse.forget();
    }

    /// Octaves of noise times points that were evaluated to compile it.
    pub(crate) fn octave_samples(&self) -> usize {
        self.coarse.octave_samples
    }

    /// Whether both have the same shores: everything that they depend on.
    fn has_coast_of(&self, other: &Terrain) -> bool {
        self.stack == other.stack && self.planet.sea_level_m() == other.planet.sea_level_m()
    }

    /// The same terrain evaluated with a given instruction set, for tests and benches. The results are the same.
    pub fn with_simd(mut self, simd: Simd) -> Self {
        self.simd = simd.min(Simd::detect());
        self
    }

    /// The planet it was compiled from.
    pub fn planet(&self) -> &Arc<Planet> {
        &self.planet
    }

    /// The instruction set in use.
    pub fn simd(&self) -> Simd {
        self.simd
    }

    /// Lowest and greatest height of the ground. Conservative: no point lies outside.
    pub fn height_bounds_m(&self) -> (f64, f64) {
        self.height_bounds_m
    }

    /// The same within an angle of a direction: narrower, or equal. NaN counts as any angle.
    pub fn height_bounds_near_m(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let angle_rad = if angle_rad.is_nan() { PI } else { angle_rad.abs().min(PI) };
        let ((lo, hi), (lowest, highest)) =
            (self.with_relief(self.stack.bounds_near_m(unit(dir_planet), angle_rad)), self.height_bounds_m);
        (lo.max(lowest), hi.min(highest))
    }

    /// Bounds of the height that the layers make, widened by biome relief.
    fn with_relief(&self, (lo, hi): (f64, f64)) -> (f64, f64) {
        let Some(relief) = &self.relief else { return (lo, hi) };
        let ((less, more), (lowest, highest)) = (relief.bounds_m(), self.stack.limits_m());
        ((lo + less).clamp(lowest, highest), (hi + more).clamp(lowest, highest))
    }

    /// How many octaves of noise one point takes at most.
    pub fn octaves_per_point(&self) -> usize {
        let layers: usize = self.stack.layers.iter().filter(|l| l.needed).map(|l| l.landform.octave_count()).sum();
        let climate: usize = self.climate.noises().into_iter().flatten().map(Landform::octave_count).sum();
        layers + climate + self.relief.as_ref().map_or(0, Relief::octave_count)
    }
}
