//! A planet without a structure: continents, mountains, canyons and dunes are layers, with sea, air and clouds.
#![allow(dead_code, unreachable_pub, clippy::unwrap_used)]

use std::path::Path;
use tellus::planet::Planet;

/// File name of the preset.
pub const LAYERED: &str = "layered.ron";

/// The planet itself.
pub fn layered() -> Planet {
    Planet::load(Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(LAYERED)).unwrap()
}
