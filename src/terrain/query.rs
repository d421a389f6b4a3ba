//! Queries: what the ground is under directions from the planet's centre.
//!
//! A direction may have any length. A direction without one (zero, infinite or NaN) counts as the north pole, so that
//! every query has a finite answer; those of `checked` refuse it. All queries of a point agree to the bit:
//! alone or in a batch, on any thread.

use super::Terrain;
use super::biome::Site;
use super::climate::PointClimate;
#[cfg(doc)]
use super::curvature::CURVATURE_M;
use super::evaluate::BatchScratch;
use super::field::{ALL_OCTAVES, Components};
use super::lane::CHUNK;
use super::points::unit;
use super::water::River;
use super::wet::Water;
use crate::planet::{Planet, Population};
use crate::world::rivers::keep_bytes;
use glam::DVec3;
use rayon::prelude::*;
use std::cell::RefCell;
use std::fmt;

/// Directions for one task of a parallel query.
const TASK: usize = 1024;

/// The surface at one point.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
#[non_exhaustive]
pub struct Sample {
    /// Height of the ground above the reference sphere (below the sea too).
    pub height_m: f64,
    /// Unit normal of the ground in the planet frame.
    pub normal_planet: DVec3,
    /// Angle between the ground and the horizontal.
    pub slope_rad: f64,
    /// Height over the mean of four points [`CURVATURE_M`] around, as a share of that distance: about -1 to 1, below 0
    /// in hollows and above 0 on ridges.
    pub curvature: f64,
    /// Temperature at the surface (of the sea, where there is sea).
    pub temperature_c: f64,
    /// The same between the coldest (0) and the hottest (1) temperature of the biome table.
    pub temperature: f64,
    /// Moisture, 0 to 1: the biome table's columns.
    pub moisture: f64,
    /// The same as rain and snow in a year.
    pub precipitation_mm: f64,
    /// Column and row of the biome table, after border jitter.
    pub cell: [usize; 2],
    /// Index of the biome in the palette: the cell's, or that of a surface rule for steep ground, beaches or snow.
    pub biome: usize,
    /// Whether steep ground shows the rock that biomes share instead of the biome.
    pub is_rock: bool,
    /// Surface of the sea, lake or river that stands or flows over the ground here.
    pub water_level_m: Option<f64>,
    /// The nearest river, if one is near.
    pub river: Option<River>,
    /// Distance from the nearest water, 0 in it: from the bank of a river as far as rivers are known, and from a lake
    /// or the sea as ten times the height over its level, as if all shores rose one in ten. None if no water is known.
    pub bank_m: Option<f64>,
    /// Whether that distance follows from a height over a lake or the sea.
    pub bank_by_height: bool,
    /// The lake whose water it is.
    pub lake: Option<u32>,
    /// The basin that the cell of the point drains to, on the finest grid of rivers; none in the sea.
    pub basin: Option<u32>,
    /// Mean wind of a year: a tangent in the planet frame, to where the air moves. 0 without a structure.
    pub wind_planet_m_s: DVec3,
    /// Rain and snow in a year: the structure's weather, or without one the climate's `precipitation_mm`.
    pub rain_mm: f64,
    /// The plate of the crust, by its index.
    pub plate: Option<u16>,
}

/// What [`Terrain::samples`] finds besides the height. What is not asked for costs nothing and keeps its default value
/// (0 or none) in each [`Sample`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[non_exhaustive]
pub struct Wanted {
    /// Normal and slope.
    pub normal: bool,
    /// Temperature, moisture and precipitation.
    pub climate: bool,
    /// Cell and biome. They take the slope and the climate, which are then filled in too.
    pub biome: bool,
    /// Water level, river, lake, basin, wind, rain and plate. Without a structure rain takes the climate, which is
    /// then filled in too.
    pub water: bool,
    /// Distance from the nearest water. It takes the water, which is then filled in too.
    pub bank: bool,
    /// Curvature. It takes four heights more.
    pub curvature: bool,
}

impl Wanted {
    /// The height alone.
    pub const HEIGHT: Self =
        Self { normal: false, climate: false, biome: false, water: false, bank: false, curvature: false };
    /// Everything.
    pub const ALL: Self = Self { normal: true, climate: true, biome: true, water: true, bank: true, curvature: true };

    /// And the normal.
    #[must_use]
    pub fn and_normal(self) -> Self {
        Self { normal: true, ..self }
    }

