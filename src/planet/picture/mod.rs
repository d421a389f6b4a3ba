//! Pictures that a preset refers to: the reference in the file, and the pixels.
//!
//! - `pixels`: the pixels and how they cover the sphere
//! - `known`: pictures in use, so that none is read twice
//! - `read`: opens the file; `from_png`, `from_exr`: decoders; `canvas`: where decoded rows or blocks are put;
//!   `contain`: panics of decoders as errors
//! - `budget`: memory and work limits of all pictures of a planet
//! - `place`: paths, relative to the folder of a preset
//!
//! A planet carries its pixels with it, shared and never saved, so that its evaluator needs no file.
//! [`Planet::load`](super::Planet::load) reads them. A layer whose pixels are missing is flat, and a stamp leaves the
//! ground as it is.

mod budget;
mod canvas;
mod contain;
mod from_exr;
mod from_png;
mod known;
mod pixels;
mod place;
mod read;

pub use budget::{Budget, MAX_BYTES, MAX_PIXELS, MAX_WORK_BYTES};
pub use contain::is_contained;
pub use pixels::{Picture, PictureExtent, PictureLayout};

use super::open::followed;
use super::param::{ParamValue, ValueMut, ValueRef};
use serde::{Deserialize, Serialize};
use std::path::{Path, PathBuf};
use std::sync::Arc;

/// The source of a picture: a file, and what it covers.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PictureKey {
    /// Where the file is.
    pub file: PathBuf,
    /// What it covers.
    pub extent: PictureExtent,
}

impl PictureKey {
    /// Reads the picture, or shares the picture in use if its file has not changed. Its size is taken from the budget
    /// of the planet.
    ///
    /// # Errors
    /// What is wrong with the file, and what would be right.
    pub fn load(&self, budget: &mut Budget) -> Result<Arc<Picture>, String> {
        known::load(&self.file, self.extent, budget)
    }

    /// Reads the picture from the bytes of a PNG or OpenEXR file, such as an entry of an asset pack. Its size is taken
    /// from the budget of the planet.
    ///
    /// # Errors
    /// What is wrong with the bytes, and what would be right.
    pub fn decode(&self, bytes: &[u8], budget: &mut Budget) -> Result<Arc<Picture>, String> {
        let decoded = read::read_bytes(bytes, self.extent, budget);
        decoded.map(Arc::new).map_err(|problem| format!("{} {problem}", self.file.display()))
    }
}

/// A reference to a picture. A preset holds only the path.
#[derive(Clone, Debug, Default, Serialize, Deserialize)]
#[serde(from = "String", into = "String")]
pub struct PictureFile {
    path: String,
    /// The folder to which a relative path is relative.
    folder: Option<Arc<Path>>,
    loaded: Option<(PictureKey, Arc<Picture>)>,
}

impl From<String> for PictureFile {
    fn from(path: String) -> Self {
        Self { path, ..Self::default() }
    }
}

impl From<PictureFile> for String {
    fn from(file: PictureFile) -> Self {
        file.path
    }
}

/// Equal references lead to the same file and have the same pixels, however the path is written.
impl PartialEq for PictureFile {
    fn eq(&self, other: &Self) -> bool {
        let place = |file: &Self| file.location().map(|path| place::tidy(&path));
        let same_place = match (place(self), place(other)) {
            (None, None) => self.path == other.path,
            (a, b) => a == b,
        };
        same_place && self.current() == other.current()
    }
}

impl ParamValue for PictureFile {
    fn value_mut(&mut self) -> ValueMut<'_> {
        ValueMut::Text(&mut self.path)
    }

    fn value_ref(&self) -> ValueRef<'_> {
        ValueRef::Text(&self.path)
    }
}

impl PictureFile {
    /// The path as it is written.
    pub fn path(&self) -> &str {
        &self.path
    }

    /// Where the file is. None without a path, or with a relative path before the planet has a folder.
    pub fn location(&self) -> Option<PathBuf> {
        let path = Path::new(&self.path);
        match &self.folder {
            _ if self.path.is_empty() => None,
            Some(folder) => Some(folder.join(path)),
            None => path.is_absolute().then(|| path.to_owned()),
        }
    }

    /// The source of the pixels that cover this.
    pub fn key(&self, extent: impl Into<PictureExtent>) -> Option<PictureKey> {
        Some(PictureKey { file: self.location()?, extent: extent.into() })
    }

    /// The pixels that cover this, if they are loaded.
    pub fn picture(&self, extent: impl Into<PictureExtent>) -> Option<&Arc<Picture>> {
        let extent = extent.into();
        self.current().filter(|(key, _)| key.extent == extent).map(|(_, picture)| picture)
    }

    /// The loaded pixels, unless the path has changed since.
    fn current(&self) -> Option<&(PictureKey, Arc<Picture>)> {
        self.loaded.as_ref().filter(|(key, _)| self.location().as_ref() == Some(&key.file))
    }

    /// Whether its relative paths are relative to something.
    pub(super) fn has_folder(&self) -> bool {
        self.folder.is_some()
    }

    /// A relative path without a folder becomes relative to this one.
    pub(super) fn set_folder(&mut self, folder: &Path) {
        self.folder.get_or_insert_with(|| folder.into());
    }

    /// Takes over pixels that were read from their source.
    pub(super) fn give(&mut self, key: &PictureKey, picture: &Arc<Picture>) {
        self.loaded = Some((key.clone(), picture.clone()));
    }

    /// Takes over pixels from another reference to the same file, if one has them.
    #[cfg(feature = "editor")]
    pub(crate) fn share<'a>(&mut self, others: impl Iterator<Item = &'a PictureFile>) {
        let place = self.location();
        let loaded = others.filter_map(PictureFile::current);
        if let Some(loaded) = loaded.filter(|(key, _)| Some(&key.file) == place.as_ref()).last() {
            self.loaded = Some(loaded.clone());
        }
    }

    /// Rewrites the path for a preset in this folder.
    pub(super) fn move_to(&mut self, folder: &Path) {
        let Some(old) = self.location() else { return };
        if self.folder.as_deref() == Some(folder) && Path::new(&self.path).is_relative() {
            return;
        }
        let moved = Self { path: place::written_from(&old, folder), folder: Some(folder.into()), loaded: None };
        let loaded = self.current().cloned();
        *self = moved;
        if let (Some((key, picture)), Some(file)) = (loaded, self.location()) {
            self.loaded = Some((PictureKey { file, ..key }, picture));
        }
    }
}

/// The folder of a preset or a system file, where all that it names begins: pictures, edits, presets. Of a link, the
/// folder of the file to which it leads, which is also the file that a save replaces.
pub(crate) fn folder_of(file: &Path) -> PathBuf {
    let file = followed(file);
    let whole = std::path::absolute(&file).unwrap_or(file);
    whole.parent().map_or_else(PathBuf::new, Path::to_owned)
}
