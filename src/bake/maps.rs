//! The maps that can be baked: their names, units and ranges, and the values of each at a point.
//!
//! A value is what [`Terrain::sample`](crate::terrain::Terrain::sample) and
//! [`CloudField::cover`](crate::clouds::CloudField::cover) answer at the point, as a float of 32 bits.

use crate::clouds::CloudCover;
use crate::life::Canopies;
use crate::planet::{Biome, Planet, Water};
use crate::sphere::geo::east_north;
use crate::terrain::{Sample, Wanted};
use glam::DVec3;

/// Most channels of a map.
pub(super) const MOST_CHANNELS: usize = 3;

/// A map of a planet.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum Map {
    /// Height of the ground above the reference sphere, below the sea too; metres.
    Height,
    /// Unit normal of the ground along east, north and up.
    Normal,
    /// Unit normal of the ground in the planet frame.
    NormalPlanet,
    /// Angle between the ground and the horizontal, degrees.
    Slope,
    /// Temperature at the surface, °C.
    Temperature,
    /// Rain and snow of the climate, mm a year.
    Precipitation,
    /// Moisture of the climate, 0 to 1: the columns of the biome table.
    Moisture,
    /// Rain and snow of the structure's weather (without a structure, of the climate), mm a year.
    Rain,
    /// Index of the biome in the palette.
    Biome,
    /// Mean colour, linear sRGB, of the biome through the water over it and of the plants and stones on it: without
    /// macro variation, steep rock that shows through, floes or clouds.
    Albedo,
    /// Roughness of the biome, 0 to 1.
    Roughness,
    /// Ambient occlusion: how much of the sky over the ground the ground around leaves open, 0 to 1.
    AmbientOcclusion,
    /// Share of the ground that plants and stones cover, as seen from above, 0 to 1.
    Canopy,
    /// Mean height of the plants and stones, metres.
    CanopyHeight,
    /// Lights of settlements at night, linear sRGB; sunlit white ground has 1.
    NightLights,
    /// Depth of sea, lake or river over the ground; 0 on land; metres.
    WaterDepth,
    /// Water that flows by in the nearest river, if one is near; else 0; m³/s.
    Discharge,
    /// Direction in which that river flows, along east, north and up (which is 0); 0 without one.
    Flow,
    /// Share of the sky that low clouds cover, 0 to 1.
    CloudCover,
    /// Share that middle clouds cover, 0 to 1.
    MiddleCover,
    /// Share that the veil covers, 0 to 1.
    VeilCover,
    /// Share of the ground that fog covers, 0 to 1.
    FogCover,
}

/// The numbers that a map runs between.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Range {
    /// The same for every planet.
    Fixed(f64, f64),
    /// From the least to the greatest value of the map.
    Found,
    /// Whole numbers that are stored as they are.
    Numbers,
}

/// What is known of a point.
pub(super) struct Site<'a> {
    pub(super) planet: &'a Planet,
    pub(super) dir: DVec3,
    pub(super) sample: &'a Sample,
    pub(super) clouds: CloudCover,
    /// The share of the sky that is open.
    pub(super) open: f64,
    pub(super) lights: [f64; 3],
    pub(super) canopies: &'a Canopies,
}

impl Map {
    /// All of them.
    pub const ALL: [Map; 22] = [
        Map::Height,
        Map::Normal,
        Map::NormalPlanet,
        Map::Slope,
        Map::Temperature,
        Map::Precipitation,
        Map::Moisture,
        Map::Rain,
        Map::Biome,
        Map::Albedo,
        Map::Roughness,
        Map::AmbientOcclusion,
        Map::Canopy,
        Map::CanopyHeight,
        Map::NightLights,
        Map::WaterDepth,
        Map::Discharge,
        Map::Flow,
        Map::CloudCover,
        Map::MiddleCover,
        Map::VeilCover,
        Map::FogCover,
    ];