    /// And the climate.
    #[must_use]
    pub fn and_climate(self) -> Self {
        Self { climate: true, ..self }
    }

    /// And the biome.
    #[must_use]
    pub fn and_biome(self) -> Self {
        Self { biome: true, ..self }
    }

    /// And water, wind, rain and plate.
    #[must_use]
    pub fn and_water(self) -> Self {
        Self { water: true, ..self }
    }

    /// And the distance from the nearest water.
    #[must_use]
    pub fn and_bank(self) -> Self {
        Self { bank: true, ..self }
    }

    /// And the curvature.
    #[must_use]
    pub fn and_curvature(self) -> Self {
        Self { curvature: true, ..self }
    }

    /// And what the populations of a planet ask of a place besides its biome: water, and the rest only if one that is
    /// on asks for it.
    #[must_use]
    pub(crate) fn and_for_life(self, planet: &Planet) -> Self {
        let asks = |what: fn(&Population) -> bool| planet.life.iter().any(|one| one.enabled && what(one));
        Self {
            water: true,
            bank: self.bank || asks(Population::asks_bank),
            curvature: self.curvature || asks(Population::asks_curvature),
            ..self
        }
    }

    fn slope(self) -> bool {
        self.normal || self.biome
    }
}

/// How much of a structure's rivers and valleys a query finds. Layers always count with all that they have.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum Detail {
    /// All of them, as the finest mesh shows them.
    #[default]
    All,
    /// What points this far apart along the reference sphere show, metres: far cheaper where points are spread over the
    /// planet. A number that is no distance counts as 0.
    SpacingM(f64),
}

impl Detail {
    /// The distance between points as an angle; 0 for all detail.
    pub(crate) fn spacing_rad(self, radius_m: f64) -> f64 {
        match self {
            Detail::SpacingM(spacing_m) if spacing_m > 0.0 => spacing_m.min(radius_m) / radius_m,
            _ => 0.0,
        }
    }
}

/// Memory for queries on one thread. It grows with the first query of a planet; later ones allocate nothing.
#[derive(Default)]
pub struct Scratch(pub(super) Box<BatchScratch>);

impl fmt::Debug for Scratch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("Scratch")
    }
}

/// Lends the calling thread's own scratch.
pub(super) fn with_scratch<T>(query: impl FnOnce(&mut Scratch) -> T) -> T {
    thread_local! {
        static SCRATCH: RefCell<Scratch> = RefCell::default();
    }
    SCRATCH.with_borrow_mut(query)
}

/// Heights and slopes at points, for shading.
pub(crate) struct Slopes {
    pub(crate) height_m: Vec<f64>,
    /// For each spacing, the slopes that points so far apart can show: see [`tangent_slope`].
    pub(crate) slopes: Vec<Vec<DVec3>>,
    /// Water over the ground; empty without a structure.
    pub(crate) water: Vec<Water>,
}

impl Terrain {
    /// Height of the ground above the reference sphere under a direction: the height of a mesh vertex there, to the
    /// bit. Between vertices the mesh is straight and stays within the screen-space error.
    pub fn height_m(&self, dir_planet: DVec3) -> f64 {
        let mut height_m = 0.0;
        with_scratch(|scratch| {
            self.heights_spaced_into(&[dir_planet], 0.0, std::slice::from_mut(&mut height_m), scratch);
        });
        height_m
    }

    /// Sets how many bytes the rivers of each planet may keep for later queries, for the whole program: 192 MiB unless
    /// told. What is not kept is made again at its next query, in some milliseconds a place. A point that stands alone
    /// on land takes tens of kilobytes.
    pub fn keep_rivers(bytes: usize) {
        keep_bytes(bytes);
    }

    /// Bytes that the rivers of this planet keep now.
    pub fn kept_rivers_bytes(&self) -> usize {
        self.world().carved.map().map_or(0, |carved| carved.rivers.kept_bytes())
    }

    /// [`Terrain::height_m`] of many directions with less of the rivers, on all cores.
    pub fn heights_detailed_m(&self, dirs_planet: &[DVec3], detail: Detail) -> Vec<f64> {
        self.heights_spaced_m(dirs_planet, detail.spacing_rad(self.planet().radius_m()))
    }

