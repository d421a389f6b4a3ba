//! Every map of a planet with rivers, clouds and towns, in every format and projection, read by other code than wrote
//! it and compared with `tellus sample` at a thousand places.

use crate::bake::{command, expected, pixels, sampled_of};
use crate::{LAYERED, decode};
use decode::Picture;
use serde_json::Value;
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::fs;
use std::path::{Path, PathBuf};
use tellus::bake::Map;
use tellus::glam::{DVec2, DVec3};
use tellus::planet::Planet;
use tellus::sphere::{LatLon, Tangent};

/// A planet that has every map; its rivers are solved in a moment.
fn rills(folder: &Path) -> PathBuf {
    let path = folder.join("rills.ron");
    let text = "(version: 3, name: \"Rills\", structure: (grids: 1), water: (level_m: 0), clouds: (), settlements: 1.0, \
         life: [(per_hectare: 20000.0, height_m: 0.5, color: (0.2, 0.5, 0.1), leaf_color: (0.2, 0.5, 0.1))])";
    fs::write(&path, text).unwrap();
    path
}

fn bake(preset: &Path, folder: &Path, maps: &[&str], more: &[&str]) {
    let (what, out) = (maps.join(","), folder.to_str().unwrap());
    // What samples answer.
    let all = ["bake", preset.to_str().unwrap(), "-o", out, "--detail", "all", "--progress", "none"];
    let args = [&all[..], &["--what", what.as_str()], more].concat();
    let output = command(&args).output().unwrap();
    assert!(output.status.success(), "{more:?}: {}", String::from_utf8_lossy(&output.stderr));
}

/// The finest level of a texture, read by the crate ktx2. Vectors and colours have a fourth channel of 1.
fn ktx2(bytes: &[u8]) -> Picture {
    let reader = ktx2::Reader::new(bytes).unwrap();
    let header = reader.header();
    let (width, height) = (header.pixel_width as usize, header.pixel_height as usize);
    let level = reader.levels().next().unwrap();
    let numbers: Vec<f64> = match header.type_size {
        1 => level.data.iter().map(|byte| f64::from(*byte)).collect(),
        _ => level.data.as_chunks().0.iter().map(|pair| f64::from(u16::from_le_bytes(*pair))).collect(),
    };
    let stored = numbers.len() / (width * height * header.face_count.max(1) as usize);
    let (channels, top) =
        if stored == 4 { (3, if header.type_size == 1 { 255.0 } else { 65_535.0 }) } else { (1, 0.0) };
    assert!(stored == 1 || numbers.chunks(4).all(|texel| texel[3] == top), "alpha is 1");
    let numbers = numbers.chunks(stored).flat_map(|texel| texel[..channels].to_vec()).collect();
    Picture { width, height, channels, numbers }
}

fn read(folder: &Path, name: &str, format: &str, size: [usize; 2]) -> Picture {
    let bytes = |ending: &str| fs::read(folder.join(format!("{name}.{ending}"))).unwrap();
    match format {
        "png8" | "png16" => decode::png(&bytes("png")).0,
        "exr" | "exr16" => decode::exr(&bytes("exr")),
        "tiff" | "tiff16" => decode::tiff(&bytes("tif")).0,
        "ktx2" => ktx2(&bytes("ktx2")),
        _ => decode::r16(&bytes("r16"), size[0], size[1]),
    }
}

