//! Climate, biomes, water, atmosphere, clouds and star of a preset.
//!
//! Colours are linear sRGB. Every other value is in the unit that its name says; the code that reads it converts to SI
//! and radians.

use super::biome::{Biome, DETAIL_SIZE, Detail, UNSET_KEY};
use super::param::{Domain, Stage, Unit, choice, count, linear, log, params, triple};

params! {
    /// Temperature and moisture over the globe.
    pub struct Climate {
        /// Temperature at sea level on the equator.
        equator_c: f64 = 28.0, "Equator", Unit::Celsius, linear(-270.0, 1000.0), Stage::Climate | Stage::Uniform;
        /// Temperature at sea level at the poles.
        pole_c: f64 = -28.0, "Poles", Unit::Celsius, linear(-270.0, 1000.0), Stage::Climate | Stage::Uniform;
        /// How much colder it gets for each kilometre of height.
        lapse_c_per_km: f64 = 6.5, "Lapse rate", Unit::CelsiusPerKilometre, linear(0.0, 30.0), Stage::Uniform;
        /// Amplitude of the temperature noise.
        temperature_variation_c: f64 = 5.0, "Temp. variation", Unit::Celsius, linear(0.0, 100.0), Stage::Climate;
        /// Moisture before noise, belts, height and sea are added; 0 is desert, 1 is rain forest.
        moisture: f64 = 0.5, "Moisture", Unit::None, linear(0.0, 1.0), Stage::Climate;
        /// Amplitude of the moisture noise.
        moisture_variation: f64 = 0.6, "Moisture variation", Unit::None, linear(0.0, 2.0), Stage::Climate;
        /// Strength of the climate belts: wet at the equator and at 50° latitude, dry at 25° and at the poles.
        belts: f64 = 0.3, "Belts", Unit::None, linear(0.0, 1.0), Stage::Climate | Stage::CloudMap;
        /// How much drier it gets for each kilometre of height.
        drying_per_km: f64 = 0.06, "Drying with height", Unit::PerKilometre, linear(0.0, 1.0), Stage::Uniform;
        /// Moisture that the sea adds at the coast.
        sea_moisture: f64 = 0.0, "Coastal moisture", Unit::None, linear(0.0, 1.0), Stage::Climate;
        /// Distance inland at which the moisture from the sea has faded to 0. It fades fastest near the coast.
        sea_reach_km: f64 = 1500.0, "Coastal reach", Unit::Kilometres, log(1.0, 20_000.0), Stage::Climate;
        /// Precipitation in a year where the moisture is 1; elsewhere in proportion. Only shown as a figure; nothing is
        /// drawn from it.
        wettest_mm: f64 = 3000.0, "Rain at moisture 1", Unit::Millimetres, log(1.0, 30_000.0), Stage::Label;
        /// Wavelength of the coarsest octave of the temperature and moisture noise.
        wavelength_km: f64 = 3000.0, "Region size", Unit::Kilometres, log(0.1, 100_000.0), Stage::ClimateNoise;
        /// Number of octaves of the temperature and moisture noise.
        octaves: u32 = 6, "Octaves", Unit::None, count(1, 16), Stage::ClimateNoise;
        /// Seed of the temperature and moisture noise.
        seed: u32 = 7, "Seed", Unit::None, Domain::Seed, Stage::ClimateNoise;
    }
}

/// The climate belts as a cubic in sin² latitude, by ascending power: wet at the equator (1) and at 50° (0.6), dry at
/// 25° and at the poles (-1). Moisture gains half of it times [`Climate::belts`]; clouds follow the same curve.
pub const CLIMATE_BELTS: [f64; 4] = [1.0, -19.404_782, 52.369_621, -34.964_839];

choice! {
    /// The quantity that selects the row of the biome table. Moisture selects the column.
    pub enum TableRows {
        /// Rows go from hot (first) to cold (last).
        Temperature = "Temperature",
        /// Rows go from high (first) to low (last).
        Elevation = "Elevation",
    }
}

choice! {
    /// The transition between two cells of the biome table.
    pub enum TableBlend {
        /// One biome blends into the other over the width of a cell.
        Linear = "Linear",
        /// A sharp border.
        Crisp = "Crisp",
    }
}

