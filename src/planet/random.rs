//! Random planets: always valid, plausible, and the same for the same seed on every machine.
//!
//! - `dice`: the pseudo-random numbers
//! - `grounds`: biomes that follow from a climate
//!
//! [`random`] makes a planet from nothing: a few layers that build on each other, a climate, and biomes that follow
//! from it. [`vary`] moves the numbers of a planet that there is. Neither knows more of a parameter than its
//! description, where that is enough.

mod dice;
mod grounds;

use super::param::Stage;
use super::{
    Atmosphere, Blend, Climate, Clouds, Fbm, Layer, LayerMask, Mask, Planet, Precision, Ridged, Shape, Star, Water,
    validate,
};
use dice::{Dice, three_digits};

/// A random planet that is always valid; the same seed gives the same planet.
pub fn random(seed: u64) -> Planet {
    let mut dice = Dice(seed);
    // The climate decides the rest: what is frozen has no clouds, what is hot no sea.
    let kind = *dice.pick(&[Kind::Temperate, Kind::Temperate, Kind::Temperate, Kind::Cold, Kind::Hot, Kind::Bare]);
    let radius_km = dice.rounded_log(if kind == Kind::Bare { 400.0 } else { 2500.0 }, 12_000.0);
    let climate = climate(kind, radius_km, &mut dice);
    let layers = layers(kind, radius_km, &mut dice);
    let water = (kind != Kind::Bare && kind != Kind::Hot && dice.chance(0.85)).then(|| Water {
        level_m: (dice.between(-0.25, 0.25) * layers.first().map_or(0.0, |l| l.amplitude_m)).round(),
        wind_m_s: dice.rounded(2.0, 15.0),
        color: dice.color([0.002, 0.02, 0.03], [0.01, 0.04, 0.07]),
        ..Water::default()
    });
    let air = kind != Kind::Bare && (water.is_some() || dice.chance(0.7));
    let clouds = (air && dice.chance(if water.is_some() { 0.9 } else { 0.4 })).then(|| Clouds {
        coverage: dice.rounded(0.2, 0.7),
        scale_km: three_digits(radius_km * dice.between(0.2, 0.5)),
        curl: dice.rounded(0.3, 1.2),
        seed: dice.seed(),
        wind_km_h: dice.rounded(-120.0, 120.0),
        ..Clouds::default()
    });
    let planet = Planet {
        name: dice.name(),
        seed: dice.seed(),
        radius_km,
        precision: Precision::default(),
        height_curve: Vec::new(),
        star: Star {
            latitude_deg: dice.rounded(-24.0, 24.0),
            color: dice.color([0.9, 0.85, 0.75], [1.0, 0.98, 1.0]),
            ..Star::default()
        },
        layers,
        biomes: grounds::biomes(kind, &climate, &mut dice),
        climate,
        water,
        atmosphere: air.then(|| atmosphere(kind, &mut dice)),
        clouds,
        editor: None,
    };
    debug_assert!(validate::problems(&planet).is_empty());
    planet
}

/// A variation of a planet: its numbers moved by up to `strength` (0 to 1) of their range;
/// always valid if the planet is.
///
/// Names, letters, switches and choices stay: it is the same planet, only different.
pub fn vary(planet: &Planet, seed: u64, strength: f64) -> Planet {
    let strength = if strength.is_finite() { strength.clamp(0.0, 1.0) } else { 0.0 };
    let mut dice = Dice(seed);
    let mut varied = planet.clone();
    varied.each(&mut |_, param, mut value| {
        let shown = !param.stages.contains(Stage::Label);
        if let Some(new) = dice.moved(param, &value.get(), strength).filter(|_| shown) {
            value.set(&new);
        }
    });
    // What several numbers must agree on.
    let biomes = &mut varied.biomes;
    if biomes.coldest_c >= biomes.hottest_c {
        (biomes.coldest_c, biomes.hottest_c) = (planet.biomes.coldest_c, planet.biomes.hottest_c);
    }
    if biomes.lowest_m >= biomes.highest_m {
        (biomes.lowest_m, biomes.highest_m) = (planet.biomes.lowest_m, planet.biomes.highest_m);
    }
    if biomes.cliff_start_deg > biomes.cliff_full_deg {
        std::mem::swap(&mut biomes.cliff_start_deg, &mut biomes.cliff_full_deg);
    }
    for (layer, old) in varied.layers.iter_mut().zip(&planet.layers) {
        for (mask, old) in layer.masks.iter_mut().zip(&old.masks) {
            let [from, to] = mask.ends();
            if from.1 == to.1 {
                *mask = old.clone();
            }
            // Slope masks that measure over one distance go on sharing it, for there may be only a few.
            if let (Mask::Slope(slope), Mask::Slope(old)) = (mask, old) {
                slope.over_m = old.over_m;
            }
        }
    }
    varied
}

