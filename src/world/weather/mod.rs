//! Weather of a mean year: winds, rain, temperature, and how much water the air would take up.
//!
//! The model is diagnostic: belts of wind that the rotation turns, monsoons towards warm land, and moisture that winds
//! carry from the sea and lose on slopes. It is solved for two seasons, and the means are given. Distances are those
//! of a planet of the Earth's size.
//!
//! - `winds`: the wind of a season; `moisture`: what it carries, and rain

mod moisture;
mod winds;

use super::bytes::{Reader, Writer};
use super::cells::Cells;
use super::grid::smoothed;
use super::map::KeepGoing;
use super::once::made;
use crate::planet::Weather as Params;
use crate::sphere::geo::east_north;
use crate::sphere::raster::{NearPoints, Raster};
use glam::{DVec2, DVec3};
use rayon::prelude::*;
use std::sync::OnceLock;
use winds::Season;

/// What the weather depends on, at the cells of one grid.
pub(crate) struct Inputs<'a> {
    pub(crate) params: &'a Params,
    pub(crate) side: usize,
    /// Height of the ground in metres.
    pub(crate) heights_m: &'a [f64],
    /// Rain and snow that are added by hand, in mm a year.
    pub(crate) more_rain_mm: Option<&'a [f64]>,
    /// Height of the sea's surface in metres, if there is a sea.
    pub(crate) sea_level_m: Option<f64>,
    /// Temperatures at sea level, and how much colder it gets with height.
    pub(crate) equator_c: f64,
    pub(crate) pole_c: f64,
    pub(crate) lapse_c_per_km: f64,
}

/// The weather of a mean year at the cells of a grid.
pub(crate) struct Weather {
    pub(crate) side: usize,
    /// Mean wind to the east and to the north in m/s.
    pub(crate) wind_m_s: Vec<[f64; 2]>,
    /// Rain and snow in mm a year.
    pub(crate) rain_mm: Vec<f64>,
    /// Water that the air would take up from a wet surface, in mm a year.
    pub(crate) evaporation_mm: Vec<f64>,
    /// Mean temperature of the ground in °C.
    pub(crate) temperature_c: Vec<f64>,
    /// How much warmer currents of the sea make it in °C.
    warmer_c: Vec<f32>,
    /// How much warmer currents of the sea make it in °C, and the humidity, as [`Weather::at`] gives them.
    rasters: [Raster<f32>; 2],
    /// Rain in mm a year, as [`Weather::rain_at`] gives it, and the wind in m/s along the axes of the planet frame, as
    /// [`Weather::wind_at`] gives it.
    rain: OnceLock<Raster<f32>>,
    wind: OnceLock<[Raster<f32>; 3]>,
    mean_wind_m_s: OnceLock<f64>,
}

/// Values of [`Weather`] by cell.
struct Cellwise {
    wind_m_s: Vec<[f64; 2]>,
    rain_mm: Vec<f64>,
    evaporation_mm: Vec<f64>,
    temperature_c: Vec<f64>,
    warmer_c: Vec<f32>,
}

/// The most that currents of the sea warm or cool.
pub(crate) const WARMEST_C: f64 = 18.0;

/// What both seasons have in common.
struct Ground<'a> {
    inputs: &'a Inputs<'a>,
    cells: &'a Cells,
    is_sea: Vec<bool>,
    /// Height above the sea in km; 0 in the sea.
    height_km: Vec<f64>,
    /// Share of land within some hundred km.
    land: Vec<f64>,
    temperature_c: Vec<f64>,
    /// The neighbours of each cell in its tangent plane: to the east and to the north, on the unit sphere.
    around: Vec<[DVec2; 8]>,
}

impl Weather {
    /// Solves the weather. None if `keep_going` said no.
    pub(crate) fn solve(inputs: &Inputs<'_>, keep_going: &KeepGoing<'_>) -> Option<Self> {
        let cells = Cells::of(inputs.side);
        let ground = Ground::new(inputs, &cells);
        let (mut rain_mm, mut wind_m_s) = (vec![0.0; cells.dirs.len()], vec![[0.0; 2]; cells.dirs.len()]);
        for sign in [1.0, -1.0] {
            let season = Season::new(&ground, sign);
            let fallen_mm = moisture::rain_mm(&ground, &season, keep_going)?;
            for (cell, dir) in cells.dirs.iter().enumerate() {
                let (east, north) = east_north(*dir);
                rain_mm[cell] += 0.5 * fallen_mm[cell];
                wind_m_s[cell][0] += 0.5 * season.wind_m_s[cell].dot(east);
                wind_m_s[cell][1] += 0.5 * season.wind_m_s[cell].dot(north);
            }
        }
        let mut rain_mm = smoothed(&cells, &rain_mm, (inputs.side / 32).max(1));
        let added_mm = inputs.more_rain_mm.unwrap_or_default();
        rain_mm.iter_mut().zip(added_mm).for_each(|(rain_mm, added_mm)| *rain_mm = (*rain_mm + added_mm).max(0.0));
        let evaporation_mm = ground.temperature_c.iter().map(|c| potential_mm(*c)).collect();
        let warmer = (0..cells.dirs.len()).map(|cell| ground.current_c(cell).clamp(-WARMEST_C, WARMEST_C) as f32);
        let warmer_c = warmer.collect();
        let temperature_c = ground.temperature_c;
        Some(Self::new(inputs.side, Cellwise { wind_m_s, rain_mm, evaporation_mm, temperature_c, warmer_c }))
    }

