//! What the surface is: the compiled evaluator that everything asks.
//!
//! - [`simd`]: the instruction sets the loops are compiled for
//! - `noise`: gradient noise of one octave; the arithmetic all else rests on
//! - `approx`: sine, cosine and arctangent for the hot loops
//! - `jet`: numbers that carry their gradient
//! - `landform`: the kinds of layer, one file each
//! - `points`, `field`: batches of points; a layer's noise and gradient at them
//! - `kept`: the fields of all layers at a batch, present and past
//! - `height`: layers joined by amplitude, curves, blends and masks
//! - `relief`: what biomes add to the height
//! - `climate`: temperature, moisture, the place in the biome table
//! - `border`: noise that moves the borders between biomes
//! - [`survey`]: where the planet lies in its biome table
//! - `coarse`: the heights that world maps read
//! - [`revision`]: what changed between two revisions of a planet
//! - `ground`: which biome the rules for steep ground, beaches and snow put in the table's stead
//! - `bench`: the noise alone, for measuring
//! - `raycast`: a ray against the ground and the sea
//!
//! [`Terrain`] is the only thing outsiders need. Tiles go through the same functions as queries, in batches.
//!
//! Every question has a finite answer. A direction may have any length; one that leads nowhere (zero, infinite or NaN)
//! counts as the one to the north pole.

mod approx;
pub mod bench;
pub(crate) mod border;
pub(crate) mod climate;
pub(crate) mod coarse;
pub(crate) mod field;
pub(crate) mod ground;
pub(crate) mod height;
mod jet;
pub(crate) mod kept;
pub(crate) mod landform;
pub(crate) mod noise;
pub(crate) mod points;
mod raycast;
pub(crate) mod relief;
pub mod revision;
pub mod simd;
pub mod survey;

use crate::planet::{InvalidPlanet, Planet};
use crate::world::{Inputs, KeepGoing, MapWork, World};
pub use height::curve_at;

use climate::{CompiledClimate, NO_SEA, PointClimate, Rules};
use coarse::{CellFields, LayerGround};
use field::{Components, EXACT, Field};
use glam::DVec3;
use height::{CompiledLayer, Heights, LayerStack};
use landform::Landform;
use points::Points;
use rayon::prelude::*;
use relief::Relief;
pub use revision::Revision;
use revision::{Compiled, Keys, TileContent, TileKeys};
use simd::Simd;
use std::f64::consts::PI;
use std::sync::Arc;

/// The compiled evaluator of one planet.
///
/// The same planet gives the same bits on every machine, instruction set and number of threads.
#[derive(Clone, Debug)]
pub struct Terrain {
    planet: Arc<Planet>,
    simd: Simd,
    pub(crate) stack: LayerStack,
    pub(crate) climate: CompiledClimate,
    /// What biomes add to the height that the layers make.
    pub(crate) relief: Option<Relief>,
    keys: Keys,
    content: TileContent,
    map_inputs: Inputs,
    height_bounds_m: (f64, f64),
}

/// What the surface is at one point.
#[derive(Clone, Debug, PartialEq)]
pub struct Sample {
    /// Height of the ground above the reference sphere (below the sea too).
    pub height_m: f64,
    /// Unit normal of the ground in the planet frame.
    pub normal_planet: DVec3,
    /// Angle between the ground and the horizontal.
    pub slope_rad: f64,
    /// Temperature at the surface (of the sea, where there is sea).
    pub temperature_c: f64,
    /// The same between the coldest (0) and the hottest (1) that the biome table knows.
    pub temperature: f64,
    /// Moisture, 0 to 1: the biome table's columns.
    pub moisture: f64,
    /// The same as rain and snow in a year.
    pub precipitation_mm: f64,
    /// Cell of the biome table, as column and row: the one that moisture and temperature (or height) fall into after
    /// borders have been moved by noise.
    pub cell: [usize; 2],
    /// Index of the biome in the palette: the cell's, or what a rule for steep ground, beaches or snow puts there.
    pub biome: usize,
    /// By how much each layer of the preset changes the height there, in its order; 0 for layers that are off. What biomes add
    /// ([`crate::planet::Biome::relief_m`]) is in none of them.
    pub layers_m: Vec<f64>,
}