    /// [`Terrain::samples`] with less of the rivers.
    pub fn samples_detailed(&self, dirs_planet: &[DVec3], wanted: Wanted, detail: Detail) -> Vec<Sample> {
        let spacing_rad = detail.spacing_rad(self.planet().radius_m());
        let mut samples = vec![Sample::default(); dirs_planet.len()];
        let tasks = samples.par_chunks_mut(TASK).zip(dirs_planet.par_chunks(TASK));
        tasks.for_each(|(samples, dirs)| {
            with_scratch(|scratch| self.samples_spaced_into(dirs, spacing_rad, wanted, samples, scratch));
        });
        samples
    }

    /// [`Terrain::height_m`] of many directions, on all cores.
    pub fn heights_m(&self, dirs_planet: &[DVec3]) -> Vec<f64> {
        self.heights_spaced_m(dirs_planet, 0.0)
    }

    /// As [`Terrain::heights_m`], without valleys of a structure that points `spacing_rad` apart would not show.
    pub(crate) fn heights_spaced_m(&self, dirs_planet: &[DVec3], spacing_rad: f64) -> Vec<f64> {
        let mut heights_m = vec![0.0; dirs_planet.len()];
        let tasks = heights_m.par_chunks_mut(TASK).zip(dirs_planet.par_chunks(TASK));
        tasks.for_each(|(heights_m, dirs)| {
            with_scratch(|scratch| self.heights_spaced_into(dirs, spacing_rad, heights_m, scratch));
        });
        heights_m
    }

    /// As [`Terrain::heights_into`], without valleys of a structure that points `spacing_rad` apart would not show.
    pub(crate) fn heights_spaced_into(
        &self,
        dirs_planet: &[DVec3],
        spacing_rad: f64,
        heights_m: &mut [f64],
        scratch: &mut Scratch,
    ) {
        for (dirs, heights_m) in dirs_planet.chunks(CHUNK).zip(heights_m.chunks_mut(CHUNK)) {
            self.evaluate_at(dirs, spacing_rad, &[], scratch);
            for (height_m, found) in heights_m.iter_mut().zip(&scratch.0.heights.height_m) {
                *height_m = *found;
            }
        }
    }

    /// The surface under a direction.
    pub fn sample(&self, dir_planet: DVec3) -> Sample {
        let mut sample = Sample::default();
        let samples = std::slice::from_mut(&mut sample);
        with_scratch(|scratch| self.samples_spaced_into(&[dir_planet], 0.0, Wanted::ALL, samples, scratch));
        sample
    }

    /// The surface under many directions, on all cores.
    pub fn samples(&self, dirs_planet: &[DVec3], wanted: Wanted) -> Vec<Sample> {
        self.samples_detailed(dirs_planet, wanted, Detail::All)
    }

    /// As [`Terrain::samples_into`], without valleys and rivers of a structure that points `spacing_rad` apart would
    /// not show.
    pub(crate) fn samples_spaced_into(
        &self,
        dirs_planet: &[DVec3],
        spacing_rad: f64,
        wanted: Wanted,
        samples: &mut [Sample],
        scratch: &mut Scratch,
    ) {
        let spacings_rad = if wanted.slope() { ALL_OCTAVES } else { &[] };
        for (dirs, samples) in dirs_planet.chunks(CHUNK).zip(samples.chunks_mut(CHUNK)) {
            self.evaluate_at(dirs, spacing_rad, spacings_rad, scratch);
            let BatchScratch { points, heights, .. } = &*scratch.0;
            for (i, (sample, &dir)) in samples.iter_mut().zip(&points.dirs).enumerate() {
                *sample = Sample { height_m: heights.height_m[i], ..Sample::default() };
                if let Some(gradient) = heights.gradients.first().filter(|_| wanted.slope()) {
                    let slope = self.slope(dir, gradient, i, sample.height_m);
                    sample.normal_planet = (dir - slope).normalize();
                    sample.slope_rad = libm::atan(slope.length());
                }
            }
            let is_wet = wanted.water || wanted.bank;
            let rain = is_wet && self.world().weather.map().is_none();
            if wanted.climate || wanted.biome || rain {
                self.find_climate(wanted, samples, scratch);
            }
            if is_wet {
                self.find_water(&scratch.0.points.dirs, spacing_rad, samples);
            }
            if wanted.bank {
                self.find_banks(&scratch.0.points.dirs, spacing_rad, samples);
            }
            if wanted.curvature {
                self.find_curvature(spacing_rad, samples, scratch);
            }
        }
    }

