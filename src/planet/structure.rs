//! Structure of a preset: plates that push up land, weather that rains on it, rivers that carve it.
//!
//! Widths and speeds are those of a planet of the Earth's size. On another planet each width is the same share of the
//! radius, so that every planet has the same layout, large or small. Heights and depths are true metres everywhere.

use super::param::{Domain, Stage, Unit, choice, count, linear, log, params};

/// Most grids of a structure.
pub const MAX_GRIDS: u32 = 5;
/// Most plates of a structure.
pub const MAX_PLATES: u32 = 60;

params! {
    /// Large-scale structure of a planet.
    pub struct Structure {
        /// Number of grids on which rivers are solved, coarse to fine. The first has 64 cells along the side of each of
        /// six squares; each further one has twice as many. All grids have the same great rivers.
        grids: u32 = 4, "Grids", Unit::None, count(1, MAX_GRIDS), Stage::Field;
        /// Share of the solved weather in the climate of the biome table and in the cover of clouds; the rest is the
        /// climate's own belts and coasts.
        weather_share: f64 = 1.0, "Weather share", Unit::None, linear(0.0, 1.0), Stage::Climate | Stage::CloudMap;
    } with {
        /// Plates of the crust: continents, mountain belts, island arcs, ridges of the ocean floor.
        plates: Plates = Plates::default();
        /// Winds, rain and temperature over the plates' relief.
        weather: Weather = Weather::default();
        /// Rivers and lakes, and the valleys that they carve.
        rivers: Rivers = Rivers::default();
    }
}

params! {
    /// Plates of the crust. Their boundaries give mountain belts, trenches, island arcs, rifts and ridges.
    pub struct Plates {
        /// Seed of the layout: plates, their motion, continents and hot spots.
        seed: u32 = 1, "Seed", Unit::None, Domain::Seed, Stage::Field;
        /// Number of plates. A third of them are large.
        count: u32 = 15, "Plate count", Unit::None, count(2, MAX_PLATES), Stage::Field;
        /// How much plates differ in size: 0 is all alike, 1 is a few giants and many small ones.
        size_variation: f64 = 0.6, "Size variation", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How ragged boundaries between plates are: 0 is straight lines.
        raggedness: f64 = 1.0, "Raggedness", Unit::None, linear(0.0, 2.0), Stage::Field;
        /// Share of the planet that is continental crust. A part of it is shelf, under the sea.
        continents: f64 = 0.38, "Continental crust", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How continents break up: 0 is a few with even coasts, 1 is many pieces with gulfs and islands.
        fragments: f64 = 0.5, "Fragmentation", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Speed of a plate of medium size.
        drift_mm_yr: f64 = 50.0, "Drift", Unit::MillimetresPerYear, log(1.0, 500.0), Stage::Field;
        /// How far the strongest mountain belts have been pushed up. Rivers take a part of it away.
        mountains_m: f64 = 7500.0, "Mountains", Unit::Metres, linear(0.0, 30_000.0), Stage::Field;
        /// Width of a mountain belt along a coast, on a planet of the Earth's size.
        belt_km: f64 = 420.0, "Belt width", Unit::Kilometres, log(50.0, 2000.0), Stage::Field;
        /// Width of the high plateau behind a collision of two continents, on a planet of the Earth's size.
        plateau_km: f64 = 650.0, "Plateau width", Unit::Kilometres, log(10.0, 3000.0), Stage::Field;
        /// Height of the old worn belts inside continents.
        old_belts_m: f64 = 1400.0, "Old belt height", Unit::Metres, linear(0.0, 10_000.0), Stage::Field;
        /// Mean height to which the inside of a continent has been raised.
        inland_m: f64 = 500.0, "Inland height", Unit::Metres, linear(0.0, 10_000.0), Stage::Field;
        /// Depth of an old ocean floor below the reference sphere.
        ocean_m: f64 = 5200.0, "Ocean depth", Unit::Metres, linear(0.0, 20_000.0), Stage::Field;
        /// Depth of a ridge in the middle of an ocean below the reference sphere.
        ridge_m: f64 = 2500.0, "Ridge depth", Unit::Metres, linear(0.0, 20_000.0), Stage::Field;
        /// Depth of a trench below the ocean floor beside it.
        trench_m: f64 = 3500.0, "Trench depth", Unit::Metres, linear(0.0, 20_000.0), Stage::Field;
        /// Width of the shelf along a coast where no plate sinks, on a planet of the Earth's size.
        shelf_km: f64 = 140.0, "Shelf width", Unit::Kilometres, log(1.0, 1000.0), Stage::Field;
        /// Height of the volcanoes of an island arc above the ocean floor.
        arcs_m: f64 = 5500.0, "Arc height", Unit::Metres, linear(0.0, 20_000.0), Stage::Field;
        /// Depth of a rift inside a continent.
        rifts_m: f64 = 1100.0, "Rift depth", Unit::Metres, linear(0.0, 10_000.0), Stage::Field;
        /// Number of hot spots. Each leaves a chain of volcanoes on the plate that drifts over it.
        hot_spots: u32 = 9, "Hot spots", Unit::None, count(0, 40), Stage::Field;
        /// Height of the youngest volcano of a hot spot above the ground.
        hot_spots_m: f64 = 6500.0, "Hot-spot volcanoes", Unit::Metres, linear(0.0, 30_000.0), Stage::Field;
    } with {
        /// Plates that were changed by hand. All others stay as they were laid out.
        by_hand: Vec<PlateByHand> = Vec::new();
    }
}

impl Plates {
    /// Adds the entry of a plate, or replaces it.
    pub fn set_by_hand(&mut self, entry: PlateByHand) {
        match self.by_hand.iter_mut().find(|other| other.plate == entry.plate) {
            Some(other) => *other = entry,
            None => self.by_hand.push(entry),
        }
    }
}