/// The ground at points.
pub(crate) struct GroundRelief {
    pub(crate) height_m: Vec<f64>,
    /// For each spacing asked for, the slopes without what is not seen at it: see [`tangent_slope`].
    pub(crate) slopes: Vec<Vec<DVec3>>,
}

impl Terrain {
    /// Compiles a planet.
    ///
    /// # Errors
    /// A planet that was changed to something that no preset may say: all that is wrong with it. One that was loaded
    /// and not changed since is valid.
    pub fn try_new(planet: Arc<Planet>) -> Result<Self, InvalidPlanet> {
        Self::try_new_with(planet, &CellFields::default(), &mut MapWork::default())
    }

    /// As [`Terrain::try_new`]: waits for the finest world maps.
    pub(crate) fn try_new_with(
        planet: Arc<Planet>,
        fields: &CellFields,
        work: &mut MapWork,
    ) -> Result<Self, InvalidPlanet> {
        let mut terrain = Self::try_draft(planet, &World::default())?;
        while let Some(next) = terrain.with_next_map(fields, &|| true, work) {
            terrain = next;
        }
        Ok(terrain)
    }

    /// Compiles a planet with the world maps of an earlier revision, which serve until its own are solved.
    ///
    /// # Errors
    /// As [`Terrain::try_new`].
    pub(crate) fn try_draft(planet: Arc<Planet>, world: &World) -> Result<Self, InvalidPlanet> {
        planet.check()?;
        let Compiled { stack, mut climate, relief, map_inputs, content, keys } = Compiled::new(&planet);
        climate.world = world.serving(&map_inputs);
        let simd = Simd::detect();
        let height_bounds_m = (0.0, 0.0);
        let mut terrain = Self { planet, simd, stack, climate, relief, keys, content, map_inputs, height_bounds_m };
        terrain.height_bounds_m = terrain.with_relief(terrain.stack.bounds_m());
        Ok(terrain)
    }

    /// The revision of the planet that the terrain was compiled from.
    pub fn revision(&self) -> Revision {
        Revision::with(self.planet.clone(), self.keys.clone())
    }

    /// The content keys of the planet.
    pub fn keys(&self) -> &Keys {
        &self.keys
    }

    /// The world maps that serve.
    pub(crate) fn world(&self) -> &World {
        &self.climate.world
    }

    /// Whether the world maps that serve are the planet's own, at their finest level.
    pub fn has_final_maps(&self) -> bool {
        self.world().is_final(&self.map_inputs)
    }

    /// The same terrain with the next level of its own world maps. None if its maps are final, or if `keep_going` said
    /// no. `fields` keeps layer fields for the next revision.
    pub(crate) fn with_next_map(
        &self,
        fields: &CellFields,
        keep_going: &KeepGoing<'_>,
        work: &mut MapWork,
    ) -> Option<Self> {
        if self.has_final_maps() {
            return None;
        }
        let ground = LayerGround { inputs: &self.map_inputs, stack: &self.stack, simd: self.simd, fields };
        let world = self.world().step(&ground, keep_going, work)?;
        let mut terrain = self.clone();
        terrain.climate.world = world;
        Some(terrain)
    }

    /// Content keys of the tiles that the terrain makes, with the world maps that serve.
    pub(crate) fn tile_keys(&self) -> TileKeys {
        self.content.keys(self.world().coast.key())
    }

    /// The same terrain evaluated with a given instruction set, for tests and benches. The answers are the same.
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

