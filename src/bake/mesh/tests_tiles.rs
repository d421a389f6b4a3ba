//! Tiles with whole numbers as vertices, and tilesets that do not list their tiles, of a small planet.

use super::tests::{terrain, tiles};
use super::tileset::uri;
use super::*;
use crate::sphere::{Face, NodeId};
use std::collections::HashMap;
use std::fs;

/// The JSON of a GLB, and its binary chunk.
fn read(path: &Path) -> (Value, Vec<u8>) {
    let bytes = fs::read(path).unwrap();
    let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
    (serde_json::from_slice(&bytes[20..20 + length]).unwrap(), bytes[28 + length..].to_vec())
}

fn numbers(array: &Value) -> Vec<f64> {
    array.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

/// The elements of an attribute, as far apart as the view says.
fn elements<'a>((json, binary): &'a (Value, Vec<u8>), attribute: &str, length: usize) -> Vec<&'a [u8]> {
    let index = &json["meshes"][0]["primitives"][0]["attributes"][attribute];
    let accessor = &json["accessors"][index.as_u64().unwrap() as usize];
    let view = &json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
    let [offset, bytes] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
    let stride = view["byteStride"].as_u64().map_or(length, |stride| stride as usize);
    let count = accessor["count"].as_u64().unwrap() as usize;
    assert!(offset % 4 == 0 && stride % 4 == 0 && bytes == count * stride);
    binary[offset..offset + bytes].chunks_exact(stride).map(|element| &element[..length]).collect()
}

fn shorts(element: &[u8]) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|k| f64::from(u16::from_le_bytes([element[2 * k], element[2 * k + 1]]))))
}

fn floats(element: &[u8]) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|k| f64::from(f32::from_le_bytes(element[4 * k..][..4].try_into().unwrap()))))
}

fn bytes(element: &[u8]) -> DVec3 {
    DVec3::from_array([0, 1, 2].map(|k| f64::from(element[k].cast_signed()) / 127.0))
}

