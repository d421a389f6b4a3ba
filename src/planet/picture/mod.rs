//! Pictures that a preset refers to: the reference in the file, and the pixels.
//!
//! - `pixels`: the pixels and how they cover the sphere
//! - `known`: pictures in use, so that none is read twice
//! - `read`: opens the file; `from_png`, `from_exr`: decoders; `canvas`: where decoded rows or blocks are put;
//!   `contain`: panics of decoders as errors
//! - `budget`: memory and work limits of all pictures of a planet
//! - `place`: paths, relative to the folder of a preset
//!
//! [`Planet::load`](super::Planet::load) reads them. A layer whose pixels are missing is flat, and a stamp leaves the
//! ground as it is.

mod budget;
mod canvas;
pub(super) mod contain;
mod from_exr;
mod from_png;
mod known;
mod pixels;
pub(super) mod place;
mod read;

pub use budget::{Budget, MAX_BYTES, MAX_MESH_TRIANGLES, MAX_PIXELS, MAX_WORK_BYTES};
pub use contain::is_contained;
pub(super) use from_exr::{Wanted, each_run as exr_runs};
pub(super) use from_png::each_run as png_runs;
pub use pixels::{Picture, PictureExtent, PictureLayout};

use super::linked::{Linked, LinkedFile, LinkedKey};
use super::open::followed;
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

/// A reference to a picture.
pub type PictureFile = LinkedFile<Picture>;

impl Linked for Picture {
    type Key = PictureKey;
}

impl LinkedKey for PictureKey {
    fn file(&self) -> &Path {
        &self.file
    }

    fn renamed(self, file: PathBuf) -> Self {
        Self { file, ..self }
    }
}

impl LinkedFile<Picture> {
    /// The source of the pixels that cover this.
    pub fn key(&self, extent: impl Into<PictureExtent>) -> Option<PictureKey> {
        Some(PictureKey { file: self.location()?, extent: extent.into() })
    }

    /// The pixels that cover this, if they are loaded.
    pub fn picture(&self, extent: impl Into<PictureExtent>) -> Option<&Arc<Picture>> {
        let extent = extent.into();
        self.current().filter(|(key, _)| key.extent == extent).map(|(_, picture)| picture)
    }
}

/// The folder of a preset or a system file, where all that it names begins: pictures, edits, presets. Of a link, the
/// folder of the file to which it leads, which is also the file that a save replaces.
pub(crate) fn folder_of(file: &Path) -> PathBuf {
    let file = followed(file);
    let whole = std::path::absolute(&file).unwrap_or(file);
    whole.parent().map_or_else(PathBuf::new, Path::to_owned)
}
