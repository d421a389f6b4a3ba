//! Preset versions: one module for each version's file, and the chain from the oldest to the planet of today.
//!
//! - `v1`, `v2`: old versions, frozen
//! - `v3`: the current version, whose parts are the types of today
//! - `frozen`: macros for old versions
//!
//! When version 4 comes: freeze in `v3` the types that change, write their step to `v4` and nothing else about version
//! 3, read version 4 here, and add `tests/fixtures/preset_v4.ron`. The fixtures of old versions load for ever. Never
//! edit a fixture, and never migrate text.

mod frozen;
mod v1;
mod v2;
mod v3;

use super::explain::parse;
use super::{Planet, Problem, VERSION};
use frozen::Migrate;
pub(crate) use v3::File as CurrentFile;

/// Reads the text of a preset that says it is of `version`.
pub(crate) fn read(version: u32, text: &str) -> Result<Planet, Problem> {
    let from_v2 = |file: v2::File| Migrate::<v3::File>::migrate(file).into();
    match version {
        1 => parse::<Planet, v1::File>(text).map(|file| from_v2(file.migrate())),
        2 => parse::<Planet, v2::File>(text).map(from_v2),
        3 => parse::<Planet, v3::File>(text).map(Planet::from),
        _ => Err(Problem {
            line: 1,
            column: 1,
            path: "version".to_owned(),
            message: format!("there is no version {version}; use {VERSION}"),
        }),
    }
}