    /// Its name on the command line and in the names of files.
    pub fn name(self) -> &'static str {
        match self {
            Map::Height => "height",
            Map::Normal => "normal",
            Map::NormalPlanet => "normal_planet",
            Map::Slope => "slope",
            Map::Temperature => "temperature",
            Map::Precipitation => "precipitation",
            Map::Moisture => "moisture",
            Map::Rain => "rain",
            Map::Biome => "biome",
            Map::Albedo => "albedo",
            Map::Roughness => "roughness",
            Map::AmbientOcclusion => "ambient_occlusion",
            Map::Canopy => "canopy",
            Map::CanopyHeight => "canopy_height",
            Map::NightLights => "night_lights",
            Map::WaterDepth => "water_depth",
            Map::Discharge => "discharge",
            Map::Flow => "flow",
            Map::CloudCover => "cloud_cover",
            Map::MiddleCover => "middle_cover",
            Map::VeilCover => "veil_cover",
            Map::FogCover => "fog_cover",
        }
    }

    /// The map of a name.
    pub fn named(name: &str) -> Option<Self> {
        Self::ALL.into_iter().find(|map| map.name() == name)
    }

    /// Its name for a person.
    pub fn label(self) -> &'static str {
        match self {
            Map::Height => "Height",
            Map::Normal => "Normal",
            Map::NormalPlanet => "Planet normal",
            Map::Slope => "Slope",
            Map::Temperature => "Temperature",
            Map::Precipitation => "Precipitation",
            Map::Moisture => "Moisture",
            Map::Rain => "Rain",
            Map::Biome => "Biome numbers",
            Map::Albedo => "Albedo",
            Map::Roughness => "Roughness",
            Map::AmbientOcclusion => "Ambient occlusion",
            Map::Canopy => "Canopy",
            Map::CanopyHeight => "Canopy height",
            Map::NightLights => "Night lights",
            Map::WaterDepth => "Water depth",
            Map::Discharge => "Discharge",
            Map::Flow => "Flow",
            Map::CloudCover => "Low clouds",
            Map::MiddleCover => "Middle clouds",
            Map::VeilCover => "Veil",
            Map::FogCover => "Fog",
        }
    }

    /// What its values are, as a sentence without a full stop.
    pub fn told(self) -> &'static str {
        match self {
            Map::Height => "Metres above the reference sphere, below the sea too",
            Map::Normal => "Unit normal along east, north and up",
            Map::NormalPlanet => "Unit normal along the axes of the planet, for a globe in one piece",
            Map::Slope => "Degrees",
            Map::Temperature => "°C at the surface",
            Map::Precipitation => "Rain and snow of the climate, mm a year",
            Map::Moisture => "The columns of the biome table, 0 to 1",
            Map::Rain => "Rain and snow of the structure's weather, mm a year",
            Map::Biome => "Index into the palette, which the JSON lists",
            Map::Albedo => "Mean colour of the biome through the water over it, and of what stands there",
            Map::Roughness => "Of the biome, 0 to 1",
            Map::AmbientOcclusion => "Share of the sky that the ground around leaves open; 1 is all",
            Map::Canopy => "Share of the ground that plants and stones cover, as seen from above",
            Map::CanopyHeight => "Mean height of the plants and stones in metres",
            Map::NightLights => "Towns, as they are drawn from afar",
            Map::WaterDepth => "Metres of sea, lake or river over the ground",
            Map::Discharge => "m³/s of the nearest river, if one is near",
            Map::Flow => "Direction of the nearest river along east, north and up",
            Map::CloudCover | Map::MiddleCover | Map::VeilCover => "Share of the sky at the time of the view",
            Map::FogCover => "Share of the ground at the time of the view",
        }
    }

    /// The unit of its values; empty for shares and numbers.
    pub fn unit(self) -> &'static str {
        match self {
            Map::Height | Map::WaterDepth | Map::CanopyHeight => "m",
            Map::Slope => "deg",
            Map::Temperature => "C",
            Map::Precipitation | Map::Rain => "mm/year",
            Map::Discharge => "m3/s",
            _ => "",
        }
    }

    /// Numbers at each pixel: 1, or 3 of a vector or colour.
    pub fn channels(self) -> usize {
        let has_many = matches!(self, Map::Normal | Map::NormalPlanet | Map::Albedo | Map::NightLights | Map::Flow);
        if has_many { MOST_CHANNELS } else { 1 }
    }

    pub(super) fn range(self) -> Range {
        match self {
            Map::Height
            | Map::Temperature
            | Map::Precipitation
            | Map::Rain
            | Map::CanopyHeight
            | Map::NightLights
            | Map::WaterDepth
            | Map::Discharge => Range::Found,
            Map::Normal | Map::NormalPlanet | Map::Flow => Range::Fixed(-1.0, 1.0),
            Map::Slope => Range::Fixed(0.0, 90.0),
            Map::Biome => Range::Numbers,
            _ => Range::Fixed(0.0, 1.0),
        }
    }

    /// Whether it shows what stands on the ground.
    pub(super) fn shows_life(self) -> bool {
        matches!(self, Map::Albedo | Map::Canopy | Map::CanopyHeight)
    }

    /// Whether it shows clouds, which change with time.
    pub fn is_of_clouds(self) -> bool {
        matches!(self, Map::CloudCover | Map::MiddleCover | Map::VeilCover | Map::FogCover)
    }

    /// What it asks of the terrain; None for nothing.
    pub(super) fn wanted(self) -> Option<Wanted> {
        let height = Wanted::HEIGHT;
        match self {
            Map::Height | Map::AmbientOcclusion => Some(height),
            Map::NightLights => Some(height.and_climate().and_water()),
            Map::Normal | Map::NormalPlanet | Map::Slope => Some(height.and_normal()),
            Map::Temperature | Map::Precipitation | Map::Moisture => Some(height.and_climate()),
            Map::Biome | Map::Roughness => Some(height.and_biome()),
            Map::Albedo | Map::Canopy | Map::CanopyHeight => Some(height.and_biome().and_water()),
            Map::Rain | Map::WaterDepth | Map::Discharge | Map::Flow => Some(height.and_water()),
            Map::CloudCover | Map::MiddleCover | Map::VeilCover | Map::FogCover => None,
        }
    }

    /// Why a planet has no such map, if it has none.
    pub fn missing(self, planet: &Planet) -> Option<&'static str> {
        match self {
            _ if planet.giant.is_some() && !self.is_of_clouds() => Some("no ground: it is a gas giant"),
            Map::WaterDepth if planet.water.is_none() && planet.structure.is_none() => {
                Some("neither a sea nor a structure, so it has no water")
            }
            Map::NightLights if planet.settlements <= 0.0 => Some("no settlements"),
            Map::NightLights if planet.water.is_none() => Some("no sea, by which settlements lie"),
            Map::Discharge | Map::Flow if planet.structure.is_none() => Some("no structure, so it has no rivers"),
            Map::Canopy | Map::CanopyHeight if planet.life.iter().all(|population| !population.enabled) => {
                Some("nothing that stands on the ground")
            }
            _ if self.is_of_clouds() && planet.clouds.is_none() => Some("no clouds"),
            _ => None,
        }
    }

    /// Its values at a point, one for each channel.
    pub(super) fn values(self, site: &Site<'_>) -> [f32; MOST_CHANNELS] {
        let Site { planet, dir, sample, clouds, open, lights, canopies } = site;
        let local = |vector: DVec3| {
            let (east, north) = east_north(*dir);
            [vector.dot(east), vector.dot(north), vector.dot(*dir)]
        };
        let biome = || planet.biomes.palette.get(sample.biome);
        let values = match self {
            Map::Height => [sample.height_m, 0.0, 0.0],
            Map::Normal => local(sample.normal_planet),
            Map::NormalPlanet => sample.normal_planet.to_array(),
            Map::Slope => [sample.slope_rad.to_degrees(), 0.0, 0.0],
            Map::Temperature => [sample.temperature_c, 0.0, 0.0],
            Map::Precipitation => [sample.precipitation_mm, 0.0, 0.0],
            Map::Moisture => [sample.moisture, 0.0, 0.0],
            Map::Rain => [sample.rain_mm, 0.0, 0.0],
            Map::Biome => [sample.biome as f64, 0.0, 0.0],
            Map::Albedo => biome().map_or([0.0; 3], |biome| {
                canopies.albedo(*dir, sample, through_water(planet, sample, mean_color(biome)))
            }),
            Map::Roughness => [biome().map_or(1.0, |biome| biome.roughness), 0.0, 0.0],
            Map::AmbientOcclusion => [*open, 0.0, 0.0],
            Map::Canopy => [canopies.at(*dir, sample).cover, 0.0, 0.0],
            Map::CanopyHeight => [canopies.at(*dir, sample).height_m, 0.0, 0.0],
            Map::NightLights => *lights,
            Map::WaterDepth => [depth_m(sample), 0.0, 0.0],
            Map::Discharge => [sample.river.map_or(0.0, |river| river.discharge_m3_s), 0.0, 0.0],
            Map::Flow => sample.river.map_or([0.0; 3], |river| local(river.flow_planet)),
            Map::CloudCover => [clouds.low, 0.0, 0.0],
            Map::MiddleCover => [clouds.middle, 0.0, 0.0],
            Map::VeilCover => [clouds.veil, 0.0, 0.0],
            Map::FogCover => [clouds.fog, 0.0, 0.0],
        };
        values.map(|value| value as f32)
    }
}

