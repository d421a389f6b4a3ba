//! The JSON beside a map: what its numbers mean.

use super::Bake;
use super::format::Shape;
use super::maps::{Map, Range, mean_color};
use super::projection::Projection;
use crate::planet::{Key, VERSION};
use serde_json::{Value, json};

/// What a program must know to read the map in `file`.
pub(super) fn about(bake: &Bake, map: Map, file: &str, faces: &[&str], shape: &Shape) -> Value {
    let planet = bake.terrain.planet();
    let mut about = json!({
        "planet": planet.name,
        "map": map.name(),
        "file": file,
        "format": shape.format.name(),
        "width": shape.width,
        "height": shape.height,
        "channels": channels(map),
        "projection": bake.projection.name(),
        "min": shape.steps.min,
        "max": shape.steps.max,
        "unit": map.unit(),
        "detail": bake.detail.name(),
        "encoding": encoding(map, shape),
        "radius_m": planet.radius_m(),
        "sea_level_m": planet.sea_level_m(),
        "preset_hash": format!("{:032x}", Key::of_planet(planet).bits()),
        // The version of presets pins the algorithm of the terrain, too.
        "algorithm_version": VERSION,
        "made_by": concat!("tellus ", env!("CARGO_PKG_VERSION")),
    });
    if map.unit() == "m" {
        about["min_m"] = json!(shape.steps.min);
        about["max_m"] = json!(shape.steps.max);
    }
    match faces {
        [] => {}
        [face] => about["face"] = json!(face),
        all => about["faces"] = json!(all),
    }
    if let Projection::Region(region) = bake.projection {
        about["lat_deg"] = json!(region.lat_deg);
        about["lon_deg"] = json!(region.lon_deg);
        about["pixel_m"] = json!(region.side_km * 1000.0 / f64::from(shape.width));
    }
    if map.is_of_clouds() {
        about["time_s"] = json!(bake.time_secs);
    }
    if map == Map::Biome {
        let biome = |(id, biome): (usize, &crate::planet::Biome)| json!({ "id": id, "key": biome.key, "name": biome.name, "color": mean_color(biome) });
        about["palette"] = planet.biomes.palette.iter().enumerate().map(biome).collect();
    }
    about
}

/// What each channel is.
fn channels(map: Map) -> Value {
    match map {
        Map::Normal | Map::Flow => json!(["east", "north", "up"]),
        Map::NormalPlanet => json!(["x", "y", "z"]),
        Map::Albedo => json!(["red", "green", "blue"]),
        other => json!([other.name()]),
    }
}

/// How the numbers of the file become values.
fn encoding(map: Map, shape: &Shape) -> &'static str {
    match (shape.format.top(map), map.range()) {
        (None, _) => "values",
        (_, Range::Numbers) => "numbers",
        _ if shape.steps.is_srgb() => "srgb",
        _ => "linear",
    }
}
