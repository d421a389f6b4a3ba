//! The version of all that shapes the ground, and what a preset says of it.

use super::{locate, text::SAVED};

/// The version of all that shapes the ground: layers, the solvers of world maps, and rivers between their cells. Equal
/// presets have equal heights, to the bit, wherever this version is the same; files that were made of a planet tell it,
/// and presets with a structure. It grows with every change of a height, also of planets with a structure alone; tests
/// of solved worlds say when.
pub const GROUND_VERSION: u32 = 5;

/// What each version changed, the newest first.
const CHANGES: &[(u32, &str)] = &[
    (5, "lakes have a rim where lower ground lies beside them, and islands where they are shallow"),
    (4, "layers over a structure end at its rivers, and wide rivers have their bed on their whole width"),
];

/// The field of a preset.
const FIELD: &str = "ground_version";

/// A note for the user of a preset whose solved ground is other here than where it was saved; None if it is the same,
/// or if the planet has no structure. `text`: of the preset.
pub fn ground_note(text: &str) -> Option<String> {
    let value = |field: &str| locate::find(text, field).map(|place| &text[place.value..]);
    value("structure").filter(|structure| !structure.starts_with("None"))?;
    let now = GROUND_VERSION;
    let Some(found) = value(FIELD) else {
        return was_saved(text).then(|| {
            format!(
                "an earlier Tellus saved this planet; its rivers and lakes may be other ones now. Saved again, it says \
                 that it is meant for this ground (version {now})"
            )
        });
    };
    let digits = found.split(|c: char| !c.is_ascii_digit()).next()?;
    match digits.parse::<u32>().ok()? {
        version if version == now => None,
        version if version > now => Some(format!(
            "a newer Tellus shaped this planet (ground version {version}, here {now}); its rivers and lakes differ \
             here: update the program"
        )),
        version => {
            let changes: Vec<&str> =
                CHANGES.iter().filter(|(number, _)| *number > version).map(|(_, change)| *change).collect();
            Some(format!(
                "this planet was shaped by ground version {version}, and is by {now} now: {}. Saved again, it says \
                 that it is meant for the new ground; who needs the old one keeps that version of Tellus",
                changes.join("; ")
            ))
        }
    }
}

/// Whether a program saved the text, rather than a hand or a script that left fields out.
fn was_saved(text: &str) -> bool {
    text.trim_start_matches('\u{feff}').trim_start().starts_with(SAVED)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::planet::{Planet, shipped};

    #[test]
    fn only_other_ground_is_worth_a_note() {
        let saved = shipped::default_planet().to_text();
        assert!(saved.contains(&format!("\n    {FIELD}: {GROUND_VERSION},\n")), "{saved}");
        assert_eq!(ground_note(&saved), None);
        let with = |version: &str| {
            saved.replace(&format!("{FIELD}: {GROUND_VERSION},"), &version.replace('#', &format!("{FIELD}: ")))
        };
        let note = |version: &str| ground_note(&with(version)).unwrap_or_default();
        assert!(note("#4,").contains("lakes have a rim") && !note("#4,").contains("wide rivers"), "{}", note("#4,"));
        assert!(note("#3,").contains("wide rivers"));
        assert!(note("#99,").contains("update the program"));
        assert!(note("").contains("an earlier Tellus saved"));
        assert_eq!(ground_note(&format!("// By hand.\n{}", with(""))), None);
        // All of them can be read, and are saved with the version of today.
        for version in ["#4,", "#99,", ""] {
            assert_eq!(Planet::from_text("a.ron", &with(version)).unwrap().to_text(), saved);
        }
        let plain = Planet { structure: None, ..shipped::default_planet() }.to_text();
        assert!(!plain.contains(FIELD) && ground_note(&plain).is_none());
    }

    #[test]
    fn each_version_says_what_it_changed() {
        assert_eq!(CHANGES[0].0, GROUND_VERSION);
    }
}
