//! Messages about broken files are in plain words, with the place and what would be right; no word of the parser shows.

use crate::fuzz::{changed, tokens};
use crate::support::dice::Dice;
use tellus::planet::{LoadError, Planet, shipped};
use tellus::system::{self, System};

/// Changed texts of each file.
const CASES: u64 = 3000;

/// Words of the parser and of its library, in small letters.
const RAW: [&str; 34] = [
    "expected",
    "unexpected ",
    "invalid",
    "identifier",
    "boolean",
    "integer",
    "float",
    "struct ",
    "enum",
    "variant",
    "tuple",
    "sequence",
    "a map",
    "unit value",
    "optional value",
    "newtype",
    "attribute",
    "extension",
    "recursion",
    "serde",
    "ron::",
    "rawvalue",
    "raw identifier",
    "eof",
    "end of ron",
    "non-whitespace",
    "trailing",
    "unicode",
    "escape",
    "utf-8 char",
    "hex digit",
    "out of bounds",
    "underscore",
    "std ",
];

/// A message without what it repeats of the file.
fn own_words(message: &str) -> String {
    message.split('`').step_by(2).collect::<Vec<_>>().join("`").to_lowercase()
}

/// What is raw in a message, if anything.
fn raw(error: &LoadError) -> Option<String> {
    let LoadError::Invalid { problems, .. } = error else { return Some(error.to_string()) };
    let wrong = problems.iter().find(|problem| {
        let words = own_words(&problem.message);
        // A place, and what would be right.
        let is_whole = problem.line > 0 && problem.column > 0 && words.contains(['`', ';', ',']);
        // A comma is unexpected, or something before one.
        let words = words.replace(" is unexpected; put", "");
        !is_whole || RAW.iter().any(|raw| words.contains(raw))
    });
    wrong.map(ToString::to_string)
}

/// Reads changed texts of a file. Gives the raw messages.
fn raw_messages(text: &str, first: u64, read: impl Fn(&str) -> Result<(), LoadError>) -> Vec<String> {
    let tokens = tokens(text);
    let mut refused = 0;
    let mut found = Vec::new();
    for seed in first..first + CASES {
        let changed = changed(&tokens, &mut Dice(seed));
        if let Err(error) = read(&changed) {
            refused += 1;
            found.extend(raw(&error).map(|message| format!("seed {seed}: {message}")));
        }
    }
    assert!(refused > CASES / 2, "only {refused} of {CASES} were refused");
    found
}

#[test]
fn no_word_of_the_parser_reaches_the_reader() {
    let preset = shipped::ALL.iter().find(|preset| preset.file == "maren.ron").unwrap();
    let mut found = raw_messages(preset.text, 1, |text| Planet::from_text("p.ron", text).map(drop));
    let system = system::shipped::ALL[0].load().unwrap().to_text();
    found.extend(raw_messages(&system, 1_000_000, |text| System::from_text("s.ron", text).map(drop)));
    assert!(found.is_empty(), "{} raw messages:\n{}", found.len(), found[..found.len().min(40)].join("\n"));
}

/// What the parser has words of its own for is told with its place and what would be right.
#[test]
fn signs_that_mean_nothing_are_explained() {
    for (text, expected) in [
        ("(version: 3, radius_km: 6371,0)", "f.ron:1:25: radius_km: write 6371.0 with a point; a comma ends the value"),
        (
            "(version: 3, water: (level_m: -12,75))",
            "f.ron:1:31: water.level_m: write -12.75 with a point; a comma ends the value",
        ),
        ("(version: 3, 5: 2)", "f.ron:1:14: `5` is not a field's name; write `field: value`"),
        (
            "(version: 3, name: \"a\\qb\")",
            "f.ron:1:22: name: this `\\` begins no known sign; write `\\\\` for a backslash, and `/` in paths",
        ),
        (
            "#![enable(nothing)] (version: 3)",
            "f.ron:1:1: a line with `#!` changes the notation; remove it: no preset needs one",
        ),
        ("(version: 3, radius_km: 1e300)", "f.ron:1:25: radius_km: 1e300 is out of range; use 1 to 100000 km"),
        (
            "(version: 1, name: \"Hearth\", bodies: [])",
            "f.ron:1:30: this is a system file, not a preset; name the preset of one of its planets, or one of its \
             bodies (--body)",
        ),
    ] {
        let message = Planet::from_text("f.ron", text).unwrap_err().to_string();
        assert_eq!(message, expected, "{text}");
    }
}

#[test]
fn a_file_of_the_other_kind_is_called_so() {
    let preset = Planet::default().to_text();
    let message = System::from_text("s.ron", &preset).unwrap_err().to_string();
    assert!(
        message.contains("this is a preset of one planet, not a system file; name a file with `bodies`"),
        "{message}"
    );
    let system = system::shipped::ALL[0].load().unwrap().to_text();
    let message = Planet::from_text("p.ron", &system).unwrap_err().to_string();
    assert!(message.contains("this is a system file, not a preset"), "{message}");
}
