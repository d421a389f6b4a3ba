//! The system in whose sky the planet is drawn.

use crate::planet::shipped;
use crate::render::Worlds;
use crate::system::{System, limits, shipped as systems};
use std::path::PathBuf;
use std::sync::Arc;

/// Where a system comes from.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Origin {
    /// The shipped system of this index.
    Shipped(usize),
    /// A file.
    File(PathBuf),
}

/// A system that is open.
#[derive(Clone, Debug)]
pub struct OpenSystem {
    /// Where it comes from.
    pub origin: Origin,
    /// Its bodies.
    pub worlds: Arc<Worlds>,
    /// What about it does not last.
    pub warnings: Vec<String>,
}

/// Where a planet to open is.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Preset {
    /// The shipped preset of this index.
    Shipped(usize),
    /// A file.
    File(PathBuf),
}

impl OpenSystem {
    /// A shipped system.
    ///
    /// # Errors
    /// Why it cannot be read.
    pub fn shipped(index: usize) -> Result<Self, String> {
        let shipped = systems::ALL.get(index).ok_or("there is no such system")?;
        let system = shipped.load().map_err(|error| error.to_string())?;
        let planets = shipped.planets(&system);
        Ok(Self::new(Origin::Shipped(index), Worlds::new(system, planets)))
    }

    /// A system file, with the presets that it names.
    ///
    /// # Errors
    /// What is wrong with the file or with a preset.
    pub fn file(path: PathBuf) -> Result<Self, String> {
        let system = System::load(&path).map_err(|error| error.to_string())?;
        let planets = system.load_planets(&path).map_err(|error| error.to_string())?;
        Ok(Self::new(Origin::File(path), Worlds::new(system, planets)))
    }

    fn new(origin: Origin, worlds: Worlds) -> Self {
        let warnings = limits::warnings(worlds.system(), &worlds.radii_m());
        let warnings = warnings.into_iter().map(|warning| warning.message).collect();
        Self { origin, worlds: Arc::new(worlds), warnings }
    }

    /// The preset of a body; None for stars and points.
    pub fn preset(&self, body: usize) -> Option<Preset> {
        let member = self.worlds.system().bodies.get(body)?;
        self.worlds.planet(body)?;
        match &self.origin {
            Origin::File(path) => {
                let folder = path.parent().map_or_else(PathBuf::new, std::path::Path::to_owned);
                let path = folder.join(&member.preset);
                // Without `..` in the title.
                Some(Preset::File(std::fs::canonicalize(&path).unwrap_or(path)))
            }
            Origin::Shipped(_) => {
                let name = member.preset.rsplit('/').next()?;
                shipped::ALL.iter().position(|shipped| shipped.file == name).map(Preset::Shipped)
            }
        }
    }

    /// The body to begin with: the first planet.
    pub fn first_planet(&self) -> Option<usize> {
        (0..self.worlds.system().bodies.len()).find(|body| self.worlds.planet(*body).is_some())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_planet_of_a_shipped_system_can_be_opened() {
        for index in 0..systems::ALL.len() {
            let open = OpenSystem::shipped(index).unwrap();
            let bodies = &open.worlds.system().bodies;
            for (number, body) in bodies.iter().enumerate() {
                assert_eq!(open.preset(number).is_some(), !body.preset.is_empty(), "{}", body.name);
            }
            assert!(open.first_planet().is_some());
        }
        assert!(OpenSystem::shipped(99).is_err());
    }
}
