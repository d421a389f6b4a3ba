//! Random planets: always valid, plausible, and the same for the same seed on every machine.
//!
//! - `dice`: the pseudo-random numbers
//! - `lands`: layers that suit a kind of world
//! - `structure`: plates, weather and rivers of most wet worlds
//! - `grounds`: biomes that suit a climate
//! - `life`: plants and stones that suit the biomes
//!
//! [`random`] makes a planet: a few layers that build on each other, a climate, and biomes that suit it. [`vary`] moves
//! the numbers of an existing planet. Both use the descriptions of parameters wherever those suffice.

pub(crate) mod dice;
mod grounds;
mod lands;
mod life;
mod structure;

use super::locks::Locks;
use super::param::{ParamPath, Stage};
use super::{Atmosphere, Biomes, Climate, Clouds, GroundEdits, Layer, Mask, Planet, Precision, Star, Water, validate};
use dice::{Dice, three_digits};

/// Mixed into the seed of a planet for what stands on it.
const LIFE_SEED: u64 = 0x6c69_6665;

/// A random planet. Always valid; the same seed gives the same planet.
pub fn random(seed: u64) -> Planet {
    random_of(None, seed)
}

/// A random planet of a kind; None leaves the kind to chance.
pub fn random_of(kind: Option<Kind>, seed: u64) -> Planet {
    let mut dice = Dice(seed);
    // The climate decides the rest: a frozen world has no clouds, a hot one no sea.
    let any =
        *dice.pick(&[Kind::Temperate, Kind::Temperate, Kind::Temperate, Kind::Cold, Kind::Hot, Kind::Dry, Kind::Bare]);
    let kind = kind.unwrap_or(any);
    let radius_km = dice.rounded_log(if kind == Kind::Bare { 400.0 } else { 2500.0 }, 12_000.0);
    let climate = climate(kind, radius_km, &mut dice);
    let sea = kind == Kind::Temperate || kind == Kind::Cold && dice.chance(0.7);
    let structure = (kind == Kind::Temperate && dice.chance(0.7)).then(|| structure::structure(radius_km, &mut dice));
    let layers = match structure {
        Some(_) => lands::detail(radius_km, &mut dice),
        None => lands::layers(kind, sea, radius_km, &mut dice),
    };
    let water = sea.then(|| Water {
        level_m: dice.rounded(-80.0, 40.0),
        wind_m_s: dice.rounded(2.0, 15.0),
        color: sea_color(&mut dice),
        ..Water::default()
    });
    let air = kind != Kind::Bare && (water.is_some() || dice.chance(0.7));
    let clouds = (air && dice.chance(if water.is_some() { 0.9 } else { 0.4 })).then(|| Clouds {
        // Over ice, clouds would hide white behind white; deserts have few.
        // More than a fifth would hide the land.
        coverage: if kind == Kind::Temperate { dice.rounded(0.07, 0.18) } else { dice.rounded(0.03, 0.12) },
        storms: if water.is_some() { dice.rounded(0.3, 1.0) } else { dice.rounded(0.0, 0.3) },
        veil: dice.rounded(0.02, 0.15),
        scale_km: three_digits(radius_km * dice.between(0.36, 0.6)),
        curl: dice.rounded(0.3, 0.6),
        seed: dice.seed(),
        wind_km_h: dice.rounded(-120.0, 120.0),
        ..Clouds::default()
    });
    let mut planet = Planet {
        name: dice.name(),
        seed: dice.seed(),
        radius_km,
        precision: Precision::default(),
        settlements: 0.0,
        height_curve: Vec::new(),
        star: Star { latitude_deg: dice.rounded(-24.0, 24.0), color: star_color(&mut dice), ..Star::default() },
        layers,
        edits: GroundEdits::default(),
        life: Vec::new(),
        biomes: grounds::biomes(kind, &climate, &mut dice),
        climate,
        structure,
        water,
        atmosphere: air.then(|| atmosphere(kind, &mut dice)),
        clouds,
        giant: None,
        rings: None,
        editor: None,
    };
    // Dice of their own: what stands on a planet decides nothing else.
    planet.life = life::populations(kind, &planet.biomes, &mut Dice(seed ^ LIFE_SEED));
    debug_assert!(validate::problems(&planet).is_empty());
    planet
}

/// A variation of a planet: each number moved by up to `strength` (0 to 1) of its own size; always valid if the planet
/// is.
///
/// Zero, names, letters, switches, choices and what is locked stay the same. A seed is another one with a probability
/// of `strength` squared: a little variation keeps the continents.
pub fn vary(planet: &Planet, seed: u64, strength: f64) -> Planet {
    vary_some(planet, seed, strength, &|_| true)
}

