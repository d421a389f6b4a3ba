//! The structure of a random wet world: between an old continent with great rivers and young, steep islands.

use super::dice::{Dice, three_digits};
use super::lands::steepness;
use crate::planet::{Plates, Rivers, Structure, Weather};

/// Plates, weather and rivers of a planet with a sea.
pub(super) fn structure(radius_km: f64, dice: &mut Dice) -> Structure {
    let islands = dice.chance(0.3);
    let age = if islands { dice.between(0.0, 0.4) } else { dice.between(0.1, 1.0) };
    // Lengths along the ground scale with the radius by themselves.
    let steepness = steepness(radius_km);
    let mountains_m = three_digits(steepness * (10_000.0 - 4000.0 * age) * dice.between(0.8, 1.1));
    let plates = Plates {
        seed: dice.seed(),
        count: if islands { dice.rounded(24.0, 40.0) } else { dice.rounded(8.0, 20.0) } as u32,
        continents: if islands { dice.rounded(0.22, 0.36) } else { dice.rounded(0.36, 0.6) },
        fragments: if islands { 1.0 } else { dice.rounded(0.2, 0.7) },
        mountains_m,
        belt_km: dice.rounded_log(250.0, 480.0),
        plateau_km: dice.rounded_log(300.0, 1100.0),
        old_belts_m: dice.rounded(1000.0, 2400.0),
        inland_m: dice.rounded(350.0, 800.0),
        shelf_km: dice.rounded_log(80.0, 240.0),
        arcs_m: if islands { dice.rounded(7000.0, 9500.0) } else { dice.rounded(4500.0, 7000.0) },
        hot_spots: if islands { dice.rounded(12.0, 28.0) } else { dice.rounded(4.0, 14.0) } as u32,
        ..Plates::default()
    };
    let weather = Weather {
        wetness: dice.rounded_log(0.8, 3.0),
        reach_km: dice.rounded_log(1500.0, 4500.0),
        rain_shadow: dice.rounded(0.8, 1.5),
        ..Weather::default()
    };
    let rivers = Rivers {
        seed: dice.seed(),
        age_myr: three_digits(6.0 * libm::pow(8.0, age)),
        erodibility: dice.rounded(0.8, 1.4),
        rock_variation: dice.rounded(0.4, 0.9),
        deposition: dice.rounded(0.8, 1.8),
        lakes: dice.rounded(0.6, 1.4),
        ..Rivers::default()
    };
    Structure { plates, weather, rivers, ..Structure::default() }
}
