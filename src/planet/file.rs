//! Loading and saving a preset, and the errors of both.

use super::locate::Place;
use super::param::ParamPath;
use super::picture::folder_of;
use super::problem::Problem;
use super::root::Root;
use super::{Planet, beside, explain, locate, migrate, text, validate};
use std::collections::HashMap;
use std::io;
use std::path::{Path, PathBuf};

pub(crate) use super::open::read;
#[cfg(feature = "bake")]
pub(crate) use super::output::{Staged, stage, write_atomically_with};
pub(crate) use super::output::{Target, write_atomically};

/// Longest preset that is read, in bytes: more than that of one with every list at its limit.
pub const MAX_FILE_BYTES: u64 = 48 << 20;

/// A preset that could not be loaded.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum LoadError {
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: io::Error,
    },
    /// The text is not a valid preset. Displays one line per problem: `file:line:column: path: message`.
    #[error("{}", lines(file, problems))]
    Invalid {
        /// The file, or a name for the text.
        file: String,
        /// All problems.
        problems: Vec<Problem>,
    },
}

fn lines(file: &str, problems: &[Problem]) -> String {
    let gap = |problem: &Problem| if problem.line > 0 { "" } else { " " };
    problems.iter().map(|p| format!("{file}:{}{p}", gap(p))).collect::<Vec<_>>().join("\n")
}

/// A preset that could not be saved.
#[derive(Debug, thiserror::Error)]
#[error("{}: {message}", path.display())]
#[non_exhaustive]
pub struct SaveError {
    /// The file.
    pub path: PathBuf,
    /// Why, and what to do.
    pub message: String,
}

impl Planet {
    /// Reads and checks a preset and the files it refers to. A texture set that cannot be read is a warning in the log.
    pub fn load(path: impl AsRef<Path>) -> Result<Planet, LoadError> {
        Self::load_with_text(path.as_ref()).map(|(planet, _)| planet)
    }

    /// As [`Planet::load`], with the text of the preset.
    pub(crate) fn load_with_text(path: &Path) -> Result<(Planet, String), LoadError> {
        let (file, text) = (path.display().to_string(), read_text(path)?);
        let planet = Self::placed(&file, &text, &mut beside::in_folder_of(path), |planet| {
            planet.set_folder(&folder_of(path));
            planet.load_pictures()
        })?;
        Ok((planet, text))
    }

    /// Reads and checks a preset without its pictures: their layers are flat until [`Planet::load_pictures`].
    pub fn open(path: impl AsRef<Path>) -> Result<Planet, LoadError> {
        let path = path.as_ref();
        Self::from_text_of(path, &read_text(path)?)
    }

    /// As [`Planet::open`], of a preset whose text has been read.
    pub(crate) fn from_text_of(path: &Path, text: &str) -> Result<Planet, LoadError> {
        Self::placed(&path.display().to_string(), text, &mut beside::in_folder_of(path), |planet| {
            planet.set_folder(&folder_of(path));
            Vec::new()
        })
    }

    /// Reads and checks a preset from text, without its pictures; `file` names it in messages. A preset whose edits are
    /// in a file beside it is refused: see [`Planet::from_pack`].
    pub fn from_text(file: &str, text: &str) -> Result<Planet, LoadError> {
        Self::placed(file, text, &mut beside::nowhere, |_| Vec::new())
    }

    /// Reads and checks a preset from text, and its files from memory: of an asset pack, say. `fetch` gives the bytes
    /// of the file at a path, as it is written in the preset, or says why it cannot: those of PNG or OpenEXR pictures,
    /// those that a texture set may have ([`Planet::load_pictures_from`]), and those of the edits if they are in a file
    /// beside the preset.
    ///
    /// ```
    /// use tellus::planet::Planet;
    ///
    /// let preset = std::fs::read_to_string("planets/pallor.ron")?; // of the pack
    /// let planet = Planet::from_pack("pallor.ron", &preset, |path| Err(format!("{} is not packed", path.display())))?;
    /// assert_eq!(planet.name, "Pallor"); // which has no pictures
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn from_pack(
        file: &str,
        text: &str,
        fetch: impl FnMut(&Path) -> Result<Vec<u8>, String>,
    ) -> Result<Planet, LoadError> {
        let fetch = std::cell::RefCell::new(fetch);
        let mut edits = |name: &str| {
            let bytes = fetch.borrow_mut()(Path::new(name))?;
            String::from_utf8(bytes).map_err(|_| format!("{name}: the text is not UTF-8; save it as UTF-8"))
        };
        Self::placed(file, text, &mut edits, |planet| planet.load_pictures_from(|path| fetch.borrow_mut()(path)))
    }

