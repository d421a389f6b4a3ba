//! The speed of baking height maps of the whole globe.

use super::{median, peak_memory_mb, repeat};
use crate::bake::{Bake, Detail, Format, Map, Projection};
use crate::planet::{Planet, shipped};
use crate::terrain::Terrain;
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::Instant;

/// Width of the map.
const SIZE: u32 = 2048;

/// Width of the large map: 134 million pixels.
const LARGE: u32 = 16_384;

/// The `large_bake` object of the report: a 16-bit height map of the default planet of 16k x 8k pixels with the detail
/// of a pixel, from the planet to the file, once, on all cores. Its memory is that of the process: ask for it alone.
pub(super) fn measure_large() -> Result<Value, String> {
    let terrain = Terrain::try_new(Arc::new(shipped::default_planet())).map_err(|error| error.to_string())?;
    let mut bake = Bake::new(Arc::new(terrain), vec![Map::Height], Projection::Equirect, LARGE, Format::Png16);
    bake.detail = Detail::Pixel;
    let folder = tempfile::tempdir().map_err(|error| format!("a folder for the maps: {error}"))?;
    let begun = Instant::now();
    bake.run(folder.path(), &|_| true).map_err(|error| error.to_string())?;
    let secs = begun.elapsed().as_secs_f64();
    let mpixels = f64::from(LARGE) * f64::from(LARGE / 2) * 1e-6;
    Ok(json!({ "size": [LARGE, LARGE / 2], "secs": secs, "mps": mpixels / secs, "memory_mb": peak_memory_mb() }))
}

/// The `bake` object of the report: million pixels a second of a 16-bit height map, from the planet to the file, on one
/// core and on all; and of the default planet, whose structure is baked with the detail of a pixel.
pub(super) fn measure(planet: &Arc<Planet>) -> Result<Value, String> {
    let terrain = |planet| Terrain::try_new(planet).map(Arc::new).map_err(|error| error.to_string());
    let (plain, rivers) = (terrain(planet.clone())?, terrain(Arc::new(shipped::default_planet()))?);
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().map_err(|error| error.to_string())?;
    Ok(json!({
        "height_one_mps": one.install(|| mps(&plain))?,
        "height_all_mps": mps(&plain)?,
        "rivers_one_mps": one.install(|| mps(&rivers))?,
        "rivers_all_mps": mps(&rivers)?,
    }))
}

/// Million pixels a second.
fn mps(terrain: &Arc<Terrain>) -> Result<Option<f64>, String> {
    let mut bake = Bake::new(terrain.clone(), vec![Map::Height], Projection::Equirect, SIZE, Format::Png16);
    bake.detail = Detail::Pixel;
    // A bake into a folder that has its maps does nothing.
    let run = || -> Result<(), String> {
        let folder = tempfile::tempdir().map_err(|error| format!("a folder for the maps: {error}"))?;
        bake.run(folder.path(), &|_| true).map(drop).map_err(|error| error.to_string())
    };
    let mut failed = None;
    let times_ms = repeat(|| failed = run().err());
    let pixels = f64::from(SIZE) * f64::from(SIZE / 2);
    failed.map_or_else(|| Ok(median(&times_ms).map(|ms| pixels / ms / 1000.0)), Err)
}
