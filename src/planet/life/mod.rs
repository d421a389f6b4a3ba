//! What stands on the ground: populations of plants, stones and other objects. `crate::life` places them.
//!
//! - `forms`: the forms of objects, and the parameters of each
//! - `lie`: what populations ask of water near and of ridges and hollows
//! - `ready`: populations to start from
//! - `painted`: populations that edits name
//! - `seeds`: populations that share a seed

mod forms;
mod lie;
mod painted;
mod ready;
mod seeds;

pub use forms::{
    Bulbs, Cactus, Conifer, Crown, Crystal, Cushion, Fans, FileMesh, Form, GameObject, Mushroom, Palm, Stone, Tendrils,
    Tree, Tuft, Wood,
};
pub use ready::{READY_POPULATIONS, ReadyPopulation};
pub use seeds::free_seed;

use super::Planet;
use super::param::{Domain, ParamPath, Segment, Stage, Unit, linear, log, params};
use super::printable::number_text;

/// Most populations a planet may have.
pub const MAX_POPULATIONS: usize = 32;

params! {
    /// A population: objects of one form, spread over the ground where it suits them. None stands in water unless it
    /// may. Give each population a seed of its own: equal ones of one density would stand at the same places.
    pub struct Population {
        /// Name of the population.
        name: String = "Population".to_owned(), "Name", Unit::None, Domain::Text { max_chars: 48 }, Stage::Label;
        /// Whether the population is there.
        enabled: bool = true, "Enabled", Unit::None, Domain::Flag, Stage::Life;
        /// Seed of the population. Another seed places its objects anew.
        seed: u32 = 1, "Seed", Unit::None, Domain::Seed, Stage::Life;
        /// Objects on a hectare (100 m by 100 m) where everything suits them. A forest has 200 to 600 trees, a meadow
        /// 50000 tufts.
        per_hectare: f64 = 100.0, "Per hectare", Unit::None, log(0.001, 200_000.0), Stage::Life;
        /// Keys of the biomes where the objects stand. Without a key they stand in all biomes. A key that the palette
        /// does not have counts for nothing, so that a population can go from planet to planet.
        biomes: String = String::new(), "Biomes", Unit::None, Domain::BiomeKeys, Stage::Life;
        /// Share of the objects that are drawn together into groups: 0 is even, 1 leaves clearings.
        clumping: f64 = 0.3, "Clumping", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Size of the groups.
        clump_m: f64 = 80.0, "Clump size", Unit::Metres, log(0.5, 10_000.0), Stage::Life;
        /// Gentlest slope on which the objects stand.
        slope_from_deg: f64 = 0.0, "Slope from", Unit::Degrees, linear(0.0, 90.0), Stage::Life;
        /// Steepest slope on which the objects stand.
        slope_to_deg: f64 = 35.0, "Slope to", Unit::Degrees, linear(0.0, 90.0), Stage::Life;
        /// Lowest ground on which the objects stand, above the sea or the reference sphere.
        height_from_m: f64 = -20_000.0, "Height from", Unit::Metres, linear(-20_000.0, 20_000.0), Stage::Life;
        /// Highest ground on which the objects stand, above the sea or the reference sphere.
        height_to_m: f64 = 20_000.0, "Height to", Unit::Metres, linear(-20_000.0, 20_000.0), Stage::Life;
        /// Coldest mean temperature at which the objects stand. They thin out over two degrees more.
        temperature_from_c: f64 = -200.0, "Temperature from", Unit::Celsius, linear(-200.0, 500.0), Stage::Life;
        /// Hottest mean temperature at which the objects stand. They thin out over two degrees more.
        temperature_to_c: f64 = 500.0, "Temperature to", Unit::Celsius, linear(-200.0, 500.0), Stage::Life;
        /// Driest moisture at which the objects stand.
        moisture_from: f64 = 0.0, "Moisture from", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Wettest moisture at which the objects stand.
        moisture_to: f64 = 1.0, "Moisture to", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Least distance from water: from the bank of a river, or ten times the height over a lake or the sea.
        #[serde(skip_serializing_if = "lie::is::<0>")]
        bank_from_m: f64 = 0.0, "From water", Unit::Metres, log(0.0, 10_000.0), Stage::Life;
        /// Greatest distance from water: from the bank of a river, or ten times the height over a lake or the sea;
        /// 10000 is any. It is exact beside a river, and follows a straightened course beyond some hundred metres.
        #[serde(skip_serializing_if = "lie::is::<10_000>")]
        bank_to_m: f64 = lie::ANY_BANK_M, "Near water", Unit::Metres, log(0.0, lie::ANY_BANK_M), Stage::Life;
        /// Least curvature of the ground: its height over the mean 50 m around, as a share of these 50 m. From
        /// 0.05 on are ridges among hills, from 0.2 on crests of mountains; -1 is any.
        #[serde(skip_serializing_if = "lie::is::<-1>")]
        curvature_from: f64 = -1.0, "Curvature from", Unit::None, linear(-1.0, 1.0), Stage::Life;
        /// Greatest curvature of the ground: its height over the mean 50 m around, as a share of these 50 m. Up to
        /// -0.05 are hollows among hills, up to -0.2 gullies of mountains; 1 is any.
        #[serde(skip_serializing_if = "lie::is::<1>")]
        curvature_to: f64 = 1.0, "Curvature to", Unit::None, linear(-1.0, 1.0), Stage::Life;
        /// Least height of the ground above the sea; the beach below stays bare.
        shore_m: f64 = 2.0, "Above the sea", Unit::Metres, linear(0.0, 100.0), Stage::Life;
        /// Whether the objects stand in water, too.
        in_water: bool = false, "In water", Unit::None, Domain::Flag, Stage::Life;
        /// Height of an object above the ground.
        height_m: f64 = 10.0, "Height", Unit::Metres, log(0.02, 300.0), Stage::Life;
        /// How much single heights differ: 0.5 is from a half to one and a half of the height.
        height_spread: f64 = 0.3, "Height spread", Unit::None, linear(0.0, 0.9), Stage::Life;
        /// How upright an object stands: 1 is upright on any slope, 0 is square to the ground.
        upright: f64 = 1.0, "Upright", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// Greatest lean of single objects, each to a side of its own.
        lean_deg: f64 = 3.0, "Lean", Unit::Degrees, linear(0.0, 60.0), Stage::Life;
        /// Share of the height that is below the ground.
        sunk: f64 = 0.02, "Sunk", Unit::None, linear(0.0, 0.9), Stage::Life;
        /// Colour of wood, stalks and stone (albedo, linear sRGB).
        color: [f64; 3] = [0.10, 0.07, 0.05], "Colour", Unit::None, Domain::Color, Stage::Life;
        /// Colour of leaves, caps and tips (albedo, linear sRGB).
        leaf_color: [f64; 3] = [0.05, 0.09, 0.025], "Leaf colour", Unit::None, Domain::Color, Stage::Life;
        /// How much the brightness of single objects differs.
        color_spread: f64 = 0.25, "Colour spread", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// How far fallen leaves, needles and twigs cover the ground where the objects close above it: 0 is none, 1
        /// all.
        litter: f64 = 0.0, "Litter", Unit::None, linear(0.0, 1.0), Stage::Life;
        /// How far the wind sways the tips, as a share of the height in a gale.
        sway: f64 = 0.05, "Sway", Unit::None, linear(0.0, 0.5), Stage::Life;
        /// Whether bodies hit the objects: trunks and stones do, grass does not.
        solid: bool = true, "Solid", Unit::None, Domain::Flag, Stage::Life;
    } with {
        /// Form of the objects.
        form: Form = Form::default();
    }
}

