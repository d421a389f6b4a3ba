//! What a planet is: plain data, its description, its file.
//!
//! - [`param`]: one description for each parameter and the visitor that reaches them all
//! - [`layers`], [`shapes`], [`masks`], [`parts`], [`biome`], [`table`]: the preset's data (terrain layers; their kinds; where
//!   they act; everything else; one kind of ground; the biome table); `kinds` writes the enums whose values carry parameters
//! - `airs`, `tables`, `star_color`: atmospheres and biome tables to start from; the colour of a star by its temperature
//! - [`diff`]: which parameters two planets differ in, and which stages of a rebuild that makes stale
//! - [`validate`]: what serde cannot see: ranges, names that refer to each other, the table's shape
//! - [`mod@file`]: loading and saving; `text` writes a preset, `explain` reads one and words what is wrong with it,
//!   `locate` knows lines and columns, `migrate` old versions
//! - [`picture`]: pictures that a preset refers to
//! - [`shipped`]: the presets that come with the program
//! - [`notes`]: what the editor keeps in a preset for itself
//! - [`random`]: random planets that are always valid

mod airs;
pub mod biome;
mod day;
pub mod diff;
pub(crate) mod explain;
pub mod file;
pub mod key;
pub(crate) mod kinds;
pub mod layers;
pub(crate) mod locate;
pub mod masks;
pub(crate) mod migrate;
pub mod notes;
mod open;
pub mod param;
pub mod parts;
pub mod picture;
mod pictures;
pub mod random;
pub mod shapes;
pub mod shipped;
mod star_color;
pub mod table;
mod tables;
pub(crate) mod text;
pub mod validate;

pub use airs::{STARTING_AIRS, StartingAir};
pub use biome::{Biome, Detail, Steep};
pub use file::{LoadError, Problem, SaveError};
pub use key::Key;
pub use layers::{Blend, Layer};
pub use masks::{HeightMask, LatitudeMask, LayerMask, Mask, SlopeMask};
pub use notes::{Bookmark, EditorNotes};
pub use parts::{Atmosphere, Biomes, Climate, Clouds, Star, TableBlend, TableRows, Water};
pub use picture::PictureLayout;
pub use shapes::{
    Billow, Canyons, CellStyle, Cells, Continents, Craters, Damped, Dunes, Fbm, Gullies, HeightMap, Ridged, Shape,
    Terraces, Warped,
};
pub use star_color::{STAR_KELVIN, star_color, star_kelvin};
pub use table::Table;
pub use tables::{STARTING_TABLES, StartingTable};
pub use validate::InvalidPlanet;

use param::{Curve, Domain, ParamPath, Params, Part, PartType, Stage, Unit, choice, log, params};
use serde::{Deserialize, Serialize};

/// The version of the preset format that this crate writes. It pins the terrain algorithm too: a preset of an old
/// version is migrated when it is read, and keeps its exact heights.
pub const VERSION: u32 = 3;

/// Most layers a planet may have.
pub const MAX_LAYERS: usize = 64;

/// Most masks a layer may have.
pub const MAX_MASKS: usize = 8;

/// Most distances over which the slope masks of a planet may measure, all different.
pub const MAX_SLOPE_DISTANCES: usize = 6;

/// Reach of the curve over heights, and how close its points may stand.
const HEIGHT_CURVE: Domain = Domain::Curve { most: 100_000.0, least_step: 1.0 };

/// Most biomes a palette may have.
pub const MAX_BIOMES: usize = 64;

params! {
    /// A whole planet, as saved in a preset.
    pub struct Planet {
        /// What the planet is called.
        name: String = "Unnamed".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 64 }, Stage::Label;
        /// Start of every pseudo-random sequence of this planet: each layer's own seed is mixed with it.
        seed: u32 = 1, "Seed", Unit::None, Domain::Seed, Stage::Field | Stage::ClimateNoise | Stage::CloudMap;
        /// Radius of the reference sphere from which heights are measured.
        radius_km: f64 = 6371.0, "Radius", Unit::Kilometres, log(1.0, 100_000.0), Stage::Field | Stage::ClimateNoise | Stage::CloudMap | Stage::AirTables;
        /// How exactly heights are found. Classic is how presets before version 3 were made, and keeps their heights to
        /// the bit; Millimetre is smooth underfoot on the highest mountains.
        precision: Precision = Precision::Millimetre, "Precision", Unit::None, Domain::Choice, Stage::Field;
        /// Reshapes the height that the layers make together: points (height, what it becomes). Empty leaves it as it
        /// is; beyond its ends the curve goes on straight.
        height_curve: Curve = Curve::new(), "Height curve", Unit::Metres, HEIGHT_CURVE, Stage::Height;
    } with {
        /// The star that lights the planet.
        star: Star = Star::default();
        /// Terrain, applied from first to last.
        layers: Vec<Layer> = Vec::new();
        /// Temperature and moisture over the globe.
        climate: Climate = Climate::default();
        /// What kind of ground lies where.
        biomes: Biomes = Biomes::default();
        /// The sea, or None.
        water: Option<Water> = None;
        /// The air, or None.
        atmosphere: Option<Atmosphere> = None;
        /// The clouds, or None.
        clouds: Option<Clouds> = None;
        /// What only the editor reads, or None.
        editor: Option<EditorNotes> = None;
    }
}

impl Planet {
    /// Radius of the reference sphere in metres.
    pub fn radius_m(&self) -> f64 {
        self.radius_km * 1000.0
    }

    /// Height of the sea's surface above the reference sphere, if there is a sea.
    pub fn sea_level_m(&self) -> Option<f64> {
        self.water.as_ref().map(|water| water.level_m)
    }

    /// Every part of a planet, at any depth.
    pub fn all_parts() -> Vec<&'static Part> {
        let mut parts = Vec::new();
        <Self as PartType>::each_part(&mut |part| parts.push(part));
        parts
    }

    /// Calls `visit` for each parameter of the planet in the order of the file, to be changed.
    pub fn each(&mut self, visit: &mut param::Visit<'_>) {
        Params::each_param(self, &mut ParamPath::default(), visit);
    }

    /// Calls `look` for each parameter of the planet in the order of the file.
    pub fn each_value(&self, look: &mut param::Look<'_>) {
        Params::each_value(self, &mut ParamPath::default(), look);
    }
}

choice! {
    /// How exactly heights are found.
    pub enum Precision {
        /// Within a millimetre of f64 throughout at 8 km of amplitude.
        Millimetre = "Millimetre",
        /// As before version 3: a third of a millimetre off for each kilometre of amplitude, and more for some kinds of
        /// layer.
        Classic = "Classic",
    }
}

/// The number in front of a preset; see [`VERSION`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Version(pub(crate) u32);
