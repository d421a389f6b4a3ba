//! What the CPU and the shaders share, from one source: constants and structs, written out as the shader file
//! `shared.wgsl`.
//!
//! - `constants`: sizes and counts that belong to both sides
//! - `structs`: the structs of uniform buffers

mod constants;
mod structs;

pub(crate) use constants::*;
pub use constants::{MAX_POINTS, MAX_SUNS};
pub(crate) use structs::*;

use super::biome_table::{CANOPY, ROCK, RULES, SHOWN, SHOWN_ROW, WRAP_M};
use super::debug_view::DebugView;
use super::horizon_pool;
use super::life::{CANOPY_LAYER_ROWS, CANOPY_LAYERS, Material};
use super::patterns::{self, PATTERN_ROUGHNESS, PATTERN_STEEPEST};
use super::tone::{self, Tone};
use super::wgsl::{Constant, constant};
use crate::giant;
use crate::life::canopy;
use crate::life::form::cover;
use crate::life::planting_map;
use crate::life::suitability;
use crate::life::thinning::{FULL_SHARE, WIDEST, WIDEST_PX, WIDEST_SINES};
use crate::lod::horizon::AZIMUTHS;
use crate::lod::morph::COARSEST_MORPHING;
use crate::lod::tile::{DETAIL_APRON, DETAIL_SIDE, TILE_QUADS, TILE_SIDE, TILE_VERTICES, Vertex};
use crate::rings;
use crate::sphere::cube::C_SQUARED;
use crate::terrain::border::{self, OCTAVE_TURN};
use crate::terrain::material::WRAP_FAR_M;
use std::mem::offset_of;

