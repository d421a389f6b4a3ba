//! Constants that the CPU and the shaders share, written out as the shader file `shared.wgsl`.

use super::biome_table::{ROCK, RULES};
use super::cloud_map::WEATHER_SIDE;
use super::exposure::{METER_BINS, METER_GROUP, METER_STRIDE, MeterStep};
use super::horizon_pool::IMAGES_ALONG;
use super::luts::{IRRADIANCE_SIZE, MULTISCATTER_SIZE, OPTICAL_DEPTH_SIZE, SKY_SIZE};
use super::material_maps::{PATTERN_ROUGHNESS, PATTERN_STEEPEST};
use super::morph::{MorphEye, SHOWN_BYTES};
use super::wgsl::{Constant, constant};
use super::{DebugView, Tone, material_noise, noise_tile, tone, uniforms};
use crate::lod::horizon::AZIMUTHS;
use crate::lod::morph::COARSEST_MORPHING;
use crate::lod::tile::{DETAIL_APRON, DETAIL_SIDE, TILE_QUADS, TILE_SIDE, TILE_VERTICES, Vertex};
use crate::sphere::cube::C_SQUARED;
use crate::terrain::border::{self, OCTAVE_TURN};
use std::mem::offset_of;

/// Plane waves of the sea near the eye.
pub(crate) const WAVES: usize = 16;
/// Octaves of the macro variation of ground and ice, coarse to fine: their periods in metres.
pub(crate) const MOTTLE_PERIODS_M: [f64; MOTTLE_OCTAVES] = [330_000.0, 41_000.0, 5100.0, 640.0, 80.0, 10.0, 1.25];
/// Octaves of the macro variation.
pub(crate) const MOTTLE_OCTAVES: usize = 7;
/// Octaves of the border jitter.
pub(crate) const BORDER_OCTAVES: usize = border::OCTAVES;
/// Bands of the noise that shapes clouds, widest first; each is turned against the one before, so that the repeats of
/// their tile never coincide.
pub(crate) const CLOUD_BANDS: usize = 6;
/// The band that makes puffs.
pub(crate) const CLOUD_PUFF_BAND: i32 = 3;
/// Biomes in a mixture: four cells of the biome table, each with the biome of its steep ground, beach and snow.
pub(crate) const MIXTURE_ENTRIES: u32 = 10;

/// The text of `shared.wgsl`.
pub(crate) fn text() -> String {
    let words = |bytes: usize| (bytes / size_of::<u32>()) as u32;
    let size = |size: [u32; 2]| size.map(f64::from);
    let constants: &[(&str, &dyn Constant)] = &[
        ("MAX_SUNS", &(super::MAX_SUNS as u32)),
        // Tiles
        ("TILE_QUADS", &(TILE_QUADS as u32)),
        ("TILE_SIDE", &(TILE_SIDE as u32)),
        ("TILE_VERTICES", &(TILE_VERTICES as u32)),
        ("DETAIL_SIDE", &(DETAIL_SIDE as f64)),
        ("DETAIL_APRON", &(DETAIL_APRON as i32)),
        ("HORIZON_AZIMUTHS", &(AZIMUTHS as u32)),
        ("HORIZON_IMAGES_ALONG", &(IMAGES_ALONG as u32)),
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
        ("NOISE_TILE_SIDE", &(noise_tile::SIDE as f64)),
        ("MOTTLE_OCTAVES", &(MOTTLE_OCTAVES as u32)),
        ("BORDER_OCTAVES", &(BORDER_OCTAVES as u32)),
        ("BORDER_GAIN", &border::GAIN),
        ("BORDER_TILE_SIDE", &(border::TILE_SIDE as f64)),
        ("CLOUD_BANDS", &(CLOUD_BANDS as i32)),
        ("CLOUD_PUFF_BAND", &CLOUD_PUFF_BAND),
        ("WAVES", &(WAVES as u32)),
        // Biomes
        ("BIOME_ROCK", &(ROCK as i32)),
        ("BIOME_RULES", &(RULES as i32)),
        ("MIXTURE_ENTRIES", &MIXTURE_ENTRIES),
        ("PATTERN_STEEPEST", &f64::from(PATTERN_STEEPEST)),
        ("PATTERN_ROUGHNESS", &f64::from(PATTERN_ROUGHNESS)),
        ("PATTERN_SIDE", &(material_noise::SIDE as f64)),
        // LUTs
        ("OPTICAL_DEPTH_SIZE", &size(OPTICAL_DEPTH_SIZE)),
        ("MULTISCATTER_SIZE", &size(MULTISCATTER_SIZE)),
        ("IRRADIANCE_SIZE", &size(IRRADIANCE_SIZE)),
        ("SKY_SIZE", &size(SKY_SIZE)),
        ("WEATHER_SIDE", &WEATHER_SIDE),
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
        uniforms::Frame::declaration(),
        uniforms::Sun::declaration(),
        uniforms::Octave::declaration(),
        uniforms::Wave::declaration(),
        uniforms::Body::declaration(),
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
