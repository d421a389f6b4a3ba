//! Tests of the command line, run as a process, of the README's promises, and of the repository's own rules.
//!
//! - `bake`: maps against `tellus sample`; `decode`: readers of their files; `baked_edits`: ground edits as a picture
//! - `coasts`: coasts as lines and polygons
//! - `commands`: answers, messages, exit status
//! - `disk`: disks that are full or read-only
//! - `sets`: sets of files: damaged, finished, incomplete; threads and progress
//! - `readback`: every map, format and projection
//! - `instances`: plants and stones of a region; `meshes`: meshes of artists
//! - `rivers`: rivers as GeoJSON, many points
//! - `outputs`: outputs that are inputs, links, addresses; nothing is lost
//! - `mesh`: meshes against `tellus sample`
//! - `fuzz`: random command lines
//! - `house`: the length of files and comments
//! - `hostile`: broken and oversized files
//! - `interface`: what docs/commands.md promises, against `--help`
//! - `system`: systems of planets
//! - `textures`: texture sets of biomes
//! - `readme`: the README's examples, presets and pictures
#![allow(clippy::unwrap_used, clippy::panic, missing_docs)]

mod bake;
mod baked_edits;
mod coasts;
mod commands;
mod decode;
#[cfg(target_os = "linux")]
mod disk;
mod fuzz;
#[cfg(unix)]
mod hostile;
mod house;
mod instances;
mod interface;
mod mesh;
mod meshes;
#[cfg(unix)]
mod outputs;
mod readback;
mod readme;
mod rivers;
mod sets;
mod system;
mod textures;

#[path = "../support/dice.rs"]
mod dice;
#[path = "../support/glb.rs"]
mod glb;
#[path = "../support/textures.rs"]
mod textures_of;

/// A planet without a structure: there are no maps to solve.
const LAYERED: &str = "tests/fixtures/layered.ron";
