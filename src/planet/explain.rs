//! Parses RON, and explains errors to a person who edits presets by hand.
//!
//! ron reports a position and what it expected; serde_path_to_error adds the path; the description of the parameter
//! adds what would be right.

use super::param::{Domain, Form, Param};
use super::printable::printable;
use super::root::Root;
use super::{Mask, Problem, Shape, Tool, life, locate};
use ron::error::{Error, SpannedError};
use ron::extensions::Extensions;
use serde::de::DeserializeOwned;
use serde_path_to_error::Segment;

const TOO_EARLY: &str = "the text ends too early; a closing bracket or a value is missing";

/// RON options of presets: `shape: Fbm(octaves: 3)` and `water: (level_m: 0.0)` need no further brackets.
pub(crate) fn options() -> ron::Options {
    let extensions = Extensions::UNWRAP_VARIANT_NEWTYPES | Extensions::IMPLICIT_SOME;
    ron::Options::default().with_default_extension(extensions)
}

/// Reads the whole text as one value: a file of an `R`, perhaps of an old version.
pub(crate) fn parse<R: Root, T: DeserializeOwned>(text: &str) -> Result<T, Problem> {
    let outside = |error: SpannedError| problem::<R>(text, String::new(), &error);
    let mut deserializer = ron::Deserializer::from_str_with_options(text, &options()).map_err(outside)?;
    let mut track = serde_path_to_error::Track::new();
    let value = T::deserialize(serde_path_to_error::Deserializer::new(&mut deserializer, &mut track));
    let value = value.map_err(|code| problem::<R>(text, path_text(&track.path()), &deserializer.span_error(code)))?;
    deserializer.end().map_err(|code| outside(deserializer.span_error(code)))?;
    Ok(value)
}

/// The path as in `layers[2].shape.octaves`; enum variants are not part of it.
fn path_text(path: &serde_path_to_error::Path) -> String {
    let mut text = String::new();
    for segment in path {
        match segment {
            Segment::Seq { index } => text.push_str(&format!("[{index}]")),
            Segment::Map { key } if text.is_empty() => text.push_str(key),
            Segment::Map { key } => text.push_str(&format!(".{key}")),
            Segment::Enum { .. } | Segment::Unknown => {}
        }
    }
    text
}

