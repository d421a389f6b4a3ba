//! Structured fuzzing of what strangers write: presets, systems, height pictures. Tokens of valid texts are deleted,
//! doubled, swapped and replaced; bytes of valid pictures are changed. Nothing may panic; what is taken must be valid,
//! and the same after it has been written and read again; what is refused gets a message of a line or a few.

use crate::support::dice::Dice;
use crate::support::edits::full_planet;
use crate::support::png::{changed_png, pick};
use tellus::planet::picture::{Budget, PictureKey};
use tellus::planet::{PictureLayout, Planet, VERSION};
use tellus::system::System;
use tellus::terrain::Revision;

/// Cases in the suite, and in the long tests.
const CASES: u64 = 20_000;
const LONG_CASES: u64 = 1_000_000;
/// Each run of `OF` cases begins with large presets. Systems follow up to the case `SYSTEMS`, pictures up to the case
/// `PICTURES`. The rest are small presets.
const OF: u64 = 100;
const LARGE: u64 = 4;
const SYSTEMS: u64 = 15;
const PICTURES: u64 = 20;
/// Longest message about a text.
const MOST_CHARS: usize = 20_000;

/// What numbers become.
const NUMBERS: [&str; 18] = [
    "0",
    "-0",
    "0.0",
    "-1",
    "1e308",
    "-1e308",
    "1e999",
    "NaN",
    "inf",
    "-inf",
    "4294967295",
    "4294967296",
    "1e-320",
    "99999999999999999999",
    "0x10",
    "1_000",
    "+5",
    "3.",
];
/// What is put anywhere.
const BITS: [&str; 22] = [
    "(",
    ")",
    "[",
    "]",
    "{",
    "}",
    ":",
    ",",
    "\"",
    "'",
    "\\",
    "//",
    "/*",
    "*/",
    "r#\"",
    "\u{0}",
    "\u{1b}[2J",
    "é",
    "\u{202e}",
    "Some(",
    "None",
    "#![enable(implicit_some)]",
];

