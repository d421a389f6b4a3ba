//! What a new planet can begin as: a bare sphere, a planet that ships with the program, or a random one of a kind.

use crate::lod::scout;
use crate::planet::random::Kind;
use crate::planet::{Planet, shipped};

/// Name of a planet that nobody has named yet.
const UNNAMED: &str = "Untitled";
/// Seed of the pictures of random kinds.
const SHOWN_SEED: u64 = 7;

/// What a new planet begins as.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Template {
    /// A sphere without layers, air and water.
    Blank,
    /// A copy of the shipped planet with this file name.
    Shipped(&'static str),
    /// A random planet of a kind.
    Random(Kind),
}

/// A template with the texts that show it.
pub struct Entry {
    /// The template.
    pub template: Template,
    /// Its name.
    pub name: &'static str,
    /// What it is good for.
    pub note: &'static str,
}

const fn entry(template: Template, name: &'static str, note: &'static str) -> Entry {
    Entry { template, name, note }
}

/// All templates, in the order shown.
pub const ALL: [Entry; 14] = [
    entry(Template::Shipped("aurel.ron"), "Earth-like", "Plates, rains and rivers: deserts, forests, a snowy range"),
    entry(Template::Shipped("alder.ron"), "Old continents", "Wide worn lands with great rivers and rain forest"),
    entry(Template::Shipped("skerry.ron"), "Young islands", "Arcs of islands that plates push up"),
    entry(Template::Shipped("maren.ron"), "Archipelago", "Volcanoes, reefs and atolls from layers alone"),
    entry(Template::Shipped("sabkha.ron"), "Dry canyons", "Rivers that end in dry basins"),
    entry(Template::Shipped("cinnabar.ron"), "Red desert", "Thin dusty air, dunes, a great rift, no sea"),
    entry(Template::Shipped("hoarfrost.ron"), "Ice world", "Old ice with crevasses, open water at the equator"),
    entry(Template::Shipped("pallor.ron"), "Moon", "Craters and plains of lava under a black sky"),
    entry(Template::Shipped("garland.ron"), "Ringed giant", "Bands, jets and storms of a gas giant"),
    entry(Template::Blank, "Blank sphere", "Nothing yet: no layers, no water, no air"),
    entry(Template::Random(Kind::Temperate), "Random: temperate", "Seas, continents and clouds by chance"),
    entry(Template::Random(Kind::Cold), "Random: cold", "Ice and cold ground by chance"),
    entry(Template::Random(Kind::Dry), "Random: dry", "Deserts under thin air by chance"),
    entry(Template::Random(Kind::Hot), "Random: hot", "Scorched ground by chance"),
];

impl Template {
    /// The planet to begin with. `seed`: of a random one.
    pub fn planet(self, seed: u64) -> Planet {
        let made = match self {
            Template::Blank => Planet::default(),
            Template::Shipped(file) => {
                let preset = shipped::ALL.iter().find(|preset| preset.file == file);
                preset.and_then(|preset| preset.load().ok()).unwrap_or_default()
            }
            Template::Random(kind) => return scout::random_planet(Some(kind), seed),
        };
        Planet { name: UNNAMED.to_owned(), ..made }
    }

    /// The planet of its picture. Kinds do not share a seed: their colours would be alike.
    pub fn shown(self) -> Planet {
        let kind = if let Template::Random(kind) = self { kind as u64 } else { 0 };
        self.planet(SHOWN_SEED + kind)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::validate;

    #[test]
    fn every_template_is_a_planet_of_its_own() {
        let planets: Vec<Planet> = ALL.iter().map(|entry| entry.template.planet(3)).collect();
        for (planet, entry) in planets.iter().zip(&ALL) {
            assert!(validate::problems(planet).is_empty(), "{}", entry.name);
            let is_random = matches!(entry.template, Template::Random(_));
            assert!(is_random || planet.name == UNNAMED);
            assert_eq!(planets.iter().filter(|other| *other == planet).count(), 1, "{}", entry.name);
        }
        assert!(shipped::ALL.iter().all(|preset| ALL.iter().any(|e| e.template == Template::Shipped(preset.file))));
    }
}
