//! The pictures in use, so that layers and planets share them and undo finds them again.

use super::budget::Budget;
use super::pixels::{Picture, PictureExtent};
use super::read;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::SystemTime;

/// The file that a picture was read from. Links to one file are one file.
#[derive(Clone, PartialEq)]
struct Origin {
    file: PathBuf,
    extent: PictureExtent,
    bytes: u64,
    changed: SystemTime,
}

impl Origin {
    fn of(file: &Path, extent: PictureExtent) -> Option<Self> {
        let metadata = std::fs::metadata(file).ok()?;
        let file = std::fs::canonicalize(file).ok()?;
        Some(Self { file, extent, bytes: metadata.len(), changed: metadata.modified().ok()? })
    }
}

static KNOWN: Mutex<Vec<(Origin, Weak<Picture>)>> = Mutex::new(Vec::new());

/// See [`super::PictureKey::load`].
pub(super) fn load(file: &Path, extent: PictureExtent, budget: &mut Budget) -> Result<Arc<Picture>, String> {
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let too_much = |problem: String| format!("{} {problem}", file.display());
    let origin = Origin::of(file, extent);
    let same = |(other, _): &&(Origin, Weak<Picture>)| Some(other) == origin.as_ref();
    let shared = known().iter().find(same).and_then(|(_, picture)| picture.upgrade());
    if let Some(picture) = shared {
        budget.keep(&picture).map_err(too_much)?;
        return Ok(picture);
    }
    let read = read::read(file, extent, budget)?;
    let mut known = known();
    known.retain(|(_, picture)| picture.strong_count() > 0);
    // A copy of a file is the same picture: its pixels are kept once.
    let twin = known.iter().filter_map(|(_, picture)| picture.upgrade()).find(|picture| **picture == read);
    let picture = twin.unwrap_or_else(|| Arc::new(read));
    if let Some(origin) = origin {
        known.retain(|(other, _)| other.file != origin.file || other.extent != origin.extent);
        known.push((origin, Arc::downgrade(&picture)));
    }
    drop(known);
    budget.give_back(picture.bytes);
    budget.keep(&picture).map_err(too_much)?;
    Ok(picture)
}