    /// Fills in climate and biome of the points evaluated last, whose heights and slopes are known.
    fn find_climate(&self, wanted: Wanted, samples: &mut [Sample], scratch: &mut Scratch) {
        let BatchScratch { points, noise, .. } = &mut *scratch.0;
        let inputs = noise.climate(self, points);
        for (i, (sample, &dir)) in samples.iter_mut().zip(&points.dirs).enumerate() {
            let (noise, from_maps, painted) = inputs.at(i);
            let climate = self.rules.at(dir.z, sample.height_m, noise, from_maps, &painted);
            let PointClimate { temperature_c, temperature, moisture, .. } = climate;
            let precipitation_mm = moisture * self.planet().climate.wettest_mm;
            *sample = Sample { temperature_c, temperature, moisture, precipitation_mm, ..*sample };
            if wanted.biome {
                let cosine = sample.normal_planet.dot(dir);
                let site = Site { height_m: sample.height_m, cosine, temperature_c };
                (sample.cell, sample.biome, sample.is_rock) = self.biomes.at(dir, &climate, site);
            }
        }
    }

    /// By how much each layer of the preset changes the height under a direction, in order; 0 for layers that are off.
    /// Biome relief is in none of them.
    pub fn layers_m(&self, dir_planet: DVec3) -> Vec<f64> {
        let (mut layers_m, mut before_m) = (vec![0.0; self.stack.layers.len()], 0.0);
        with_scratch(|Scratch(scratch)| {
            scratch.points.refill(std::iter::once(unit(dir_planet)), 0.0);
            self.evaluate(&[], scratch, |layer, heights_m| {
                layers_m[layer] = heights_m[0] - before_m;
                before_m = heights_m[0];
            });
        });
        let mut of_preset = layers_m.split_off(self.stack.layers_before());
        of_preset.truncate(self.planet().layers.len());
        of_preset
    }

    /// The ground at unit directions, with the slopes that points at each spacing (angles) can show. The points
    /// themselves lie as far apart as the first spacing says.
    pub(crate) fn slopes_at(&self, dirs_planet: &[DVec3], spacings_rad: &[f64]) -> Slopes {
        let mut ground = Slopes {
            height_m: Vec::with_capacity(dirs_planet.len()),
            slopes: spacings_rad.iter().map(|_| Vec::with_capacity(dirs_planet.len())).collect(),
            water: Vec::new(),
        };
        with_scratch(|scratch| {
            for dirs in dirs_planet.chunks(CHUNK) {
                self.evaluate_at(dirs, spacings_rad.first().copied().unwrap_or(0.0), spacings_rad, scratch);
                let heights = &scratch.0.heights;
                ground.height_m.extend_from_slice(&heights.height_m);
                ground.water.extend_from_slice(&heights.water);
                for (slopes, gradient) in ground.slopes.iter_mut().zip(&heights.gradients) {
                    let slope = |(i, &dir)| self.slope(dir, gradient, i, heights.height_m[i]);
                    slopes.extend(dirs.iter().enumerate().map(slope));
                }
            }
        });
        ground
    }

    /// Evaluates at most one chunk of directions, `spacing_rad` apart (0: all detail).
    pub(super) fn evaluate_at(
        &self,
        dirs_planet: &[DVec3],
        spacing_rad: f64,
        spacings_rad: &[f64],
        Scratch(scratch): &mut Scratch,
    ) {
        scratch.points.refill(dirs_planet.iter().map(|&dir| unit(dir)), spacing_rad);
        self.evaluate(spacings_rad, scratch, |_, _| {});
    }

    /// The slope at the `i`th point, from a gradient by the unit direction.
    fn slope(&self, dir: DVec3, gradient: &Components, i: usize, height_m: f64) -> DVec3 {
        let gradient = gradient.each_ref().map(|component| f64::from(component[i]));
        tangent_slope(dir, DVec3::from_array(gradient), self.planet().radius_m() + height_m)
    }
}

/// Rise over run of a height whose gradient by the unit direction is `gradient`, at `radius_m` from the centre: a
/// vector in the tangent plane. The surface's normal is along `dir - slope`.
fn tangent_slope(dir: DVec3, gradient: DVec3, radius_m: f64) -> DVec3 {
    (gradient - dir * dir.dot(gradient)) / radius_m
}