fn problem<R: Root>(text: &str, path: String, error: &SpannedError) -> Problem {
    let stop = locate::offset(text, error.span.end.line, error.span.end.col);
    let place = locate::find(text, &path);
    let at_value = place.map_or(stop, |place| place.value);
    if let Some((start, number)) = decimal_comma(text, stop) {
        let path = last_value(text, start + 1).0;
        return Problem { path, ..at(text, start, format!("write {number} with a point; a comma ends the value")) };
    }
    let (offset, message) = match &error.code {
        Error::NoSuchStructField { expected, found, .. } => {
            (key_offset(text, &path, found).unwrap_or(stop), stranger("field", found, expected))
        }
        Error::NoSuchEnumVariant { expected, found, .. } => (at_value, stranger("value", found, expected)),
        Error::DuplicateStructField { field, .. } => {
            (key_offset(text, &path, field).unwrap_or(stop), format!("`{field}` stands here twice; remove one"))
        }
        Error::MissingStructField { field, .. } => (at_value, format!("`{field}` is missing; add it")),
        // ron reads `octaves: 3.5` as 3 and then misses a comma.
        Error::ExpectedComma if text.get(stop..).is_some_and(|rest| rest.starts_with('.')) => {
            let (path, place) = last_value(text, stop);
            let offset = place.map_or(stop, |place| place.value);
            let message = wanted::<R>(text, &path, offset);
            return Problem { path, ..at(text, offset, message) };
        }
        Error::ExpectedComma if text.get(stop..).is_none_or(|rest| rest.trim().is_empty()) => {
            (stop, TOO_EARLY.to_owned())
        }
        Error::ExpectedComma => (stop, format!("{} is unexpected; put a comma before it", locate::excerpt(text, stop))),
        Error::ExpectedBoolean
        | Error::ExpectedFloat
        | Error::ExpectedInteger
        | Error::ExpectedString
        | Error::ExpectedChar
        | Error::ExpectedArray
        | Error::ExpectedStructLike
        | Error::ExpectedNamedStructLike(_)
        | Error::ExpectedOption
        | Error::ExpectedUnit
        | Error::InvalidValueForType { .. }
        | Error::InvalidIntegerDigit { .. }
        | Error::IntegerOutOfBounds
        | Error::FloatUnderscore
        | Error::UnderscoreAtBeginning
            if place.is_some() =>
        {
            (at_value, wanted::<R>(text, &path, at_value))
        }
        Error::ExpectedDifferentLength { found, .. } => {
            let are = if *found == 1 { "number is" } else { "numbers are" };
            (at_value, format!("{found} {are} too few; use {}", numbers::<R>(&path)))
        }
        Error::ExpectedStructLikeEnd if place.is_some_and(|p| parameter::<R>(&path).is_some() && p.value < stop) => {
            (stop, format!("too many numbers; use {}; decimals have a point: 0.5", numbers::<R>(&path)))
        }
        Error::ExpectedStructLikeEnd | Error::ExpectedOptionEnd => {
            (stop, "a closing `)` is missing; add it here".to_owned())
        }
        Error::ExpectedArrayEnd => (stop, "a closing `]` is missing; add it here".to_owned()),
        Error::ExpectedMapColon => (stop, "a colon is missing; write `field: value`".to_owned()),
        Error::ExpectedStringEnd => (stop, "this text has no closing `\"`; add it".to_owned()),
        Error::UnclosedBlockComment => (stop, "this comment has no closing `*/`; add it".to_owned()),
        Error::ExpectedIdentifier if text.get(stop..).is_some_and(|rest| rest.starts_with('(')) => {
            (stop, "this `(` is one too many; write `(field: value, ...)`".to_owned())
        }
        Error::ExpectedIdentifier => {
            (stop, format!("{} is not a field's name; write `field: value`", locate::excerpt(text, stop)))
        }
        Error::Eof => (text.len(), TOO_EARLY.to_owned()),
        Error::TrailingCharacters => {
            let (found, thing) = (locate::excerpt(text, stop), R::THING);
            (stop, format!("{found} stands behind the {thing}; remove all behind the last `)`"))
        }
        Error::ExceededRecursionLimit => (stop, format!("brackets are nested too deeply; a {} needs few", R::NOUN)),
        Error::ExpectedDifferentStructName { expected, found } => {
            (at_value, format!("`{found}` is not what belongs here; write `{expected}(...)` or only `(...)`"))
        }
        Error::ExpectedStructLike | Error::ExpectedNamedStructLike(_) => {
            let found = locate::excerpt(text, stop);
            (stop, format!("found {found}; a {} is written `(version: {}, ...)`", R::NOUN, R::VERSION))
        }
        Error::SuggestRawIdentifier(found) | Error::InvalidIdentifier(found) => {
            let start = start_of(text, found, stop);
            if is_behind_colon(text, start) {
                let (path, _) = last_value(text, start + 1);
                let message = wanted::<R>(text, &path, start);
                return Problem { path, ..at(text, start, message) };
            }
            (start, format!("{} is not a field's name; write `field: value`", locate::excerpt(text, start)))
        }
        Error::InvalidEscape(_) => {
            let message = "this `\\` begins no known sign; write `\\\\` for a backslash, and `/` in paths";
            (before(text, "\\", stop), message.to_owned())
        }
        Error::ExpectedAttribute | Error::ExpectedAttributeEnd | Error::NoSuchExtension(_) => {
            let message = format!("a line with `#!` changes the notation; remove it: no {} needs one", R::NOUN);
            (before(text, "#!", stop), message)
        }
        // The words of a parser help nobody who has not written it.
        _ if place.is_some() && !path.is_empty() => (at_value, wanted::<R>(text, &path, at_value)),
        _ => {
            let found = locate::excerpt(text, stop);
            let (noun, version) = (R::NOUN, R::VERSION);
            (
                stop,
                format!(
                    "{found} is not what belongs here; a {noun} is written `(version: {version}, field: value, ...)`"
                ),
            )
        }
    };
    Problem { path, ..at(text, offset, message) }
}

