//! The preset: its data, the descriptions of its parameters, loading and saving.
//!
//! - [`param`]: one description for each parameter and each part, and the visitors of all parameters
//! - [`layers`], [`shapes`] (landforms), [`masks`], [`parts`] (climate to star), [`biome`], [`table`] (the biome
//!   table): the data of a preset; `kinds` writes enums whose variants carry parameters
//! - `airs`, `seas`, `skies`, `tables`: values to start from; `starting` is their type
//! - `star_color`, `day`: the colour of a star by temperature; its position by hour and season
//! - `ground_version`: the version of all that shapes the ground, and notes about presets of another
//! - [`diff`]: which parameters two planets differ in
//! - [`key`]: content keys
//! - [`validate`]: ranges, references between names, the shape of the biome table
//! - [`mod@file`]: loading and saving; `open` opens files, `output` writes them; `beside` keeps long lists of edits in
//!   a file of their own, `text` writes a preset, `explain` parses one and explains errors, `locate` finds lines and
//!   columns, `migrate` reads old versions; [`snippet`] reads and writes single parts
//! - [`sources`]: what a work reads, so that its outputs replace none of it
//! - `giant`: gas giants, and giants to start from
//! - `rings`: rings of a planet, and rings to start from
//! - `printable`: text of strangers, as it may be shown
//! - `root`: what a whole file holds: a planet or a system
//! - [`structure`]: plates, weather and rivers of a preset
//! - [`life`]: populations of plants, stones and other objects
//! - [`edits`]: changes of the ground at a place, made by hand
//! - [`linked`]: references to files; [`picture`], [`textures`] and [`mesh`]: those files; `pictures`: all those of a
//!   planet
//! - [`watch`]: a preset that changes on disk while a game runs
//! - [`shipped`]: the presets that come with the program
//! - `idle`: parameters that have no effect where the others stand
//! - [`notes`]: the editor's own section of a preset; [`locks`]: what variations leave as it is
//! - [`random`]: random planets that are always valid

mod airs;
mod beside;
pub mod biome;
mod day;
pub mod diff;
pub mod edits;
pub(crate) mod explain;
pub mod file;
mod giant;
mod ground_version;
mod idle;
pub mod key;
pub(crate) mod kinds;
pub mod layers;
pub mod life;
pub mod linked;
pub(crate) mod locate;
pub mod locks;
pub mod masks;
pub mod mesh;
pub(crate) mod migrate;
pub mod notes;
pub(crate) mod open;
pub(crate) mod output;
pub mod param;
pub mod parts;
pub mod picture;
mod pictures;
pub(crate) mod printable;
pub(crate) mod problem;
pub mod random;
mod rings;
pub(crate) mod root;
mod seas;
pub mod shapes;
pub mod shipped;
mod skies;
pub mod snippet;
pub mod sources;
mod star_color;
mod starting;
pub mod structure;
pub mod table;
mod tables;
pub(crate) mod text;
pub mod textures;
pub mod validate;
pub mod watch;

pub use airs::STARTING_AIRS;
pub use biome::{Biome, Detail, Steep};
pub use edits::{EditPoint, EditPoints, GroundEdit, GroundEdits, Limit, Tool};
pub use file::{LoadError, SaveError};
pub use giant::{Giant, STARTING_GIANTS};
pub use ground_version::{GROUND_VERSION, ground_note};
pub use key::Key;
pub use layers::{Blend, Layer};
pub use life::{Form, MAX_POPULATIONS, Population};
pub use masks::{HeightMask, LatitudeMask, LayerMask, Mask, PaintedMask, SlopeMask};
pub use notes::{Bookmark, EditorNotes};
pub use parts::{Atmosphere, Biomes, CLIMATE_BELTS, Climate, Clouds, Star, TableBlend, TableRows, Water};
pub use picture::PictureLayout;
pub use pictures::{FileContent, FileKey};
pub use problem::Problem;
pub use rings::{Rings, STARTING_RINGS};
pub use seas::STARTING_SEAS;
pub use shapes::{
    Billow, Canyons, CellStyle, Cells, Continents, Craters, Damped, Dunes, Fbm, Gullies, HeightMap, Ridged, Shape,
    Terraces, Warped,
};
pub use skies::STARTING_SKIES;
pub use star_color::{STAR_KELVIN, star_color, star_kelvin};
pub use starting::Starting;
pub use structure::{PlateByHand, PlateKind, Plates, Rivers, Rotation, Structure, Weather};
pub use table::Table;
pub use tables::{STARTING_TABLES, StartingTable};
pub use validate::InvalidPlanet;