/// The same of the parameters alone whose paths `moves` accepts.
pub fn vary_some(planet: &Planet, seed: u64, strength: f64, moves: &dyn Fn(&ParamPath) -> bool) -> Planet {
    let strength = if strength.is_finite() { strength.clamp(0.0, 1.0) } else { 0.0 };
    let (mut dice, locks) = (Dice(seed), Locks::of(planet));
    let mut varied = planet.clone();
    varied.each(&mut |path, param, mut value| {
        // Drawn in any case: a lock changes nothing but what it is on.
        let moved = dice.moved(param, &value.get(), strength);
        // What was made by hand stays where it is.
        let by_hand = path.part() == "edits";
        let stays = by_hand || param.stages.contains(Stage::Label) || !moves(path) || locks.hold(path);
        if let Some(new) = moved.filter(|_| !stays) {
            value.set(&new);
        }
    });
    mend_biomes(&mut varied.biomes, &planet.biomes);
    mend_masks(&mut varied.layers, &planet.layers);
    for (population, old) in varied.life.iter_mut().zip(&planet.life) {
        population.ask_no_more_than(old);
        population.mend_ranges();
    }
    varied
}

/// Takes numbers back that break a rule together.
fn mend_biomes(biomes: &mut Biomes, old: &Biomes) {
    if biomes.coldest_c >= biomes.hottest_c {
        (biomes.coldest_c, biomes.hottest_c) = (old.coldest_c, old.hottest_c);
    }
    if biomes.lowest_m >= biomes.highest_m {
        (biomes.lowest_m, biomes.highest_m) = (old.lowest_m, old.highest_m);
    }
    if biomes.cliff_start_deg > biomes.cliff_full_deg {
        (biomes.cliff_start_deg, biomes.cliff_full_deg) = (old.cliff_start_deg, old.cliff_full_deg);
    }
    for (biome, old) in biomes.palette.iter_mut().zip(&old.palette) {
        if biome.steep_from_deg > biome.steep_to_deg {
            (biome.steep_from_deg, biome.steep_to_deg) = (old.steep_from_deg, old.steep_to_deg);
        }
    }
}

/// The same of masks.
fn mend_masks(layers: &mut [Layer], old: &[Layer]) {
    for (layer, old) in layers.iter_mut().zip(old) {
        for (mask, old) in layer.masks.iter_mut().zip(&old.masks) {
            let [from, to] = mask.ends();
            if from.1 == to.1 {
                *mask = old.clone();
            }
            // Slope masks that measure over one distance keep sharing it, because only a few distances are allowed.
            if let (Mask::Slope(slope), Mask::Slope(old)) = (mask, old) {
                slope.over_m = old.over_m;
            }
        }
    }
}

/// A kind of world.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Mild, with a sea.
    Temperate,
    /// Frozen, most with a sea.
    Cold,
    /// Scorched.
    Hot,
    /// Without a sea, and not too hot.
    Dry,
    /// Without air: a moon.
    Bare,
}

/// White like the Sun, or blue-white, orange or red.
fn star_color(dice: &mut Dice) -> [f64; 3] {
    let white = ([0.9, 0.85, 0.75], [1.0, 0.98, 1.0]);
    let blue = ([0.72, 0.82, 1.0], [0.85, 0.92, 1.0]);
    let orange = ([1.0, 0.7, 0.42], [1.0, 0.82, 0.6]);
    let red = ([1.0, 0.5, 0.26], [1.0, 0.62, 0.4]);
    let (low, high) = *dice.pick(&[white, white, white, white, blue, orange, orange, red]);
    dice.color(low, high)
}

/// Blue-green like most of the Earth's, or teal, or rusty with iron.
fn sea_color(dice: &mut Dice) -> [f64; 3] {
    let blue = ([0.002, 0.02, 0.03], [0.01, 0.04, 0.07]);
    let teal = ([0.003, 0.045, 0.04], [0.01, 0.08, 0.065]);
    let rust = ([0.05, 0.018, 0.008], [0.09, 0.035, 0.018]);
    let (low, high) = *dice.pick(&[blue, blue, blue, blue, teal, teal, rust]);
    dice.color(low, high)
}

