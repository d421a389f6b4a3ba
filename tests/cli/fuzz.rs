//! Random command lines: whatever they hold, the program answers, or says what is wrong and ends with status 1 or 2.

use super::dice::Dice;
use assert_cmd::Command;
use std::path::Path;
use std::time::Duration;

const CASES: u64 = 160;
const LONG_CASES: u64 = 20_000;
/// A command that takes longer hangs.
const PATIENCE: Duration = Duration::from_secs(60);

/// Options with values that are right and make little work.
type Options = &'static [(&'static str, &'static [&'static str])];

/// Commands that need no graphics device: their options, and those that are always there, because their defaults make
/// much work.
const COMMANDS: [(&str, Options, Options); 11] = [
    ("check", &[], &[]),
    (
        "sample",
        &[
            ("--lat", &["20", "-89.5"]),
            ("--lon", &["52"]),
            ("--points", &["points", "-"]),
            ("--time", &["5"]),
            ("--json", &[]),
        ],
        &[],
    ),
    (
        "nearest",
        &[
            ("--what", &["land", "sea", "object"]),
            ("--slope", &["3"]),
            ("--above", &["100"]),
            ("--biome", &["Forest"]),
            ("--json", &[]),
        ],
        &[("--lat", &["1"]), ("--lon", &["2"]), ("--within", &["20"]), ("--spacing", &["2000"])],
    ),
    (
        "bake",
        &[
            ("--what", &["height", "slope", "biome"]),
            ("--as", &["cube", "equirect", "region"]),
            ("--format", &["png8", "exr", "ktx2"]),
            ("--lat", &["4"]),
            ("--lon", &["5"]),
            ("--km", &["20"]),
            ("--range", &["-10,500"]),
            ("--shard", &["1/2"]),
        ],
        &[("--size", &["16", "64"]), ("-o", &["maps", "nope/maps"])],
    ),
    (
        "mesh",
        &[
            ("--texture", &["16"]),
            ("--water", &["surface", "apart"]),
            ("--skirt", &["5"]),
            ("--scale", &["0.01"]),
            ("--quantize", &[]),
        ],
        &[
            ("--spacing", &["2000"]),
            ("--lat", &["4"]),
            ("--lon", &["5"]),
            ("--km", &["20"]),
            ("-o", &["a.glb", "a.obj", "a"]),
        ],
    ),
    (
        "tiles",
        &[
            ("--cells", &["8"]),
            ("--texture", &["16"]),
            ("--water", &["none"]),
            ("--implicit", &[]),
            ("--quantize", &[]),
        ],
        &[("--levels", &["0"]), ("-o", &["tiles"])],
    ),
    ("rivers", &[("--min-discharge", &["10"])], &[("-o", &["rivers.geojson"])]),
    (
        "coasts",
        &[("--height", &["100"]), ("--min-length", &["50"])],
        &[("--spacing", &["90000"]), ("-o", &["c.geojson"])],
    ),
    (
        "instances",
        &[("--kind", &["Trees"]), ("--km", &["0.2"])],
        &[("--lat", &["5"]), ("--lon", &["6"]), ("-o", &["o.csv", "o.geojson"])],
    ),
    (
        "sky",
        &[("--azimuth", &["40"]), ("--altitude", &["2000"]), ("--json", &[])],
        &[("--sun-zenith", &["50"]), ("--view-zenith", &["80"])],
    ),
    ("new", &[("--seed", &["7"]), ("--from", &["planet.ron", "none.ron"])], &[("-o", &["new.ron", "nope/new.ron"])]),
];

/// Values that are wrong almost everywhere.
const HOSTILE: [&str; 20] = [
    "",
    "-",
    "--",
    "NaN",
    "inf",
    "-inf",
    "1e400",
    "-1",
    "99999999999999999999",
    "0x10",
    "1,2",
    ",",
    "a b",
    "é",
    "\u{202e}x",
    "nope/nope/x",
    "\u{1b}[31mred",
    "--json",
    "-1e-320",
    "%s%n",
];

fn pick<'a>(dice: &mut Dice, from: &[&'a str]) -> &'a str {
    from.get((dice.roll() * from.len() as f64) as usize).copied().unwrap_or_default()
}