params! {
    /// The biome table: rows of one-letter keys over a palette of named biomes, selected by climate.
    pub struct Biomes {
        /// Quantity of the rows: temperature (hottest first) or elevation (highest first). Columns are moisture, driest
        /// first.
        rows: TableRows = TableRows::Temperature, "Rows", Unit::None, Domain::Choice, Stage::Uniform;
        /// Temperature of the last row.
        coldest_c: f64 = -30.0, "Coldest", Unit::Celsius, linear(-270.0, 1000.0), Stage::Uniform;
        /// Temperature of the first row.
        hottest_c: f64 = 30.0, "Hottest", Unit::Celsius, linear(-270.0, 1000.0), Stage::Uniform;
        /// Height above sea level (or the reference sphere, without a sea) of the last row, if rows are elevations.
        lowest_m: f64 = 0.0, "Lowest", Unit::Metres, linear(-50_000.0, 50_000.0), Stage::Uniform;
        /// Height above sea level (or the reference sphere, without a sea) of the first row, if rows are elevations.
        highest_m: f64 = 6000.0, "Highest", Unit::Metres, linear(-50_000.0, 100_000.0), Stage::Uniform;
        /// Transition between two cells: a blend (Linear) or a sharp border (Crisp).
        blend: TableBlend = TableBlend::Linear, "Blending", Unit::None, Domain::Choice, Stage::Uniform;
        /// Border jitter: how far noise moves the borders between biomes, so that neither the cells of the table nor
        /// lines of equal climate show on the ground; 1 is up to about half a cell.
        border_jitter: f64 = 1.0, "Border jitter", Unit::None, linear(0.0, 4.0), Stage::Uniform;
        /// Slope at which bare rock begins to replace the biomes whose steep ground is Rock.
        cliff_start_deg: f64 = 28.0, "Rock starts at", Unit::Degrees, linear(0.0, 90.0), Stage::Material;
        /// Slope from which those biomes are bare rock only.
        cliff_full_deg: f64 = 42.0, "Bare rock from", Unit::Degrees, linear(0.0, 90.0), Stage::Material;
        /// Colour of bare rock on steep ground.
        cliff_color: [f64; 3] = [0.16, 0.14, 0.12], "Rock colour", Unit::None, Domain::Color, Stage::Material;
        /// Close-up pattern of bare rock.
        cliff_detail: Detail = Detail::None, "Rock detail", Unit::None, Domain::Choice, Stage::Material;
        /// Period of the pattern of bare rock.
        cliff_detail_m: f64 = 6.0, "Rock detail size", Unit::Metres, DETAIL_SIZE, Stage::Material;
        /// Beaches cover ground up to this height above and below sea level; 0 means no beaches.
        beach_m: f64 = 0.0, "Beach height", Unit::Metres, log(0.0, 1000.0), Stage::Material;
        /// Key of the biome of beaches. The bed of shallow water beside a beach has its colour.
        beach_key: char = UNSET_KEY, "Beach biome", Unit::None, Domain::BiomeKey, Stage::Material;
        /// Ground steeper than this is no beach.
        beach_steepest_deg: f64 = 15.0, "Beach max slope", Unit::Degrees, linear(0.0, 90.0), Stage::Material;
        /// Whether snow lies over the biomes where it is cold.
        snow: bool = false, "Snow cover", Unit::None, Domain::Flag, Stage::Material;
        /// Key of the biome of snow.
        snow_key: char = UNSET_KEY, "Snow biome", Unit::None, Domain::BiomeKey, Stage::Material;
        /// Temperature at which snow covers half of the ground.
        snow_below_c: f64 = -6.0, "Half covered at", Unit::Celsius, linear(-270.0, 1000.0), Stage::Material;
        /// Range of temperature from bare ground to full snow cover.
        snow_range_c: f64 = 4.0, "Snow transition", Unit::Celsius, linear(0.1, 100.0), Stage::Material;
        /// Ground steeper than this sheds its snow.
        snow_steepest_deg: f64 = 40.0, "Snow max slope", Unit::Degrees, linear(0.0, 90.0), Stage::Material;
    } with {
        /// The biomes that the letters of the table refer to.
        palette: Vec<Biome> = vec![Biome::default()];
        /// The biome table: each string is a row, each letter the key of a biome in the palette.
        table: Table = Table::uniform('a', 16, 12);
    }
}

