//! Climate: temperature and moisture at the surface, and the row and column of the biome table that follow.

use super::edits::Painted;
use super::field::Field;
use super::landform::Landform;
use super::points::Points;
use crate::planet::{CLIMATE_BELTS, Key, Planet, TableRows};
use crate::simd::Simd;
use crate::sphere::raster::NearPoints;
use crate::world::carved::Carved;
use crate::world::coast::Coast;
use crate::world::weather::{WARMEST_C, Weather};
use crate::world::{Inputs, Slot, World};
use glam::DVec3;

/// The climate of a planet, compiled.
#[derive(Clone, Debug)]
pub(crate) struct CompiledClimate {
    noises: Option<[Landform; 2]>,
    /// The world maps that climate reads.
    pub(crate) world: World,
}

/// Climate noise at a batch of points. It depends on the seed, region size and octaves of the climate alone.
#[derive(Clone, Debug, Default, PartialEq)]
pub(crate) struct ClimateField {
    pub(crate) temperature: Vec<f64>,
    pub(crate) moisture: Vec<f64>,
}

/// The climate of one point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct PointClimate {
    pub(crate) temperature_c: f64,
    /// Position between the coldest (0) and the hottest (1) temperature of the biome table.
    pub(crate) temperature: f64,
    /// 0 to 1: the column of the biome table.
    pub(crate) moisture: f64,
    /// Row of the biome table, from 0 (last row: coldest or lowest) to 1 (first row).
    pub(crate) row: f64,
}

impl CompiledClimate {
    pub(crate) fn new(planet: &Planet) -> Self {
        let climate = &planet.climate;
        let varies = climate.temperature_variation_c > 0.0 || climate.moisture_variation > 0.0;
        let noise = |kind: u64| {
            // Layers take the planet's seed for the upper half of theirs; mixing it keeps the seeds of the climate
            // apart.
            let seed = crate::world::noise::mix(u64::from(planet.seed)) ^ (u64::from(climate.seed) << 1) ^ kind;
            Landform::fbm(seed, planet.radius_km / climate.wavelength_km, climate.octaves)
        };
        Self { noises: varies.then(|| [noise(0), noise(1)]), world: World::default() }
    }

    /// Whether the planet's moisture depends on the distance to the coast.
    pub(crate) fn reads_coast(planet: &Planet) -> bool {
        planet.water.is_some() && planet.climate.sea_moisture > 0.0
    }

    /// The noises: the key of a kept [`ClimateField`].
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

    /// What world maps say at each point; empty if the climate reads none, or if none serves yet.
    pub(crate) fn climates_of_maps(&self, dirs_planet: &[DVec3]) -> Vec<MapClimate> {
        let mut found = Vec::new();
        self.find_climates_of_maps(dirs_planet, &mut MapScratch::default(), &mut found);
        found
    }

    /// As [`CompiledClimate::climates_of_maps`], in memory that is used again. Points near each other take least time.
    pub(crate) fn find_climates_of_maps(
        &self,
        dirs_planet: &[DVec3],
        memory: &mut MapScratch,
        found: &mut Vec<MapClimate>,
    ) {
        found.clear();
        let (coast, weather) = (self.world.coast.map(), self.world.weather.map());
        if coast.is_none() && weather.is_none() {
            return;
        }
        let MapScratch { points, inland_rad, warmer_c, humidity, wet } = memory;
        found.resize(dirs_planet.len(), MapClimate::NONE);
        points.refill(dirs_planet.iter().copied());
        if let Some(coast) = coast {
            coast.find_inland_rad(points, inland_rad);
            for (found, inland_rad) in found.iter_mut().zip(inland_rad) {
                found.inland_rad = *inland_rad;
            }
        }
        humidity.clear();
        humidity.resize(dirs_planet.len(), 0.0);
        if let Some(weather) = weather {
            weather.find(points, warmer_c, humidity);
            for (found, warmer_c) in found.iter_mut().zip(warmer_c) {
                found.warmer_c = *warmer_c;
            }
        }
        if let Some(carved) = self.world.carved.map() {
            carved.floodplains.raise(points, humidity, wet);
        }
        for (found, humidity) in found.iter_mut().zip(humidity) {
            found.humidity = *humidity;
        }
    }

    /// Keys of the maps that [`CompiledClimate::climates_of_maps`] reads.
    pub(crate) fn map_keys(&self) -> MapKeys {
        [self.world.coast.key(), self.world.weather.key(), self.world.carved.key()]
    }
}