fn arguments(dice: &mut Dice) -> Vec<String> {
    let (command, options, always) = COMMANDS[(dice.roll() * COMMANDS.len() as f64) as usize];
    let mut parts: Vec<Vec<String>> = Vec::new();
    let mut add = |dice: &mut Dice, (name, values): (&str, &'static [&'static str]), hostile: f64| {
        let mut part = vec![name.to_owned()];
        if dice.roll() < hostile {
            part.push(pick(dice, &HOSTILE).to_owned());
        } else if !values.is_empty() {
            part.push(pick(dice, values).to_owned());
        }
        parts.push(part);
    };
    for option in options {
        if dice.roll() < 0.4 {
            add(dice, *option, 0.2);
        }
    }
    for option in always {
        add(dice, *option, 0.1);
    }
    let file = match dice.roll() {
        x if x < 0.7 => "planet.ron",
        x if x < 0.8 => "none.ron",
        x if x < 0.85 => ".",
        _ => pick(dice, &HOSTILE),
    };
    if command != "new" {
        parts.push(vec![file.to_owned()]);
    }
    if dice.roll() < 0.1 {
        parts.push(vec![pick(dice, &HOSTILE).to_owned()]);
    }
    // In any order.
    for i in (1..parts.len()).rev() {
        parts.swap(i, (dice.roll() * (i + 1) as f64) as usize);
    }
    std::iter::once(command.to_owned()).chain(parts.into_iter().flatten()).collect()
}

/// Runs command lines. Gives how many ended with each status.
fn run(first: u64, count: u64) -> [u64; 3] {
    let folder = tempfile::tempdir().unwrap();
    let planet = Path::new(env!("CARGO_MANIFEST_DIR")).join(crate::LAYERED);
    std::fs::copy(planet, folder.path().join("planet.ron")).unwrap();
    std::fs::write(folder.path().join("points"), "1,2\n# none\n\n-20.5,170\n").unwrap();
    let mut ended = [0; 3];
    for case in first..first + count {
        let mut dice = Dice(case.wrapping_mul(0x9E37_79B9_7F4A_7C15));
        let arguments = arguments(&mut dice);
        let mut command: Command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
        command.env("TELLUS_MAPS", "").env("RUST_BACKTRACE", "0").current_dir(folder.path()).args(&arguments);
        let output = command.write_stdin("3,4\n").timeout(PATIENCE).output().unwrap();
        let told = String::from_utf8(output.stderr).unwrap();
        let context = || format!("case {case}: {arguments:?}: {:?}: {told}", output.status);
        let status = output.status.code().unwrap_or_else(|| panic!("{}", context()));
        assert!((0..3).contains(&status) && !told.contains("panicked"), "{}", context());
        assert!(status == 0 || !told.trim().is_empty(), "{}", context());
        assert!(told.len() < 20_000, "{}", context());
        let said = String::from_utf8(output.stdout).unwrap();
        let commands =
            |c: char| (c.is_control() && !matches!(c, '\n' | '\t')) || ('\u{202a}'..='\u{202e}').contains(&c);
        assert!(!told.contains(commands) && !said.contains(commands), "{}", context());
        ended[status as usize] += 1;
        clean(folder.path());
    }
    ended
}

/// Removes what a command has written: a new planet may have a structure, whose maps take minutes.
fn clean(folder: &Path) {
    for entry in folder.read_dir().unwrap().map(Result::unwrap) {
        let is_ours = ["planet.ron", "points"].iter().any(|name| entry.file_name() == *name);
        match entry.file_type().unwrap().is_dir() {
            true => std::fs::remove_dir_all(entry.path()).unwrap(),
            false if !is_ours => std::fs::remove_file(entry.path()).unwrap(),
            false => {}
        }
    }
}

#[test]
fn random_command_lines_end_with_an_answer_or_a_message() {
    let ended = run(0, CASES);
    assert!(ended.iter().all(|count| *count > CASES / 20), "{ended:?}");
}

#[test]
#[ignore = "minutes; in `scripts/test long`"]
fn twenty_thousand_random_command_lines_end_with_an_answer_or_a_message() {
    let ended = run(CASES, LONG_CASES);
    println!("counted: {LONG_CASES} random command lines; status 0, 1, 2: {ended:?}");
}