    /// The surface under a direction from the planet's centre, of any length. See [`crate::terrain`] for zero and NaN.
    pub fn sample(&self, dir_planet: DVec3) -> Sample {
        let dir = unit(dir_planet);
        let points = Points::new(vec![dir]);
        let fields = self.fields(&points, EXACT);
        let (mut layers_m, mut before_m) = (vec![0.0; self.stack.layers.len()], 0.0);
        let mut heights = height::combine(&self.stack, self.simd, &points, &fields, EXACT, |layer, heights_m| {
            layers_m[layer] = heights_m[0] - before_m;
            before_m = heights_m[0];
        });
        self.raise(&mut heights, &points, EXACT);
        let height_m = heights.height_m[0];
        let gradient = DVec3::from_array(heights.gradients[0].each_ref().map(|component| f64::from(component[0])));
        let slope = tangent_slope(dir, gradient, self.planet.radius_m() + height_m);
        let noise = self.climate.field(self.simd, &points);
        let inland_rad = self.climate.inland_rad(&[dir]).first().copied().unwrap_or(NO_SEA);
        let noise = [noise.temperature[0], noise.moisture[0]];
        let climate = Rules::new(&self.planet).at(dir.z, height_m, noise, inland_rad);
        let slope_rad = libm::atan(slope.length());
        let (cell, biome) = self.biome_of(dir, &climate, height_m, slope_rad);
        Sample {
            height_m,
            normal_planet: (dir - slope).normalize(),
            slope_rad,
            temperature_c: climate.temperature_c,
            temperature: climate.temperature,
            moisture: climate.moisture,
            precipitation_mm: climate.moisture * self.planet.climate.wettest_mm,
            cell,
            biome,
            layers_m,
        }
    }

    /// The cell of the biome table and the biome of a place: an index into the palette. Keys that the palette lacks count
    /// as its first biome.
    fn biome_of(&self, dir: DVec3, climate: &PointClimate, height_m: f64, slope_rad: f64) -> ([usize; 2], usize) {
        let biomes = &self.planet.biomes;
        let cell = border::cell_of(&self.planet, dir, climate.moisture, climate.row);
        let biome = biomes.table.key(cell[0], cell[1]).and_then(|key| biomes.index_of(key)).unwrap_or(0);
        let site = ground::Site { biome, height_m, slope_rad, temperature_c: climate.temperature_c };
        (cell, ground::biome_by_rules(&self.planet, site))
    }

    /// Height of the ground above the reference sphere under a direction of any length: the height that a tile has at a
    /// vertex of that direction, to the bit. See [`crate::terrain`] for zero and NaN.
    pub fn height_m(&self, dir_planet: DVec3) -> f64 {
        self.heights_of(vec![unit(dir_planet)])[0]
    }

    /// Heights under many directions, on all cores: of each what [`Terrain::height_m`] says.
    pub fn heights_m(&self, dirs_planet: &[DVec3]) -> Vec<f64> {
        dirs_planet
            .par_chunks(1024)
            .flat_map_iter(|dirs| self.heights_of(dirs.iter().map(|&d| unit(d)).collect()))
            .collect()
    }

    /// Lowest and greatest height the planet can have (conservative: no point lies outside).
    pub fn height_bounds_m(&self) -> (f64, f64) {
        self.height_bounds_m
    }

    /// The same for the ground within an angle of a direction: narrower, or equal. NaN is any angle.
    pub fn height_bounds_near_m(&self, dir_planet: DVec3, angle_rad: f64) -> (f64, f64) {
        let angle_rad = if angle_rad.is_nan() { PI } else { angle_rad.abs().min(PI) };
        let ((lo, hi), (lowest, highest)) =
            (self.with_relief(self.stack.bounds_near_m(unit(dir_planet), angle_rad)), self.height_bounds_m);
        (lo.max(lowest), hi.min(highest))
    }

    /// Bounds of what the layers make, widened by what biomes add.
    fn with_relief(&self, (lo, hi): (f64, f64)) -> (f64, f64) {
        let Some(relief) = &self.relief else { return (lo, hi) };
        let ((less, more), (lowest, highest)) = (relief.bounds_m(), self.stack.limits_m());
        ((lo + less).clamp(lowest, highest), (hi + more).clamp(lowest, highest))
    }

