//! The application.

use std::path::PathBuf;

/// Opens the editor's window, with a preset if one is given, and stays until it is closed.
pub fn run(path: Option<PathBuf>) -> Result<(), String> {
    drop(path);
    Err("the editor is not built yet".to_owned())
}