/// What `tellus sample` and the preset say of a map at a place.
fn wanted(map: &str, answer: &Value, planet: &Planet, place: (f64, f64)) -> Vec<f64> {
    let biome = || planet.biomes.palette.iter().position(|biome| answer["biome"] == biome.name.as_str()).unwrap();
    let river = &answer["river"];
    match map {
        "biome" => vec![biome() as f64],
        "roughness" => vec![planet.biomes.palette[biome()].roughness],
        "albedo" => {
            let (biome, water) = (&planet.biomes.palette[biome()], planet.water.as_ref().unwrap());
            let depth_m = answer["water_level_m"].as_f64().map_or(0.0, |m| m - answer["height_m"].as_f64().unwrap());
            let channel = |k: usize| {
                let ground = biome.color[k] * (1.0 - biome.patches) + biome.patch_color[k] * biome.patches;
                let seen = (-2.0 * depth_m.max(0.0) * water.absorption_per_m[k]).exp();
                let below = water.color[k] * (1.0 - seen) + ground * seen;
                below + (planet.life[0].color[k] - below) * answer["canopy_cover"].as_f64().unwrap()
            };
            (0..3).map(channel).collect()
        }
        "canopy" => vec![answer["canopy_cover"].as_f64().unwrap()],
        "canopy_height" => vec![answer["canopy_height_m"].as_f64().unwrap()],
        "discharge" => vec![river["discharge_m3_s"].as_f64().unwrap_or(0.0)],
        "flow" if river.is_null() => vec![0.0; 3],
        "flow" => {
            let flow: Vec<f64> = river["flow"].as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect();
            let local = Tangent::at(LatLon::from_degrees(place.0, place.1)).local(DVec3::from_slice(&flow));
            local.to_array().to_vec()
        }
        other => expected(other, answer, &[], place),
    }
}

/// Checks pictures of floats. `found`: for each place the number of its picture and its pixel. Where pixels are not at
/// round numbers of degrees, a few lie on the border of a biome or a river, and belong to the other side.
fn check(preset: &Path, maps: &[&str], read: &dyn Fn(&str) -> Vec<Vec<f64>>, places: &[(f64, f64)], strays: usize) {
    let (planet, answers) = (Planet::load(preset).unwrap(), sampled_of(preset.to_str().unwrap(), places));
    assert!(answers.iter().filter(|answer| !answer["river"].is_null()).count() > 0, "no river is near");
    for map in maps.iter().filter(|map| **map != "night_lights") {
        let mut wrong = Vec::new();
        for ((found, answer), place) in read(map).iter().zip(&answers).zip(places) {
            let wanted = wanted(map, answer, &planet, *place);
            assert_eq!(found.len(), wanted.len());
            let near = |(found, wanted): (&f64, &f64)| (found - wanted).abs() <= 1e-6 * wanted.abs() + 1e-5;
            if !found.iter().zip(&wanted).all(near) {
                wrong.push(format!("{place:?}: {found:?}, not {wanted:?}"));
            }
        }
        assert!(wrong.len() <= strays, "{map}: {} of {}: {}", wrong.len(), places.len(), wrong[0]);
    }
}

/// All but ambient occlusion, which takes long beside rivers.
fn maps() -> Vec<&'static str> {
    Map::ALL.map(Map::name).into_iter().filter(|map| *map != "ambient_occlusion").collect()
}

#[test]
fn every_map_of_the_globe_in_every_format() {
    let folder = tempfile::tempdir().unwrap();
    let (folder, size) = (folder.path(), [64, 32]);
    let (preset, maps, pixels) = (rills(folder), maps(), pixels(64, 32));
    bake(&preset, folder, &maps, &["--size", "64", "--format", "exr"]);
    let floats = |map: &str| read(folder, map, "exr", size);
    let place = |&(x, y): &(usize, usize)| (90.0 - (y as f64 + 0.5) * 5.625, (x as f64 + 0.5) * 5.625 - 180.0);
    let places: Vec<_> = pixels.iter().map(place).collect();
    let at = |map: &str| {
        let picture = floats(map);
        pixels.iter().map(|&(x, y)| picture.at(x, y).to_vec()).collect()
    };
    check(&preset, &maps, &at, &places, 0);
    // Pixels that lie close share their rivers, so that many bakes are quick.
    let (near, region) =
        (folder.join("near"), ["--as", "region", "--lat", "20", "--lon", "-30", "--km", "48", "--size", "24"]);
    bake(&preset, &near, &maps, &[&region[..], &["--format", "exr"]].concat());
    check_formats(&preset, &near, &maps, [24, 24], &region);
}