    fn new(side: usize, cells: Cellwise) -> Self {
        let Cellwise { wind_m_s, rain_mm, evaporation_mm, temperature_c, warmer_c } = cells;
        let humid = |(rain, potential): (&f64, &f64)| humidity(*rain, *potential) as f32;
        let humid = rain_mm.iter().zip(&evaporation_mm).map(humid).collect();
        let rasters = [Raster::cube(side, warmer_c.clone()), Raster::cube(side, humid)];
        Self {
            side,
            wind_m_s,
            rain_mm,
            evaporation_mm,
            temperature_c,
            warmer_c,
            rasters,
            rain: OnceLock::new(),
            wind: OnceLock::new(),
            mean_wind_m_s: OnceLock::new(),
        }
    }

    /// Writes what [`Weather::read_from`] needs.
    pub(crate) fn write_to(&self, to: &mut Writer) {
        to.f64s(self.wind_m_s.iter().copied().flatten());
        for values in [&self.rain_mm, &self.evaporation_mm, &self.temperature_c] {
            to.f64s(values.iter().copied());
        }
        to.f32s(self.warmer_c.iter().copied());
    }

    /// The weather on a grid that was written.
    pub(crate) fn read_from(side: usize, from: &mut Reader<'_>) -> Option<Self> {
        let count = 6 * side * side;
        let wind_m_s = from.f64s(2 * count)?.as_chunks().0.to_vec();
        let [rain_mm, evaporation_mm, temperature_c] = [from.f64s(count)?, from.f64s(count)?, from.f64s(count)?];
        let warmer_c = from.f32s(count)?;
        Some(Self::new(side, Cellwise { wind_m_s, rain_mm, evaporation_mm, temperature_c, warmer_c }))
    }

    /// How much warmer currents of the sea make it in °C, and the humidity (0 to 1), at a unit direction.
    pub(crate) fn at(&self, dir: DVec3) -> [f64; 2] {
        let place = self.rasters[0].place(dir);
        self.rasters.each_ref().map(|raster| raster.value(&place, 0))
    }

    /// Finds the answers of [`Weather::at`] at points near each other: one number for each, of either kind.
    pub(crate) fn find(&self, points: &NearPoints, warmer_c: &mut Vec<f64>, humidity: &mut Vec<f64>) {
        self.rasters[0].values(points, warmer_c);
        self.rasters[1].values(points, humidity);
    }

    /// Rain and snow in mm a year at a unit direction.
    pub(crate) fn rain_at(&self, dir: DVec3) -> f64 {
        let raster = made(&self.rain, || Raster::cube(self.side, self.rain_mm.iter().map(|mm| *mm as f32).collect()));
        raster.value(&raster.place(dir), 0).max(0.0)
    }

    /// The mean wind in m/s at a unit direction: a tangent.
    pub(crate) fn wind_at(&self, dir: DVec3) -> DVec3 {
        let rasters = made(&self.wind, || {
            let cells = Cells::of(self.side);
            let winds = cells.dirs.iter().zip(&self.wind_m_s).map(|(dir, [to_east, to_north])| {
                let (east, north) = east_north(*dir);
                east * *to_east + north * *to_north
            });
            let winds: Vec<DVec3> = winds.collect();
            let along = |axis: usize| winds.iter().map(|wind| wind[axis] as f32).collect();
            [0, 1, 2].map(|axis| Raster::cube(self.side, along(axis)))
        });
        let place = rasters[0].place(dir);
        let wind = DVec3::from_array(rasters.each_ref().map(|raster| raster.value(&place, 0)));
        wind - dir * wind.dot(dir)
    }

    /// The mean speed of the wind over the globe, m/s.
    pub(crate) fn mean_wind_m_s(&self) -> f64 {
        *self.mean_wind_m_s.get_or_init(|| {
            let speeds = self.wind_m_s.iter().map(|[to_east, to_north]| libm::hypot(*to_east, *to_north));
            speeds.sum::<f64>() / self.wind_m_s.len().max(1) as f64
        })
    }