params! {
    /// A sea that fills everything below sea level.
    pub struct Water {
        /// Sea level: height of the sea above the reference sphere.
        level_m: f64 = 0.0, "Sea level", Unit::Metres, linear(-50_000.0, 50_000.0), Stage::Climate | Stage::Uniform;
        /// Absorption of light in water. Clear sea water absorbs red most.
        absorption_per_m: [f64; 3] = [0.34, 0.0325, 0.00635], "Absorption", Unit::PerMetre, triple(10.0), Stage::Uniform;
        /// Colour of the light that deep water scatters back.
        color: [f64; 3] = [0.004, 0.028, 0.052], "Deep colour", Unit::None, Domain::Color, Stage::Uniform;
        /// Wind over the sea. More wind makes steeper waves and a wider glint.
        wind_m_s: f64 = 7.0, "Wind", Unit::MetresPerSecond, linear(0.0, 40.0), Stage::Uniform;
        /// Length of open water that the wind blows over. Waves are highest from some hundred kilometres on.
        fetch_km: f64 = 1000.0, "Fetch", Unit::Kilometres, log(0.1, 10_000.0), Stage::Uniform;
        /// Height of the swell: long waves from storms far away.
        swell_m: f64 = 0.5, "Swell", Unit::Metres, linear(0.0, 20.0), Stage::Uniform;
        /// Temperature below which the sea is frozen.
        freezing_c: f64 = -12.0, "Freezes at", Unit::Celsius, linear(-300.0, 1000.0), Stage::Uniform;
        /// Colour of the ice on a frozen sea.
        ice_color: [f64; 3] = [0.72, 0.78, 0.84], "Ice colour", Unit::None, Domain::Color, Stage::Uniform;
        /// Width of the greatest ice floes. Between them is open water; 0 is ice without gaps.
        floe_m: f64 = 3000.0, "Floe size", Unit::Metres, log(0.0, 100_000.0), Stage::Uniform;
        /// Light that the sea gives off by itself, as lava does: 1 is as bright as white ground in the sun.
        glow: f64 = 0.0, "Glow", Unit::None, log(0.0, 100.0), Stage::Uniform;
        /// Colour of that light.
        glow_color: [f64; 3] = [1.0, 0.25, 0.03], "Glow colour", Unit::None, Domain::Color, Stage::Uniform;
    }
}

