//! `tellus check`: validates presets.

use super::{Failure, print, tell};
use crate::planet::Planet;
use std::path::PathBuf;

/// Check presets; every problem as file:line:column: path: message
#[derive(clap::Args)]
pub(super) struct Args {
    /// The presets
    #[arg(value_name = "FILE.ron", required = true)]
    files: Vec<PathBuf>,
}

pub(super) fn run(args: &Args) -> Result<(), Failure> {
    let mut all_valid = true;
    for file in &args.files {
        match Planet::load(file) {
            Ok(_) => print(&format!("{}: valid", file.display()))?,
            Err(error) => {
                // Without a prefix: text editors and CI find the line by `file:line:column:`.
                tell(&error.to_string());
                all_valid = false;
            }
        }
    }
    if all_valid { Ok(()) } else { Err(Failure::Told) }
}
