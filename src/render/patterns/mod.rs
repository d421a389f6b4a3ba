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

pub(crate) use crate::planet::textures::layer::{PATTERN_ROUGHNESS, PATTERN_STEEPEST};
pub(crate) use arrays::{Pattern, PatternArrays, PatternPool};
pub(crate) use noise::SIDE;

use crate::planet::textures::TextureSet;
use crate::planet::{Biomes, Detail};
use canvas::Spot;
use std::sync::Arc;

/// The built-in kinds of pattern that a planet names, each once.
fn kinds_of(biomes: &Biomes) -> Vec<Detail> {
    let shown = biomes.palette.iter().flat_map(|biome| [biome.detail, biome.patch_detail]).chain([biomes.cliff_detail]);
    Detail::ALL.iter().filter(|kind| **kind != Detail::None && shown.clone().any(|s| s == **kind)).copied().collect()
}

/// The patterns that a planet shows, each once: built-in ones, then the texture sets of its biomes. A biome with a set
/// keeps the layer of its built-in pattern, for when there is no room for the set.
pub(crate) fn patterns_of(biomes: &Biomes) -> Arc<[Pattern]> {
    let mut sets: Vec<Arc<TextureSet>> = Vec::new();
    for set in biomes.palette.iter().filter_map(|biome| biome.textures.set()) {
        if !sets.contains(set) {
            sets.push(set.clone());
        }
    }
    kinds_of(biomes).into_iter().map(Pattern::Kind).chain(sets.into_iter().map(Pattern::Set)).collect()
}

/// Draws the built-in patterns of a planet on other threads. Texture sets are ready when they have been read.
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
