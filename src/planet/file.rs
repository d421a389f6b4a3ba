//! Loading and saving a preset, and the errors of both.

use super::locate::Place;
use super::open::{Opened, open};
use super::param::ParamPath;
use super::picture::folder_of;
use super::problem::Problem;
use super::root::Root;
use super::{Planet, beside, explain, locate, migrate, text, validate};
use std::collections::{BTreeSet, HashMap};
use std::fs::{File, Permissions};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

/// Longest preset that is read, in bytes: more than that of one with every list at its limit.
pub const MAX_FILE_BYTES: u64 = 48 << 20;

/// How names of unfinished files begin and end.
const UNFINISHED: &str = ".tellus-";
const UNFINISHED_END: &str = ".tmp";
/// Age from which an unfinished file is one that a killed writer left.
const ABANDONED: Duration = Duration::from_secs(3600);
/// Most links from a path to a file.
const MOST_LINKS: usize = 40;

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
    /// Reads and checks a preset and the pictures it refers to.
    pub fn load(path: impl AsRef<Path>) -> Result<Planet, LoadError> {
        let path = path.as_ref();
        let (file, text) = (path.display().to_string(), read_text(path)?);
        Self::placed(&file, &text, &mut beside::in_folder_of(path), |planet| {
            planet.set_folder(&folder_of(path));
            planet.load_pictures()
        })
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
    /// and those of the edits if they are in a file beside the preset.
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

/// The bytes of a file: all of them, or `most` and one more of a longer file.
pub(crate) fn read(path: &Path, most: u64) -> io::Result<Vec<u8>> {
    let mut bytes = Vec::new();
    open_file(path)?.take(most + 1).read_to_end(&mut bytes)?;
    Ok(bytes)
}

/// Opens a file for reading, and nothing else.
pub(crate) fn open_file(path: &Path) -> io::Result<File> {
    match open(path)? {
        Opened::File(file) => Ok(file),
        Opened::Folder => Err(io::Error::new(io::ErrorKind::IsADirectory, "is a folder; name a file")),
        Opened::Special => {
            Err(io::Error::new(io::ErrorKind::InvalidInput, "is a device or a pipe, not a file; name a file"))
        }
    }
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

/// Writes a file beside the target, syncs it to disk, then renames it to the target: a reader finds the old file or the
/// new one, never a part of either, whatever fails in between.
pub(crate) fn write_atomically(path: &Path, bytes: &[u8]) -> Result<(), String> {
    write_atomically_with(path, None, &mut |file| file.write_all(bytes))
}

/// As [`write_atomically`], for a file that is written piece by piece. `beside`: the folder for the unfinished file, on
/// the disk of the target; the folder of the target unless one is given.
pub(crate) fn write_atomically_with(
    path: &Path,
    beside: Option<&Path>,
    write: &mut dyn FnMut(&mut File) -> io::Result<()>,
) -> Result<(), String> {
    stage(path, beside, write)?.commit()
}

/// A file that is complete and on the disk, but not in its place yet. Files of a set are staged first and then
/// committed together: a disk that is full changes none of them. Dropped, it is removed.
pub(crate) struct Staged {
    unfinished: tempfile::TempPath,
    target: PathBuf,
    folder: PathBuf,
}

/// The first part of [`write_atomically_with`]: all of it but the rename.
pub(crate) fn stage(
    path: &Path,
    beside: Option<&Path>,
    write: &mut dyn FnMut(&mut File) -> io::Result<()>,
) -> Result<Staged, String> {
    let Target { path: target, folder, permissions } = Target::checked(path)?;
    let unfinished = beside.unwrap_or(&folder);
    sweep(unfinished);
    let mut builder = tempfile::Builder::new();
    builder.prefix(UNFINISHED).suffix(UNFINISHED_END);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(0o666));
    let mut file = builder
        .tempfile_in(unfinished)
        .map_err(|e| failed(&format!("cannot write to the folder {}", unfinished.display()), &e))?;
    write(file.as_file_mut()).map_err(|e| failed("cannot write", &e))?;
    if let Some(permissions) = permissions {
        // Not every file system has permissions.
        let _ = file.as_file().set_permissions(permissions);
    }
    file.as_file().sync_all().map_err(|e| failed("cannot write", &e))?;
    Ok(Staged { unfinished: file.into_temp_path(), target, folder })
}

impl Staged {
    /// Where its bytes are until it is committed.
    #[cfg(feature = "bake")]
    pub(crate) fn unfinished(&self) -> &Path {
        &self.unfinished
    }

    /// Moves it to its place.
    pub(crate) fn commit(self) -> Result<(), String> {
        let Self { unfinished, target, folder } = self;
        unfinished.persist(target).map_err(|e| failed("cannot replace the file", &e.error))?;
        // The rename must reach the disk, too. Not every system can open folders, and the file is complete already.
        #[cfg(unix)]
        if let Ok(folder) = File::open(folder) {
            let _ = folder.sync_all();
        }
        Ok(())
    }
}

fn failed(what: &str, error: &io::Error) -> String {
    format!("{what}: {error}; the old file is as it was")
}

/// Where a link leads whose target is missing; the path itself if it is no link.
fn followed(path: &Path) -> PathBuf {
    let mut path = path.to_owned();
    // More links than this are a circle, which the system refuses.
    for _ in 0..MOST_LINKS {
        let Ok(target) = std::fs::read_link(&path) else { break };
        path = path.parent().map_or_else(|| target.clone(), |folder| folder.join(&target));
    }
    path
}

/// Removes the unfinished files that killed writers left in a folder; each process looks once. A writer that is at work
/// has touched its file lately.
fn sweep(folder: &Path) {
    static SWEPT: Mutex<BTreeSet<PathBuf>> = Mutex::new(BTreeSet::new());
    if !SWEPT.lock().unwrap_or_else(PoisonError::into_inner).insert(folder.to_owned()) {
        return;
    }
    for entry in std::fs::read_dir(folder).into_iter().flatten().flatten() {
        let name = entry.file_name();
        let name = name.to_string_lossy();
        let age = || entry.metadata().ok()?.modified().ok()?.elapsed().ok();
        if name.starts_with(UNFINISHED) && name.ends_with(UNFINISHED_END) && age().is_some_and(|age| age > ABANDONED) {
            // It may belong to somebody else.
            let _ = std::fs::remove_file(entry.path());
        }
    }
}

/// A place where a file can be written.
pub(crate) struct Target {
    path: PathBuf,
    folder: PathBuf,
    /// Those of the file that is there already.
    permissions: Option<Permissions>,
}

impl Target {
    /// Checks that a file can be written or replaced here, as far as that is known before.
    pub(crate) fn checked(path: &Path) -> Result<Self, String> {
        // A link stays a link; its target is replaced, or made.
        let target = std::fs::canonicalize(path).unwrap_or_else(|_| followed(path));
        if std::fs::symlink_metadata(&target).is_ok_and(|metadata| metadata.is_symlink()) {
            return Err("is a link that leads around in a circle; name a file".to_owned());
        }
        let folder = match target.parent() {
            Some(folder) if !folder.as_os_str().is_empty() => folder,
            _ => Path::new("."),
        };
        if !folder.is_dir() {
            return Err(format!("there is no folder {}; make it first or save elsewhere", folder.display()));
        }
        if target.is_dir() {
            return Err("is a folder; name a file in it".to_owned());
        }
        if path.file_name().is_none() {
            return Err("is not a file's name; name a file".to_owned());
        }
        if std::fs::metadata(path).is_ok_and(|metadata| !metadata.is_file()) {
            return Err("is a device or a pipe, not a file; name a file".to_owned());
        }
        let permissions = std::fs::metadata(&target).ok().map(|metadata| metadata.permissions());
        if permissions.as_ref().is_some_and(Permissions::readonly) {
            return Err("is read-only; change its permissions or save elsewhere".to_owned());
        }
        Ok(Self { folder: folder.to_owned(), path: target, permissions })
    }
}