fn climate(kind: Kind, radius_km: f64, dice: &mut Dice) -> Climate {
    let equator_c = match kind {
        Kind::Temperate => dice.rounded(22.0, 34.0),
        Kind::Cold => dice.rounded(-12.0, 10.0),
        Kind::Hot => dice.rounded(60.0, 200.0),
        Kind::Dry => dice.rounded(5.0, 45.0),
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
    // Thin on cold worlds, thick on wet ones; dust turns the sky yellow and red. Thicker air than on the Earth would
    // veil the ground from orbit.
    let thickness = match kind {
        Kind::Hot => dice.between(0.2, 0.7),
        Kind::Dry => dice.between(0.05, 0.4),
        Kind::Cold => dice.between(0.3, 0.8),
        _ => dice.between(0.5, 0.95),
    };
    // A factor on the haze of the default air, which is clearer than any on the Earth.
    let dust = if kind == Kind::Temperate { dice.between(2.0, 9.0) } else { dice.between(2.0, 11.0) };
    // Red and violet skies were many, and all their planets looked alike: blue stays the strongest.
    let tint = dice.color([0.75, 0.85, 0.95], [1.05, 1.2, 1.1]);
    // Dust of deserts and fumes of hot worlds swallow blue: the air is butterscotch instead of blue.
    let dusty = matches!(kind, Kind::Dry | Kind::Hot) && dice.chance(0.75);
    let (tint, dust_absorbs) = if dusty { (tint.map(|t| t * 0.35), [0.4, 2.0, 5.0]) } else { (tint, [1.0; 3]) };
    let scaled = |color: [f64; 3], factor: f64| color.map(|c| three_digits(c * factor));
    let mut rayleigh_per_km = scaled(earth.rayleigh_per_km, thickness);
    for (component, tint) in rayleigh_per_km.iter_mut().zip(tint) {
        *component = three_digits(*component * tint);
    }
    let mut mie_absorption_per_km = scaled(earth.mie_absorption_per_km, dust);
    for (component, share) in mie_absorption_per_km.iter_mut().zip(dust_absorbs) {
        *component = three_digits(*component * share);
    }
    Atmosphere {
        rayleigh_per_km,
        mie_scattering_per_km: scaled(earth.mie_scattering_per_km, dust),
        mie_absorption_per_km,
        ..earth
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::locks;
    use crate::planet::param::{Choice, Segment};
    use crate::planet::{Shape, Steep};
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
            let fewest = if planet.structure.is_some() { 1 } else { 4 };
            prop_assert!((fewest..=12).contains(&planet.layers.len()));
            prop_assert!(planet.biomes.palette.len() >= 2, "{:?}", planet.biomes.table);
            let biomes = &planet.biomes;
            let named = biomes.palette.iter().map(|biome| biome.steep_key).chain([biomes.beach_key, biomes.snow_key]);
            named.for_each(|key| assert!(biomes.index_of(key).is_some(), "{key:?} is no biome"));
            prop_assert_eq!(planet, random(seed));
        }

        #[test]
        fn variations_are_valid(seed: u64, other: u64, strength in 0.0..=1.0_f64) {
            assert_valid(&vary(&random(seed), other, strength))?;
        }
    }

    #[test]
    fn steep_rules_stay_in_order() {
        let mut planet = random(5);
        for biome in &mut planet.biomes.palette {
            (biome.steep, biome.steep_from_deg, biome.steep_to_deg) = (Steep::Biome, 38.0, 40.0);
        }
        for seed in 0..100 {
            assert_eq!(validate::problems(&vary(&planet, seed, 0.25)), []);
        }
    }

    #[test]
    fn no_strength_changes_nothing_and_some_does() {
        let planet = random(5);
        assert_eq!(vary(&planet, 9, 0.0), planet);
        assert_ne!(vary(&planet, 9, 0.1), planet);
        let only = vary_some(&planet, 9, 0.5, &|path| path.segments().first() == Some(&Segment::Field("climate")));
        assert_ne!(only.climate, planet.climate);
        assert_eq!(Planet { climate: planet.climate.clone(), ..only }, planet);
        assert_eq!(vary(&planet, 9, 0.3), vary(&planet, 9, 0.3));
    }

    #[test]
    fn what_is_locked_does_not_vary() {
        let mut planet = random(5);
        locks::toggle(&mut planet, &ParamPath::default().join("climate"));
        let varied = vary(&planet, 9, 0.8);
        assert_eq!((&varied.climate, &varied.editor), (&planet.climate, &planet.editor));
        assert_ne!(varied.layers, planet.layers);
    }

    #[test]
    fn a_little_variation_keeps_sizes_and_seeds() {
        let planet = random(5);
        let mut same_seeds = 0;
        for seed in 0..20 {
            let varied = vary(&planet, seed, 0.1);
            same_seeds += usize::from(varied.seed == planet.seed);
            let ratio = varied.radius_km / planet.radius_km;
            assert!((0.8..1.25).contains(&ratio), "{ratio}");
            assert_eq!(varied.settlements, 0.0, "nothing is switched on");
        }
        assert!(same_seeds >= 17, "{same_seeds} of 20");
    }

    /// Every feature of the evaluator occurs, except pictures.
    #[test]
    fn every_kind_of_layer_is_used() {
        let planets: Vec<_> = (0..192).map(random).collect();
        for (index, name) in Shape::NAMES.iter().enumerate().filter(|(_, name)| **name != "HeightMap") {
            let has = |p: &&Planet| p.layers.iter().any(|layer| layer.shape.index() == index);
            let count = planets.iter().filter(has).count();
            assert!(count >= 6, "{name}: {count} of 192");
        }
    }

    #[test]
    fn planets_differ_in_what_they_have() {
        let planets: Vec<_> = (0..64).map(random).collect();
        let share = |has: fn(&Planet) -> bool| planets.iter().filter(|p| has(p)).count();
        for (what, count) in [
            ("sea", share(|p| p.water.is_some())),
            ("air", share(|p| p.atmosphere.is_some())),
            ("clouds", share(|p| p.clouds.is_some())),
            ("structure", share(|p| p.structure.is_some())),
        ] {
            assert!((10..=60).contains(&count), "{what}: {count} of 64");
        }
    }
}
