//! Biomes that suit a climate: the palette of a world and its biome table.

use super::Kind;
use super::dice::{Dice, three_digits};
use crate::planet::{Biome, Biomes, Climate, Detail, Table, TableRows};

/// A biome with its climate: ground colder than this and at least this moist.
struct Ground {
    key: char,
    name: &'static str,
    color: [f64; 3],
    /// Close-up pattern, that of its patches, and the period of both.
    detail: (Detail, Detail, f64),
    below_c: f64,
    from_moisture: f64,
}

/// Ground that is found below a temperature and from a moisture.
const fn ground(
    key: char,
    name: &'static str,
    color: [f64; 3],
    detail: (Detail, Detail, f64),
    fits: [f64; 2],
) -> Ground {
    Ground { key, name, color, detail, below_c: fits[0], from_moisture: fits[1] }
}

/// For worlds with weather. The coldest that fits wins; among those, the wettest.
const LIVING: &[Ground] = &[
    ground('i', "Ice", [0.78, 0.82, 0.87], (Detail::Ice, Detail::Snow, 6.0), [-14.0, 0.0]),
    ground('b', "Blue ice", [0.36, 0.50, 0.62], (Detail::BlueIce, Detail::Ice, 6.0), [-14.0, 0.52]),
    ground('s', "Snow", [0.70, 0.73, 0.76], (Detail::Snow, Detail::Crust, 4.5), [-6.0, 0.0]),
    ground('t', "Tundra", [0.19, 0.18, 0.12], (Detail::Gravel, Detail::Moss, 2.0), [1.0, 0.0]),
    ground('c', "Cold steppe", [0.21, 0.19, 0.11], (Detail::Steppe, Detail::Grass, 3.0), [8.0, 0.0]),
    ground('k', "Taiga", [0.055, 0.09, 0.045], (Detail::Needles, Detail::Moss, 2.4), [8.0, 0.35]),
    ground('g', "Grassland", [0.15, 0.18, 0.065], (Detail::Grass, Detail::Steppe, 2.6), [20.0, 0.25]),
    ground('x', "Dry scrub", [0.27, 0.22, 0.12], (Detail::Steppe, Detail::Gravel, 3.0), [20.0, 0.0]),
    ground('f', "Forest", [0.045, 0.085, 0.03], (Detail::Litter, Detail::Moss, 2.4), [20.0, 0.5]),
    ground('d', "Desert", [0.45, 0.32, 0.17], (Detail::Sand, Detail::Gravel, 2.5), [500.0, 0.0]),
    ground('a', "Savanna", [0.24, 0.2, 0.075], (Detail::Steppe, Detail::Grass, 3.0), [500.0, 0.3]),
    ground('w', "Woodland", [0.09, 0.12, 0.04], (Detail::Grass, Detail::Litter, 2.6), [500.0, 0.5]),
    ground('j', "Rain forest", [0.025, 0.065, 0.018], (Detail::Litter, Detail::Moss, 2.4), [500.0, 0.72]),
];

/// A biome with patches that differ from the rest by their pattern, and a little by their brightness.
fn patched(color: [f64; 3], patch_detail: Detail) -> Biome {
    const SHADE: f64 = 0.9;
    Biome {
        patches: 0.35,
        patch_color: color.map(|c| three_digits(SHADE * c)),
        patch_m: 25.0,
        patch_detail,
        ..Biome::default()
    }
}

/// The pattern that takes a pattern's place on a world without air, which has no ripples and no crumbs of earth.
fn without_wind(kind: Kind, detail: Detail) -> Detail {
    let is_dust = matches!(detail, Detail::Sand | Detail::Soil);
    if kind == Kind::Bare && is_dust { Detail::Regolith } else { detail }
}

/// Keys of vegetated ground.
const FOLIAGE: [char; 8] = ['k', 'g', 'f', 'a', 'w', 'j', 'c', 'x'];

/// How the red, green and blue of green leaves make the colours of other leaves.
type Leaves = [[f64; 3]; 3];