/// What sort of world.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    Temperate,
    Cold,
    Hot,
    /// Without air: a moon.
    Bare,
}

/// Ground, mountains where a mask lets them, and what else the dice say.
fn layers(kind: Kind, radius_km: f64, dice: &mut Dice) -> Vec<Layer> {
    // Smaller planets bear higher mountains, but not without end.
    let relief_m = 4000.0 * (6371.0 / radius_km).powf(0.3) * dice.between(0.6, 1.4);
    let wavelength = |dice: &mut Dice, low: f64, high: f64| three_digits(radius_km * dice.between(low, high));
    let metres = |share: f64| three_digits(relief_m * share);
    let named = |name: &str, dice: &mut Dice| Layer { name: name.to_owned(), seed: dice.seed(), ..Layer::default() };
    let mask =
        |layer: &str, from: f64, to: f64| Mask::Layer(LayerMask { layer: layer.to_owned(), from, to, invert: false });

    let first = if kind == Kind::Bare { "Highlands" } else { "Continents" };
    let mut layers = vec![Layer {
        amplitude_m: metres(1.0),
        bias: dice.rounded(-0.15, 0.1),
        shape: Shape::Fbm(Fbm {
            wavelength_km: wavelength(dice, 0.5, 1.1),
            octaves: 14,
            gain: dice.rounded(0.42, 0.52),
            ..Fbm::default()
        }),
        ..named(first, dice)
    }];
    layers.push(Layer {
        amplitude_m: metres(dice.between(0.8, 1.3)),
        bias: dice.rounded(0.6, 1.0),
        shape: Shape::Ridged(Ridged {
            wavelength_km: wavelength(dice, 0.06, 0.18),
            octaves: 14,
            gain: dice.rounded(0.42, 0.55),
            ..Ridged::default()
        }),
        masks: vec![mask(first, dice.rounded(-0.1, 0.1), dice.rounded(0.2, 0.6))],
        ..named("Mountains", dice)
    });
    layers.push(Layer {
        amplitude_m: metres(dice.between(0.05, 0.15)),
        shape: Shape::Fbm(Fbm {
            wavelength_km: wavelength(dice, 0.01, 0.03),
            octaves: 12,
            gain: dice.rounded(0.45, 0.6),
            ..Fbm::default()
        }),
        ..named("Hills", dice)
    });
    if dice.chance(0.5) {
        layers.push(Layer {
            amplitude_m: metres(dice.between(0.15, 0.4)),
            blend: Blend::Subtract,
            bias: 0.8,
            shape: Shape::Ridged(Ridged {
                wavelength_km: wavelength(dice, 0.08, 0.3),
                octaves: 8,
                gain: dice.rounded(0.35, 0.45),
                ..Ridged::default()
            }),
            masks: vec![mask("Hills", dice.rounded(0.2, 0.4), dice.rounded(-0.3, 0.0))],
            ..named("Rifts", dice)
        });
    }
    if dice.chance(0.4) {
        layers.push(Layer {
            amplitude_m: metres(dice.between(0.2, 0.5)),
            bias: dice.rounded(-0.2, 0.2),
            shape: Shape::Fbm(Fbm { wavelength_km: wavelength(dice, 0.15, 0.4), octaves: 10, ..Fbm::default() }),
            ..named("Plateaus", dice)
        });
    }
    if dice.chance(0.3) {
        layers.push(Layer {
            amplitude_m: metres(0.4),
            bias: 0.9,
            shape: Shape::Ridged(Ridged {
                wavelength_km: wavelength(dice, 0.02, 0.05),
                octaves: 10,
                gain: 0.5,
                ..Ridged::default()
            }),
            masks: vec![mask("Mountains", dice.rounded(0.3, 0.6), dice.rounded(-0.2, 0.1))],
            ..named("Foothills", dice)
        });
    }
    layers
}

