//! Ground edits in a file beside the preset.
//!
//! A preset whose list of edits would be longer than [`MOST_INLINE_BYTES`] names a file of its folder instead:
//! `edits: "maren.edits-0123456789abcdef.ron"`. That file is a preset that holds edits alone.
//!
//! Its name ends with a hash of its text, so a save never changes an edits file that a preset names: it writes another
//! one, then replaces the preset, then removes what no preset names any more. A save that is killed leaves the old
//! preset with its old edits or the new one with its new edits.

use super::file::{self, LoadError, MAX_FILE_BYTES, write_atomically};
use super::key::fnv1a;
use super::param::ParamPath;
use super::picture::folder_of;
use super::{Planet, Problem, explain, locate, snippet};
use std::fs;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

/// Longest list of edits in a preset, in bytes: some thousand strokes.
const MOST_INLINE_BYTES: usize = 1 << 20;
/// Fewer edits of fewer points each are a shorter list.
const FEW_EDITS: usize = 100;
const FEW_POINTS: usize = 100;

/// What stands between the stem of the preset and the hash, and behind the hash.
const MIDDLE: &str = ".edits-";
const END: &str = ".ron";
/// Digits of the hash.
const DIGITS: usize = 16;
/// An edits file younger than this may be one whose preset is being written.
const YOUNG: Duration = Duration::from_secs(60);
/// Files of a folder that are searched for the names of edits files. In a fuller folder none is removed.
const MOST_SEARCHED: usize = 1000;
/// Longer files are no presets that name an edits file.
const LONGEST_SEARCHED_BYTES: u64 = 4 << 20;

/// Gives the text of an edits file by its name, or why there is none.
pub(super) type Fetch<'a> = dyn FnMut(&str) -> Result<String, String> + 'a;

/// An edits file that was read.
pub(super) struct EditsFile {
    file: String,
    text: String,
}

/// No edits file can be read: the text does not come from a file.
pub(super) fn nowhere(name: &str) -> Result<String, String> {
    Err(format!("the edits are in the file {name} beside the preset, and this text has no folder; load it as a file"))
}

/// Reads edits files in the folder of a preset. Of a link to a preset, in the folder of the preset.
pub(super) fn in_folder_of(preset: &Path) -> impl FnMut(&str) -> Result<String, String> + use<> {
    let folder = folder_of(preset);
    move |name| match file::read_text(&folder.join(name)) {
        Ok(text) => Ok(text),
        Err(LoadError::Read { source, .. }) => Err(format!("{name}, which belongs beside the preset: {source}")),
        Err(LoadError::Invalid { problems, .. }) => {
            let why = problems.into_iter().next().map(|problem| problem.message).unwrap_or_default();
            Err(format!("{name}: {why}"))
        }
    }
}

/// Parses a preset and the edits that it names. Values may be invalid: see [`checked`].
pub(super) fn parsed(file: &str, text: &str, fetch: &mut Fetch<'_>) -> Result<(Planet, Option<EditsFile>), LoadError> {
    let Some(place) = reference(text) else { return Ok((file::parsed_alone(file, text)?, None)) };
    let invalid = |message: String| LoadError::Invalid {
        file: file.to_owned(),
        problems: vec![Problem { path: "edits".to_owned(), ..explain::at(text, place.start, message) }],
    };
    let name = checked_name(&text[place.clone()]).map_err(invalid)?;
    // As long as the name, so that places of problems stay right.
    let list = format!("[{}]", " ".repeat(place.len() - 2));
    let mut planet = file::parsed_alone(file, &[&text[..place.start], &list, &text[place.end..]].concat())?;
    let edits = EditsFile { file: name.to_owned(), text: fetch(name).map_err(invalid)? };
    if reference(&edits.text).is_some() {
        return Err(invalid(format!("{name} names a further file; it must list the edits")));
    }
    planet.edits = file::parsed_alone(name, &edits.text)?.edits;
    match stranger(&edits.text) {
        Some(problem) => Err(LoadError::Invalid { file: name.to_owned(), problems: vec![problem] }),
        None => Ok((planet, Some(edits))),
    }
}

/// A field of an edits file that belongs in the preset.
fn stranger(text: &str) -> Option<Problem> {
    let mut found = None;
    locate::walk(text, |steps, place| {
        if let [locate::Step::Field(name)] = steps
            && !["version", "edits"].contains(name)
        {
            let message = format!("a file of edits holds nothing else; move `{name}` to the preset");
            found = Some(Problem { path: (*name).to_owned(), ..explain::at(text, place.key, message) });
        }
        found.is_none()
    });
    found
}

/// Checks a planet that was parsed, problems of edits at their places in the edits file.
pub(super) fn checked(file: &str, text: &str, planet: &Planet, edits: Option<&EditsFile>) -> Result<(), LoadError> {
    let problems = super::validate::problems(planet);
    if problems.is_empty() { Ok(()) } else { Err(placed(file, text, edits, problems)) }
}

/// Adds their places to the problems of a planet. If there are problems in the edits file, those alone.
pub(super) fn placed(
    file: &str,
    text: &str,
    edits: Option<&EditsFile>,
    problems: Vec<(ParamPath, String)>,
) -> LoadError {
    if let Some(edits) = edits {
        let is_edit = |(path, _): &(ParamPath, String)| path.to_string().starts_with("edits[");
        if problems.iter().any(is_edit) {
            let of_edits = problems.into_iter().filter(is_edit).collect();
            return file::all_placed(&edits.file, &edits.text, of_edits);
        }
    }
    file::all_placed(file, text, problems)
}

