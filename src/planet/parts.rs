//! The other parts of a preset: climate, biomes, water, atmosphere, clouds, star.
//!
//! Colours are linear sRGB. Lengths, angles and rates are in the unit their name says; the parts that use them convert
//! to SI and radians.

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
        /// Swing of the temperature from place to place.
        temperature_variation_c: f64 = 5.0, "Temperature variation", Unit::Celsius, linear(0.0, 100.0), Stage::Climate;
        /// Moisture of a place that nothing else makes wet or dry; 0 is desert, 1 is rain forest.
        moisture: f64 = 0.5, "Moisture", Unit::None, linear(0.0, 1.0), Stage::Climate;
        /// Swing of the moisture from place to place.
        moisture_variation: f64 = 0.6, "Moisture variation", Unit::None, linear(0.0, 2.0), Stage::Climate;
        /// Strength of the belts: wet at the equator and in the middle latitudes, dry between them and at the poles.
        belts: f64 = 0.3, "Belts", Unit::None, linear(0.0, 1.0), Stage::Climate;
        /// How much drier it gets for each kilometre of height.
        drying_per_km: f64 = 0.06, "Drying with height", Unit::PerKilometre, linear(0.0, 1.0), Stage::Uniform;
        /// How much moister it is at the sea than far from it.
        sea_moisture: f64 = 0.0, "Moisture from the sea", Unit::None, linear(0.0, 1.0), Stage::Climate;
        /// How far moisture from the sea reaches inland; on the way it fades, fastest near the shore.
        sea_reach_km: f64 = 1500.0, "Reach of the sea", Unit::Kilometres, log(1.0, 20_000.0), Stage::Climate;
        /// Rain and snow in a year where the moisture is 1; elsewhere in proportion. For figures alone:
        /// nothing is drawn from it.
        wettest_mm: f64 = 3000.0, "Wettest", Unit::Millimetres, log(1.0, 30_000.0), Stage::Label;
        /// Size of the regions between which temperature and moisture vary.
        wavelength_km: f64 = 3000.0, "Region size", Unit::Kilometres, log(0.1, 100_000.0), Stage::ClimateNoise;
        /// How many octaves the variation has.
        octaves: u32 = 6, "Octaves", Unit::None, count(1, 16), Stage::ClimateNoise;
        /// Start of the variation's pseudo-random sequence.
        seed: u32 = 7, "Seed", Unit::None, Domain::Seed, Stage::ClimateNoise;
    }
}

choice! {
    /// What the biome table's rows stand for; its columns are always moisture, dry to wet.
    pub enum TableRows {
        /// Rows go from hot (first) to cold (last).
        Temperature = "Temperature",
        /// Rows go from high (first) to low (last).
        Elevation = "Elevation",
    }
}

choice! {
    /// What lies between the middles of two cells of the biome table.
    pub enum TableBlend {
        /// One ground passes into the other over the width of a cell.
        Linear = "Linear",
        /// One ground ends where the other begins.
        Crisp = "Crisp",
    }
}