params! {
    /// The atmosphere: two kinds of scatterers whose density falls with height, and one absorbing layer.
    pub struct Atmosphere {
        /// Height of the top of the atmosphere above the reference sphere.
        height_km: f64 = 100.0, "Height", Unit::Kilometres, log(0.1, 5000.0), Stage::OpticalDepth;
        /// Scattering by molecules at the reference sphere, for red, green and blue.
        rayleigh_per_km: [f64; 3] = [0.005802, 0.013558, 0.0331], "Rayleigh scattering", Unit::PerKilometre, triple(2.0), Stage::OpticalDepth;
        /// Height over which the density of molecules falls by a factor of e.
        rayleigh_scale_km: f64 = 8.0, "Rayleigh scale", Unit::Kilometres, log(0.01, 500.0), Stage::OpticalDepth;
        /// Scattering by dust and droplets at the reference sphere.
        mie_scattering_per_km: [f64; 3] = [0.003996, 0.003996, 0.003996], "Mie scattering", Unit::PerKilometre, triple(2.0), Stage::OpticalDepth;
        /// Absorption by dust and droplets at the reference sphere.
        mie_absorption_per_km: [f64; 3] = [0.000444, 0.000444, 0.000444], "Mie absorption", Unit::PerKilometre, triple(2.0), Stage::OpticalDepth;
        /// Height over which the density of dust and droplets falls by a factor of e.
        mie_scale_km: f64 = 1.2, "Mie scale", Unit::Kilometres, log(0.01, 500.0), Stage::OpticalDepth;
        /// Forward scattering of dust and droplets: 0 scatters evenly, near 1 makes a tight glow around the star.
        mie_anisotropy: f64 = 0.8, "Mie anisotropy", Unit::None, linear(-0.95, 0.95), Stage::AirTables;
        /// Absorption in the middle of the absorbing layer, such as ozone.
        absorber_per_km: [f64; 3] = [0.00065, 0.001881, 0.000085], "Absorption", Unit::PerKilometre, triple(2.0), Stage::OpticalDepth;
        /// Height of the middle of the absorbing layer.
        absorber_height_km: f64 = 25.0, "Absorber altitude", Unit::Kilometres, log(0.0, 1000.0), Stage::OpticalDepth;
        /// Distance from the middle of the absorbing layer to its edges.
        absorber_width_km: f64 = 15.0, "Absorber width", Unit::Kilometres, log(0.01, 500.0), Stage::OpticalDepth;
        /// Albedo of the ground, as the light in the atmosphere assumes it.
        ground_albedo: [f64; 3] = [0.3, 0.3, 0.3], "Ground albedo", Unit::None, Domain::Color, Stage::AirTables;
        /// Brightness of the aurora at night: 1 is a bright one of the Earth, 0 is none.
        aurora: f64 = 0.0, "Aurora", Unit::None, linear(0.0, 10.0), Stage::Uniform;
        /// Magnetic latitude of the aurora. The magnetic poles are 10° from the poles.
        aurora_lat_deg: f64 = 67.0, "Aurora latitude", Unit::Degrees, linear(30.0, 88.0), Stage::Uniform;
    }
}

/// Most cyclones that live at a time.
pub const MAX_CYCLONES: u32 = 96;