const GREEN: Leaves = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
const LEAVES: &[Leaves] = &[
    GREEN,
    GREEN,
    GREEN,
    GREEN,
    // Red: they leave little of the green.
    [[0.2, 1.1, 0.0], [0.3, 0.12, 0.0], [0.0, 0.15, 0.7]],
    // Violet.
    [[0.2, 0.75, 0.0], [0.3, 0.15, 0.0], [0.0, 0.65, 0.5]],
    // Teal.
    [[0.35, 0.1, 0.0], [0.0, 0.9, 0.0], [0.0, 0.7, 0.3]],
    // Gold.
    [[0.6, 1.2, 0.0], [0.2, 0.75, 0.0], [0.0, 0.1, 0.5]],
];

/// Ground colours of a world without weather, the darkest first.
type Shades = [[f64; 3]; 5];

const DESERTS: &[Shades] = &[
    // Rust.
    [[0.10, 0.045, 0.03], [0.20, 0.09, 0.05], [0.33, 0.16, 0.085], [0.42, 0.25, 0.14], [0.50, 0.36, 0.23]],
    // Ochre.
    [[0.09, 0.07, 0.05], [0.20, 0.14, 0.08], [0.34, 0.24, 0.13], [0.43, 0.33, 0.20], [0.52, 0.44, 0.32]],
    // Ash.
    [[0.05, 0.05, 0.055], [0.11, 0.10, 0.10], [0.19, 0.17, 0.155], [0.30, 0.26, 0.22], [0.42, 0.37, 0.31]],
    // Bone.
    [[0.16, 0.12, 0.10], [0.28, 0.21, 0.16], [0.38, 0.31, 0.24], [0.48, 0.42, 0.34], [0.56, 0.52, 0.45]],
];

const MOONS: &[Shades] = &[
    // Basalt and dust.
    [[0.05, 0.049, 0.052], [0.095, 0.092, 0.088], [0.165, 0.158, 0.148], [0.245, 0.236, 0.22], [0.36, 0.35, 0.335]],
    // Browned by age.
    [[0.06, 0.05, 0.045], [0.12, 0.10, 0.085], [0.19, 0.165, 0.14], [0.27, 0.24, 0.21], [0.38, 0.35, 0.32]],
];

/// A palette and a biome table that suit the climate.
pub(super) fn biomes(kind: Kind, climate: &Climate, dice: &mut Dice) -> Biomes {
    let mut biomes =
        if matches!(kind, Kind::Temperate | Kind::Cold) { living(climate, dice) } else { strata(kind, dice) };
    // Beaches and snow name a biome even if they are off, so that they can be switched on by hand.
    biomes.name_missing(true);
    biomes
}

/// Vegetated ground, by temperature and moisture.
fn living(climate: &Climate, dice: &mut Dice) -> Biomes {
    const COLUMNS: usize = 16;
    const ROWS: usize = 12;
    let (coldest_c, hottest_c) = ((climate.pole_c - 12.0).round(), (climate.equator_c + 4.0).round());
    let shift = dice.between(-3.0, 3.0);
    let mut table = Table::uniform('?', COLUMNS, ROWS);
    let mut used = Vec::new();
    for row in 0..ROWS {
        let share = row as f64 / (ROWS - 1) as f64;
        let temperature = hottest_c + (coldest_c - hottest_c) * share + shift;
        for column in 0..COLUMNS {
            let moisture = (column as f64 + 0.5) / COLUMNS as f64;
            let fits = |g: &&Ground| moisture >= g.from_moisture && temperature < g.below_c;
            let coldest = LIVING.iter().filter(fits).map(|g| g.below_c).fold(f64::MAX, f64::min);
            let best = LIVING
                .iter()
                .filter(fits)
                .filter(|g| g.below_c == coldest)
                .max_by(|a, b| a.from_moisture.total_cmp(&b.from_moisture))
                .or(LIVING.last());
            if let Some(best) = best {
                table.set_key(column, row, best.key);
                if !used.contains(&best.key) {
                    used.push(best.key);
                }
            }
        }
    }
    let leaves = *dice.pick(LEAVES);
    let tinted = |ground: &Ground| {
        let mixed = leaves.map(|row| row.iter().zip(ground.color).map(|(share, c)| share * c).sum());
        if FOLIAGE.contains(&ground.key) { mixed } else { ground.color }
    };
    let palette = LIVING
        .iter()
        .filter(|g| used.contains(&g.key))
        .map(|g| {
            let color = tinted(g).map(|c: f64| three_digits((c * dice.between(0.88, 1.12)).min(1.0)));
            Biome {
                key: g.key,
                name: g.name.to_owned(),
                color,
                variation: dice.rounded(0.15, 0.4),
                roughness: if matches!(g.key, 'i' | 's' | 'b') { 0.6 } else { 0.9 },
                detail: g.detail.0,
                detail_m: g.detail.2,
                ..patched(color, g.detail.1)
            }
        })
        .collect();
    Biomes { coldest_c, hottest_c, palette, table, cliff_detail: Detail::Rock, ..Biomes::default() }
}