/// Memory for what world maps say.
#[derive(Debug, Default)]
pub(crate) struct MapScratch {
    points: NearPoints,
    inland_rad: Vec<f64>,
    warmer_c: Vec<f64>,
    humidity: Vec<f64>,
    wet: Vec<f64>,
}

/// The inputs of the climate other than height, at a batch of points.
#[derive(Clone, Copy, Debug)]
pub(crate) struct ClimateInputs<'a> {
    /// Noise for temperature and moisture.
    pub(crate) noise: [&'a [f64]; 2],
    /// What world maps say; empty if the climate reads none.
    pub(crate) from_maps: &'a [MapClimate],
    /// Paint; empty where there is none.
    pub(crate) painted: &'a [Painted],
}

impl ClimateInputs<'_> {
    /// Noise, what world maps say, and paint of one point.
    #[inline(always)]
    pub(crate) fn at(&self, i: usize) -> ([f64; 2], MapClimate, Painted) {
        let at = |numbers: &[f64]| numbers.get(i).copied().unwrap_or(0.0);
        (
            [at(self.noise[0]), at(self.noise[1])],
            self.from_maps.get(i).copied().unwrap_or(MapClimate::NONE),
            self.painted.get(i).copied().unwrap_or(Painted::NONE),
        )
    }
}

/// Keys of the maps of coast, weather and carved ground.
pub(crate) type MapKeys = [Option<Key>; 3];

/// The [`CompiledClimate::map_keys`] of a planet whose own maps serve.
pub(crate) fn final_map_keys(inputs: &Inputs) -> MapKeys {
    [Slot::<Coast>::final_key(inputs), Slot::<Weather>::final_key(inputs), Slot::<Carved>::final_key(inputs)]
}

/// What world maps say about the climate of a point.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct MapClimate {
    /// Distance from the sea as an angle; infinite beyond the reach of any coast.
    pub(crate) inland_rad: f64,
    /// How much warmer currents of the sea make it, in °C.
    pub(crate) warmer_c: f64,
    /// Share of the air's demand for water that rain meets, 0 to 1, raised on floodplains; see
    /// [`crate::world::weather::Weather::at`] and `world/floodplain.rs`.
    pub(crate) humidity: f64,
}

impl MapClimate {
    /// Without maps.
    pub(crate) const NONE: Self = Self { inland_rad: f64::INFINITY, warmer_c: 0.0, humidity: 0.0 };
    /// The driest and the wettest climate.
    const EXTREMES: [Self; 2] = [
        Self { inland_rad: f64::INFINITY, warmer_c: -WARMEST_C, humidity: 0.0 },
        Self { inland_rad: 0.0, warmer_c: WARMEST_C, humidity: 1.0 },
    ];
}

/// The climate at sea level: the climate parameters whose results tiles hold, converted for evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct SeaLevelClimate {
    equator_c: f64,
    /// Temperature of a pole less that of the equator.
    warmer_c: f64,
    temperature_variation_c: f64,
    moisture: f64,
    belts: f64,
    moisture_variation: f64,
    /// Moisture that the sea adds at the coast.
    sea_moisture: f64,
    /// How far moisture from the sea reaches inland.
    sea_reach_rad: f64,
    /// Share of the solved weather in the climate; 0 without a structure.
    weather: f64,
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
            weather: planet.structure.as_ref().map_or(0.0, |structure| structure.weather_share),
        }
    }

    /// Temperature in °C and moisture (not limited to 0 to 1) at the sine of a latitude, with noise for temperature
    /// and moisture.
    #[inline(always)]
    pub(crate) fn at(&self, sin_lat: f64, noise: [f64; 2], from_maps: MapClimate) -> [f64; 2] {
        self.lifted(sin_lat, [0.0; 2], noise, from_maps)
    }

    /// As [`Self::at`], colder by `less[0]` °C and drier by `less[1]`.
    #[inline(always)]
    fn lifted(&self, sin_lat: f64, less: [f64; 2], noise: [f64; 2], from_maps: MapClimate) -> [f64; 2] {
        let sin2_lat = sin_lat * sin_lat;
        let temperature_c =
            self.equator_c + self.warmer_c * sin2_lat - less[0] + self.temperature_variation_c * noise[0];
        let left = (1.0 - from_maps.inland_rad / self.sea_reach_rad).max(0.0);
        let belts = self.belts * belt(sin2_lat);
        let from_sea = self.sea_moisture * left * left;
        let moisture = self.moisture + belts + self.moisture_variation * noise[1] - less[1] + from_sea;
        // The solved weather replaces belts and sea. Without it, a product with 0 leaves every bit.
        let drier = self.weather * (from_maps.humidity - (self.moisture + belts + from_sea));
        [temperature_c + self.weather * from_maps.warmer_c, moisture + drier]
    }
}

