//! Presets of version 3, the current one: the versions, then the fields of [`Planet`].

use crate::planet::param::Curve;
use crate::planet::{
    Atmosphere, Biomes, Climate, Clouds, EditorNotes, GROUND_VERSION, Giant, GroundEdits, Layer, Planet, Population,
    Precision, Rings, Star, Structure, VERSION, Version, Water,
};
use serde::{Deserialize, Serialize};

/// Writes the file from the fields of the planet. They are spelt out because serde's `flatten` loses positions.
macro_rules! file {
    ($($(#[$attr:meta])* $field:ident: $type:ty,)+) => {
        /// The whole file.
        #[derive(Serialize, Deserialize)]
        #[serde(rename = "Planet", default, deny_unknown_fields)]
        pub(crate) struct File {
            pub(super) version: Version,
            /// [`GROUND_VERSION`] when the file was saved, of a planet with a structure.
            #[serde(skip_serializing_if = "Option::is_none")]
            pub(super) ground_version: Option<u32>,
            $($(#[$attr])* pub(super) $field: $type,)+
        }

        impl From<Planet> for File {
            fn from(planet: Planet) -> Self {
                let ground_version = planet.structure.is_some().then_some(GROUND_VERSION);
                Self { version: Version(VERSION), ground_version, $($field: planet.$field,)+ }
            }
        }

        impl From<File> for Planet {
            fn from(file: File) -> Self {
                Self { $($field: file.$field,)+ }
            }
        }
    };
}

file! {
    name: String,
    seed: u32,
    radius_km: f64,
    precision: Precision,
    settlements: f64,
    height_curve: Curve,
    star: Star,
    layers: Vec<Layer>,
    #[serde(skip_serializing_if = "GroundEdits::is_empty")]
    edits: GroundEdits,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    life: Vec<Population>,
    climate: Climate,
    biomes: Biomes,
    structure: Option<Structure>,
    water: Option<Water>,
    atmosphere: Option<Atmosphere>,
    clouds: Option<Clouds>,
    #[serde(skip_serializing_if = "Option::is_none")]
    giant: Option<Giant>,
    #[serde(skip_serializing_if = "Option::is_none")]
    rings: Option<Rings>,
    #[serde(skip_serializing_if = "Option::is_none")]
    editor: Option<EditorNotes>,
}

impl Default for File {
    fn default() -> Self {
        Planet::default().into()
    }
}