#[test]
fn whole_numbers_are_within_half_a_step_and_leave_no_gap_within_a_level() {
    let (terrain, whole, short) = (terrain(), tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    // Neither a power of two, nor one that divides one.
    let plain = Tileset { cells: 6, ..tiles(2) };
    plain.run(&terrain, whole.path(), &|_| true).unwrap();
    let quantized = Tileset { is_quantized: true, ..plain.clone() };
    quantized.run(&terrain, short.path(), &|_| true).unwrap();
    let mut shared = 0;
    let mut greatest: f64 = 0.0;
    let mut points: HashMap<(u8, [u64; 3]), [f64; 3]> = HashMap::new();
    for node in plain.nodes(terrain.planet()) {
        let (plain, short) = (read(&whole.path().join(uri(node))), read(&short.path().join(uri(node))));
        for key in ["extensionsUsed", "extensionsRequired"] {
            assert_eq!((&short.0[key], &plain.0[key]), (&json!(["KHR_mesh_quantization"]), &Value::Null));
        }
        let [origin_m, corner_m] = [&plain, &short].map(|(json, _)| numbers(&json["nodes"][0]["translation"]));
        let scale = numbers(&short.0["nodes"][1]["scale"]);
        let step_m = scale[0];
        assert!(scale == [step_m; 3] && short.0["nodes"][0]["children"] == json!([1]));
        // As documented: the mean side is a quarter of a turn over two to the power of the level.
        let side_m = FRAC_PI_2 * 40_000.0 / f64::from(1 << node.level);
        assert!((step_m * 65_531.0 / (side_m * (1.35 + 1.0 / 6.0)) - 1.0).abs() < 1e-9);
        let corner = DVec3::from_slice(&corner_m) / step_m;
        assert!(corner.distance(corner.round()) < 1e-6, "{corner}");
        let positions = elements(&short, "POSITION", 6).into_iter().map(shorts);
        let wanted = elements(&plain, "POSITION", 12).into_iter().map(floats);
        for (i, (steps, wanted_m)) in positions.clone().zip(wanted).enumerate() {
            let found_m = steps * step_m + DVec3::from_slice(&corner_m);
            let away = (found_m - wanted_m - DVec3::from_slice(&origin_m)).abs().max_element() / step_m;
            // The lower vertices of skirts hang from vertices that were moved.
            assert!(away < if i < 49 { 0.51 } else { 1.01 }, "{node:?} {i}: {away} steps");
            greatest = greatest.max(away);
            if i < 49 {
                let share = |number: usize| NodeId::side_share(number as u32, 6);
                let dir = node.direction(share(i % 7), 1.0 - share(i / 7)).to_array().map(|c| (c + 0.0).to_bits());
                let point = (corner.round() + steps).to_array();
                if let Some(other) = points.insert((node.level, dir), point) {
                    shared += 1;
                    assert_eq!(point, other, "{node:?} {i}");
                }
            }
        }
        for (normal, wanted) in elements(&short, "NORMAL", 3).into_iter().zip(elements(&plain, "NORMAL", 12)) {
            assert!(bytes(normal).angle_between(floats(wanted)).to_degrees() < 0.4);
        }
        let triangles = |(json, binary): &(Value, Vec<u8>), length: usize| -> Vec<u32> {
            let index = json["meshes"][0]["primitives"][0]["indices"].as_u64().unwrap() as usize;
            let view = &json["bufferViews"][json["accessors"][index]["bufferView"].as_u64().unwrap() as usize];
            let [offset, bytes] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
            let number = |index: &[u8]| index.iter().rev().fold(0, |sum, byte| sum << 8 | u32::from(*byte));
            binary[offset..offset + bytes].chunks_exact(length).map(number).collect()
        };
        assert_eq!(triangles(&short, 2), triangles(&plain, 4));
        let accessor = &short.0["accessors"][0];
        let all: Vec<_> = positions.collect();
        for (key, corner) in [
            ("min", all.iter().copied().fold(DVec3::INFINITY, DVec3::min)),
            ("max", all.iter().copied().fold(DVec3::NEG_INFINITY, DVec3::max)),
        ] {
            assert_eq!(numbers(&accessor[key]), corner.to_array());
        }
    }
    // Most inner borders of 126 tiles, of 7 vertices each.
    assert!(shared > 1000 && greatest > 0.45, "{shared} {greatest}");
    let error = plain.run(&terrain, short.path(), &|_| true).unwrap_err().to_string();
    assert!(error.contains("holds tiles of another bake"), "{error}");
}

#[test]
fn tiles_of_whole_numbers_have_tangents_for_their_textures() {
    let (terrain, folder) = (terrain(), tempfile::tempdir().unwrap());
    let tileset = Tileset { is_quantized: true, texture_px: Some(4), ..tiles(0) };
    tileset.run(&terrain, folder.path(), &|_| true).unwrap();
    let tile = read(&folder.path().join("0/pos_z_0_0.glb"));
    for (tangent, normal) in elements(&tile, "TANGENT", 4).into_iter().zip(elements(&tile, "NORMAL", 3)) {
        assert_eq!(tangent[3], 127);
        assert!(bytes(tangent).dot(bytes(normal)).abs() < 0.015);
    }
    let places = elements(&tile, "TEXCOORD_0", 4);
    // The grid of 5 by 5, row by row.
    assert_eq!((places[0], places[24], places[12]), (&[0, 0, 0, 0][..], &[255; 4][..], &[0, 128, 0, 128][..]));
}

/// The tiles of a face as the tileset lists them, in the order of a subtree file.
fn listed(root: &Value) -> Vec<Value> {
    let (mut tiles, mut level) = (Vec::new(), vec![root.clone()]);
    while !level.is_empty() {
        let children = |tile: &Value| tile["children"].as_array().cloned().unwrap_or_default();
        let next = level.iter().flat_map(children).collect();
        tiles.append(&mut level);
        level = next;
    }
    tiles
}

#[test]
fn subtrees_say_of_the_same_tiles_what_the_list_says() {
    let (terrain, folder) = (terrain(), tempfile::tempdir().unwrap());
    let region = Some(Region { lat_deg: 20.0, lon_deg: -40.0, side_km: 4.0 });
    let plain = Tileset { region, ..tiles(4) };
    plain.run(&terrain, folder.path(), &|_| true).unwrap();
    let tileset =
        || -> Value { serde_json::from_slice(&fs::read(folder.path().join("tileset.json")).unwrap()).unwrap() };
    let list = tileset();
    // The same tiles serve both, and files that are there are not written again.
    let tile = folder.path().join("1/neg_z_1_0.glb");
    let written = || fs::metadata(&tile).unwrap().modified().unwrap();
    let before = written();
    let implicit = Tileset { is_implicit: true, ..plain.clone() };
    let Outcome::Done(files) = implicit.run(&terrain, folder.path(), &|_| true).unwrap() else { panic!("stopped") };
    assert_eq!(files.len(), 1 + 6 + plain.nodes(terrain.planet()).len());
    assert_eq!(written(), before);
    let whole = tileset();
    assert!(list["schema"].is_null() && whole["schema"]["classes"]["tile"].is_object());
    let mut depths = Vec::new();
    for (i, face) in Face::ALL.into_iter().enumerate() {
        let (root, tiles) = (&whole["root"]["children"][i], listed(&list["root"]["children"][i]));
        assert!(root["children"].is_null() && root["metadata"].is_null());
        assert_eq!(root["boundingVolume"], tiles[0]["boundingVolume"]);
        let name = root["implicitTiling"]["subtrees"]["uri"].as_str().unwrap();
        let name = ["{level}", "{x}", "{y}"].iter().fold(name.to_owned(), |name, part| name.replace(part, "0"));
        let file = fs::read(folder.path().join(&name)).unwrap();
        let length = u64::from_le_bytes(file[8..16].try_into().unwrap()) as usize;
        let json: Value = serde_json::from_slice(&file[24..24 + length]).unwrap();
        let table = &json["propertyTables"][0];
        assert_eq!(table["count"], tiles.len());
        let column = |name: &str| -> Vec<f64> {
            let view = &json["bufferViews"][table["properties"][name]["values"].as_u64().unwrap() as usize];
            let [start, bytes] = ["byteOffset", "byteLength"].map(|key| view[key].as_u64().unwrap() as usize);
            file[24 + length + start..][..bytes].as_chunks().0.iter().map(|b| f64::from_le_bytes(*b)).collect()
        };
        let boxes: Vec<_> = tiles.iter().flat_map(|tile| numbers(&tile["boundingVolume"]["box"])).collect();
        // The reader of JSON is a bit off at times.
        let are_near = |a: &[f64], b: &[f64]| a.len() == b.len() && a.iter().zip(b).all(|(a, b)| (a - b).abs() < 1e-9);
        assert!(are_near(&column("bounds"), &boxes));
        let errors: Vec<_> = tiles.iter().map(|tile| tile["geometricError"].as_f64().unwrap()).collect();
        assert!(are_near(&column("error_m"), &errors));
        // Columns and rows grow along the axes of the box of the face.
        let bounds = numbers(&root["boundingVolume"]["box"]);
        let [center_m, east_m, north_m, up_m] = [0, 3, 6, 9].map(|k| DVec3::from_slice(&bounds[k..]));
        for node in [NodeId { level: 2, face, x: 3, y: 1 }, NodeId { level: 2, face, x: 1, y: 2 }] {
            let along = node.direction(0.5, 0.5) * 40_000.0 - center_m;
            let share = |axis: DVec3| along.dot(axis) / axis.length_squared();
            assert_eq!((share(east_m) > 0.0, share(north_m) > 0.0), (node.x > 1, node.y > 1), "{node:?}");
        }
        assert!(up_m.dot(center_m) > 0.0 && east_m.cross(north_m).dot(up_m) > 0.0);
        depths.push(root["implicitTiling"]["subtreeLevels"].as_u64().unwrap());
        // Bits that are set are those of tiles whose files are there.
        let content = root["content"]["uri"].as_str().unwrap();
        let there = |level: u8, x: u32, y: u32| {
            let parts = [("{level}", u32::from(level)), ("{x}", x), ("{y}", y)];
            let file = parts.iter().fold(content.to_owned(), |uri, (part, n)| uri.replace(part, &n.to_string()));
            folder.path().join(file).is_file()
        };
        let levels = 0..*depths.last().unwrap() as u8;
        let all = levels.flat_map(|l| (0..1 << l).flat_map(move |y| (0..1 << l).map(move |x| (l, x, y))));
        assert_eq!(all.filter(|(level, x, y)| there(*level, *x, *y)).count(), tiles.len());
    }
    // Levels beyond 2 are there around the region alone.
    assert!(depths.contains(&3) && depths.contains(&5), "{depths:?}");
    // Back to the list.
    plain.run(&terrain, folder.path(), &|_| true).unwrap();
    assert_eq!(tileset(), list);
}
