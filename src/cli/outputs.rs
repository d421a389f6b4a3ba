//! The gate through which every command that writes files passes before it works. It refuses an output that is an
//! input, an address, or on a disk that takes no file or has too little room; and asks for the right ending.

use super::Failure;
use crate::bake::room::{bytes_in, check_room};
use crate::planet::output::{Target, check_folder};
use crate::planet::sources::Sources;
use std::fmt::Display;
use std::path::Path;

fn failed(path: &Path, error: impl Display) -> Failure {
    Failure::Message(format!("{}: {error}", path.display()))
}

/// Checks files of one folder that are to be written.
pub(super) fn check_files(sources: &Sources, outputs: &[impl AsRef<Path>]) -> Result<(), Failure> {
    if let Some(first) = outputs.first().map(AsRef::as_ref) {
        Target::checked(first).and_then(|target| target.probe()).map_err(|error| failed(first, error))?;
    }
    check_sources(sources, outputs)
}

/// Checks a folder, which may have to be made, and the files that are to be written in it.
pub(super) fn check_files_in(folder: &Path, sources: &Sources, outputs: &[impl AsRef<Path>]) -> Result<(), Failure> {
    check_folder(folder).map_err(|error| failed(folder, error))?;
    check_sources(sources, outputs)
}

fn check_sources(sources: &Sources, outputs: &[impl AsRef<Path>]) -> Result<(), Failure> {
    for output in outputs.iter().map(AsRef::as_ref) {
        sources.check(output).map_err(|error| failed(output, error))?;
    }
    Ok(())
}

/// Checks that a file's name has one of these endings.
pub(super) fn check_ending(output: &Path, endings: &[&str]) -> Result<(), Failure> {
    let found = output.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
    if endings.iter().any(|ending| found.eq_ignore_ascii_case(ending)) {
        return Ok(());
    }
    let wanted: Vec<String> = endings.iter().map(|ending| format!(".{ending}")).collect();
    Err(failed(output, format!("the name has another ending than what is written; use {}", wanted.join(" or "))))
}

/// Disk space check before work that writes at least `least_bytes`. `parts`: the ending of files that an earlier run of
/// the same work may have left in the folder; their bytes count as written.
pub(super) fn check_disk(folder: &Path, least_bytes: u64, parts: Option<&str>) -> Result<(), Failure> {
    let is_part = |path: &Path| path.extension().is_some_and(|ending| parts.is_some_and(|part| ending == part));
    let there = if parts.is_some() { bytes_in(folder, &is_part, 1) } else { 0 };
    check_room(folder, least_bytes, there).map_err(|error| failed(folder, error))
}
