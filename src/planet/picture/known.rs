//! The pictures that are in use somewhere, so that layers and planets share them and undo finds them again.

use super::budget::Budget;
use super::{Picture, PictureKey, PictureLayout, read};
use std::path::PathBuf;
use std::sync::{Arc, Mutex, PoisonError, Weak};
use std::time::SystemTime;

/// What a picture was read from: links to one file are one file.
#[derive(Clone, PartialEq)]
struct Origin {
    file: PathBuf,
    layout: PictureLayout,
    bytes: u64,
    changed: SystemTime,
}

impl Origin {
    fn of(key: &PictureKey) -> Option<Self> {
        let metadata = std::fs::metadata(&key.file).ok()?;
        let file = std::fs::canonicalize(&key.file).ok()?;
        Some(Self { file, layout: key.layout, bytes: metadata.len(), changed: metadata.modified().ok()? })
    }
}

static KNOWN: Mutex<Vec<(Origin, Weak<Picture>)>> = Mutex::new(Vec::new());

/// See [`PictureKey::load`].
pub(super) fn load(key: &PictureKey, budget: &mut Budget) -> Result<Arc<Picture>, String> {
    let known = || KNOWN.lock().unwrap_or_else(PoisonError::into_inner);
    let too_much = |problem: String| format!("{} {problem}", key.file.display());
    let origin = Origin::of(key);
    let same = |(other, _): &&(Origin, Weak<Picture>)| Some(other) == origin.as_ref();
    let shared = known().iter().find(same).and_then(|(_, picture)| picture.upgrade());
    if let Some(picture) = shared {
        budget.keep(&picture).map_err(too_much)?;
        return Ok(picture);
    }
    let read = read::read(&key.file, key.layout, budget)?;
    let mut known = known();
    known.retain(|(_, picture)| picture.strong_count() > 0);
    // A copy of a file is the same picture, too: its pixels are kept once.
    let twin = known.iter().filter_map(|(_, picture)| picture.upgrade()).find(|picture| **picture == read);
    let picture = twin.unwrap_or_else(|| Arc::new(read));
    if let Some(origin) = origin {
        known.retain(|(other, _)| other.file != origin.file || other.layout != origin.layout);
        known.push((origin, Arc::downgrade(&picture)));
    }
    drop(known);
    budget.give_back(picture.bytes);
    budget.keep(&picture).map_err(too_much)?;
    Ok(picture)
}