/// The other formats hold the floats, to half a step of their numbers.
fn check_formats(preset: &Path, folder: &Path, maps: &[&str], size: [usize; 2], more: &[&str]) {
    for format in ["png8", "png16", "exr16", "tiff", "tiff16", "ktx2", "r16"] {
        let is_one = |map: &&str| Map::named(map).is_some_and(|map| map.channels() == 1);
        let maps: Vec<&str> = maps.iter().copied().filter(|map| format != "r16" || is_one(map)).collect();
        let other = folder.join(format);
        bake(preset, &other, &maps, &[more, &["--format", format]].concat());
        for map in maps {
            let (found, wanted) = (read(&other, map, format, size), read(folder, map, "exr", size));
            let about: Value = serde_json::from_slice(&fs::read(other.join(format!("{map}.json"))).unwrap()).unwrap();
            let [min, max] = ["min", "max"].map(|key| about[key].as_f64().unwrap());
            let is_srgb = about["encoding"] == "srgb";
            let top = if format == "png8" || (format == "ktx2" && is_srgb) { 255.0 } else { 65_535.0 };
            assert_eq!((found.width, found.height, found.channels), (size[0], size[1], wanted.channels), "{map}");
            for (&number, &value) in found.numbers.iter().zip(&wanted.numbers) {
                let (found, near) = match format {
                    "tiff" => (number, 0.0),
                    // Half floats end at 65,504.
                    "exr16" if value.abs() > 65_504.0 => continue,
                    "exr16" => (number, value.abs() / 2048.0 + 1e-7),
                    _ if about["encoding"] == "numbers" => (number, 0.0),
                    _ if is_srgb => {
                        let share = number / top;
                        let linear =
                            if share <= 0.040_45 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) };
                        (linear, 0.5 / top * 2.4)
                    }
                    _ => {
                        (min + number / top * (max - min), (0.5 / top) * (max - min) + 1e-7 * max.abs().max(min.abs()))
                    }
                };
                assert!((found - value).abs() <= near, "{map} as {format}: {found}, not {value}");
            }
        }
    }
}

#[test]
fn every_map_of_a_cube_and_of_a_region() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (preset, maps) = (rills(folder), maps());
    bake(&preset, folder, &maps, &["--as", "cube", "--size", "13", "--format", "exr"]);
    let names = ["pos_x", "neg_x", "pos_y", "neg_y", "pos_z", "neg_z"];
    let texels: Vec<(usize, usize, usize)> = (0..1014).map(|i| (i / 169, i % 13, i / 13 % 13)).collect();
    let place = |&(face, x, y): &(usize, usize, usize)| {
        let [u, v] = [x, y].map(|at| (at as f64 + 0.5) / 6.5 - 1.0);
        let dir = [[1.0, -v, -u], [-1.0, -v, u], [u, 1.0, v], [u, -1.0, -v], [u, -v, 1.0], [-u, -v, -1.0]][face];
        LatLon::from_direction(DVec3::from_array(dir)).to_degrees()
    };
    let at = |map: &str| {
        let faces = names.map(|face| read(folder, &format!("{map}_{face}"), "exr", [13, 13]));
        texels.iter().map(|&(face, x, y)| faces[face].at(x, y).to_vec()).collect()
    };
    check(&preset, &maps, &at, &texels.iter().map(place).collect::<Vec<_>>(), 3);
    // A region with a river.
    let region = ["--as", "region", "--lat", "1.1", "--lon", "24", "--km", "100", "--size", "40", "--format", "exr"];
    bake(&preset, folder, &maps, &region);
    let (tangent, pixels) = (Tangent::at(LatLon::from_degrees(1.1, 24.0)), pixels(40, 40));
    let radius_km = Planet::load(&preset).unwrap().radius_km;
    let place = |&(x, y): &(usize, usize)| {
        let [right, down] = [x, y].map(|at| (at as f64 + 0.5 - 20.0) * 2.5 / radius_km);
        LatLon::from_direction(tangent.direction(right, -down)).to_degrees()
    };
    let at = |map: &str| {
        let picture = read(folder, map, "exr", [40, 40]);
        pixels.iter().map(|&(x, y)| picture.at(x, y).to_vec()).collect()
    };
    check(&preset, &maps, &at, &pixels.iter().map(place).collect::<Vec<_>>(), 3);
}