/// A number with a comma for a point, near which the parser has stopped: its offset, and how it is written. `a: 1,5` is
/// one, but not the list `[1,5]`.
fn decimal_comma(text: &str, stop: usize) -> Option<(usize, String)> {
    let is_digit = |byte: Option<&u8>| byte.is_some_and(u8::is_ascii_digit);
    let bytes = text.as_bytes();
    // The parser stands at the digits behind the comma, or behind them.
    let behind = bytes.get(..stop)?.iter().rev().take_while(|byte| byte.is_ascii_digit()).count();
    let comma = (stop - behind).checked_sub(1).filter(|comma| bytes.get(*comma) == Some(&b','))?;
    if !is_digit(bytes.get(comma + 1)) || !is_digit(comma.checked_sub(1).and_then(|before| bytes.get(before))) {
        return None;
    }
    let is_whole = |byte: &&u8| byte.is_ascii_digit() || matches!(byte, b'-' | b'+' | b'_');
    let start = comma - bytes[..comma].iter().rev().take_while(is_whole).count();
    let end = comma + 1 + bytes[comma + 1..].iter().take_while(|byte| byte.is_ascii_digit()).count();
    let number = text.get(start..end)?.replace(',', ".");
    is_behind_colon(text, start).then_some((start, number))
}

/// Whether a value begins at an offset.
fn is_behind_colon(text: &str, offset: usize) -> bool {
    text.get(..offset).is_some_and(|before| before.trim_end().ends_with(':'))
}

/// Where a sign stands last before the parser has stopped.
fn before(text: &str, sign: &str, stop: usize) -> usize {
    text.get(..stop).and_then(|read| read.rfind(sign)).unwrap_or(stop)
}

/// Where a word begins at or behind which the parser has stopped.
fn start_of(text: &str, word: &str, stop: usize) -> usize {
    let mut from = stop.saturating_sub(word.len() + 2);
    while !text.is_char_boundary(from) {
        from -= 1;
    }
    text[from..].find(word).map_or(stop, |found| from + found)
}

/// A problem at a byte offset.
pub(crate) fn at(text: &str, offset: usize, message: impl Into<String>) -> Problem {
    let (line, column) = locate::line_column(text, offset);
    Problem { line, column, path: String::new(), message: message.into() }
}

/// The offset of the last occurrence of a field's name. ron names the field, but reports a position behind it.
fn key_offset(text: &str, path: &str, field: &str) -> Option<usize> {
    let parent = locate::steps(path);
    let parent = match parent.split_last() {
        Some((locate::Step::Field(last), rest)) if *last == field => rest.to_vec(),
        _ => parent,
    };
    let mut key = None;
    locate::walk(text, |path, place| {
        if path.split_last().is_some_and(|(last, rest)| *last == locate::Step::Field(field) && rest == parent) {
            key = Some(place.key);
        }
        true
    });
    key
}

/// The last value that begins before an offset.
fn last_value(text: &str, before: usize) -> (String, Option<locate::Place>) {
    let mut last = (String::new(), None);
    locate::walk(text, |path, place| {
        if place.value < before {
            last = (locate::path_text(path), Some(place));
        }
        place.value < before
    });
    last
}

/// The message for an unknown name: a guess of what was meant, and the known names.
fn stranger(what: &str, found: &str, known: &[&str]) -> String {
    let near = known
        .iter()
        .map(|name| (strsim::damerau_levenshtein(&found.to_lowercase(), &name.to_lowercase()), *name))
        .filter(|(distance, name)| *distance <= 1 + name.len().min(found.len()) / 4)
        .min();
    let meant = near.map_or(String::new(), |(_, name)| format!("did you mean `{name}`? "));
    let found = printable(found);
    match known {
        [] => format!("there is no {what} `{found}` here; remove it"),
        _ => format!("there is no {what} `{found}` here; {meant}use {}", list(known, "")),
    }
}

