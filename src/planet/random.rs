//! Random planets: always valid, plausible, and the same for the same seed on every machine.
//!
//! [`random`] makes a planet from nothing: a few layers that build on each other, a climate, and biomes that follow from
//! it. [`vary`] moves the numbers of a planet that there is. Neither knows more of a parameter than its description,
//! where that is enough.

use super::param::{Domain, Param, Value};
use super::{
    Atmosphere, Biome, Biomes, Blend, Climate, Clouds, Fbm, Layer, Mask, Planet, Ridged, Shape, Star, Table, Water,
    validate,
};

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
        star: Star {
            latitude_deg: dice.rounded(-24.0, 24.0),
            color: dice.color([0.9, 0.85, 0.75], [1.0, 0.98, 1.0]),
            ..Star::default()
        },
        layers,
        biomes: biomes(kind, &climate, &mut dice),
        climate,
        water,
        atmosphere: air.then(|| atmosphere(kind, &mut dice)),
        clouds,
    };
    debug_assert!(validate::problems(&planet).is_empty());
    planet
}

/// A variation of a planet: its numbers moved by up to `strength` (0 to 1) of their range; always valid if the planet is.
///
/// Names, letters, switches and choices stay: it is the same planet, only different.
pub fn vary(planet: &Planet, seed: u64, strength: f64) -> Planet {
    let strength = if strength.is_finite() { strength.clamp(0.0, 1.0) } else { 0.0 };
    let mut dice = Dice(seed);
    let mut varied = planet.clone();
    varied.each(&mut |_, param, mut value| {
        if let Some(new) = dice.moved(param, &value.get(), strength) {
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
            if mask.from == mask.to {
                *mask = old.clone();
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
    let mask = |layer: &str, from: f64, to: f64| Mask { layer: layer.to_owned(), from, to, ..Mask::default() };

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

/// A biome with the climate in which it lies: it is found where it is colder than this and at least so moist.
struct Ground {
    key: char,
    name: &'static str,
    color: [f64; 3],
    below_c: f64,
    from_moisture: f64,
}

const fn ground(key: char, name: &'static str, color: [f64; 3], below_c: f64, from_moisture: f64) -> Ground {
    Ground { key, name, color, below_c, from_moisture }
}

/// For worlds with weather. The coldest that fits wins; among those, the wettest.
const LIVING: &[Ground] = &[
    ground('i', "Ice", [0.78, 0.82, 0.87], -14.0, 0.0),
    ground('s', "Snow", [0.70, 0.73, 0.76], -6.0, 0.0),
    ground('t', "Tundra", [0.19, 0.18, 0.12], 1.0, 0.0),
    ground('c', "Cold steppe", [0.21, 0.19, 0.11], 8.0, 0.0),
    ground('k', "Taiga", [0.055, 0.09, 0.045], 8.0, 0.35),
    ground('g', "Grassland", [0.15, 0.18, 0.065], 20.0, 0.25),
    ground('x', "Dry scrub", [0.27, 0.22, 0.12], 20.0, 0.0),
    ground('f', "Forest", [0.045, 0.085, 0.03], 20.0, 0.5),
    ground('d', "Desert", [0.45, 0.32, 0.17], 500.0, 0.0),
    ground('a', "Savanna", [0.24, 0.2, 0.075], 500.0, 0.3),
    ground('w', "Woodland", [0.09, 0.12, 0.04], 500.0, 0.5),
    ground('j', "Rain forest", [0.025, 0.065, 0.018], 500.0, 0.72),
];

/// For worlds without life.
const BARREN: &[Ground] = &[
    ground('i', "Frost", [0.62, 0.64, 0.66], -60.0, 0.3),
    ground('p', "Pale dust", [0.33, 0.31, 0.28], -10.0, 0.0),
    ground('r', "Regolith", [0.20, 0.18, 0.165], 60.0, 0.0),
    ground('m', "Dark plain", [0.085, 0.08, 0.078], 60.0, 0.5),
    ground('o', "Ochre", [0.38, 0.23, 0.12], 500.0, 0.0),
    ground('b', "Baked rock", [0.16, 0.09, 0.06], 500.0, 0.5),
];

/// A palette and a table that follow from the climate.
fn biomes(kind: Kind, climate: &Climate, dice: &mut Dice) -> Biomes {
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
        })
        .collect();
    Biomes { coldest_c, hottest_c, palette, table, ..Biomes::default() }
}

/// Rounded to three significant digits: a file should be pleasant to read.
fn three_digits(value: f64) -> f64 {
    if value == 0.0 || !value.is_finite() {
        return value;
    }
    let scale = libm::pow(10.0, 2.0 - libm::floor(libm::log10(value.abs())));
    (value * scale).round() / scale
}

/// SplitMix64 (Steele, Lea, Flood 2014): tiny, and the same everywhere.
struct Dice(u64);

impl Dice {
    fn next(&mut self) -> u64 {
        self.0 = self.0.wrapping_add(0x9e37_79b9_7f4a_7c15);
        let mut z = self.0;
        z = (z ^ (z >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
        z ^ (z >> 31)
    }

    /// From 0 to below 1.
    fn unit(&mut self) -> f64 {
        (self.next() >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// In steps that read well: tenths of small numbers, hundredths of smaller ones.
    fn rounded(&mut self, low: f64, high: f64) -> f64 {
        let step = if high - low > 5.0 { 1.0 } else { 100.0 };
        ((self.between(low, high) * step).round() / step).clamp(low, high)
    }

    fn rounded_log(&mut self, low: f64, high: f64) -> f64 {
        three_digits(libm::exp(self.between(libm::log(low), libm::log(high)))).clamp(low, high)
    }

    fn color(&mut self, low: [f64; 3], high: [f64; 3]) -> [f64; 3] {
        let mut color = low;
        for (component, high) in color.iter_mut().zip(high) {
            *component = three_digits(self.between(*component, high)).clamp(*component, high);
        }
        color
    }

    fn chance(&mut self, share: f64) -> bool {
        self.unit() < share
    }

    fn seed(&mut self) -> u32 {
        // Four digits are enough to differ and can be read out.
        (self.next() % 10_000) as u32
    }

    fn pick<'a, T>(&mut self, from: &'a [T]) -> &'a T {
        &from[(self.next() % from.len() as u64) as usize]
    }

    fn name(&mut self) -> String {
        const STARTS: &[&str] =
            &["Ar", "Bel", "Cal", "Dor", "El", "Fen", "Ish", "Kor", "Mir", "Nov", "Or", "Tal", "Ver"];
        const MIDDLES: &[&str] = &["a", "e", "i", "o", "u", "ae", "ia", "and", "ess", "ili", "or"];
        const ENDS: &[&str] = &["dia", "ra", "th", "lon", "mir", "nis", "ria", "s", "ta", "vos", "x"];
        [STARTS, MIDDLES, ENDS].map(|part| *self.pick(part)).concat()
    }

    /// A value moved by up to `strength` of its range, or `None` where there is nothing to move.
    fn moved(&mut self, param: &Param, value: &Value, strength: f64) -> Option<Value> {
        if strength == 0.0 {
            return None;
        }
        let by = self.between(-strength, strength);
        let along = |value: f64, min: f64, max: f64| (value + by * (max - min)).clamp(min, max);
        match (value, param.domain) {
            (Value::Number(v), Domain::Number { min, max, logarithmic: false }) => {
                Some(Value::Number(three_digits(along(*v, min, max)).clamp(min, max)))
            }
            // Equal steps are equal ratios. Zero is a choice, not a size, and stays.
            (Value::Number(v), Domain::Number { min, max, logarithmic: true }) if *v > 0.0 => {
                let floor = if min > 0.0 { min } else { max * 1e-6 };
                let moved = libm::exp(along(libm::log(v.max(floor)), libm::log(floor), libm::log(max)));
                Some(Value::Number(three_digits(moved).clamp(min, max)))
            }
            (Value::Count(v), Domain::Count { min, max }) => {
                let moved = along(f64::from(*v), f64::from(min), f64::from(max)).round();
                Some(Value::Count((moved as u32).clamp(min, max)))
            }
            (Value::Count(_), Domain::Seed) => Some(Value::Count(self.seed())),
            (Value::Triple(v), Domain::Color | Domain::Triple { .. }) => {
                let max = if let Domain::Triple { max } = param.domain { max } else { 1.0 };
                // By ratio: coefficients differ by powers of ten, and grey stays nearly grey.
                let moved = v.map(|c| three_digits(c * (1.0 + self.between(-strength, strength))).clamp(0.0, max));
                Some(Value::Triple(moved))
            }
            _ => None,
        }
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
