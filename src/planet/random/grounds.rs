//! Biomes that follow from a climate: which grounds a world has, and where they lie in its table.

use super::Kind;
use super::dice::{Dice, three_digits};
use crate::planet::{Biome, Biomes, Climate, Detail, Table};

/// A biome with the climate in which it lies: it is found where it is colder than this and at least so moist.
struct Ground {
    key: char,
    name: &'static str,
    color: [f64; 3],
    /// What it looks like from near, and the size of that.
    detail: (Detail, f64),
    below_c: f64,
    from_moisture: f64,
}

const fn ground(
    key: char,
    name: &'static str,
    color: [f64; 3],
    detail: (Detail, f64),
    below_c: f64,
    from_moisture: f64,
) -> Ground {
    Ground { key, name, color, detail, below_c, from_moisture }
}

/// For worlds with weather. The coldest that fits wins; among those, the wettest.
const LIVING: &[Ground] = &[
    ground('i', "Ice", [0.78, 0.82, 0.87], (Detail::Ice, 6.0), -14.0, 0.0),
    ground('s', "Snow", [0.70, 0.73, 0.76], (Detail::Snow, 4.0), -6.0, 0.0),
    ground('t', "Tundra", [0.19, 0.18, 0.12], (Detail::Gravel, 2.0), 1.0, 0.0),
    ground('c', "Cold steppe", [0.21, 0.19, 0.11], (Detail::Grass, 1.5), 8.0, 0.0),
    ground('k', "Taiga", [0.055, 0.09, 0.045], (Detail::Litter, 1.2), 8.0, 0.35),
    ground('g', "Grassland", [0.15, 0.18, 0.065], (Detail::Grass, 1.5), 20.0, 0.25),
    ground('x', "Dry scrub", [0.27, 0.22, 0.12], (Detail::Gravel, 1.6), 20.0, 0.0),
    ground('f', "Forest", [0.045, 0.085, 0.03], (Detail::Litter, 1.2), 20.0, 0.5),
    ground('d', "Desert", [0.45, 0.32, 0.17], (Detail::Sand, 2.5), 500.0, 0.0),
    ground('a', "Savanna", [0.24, 0.2, 0.075], (Detail::Grass, 1.8), 500.0, 0.3),
    ground('w', "Woodland", [0.09, 0.12, 0.04], (Detail::Grass, 1.5), 500.0, 0.5),
    ground('j', "Rain forest", [0.025, 0.065, 0.018], (Detail::Litter, 1.2), 500.0, 0.72),
];

/// For worlds without life.
const BARREN: &[Ground] = &[
    ground('i', "Frost", [0.62, 0.64, 0.66], (Detail::Snow, 4.0), -60.0, 0.3),
    ground('p', "Pale dust", [0.33, 0.31, 0.28], (Detail::Sand, 2.5), -10.0, 0.0),
    ground('r', "Regolith", [0.20, 0.18, 0.165], (Detail::Gravel, 2.0), 60.0, 0.0),
    ground('m', "Dark plain", [0.085, 0.08, 0.078], (Detail::Rock, 6.0), 60.0, 0.5),
    ground('o', "Ochre", [0.38, 0.23, 0.12], (Detail::Sand, 2.5), 500.0, 0.0),
    ground('b', "Baked rock", [0.16, 0.09, 0.06], (Detail::Mud, 2.0), 500.0, 0.5),
];

/// A palette and a table that follow from the climate.
pub(super) fn biomes(kind: Kind, climate: &Climate, dice: &mut Dice) -> Biomes {
    const COLUMNS: usize = 16;
    const ROWS: usize = 12;
    let choices = if matches!(kind, Kind::Temperate | Kind::Cold) { LIVING } else { BARREN };
    let (coldest_c, hottest_c) = ((climate.pole_c - 12.0).round(), (climate.equator_c + 4.0).round());
    // Barren grounds are named after their place in the range of the world, not after a thermometer.
    let (offset, stretch) = if choices.len() == LIVING.len() { (0.0, 1.0) } else { (hottest_c - 70.0, 0.6) };
    let shift = dice.between(-3.0, 3.0);
    let mut table = Table::uniform('?', COLUMNS, ROWS);
    let mut used = Vec::new();
    for row in 0..ROWS {
        let share = row as f64 / (ROWS - 1) as f64;
        let temperature = hottest_c + (coldest_c - hottest_c) * share + shift;
        for column in 0..COLUMNS {
            let moisture = (column as f64 + 0.5) / COLUMNS as f64;
            let fits = |g: &&Ground| {
                moisture >= g.from_moisture
                    && temperature < offset + g.below_c * if offset == 0.0 { 1.0 } else { stretch }
            };
            let coldest = choices.iter().filter(fits).map(|g| g.below_c).fold(f64::MAX, f64::min);
            let best = choices
                .iter()
                .filter(fits)
                .filter(|g| g.below_c == coldest)
                .max_by(|a, b| a.from_moisture.total_cmp(&b.from_moisture))
                .or(choices.last());
            if let Some(best) = best {
                table.set_key(column, row, best.key);
                if !used.contains(&best.key) {
                    used.push(best.key);
                }
            }
        }
    }
    let palette = choices
        .iter()
        .filter(|g| used.contains(&g.key))
        .map(|g| Biome {
            key: g.key,
            name: g.name.to_owned(),
            color: g.color.map(|c| three_digits((c * dice.between(0.88, 1.12)).min(1.0))),
            variation: dice.rounded(0.15, 0.4),
            roughness: if matches!(g.key, 'i' | 's') { 0.6 } else { 0.9 },
            detail: g.detail.0,
            detail_m: g.detail.1,
            ..Biome::default()
        })
        .collect();
    Biomes { coldest_c, hottest_c, palette, table, cliff_detail: Detail::Rock, ..Biomes::default() }
}
