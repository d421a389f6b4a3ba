//! Preset versions: one type for each version's file, and the chain from the oldest to the planet of today.
//!
//! - `v1`, `v2`: versions 1 and 2, frozen
//!
//! Version 3 is current. When version 4 comes: copy what changes of version 3's types into `migrate/v3.rs` and freeze
//! them, write `impl From<v3::File> for FileV4` and nothing else about version 3, read version 4 here, and add
//! `tests/fixtures/preset_v4.ron` beside the fixtures of the versions before, which go on loading for ever. Never edit
//! a fixture, and never migrate text.

mod v1;
mod v2;

use super::explain::parse;
use super::param::Curve;
use super::{
    Atmosphere, Biomes, Climate, Clouds, EditorNotes, Layer, Planet, Precision, Problem, Star, VERSION, Version, Water,
};
use serde::{Deserialize, Serialize};

/// Reads the text of a preset that says it is of `version`.
pub(crate) fn read(version: u32, text: &str) -> Result<Planet, Problem> {
    match version {
        1 => parse::<v1::File>(text).map(v2::File::from).map(FileV3::from).map(Planet::from),
        2 => parse::<v2::File>(text).map(FileV3::from).map(Planet::from),
        3 => parse::<FileV3>(text).map(Planet::from),
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
pub(crate) struct FileV3 {
    version: Version,
    name: String,
    seed: u32,
    radius_km: f64,
    precision: Precision,
    height_curve: Curve,
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

impl Default for FileV3 {
    fn default() -> Self {
        Planet::default().into()
    }
}

impl From<Planet> for FileV3 {
    fn from(planet: Planet) -> Self {
        let Planet {
            name,
            seed,
            radius_km,
            precision,
            height_curve,
            star,
            layers,
            climate,
            biomes,
            water,
            atmosphere,
            clouds,
            editor,
        } = planet;
        let version = Version(VERSION);
        Self {
            version,
            name,
            seed,
            radius_km,
            precision,
            height_curve,
            star,
            layers,
            climate,
            biomes,
            water,
            atmosphere,
            clouds,
            editor,
        }
    }
}

impl From<FileV3> for Planet {
    fn from(file: FileV3) -> Self {
        let FileV3 {
            version: _,
            name,
            seed,
            radius_km,
            precision,
            height_curve,
            star,
            layers,
            climate,
            biomes,
            water,
            atmosphere,
            clouds,
            editor,
        } = file;
        Self {
            name,
            seed,
            radius_km,
            precision,
            height_curve,
            star,
            layers,
            climate,
            biomes,
            water,
            atmosphere,
            clouds,
            editor,
        }
    }
}
