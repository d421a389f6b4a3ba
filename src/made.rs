//! What made a file, and whether it is whole: for sets of files that are made part by part, such as the strips of a
//! bake, the tiles of a tileset and the frames of a film.
//!
//! A part that is there is used again only if the same made it, its [`identity`], and if its bytes have the CRC-32 of
//! those that were written. A set whose parts have no room for that has a [`Ledger`] beside them.

use crate::planet::open::{open_file, read};
use crate::planet::{GROUND_VERSION, Key};
use crc32fast::Hasher;
use std::collections::BTreeMap;
use std::fmt::Debug;
use std::fs::{File, OpenOptions};
use std::io::{self, Read as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Longest ledger that is read: far more than a line for each of the most tiles.
const MOST_BYTES: u64 = 1 << 26;

/// Versions of the program and of all that shapes the ground. Files of a planet depend on them besides its preset and
/// what was asked for.
const VERSIONS: (&str, u32) = (env!("CARGO_PKG_VERSION"), GROUND_VERSION);

/// Identity of what makes a file: a planet, given by its key, what is asked for, and all versions.
pub(crate) fn identity(planet: Key, asked: &impl Debug) -> Key {
    Key::of(&(VERSIONS, planet, asked))
}

/// The CRC-32 of the bytes of a file. (A hasher can be joined with that of the file that follows.)
pub(crate) fn crc32_of(path: &Path) -> io::Result<Hasher> {
    let (mut file, mut hasher) = (open_file(path)?, Hasher::new());
    let mut bytes = vec![0; 1 << 16];
    loop {
        match file.read(&mut bytes)? {
            0 => return Ok(hasher),
            count => hasher.update(&bytes[..count]),
        }
    }
}

/// The list of the parts that are complete, in a text file beside them: for each a line with its identity, its CRC-32
/// and its name. A line is added when its part is complete; the last line of a name holds. Lines that a crash or
/// somebody else has broken count for nothing.
pub(crate) struct Ledger {
    path: PathBuf,
    /// The first line, which may say what the set is. Films have none.
    #[cfg_attr(not(feature = "bake"), allow(dead_code))]
    title: Option<String>,
    parts: BTreeMap<String, (Key, u32)>,
    /// The end of the file once a line was added, and whether the file must get an end of line before the next.
    end: Mutex<(Option<File>, bool)>,
}

impl Ledger {
    /// The list in a file; an empty one if there is none.
    pub(crate) fn open(path: &Path) -> io::Result<Self> {
        let bytes = match read(path, MOST_BYTES) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => Vec::new(),
            bytes => bytes?,
        };
        let text = String::from_utf8_lossy(&bytes);
        let title = text.lines().next().map(str::to_owned);
        let parts = text.lines().filter_map(part).collect();
        let is_torn = !text.is_empty() && !text.ends_with('\n');
        Ok(Self { path: path.to_owned(), title, parts, end: Mutex::new((None, is_torn)) })
    }

    /// The first line.
    #[cfg_attr(not(feature = "bake"), allow(dead_code))]
    pub(crate) fn title(&self) -> Option<&str> {
        self.title.as_deref()
    }

    /// Whether a part is there whole, and made by the same. `file`: where it is.
    pub(crate) fn has(&self, name: &str, identity: Key, file: &Path) -> bool {
        let Some((_, wanted)) = self.parts.get(name).filter(|(found, _)| *found == identity) else { return false };
        crc32_of(file).is_ok_and(|found| found.finalize() == *wanted)
    }

    /// Adds a part that is complete.
    pub(crate) fn add(&self, name: &str, identity: Key, crc32: u32) -> io::Result<()> {
        self.add_line(&format!("{:032x} {crc32:08x} {name}", identity.bits()))
    }

    /// Adds a line: the title, if it is the first.
    pub(crate) fn add_line(&self, line: &str) -> io::Result<()> {
        let mut end = self.end.lock().unwrap_or_else(PoisonError::into_inner);
        let (file, is_torn) = &mut *end;
        let file = match file {
            Some(file) => file,
            None => file.insert(OpenOptions::new().append(true).create(true).open(&self.path)?),
        };
        // In one piece, for whoever adds to the same file.
        let text = format!("{}{line}\n", if *is_torn { "\n" } else { "" });
        *is_torn = false;
        file.write_all(text.as_bytes())?;
        file.sync_data()
    }
}

/// A part by its line.
fn part(line: &str) -> Option<(String, (Key, u32))> {
    let mut words = line.splitn(3, ' ');
    let (identity, crc32, name) = (words.next()?, words.next()?, words.next()?);
    let is_long = identity.len() == 32 && crc32.len() == 8;
    let identity = Key::from_bits(u128::from_str_radix(identity, 16).ok().filter(|_| is_long)?);
    Some((name.to_owned(), (identity, u32::from_str_radix(crc32, 16).ok()?)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs;

    #[test]
    fn parts_are_there_if_they_are_whole_and_the_same_made_them() {
        let folder = tempfile::tempdir().unwrap();
        let (list, file) = (folder.path().join("list"), folder.path().join("a b.glb"));
        let key = |number: u32| identity(Key::of(&"planet"), &number);
        fs::write(&file, b"whole").unwrap();
        let crc32 = crc32_of(&file).unwrap().finalize();
        assert_eq!(crc32, crc32fast::hash(b"whole"));
        let ledger = Ledger::open(&list).unwrap();
        assert!(ledger.title().is_none() && !ledger.has("a b.glb", key(1), &file));
        ledger.add_line("title").unwrap();
        ledger.add("a b.glb", key(1), crc32).unwrap();
        let has = |number: u32| Ledger::open(&list).unwrap().has("a b.glb", key(number), &file);
        assert_eq!(Ledger::open(&list).unwrap().title(), Some("title"));
        assert!(has(1) && !has(2));
        for damaged in [&b"whoLe"[..], b"who", b"", b"whole and more"] {
            fs::write(&file, damaged).unwrap();
            assert!(!has(1));
        }
        fs::remove_file(&file).unwrap();
        assert!(!has(1));
        // A line that was cut off, and one after it; the last line of a name holds.
        fs::write(&file, b"whole").unwrap();
        let text = fs::read_to_string(&list).unwrap();
        fs::write(&list, &text[..text.len() - 12]).unwrap();
        assert!(!has(1));
        Ledger::open(&list).unwrap().add("a b.glb", key(2), crc32).unwrap();
        assert!(has(2) && !has(1));
        assert!(Ledger::open(folder.path()).is_err());
    }

    #[test]
    fn identities_tell_planets_options_and_versions_apart() {
        let planet = Key::of(&"planet");
        assert_eq!(identity(planet, &1), identity(planet, &1));
        assert_ne!(identity(planet, &1), identity(planet, &2));
        assert_ne!(identity(planet, &1), identity(Key::of(&"other"), &1));
        for versions in [("0", VERSIONS.1), (VERSIONS.0, 0)] {
            assert_ne!(Key::of(&(versions, planet, &1)), identity(planet, &1));
        }
    }
}