params! {
    /// The look-up table that turns climate into ground: rows of one-letter keys over a palette of named biomes.
    pub struct Biomes {
        /// What the rows stand for: temperature (hot first) or elevation (high first). Columns are moisture, dry first.
        rows: TableRows = TableRows::Temperature, "Rows", Unit::None, Domain::Choice, Stage::Uniform;
        /// Temperature of the last row.
        coldest_c: f64 = -30.0, "Coldest", Unit::Celsius, linear(-270.0, 1000.0), Stage::Uniform;
        /// Temperature of the first row.
        hottest_c: f64 = 30.0, "Hottest", Unit::Celsius, linear(-270.0, 1000.0), Stage::Uniform;
        /// Height above the sea (or the reference sphere) of the last row, when rows are elevations.
        lowest_m: f64 = 0.0, "Lowest", Unit::Metres, linear(-50_000.0, 50_000.0), Stage::Uniform;
        /// Height above the sea (or the reference sphere) of the first row, when rows are elevations.
        highest_m: f64 = 6000.0, "Highest", Unit::Metres, linear(-50_000.0, 100_000.0), Stage::Uniform;
        /// What lies between the middles of two cells: a passage (Linear) or a border (Crisp).
        blend: TableBlend = TableBlend::Linear, "Blending", Unit::None, Domain::Choice, Stage::Uniform;
        /// How far noise moves the borders between biomes to and fro, so that neither the table's grid nor lines of
        /// equal climate show on the ground; 1 is up to about half a cell.
        border_jitter: f64 = 1.0, "Border jitter", Unit::None, linear(0.0, 4.0), Stage::Uniform;
        /// Slope at which bare rock begins to show through the biomes that share it.
        cliff_start_deg: f64 = 28.0, "Rock begins", Unit::Degrees, linear(0.0, 90.0), Stage::Material;
        /// Slope from which there is only bare rock.
        cliff_full_deg: f64 = 42.0, "Only rock", Unit::Degrees, linear(0.0, 90.0), Stage::Material;
        /// Colour of bare rock on steep ground.
        cliff_color: [f64; 3] = [0.16, 0.14, 0.12], "Rock", Unit::None, Domain::Color, Stage::Material;
        /// What bare rock looks like from near.
        cliff_detail: Detail = Detail::None, "Detail of rock", Unit::None, Domain::Choice, Stage::Material;
        /// Size of the pattern of bare rock, from one repeat to the next.
        cliff_detail_m: f64 = 6.0, "Size of rock", Unit::Metres, DETAIL_SIZE, Stage::Material;
        /// Beach lies where the ground is at most this far above or below the level of the sea; 0 is no beach.
        beach_m: f64 = 0.0, "Beach up to", Unit::Metres, log(0.0, 1000.0), Stage::Material;
        /// Key of the biome that beaches are of; the bed of shallow water beside them has its colour.
        beach_key: char = UNSET_KEY, "Beach", Unit::None, Domain::BiomeKey, Stage::Material;
        /// No beach is steeper than this.
        beach_steepest_deg: f64 = 15.0, "Steepest beach", Unit::Degrees, linear(0.0, 90.0), Stage::Material;
        /// Whether snow lies over the biomes where it is cold.
        snow: bool = false, "Snow", Unit::None, Domain::Flag, Stage::Material;
        /// Key of the biome that snow is of.
        snow_key: char = UNSET_KEY, "Snow is", Unit::None, Domain::BiomeKey, Stage::Material;
        /// Temperature at which snow covers half of the ground.
        snow_below_c: f64 = -6.0, "Snow below", Unit::Celsius, linear(-270.0, 1000.0), Stage::Material;
        /// From bare ground to full cover.
        snow_range_c: f64 = 4.0, "Range of snow", Unit::Celsius, linear(0.1, 100.0), Stage::Material;
        /// Steeper ground than this sheds its snow.
        snow_steepest_deg: f64 = 40.0, "Steepest snow", Unit::Degrees, linear(0.0, 90.0), Stage::Material;
    } with {
        /// The biomes that the table's letters stand for.
        palette: Vec<Biome> = vec![Biome::default()];
        /// The table: each string is a row, each letter a biome of the palette.
        table: Table = Table::uniform('a', 16, 12);
    }
}

params! {
    /// A sea that fills everything below its level.
    pub struct Water {
        /// Height of the sea's surface above the reference sphere.
        level_m: f64 = 0.0, "Level", Unit::Metres, linear(-50_000.0, 50_000.0), Stage::Climate | Stage::Uniform;
        /// How fast water swallows light on its way down and back; clear sea water swallows red first.
        absorption_per_m: [f64; 3] = [0.34, 0.0325, 0.00635], "Absorption", Unit::PerMetre, triple(10.0), Stage::Uniform;
        /// Colour of the light that deep water sends back.
        color: [f64; 3] = [0.004, 0.028, 0.052], "Deep colour", Unit::None, Domain::Color, Stage::Uniform;
        /// Wind over the sea: more wind, more waves, a wider glint.
        wind_m_s: f64 = 7.0, "Wind", Unit::MetresPerSecond, linear(0.0, 40.0), Stage::Uniform;
        /// Temperature below which the sea is frozen over.
        freezing_c: f64 = -12.0, "Freezes at", Unit::Celsius, linear(-300.0, 1000.0), Stage::Uniform;
        /// Colour of the ice on a frozen sea.
        ice_color: [f64; 3] = [0.72, 0.78, 0.84], "Ice", Unit::None, Domain::Color, Stage::Uniform;
    }
}

