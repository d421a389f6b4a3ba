//! Temperature and moisture at the surface, and the place in the biome table that they make.

use super::field::Field;
use super::landform::Landform;
use super::points::Points;
use super::simd::Simd;
use crate::planet::{CLIMATE_BELTS, Planet, TableRows};
use crate::world::World;
use glam::DVec3;

/// The climate of a planet, compiled.
#[derive(Clone, Debug)]
pub(crate) struct CompiledClimate {
    noises: Option<[Landform; 2]>,
    /// The world maps that climate reads.
    pub(crate) world: World,
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
        Self { noises: varies.then(|| [noise(0), noise(1)]), world: World::default() }
    }

    /// Whether the planet's moisture depends on the distance to the coast.
    pub(crate) fn reads_coast(planet: &Planet) -> bool {
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

    /// Distance from the sea in radians at each point; empty if climate does not read it, or if no map serves yet.
    pub(crate) fn inland_rad(&self, dirs_planet: &[DVec3]) -> Vec<f64> {
        let coast = self.world.coast.map().into_iter();
        coast.flat_map(|coast| dirs_planet.iter().map(|&dir| coast.inland_rad(dir))).collect()
    }
}

/// A distance beyond the reach of any sea.
pub(crate) const NO_SEA: f64 = f64::INFINITY;

/// Climate at the level of the sea: the parameters of a planet that tiles hold the results of.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SeaLevelClimate {
    equator_c: f64,
    /// From the equator to a pole.
    warmer_c: f64,
    temperature_variation_c: f64,
    moisture: f64,
    belts: f64,
    moisture_variation: f64,
    /// Moisture that the sea adds at the coast.
    sea_moisture: f64,
    /// How far moisture from the sea reaches inland.
    sea_reach_rad: f64,
}

impl SeaLevelClimate {
    pub(crate) fn new(planet: &Planet) -> Self {
        let climate = &planet.climate;
        Self {
            equator_c: climate.equator_c,
            warmer_c: climate.pole_c - climate.equator_c,
            temperature_variation_c: climate.temperature_variation_c,
            moisture: climate.moisture,
            belts: climate.belts * 0.5,
            moisture_variation: climate.moisture_variation,
            sea_moisture: climate.sea_moisture,
            sea_reach_rad: climate.sea_reach_km / planet.radius_km,
        }
    }

    /// Temperature in °C, and moisture that may lie beyond 0 to 1, at the latitude of a sine, with this noise for
    /// temperature and moisture, at a distance from the sea in radians ([`NO_SEA`] where there is none).
    #[inline(always)]
    pub(crate) fn at(&self, sin_lat: f64, noise: [f64; 2], inland_rad: f64) -> [f64; 2] {
        self.lifted(sin_lat, [0.0; 2], noise, inland_rad)
    }

    /// As [`Self::at`], colder by `less[0]` °C and drier by `less[1]`.
    #[inline(always)]
    fn lifted(&self, sin_lat: f64, less: [f64; 2], noise: [f64; 2], inland_rad: f64) -> [f64; 2] {
        let sin2_lat = sin_lat * sin_lat;
        let temperature_c =
            self.equator_c + self.warmer_c * sin2_lat - less[0] + self.temperature_variation_c * noise[0];
        let left = (1.0 - inland_rad / self.sea_reach_rad).max(0.0);
        let moisture = self.moisture + self.belts * belt(sin2_lat) + self.moisture_variation * noise[1] - less[1]
            + self.sea_moisture * left * left;
        [temperature_c, moisture]
    }
}

/// How climate follows from latitude, height and noise: the parameters of a planet, as numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rules {
    sea_level: SeaLevelClimate,
    lapse_c_per_km: f64,
    drying_per_km: f64,
    /// From which heights count: the sea's surface.
    sea_m: f64,
    /// Temperature of the table's last row, and from there to the end of the first.
    coldest_c: f64,
    range_c: f64,
    /// Whether the table's rows go by temperature, not by height.
    by_temperature: bool,
    /// What the last row begins with, and from there to the end of the first.
    lowest: f64,
    span: f64,
}

impl Rules {
    pub(crate) fn new(planet: &Planet) -> Self {
        let (climate, biomes) = (&planet.climate, &planet.biomes);
        let by_temperature = biomes.rows == TableRows::Temperature;
        let (lowest, highest) =
            if by_temperature { (biomes.coldest_c, biomes.hottest_c) } else { (biomes.lowest_m, biomes.highest_m) };
        Self {
            sea_level: SeaLevelClimate::new(planet),
            lapse_c_per_km: climate.lapse_c_per_km,
            drying_per_km: climate.drying_per_km,
            sea_m: planet.sea_level_m().unwrap_or(0.0),
            coldest_c: biomes.coldest_c,
            range_c: biomes.hottest_c - biomes.coldest_c,
            by_temperature,
            lowest,
            span: highest - lowest,
        }
    }

    /// The climate at a place whose latitude has this sine, at this height of the ground, with this noise for
    /// temperature and moisture, so far from the sea (as an angle; [`NO_SEA`] where there is none).
    #[inline(always)]
    pub(crate) fn at(&self, sin_lat: f64, height_m: f64, noise: [f64; 2], inland_rad: f64) -> PointClimate {
        // Over a sea the surface is the sea's.
        let above_m = height_m - self.sea_m;
        let above_km = above_m.max(0.0) / 1000.0;
        let less = [self.lapse_c_per_km * above_km, self.drying_per_km * above_km];
        let [temperature_c, moisture] = self.sea_level.lifted(sin_lat, less, noise, inland_rad);
        let temperature = (temperature_c - self.coldest_c) / self.range_c;
        let row = (if self.by_temperature { temperature_c } else { above_m } - self.lowest) / self.span;
        PointClimate {
            temperature_c,
            temperature: temperature.clamp(0.0, 1.0),
            moisture: moisture.clamp(0.0, 1.0),
            row: row.clamp(0.0, 1.0),
        }
    }

    /// How much moisture and row change with each metre of height, where they do.
    pub(crate) fn by_height(&self, height_m: f64, climate: &PointClimate) -> [f64; 2] {
        let over_sea = height_m > self.sea_m;
        let inside = |x: f64| x > 0.0 && x < 1.0;
        let moisture = if over_sea && inside(climate.moisture) { -self.drying_per_km / 1000.0 } else { 0.0 };
        let row = match self.by_temperature {
            _ if !inside(climate.row) => 0.0,
            true if !over_sea => 0.0,
            true => -self.lapse_c_per_km / 1000.0 / self.span,
            false => 1.0 / self.span,
        };
        [moisture, row]
    }
}

/// The climate belts at a latitude: see [`CLIMATE_BELTS`].
#[inline(always)]
fn belt(sin2_lat: f64) -> f64 {
    let [c0, c1, c2, c3] = CLIMATE_BELTS;
    c0 + sin2_lat * (c1 + sin2_lat * (c2 + sin2_lat * c3))
}