/// The message for a value of the wrong type: what was found, and what would be right.
fn wanted<R: Root>(text: &str, path: &str, offset: usize) -> String {
    let found = locate::excerpt(text, offset);
    let right = match parameter::<R>(path) {
        Some((param, names)) => in_words(param, names),
        None if path == "version" => format!("a whole number, now {}", R::VERSION),
        None => match (form::<R>(path), path.ends_with(']')) {
            (Some(Form::List), false) => "a list: `[(...), (...)]`".to_owned(),
            (Some(Form::Table), false) => "a list of rows: `[\"aab\", \"abb\"]`".to_owned(),
            (Some(Form::Table), true) => "a row of letters: `\"aab\"`".to_owned(),
            (Some(Form::Optional), false) => "`(...)` or `None`".to_owned(),
            _ => "`(field: value, ...)`".to_owned(),
        },
    };
    format!("{found} is not what belongs here; use {right}")
}

/// The form of the part at a path, or of the part whose element is at the path.
fn form<R: Root>(path: &str) -> Option<Form> {
    let name = locate::steps(path).into_iter().rev().find_map(|step| match step {
        locate::Step::Field(name) => Some(name),
        locate::Step::Index(_) => None,
    })?;
    R::parts().into_iter().find(|part| part.name == name).map(|part| part.form)
}

fn in_words(param: &Param, names: &[&str]) -> String {
    match param.domain {
        Domain::Number { .. } => format!("a number: {}", param.range_text()),
        Domain::Count { .. } => format!("a whole number: {}", param.range_text()),
        Domain::Seed => format!("a whole number: 0 to {}", u32::MAX),
        Domain::Triple { .. } | Domain::Color => {
            format!("three numbers, for red, green and blue: `(0.1, 0.2, 0.3)`, {}", param.range_text())
        }
        Domain::Flag => "`true` or `false`".to_owned(),
        Domain::Letter | Domain::BiomeKey => "a letter in single quotes: `'a'`".to_owned(),
        Domain::BiomeKeys => "keys of biomes in double quotes: `\"fw\"`".to_owned(),
        Domain::Text { .. } | Domain::MaskName { .. } | Domain::PopulationName { .. } => {
            "text in double quotes: `\"text\"`".to_owned()
        }
        Domain::Curve { .. } => format!("a list of points: `[(-1, 0), (1, 2)]`, {}", param.range_text()),
        Domain::File { .. } => "a path in double quotes: `\"maps/heights.png\"`".to_owned(),
        // A kind carries its own parameters: `Fbm(...)`.
        Domain::Choice
            if [Shape::KIND.name, Mask::KIND.name, Tool::KIND.name, life::Form::KIND.name].contains(&param.name) =>
        {
            format!("one of {}", list(names, "(...)"))
        }
        Domain::Choice => format!("one of {}", list(names, "")),
    }
}

/// The count of numbers in brackets that a path needs, in words.
fn numbers<R: Root>(path: &str) -> &'static str {
    match parameter::<R>(path) {
        Some((Param { domain: Domain::Curve { .. }, .. }, _)) => "two for each point: `(from, to)`",
        None if path.contains(".points[") => "two for each point, `(latitude, longitude)`, or three with a height",
        _ => "three, for red, green and blue",
    }
}

fn list(names: &[&str], after: &str) -> String {
    let names: Vec<String> = names.iter().map(|name| format!("`{name}{after}`")).collect();
    names.join(", ")
}

/// The description of the parameter at a path, and the names of its values if it is a choice.
fn parameter<R: Root>(path: &str) -> Option<(&'static Param, &'static [&'static str])> {
    // Elements of a list have the same parameters: indices are left out.
    let general = |steps: Vec<locate::Step<'_>>| -> Vec<Option<String>> {
        let name = |step: &locate::Step<'_>| match step {
            locate::Step::Field(name) => Some((*name).to_owned()),
            locate::Step::Index(_) => None,
        };
        steps.iter().map(name).collect()
    };
    let mut wanted = general(locate::steps(path));
    loop {
        let mut found = None;
        for root in R::every_kind() {
            root.look(&mut |path, param, value| {
                if found.is_none() && general(locate::steps(&path.to_string())) == wanted {
                    found = Some((param, value.names()));
                }
            });
        }
        // Components of a colour and points of a curve have the description of the whole.
        if found.is_some() || wanted.pop() != Some(None) {
            return found;
        }
    }
}