fn climate(kind: Kind, radius_km: f64, dice: &mut Dice) -> Climate {
    let equator_c = match kind {
        Kind::Temperate => dice.rounded(22.0, 34.0),
        Kind::Cold => dice.rounded(-15.0, 8.0),
        Kind::Hot => dice.rounded(60.0, 200.0),
        Kind::Bare => dice.rounded(-60.0, 60.0),
    };
    Climate {
        equator_c,
        pole_c: (equator_c - dice.between(35.0, 70.0)).round(),
        moisture: if kind == Kind::Temperate { dice.rounded(0.35, 0.65) } else { dice.rounded(0.1, 0.5) },
        moisture_variation: dice.rounded(0.4, 1.0),
        temperature_variation_c: dice.rounded(2.0, 8.0),
        belts: dice.rounded(0.1, 0.5),
        wavelength_km: three_digits(radius_km * dice.between(0.3, 0.6)),
        seed: dice.seed(),
        ..Climate::default()
    }
}

fn atmosphere(kind: Kind, dice: &mut Dice) -> Atmosphere {
    let earth = Atmosphere::default();
    // Thin on cold worlds, thick on hot ones; dust makes the sky yellow and red.
    let thickness = match kind {
        Kind::Hot => dice.between(1.0, 3.0),
        Kind::Cold => dice.between(0.3, 1.0),
        _ => dice.between(0.7, 1.5),
    };
    let dust = if kind == Kind::Temperate { dice.between(0.5, 2.0) } else { dice.between(1.0, 5.0) };
    let tint = dice.color([0.7, 0.7, 0.7], [1.3, 1.3, 1.3]);
    let scaled = |color: [f64; 3], factor: f64| color.map(|c| three_digits(c * factor));
    let mut rayleigh_per_km = scaled(earth.rayleigh_per_km, thickness);
    for (component, tint) in rayleigh_per_km.iter_mut().zip(tint) {
        *component = three_digits(*component * tint);
    }
    Atmosphere {
        rayleigh_per_km,
        mie_scattering_per_km: scaled(earth.mie_scattering_per_km, dust),
        mie_absorption_per_km: scaled(earth.mie_absorption_per_km, dust),
        ..earth
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn assert_valid(planet: &Planet) -> Result<(), TestCaseError> {
        let problems = validate::problems(planet);
        prop_assert!(problems.is_empty(), "{problems:?}");
        Ok(())
    }

    proptest! {
        #[test]
        fn random_planets_are_valid_and_repeatable(seed: u64) {
            let planet = random(seed);
            assert_valid(&planet)?;
            prop_assert!((3..=6).contains(&planet.layers.len()));
            prop_assert!(planet.biomes.palette.len() >= 2, "{:?}", planet.biomes.table);
            prop_assert_eq!(planet, random(seed));
        }

        #[test]
        fn variations_are_valid(seed: u64, other: u64, strength in 0.0..=1.0_f64) {
            assert_valid(&vary(&random(seed), other, strength))?;
        }
    }

    #[test]
    fn no_strength_changes_nothing_and_some_does() {
        let planet = random(5);
        assert_eq!(vary(&planet, 9, 0.0), planet);
        assert_ne!(vary(&planet, 9, 0.1), planet);
        assert_eq!(vary(&planet, 9, 0.3), vary(&planet, 9, 0.3));
    }

    #[test]
    fn planets_differ_in_what_they_have() {
        let planets: Vec<_> = (0..64).map(random).collect();
        let share = |has: fn(&Planet) -> bool| planets.iter().filter(|p| has(p)).count();
        for (what, count) in [
            ("sea", share(|p| p.water.is_some())),
            ("air", share(|p| p.atmosphere.is_some())),
            ("clouds", share(|p| p.clouds.is_some())),
        ] {
            assert!((10..=60).contains(&count), "{what}: {count} of 64");
        }
    }
}
