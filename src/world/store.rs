//! World maps on disk: solved once, read by every later process.
//!
//! Each file holds one map at its finest level. Its name is the map, the side of its grid and the key of everything
//! that it was solved from, so a file is never out of date, only unused. A file that is damaged, or of another
//! version, counts as missing. Files of other programs that happen to be in the folder stay as they are.
//!
//! Format, little-endian: `MAGIC`, [`GROUND_VERSION`], the key (16 bytes), a checksum (8 bytes), the content.

use super::bytes::{Reader, Writer};
use super::map::{Inputs, WorldMap};
use crate::planet::GROUND_VERSION;
use crate::planet::Key;
use crate::planet::open::{open_file, read_whole};
use crate::planet::output::{check_address, write_over_links};
use std::fs;
use std::io::Read as _;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};
use std::time::SystemTime;

const MAGIC: [u8; 8] = *b"TELLUSWM";
const HEADER: usize = MAGIC.len() + 4 + 16 + 8;
const EXTENSION: &str = "map";
/// Longest file that is read: the largest map has less than 100 MiB.
const MOST_BYTES: u64 = 256 << 20;

/// A folder of solved world maps. Share one between all terrains and builders of a process.
#[derive(Debug)]
pub struct MapStore {
    folder: PathBuf,
    /// None: the folder is only read.
    limit_bytes: Option<u64>,
    problem: Mutex<Option<String>>,
}

impl MapStore {
    /// A folder that keeps maps from one process to the next. It is made when the first map is written. When the maps
    /// in it exceed `limit_bytes`, those that were not used for longest are deleted; the newest map always stays.
    pub fn new(folder: impl Into<PathBuf>, limit_bytes: u64) -> Self {
        Self { folder: folder.into(), limit_bytes: Some(limit_bytes), problem: Mutex::default() }
    }

    /// A folder that is only read: maps that a game ships beside its presets.
    pub fn read_only(folder: impl Into<PathBuf>) -> Self {
        Self { folder: folder.into(), limit_bytes: None, problem: Mutex::default() }
    }

    /// The folder.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// The newest reason why a map could not be written, told once. Maps that cannot be written are solved again by
    /// the next process; nothing else is lost.
    pub fn take_problem(&self) -> Option<String> {
        self.problem.lock().unwrap_or_else(PoisonError::into_inner).take()
    }

    fn path(&self, name: &str, side: usize, key: Key) -> PathBuf {
        self.folder.join(format!("{name}_{side}_{:032x}.{EXTENSION}", key.bits()))
    }

    /// Whether there is a file for the map of a key.
    pub(super) fn has<M: WorldMap>(&self, side: usize, key: Key) -> bool {
        self.path(M::NAME, side, key).is_file()
    }

    /// The map of a key, if it is there and whole.
    pub(super) fn read<M: WorldMap>(&self, inputs: &Inputs, side: usize, key: Key) -> Option<M> {
        profiling::scope!("read a world map");
        let path = self.path(M::NAME, side, key);
        let bytes = read_whole(&path, MOST_BYTES).ok()?;
        let content = content(&bytes, key)?;
        let mut reader = Reader(content);
        let map = M::read(inputs, side, &mut reader).filter(|_| reader.is_at_end())?;
        if self.limit_bytes.is_some() {
            // Keeps it from being the one that is deleted. Not every file system has times.
            let _ = open_file(&path).and_then(|file| file.set_modified(SystemTime::now()));
        }
        Some(map)
    }

    /// Writes a map, unless the folder is only read.
    pub(super) fn write<M: WorldMap>(&self, map: &M, side: usize, key: Key) {
        profiling::scope!("write a world map");
        let Some(limit_bytes) = self.limit_bytes else { return };
        let mut writer = Writer(vec![0; HEADER]);
        map.write(&mut writer);
        let bytes = with_header(writer.0, key);
        let written = check_address(&self.folder)
            .and_then(|()| fs::create_dir_all(&self.folder).map_err(|error| format!("cannot make the folder: {error}")))
            .and_then(|()| write_over_links(&self.path(M::NAME, side, key), &bytes));
        match written {
            Ok(()) => self.trim(limit_bytes),
            Err(error) => {
                let message = format!("{}: {error}; world maps will be solved again", self.folder.display());
                *self.problem.lock().unwrap_or_else(PoisonError::into_inner) = Some(message);
            }
        }
    }

