//! The systems that come with the program.

use super::System;
use crate::planet::{LoadError, Planet, shipped};
use std::sync::Arc;

/// A system that is part of the program.
#[derive(Clone, Copy, Debug)]
pub struct Shipped {
    /// File name below `systems/`.
    pub file: &'static str,
    /// Its text.
    pub text: &'static str,
}

impl Shipped {
    /// Parses the system file. A test proves that this never fails.
    ///
    /// # Errors
    /// As [`System::from_text`].
    pub fn load(&self) -> Result<System, LoadError> {
        System::from_text(self.file, self.text)
    }

    /// The planets of its bodies, which are shipped presets; None for stars and points.
    pub fn planets(&self, system: &System) -> Vec<Option<Arc<Planet>>> {
        let planet = |preset: &str| {
            let name = preset.rsplit('/').next().unwrap_or_default();
            shipped::ALL.iter().find(|shipped| shipped.file == name)?.load().ok().map(Arc::new)
        };
        system.bodies.iter().map(|body| planet(&body.preset)).collect()
    }
}

/// All shipped systems.
pub const ALL: &[Shipped] = &[
    Shipped { file: "hearth.ron", text: include_str!("../../systems/hearth.ron") },
    Shipped { file: "twins.ron", text: include_str!("../../systems/twins.ron") },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::system::limits;
    use std::path::Path;

    /// Run with `TELLUS_BLESS=1` to write the systems anew in the form that saving gives them.
    #[test]
    fn every_shipped_system_loads_lasts_and_is_written_as_saving_writes_it() {
        let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("systems");
        assert_eq!(std::fs::read_dir(&folder).unwrap().count(), ALL.len());
        for shipped in ALL {
            let path = folder.join(shipped.file);
            let system = System::load(&path).unwrap_or_else(|error| panic!("{error}"));
            if std::env::var_os("TELLUS_BLESS").is_some() {
                system.save(&path).unwrap();
            }
            assert!(system.to_text() == std::fs::read_to_string(&path).unwrap(), "{}: bless it", shipped.file);
            let planets = system.load_planets(&path).unwrap_or_else(|error| panic!("{error}"));
            assert_eq!(planets, shipped.planets(&system));
            let radius_m = |(body, planet): (&crate::system::Member, &Option<Arc<Planet>>)| match planet {
                Some(planet) => planet.radius_m(),
                None => body.light.as_ref().map_or(0.0, crate::system::Light::radius_m),
            };
            let radii_m: Vec<f64> = system.bodies.iter().zip(&planets).map(radius_m).collect();
            assert_eq!(limits::warnings(&system, &radii_m), [], "{}", shipped.file);
        }
    }
}