/// The text of `shared.wgsl`.
pub(crate) fn text() -> String {
    let words = |bytes: usize| (bytes / size_of::<u32>()) as u32;
    let size = |size: [u32; 2]| size.map(f64::from);
    let constants: &[(&str, &dyn Constant)] = &[
        ("MAX_SUNS", &(MAX_SUNS as u32)),
        // Giants and rings
        ("BAND_ENTRIES", &(BAND_ENTRIES as u32)),
        ("GIANT_FOG_TOP_KM", &FOG_TOP_KM),
        ("GIANT_DETAIL_RATIO", &giant::DETAIL_RATIO),
        ("RING_ENTRIES", &(RING_ENTRIES as u32)),
        ("RINGLET_GAIN", &rings::RINGLET_GAIN),
        ("RING_ORDERS", &rings::HIGHER_ORDERS),
        ("RING_DUST_FORWARD", &rings::DUST_FORWARD),
        ("RING_CLASSES", &(RING_CLASSES as u32)),
        ("RING_SIZE_SPREAD", &(rings::SIZE_RATIO * rings::SIZE_RATIO)),
        ("RING_MOST_CHANCE", &rings::MOST_CHANCE),
        ("RING_FACETS_AT", &rings::FACETS_AT),
        // Tiles
        ("TILE_QUADS", &(TILE_QUADS as u32)),
        ("TILE_SIDE", &(TILE_SIDE as u32)),
        ("TILE_VERTICES", &(TILE_VERTICES as u32)),
        ("DETAIL_SIDE", &(DETAIL_SIDE as f64)),
        ("DETAIL_APRON", &(DETAIL_APRON as i32)),
        ("HORIZON_AZIMUTHS", &(AZIMUTHS as u32)),
        ("HORIZON_IMAGES_ALONG", &(horizon_pool::IMAGES_ALONG as u32)),
        ("FACE_BEND", &C_SQUARED),
        // Vertices as arrays of words, for morphing
        ("VERTEX_WORDS", &words(size_of::<Vertex>())),
        ("VERTEX_HEIGHT", &words(offset_of!(Vertex, height_m))),
        ("VERTEX_LOW", &words(offset_of!(Vertex, position_low_m))),
        ("VERTEX_TEMPERATURE", &words(offset_of!(Vertex, temperature_c))),
        ("VERTEX_MOISTURE", &words(offset_of!(Vertex, moisture))),
        ("VERTEX_DEVIATION", &words(offset_of!(Vertex, deviation_m))),
        ("VERTEX_FORESEEN", &words(offset_of!(Vertex, foreseen_m))),
        ("SHOWN_WORDS", &words(SHOWN_BYTES as usize)),
        ("COARSEST_MORPHING", &u32::from(COARSEST_MORPHING)),
        // Noises
        ("OCTAVE_TURN", &OCTAVE_TURN),
        ("NOISE_TILE_SIDE", &(crate::noise_tile::SIDE as f64)),
        ("VARIATION_OCTAVES", &(VARIATION_OCTAVES as u32)),
        ("BORDER_OCTAVES", &(BORDER_OCTAVES as u32)),
        ("BORDER_GAIN", &border::GAIN),
        ("BORDER_TILE_SIDE", &(border::TILE_SIDE as f64)),
        ("CLOUD_LAYERS", &(CLOUD_LAYERS as u32)),
        ("FOG_LAYER", &FOG_LAYER),
        ("RAIN_LAYER", &RAIN_LAYER),
        ("LOW_LAYER", &LOW_LAYER),
        ("MIDDLE_LAYER", &MIDDLE_LAYER),
        ("ROWS", &ROWS),
        ("WAVES", &(WAVES as u32)),
        // Biomes
        ("BIOME_ROCK", &(ROCK as i32)),
        ("BIOME_RULES", &(RULES as i32)),
        ("BIOME_SHOWN", &(SHOWN as i32)),
        ("SHOWN_ROW", &(SHOWN_ROW as i32)),
        ("MIXTURE_ENTRIES", &MIXTURE_ENTRIES),
        ("WRAP_M", &WRAP_M),
        ("WRAP_FAR_M", &WRAP_FAR_M),
        // Life
        ("SOFT_DEG", &suitability::SOFT_DEG),
        ("SOFT_MOISTURE", &suitability::SOFT_MOISTURE),
        ("SOFT_M", &suitability::SOFT_M),
        ("SOFT_C", &suitability::SOFT_C),
        ("FULL_SHARE", &FULL_SHARE),
        ("WIDEST", &WIDEST),
        ("WIDEST_SINES", &WIDEST_SINES),
        ("WIDEST_PX", &WIDEST_PX),
        ("COVER_EYES_DEG", &cover::EYES_DEG.map(f64::from)),
        ("COVER_SUNS_DEG", &cover::SUNS_DEG.map(f64::from)),
        ("LEAF_SOFT", &cover::LEAF_SOFT.map(f64::from)),
        ("TRANSLUCENT", &f64::from(cover::TRANSLUCENT)),
        ("ROCK", &(Material::Rock as u32)),
        ("LEAFY", &(Material::Leafy as u32)),
        ("NEEDLED", &(Material::Needled as u32)),
        ("FRONDED", &(Material::Fronded as u32)),
        ("BLADED", &(Material::Bladed as u32)),
        ("FALLEN", &(Material::Fallen as u32)),
        ("MOSSY", &(Material::Mossy as u32)),
        ("OWN_LEAVES", &f64::from(cover::OWN_LEAVES)),
        ("CANOPY_ROW", &(CANOPY as i32)),
        ("CANOPY_LAYERS", &(CANOPY_LAYERS as i32)),
        ("CANOPY_LAYER_ROWS", &(CANOPY_LAYER_ROWS as i32)),
        ("LITTER_AREA", &canopy::LITTER_AREA),
        ("PLANTING_SIDE", &(planting_map::SIDE as u32)),
        ("PATTERN_STEEPEST", &f64::from(PATTERN_STEEPEST)),
        ("PATTERN_ROUGHNESS", &f64::from(PATTERN_ROUGHNESS)),
        ("PATTERN_SIDE", &(patterns::SIDE as f64)),
        // LUTs
        ("OPTICAL_DEPTH_SIZE", &size(OPTICAL_DEPTH_SIZE)),
        ("MULTISCATTER_SIZE", &size(MULTISCATTER_SIZE)),
        ("TURNS_AT_ONCE", &TURNS_AT_ONCE),
        ("SEEN_TURNS", &SEEN_NODES[1]),
        ("GLOW_NODES", &size(GLOW_NODES)),
        ("GLOW_HALVES", &(GLOW_NODES[1] / TURNS_AT_ONCE)),
        ("IRRADIANCE_SIZE", &size(IRRADIANCE_SIZE)),
        ("SKY_SIZE", &size(SKY_SIZE)),
        ("IRRADIANCE_AT", &f64::from(IRRADIANCE_AT)),
        ("SKY_AT", &f64::from(SKY_AT)),
        ("SKY_LUT_SIZE", &size(SKY_LUT_SIZE)),
        ("CLOUD_MAP_SIDE", &f64::from(CLOUD_MAP_SIDE)),
        ("CLOUD_MAP_LEVELS", &f64::from(CLOUD_MAP_LEVELS)),
        ("CALM_SLOPE_VARIANCE", &CALM_SLOPE_VARIANCE),
        ("WAVE_SKEW", &WAVE_SKEW),
        ("WAVE_LOST", &WAVE_LOST),
        ("WAVE_ACROSS", &WAVE_ACROSS),
        ("LEAST_SKEWED", &LEAST_SKEWED),
        ("BED_REACH_M", &BED_REACH_M),
        ("WAVE_DEEP", &DEEP),
        ("WAVE_TURN", &TURN),
        ("WAVE_TURN_FALL", &TURN_FALL),
        ("WAVE_BREAKING", &BREAKING),
        ("WAVE_LEE", &LEE),
        ("WAVE_CROWDED", &CROWDED),
        ("ICE_DAMPING_M", &ICE_DAMPING_M),
        ("ICE_FIRST_COLDER_C", &ICE_COLDER_C[0]),
        ("ICE_CLOSED_COLDER_C", &ICE_COLDER_C[1]),
        ("FLOE_GRID", &FLOE_GRID),
        // Exposure
        ("METER_BINS", &METER_BINS),
        ("METER_STRIDE", &METER_STRIDE),
        ("METER_GROUP", &METER_GROUP),
    ];
    let mut text = String::new();
    for (name, value) in constants {
        text += &constant(name, *value);
    }
    for (number, view) in (0_u32..).zip(DebugView::ALL) {
        text += &constant(&format!("VIEW_{}", snake_case(&format!("{view:?}"))), &number);
    }
    for tone in Tone::ALL {
        text += &constant(&format!("TONE_{}", tone.label().to_uppercase()), &(tone as u32));
    }
    for (name, value) in tone::constants() {
        text += &constant(name, &*value);
    }
    let structs = [
        Frame::declaration(),
        Sun::declaration(),
        Occluder::declaration(),
        Point::declaration(),
        Storm::declaration(),
        RingClass::declaration(),
        Octave::declaration(),
        Wave::declaration(),
        CloudLayer::declaration(),
        Body::declaration(),
        MorphEye::declaration(),
        MeterStep::declaration(),
    ];
    text + &structs.concat()
}

/// `TILE_BORDERS` for `TileBorders`.
fn snake_case(name: &str) -> String {
    let mut out = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !out.is_empty() {
            out.push('_');
        }
        out.extend(letter.to_uppercase());
    }
    out
}