params! {
    /// The air: two kinds of scatterers that thin out with height, and one absorbing layer.
    pub struct Atmosphere {
        /// Thickness of the air above the reference sphere; above it there is none.
        height_km: f64 = 100.0, "Height", Unit::Kilometres, log(0.1, 5000.0), Stage::AirTables;
        /// Scattering by molecules at the reference sphere, for red, green and blue.
        rayleigh_per_km: [f64; 3] = [0.005802, 0.013558, 0.0331], "Rayleigh scattering", Unit::PerKilometre, triple(2.0), Stage::AirTables;
        /// Height over which molecules thin out by a factor of e.
        rayleigh_scale_km: f64 = 8.0, "Rayleigh scale", Unit::Kilometres, log(0.01, 500.0), Stage::AirTables;
        /// Scattering by dust and droplets at the reference sphere.
        mie_scattering_per_km: [f64; 3] = [0.003996, 0.003996, 0.003996], "Mie scattering", Unit::PerKilometre, triple(2.0), Stage::AirTables;
        /// Absorption by dust and droplets at the reference sphere.
        mie_absorption_per_km: [f64; 3] = [0.000444, 0.000444, 0.000444], "Mie absorption", Unit::PerKilometre, triple(2.0), Stage::AirTables;
        /// Height over which dust and droplets thin out by a factor of e.
        mie_scale_km: f64 = 1.2, "Mie scale", Unit::Kilometres, log(0.01, 500.0), Stage::AirTables;
        /// How much dust and droplets scatter forward: 0 is evenly, near 1 is a tight glow around the star.
        mie_anisotropy: f64 = 0.8, "Mie anisotropy", Unit::None, linear(-0.95, 0.95), Stage::AirTables;
        /// Absorption in the middle of the absorbing layer, such as ozone.
        absorber_per_km: [f64; 3] = [0.00065, 0.001881, 0.000085], "Absorber", Unit::PerKilometre, triple(2.0), Stage::AirTables;
        /// Height of the middle of the absorbing layer.
        absorber_height_km: f64 = 25.0, "Absorber height", Unit::Kilometres, log(0.0, 1000.0), Stage::AirTables;
        /// Distance from the middle of the absorbing layer to its edges.
        absorber_width_km: f64 = 15.0, "Absorber width", Unit::Kilometres, log(0.01, 500.0), Stage::AirTables;
        /// Share of light that the ground is taken to send back into the air.
        ground_albedo: [f64; 3] = [0.3, 0.3, 0.3], "Ground albedo", Unit::None, Domain::Color, Stage::AirTables;
    }
}

params! {
    /// A layer of clouds.
    pub struct Clouds {
        /// Share of the sky they cover.
        coverage: f64 = 0.5, "Coverage", Unit::None, linear(0.0, 1.0), Stage::Uniform;
        /// Size of the weather systems.
        scale_km: f64 = 2500.0, "Scale", Unit::Kilometres, log(1.0, 50_000.0), Stage::CloudMap;
        /// How far wind tears and curls the weather systems.
        curl: f64 = 0.6, "Curl", Unit::None, linear(0.0, 2.0), Stage::CloudMap;
        /// Start of the clouds' pseudo-random sequence.
        seed: u32 = 3, "Seed", Unit::None, Domain::Seed, Stage::CloudMap;
        /// Height of the bottom of the layer above the reference sphere.
        altitude_km: f64 = 3.0, "Altitude", Unit::Kilometres, log(0.05, 500.0), Stage::Uniform;
        /// Height from the bottom of the layer to its top.
        thickness_km: f64 = 2.0, "Thickness", Unit::Kilometres, log(0.01, 200.0), Stage::Uniform;
        /// Optical depth from top to bottom where the cover is full: 1 is a veil, 20 hides the star.
        density: f64 = 12.0, "Density", Unit::None, log(0.01, 200.0), Stage::Uniform;
        /// Size of the single clouds that one sees from near.
        puff_km: f64 = 6.0, "Puff size", Unit::Kilometres, log(0.05, 500.0), Stage::Uniform;
        /// Colour of the droplets.
        color: [f64; 3] = [0.98, 0.98, 0.98], "Colour", Unit::None, Domain::Color, Stage::Uniform;
        /// Speed at which the layer turns around the planet at the equator; negative blows to the west.
        wind_km_h: f64 = 60.0, "Wind", Unit::KilometresPerHour, linear(-2000.0, 2000.0), Stage::Uniform;
    }
}

params! {
    /// The star that lights the planet: where it stands over the planet at time zero, and how the planet turns under it.
    pub struct Star {
        /// Latitude over which the star stands overhead.
        latitude_deg: f64 = 12.0, "Latitude", Unit::Degrees, linear(-90.0, 90.0), Stage::Uniform;
        /// Longitude over which the star stands overhead.
        longitude_deg: f64 = 0.0, "Longitude", Unit::Degrees, linear(-180.0, 180.0), Stage::Uniform;
        /// Time from noon to noon; 0 if the star stands still.
        day_hours: f64 = 24.0, "Day length", Unit::Hours, log(0.0, 10_000.0), Stage::Uniform;
        /// Tilt of the planet's axis: how far north and south the star gets in a year. Seasons are set by it.
        tilt_deg: f64 = 23.4, "Axial tilt", Unit::Degrees, linear(0.0, 90.0), Stage::Label;
        /// Colour of its light (linear sRGB).
        color: [f64; 3] = [1.0, 0.97, 0.93], "Colour", Unit::None, Domain::Color, Stage::Uniform;
        /// Strength of its light on the planet; 1 is the Sun on the Earth.
        brightness: f64 = 1.0, "Brightness", Unit::None, log(0.0, 100.0), Stage::Uniform;
        /// Half the angle under which its disc is seen.
        radius_deg: f64 = 0.268, "Angular radius", Unit::Degrees, log(0.01, 20.0), Stage::AirTables;
    }
}

pub use super::table::Table;
