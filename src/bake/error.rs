//! Why a bake failed.

use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Why a bake failed. Strips that are done stay in their folder: the same bake goes on from there.
#[derive(Debug, thiserror::Error)]
#[non_exhaustive]
pub enum BakeError {
    /// What was asked for is not possible.
    #[error("{0}")]
    Asked(String),
    /// A file or folder could not be written or read.
    #[error("{}: {message}", path.display())]
    File {
        /// The file or folder.
        path: PathBuf,
        /// Why, and what to do.
        message: String,
    },
}

impl BakeError {
    pub(super) fn file(path: &Path, message: impl Display) -> Self {
        Self::File { path: path.to_owned(), message: message.to_string() }
    }
}
