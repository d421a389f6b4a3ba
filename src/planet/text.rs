//! The text of a preset: RON with the description of each parameter above its first occurrence.
//!
//! Comments are inserted afterwards, at the offsets that [`locate`] finds: ron's own metadata by path cannot tell the
//! first element of a list from the others, nor one landform from another.

use super::explain::options;
use super::param::{Domain, Param, ValueRef};
use super::root::Root;
use super::{Mask, locate};
use ron::ser::PrettyConfig;
use std::collections::{HashMap, HashSet};
use std::fmt::Write as _;

/// Longest line of a comment in characters, without indentation.
const COMMENT_CHARS: usize = 100;

/// A space at which lines are not broken.
const GLUE: &str = "\u{1}";

/// Writes a planet or a system.
pub(crate) fn write<R: Root + Into<R::File>>(root: &R) -> String {
    // Raw strings instead of escapes keep names readable.
    let config = PrettyConfig::new().new_line("\n").escape_strings(false);
    let mut bare = String::new();
    // Writing plain data into a string cannot fail. If it did, the text would be refused when it is read.
    let _ = options().to_writer_pretty(&mut bare, &Into::<R::File>::into(root.clone()), config);
    let mut text = header::<R>();
    let mut done = 0;
    for (at, comment) in comments(root, &bare) {
        let line_start = bare[..at].rfind('\n').map_or(0, |i| i + 1);
        let indent = &bare[line_start..at];
        text.push_str(&bare[done..line_start]);
        for line in wrapped(&comment) {
            let _ = writeln!(text, "{indent}// {line}");
        }
        done = line_start;
    }
    text.push_str(&bare[done..]);
    text.push('\n');
    text
}

/// The first words of each planet that is saved.
pub(super) const SAVED: &str = "// A planet for Tellus";

fn header<R: Root>() -> String {
    format!(
        "// A {} for Tellus, format version {}. Fields that are left out take their default values.\n\
         // Colours are linear sRGB. Comments are written anew when the file is saved.\n",
        R::THING,
        R::VERSION
    )
}

/// The comment of each parameter and part, with the offset of its first name.
fn comments<R: Root>(root: &R, bare: &str) -> Vec<(usize, String)> {
    // Each path has a description; each description is written once.
    let mut params: HashMap<String, String> = HashMap::new();
    root.look(&mut |path, param, value| {
        params.insert(path.to_string(), comment(param, value));
    });
    let mut parts: HashMap<&str, String> =
        R::parts().into_iter().map(|part| (part.name, part.doc.to_owned())).collect();
    if let Some(masks) = parts.get_mut("masks") {
        // Elements of the list name their kind, which has no comment of its own.
        let _ = write!(masks, " ({})", Mask::NAMES.join(", ").replace(' ', GLUE));
    }
    let mut written = HashSet::new();
    let mut found = Vec::new();
    locate::walk(bare, |steps, place| {
        let Some(locate::Step::Field(name)) = steps.last() else { return true };
        let param = params.get(&locate::path_text(steps)).cloned();
        if let Some(comment) = param.or_else(|| parts.get(name).cloned())
            && written.insert((*name, comment.clone()))
        {
            found.push((place.key, comment));
        }
        true
    });
    found
}

/// The comment of a parameter: `Wavelength of the coarsest octave. (0.001 to 100000 km)`
fn comment(param: &Param, value: ValueRef<'_>) -> String {
    let mut text = param.doc.to_owned();
    let range = match (value, param.domain) {
        (ValueRef::Choice(choice), _) => choice.names().join(", "),
        // These have no range worth a comment.
        (
            _,
            Domain::Text { .. }
            | Domain::BiomeKeys
            | Domain::MaskName { .. }
            | Domain::PopulationName { .. }
            | Domain::File { .. }
            | Domain::Color,
        ) => String::new(),
        _ => param.range_text(),
    };
    if !range.is_empty() {
        // Short ranges stay on one line.
        let range = if range.len() <= COMMENT_CHARS / 2 { range.replace(' ', GLUE) } else { range };
        let _ = write!(text, " ({range})");
    }
    text
}

fn wrapped(text: &str) -> Vec<String> {
    let mut lines = vec![String::new()];
    for word in text.split(' ').filter(|word| !word.is_empty()).map(|word| word.replace(GLUE, " ")) {
        if let Some(line) = lines.last_mut() {
            if line.is_empty() {
                line.push_str(&word);
            } else if line.chars().count() + 1 + word.chars().count() <= COMMENT_CHARS {
                line.push(' ');
                line.push_str(&word);
            } else {
                lines.push(word);
            }
        }
    }
    lines
}
