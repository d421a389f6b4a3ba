//! The patterns of the ground: for each [`Detail`] a function that draws a square texture which tiles without a seam.
//!
//! - `noise`, `canvas`: tiling noise, and strokes that cover one another
//! - `plants`, `loose`, `stone`, `frozen`, `wet`: the patterns by kind of ground
//! - `arrays`: the textures on the GPU, of the kinds that planets show
//!
//! A new pattern is a variant of [`Detail`], a function here and a line in [`draw`].

mod arrays;
mod canvas;
mod frozen;
mod loose;
mod noise;
mod plants;
mod stone;
mod wet;

pub(crate) use arrays::{PATTERN_ROUGHNESS, PATTERN_STEEPEST, PatternArrays, PatternPool, relief_of};
pub(crate) use noise::SIDE;

use crate::planet::{Biomes, Detail};
use canvas::Spot;

/// The kinds of pattern that a planet shows, each once.
pub(crate) fn kinds_of(biomes: &Biomes) -> Vec<Detail> {
    let shown = biomes.palette.iter().flat_map(|biome| [biome.detail, biome.patch_detail]).chain([biomes.cliff_detail]);
    Detail::ALL.iter().filter(|kind| **kind != Detail::None && shown.clone().any(|s| s == **kind)).copied().collect()
}

/// Draws the patterns of a planet on other threads.
pub(crate) fn draw_ahead(biomes: &Biomes) {
    arrays::draw_ahead(&kinds_of(biomes));
}

/// Height of the small bumps of the ground (centimetres to metres, `macro_variation.wgsl`) as a share of those of bare
/// rock: water and wind level loose ground, plants hide it.
pub(crate) fn bumps(kind: Detail) -> f64 {
    match kind {
        Detail::Beach | Detail::Salt | Detail::Mud | Detail::WetMud => 0.15,
        Detail::Sand | Detail::Snow | Detail::Crust | Detail::Sastrugi | Detail::Ice | Detail::BlueIce => 0.35,
        Detail::Grass | Detail::Steppe | Detail::Litter | Detail::Needles | Detail::Soil | Detail::Ash => 0.6,
        Detail::Regolith | Detail::Firn | Detail::Gravel | Detail::Cobbles | Detail::Moss => 0.7,
        Detail::None | Detail::Scree | Detail::Rock | Detail::Granite | Detail::Basalt | Detail::Sandstone => 1.0,
        Detail::Lava | Detail::RopeLava | Detail::Clinker => 1.0,
    }
}

/// Draws a pattern, row by row.
fn draw(kind: Detail) -> Vec<Spot> {
    match kind {
        Detail::None => canvas::each(|_| Spot { tint: [1.0; 3], ..Spot::default() }),
        Detail::Grass => plants::grass(),
        Detail::Steppe => plants::steppe(),
        Detail::Moss => plants::moss(),
        Detail::Litter => plants::litter(),
        Detail::Needles => plants::needles(),
        Detail::Soil => loose::soil(),
        Detail::Sand => loose::sand(),
        Detail::Beach => loose::beach(),
        Detail::Gravel => loose::gravel(),
        Detail::Cobbles => loose::cobbles(),
        Detail::Scree => loose::scree(),
        Detail::Ash => loose::ash(),
        Detail::Regolith => loose::regolith(),
        Detail::Rock => stone::rock(),
        Detail::Granite => stone::granite(),
        Detail::Basalt => stone::basalt(),
        Detail::Sandstone => stone::sandstone(),
        Detail::Lava => stone::lava(),
        Detail::RopeLava => stone::ropes(),
        Detail::Clinker => stone::clinker(),
        Detail::Mud => wet::mud(),
        Detail::WetMud => wet::wet_mud(),
        Detail::Salt => wet::salt(),
        Detail::Snow => frozen::snow(),
        Detail::Crust => frozen::crust(),
        Detail::Sastrugi => frozen::sastrugi(),
        Detail::Firn => frozen::firn(),
        Detail::Ice => frozen::ice(),
        Detail::BlueIce => frozen::blue_ice(),
    }
}
