//! Starting biome tables, each with its own palette. The texts in `tables/` are biome sections of a preset; missing
//! fields have their defaults. Climates after Whittaker (Communities and Ecosystems, 1975) and Holdridge's life zones,
//! coarsened; colours by eye.

use super::Biomes;

/// A named biome table with its palette.
#[derive(Clone, Copy, Debug)]
pub struct StartingTable {
    /// Display name.
    pub name: &'static str,
    /// A short description.
    pub note: &'static str,
    text: &'static str,
}

impl StartingTable {
    /// The biome section. A test proves that it always parses.
    pub fn biomes(&self) -> Option<Biomes> {
        ron::from_str(self.text).ok()
    }
}

/// All starting tables, the Earth's first.
pub const STARTING_TABLES: &[StartingTable] = &[
    StartingTable {
        name: "Earth",
        note: "Desert to rain forest, tundra to ice, by temperature and moisture",
        text: include_str!("tables/earth.ron"),
    },
    StartingTable {
        name: "Earth by height",
        note: "The classic: beaches, plains, forests, rock and snow by height and moisture",
        text: include_str!("tables/height.ron"),
    },
    StartingTable {
        name: "Mars",
        note: "Rust, dust and black sand under polar frost",
        text: include_str!("tables/mars.ron"),
    },
    StartingTable {
        name: "Ice",
        note: "Snow, firn, blue ice; moraine where it thaws",
        text: include_str!("tables/ice.ron"),
    },
    StartingTable {
        name: "Desert",
        note: "Dunes, salt and red rock, green in the wettest places alone",
        text: include_str!("tables/desert.ron"),
    },
    StartingTable {
        name: "Alien",
        note: "Violet moss, turquoise mats and yellow crust",
        text: include_str!("tables/alien.ron"),
    },
];

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Planet, validate};

    #[test]
    fn each_is_valid_uses_its_whole_palette_and_can_be_painted_on() {
        for table in STARTING_TABLES {
            let biomes: Biomes = ron::from_str(table.text).unwrap_or_else(|error| panic!("{}: {error}", table.name));
            assert_eq!(table.biomes().as_ref(), Some(&biomes));
            assert!(biomes.table.columns() >= 8 && biomes.table.rows().len() >= 8, "{}", table.name);
            for biome in &biomes.palette {
                assert!(
                    biomes.table.rows().iter().any(|row| row.contains(biome.key)),
                    "{}: {}",
                    table.name,
                    biome.name
                );
            }
            let planet = Planet { biomes, ..Planet::default() };
            assert_eq!(validate::problems(&planet), vec![], "{}", table.name);
        }
    }
}
