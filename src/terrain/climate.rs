//! Temperature and moisture at the surface, and the place in the biome table that they make.

use super::coast::Coast;
use super::field::Field;
use super::landform::Landform;
use super::points::Points;
use super::simd::Simd;
use crate::planet::{Planet, TableRows};
use glam::DVec3;
use std::sync::Arc;

/// The climate of a planet, compiled.
#[derive(Clone, Debug)]
pub(crate) struct CompiledClimate {
    noises: Option<[Landform; 2]>,
    /// Where the sea is, if it matters.
    pub(crate) coast: Option<Arc<Coast>>,
}

/// Climate noise at a batch of points; depends on the climate's seed, region size and octaves only.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ClimateField {
    pub(crate) temperature: Vec<f64>,
    pub(crate) moisture: Vec<f64>,
}

/// The climate of one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PointClimate {
    pub(crate) temperature_c: f64,
    /// 0 (as cold as the table knows) to 1.
    pub(crate) temperature: f64,
    /// 0 to 1: the table's column.
    pub(crate) moisture: f64,
    /// 0 (last row: coldest or lowest) to 1 (first row).
    pub(crate) row: f64,
}

impl CompiledClimate {
    pub(crate) fn new(planet: &Planet) -> Self {
        let climate = &planet.climate;
        let varies = climate.temperature_variation_c > 0.0 || climate.moisture_variation > 0.0;
        let noise = |kind: u64| {
            // Apart from the layers' seeds, whose upper half is the planet's seed alone.
            let seed = super::noise::mix(u64::from(planet.seed)) ^ (u64::from(climate.seed) << 1) ^ kind;
            Landform::fbm(seed, planet.radius_km / climate.wavelength_km, climate.octaves)
        };
        Self { noises: varies.then(|| [noise(0), noise(1)]), coast: None }
    }

    /// Whether the planet's moisture depends on where its sea is.
    pub(crate) fn needs_coast(planet: &Planet) -> bool {
        planet.water.is_some() && planet.climate.sea_moisture > 0.0
    }

    /// The noises, as the key under which a field may be kept.
    pub(crate) fn noises(&self) -> Option<&[Landform; 2]> {
        self.noises.as_ref()
    }

    pub(crate) fn field(&self, simd: Simd, points: &Points) -> ClimateField {
        match &self.noises {
            Some([temperature, moisture]) => {
                let values = |landform| Field::new(landform, simd, points, &[]).value;
                ClimateField { temperature: values(temperature), moisture: values(moisture) }
            }
            None => ClimateField { temperature: vec![0.0; points.len()], moisture: vec![0.0; points.len()] },
        }
    }

    /// Distance to the sea at each point, as an angle; nothing where it does not matter.
    pub(crate) fn inland_rad(&self, dirs_planet: &[DVec3]) -> Vec<f64> {
        let coast = self.coast.iter();
        coast.flat_map(|coast| dirs_planet.iter().map(|&dir| coast.inland_rad(dir))).collect()
    }
}

impl ClimateField {
    /// The climate at one of the field's points, of this direction and height of the ground; `inland_rad` is the answer of
    /// [`CompiledClimate::inland_rad`] for all points.
    pub(crate) fn at(
        &self,
        planet: &Planet,
        inland_rad: &[f64],
        point: usize,
        dir_planet: DVec3,
        height_m: f64,
    ) -> PointClimate {
        let climate = &planet.climate;
        let sea_m = planet.sea_level_m();
        // Over a sea the surface is the sea's.
        let above_m = sea_m.map_or(height_m, |sea| (height_m - sea).max(0.0));
        let above_km = above_m.max(0.0) / 1000.0;
        let sin2_lat = dir_planet.z * dir_planet.z;
        let temperature_c = climate.equator_c + (climate.pole_c - climate.equator_c) * sin2_lat
            - climate.lapse_c_per_km * above_km
            + climate.temperature_variation_c * self.temperature[point];
        let from_sea = inland_rad.get(point).map_or(0.0, |inland_rad| {
            let left = (1.0 - inland_rad * planet.radius_km / climate.sea_reach_km).max(0.0);
            climate.sea_moisture * left * left
        });
        let moisture =
            climate.moisture + climate.belts * 0.5 * belt(sin2_lat) + climate.moisture_variation * self.moisture[point]
                - climate.drying_per_km * above_km
                + from_sea;
        let biomes = &planet.biomes;
        let temperature = (temperature_c - biomes.coldest_c) / (biomes.hottest_c - biomes.coldest_c);
        let row = match biomes.rows {
            TableRows::Temperature => temperature,
            TableRows::Elevation => {
                let height_m = sea_m.map_or(height_m, |sea| height_m - sea);
                (height_m - biomes.lowest_m) / (biomes.highest_m - biomes.lowest_m)
            }
        };
        PointClimate {
            temperature_c,
            temperature: temperature.clamp(0.0, 1.0),
            moisture: moisture.clamp(0.0, 1.0),
            row: row.clamp(0.0, 1.0),
        }
    }
}

/// Wet at the equator (1) and at 50° (0.6), dry at 25° and at the poles (-1): the cubic in sin² latitude through those.
fn belt(sin2_lat: f64) -> f64 {
    1.0 + sin2_lat * (-19.404_782 + sin2_lat * (52.369_621 + sin2_lat * -34.964_839))
}