    /// Reads and checks a preset, then what belongs to it. `complete` gives problems, which get their places.
    fn placed(
        file: &str,
        text: &str,
        fetch: &mut beside::Fetch<'_>,
        complete: impl FnOnce(&mut Planet) -> Vec<(ParamPath, String)>,
    ) -> Result<Planet, LoadError> {
        let (mut planet, edits) = beside::parsed(file, text, fetch)?;
        beside::checked(file, text, &planet, edits.as_ref())?;
        let problems = complete(&mut planet);
        // Without its textures a biome still has a pattern, and all heights are right.
        let [textures, problems] = planet.harmless_problems(problems);
        if !textures.is_empty() {
            log::warn!("{}", beside::placed(file, text, edits.as_ref(), textures));
        }
        if problems.is_empty() { Ok(planet) } else { Err(beside::placed(file, text, edits.as_ref(), problems)) }
    }

    /// The text of the preset, with comments. Stable: the text of a loaded text is the text.
    pub fn to_text(&self) -> String {
        text::write(self)
    }

    /// Saves atomically: the old file stays until the new one is complete. Paths of pictures are rewritten relative to
    /// the new file. A planet that could not be loaded again is refused.
    ///
    /// A list of edits longer than a MiB goes to a file beside the preset, which names it.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        self.save_text(path.as_ref()).map(drop)
    }

    /// As [`Planet::save`]. Gives the text of the preset.
    pub(crate) fn save_text(&self, path: &Path) -> Result<String, SaveError> {
        let planet = self.to_save(path)?;
        let failed = |message: String| SaveError { path: path.to_owned(), message };
        let target = Target::checked(path).map_err(failed)?;
        let beside::Texts { preset, edits } = beside::texts(&planet, &target.path);
        if let Some((name, text)) = &edits {
            check_length(text).and_then(|()| beside::write(&target.folder, name, text)).map_err(failed)?;
        }
        write_preset(path, &preset)?;
        beside::sweep(&target.folder, &target.path);
        Ok(preset)
    }

    /// As [`Planet::save`], with all edits in the preset, however many there are.
    pub fn save_in_one(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let path = path.as_ref();
        write_preset(path, &self.to_save(path)?.to_text())
    }

    /// The planet as a preset of this path holds it.
    fn to_save(&self, path: &Path) -> Result<Planet, SaveError> {
        let planet = self.moved_to(&folder_of(path));
        match validate::problems(&planet).into_iter().next() {
            None => Ok(planet),
            Some((place, message)) => Err(SaveError {
                path: path.to_owned(),
                message: format!("the planet is not valid and was not saved: {place}: {message}"),
            }),
        }
    }
}

fn write_preset(path: &Path, text: &str) -> Result<(), SaveError> {
    let failed = |message: String| SaveError { path: path.to_owned(), message };
    check_length(text).and_then(|()| write_atomically(path, text.as_bytes())).map_err(failed)
}

/// Whether a text can be read again.
fn check_length(text: &str) -> Result<(), String> {
    if text.len() as u64 <= MAX_FILE_BYTES {
        return Ok(());
    }
    let most = MAX_FILE_BYTES >> 20;
    Err(format!("the preset would be longer than {most} MiB and was not saved; bake edits into a picture"))
}

/// Parses the text of a preset that lists its edits. Its values may be invalid: see [`checked`].
pub(super) fn parsed(file: &str, text: &str) -> Result<Planet, LoadError> {
    beside::parsed(file, text, &mut beside::nowhere).map(|(planet, _)| planet)
}

/// As [`parsed`], of a text that is known to list its edits.
pub(super) fn parsed_alone(file: &str, text: &str) -> Result<Planet, LoadError> {
    let mut planet = read_as::<Planet>(file, text, migrate::read)?;
    planet.biomes.forget_idle_keys();
    Ok(planet)
}

/// Parses a text with the reader of its version.
pub(crate) fn read_as<R: Root>(
    file: &str,
    text: &str,
    read: impl FnOnce(u32, &str) -> Result<R, Problem>,
) -> Result<R, LoadError> {
    let invalid = |problem| LoadError::Invalid { file: file.to_owned(), problems: vec![problem] };
    let text = without_mark(text);
    if text.len() as u64 > MAX_FILE_BYTES {
        let message = format!("the text is longer than {} KiB; a {} is much shorter", MAX_FILE_BYTES >> 10, R::NOUN);
        return Err(invalid(Problem { line: 0, column: 0, path: String::new(), message }));
    }
    if let Some((field, message)) = R::other(text) {
        let place = locate::find(text, field).map_or(0, |place| place.key);
        return Err(invalid(explain::at(text, place, message)));
    }
    version::<R>(text).and_then(|version| read(version, text)).map_err(invalid)
}