/// Colour of a biome over all of its patches.
pub(super) fn mean_color(biome: &Biome) -> [f64; 3] {
    std::array::from_fn(|k| biome.color[k] + (biome.patch_color[k] - biome.color[k]) * biome.patches)
}

/// Depth of the water over the ground.
pub(super) fn depth_m(sample: &Sample) -> f64 {
    sample.water_level_m.map_or(0.0, |level_m| level_m - sample.height_m)
}

/// The colour of the ground through the water over it, seen and lit from straight above: light passes the water twice
/// (Beer, Lambert), and deep water scatters its own colour back. Lakes have the water of the sea, or common water.
pub(super) fn through_water(planet: &Planet, sample: &Sample, ground: [f64; 3]) -> [f64; 3] {
    let depth_m = depth_m(sample);
    if depth_m <= 0.0 {
        return ground;
    }
    let common = Water::default();
    let water = planet.water.as_ref().unwrap_or(&common);
    std::array::from_fn(|k| {
        let passed = libm::exp(-2.0 * depth_m * water.absorption_per_m[k]);
        water.color[k] + (ground[k] - water.color[k]) * passed
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_lead_back_to_maps() {
        for map in Map::ALL {
            assert_eq!(Map::named(map.name()), Some(map));
            assert!(map.wanted().is_some() != map.is_of_clouds(), "{map:?}");
        }
        assert_eq!(Map::named("heights"), None);
    }

    #[test]
    fn deep_water_hides_the_ground() {
        let planet = Planet { water: Some(Water::default()), ..Planet::default() };
        let deep = planet.water.as_ref().unwrap().color;
        let seen = |depth_m: f64| {
            let sample = Sample { water_level_m: Some(depth_m), ..Sample::default() };
            through_water(&planet, &sample, [0.5; 3])
        };
        assert_eq!(seen(-1.0), [0.5; 3]);
        assert!(seen(20_000.0).iter().zip(deep).all(|(seen, deep)| (seen - deep).abs() < 1e-6));
        assert!(seen(1.0)[0] < 0.5 && seen(1.0)[0] > seen(3.0)[0]);
    }
}