    /// Adds what biomes have of their own to heights that the layers made.
    fn raise(&self, heights: &mut Heights, points: &Points, spacings_rad: &[f64]) {
        let Some(relief) = &self.relief else { return };
        let fields = relief::fields(relief, self.simd, points, spacings_rad);
        let (climate, inland_rad) = (self.climate.field(self.simd, points), self.climate.inland_rad(&points.dirs));
        relief.add(heights, spacings_rad, points, &fields, &climate, &inland_rad);
    }

    /// How many octaves of noise one point takes.
    pub fn octaves_per_point(&self) -> usize {
        let layers: usize = self.stack.layers.iter().filter(|l| l.needed).map(|l| l.landform.octave_count()).sum();
        let climate: usize = self.climate.noises().into_iter().flatten().map(Landform::octave_count).sum();
        layers + climate + self.relief.as_ref().map_or(0, Relief::octave_count)
    }

    /// A field for each needed layer, with gradients at the spacings asked for and at those that slopes need.
    fn fields(&self, points: &Points, spacings_rad: &[f64]) -> Vec<Option<Arc<Field>>> {
        let field = |layer: &CompiledLayer| {
            Arc::new(Field::new(&layer.landform, self.simd, points, &layer.spacings_rad(spacings_rad)))
        };
        self.stack.layers.iter().map(|layer| layer.needed.then(|| field(layer))).collect()
    }

    /// The ground at unit directions, its slopes as points so far apart (as angles) can show them.
    pub(crate) fn relief_at(&self, dirs_planet: Vec<DVec3>, spacings_rad: &[f64]) -> GroundRelief {
        let points = Points::new(dirs_planet);
        let radius_m = self.planet.radius_m();
        let fields = self.fields(&points, spacings_rad);
        let mut heights = height::combine(&self.stack, self.simd, &points, &fields, spacings_rad, |_, _| {});
        self.raise(&mut heights, &points, spacings_rad);
        let slope = |components: &Components, i: usize| {
            let gradient = components.each_ref().map(|component| f64::from(component[i]));
            tangent_slope(points.dirs[i], DVec3::from_array(gradient), radius_m + heights.height_m[i])
        };
        let slopes = |components| (0..points.len()).map(|i| slope(components, i)).collect();
        GroundRelief { slopes: heights.gradients.iter().map(slopes).collect(), height_m: heights.height_m }
    }

    fn heights_of(&self, dirs_planet: Vec<DVec3>) -> Vec<f64> {
        let points = Points::new(dirs_planet);
        let fields = self.fields(&points, &[]);
        let mut heights = height::combine(&self.stack, self.simd, &points, &fields, &[], |_, _| {});
        self.raise(&mut heights, &points, &[]);
        heights.height_m
    }
}

/// The direction as a unit vector; one that is already of unit length (to rounding) is left as it is, to the bit. One
/// that leads nowhere counts as the one to the north pole.
fn unit(dir: DVec3) -> DVec3 {
    let length2 = dir.length_squared();
    if (length2 - 1.0).abs() < 1e-12 {
        return dir;
    }
    // Outside of this squares lose their digits or overflow.
    if (1e-200..1e200).contains(&length2) {
        return dir.normalize();
    }
    let largest = dir.abs().max_element();
    if dir.is_finite() && largest > 0.0 { (dir / largest).normalize() } else { DVec3::Z }
}

/// Rise over run of a height whose gradient by the unit direction is `gradient`, at `radius_m` from the centre: a
/// vector in the tangent plane. The surface's normal is along `dir - slope`.
fn tangent_slope(dir: DVec3, gradient: DVec3, radius_m: f64) -> DVec3 {
    (gradient - dir * dir.dot(gradient)) / radius_m
}
