//! A problem of a preset, and its location in the text.

use std::fmt;

/// A problem of a preset.
#[derive(Clone, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub struct Problem {
    /// Line, from 1; 0 if the problem has no location in the text.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// Path in the planet: `layers[2].shape.octaves`; empty for the file as a whole.
    pub path: String,
    /// What is wrong, and what would be right.
    pub message: String,
}

/// `line:column: path: message`, without the elements that the problem lacks.
impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if self.line > 0 {
            write!(f, "{}:{}: ", self.line, self.column)?;
        }
        if !self.path.is_empty() {
            write!(f, "{}: ", self.path)?;
        }
        f.write_str(&self.message)
    }
}
