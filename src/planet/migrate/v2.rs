//! Presets of version 2: every kind of layer, heights not yet to the millimetre. Frozen: never edit it.

use super::FileV3;
use crate::planet::param::Curve;
use crate::planet::{Atmosphere, Biomes, Climate, Clouds, EditorNotes, Layer, Planet, Precision, Star, Version, Water};
use serde::Deserialize;

/// The whole file.
#[derive(Deserialize)]
#[serde(rename = "Planet", default, deny_unknown_fields)]
pub(super) struct File {
    pub(super) version: Version,
    pub(super) name: String,
    pub(super) seed: u32,
    pub(super) radius_km: f64,
    pub(super) height_curve: Curve,
    pub(super) star: Star,
    pub(super) layers: Vec<Layer>,
    pub(super) climate: Climate,
    pub(super) biomes: Biomes,
    pub(super) water: Option<Water>,
    pub(super) atmosphere: Option<Atmosphere>,
    pub(super) clouds: Option<Clouds>,
    pub(super) editor: Option<EditorNotes>,
}

impl Default for File {
    fn default() -> Self {
        Self {
            version: Version(2),
            name: "Unnamed".to_owned(),
            seed: 1,
            radius_km: 6371.0,
            height_curve: Curve::new(),
            star: Star::default(),
            layers: Vec::new(),
            climate: Climate::default(),
            biomes: Biomes::default(),
            water: None,
            atmosphere: None,
            clouds: None,
            editor: None,
        }
    }
}

impl From<File> for FileV3 {
    fn from(file: File) -> Self {
        let File {
            version: _,
            name,
            seed,
            radius_km,
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
        // The heights that it was made with.
        let precision = Precision::Classic;
        Planet {
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
        .into()
    }
}
