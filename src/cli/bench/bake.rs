//! The speed of baking a height map of the whole globe.

use super::{median, repeat};
use crate::bake::{Bake, Detail, Format, Map, Projection};
use crate::planet::{Planet, shipped};
use crate::terrain::Terrain;
use serde_json::{Value, json};
use std::sync::Arc;

/// Width of the map.
const SIZE: u32 = 2048;

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
    let folder = tempfile::tempdir().map_err(|error| format!("a folder for the maps: {error}"))?;
    let mut failed = None;
    let times_ms = repeat(|| failed = bake.run(folder.path(), &|_| true).err());
    let pixels = f64::from(SIZE) * f64::from(SIZE / 2);
    failed.map_or_else(|| Ok(median(&times_ms).map(|ms| pixels / ms / 1000.0)), |error| Err(error.to_string()))
}