use param::{Curve, Domain, ParamPath, Params, Part, PartType, Stage, Unit, choice, linear, log, params};
use serde::{Deserialize, Serialize};

/// The version of the preset format that this crate writes. It pins the layers too: a preset of an old version is
/// migrated when it is read, and its layers keep their exact heights.
pub const VERSION: u32 = 3;

/// Most layers a planet may have.
pub const MAX_LAYERS: usize = 64;

/// Most masks a layer may have.
pub const MAX_MASKS: usize = 8;

/// Most different distances over which the slope masks of a planet may measure.
pub const MAX_SLOPE_DISTANCES: usize = 6;

/// Domain of the curve over heights, in metres.
const HEIGHT_CURVE: Domain = Domain::Curve { most: 100_000.0, least_step: 1.0 };

/// Most biomes a palette may have.
pub const MAX_BIOMES: usize = 64;

params! {
    /// A whole planet, as saved in a preset.
    pub struct Planet {
        /// Name of the planet.
        name: String = "Unnamed".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 64 }, Stage::Label;
        /// Seed of the planet, mixed into the seed of every layer, the climate and the clouds.
        seed: u32 = 1, "Seed", Unit::None, Domain::Seed, Stage::Field | Stage::ClimateNoise | Stage::CloudMap;
        /// Radius of the reference sphere from which heights are measured.
        radius_km: f64 = 6371.0, "Radius", Unit::Kilometres, log(1.0, 100_000.0), Stage::Field | Stage::ClimateNoise | Stage::CloudMap | Stage::OpticalDepth;
        /// Precision of the heights. Classic is the arithmetic of presets before version 3 and keeps their heights bit
        /// for bit; Millimetre is smooth underfoot on the highest mountains.
        precision: Precision = Precision::Millimetre, "Precision", Unit::None, Domain::Choice, Stage::Field;
        /// Lights of settlements at night, where the land is low, mild and watered: 1 is as bright as the Earth's, 0 is
        /// none.
        settlements: f64 = 0.0, "Settlements", Unit::None, linear(0.0, 4.0), Stage::Uniform;
        /// Reshapes the combined height of all layers: points (height, new height). An empty curve changes nothing.
        /// Beyond its ends the curve is a straight line.
        height_curve: Curve = Curve::new(), "Height curve", Unit::Metres, HEIGHT_CURVE, Stage::Height;
    } with {
        /// The star that lights the planet.
        star: Star = Star::default();
        /// Terrain, applied from first to last.
        layers: Vec<Layer> = Vec::new();
        /// Changes of the ground made by hand, applied from first to last after all layers.
        edits: GroundEdits = GroundEdits::default();
        /// Plants, stones and other objects that stand on the ground.
        life: Vec<Population> = Vec::new();
        /// Temperature and moisture over the globe.
        climate: Climate = Climate::default();
        /// The biome table, its palette and the surface rules.
        biomes: Biomes = Biomes::default();
        /// Plates, weather and rivers, or None.
        structure: Option<Structure> = None;
        /// The sea, or None.
        water: Option<Water> = None;
        /// The air, or None.
        atmosphere: Option<Atmosphere> = None;
        /// The clouds, or None.
        clouds: Option<Clouds> = None;
        /// The clouds of a gas giant in place of layers, structure and water, or None.
        giant: Option<Giant> = None;
        /// Rings in the plane of the equator, or None.
        rings: Option<Rings> = None;
        /// The editor's own section, or None.
        editor: Option<EditorNotes> = None;
    }
}

impl Planet {
    /// Radius of the reference sphere in metres.
    pub fn radius_m(&self) -> f64 {
        self.radius_km * 1000.0
    }

    /// Sea level in metres above the reference sphere, if there is a sea.
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
    /// Precision of the heights.
    pub enum Precision {
        /// Within a millimetre of f64 throughout at 8 km of amplitude.
        Millimetre = "Millimetre",
        /// As before version 3: an error of a third of a millimetre for each kilometre of amplitude, and more for some
        /// landforms.
        Classic = "Classic",
    }
}

/// The number in front of a preset; see [`VERSION`].
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
#[serde(transparent)]
pub(crate) struct Version(pub(crate) u32);