/// Bands of ground by height, frayed by the moisture noise: dust and bedrock.
fn strata(kind: Kind, dice: &mut Dice) -> Biomes {
    const COLUMNS: usize = 12;
    const ROWS: usize = 12;
    const NAMES: [(char, &str, [Detail; 2], f64); 5] = [
        ('m', "Dark rock", [Detail::Basalt, Detail::Scree], 5.0),
        ('d', "Gravel", [Detail::Gravel, Detail::Soil], 2.0),
        ('g', "Plain", [Detail::Gravel, Detail::Sand], 1.8),
        ('p', "Pale dust", [Detail::Sand, Detail::Gravel], 2.5),
        ('b', "Bright ground", [Detail::Sand, Detail::Scree], 2.5),
    ];
    let shades = *dice.pick(if kind == Kind::Bare { MOONS } else { DESERTS });
    // Lava darkens the lowlands of moons; sand brightens those of many deserts.
    let upside_down = kind != Kind::Bare && dice.chance(0.5);
    let fray = dice.between(0.3, 0.6);
    let light = dice.between(0.85, 1.1);
    let mut table = Table::uniform('g', COLUMNS, ROWS);
    for (row, column) in (0..ROWS).flat_map(|row| (0..COLUMNS).map(move |column| (row, column))) {
        let height = 1.0 - row as f64 / (ROWS - 1) as f64;
        let level = if upside_down { 1.0 - height } else { height };
        let along = column as f64 / (COLUMNS - 1) as f64 - 0.5;
        let shade = ((level + fray * along).clamp(0.0, 0.999) * NAMES.len() as f64) as usize;
        table.set_key(column, row, NAMES[shade].0);
    }
    let mut palette: Vec<Biome> = NAMES
        .iter()
        .zip(shades)
        .map(|((key, name, details, detail_m), color)| {
            let color = color.map(|c| three_digits(c * light));
            let [detail, patch_detail] = details.map(|detail| without_wind(kind, detail));
            Biome {
                key: *key,
                name: (*name).to_owned(),
                color,
                variation: dice.rounded(0.12, 0.25),
                roughness: 0.95,
                detail,
                detail_m: *detail_m,
                ..patched(color, patch_detail)
            }
        })
        .collect();
    // On some hot worlds the dark lowlands still flow.
    if kind == Kind::Hot && !upside_down && dice.chance(0.6) {
        let lava = Biome {
            name: "Lava".to_owned(),
            color: [0.03, 0.025, 0.024],
            detail: Detail::Lava,
            patch_detail: Detail::RopeLava,
            detail_m: dice.rounded(8.0, 20.0),
            glow: dice.rounded_log(0.2, 1.0),
            flow_m_s: dice.rounded(0.1, 0.6),
            ..palette[0].clone()
        };
        palette[0] = lava;
    }
    let (lowest_m, highest_m) = if kind == Kind::Bare { (-2000.0, 2500.0) } else { (-2500.0, 4500.0) };
    let cliff_color = shades[1].map(|c| three_digits(c * 0.8));
    Biomes {
        rows: TableRows::Elevation,
        lowest_m,
        highest_m,
        cliff_color,
        cliff_detail: Detail::Rock,
        palette,
        table,
        ..Biomes::default()
    }
}
