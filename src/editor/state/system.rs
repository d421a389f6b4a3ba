//! The system in whose sky the planet is drawn.

use crate::planet::shipped;
use crate::render::Worlds;
use crate::system::System;
use crate::system::shipped as systems;
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
    /// The body that is the open planet; None while the planet is another.
    pub here: Option<usize>,
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
        Ok(Self { origin: Origin::Shipped(index), worlds: Arc::new(Worlds::new(system, planets)), here: None })
    }

    /// A system file, with the presets that it names.
    ///
    /// # Errors
    /// What is wrong with the file or with a preset.
    pub fn file(path: PathBuf) -> Result<Self, String> {
        let system = System::load(&path).map_err(|error| error.to_string())?;
        let planets = system.load_planets(&path).map_err(|error| error.to_string())?;
        Ok(Self { origin: Origin::File(path), worlds: Arc::new(Worlds::new(system, planets)), here: None })
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