/// Ambient occlusion from the heights of `tellus sample`, by a sum over the hemisphere instead of the baker's formula.
#[test]
fn ambient_occlusion_is_what_the_horizon_of_samples_leaves_open() {
    let folder = tempfile::tempdir().unwrap();
    let (folder, preset) = (folder.path(), Path::new(LAYERED));
    let region = ["--as", "region", "--lat", "16.3", "--lon", "-32.4", "--km", "24", "--size", "24"];
    bake(preset, folder, &["ambient_occlusion"], &[&region[..], &["--format", "exr"]].concat());
    let picture = read(folder, "ambient_occlusion", "exr", [24, 24]);
    let planet = Planet::load(preset).unwrap();
    let (radius_m, sea_m) = (planet.radius_m(), planet.sea_level_m().unwrap());
    let tangent = Tangent::at(LatLon::from_degrees(16.3, -32.4));
    let mut darkest = 1.0_f64;
    for (x, y) in [(0, 0), (5, 17), (12, 12), (23, 3), (9, 8), (17, 20), (2, 13)] {
        let [right, down] = [x, y].map(|at| (at as f64 + 0.5 - 12.0) * 1000.0 / radius_m);
        let dir = tangent.direction(right, -down);
        let own = Tangent::new(dir);
        let ring = |away_m: f64| (0..12).map(move |k| (away_m, f64::from(k) * TAU / 12.0));
        let around: Vec<_> = [1e3, 2e3, 4e3, 8e3, 16e3, 32e3].into_iter().flat_map(ring).collect();
        let place = |&(away_m, turn): &(f64, f64)| {
            let away_rad = away_m / radius_m;
            LatLon::from_direction(own.direction(away_rad * turn.cos(), away_rad * turn.sin())).to_degrees()
        };
        let places: Vec<_> =
            std::iter::once(LatLon::from_direction(dir).to_degrees()).chain(around.iter().map(place)).collect();
        let far_m: Vec<f64> = sampled_of(LAYERED, &places)
            .iter()
            .map(|answer| radius_m + answer["height_m"].as_f64().unwrap().max(sea_m))
            .collect();
        let rise = |k: usize| {
            let (sin, cos) = (around[k].0 / radius_m).sin_cos();
            (far_m[k + 1] * cos - far_m[0]) / (far_m[k + 1] * sin)
        };
        let slope: DVec2 = (0..12).map(|k| DVec2::from_angle(around[k].1) * rise(k) / 6.0).sum();
        let normal = DVec3::new(-slope.x, -slope.y, 1.0).normalize();
        let mut open = 0.0;
        for (k, (_, heading_rad)) in around.iter().enumerate().take(12) {
            let along = DVec2::from_angle(*heading_rad);
            let steepest = (0..6).map(|n| rise(12 * n + k)).fold(slope.dot(along), f64::max);
            let (from, steps) = (steepest.atan(), 2000);
            let step = (FRAC_PI_2 - from) / f64::from(steps);
            for i in 0..steps {
                let (sin, cos) = (from + (f64::from(i) + 0.5) * step).sin_cos();
                open += normal.dot((along * cos).extend(sin)) * cos * step * TAU / 12.0 / PI;
            }
        }
        let found = picture.at(x, y)[0];
        assert!((found - open.min(1.0)).abs() < 1e-4, "{x},{y}: {found}, not {open}");
        darkest = darkest.min(found);
    }
    assert!(darkest < 0.999, "nothing is hidden: {darkest}");
    check_formats(preset, folder, &["ambient_occlusion"], [24, 24], &region);
}