choice! {
    /// What a plate carries.
    pub enum PlateKind {
        /// As it was laid out.
        AsLaidOut = "As laid out",
        /// A continent.
        Continental = "Continental",
        /// An ocean floor alone.
        Oceanic = "Oceanic",
    }
}

params! {
    /// A plate that was changed by hand.
    pub struct PlateByHand {
        /// Number of the plate. A number that the layout does not have has no effect.
        plate: u32 = 0, "Number", Unit::None, count(0, MAX_PLATES - 1), Stage::Field;
        /// Latitude to which the middle of the plate is moved. Its continents go with it.
        latitude_deg: f64 = 0.0, "Latitude", Unit::Degrees, linear(-90.0, 90.0), Stage::Field;
        /// Longitude to which the middle of the plate is moved.
        longitude_deg: f64 = 0.0, "Longitude", Unit::Degrees, linear(-180.0, 180.0), Stage::Field;
        /// Angle by which the plate is turned about its middle, with its continents; positive is anticlockwise, seen
        /// from above.
        turn_deg: f64 = 0.0, "Turn", Unit::Degrees, linear(-180.0, 180.0), Stage::Field;
        /// Growth: its boundaries move outwards; below 0 inwards. 1 is about half the distance between two plates.
        growth: f64 = 0.0, "Growth", Unit::None, linear(-1.0, 1.0), Stage::Field;
        /// Heading of its motion at its middle: 0 is north, 90 east.
        heading_deg: f64 = 0.0, "Heading", Unit::Degrees, linear(-180.0, 360.0), Stage::Field;
        /// Speed of its motion at its middle.
        drift_mm_yr: f64 = 50.0, "Drift", Unit::MillimetresPerYear, linear(0.0, 1000.0), Stage::Field;
        /// Whether it carries a continent.
        kind: PlateKind = PlateKind::AsLaidOut, "Kind", Unit::None, Domain::Choice, Stage::Field;
    }
}

choice! {
    /// Direction in which a planet rotates.
    pub enum Rotation {
        /// As the Earth does: the star rises in the east.
        Eastward = "Eastward",
        /// The star rises in the west, and all belts of wind blow the other way.
        Westward = "Westward",
    }
}

params! {
    /// Winds, rain and temperature over the relief.
    pub struct Weather {
        /// Direction of the rotation. It decides to which side winds turn.
        rotation: Rotation = Rotation::Eastward, "Rotation", Unit::None, Domain::Choice, Stage::Field;
        /// Number of wind belts from the equator to a pole. Fast rotation gives more: the Earth has 3.
        belts: f64 = 3.0, "Wind belts", Unit::None, linear(1.0, 9.0), Stage::Field;
        /// Mean speed of the wind.
        wind_m_s: f64 = 7.0, "Wind", Unit::MetresPerSecond, log(0.1, 100.0), Stage::Field;
        /// Rain of the whole planet; 1 is the Earth.
        wetness: f64 = 1.0, "Wetness", Unit::None, log(0.02, 5.0), Stage::Field;
        /// Distance over flat land after which a third of the moisture in the air is left, on a planet of the Earth's
        /// size.
        reach_km: f64 = 2200.0, "Moisture reach", Unit::Kilometres, log(50.0, 20_000.0), Stage::Field;
        /// Strength of rain on windward slopes and of the dry side behind them; 1 is the Earth.
        rain_shadow: f64 = 1.0, "Rain shadow", Unit::None, linear(0.0, 3.0), Stage::Field;
        /// How far the belts of rain and wind move with the seasons; 1 is the Earth.
        seasons: f64 = 1.0, "Seasons", Unit::None, linear(0.0, 3.0), Stage::Field;
        /// Warm east coasts and cold west coasts of oceans; 1 is the Earth.
        currents: f64 = 1.0, "Currents", Unit::None, linear(0.0, 3.0), Stage::Field;
    }
}

params! {
    /// Rivers and lakes, and the valleys that they carve.
    pub struct Rivers {
        /// Seed of the courses of small rivers.
        seed: u32 = 1, "Seed", Unit::None, Domain::Seed, Stage::Field;
        /// How long rivers have carved while the land rose. Young land is high and hardly cut; old land is worn.
        age_myr: f64 = 14.0, "Age", Unit::MillionYears, log(0.05, 500.0), Stage::Field;
        /// How easily rock is carved; 1 is the mean of the Earth.
        erodibility: f64 = 1.0, "Erodibility", Unit::None, log(0.01, 100.0), Stage::Field;
        /// How much the kinds of rock differ: 0 is one rock everywhere.
        rock_variation: f64 = 0.6, "Rock variation", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// Steepest slope at which ground holds.
        talus_deg: f64 = 32.0, "Talus angle", Unit::Degrees, linear(5.0, 80.0), Stage::Field;
        /// Factor of the rain that feeds rivers.
        rain: f64 = 1.0, "Rain", Unit::None, log(0.01, 10.0), Stage::Field;
        /// Share of the rain's pattern in the pattern of rivers: 0 is even rain, 1 is the weather's.
        rain_pattern: f64 = 1.0, "Rain pattern", Unit::None, linear(0.0, 1.0), Stage::Field;
        /// How much rivers lay down: slopes of plains, and deltas; 1 is the Earth.
        deposition: f64 = 1.0, "Deposition", Unit::None, linear(0.0, 4.0), Stage::Field;
        /// How deep a basin must be to hold a lake: 0 is no lakes, 1 is the Earth.
        lakes: f64 = 1.0, "Lakes", Unit::None, linear(0.0, 4.0), Stage::Field;
    }
}