/// The climate parameters of a planet, converted for evaluation.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Rules {
    sea_level: SeaLevelClimate,
    lapse_c_per_km: f64,
    drying_per_km: f64,
    /// The level that heights count from: the sea's, or 0.
    sea_m: f64,
    /// Temperature at the end of the table's last row, and the span from there to the end of the first.
    coldest_c: f64,
    range_c: f64,
    /// Whether the table's rows are temperatures; else they are heights.
    by_temperature: bool,
    /// Lower end of the last row (temperature or height), and the span from there to the end of the first.
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

    /// The climate at the sine of a latitude and a height of the ground, with noise for temperature and moisture.
    #[inline(always)]
    pub(crate) fn at(
        &self,
        sin_lat: f64,
        height_m: f64,
        noise: [f64; 2],
        from_maps: MapClimate,
        painted: &Painted,
    ) -> PointClimate {
        // Above the sea bed the surface is the sea's.
        let above_m = height_m - self.sea_m;
        let less = self.less(height_m);
        let [temperature_c, moisture] = self.sea_level.lifted(sin_lat, less, noise, from_maps);
        let temperature_c = painted.temperature.at_surface(temperature_c, less[0]);
        let moisture = painted.moisture.at_surface(moisture, less[1]);
        let temperature = (temperature_c - self.coldest_c) / self.range_c;
        let row = (if self.by_temperature { temperature_c } else { above_m } - self.lowest) / self.span;
        PointClimate {
            temperature_c,
            temperature: temperature.clamp(0.0, 1.0),
            moisture: moisture.clamp(0.0, 1.0),
            row: row.clamp(0.0, 1.0),
        }
    }

    /// How much colder and drier it is at a height of the ground than at sea level.
    #[inline(always)]
    fn less(&self, height_m: f64) -> [f64; 2] {
        let above_km = (height_m - self.sea_m).max(0.0) / 1000.0;
        [self.lapse_c_per_km * above_km, self.drying_per_km * above_km]
    }

    /// Temperature in °C and moisture at sea level that give the painted ones at a height of the ground.
    pub(crate) fn painted_at_sea(
        &self,
        [temperature_c, moisture]: [f64; 2],
        height_m: f64,
        paint: &Painted,
    ) -> [f64; 2] {
        let less = self.less(height_m);
        [paint.temperature.at_sea(temperature_c, less[0]), paint.moisture.at_sea(moisture, less[1])]
    }

    /// Lowest and greatest moisture and row at a point without paint, for any noise up to `most_noise` either way and
    /// any world maps.
    pub(crate) fn ranges(&self, sin_lat: f64, height_m: f64, most_noise: f64) -> [(f64, f64); 2] {
        let [driest, wettest] = MapClimate::EXTREMES;
        let low = self.at(sin_lat, height_m, [-most_noise; 2], driest, &Painted::NONE);
        let high = self.at(sin_lat, height_m, [most_noise; 2], wettest, &Painted::NONE);
        [(low.moisture, high.moisture), (low.row.min(high.row), low.row.max(high.row))]
    }

    /// Derivatives of moisture and row by height; 0 where they are limited.
    pub(crate) fn by_height(&self, height_m: f64, climate: &PointClimate, painted: &Painted) -> [f64; 2] {
        let over_sea = height_m > self.sea_m;
        let inside = |x: f64| x > 0.0 && x < 1.0;
        let moisture = if over_sea && inside(climate.moisture) {
            -self.drying_per_km / 1000.0 * painted.moisture.falls()
        } else {
            0.0
        };
        let row = match self.by_temperature {
            _ if !inside(climate.row) => 0.0,
            true if !over_sea => 0.0,
            true => -self.lapse_c_per_km / 1000.0 / self.span * painted.temperature.falls(),
            false => 1.0 / self.span,
        };
        [moisture, row]
    }
}

/// Moisture by latitude, -1 to 1: see [`CLIMATE_BELTS`].
#[inline(always)]
fn belt(sin2_lat: f64) -> f64 {
    let [c0, c1, c2, c3] = CLIMATE_BELTS;
    c0 + sin2_lat * (c1 + sin2_lat * (c2 + sin2_lat * c3))
}
