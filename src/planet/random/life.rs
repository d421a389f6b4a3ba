//! What stands on the ground of a random planet: plants of its biomes, in the colours of its leaves, and stones.

use super::Kind;
use super::dice::{Dice, three_digits};
use crate::planet::life::{ReadyPopulation, free_seed};
use crate::planet::{Biomes, Population};

/// Ready populations of vegetated ground: keys of the biomes, and which of them one is chosen.
const PLANTS: &[(&str, &[&str])] = &[
    ("j", &["Broadleaf tree"]),
    ("f", &["Broadleaf tree", "Birch", "Poplar", "Pine"]),
    ("k", &["Conifer"]),
    ("w", &["Acacia", "Broadleaf tree", "Palm"]),
    ("a", &["Acacia", "Alien bulbs", "Alien tendrils"]),
    ("gw", &["Grass"]),
    ("ac", &["Tall grass"]),
    ("gwf", &["Shrub", "Fern", "Alien fans"]),
    ("xc", &["Dry shrub"]),
    ("d", &["Column cactus", "Barrel cactus", "Dry shrub"]),
    ("t", &["Moss cushion"]),
    ("jfk", &["Fallen trunk"]),
    ("jfkw", &["Twigs"]),
];

/// Ready populations of stones of a kind of world.
fn stones(kind: Kind) -> &'static [&'static str] {
    match kind {
        Kind::Temperate => &["Boulder", "Scree"],
        Kind::Cold => &["Boulder", "Ice block"],
        Kind::Hot => &["Lava block", "Boulder", "Scree"],
        Kind::Dry => &["Ventifact", "Stones", "Boulder", "Scree"],
        Kind::Bare => &["Regolith stone", "Boulder"],
    }
}

/// Populations that suit the biomes.
pub(super) fn populations(kind: Kind, biomes: &Biomes, dice: &mut Dice) -> Vec<Population> {
    let mut found = Vec::new();
    if matches!(kind, Kind::Temperate | Kind::Cold) {
        for (keys, names) in PLANTS {
            let keys: String = keys.chars().filter(|key| biomes.index_of(*key).is_some()).collect();
            let name = *dice.pick(names);
            let (seed, height) = (dice.seed(), dice.between(0.8, 1.25));
            let Some(ready) = ReadyPopulation::named(name).filter(|_| !keys.is_empty()) else { continue };
            let ground =
                keys.chars().next().and_then(|key| biomes.index_of(key)).map(|index| biomes.palette[index].color);
            // The climate is that of the biome.
            let anywhere = Population::default();
            found.push(Population {
                seed: free_seed(&found, seed),
                biomes: keys,
                height_m: three_digits(ready.height_m * height),
                leaf_color: if name.starts_with("Alien") { ready.leaf_color } else { leaves(ground, ready.leaf_color) },
                temperature_from_c: anywhere.temperature_from_c,
                temperature_to_c: anywhere.temperature_to_c,
                moisture_from: anywhere.moisture_from,
                moisture_to: anywhere.moisture_to,
                ..ready
            });
        }
    }
    for name in stones(kind) {
        let seed = dice.seed();
        let Some(ready) = ReadyPopulation::named(name) else { continue };
        let rock = if *name == "Ice block" { ready.color } else { rock(biomes) };
        let darker = rock.map(|part| three_digits(0.7 * part));
        let seed = free_seed(&found, seed);
        found.push(Population { seed, color: rock, leaf_color: darker, ..ready });
    }
    found
}

/// The leaves over ground of a colour: in its hue, and brighter, because they shade one another; about as bright as
/// those of the ready population.
fn leaves(ground: Option<[f64; 3]>, ready: [f64; 3]) -> [f64; 3] {
    let Some(ground) = ground else { return ready };
    let sum = |color: [f64; 3]| color.iter().sum::<f64>().max(1e-3);
    let brightness = (1.5 * sum(ground)).clamp(0.7 * sum(ready), 2.5 * sum(ready));
    ground.map(|part| three_digits((part * brightness / sum(ground)).min(1.0)))
}

/// The colour of stones: that of the rock that all biomes share.
fn rock(biomes: &Biomes) -> [f64; 3] {
    biomes.cliff_color.map(three_digits)
}