impl Population {
    /// The parameters that decide where the objects stand, and how large they are; defaults for the rest.
    pub(crate) fn placed(&self) -> Self {
        let Self { name, color, leaf_color, litter, sway, solid, form, .. } = Self::default();
        Self { name, color, leaf_color, litter, sway, solid, form, ..self.clone() }
    }

    /// Colours of the objects (albedo, linear sRGB), of wood and stone and of leaves: those of a mesh that has its own.
    pub fn colors(&self) -> [[f64; 3]; 2] {
        match &self.form {
            Form::Mesh(FileMesh { file, own_colors: true, .. }) => file.mesh().map(|mesh| mesh.colors),
            _ => None,
        }
        .unwrap_or([self.color, self.leaf_color])
    }

    /// Ranges whose ends are out of order: the field, and what is wrong with it.
    pub(crate) fn order_problems(&self) -> impl Iterator<Item = (&'static str, String)> {
        let ranges = [
            ("slope_to_deg", self.slope_from_deg, self.slope_to_deg, "slope_from_deg"),
            ("height_to_m", self.height_from_m, self.height_to_m, "height_from_m"),
            ("temperature_to_c", self.temperature_from_c, self.temperature_to_c, "temperature_from_c"),
            ("moisture_to", self.moisture_from, self.moisture_to, "moisture_from"),
            ("bank_to_m", self.bank_from_m, self.bank_to_m, "bank_from_m"),
            ("curvature_to", self.curvature_from, self.curvature_to, "curvature_from"),
        ];
        ranges.into_iter().filter(|(_, from, to, _)| from > to).map(|(field, from, to, other)| {
            let [from, to] = [from, to].map(number_text);
            (field, format!("{to} is out of order; use at least `{other}` ({from})"))
        })
    }

    /// Swaps the ends of ranges that are out of order.
    pub(crate) fn mend_ranges(&mut self) {
        for (from, to) in [
            (&mut self.slope_from_deg, &mut self.slope_to_deg),
            (&mut self.height_from_m, &mut self.height_to_m),
            (&mut self.temperature_from_c, &mut self.temperature_to_c),
            (&mut self.moisture_from, &mut self.moisture_to),
            (&mut self.bank_from_m, &mut self.bank_to_m),
            (&mut self.curvature_from, &mut self.curvature_to),
        ] {
            if from > to {
                std::mem::swap(from, to);
            }
        }
    }

    /// Whether the objects stand in a biome of this key.
    pub fn stands_in(&self, key: char) -> bool {
        self.biomes.is_empty() || self.biomes.contains(key)
    }
}

/// The path of a population.
pub fn population_path(index: usize) -> ParamPath {
    ParamPath::from(vec![Segment::Field("life"), Segment::Index(index)])
}

impl Planet {
    /// Populations with ranges that are out of order.
    pub(crate) fn life_problems(&self) -> impl Iterator<Item = (ParamPath, String)> {
        self.life.iter().enumerate().flat_map(|(index, population)| {
            population.order_problems().map(move |(field, message)| (population_path(index).join(field), message))
        })
    }

    /// Replaces a key of a biome in the table, in all rules and in all populations.
    pub fn replace_biome_key(&mut self, old: char, new: char) {
        self.biomes.replace_key(old, new);
        for population in &mut self.life {
            if population.biomes.contains(old) {
                let others = population.biomes.chars().filter(|key| *key != old && *key != new);
                population.biomes = others.chain([new]).collect();
            }
        }
    }
}