    /// Deletes the maps that were not used for longest, until the others take no more than the limit.
    fn trim(&self, limit_bytes: u64) {
        let Ok(entries) = fs::read_dir(&self.folder) else { return };
        let maps = entries.flatten().filter(|entry| is_own_name(&entry.file_name().to_string_lossy()));
        let mut maps: Vec<_> = maps
            .filter_map(|entry| {
                // Of a link this is the link.
                let metadata = entry.metadata().ok().filter(fs::Metadata::is_file)?;
                let path = entry.path();
                has_own_head(&path).then_some((metadata.modified().ok()?, metadata.len(), path))
            })
            .collect();
        maps.sort_by(|a, b| b.cmp(a));
        let mut sum_bytes = 0;
        for (number, (_, bytes, path)) in maps.iter().enumerate() {
            sum_bytes += bytes;
            if number > 0 && sum_bytes > limit_bytes {
                // Another process may have been faster.
                let _ = fs::remove_file(path);
            }
        }
    }
}

/// Whether a name is one that [`MapStore::path`] gives.
fn is_own_name(name: &str) -> bool {
    let mut parts = name.strip_suffix(EXTENSION).and_then(|stem| stem.strip_suffix('.')).unwrap_or_default().split('_');
    let is = |part: Option<&str>, is_right: fn(u8) -> bool| {
        part.is_some_and(|part| !part.is_empty() && part.bytes().all(is_right))
    };
    let is_hex = |c: u8| c.is_ascii_digit() || (b'a'..=b'f').contains(&c);
    let (map, side, key) = (parts.next(), parts.next(), parts.next());
    is(map, |c| c.is_ascii_lowercase())
        && is(side, |c| c.is_ascii_digit())
        && key.is_some_and(|key| key.len() == 32)
        && is(key, is_hex)
        && parts.next().is_none()
}

/// Whether a file begins as a map does, of whatever version.
fn has_own_head(path: &Path) -> bool {
    let mut head = [0; MAGIC.len()];
    open_file(path).and_then(|mut file| file.read_exact(&mut head)).is_ok_and(|()| head == MAGIC)
}

/// Fills in the header before the content.
fn with_header(mut bytes: Vec<u8>, key: Key) -> Vec<u8> {
    let (head, content) = bytes.split_at_mut(HEADER);
    let fields =
        [&MAGIC[..], &GROUND_VERSION.to_le_bytes(), &key.bits().to_le_bytes(), &checksum(content).to_le_bytes()];
    head.copy_from_slice(&fields.concat());
    bytes
}

/// The content of a file of a key, if it is whole.
fn content(bytes: &[u8], key: Key) -> Option<&[u8]> {
    let (head, content) = bytes.split_at_checked(HEADER)?;
    let fields =
        [&MAGIC[..], &GROUND_VERSION.to_le_bytes(), &key.bits().to_le_bytes(), &checksum(content).to_le_bytes()];
    (head == fields.concat()).then_some(content)
}

/// FNV-1a over words of eight bytes, and the bytes after the last whole word.
fn checksum(bytes: &[u8]) -> u64 {
    let (words, rest) = bytes.as_chunks();
    let words = words.iter().map(|word| u64::from_le_bytes(*word)).chain(rest.iter().map(|byte| u64::from(*byte)));
    words.fold(0xcbf2_9ce4_8422_2325, |hash: u64, word| (hash ^ word).wrapping_mul(0x0100_0000_01b3).rotate_left(23))
}

#[cfg(test)]
mod tests;
