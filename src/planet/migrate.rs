//! Preset versions: one type for each version's file, and the chain from the oldest to the planet of today.
//!
//! Version 1 is current. When version 2 comes: copy what changes of version 1's types into `migrate/v1.rs` and freeze
//! them, write `impl From<v1::File> for v2::File` and nothing else about version 1, read version 2 here, and add
//! `tests/fixtures/preset_v2.ron` beside the fixture of version 1, which goes on loading for ever. Never edit a fixture,
//! and never migrate text.

use super::explain::parse;
use super::{Atmosphere, Biomes, Climate, Clouds, EditorNotes, Layer, Planet, Problem, Star, VERSION, Version, Water};
use serde::{Deserialize, Serialize};

/// Reads the text of a preset that says it is of `version`.
pub(crate) fn read(version: u32, text: &str) -> Result<Planet, Problem> {
    match version {
        1 => parse::<FileV1>(text).map(Planet::from),
        _ => Err(Problem {
            line: 1,
            column: 1,
            path: "version".to_owned(),
            message: format!("there is no version {version}; use {VERSION}"),
        }),
    }
}

/// The whole file: the version, then the fields of [`Planet`]. Spelt out because serde's `flatten` loses positions.
#[derive(Serialize, Deserialize)]
#[serde(rename = "Planet", default, deny_unknown_fields)]
pub(crate) struct FileV1 {
    version: Version,
    name: String,
    seed: u32,
    radius_km: f64,
    star: Star,
    layers: Vec<Layer>,
    climate: Climate,
    biomes: Biomes,
    water: Option<Water>,
    atmosphere: Option<Atmosphere>,
    clouds: Option<Clouds>,
    #[serde(skip_serializing_if = "Option::is_none")]
    editor: Option<EditorNotes>,
}

impl Default for FileV1 {
    fn default() -> Self {
        Planet::default().into()
    }
}

impl From<Planet> for FileV1 {
    fn from(planet: Planet) -> Self {
        let Planet { name, seed, radius_km, star, layers, climate, biomes, water, atmosphere, clouds, editor } = planet;
        let version = Version(VERSION);
        Self { version, name, seed, radius_km, star, layers, climate, biomes, water, atmosphere, clouds, editor }
    }
}

impl From<FileV1> for Planet {
    fn from(file: FileV1) -> Self {
        let FileV1 {
            version: _,
            name,
            seed,
            radius_km,
            star,
            layers,
            climate,
            biomes,
            water,
            atmosphere,
            clouds,
            editor,
        } = file;
        Self { name, seed, radius_km, star, layers, climate, biomes, water, atmosphere, clouds, editor }
    }
}