params! {
    /// Clouds in four layers: fog, low clouds, middle clouds and a veil of ice.
    pub struct Clouds {
        /// Share of the sky covered by low clouds.
        coverage: f64 = 0.5, "Low cover", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Size of the weather systems.
        scale_km: f64 = 2500.0, "System size", Unit::Kilometres, log(1.0, 50_000.0), Stage::CloudMap;
        /// How strongly wind curls the weather systems.
        curl: f64 = 0.6, "Curl", Unit::None, linear(0.0, 2.0), Stage::CloudMap;
        /// Strength of cyclones: comma-shaped ones of middle latitudes, and tropical ones with an eye. 0 is none.
        storms: f64 = 0.6, "Cyclone strength", Unit::None, linear(0.0, 1.0), Stage::CloudMap;
        /// Number of cyclones that live at a time, most of them in the middle latitudes.
        cyclones: u32 = 24, "Cyclones", Unit::None, count(0, MAX_CYCLONES), Stage::CloudMap;
        /// Seed of the cloud noise.
        seed: u32 = 3, "Seed", Unit::None, Domain::Seed, Stage::CloudMap;
        /// Height of the bottom of the low clouds above the reference sphere.
        altitude_km: f64 = 3.0, "Altitude", Unit::Kilometres, log(0.05, 500.0), Stage::Uniform;
        /// Height from the bottom of the low clouds to their top.
        thickness_km: f64 = 2.0, "Thickness", Unit::Kilometres, log(0.01, 200.0), Stage::Uniform;
        /// Optical depth from top to bottom where the sky is fully covered: 1 is a veil, 20 hides the star.
        density: f64 = 12.0, "Density", Unit::None, log(0.01, 200.0), Stage::Uniform;
        /// Size of single clouds.
        puff_km: f64 = 6.0, "Puff size", Unit::Kilometres, log(0.05, 500.0), Stage::Uniform;
        /// Type of the low clouds: -1 is heaps everywhere, 0 is heaps in the tropics and decks towards the poles and in
        /// cyclones, 1 is decks everywhere.
        layering: f64 = 0.0, "Cloud type", Unit::None, linear(-1.0, 1.0), Stage::Uniform;
        /// How far thunderclouds tower over small heaps and decks, and spread into anvils: at 0 all clouds fill the
        /// layer, at 1 only thunderclouds reach its top.
        towers: f64 = 0.0, "Towers", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Density of the rain under thunderclouds and thick decks: 0 is dry, 1 hides what lies behind.
        rain: f64 = 0.0, "Rain", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Colour of the droplets.
        color: [f64; 3] = [0.98, 0.98, 0.98], "Colour", Unit::None, Domain::Color, Stage::Uniform;
        /// Speed of the clouds at the equator; positive is eastward, negative westward.
        wind_km_h: f64 = 60.0, "Wind", Unit::KilometresPerHour, linear(-2000.0, 2000.0), Stage::Uniform;
        /// Share of the sky covered by middle clouds.
        middle: f64 = 0.0, "Middle cover", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Clear air between the top of the low clouds and the middle clouds.
        middle_gap_km: f64 = 1.0, "Middle gap", Unit::Kilometres, log(0.0, 200.0), Stage::Uniform;
        /// Height from the bottom of the middle clouds to their top.
        middle_thickness_km: f64 = 0.6, "Middle thickness", Unit::Kilometres, log(0.01, 100.0), Stage::Uniform;
        /// Optical depth of the middle clouds where they cover the sky.
        middle_density: f64 = 4.0, "Middle density", Unit::None, log(0.01, 100.0), Stage::Uniform;
        /// Size of single middle clouds.
        middle_puff_km: f64 = 1.5, "Middle puff size", Unit::Kilometres, log(0.05, 500.0), Stage::Uniform;
        /// Share of the sky covered by a veil of high ice clouds.
        veil: f64 = 0.1, "Veil cover", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Height of the veil above the top of the low clouds. It never lies under the middle clouds.
        veil_gap_km: f64 = 3.0, "Veil gap", Unit::Kilometres, log(0.0, 200.0), Stage::Uniform;
        /// Optical depth of the veil where it covers the sky.
        veil_density: f64 = 0.6, "Veil density", Unit::None, log(0.01, 20.0), Stage::Uniform;
        /// Share of the globe under banks of fog. Mountains and islands stand out of them.
        fog: f64 = 0.0, "Fog cover", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Height of the bottom of the fog above the sea, or above the reference sphere where there is none. Fog under
        /// the ground is not seen.
        fog_altitude_km: f64 = 0.0, "Fog altitude", Unit::Kilometres, linear(-20.0, 20.0), Stage::Uniform;
        /// Height from the bottom of the fog to its top.
        fog_thickness_km: f64 = 0.3, "Fog thickness", Unit::Kilometres, log(0.01, 20.0), Stage::Uniform;
        /// Optical depth of the fog from top to bottom.
        fog_density: f64 = 6.0, "Fog density", Unit::None, log(0.01, 200.0), Stage::Uniform;
    }
}

params! {
    /// The star that lights the planet: its position over the planet at time zero, and the rotation of the planet.
    pub struct Star {
        /// Latitude at which the star is overhead.
        latitude_deg: f64 = 12.0, "Latitude", Unit::Degrees, linear(-90.0, 90.0), Stage::Uniform;
        /// Longitude at which the star is overhead at time zero.
        longitude_deg: f64 = 0.0, "Longitude", Unit::Degrees, linear(-180.0, 180.0), Stage::Uniform;
        /// Time from noon to noon; 0 means that the star does not move.
        day_hours: f64 = 24.0, "Day length", Unit::Hours, log(0.0, 10_000.0), Stage::Uniform;
        /// Tilt of the planet's axis: the greatest latitude of the star in a year. The Season control reads it.
        tilt_deg: f64 = 23.4, "Axial tilt", Unit::Degrees, linear(0.0, 90.0), Stage::Label;
        /// Colour of the light (linear sRGB).
        color: [f64; 3] = [1.0, 0.97, 0.93], "Colour", Unit::None, Domain::Color, Stage::Uniform;
        /// Brightness of the light on the planet; 1 is the Sun on the Earth.
        brightness: f64 = 1.0, "Brightness", Unit::None, log(0.0, 100.0), Stage::Uniform;
        /// Angular radius of the star's disc.
        radius_deg: f64 = 0.268, "Angular radius", Unit::Degrees, log(0.01, 20.0), Stage::AirTables;
    }
}

pub use super::table::Table;
