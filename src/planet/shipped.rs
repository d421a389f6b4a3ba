//! The presets that come with the program.

use super::{LoadError, Planet};

/// A preset that is part of the program.
#[derive(Clone, Copy, Debug)]
pub struct Shipped {
    /// File name below `planets/`.
    pub file: &'static str,
    /// Its text.
    pub text: &'static str,
}

impl Shipped {
    /// Parses the preset. A test proves that this never fails.
    pub fn load(&self) -> Result<Planet, LoadError> {
        Planet::from_text(self.file, self.text)
    }
}

/// All shipped presets, the default planet first.
pub const ALL: &[Shipped] = &[
    Shipped { file: "aurel.ron", text: include_str!("../../planets/aurel.ron") },
    Shipped { file: "maren.ron", text: include_str!("../../planets/maren.ron") },
    Shipped { file: "cinnabar.ron", text: include_str!("../../planets/cinnabar.ron") },
    Shipped { file: "hoarfrost.ron", text: include_str!("../../planets/hoarfrost.ron") },
    Shipped { file: "pallor.ron", text: include_str!("../../planets/pallor.ron") },
    Shipped { file: "alder.ron", text: include_str!("../../planets/alder.ron") },
    Shipped { file: "skerry.ron", text: include_str!("../../planets/skerry.ron") },
    Shipped { file: "sabkha.ron", text: include_str!("../../planets/sabkha.ron") },
    Shipped { file: "garland.ron", text: include_str!("../../planets/garland.ron") },
];

/// The planet shown at the start: the first of [`ALL`].
pub fn default_planet() -> Planet {
    ALL.first().and_then(|shipped| shipped.load().ok()).unwrap_or_default()
}

/// A planet without a structure, for unit tests: continents, mountains, canyons and dunes are layers.
#[cfg(test)]
pub(crate) fn layered() -> Planet {
    Planet::from_text("layered.ron", include_str!("../../tests/fixtures/layered.ron")).expect("a valid fixture")
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    fn folder() -> std::path::PathBuf {
        std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("planets")
    }

    /// Run with `TELLUS_BLESS=1` to write the presets anew in the form that saving gives them.
    #[test]
    fn every_shipped_preset_loads_and_is_written_as_saving_writes_it() {
        for shipped in ALL {
            let path = folder().join(shipped.file);
            let planet = Planet::load(&path).unwrap_or_else(|error| panic!("{error}"));
            if std::env::var_os("TELLUS_BLESS").is_some() {
                planet.save(&path).unwrap();
            }
            assert!(planet.to_text() == std::fs::read_to_string(&path).unwrap(), "{}: bless it", shipped.file);
        }
    }

    #[test]
    fn every_preset_in_the_folder_is_shipped() {
        let files: BTreeSet<String> = std::fs::read_dir(folder())
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .filter(|name| name.ends_with(".ron"))
            .collect();
        assert_eq!(files, ALL.iter().map(|shipped| shipped.file.to_owned()).collect());
    }

    #[test]
    fn the_default_planet_is_the_first() {
        assert_eq!(default_planet(), ALL[0].load().unwrap());
        assert_ne!(default_planet(), Planet::default());
    }
}
