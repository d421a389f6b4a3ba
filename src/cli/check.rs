//! `tellus check`: validates presets and system files.

use super::{Failure, load_noted, print, tell};
use crate::planet::LoadError;
use crate::planet::file::read_text;
use crate::system::System;
use std::path::{Path, PathBuf};

/// Check presets and system files; every problem as file:line:column: path: message
#[derive(clap::Args)]
pub(super) struct Args {
    /// The presets and system files
    #[arg(value_name = "FILE.ron", required = true)]
    files: Vec<PathBuf>,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let mut all_valid = true;
    for file in &args.files {
        match checked(file) {
            Ok(()) => print(&format!("{}: valid", file.display()))?,
            Err(error) => {
                // Without a prefix: text editors and CI find the line by `file:line:column:`.
                tell(&error.to_string());
                all_valid = false;
            }
        }
    }
    if all_valid { Ok(()) } else { Err(Failure::Told) }
}

/// Checks a file. A system file is checked with the presets that it names.
fn checked(file: &Path) -> Result<(), LoadError> {
    let text = read_text(file)?;
    if System::is_system(&text) {
        let system = System::from_text(&file.display().to_string(), &text)?;
        return system.check_places(file, &system.load_planets(file)?);
    }
    load_noted(file).map(drop)
}