    /// Water that runs off in mm a year: what is left of the rain after evaporation (Schreiber 1904).
    pub(crate) fn runoff_mm(&self) -> Vec<f64> {
        let of = |(rain, potential): (&f64, &f64)| rain * libm::exp(-potential / rain.max(1.0));
        self.rain_mm.iter().zip(&self.evaporation_mm).map(of).collect()
    }

    /// What a lake loses beyond the rain that falls on it, in mm a year.
    pub(crate) fn dryness_mm(&self) -> Vec<f64> {
        self.evaporation_mm.iter().zip(&self.rain_mm).map(|(potential, rain)| potential - rain).collect()
    }
}

/// The share of the air's demand for water that rain meets: a desert has less than 0.2, rain forest more than 0.6.
fn humidity(rain_mm: f64, potential_mm: f64) -> f64 {
    rain_mm / (rain_mm + potential_mm).max(1.0)
}

/// Potential evaporation in mm a year by the mean temperature (after Holdridge 1967).
fn potential_mm(temperature_c: f64) -> f64 {
    60.0 + 56.0 * temperature_c.clamp(0.0, 34.0)
}

impl<'a> Ground<'a> {
    fn new(inputs: &'a Inputs<'a>, cells: &'a Cells) -> Self {
        let level_m = inputs.sea_level_m.unwrap_or(f64::MIN);
        let is_sea: Vec<bool> = inputs.heights_m.iter().map(|m| *m < level_m).collect();
        let zero_m = inputs.sea_level_m.unwrap_or(0.0);
        let height_km: Vec<f64> = inputs.heights_m.iter().map(|m| (m - zero_m).max(0.0) * 1e-3).collect();
        let share: Vec<f64> = is_sea.iter().map(|sea| if *sea { 0.0 } else { 1.0 }).collect();
        // The same distance on every grid: a random walk goes as far as the root of its steps.
        let rounds = (inputs.side * inputs.side / 340).clamp(1, 48);
        let land = smoothed(cells, &share, rounds);
        let around = (0..cells.dirs.len()).into_par_iter().map(|cell| around(cells, cell)).collect();
        let mut ground = Self { inputs, cells, is_sea, height_km, land, temperature_c: Vec::new(), around };
        ground.temperature_c = (0..cells.dirs.len()).into_par_iter().map(|cell| ground.temperature_c(cell)).collect();
        ground
    }

    /// Mean temperature: by latitude and height, and by the current along the coast. Water that flows towards a pole
    /// along the east side of a continent is warm; what returns along a west side in the tropics is cold.
    fn temperature_c(&self, cell: usize) -> f64 {
        let Inputs { equator_c, pole_c, lapse_c_per_km, .. } = *self.inputs;
        let flat2 = 1.0 - self.cells.dirs[cell].z * self.cells.dirs[cell].z;
        pole_c + (equator_c - pole_c) * flat2 - lapse_c_per_km * self.height_km[cell] + self.current_c(cell)
    }

    /// How much warmer the currents of the sea make a coast.
    fn current_c(&self, cell: usize) -> f64 {
        let dir = self.cells.dirs[cell];
        let params = self.inputs.params;
        let (east, _) = east_north(dir);
        let flat2 = 1.0 - dir.z * dir.z;
        let turn = winds::turn(params);
        // Land to the east: a west coast. The sign turns at 42 degrees.
        let west_coast = turn * self.slope(&self.land, cell).dot(east) * 0.12;
        -params.currents * 6.0 * west_coast.clamp(-1.0, 1.0) * (flat2 - 0.55) / 0.45
    }

    /// The gradient of values by the direction: of the plane that fits the neighbours of a cell best.
    fn slope(&self, values: &[f64], cell: usize) -> DVec3 {
        let [mut sum, mut squares] = [DVec2::ZERO; 2];
        let mut across = 0.0;
        for (way, other) in self.around[cell].iter().zip(self.cells.around(cell)) {
            sum += *way * (values[other as usize] - values[cell]);
            squares += *way * *way;
            across += way.x * way.y;
        }
        let scale = (squares.x * squares.y - across * across).max(1e-24);
        let (east, north) = east_north(self.cells.dirs[cell]);
        let slope = DVec2::new(sum.x * squares.y - sum.y * across, sum.y * squares.x - sum.x * across) / scale;
        east * slope.x + north * slope.y
    }
}

/// [`Ground::around`] of a cell.
fn around(cells: &Cells, cell: usize) -> [DVec2; 8] {
    let here = cells.dirs[cell];
    cells.around(cell).map(|other| tangent(here, cells.dirs[other as usize] - here))
}

/// A vector of the planet frame in the tangent plane at a direction: to the east and to the north.
fn tangent(here: DVec3, vector: DVec3) -> DVec2 {
    let (east, north) = east_north(here);
    DVec2::new(vector.dot(east), vector.dot(north))
}

#[cfg(test)]
mod tests;