/// A small preset with most kinds of values.
fn small() -> String {
    format!(
        "(version: {VERSION}, name: \"Islet\", seed: 7, radius_km: 40.0,
height_curve: [(-100, -50), (0, 10), (900, 400)],
layers: [
(name: \"Hills\", amplitude_m: 800.0, shape: Fbm(wavelength_km: 12.0, octaves: 8), curve: [(-1, 0), (1, 1)]),
(name: \"Crags\", blend: SmoothMax, shape: Ridged(wavelength_km: 5.0),
masks: [Layer(layer: \"Hills\", from: 0.0, to: 0.2)]),
],
water: (level_m: -50.0), atmosphere: (), clouds: None, structure: None,
biomes: (rows: Temperature, palette: [(key: 'a', name: \"Grass\", color: (0.1, 0.2, 0.05)), (key: 'b')],
table: [\"aab\", \"bba\"]),
edits: [(name: \"Old fire\", tool: Volcano(height_m: 3200, caldera: 0.15), points: [(12.5, -45)]),
(tool: Road(), radius_km: 0.5, points: [(12.1, -45.2, 310), (12.2, -45.1, 460)]),
(tool: Uplift(), points: [(1, 2)])],
editor: (bookmarks: [(name: \"Bay\", latitude_deg: 3, altitude_m: 500)]))"
    )
}

/// A text without comments, as tokens.
pub(crate) fn tokens(text: &str) -> Vec<String> {
    let mut tokens: Vec<String> = Vec::new();
    for line in text.lines().filter(|line| !line.trim_start().starts_with("//")) {
        let mut rest = line.trim();
        while let Some(first) = rest.chars().next() {
            let is_word = |c: char| c.is_alphanumeric() || matches!(c, '_' | '.' | '-' | '#');
            let length = match first {
                quote @ ('"' | '\'') => rest[1..].find(quote).map_or(rest.len(), |end| end + 2),
                c if is_word(c) => rest.find(|c| !is_word(c)).unwrap_or(rest.len()),
                c => c.len_utf8(),
            };
            tokens.push(rest[..length].to_owned());
            rest = rest[length..].trim_start();
        }
        tokens.push("\n".to_owned());
    }
    tokens
}

/// A text with some tokens changed.
pub(crate) fn changed(tokens: &[String], dice: &mut Dice) -> String {
    let mut tokens = tokens.to_vec();
    for _ in 0..1 + pick(dice, 3) {
        let at = pick(dice, tokens.len());
        let end = (at + 1 + pick(dice, 6)).min(tokens.len());
        match pick(dice, 9) {
            0 => drop(tokens.drain(at..end)),
            1 => {
                let doubled = tokens[at..end].to_vec();
                tokens.splice(at..at, doubled);
            }
            2 | 3 => {
                let is_number = |token: &&mut String| token.starts_with(|c: char| c.is_ascii_digit() || c == '-');
                let count = tokens.iter_mut().filter(is_number).count();
                let number = pick(dice, count);
                if let Some(token) = tokens.iter_mut().filter(is_number).nth(number) {
                    *token = NUMBERS[pick(dice, NUMBERS.len())].to_owned();
                }
            }
            4 => {
                let other = pick(dice, tokens.len());
                tokens.swap(at, other);
            }
            5 => tokens[at] = tokens[pick(dice, tokens.len())].clone(),
            6 => tokens.insert(at, BITS[pick(dice, BITS.len())].to_owned()),
            7 => tokens.insert(at, BITS[pick(dice, 6)].repeat(1 + pick(dice, 300))),
            _ => tokens.truncate(end),
        }
        if tokens.is_empty() {
            return String::new();
        }
    }
    tokens.join(" ")
}

/// A message is short, and holds nothing that commands a terminal.
fn is_plain(message: &str) {
    assert!(message.len() < MOST_CHARS, "{} characters: {}", message.len(), &message[..200]);
    let turns = |c: char| ('\u{202a}'..='\u{202e}').contains(&c) || ('\u{2066}'..='\u{2069}').contains(&c);
    let is_plain = |c: char| (!c.is_control() && !turns(c)) || c == '\n';
    assert!(!message.is_empty() && message.chars().all(is_plain), "{message:?}");
}

fn read_preset(text: &str) -> bool {
    match Planet::from_text("p.ron", text) {
        Err(error) => is_plain(&error.to_string()),
        Ok(planet) => {
            assert_eq!(planet.check(), Ok(()));
            let again = Planet::from_text("p.ron", &planet.to_text()).unwrap_or_else(|error| panic!("{error}: {text}"));
            assert!(again == planet, "not the same once it has been written: {text}");
            // The keys of everything are made; without pictures, which no folder has.
            let _ = Revision::try_new(planet.into());
            return true;
        }
    }
    false
}

fn read_system(text: &str) -> bool {
    match System::from_text("s.ron", text) {
        Err(error) => is_plain(&error.to_string()),
        Ok(system) => {
            let again = System::from_text("s.ron", &system.to_text()).unwrap_or_else(|error| panic!("{error}: {text}"));
            assert!(again == system, "not the same once it has been written: {text}");
            return true;
        }
    }
    false
}

fn read_picture(bytes: &[u8]) -> bool {
    let key = PictureKey { file: "p.png".into(), extent: PictureLayout::Equirectangular.into() };
    match key.decode(bytes, &mut Budget::default()) {
        Err(error) => is_plain(&error),
        Ok(picture) => {
            let (lowest, highest) = picture.bounds();
            assert!(lowest <= highest && lowest.is_finite() && highest.is_finite());
            return true;
        }
    }
    false
}

/// Runs cases from `first` on. Gives how many of presets, systems and pictures were taken.
fn run(first: u64, count: u64) -> [u64; 3] {
    // As tokens the files are still valid.
    for base in [small(), full_planet().to_text()] {
        Planet::from_text("p.ron", &tokens(&base).join(" ")).unwrap_or_else(|error| panic!("{error}"));
    }
    let bases = [tokens(&small()), tokens(&full_planet().to_text())];
    let systems: Vec<Vec<String>> =
        tellus::system::shipped::ALL.iter().map(|shipped| tokens(&shipped.load().unwrap().to_text())).collect();
    let png = include_bytes!("../fixtures/plain.png");
    let mut taken = [0; 3];
    for seed in first..first + count {
        let mut dice = Dice(seed);
        match seed % OF {
            n if n < LARGE => taken[0] += u64::from(read_preset(&changed(&bases[1], &mut dice))),
            n if n < SYSTEMS => {
                let base = &systems[pick(&mut dice, systems.len())];
                taken[1] += u64::from(read_system(&changed(base, &mut dice)));
            }
            n if n < PICTURES => taken[2] += u64::from(read_picture(&changed_png(png, &mut dice))),
            _ => taken[0] += u64::from(read_preset(&changed(&bases[0], &mut dice))),
        }
    }
    taken
}

#[test]
fn twenty_thousand_changed_files_are_read_or_refused() {
    let taken = run(0, CASES);
    // Some changes leave a valid file, or it would be luck that none panics.
    assert!(taken.iter().all(|taken| *taken > CASES / 2000), "{taken:?}");
}

#[test]
#[ignore = "minutes; in `scripts/test long`"]
fn a_million_changed_files_are_read_or_refused() {
    let taken = run(CASES, LONG_CASES);
    println!("counted: {LONG_CASES} changed files; valid presets, systems and pictures: {taken:?}");
}
