//! The JSON beside a map: what its numbers mean.

use super::Bake;
use super::format::Shape;
use super::geotiff::Ground;
use super::maps::{Map, Range, mean_color};
use super::occlusion::DISTANCES;
use super::projection::Projection;
use crate::planet::{GROUND_VERSION, Key, Planet};
use crate::sphere::Face;
use serde_json::{Value, json};

/// What a program may want to know of the planet that something was baked from.
pub(super) fn of_planet(planet: &Planet) -> Value {
    json!({
        "planet": planet.name,
        "radius_m": planet.radius_m(),
        "sea_level_m": planet.sea_level_m(),
        "preset_hash": format!("{:032x}", Key::of_planet(planet).bits()),
        "algorithm_version": GROUND_VERSION,
        "made_by": MADE_BY,
    })
}

/// Name of the checksum that a text has of itself, and its value while that is not known.
const OWN_SUM: &str = "json_crc32";
const NO_SUM: &str = "00000000";

/// The text of a description, with a CRC-32 of itself: of the text with zeros in its place.
pub(super) fn sealed(mut about: Value) -> String {
    about[OWN_SUM] = json!(NO_SUM);
    let text = format!("{about:#}\n");
    let sum = format!("{:08x}", crc32fast::hash(text.as_bytes()));
    let field = |sum: &str| format!("\"{OWN_SUM}\": \"{sum}\"");
    text.replacen(&field(NO_SUM), &field(&sum), 1)
}

/// The description in a text, if it is whole.
pub(super) fn unsealed(text: &str) -> Option<Value> {
    let about: Value = serde_json::from_str(text).ok()?;
    let sum = about.get(OWN_SUM)?.as_str()?;
    let field = |sum: &str| format!("\"{OWN_SUM}\": \"{sum}\"");
    let bare = text.replacen(&field(sum), &field(NO_SUM), 1);
    (sum == format!("{:08x}", crc32fast::hash(bare.as_bytes()))).then_some(about)
}

/// The program that made a file.
pub(super) const MADE_BY: &str = concat!("tellus ", env!("CARGO_PKG_VERSION"));

/// What a program must know to read the map in `file`.
/// `faces`: what faces of a cube are in it; `picture`: the number of its first picture.
pub(super) fn about(bake: &Bake, map: Map, file: &str, (faces, picture): (&[&str], usize), shape: &Shape) -> Value {
    let planet = bake.terrain.planet();
    let mut about = of_planet(planet);
    let of_map = [
        ("map", json!(map.name())),
        ("file", json!(file)),
        ("format", json!(shape.format.name())),
        ("width", json!(shape.width)),
        ("height", json!(shape.height)),
        ("channels", channels(map)),
        ("projection", json!(bake.projection.name())),
        ("min", json!(shape.steps.min)),
        ("max", json!(shape.steps.max)),
        ("unit", json!(map.unit())),
        ("detail", json!(bake.detail.name())),
        ("encoding", json!(encoding(map, shape))),
    ];
    for (key, value) in of_map {
        about[key] = value;
    }
    if map.unit() == "m" {
        about["min_m"] = json!(shape.steps.min);
        about["max_m"] = json!(shape.steps.max);
    }
    match faces {
        [] => {}
        [face] => about["face"] = json!(face),
        all => about["faces"] = json!(all),
    }
    if let Ground::Plane { lat_deg, lon_deg, corner_m, pixel_m } = bake.ground(picture) {
        about["lat_deg"] = json!(lat_deg);
        about["lon_deg"] = json!(lon_deg);
        about["pixel_m"] = json!(pixel_m);
        about["corner_m"] = json!(corner_m);
    }
    if let Projection::Landscape(landscape) = bake.projection {
        let [column, row] = landscape.place(picture);
        about["tiles"] = json!(landscape.tiles);
        about["tile"] = json!({ "x": column, "y": row });
        about["unreal"] = unreal(shape, landscape.pixel_m(bake.size));
    }
    if let Projection::Quadtree(tree) = bake.projection {
        about["file"] = json!(format!("{}/{{level}}/{{face}}_{{x}}_{{y}}.{}", map.name(), shape.format.extension()));
        about["faces"] = json!(Face::ALL.map(Face::name));
        about["levels"] = json!(tree.levels);
        about["apron"] = json!(tree.apron);
        about["tile_size"] = json!(bake.size);
    }
    if map.is_of_clouds() {
        about["time_s"] = json!(bake.time_secs);
    }
    // Those of a quadtree are as many pixels of each level.
    if map == Map::AmbientOcclusion && !matches!(bake.projection, Projection::Quadtree(_)) {
        let pixel_m = bake.projection.spacing_rad(bake.size, planet.radius_km) * planet.radius_m();
        about["distances_m"] = DISTANCES.iter().map(|distance| json!(distance * pixel_m)).collect();
    }
    if map == Map::Biome {
        let biome = |(id, biome): (usize, &crate::planet::Biome)| json!({ "id": id, "key": biome.key, "name": biome.name, "color": mean_color(biome) });
        about["palette"] = planet.biomes.palette.iter().enumerate().map(biome).collect();
    }
    about
}

/// How Unreal must place and scale a landscape, in its centimetres: it takes a number n of 16 bits for
/// (n - 32768) / 128 x the scale.
fn unreal(shape: &Shape, pixel_m: f64) -> Value {
    let step_m = (shape.steps.max - shape.steps.min) / f64::from(u16::MAX);
    json!({
        "scale": [100.0 * pixel_m, 100.0 * pixel_m, 100.0 * 128.0 * step_m],
        "location_z": 100.0 * (shape.steps.min + 32_768.0 * step_m),
    })
}

/// What each channel is.
fn channels(map: Map) -> Value {
    match map {
        Map::Normal | Map::Flow => json!(["east", "north", "up"]),
        Map::NormalPlanet => json!(["x", "y", "z"]),
        Map::Albedo | Map::NightLights => json!(["red", "green", "blue"]),
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