/// Checks a planet that was parsed from a text.
pub(super) fn checked(file: &str, text: &str, planet: &Planet) -> Result<(), LoadError> {
    beside::checked(file, text, planet, None)
}

/// The text of a file that should be a preset.
pub(crate) fn read_text(path: &Path) -> Result<String, LoadError> {
    let file = path.display().to_string();
    let invalid = |problem: Problem| LoadError::Invalid { file, problems: vec![problem] };
    let bytes = read(path, MAX_FILE_BYTES).map_err(|source| LoadError::Read { path: path.to_owned(), source })?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        let message = format!("the file is longer than {} KiB; a preset is much shorter", MAX_FILE_BYTES >> 10);
        return Err(invalid(Problem { line: 0, column: 0, path: String::new(), message }));
    }
    String::from_utf8(bytes).map_err(|error| {
        let readable = String::from_utf8_lossy(&error.as_bytes()[..error.utf8_error().valid_up_to()]);
        let message = "the text is not UTF-8 from here on; save it as UTF-8";
        invalid(explain::at(&readable, readable.len(), message))
    })
}

/// Some editors put a byte-order mark in front.
fn without_mark(text: &str) -> &str {
    text.strip_prefix('\u{feff}').unwrap_or(text)
}

/// The version of a text. It is found without parsing the rest, which a newer version may write differently.
fn version<R: Root>(text: &str) -> Result<u32, Problem> {
    let (field, now) = ("version", R::VERSION);
    let Some(place) = locate::find(text, field) else {
        // For a text that is no preset at all, the parser's message is better than "the version is missing".
        let problem = match explain::parse::<R, R::File>(text) {
            Err(problem) if problem.path.is_empty() && !problem.message.starts_with("there is no field") => problem,
            _ => Problem { path: field.to_owned(), ..explain::at(text, start(text), missing_version::<R>()) },
        };
        return Err(problem);
    };
    let problem = |message| Problem { path: field.to_owned(), ..explain::at(text, place.value, message) };
    let digits: String =
        text[place.value..].chars().take_while(|c| c.is_alphanumeric() || "._-+\"'".contains(*c)).collect();
    if digits.is_empty() || !digits.bytes().all(|b| b.is_ascii_digit()) {
        let found = locate::excerpt(text, place.value);
        return Err(problem(format!("{found} is not a version; use a whole number, now {now}")));
    }
    match digits.parse() {
        Ok(0) => Err(problem(format!("there is no version 0; use {now}"))),
        Ok(version) if version <= now => Ok(version),
        _ => Err(problem(format!(
            "this {} has version {digits} and was made by a newer Tellus; this one reads up to version {now}: update it",
            R::NOUN
        ))),
    }
}

fn missing_version<R: Root>() -> String {
    format!("the version is missing; write `version: {}` as the first field", R::VERSION)
}

fn start(text: &str) -> usize {
    locate::find(text, "").map_or(0, |place| place.value)
}

/// Adds to the problems of parameters their locations in the text, and sorts them by location.
pub(crate) fn all_placed(file: &str, text: &str, problems: Vec<(ParamPath, String)>) -> LoadError {
    let text = without_mark(text);
    let places = locate::all(text);
    let placed = |(path, message): (ParamPath, String)| placed(text, &places, path.to_string(), message);
    let mut problems: Vec<Problem> = problems.into_iter().map(placed).collect();
    problems.sort_by_key(|problem| (problem.line, problem.column));
    LoadError::Invalid { file: file.to_owned(), problems }
}

/// A problem of a parameter, located at its value or at the nearest enclosing value in the text.
fn placed(text: &str, places: &HashMap<String, Place>, path: String, message: String) -> Problem {
    let mut holder = path.as_str();
    loop {
        if let Some(place) = places.get(holder) {
            return Problem { path, ..explain::at(text, place.value, message) };
        }
        match holder.rfind(['.', '[']) {
            Some(end) => holder = &holder[..end],
            None if holder.is_empty() => return Problem { line: 1, column: 1, path, message },
            None => holder = "",
        }
    }
}