/// Where a text names an edits file, with the quotes.
fn reference(text: &str) -> Option<Range<usize>> {
    let start = locate::find(text, "edits")?.value;
    let name = text[start..].strip_prefix('"')?;
    Some(start..start + name.find('"')? + 2)
}

/// The name of an edits file, without its quotes: that of a file in the folder of the preset.
fn checked_name(quoted: &str) -> Result<&str, String> {
    let name = quoted.trim_matches('"');
    let is_bare = !name.starts_with('.') && !name.contains(['/', '\\', ':']) && !name.chars().any(char::is_control);
    if is_bare && name.ends_with(END) {
        Ok(name)
    } else {
        Err(format!("{quoted} is not the name of an edits file; name a .ron file in the folder of the preset"))
    }
}

/// The edits file of a preset on the disk, if it names one.
pub(super) fn of_preset(preset: &Path) -> Option<PathBuf> {
    let text = file::read_text(preset).ok()?;
    let place = reference(&text)?;
    Some(folder_of(preset).join(checked_name(&text[place]).ok()?))
}

/// What a save writes.
pub(super) struct Texts {
    /// The text of the preset.
    pub(super) preset: String,
    /// Name and text of the edits file.
    pub(super) edits: Option<(String, String)>,
}

/// The texts of a planet whose preset has this path.
pub(super) fn texts(planet: &Planet, preset: &Path) -> Texts {
    let in_one = || Texts { preset: planet.to_text(), edits: None };
    // Edits are written once, not as a part of the whole first.
    let is_few = planet.edits.len() < FEW_EDITS && planet.edits.iter().all(|edit| edit.points.0.len() < FEW_POINTS);
    let long = (!is_few).then(|| snippet::of_part(planet, "edits")).flatten();
    let Some(edits) = long.filter(|text| text.len() > MOST_INLINE_BYTES) else { return in_one() };
    let stem = preset.file_stem().unwrap_or_default().to_string_lossy();
    let name = name_of(&stem, edits.as_bytes());
    let mut bare = Planet { edits: Default::default(), ..planet.clone() }.to_text();
    match bare.rfind(')') {
        Some(end) if checked_name(&format!("{name:?}")).is_ok() => {
            let comment = "// Changes of the ground made by hand, applied from first to last after all layers.";
            bare.insert_str(end, &format!("    {comment}\n    edits: {name:?},\n"));
            Texts { preset: bare, edits: Some((name, edits)) }
        }
        _ => in_one(),
    }
}

/// Writes an edits file, unless it is there.
pub(super) fn write(folder: &Path, name: &str, text: &str) -> Result<(), String> {
    let path = folder.join(name);
    let is_there = file::read(&path, text.len() as u64).is_ok_and(|bytes| bytes == text.as_bytes());
    if is_there { Ok(()) } else { write_atomically(&path, text.as_bytes()).map_err(|why| format!("{name}: {why}")) }
}

/// Removes edits files of a preset that no file of the folder names: of former saves.
pub(super) fn sweep(folder: &Path, preset: &Path) {
    let stem = preset.file_stem().unwrap_or_default().to_string_lossy();
    let entries: Vec<_> = fs::read_dir(folder).into_iter().flatten().flatten().take(MOST_SEARCHED + 1).collect();
    let is_candidate = |entry: &fs::DirEntry| {
        let is_old = || entry.metadata().ok()?.modified().ok()?.elapsed().ok().map(|age| age > YOUNG);
        is_edits_file_of(&stem, &entry.file_name().to_string_lossy()) && is_old() == Some(true)
    };
    let mut former: Vec<&fs::DirEntry> = entries.iter().filter(|entry| is_candidate(entry)).collect();
    if former.is_empty() || entries.len() > MOST_SEARCHED {
        return;
    }
    for entry in &entries {
        let is_short = entry.metadata().is_ok_and(|data| data.is_file() && data.len() <= LONGEST_SEARCHED_BYTES);
        let is_edits = is_edits_file_of(&stem, &entry.file_name().to_string_lossy());
        if is_short && !is_edits {
            // What cannot be read may name all of them.
            let Ok(bytes) = file::read(&entry.path(), LONGEST_SEARCHED_BYTES) else { return };
            let text = String::from_utf8_lossy(&bytes);
            former.retain(|former| !text.contains(&*former.file_name().to_string_lossy()));
        }
    }
    for entry in former {
        // A file that somebody has changed, or only named like one, is not this program's.
        let is_own = file::read(&entry.path(), MAX_FILE_BYTES)
            .is_ok_and(|bytes| entry.file_name().to_string_lossy() == name_of(&stem, &bytes));
        if is_own {
            // It may belong to somebody else.
            let _ = fs::remove_file(entry.path());
        }
    }
}

/// The name of the edits file of a preset with such a stem.
fn name_of(stem: &str, text: &[u8]) -> String {
    format!("{stem}{MIDDLE}{:0DIGITS$x}{END}", fnv1a(text))
}

fn is_edits_file_of(stem: &str, name: &str) -> bool {
    let digits = || name.strip_prefix(stem)?.strip_prefix(MIDDLE)?.strip_suffix(END);
    digits().is_some_and(|digits| digits.len() == DIGITS && digits.bytes().all(|digit| digit.is_ascii_hexdigit()))
}
