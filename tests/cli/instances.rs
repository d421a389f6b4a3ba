//! Objects of a region as a table, as points and as meshes, against the library.

use crate::LAYERED;
use glam::{DVec3, Quat, Vec3};
use parquet::file::reader::{FileReader, SerializedFileReader};
use parquet::record::RowAccessor;
use serde_json::Value;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tellus::planet::life::ReadyPopulation;
use tellus::planet::{Planet, Population};
use tellus::sphere::{LatLon, Tangent};
use tellus::terrain::Terrain;

/// A planet with two populations, in a folder of its own; the path of the preset.
fn preset(folder: &Path) -> PathBuf {
    let mut planet = Planet::load(Path::new(LAYERED)).unwrap();
    let boulders = ReadyPopulation::named("Boulder").unwrap();
    let quoted = "Stones, \"small\"".to_owned();
    planet.life = vec![
        Population { per_hectare: 30.0, shore_m: 0.0, in_water: true, ..boulders.clone() },
        Population {
            name: quoted,
            seed: 7,
            per_hectare: 60.0,
            shore_m: 0.0,
            in_water: true,
            slope_to_deg: 90.0,
            ..boulders
        },
    ];
    let path = folder.join("stony.ron");
    planet.save(&path).unwrap();
    path
}

fn tellus(args: &[&str]) -> (bool, String) {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
    let output = command.env("TELLUS_MAPS", "").args(args).output().unwrap();
    (output.status.success(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_table_and_points_hold_the_objects_of_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let preset = preset(folder.path());
    let [table, points] = ["out.csv", "out.geojson"].map(|name| folder.path().join(name));
    for output in [&table, &points] {
        let place = ["--lat", "12", "--lon", "-30", "--km", "0.4", "-o", output.to_str().unwrap()];
        let (done, message) = tellus(&[&["instances", preset.to_str().unwrap()], &place[..]].concat());
        assert!(done, "{message}");
    }
    let planet = Planet::load(&preset).unwrap();
    let terrain = Terrain::try_new(Arc::new(planet.clone())).unwrap();
    let middle = LatLon::from_degrees(12.0, -30.0);
    let within = terrain.instances(middle.direction(), 200.0).unwrap();
    let text = std::fs::read_to_string(table).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "id,kind,latitude_deg,longitude_deg,height_m,turn_deg,scale,qx,qy,qz,qw");
    let ids: Vec<u64> = lines[1..].iter().map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    assert!(ids.is_sorted() && ids.len() > 500, "{}", ids.len());
    // The square holds the circle within it, and little more than 4 / pi of it.
    assert!(within.iter().all(|instance| ids.binary_search(&instance.id).is_ok()));
    let share = ids.len() as f64 / within.len() as f64;
    assert!((1.15..1.4).contains(&share), "{share}");
    assert!(lines.iter().any(|line| line.contains("\"Stones, \"\"small\"\"\"")), "names are quoted");
    let found: Value = serde_json::from_slice(&std::fs::read(points).unwrap()).unwrap();
    let features = found["features"].as_array().unwrap();
    assert_eq!(features.len(), ids.len());
    // The quaternion is the pose: its axis is that of the object, however it leans.
    let mut leaning = 0;
    for instance in within.iter().step_by(7) {
        let line = lines[1 + ids.binary_search(&instance.id).unwrap()];
        let parts: Vec<f64> = line.rsplitn(5, ',').take(4).map(|part| part.parse().unwrap()).collect();
        let turn = tellus::glam::DQuat::from_xyzw(parts[3], parts[2], parts[1], parts[0]);
        let (east, north) = tellus::sphere::geo::east_north(instance.dir_planet);
        let to_planet = |local: tellus::glam::DVec3| east * local.x + north * local.y + instance.dir_planet * local.z;
        let form = instance.planet_from_form();
        for (axis, wanted) in tellus::glam::DMat3::IDENTITY.to_cols_array_2d().into_iter().zip(form.to_cols_array_2d())
        {
            assert!(to_planet(turn * tellus::glam::DVec3::from_array(axis)).distance(wanted.into()) < 1e-5, "{line}");
        }
        leaning += usize::from(instance.axis_planet.dot(instance.dir_planet) < 0.998);
    }
    assert!(leaning > 5, "{leaning}");
    for (feature, line) in features.iter().zip(&lines[1..]).step_by(40) {
        let properties = &feature["properties"];
        let id: u64 = properties["id"].as_str().unwrap().parse().unwrap();
        assert!(line.starts_with(&format!("{id},")), "{line}");
        let at: [f64; 3] = serde_json::from_value(feature["geometry"]["coordinates"].clone()).unwrap();
        let ground_m = terrain.height_m(LatLon::from_degrees(at[1], at[0]).direction());
        assert!((-0.05..2.0).contains(&(ground_m - at[2])), "{ground_m} {at:?}");
    }
}

#[test]
fn what_cannot_be_written_is_refused_with_what_would_be_right() {
    let folder = tempfile::tempdir().unwrap();
    let preset = preset(folder.path());
    let preset = preset.to_str().unwrap();
    let output = folder.path().join("out.csv");
    let output = output.to_str().unwrap();
    let place = ["--lat", "1", "--lon", "2"];
    for (more, part) in [
        (&["-o", output, "--km", "5000"][..], "ask for a smaller part"),
        (&["-o", output, "--kind", "Trees"], "there is no population \"Trees\"; use Boulder"),
        (&["-o", "out.png"], "use .csv or .parquet"),
        (&["-o", "out.glb", "--km", "21"], "--km: objects 21 km apart"),
    ] {
        let (done, message) = tellus(&[&["instances", preset], &place[..], more].concat());
        assert!(!done && message.contains(part), "{message}");
    }
    let (done, message) = tellus(&["instances", LAYERED, "--lat", "1", "--lon", "2", "-o", output, "--kind", "Trees"]);
    assert!(!done && message.contains("has no populations"), "{message}");
}

/// Writes the objects of 400 m around 12° N 30° W.
fn written(folder: &Path, name: &str) -> PathBuf {
    let (preset, output) = (preset(folder), folder.join(name));
    let place = ["--lat", "12", "--lon", "-30", "--km", "0.4", "-o", output.to_str().unwrap()];
    let (done, message) = tellus(&[&["instances", preset.to_str().unwrap()], &place[..]].concat());
    assert!(done, "{message}");
    output
}

#[test]
fn columns_hold_the_rows_of_the_table() {
    let folder = tempfile::tempdir().unwrap();
    let table = std::fs::read_to_string(written(folder.path(), "out.csv")).unwrap();
    let columns =
        SerializedFileReader::new(std::fs::File::open(written(folder.path(), "out.parquet")).unwrap()).unwrap();
    let rows = columns.get_row_iter(None).unwrap().map(Result::unwrap);
    let mut lines = csv::Reader::from_reader(table.as_bytes());
    let mut lines = lines.records().map(Result::unwrap);
    let mut count = 0;
    for (row, line) in rows.zip(lines.by_ref()) {
        assert_eq!(row.get_ulong(0).unwrap().to_string(), line[0]);
        assert_eq!(row.get_string(1).unwrap(), &line[1]);
        for (column, per_unit) in [(2, 1e9), (3, 1e9), (4, 1e3)] {
            let wanted: f64 = line[column].parse().unwrap();
            assert!((row.get_double(column).unwrap() - wanted).abs() < 1.0 / per_unit, "{line:?}");
        }
        for (column, per_unit) in [(5, 1e2), (6, 1e4), (7, 1e6), (8, 1e6), (9, 1e6), (10, 1e6)] {
            let wanted: f32 = line[column].parse().unwrap();
            assert!((row.get_float(column).unwrap() - wanted).abs() < 1.0 / per_unit, "{line:?}");
        }
        count += 1;
    }
    assert!(count > 500 && lines.next().is_none(), "{count}");
    assert_eq!(columns.metadata().file_metadata().num_rows(), count);
}

/// A binary glTF file in memory.
struct Glb {
    json: Value,
    bytes: Vec<u8>,
}

impl Glb {
    fn read(path: &Path) -> Self {
        let file = std::fs::read(path).unwrap();
        let number = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&file[..4], number(8)), (b"glTF".as_slice(), file.len()));
        let json = number(12);
        let bytes = file.get(28 + json..).unwrap_or_default().to_vec();
        Self { json: serde_json::from_slice(&file[20..20 + json]).unwrap(), bytes }
    }

    /// The elements of an accessor, bytes each.
    fn elements(&self, accessor: &Value, stride: usize) -> Vec<&[u8]> {
        let accessor = &self.json["accessors"][accessor.as_u64().unwrap() as usize];
        let view = &self.json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        let at = view["byteOffset"].as_u64().unwrap() as usize;
        let bytes = &self.bytes[at..at + view["byteLength"].as_u64().unwrap() as usize];
        let elements: Vec<&[u8]> = bytes.chunks_exact(stride).collect();
        assert_eq!(elements.len() as u64, accessor["count"].as_u64().unwrap());
        elements
    }

    fn floats<const N: usize>(&self, accessor: &Value) -> Vec<[f32; N]> {
        let float = |bytes: &[u8], k: usize| f32::from_le_bytes(bytes[4 * k..4 * k + 4].try_into().unwrap());
        self.elements(accessor, 4 * N).into_iter().map(|bytes| std::array::from_fn(|k| float(bytes, k))).collect()
    }
}

#[test]
fn meshes_stand_where_the_library_has_the_objects() {
    let folder = tempfile::tempdir().unwrap();
    let glb = Glb::read(&written(folder.path(), "out.glb"));
    let planet = Planet::load(preset(folder.path())).unwrap();
    let terrain = Terrain::try_new(Arc::new(planet.clone())).unwrap();
    let about = &glb.json["nodes"][0]["extras"];
    let number = |name: &str| about[name].as_f64().unwrap();
    let frame = Tangent::at(LatLon::from_degrees(number("lat_deg"), number("lon_deg")));
    let radius_m = number("radius_m");
    let all = terrain.instances(frame.up_planet, 300.0).unwrap();
    let planet_dir = |v: Vec3| frame.planet(DVec3::new(v.x.into(), (-v.z).into(), v.y.into()));
    let nodes = &glb.json["nodes"].as_array().unwrap()[1..];
    let mut count = 0;
    for node in nodes {
        let attributes = &node["extensions"]["EXT_mesh_gpu_instancing"]["attributes"];
        let feet: Vec<[f32; 3]> = glb.floats(&attributes["TRANSLATION"]);
        let turns: Vec<[f32; 4]> = glb.floats(&attributes["ROTATION"]);
        let sizes: Vec<[f32; 3]> = glb.floats(&attributes["SCALE"]);
        let ids = glb.elements(&attributes["_ID"], 8);
        for (i, id) in ids.iter().enumerate() {
            let id = u64::from_le_bytes((*id).try_into().unwrap());
            let wanted = all.iter().find(|instance| instance.id == id).unwrap();
            assert_eq!(node["extras"]["kind"], planet.life[usize::from(wanted.population)].name.as_str());
            assert_eq!(node["extras"]["variant"], wanted.variant);
            let foot_m = planet_dir(Vec3::from_array(feet[i])) + frame.up_planet * radius_m;
            assert!(foot_m.distance(wanted.foot_planet_m(radius_m)) < 1e-3);
            let turn = Quat::from_array(turns[i]);
            assert!(planet_dir(turn * Vec3::Y).distance(wanted.axis_planet) < 1e-5);
            assert!(planet_dir(turn * Vec3::X).distance(wanted.planet_from_form().x_axis) < 1e-5);
            assert_eq!(sizes[i], [wanted.size_m as f32; 3]);
        }
        count += ids.len();
    }
    let table = std::fs::read_to_string(written(folder.path(), "out.csv")).unwrap();
    assert_eq!(count, table.lines().count() - 1);
}

#[test]
fn meshes_of_objects_are_whole_and_smooth_and_as_high_as_one() {
    let folder = tempfile::tempdir().unwrap();
    let glb = Glb::read(&written(folder.path(), "out.glb"));
    let meshes = glb.json["meshes"].as_array().unwrap();
    assert!(meshes.len() > 2, "{}", meshes.len());
    for mesh in meshes {
        let primitive = &mesh["primitives"][0];
        let position = &primitive["attributes"]["POSITION"];
        let positions: Vec<[f32; 3]> = glb.floats(position);
        let normals: Vec<[f32; 3]> = glb.floats(&primitive["attributes"]["NORMAL"]);
        let top = positions.iter().map(|at| at[1]).fold(f32::MIN, f32::max);
        assert!((top - 1.0).abs() < 1e-5);
        let bounds = &glb.json["accessors"][position.as_u64().unwrap() as usize];
        assert_eq!(bounds["max"][1].as_f64(), Some(f64::from(top)));
        assert!(normals.iter().all(|normal| (Vec3::from_array(*normal).length() - 1.0).abs() < 1e-4));
        let indices = glb.elements(&primitive["indices"], 2);
        let index = |bytes: &[u8]| usize::from(u16::from_le_bytes(bytes.try_into().unwrap()));
        assert!(indices.iter().all(|bytes| index(bytes) < positions.len()));
        // Triangles face as their normals do, where the surface is closed: a stone's.
        let facing = indices.as_chunks::<3>().0.iter().filter(|corners| {
            let [a, b, c] = corners.map(|bytes| Vec3::from_array(positions[index(bytes)]));
            (b - a).cross(c - a).dot(Vec3::from_array(normals[index(corners[0])])) > 0.0
        });
        assert!(facing.count() * 10 > 9 * (indices.len() / 3));
    }
}

#[test]
fn a_region_without_objects_is_a_file_without_meshes() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("none.glb");
    let place = ["--lat", "12", "--lon", "-30", "-o", output.to_str().unwrap()];
    let (done, message) = tellus(&[&["instances", LAYERED], &place[..]].concat());
    assert!(done, "{message}");
    let glb = Glb::read(&output);
    assert!(glb.json.get("meshes").is_none() && glb.bytes.is_empty());
}

#[test]
fn the_nearest_object_is_that_of_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let preset = preset(folder.path());
    let terrain = Terrain::try_new(Arc::new(Planet::load(&preset).unwrap())).unwrap();
    let dir = LatLon::from_degrees(12.0, -30.0).direction();
    let nearest = |more: &[&str]| {
        let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
        let place = ["nearest", preset.to_str().unwrap(), "--lat", "12", "--lon", "-30", "--within", "1"];
        let output = command.env("TELLUS_MAPS", "").args(place).args(more).output().unwrap();
        let [out, err] = [output.stdout, output.stderr].map(|text| String::from_utf8(text).unwrap());
        (output.status.code(), out, err)
    };
    for (more, only) in [(&["--what", "object"][..], &[][..]), (&["--kind", "Boulder"], &[0])] {
        let wanted = terrain.nearest_object(dir, 1000.0, only, &|_| true).unwrap().unwrap();
        let (code, out, err) = nearest(&[more, &["--json"]].concat());
        assert_eq!((code, err.as_str()), (Some(0), ""));
        let found: Value = serde_json::from_str(&out).unwrap();
        let kind = &terrain.planet().life[usize::from(wanted.instance.population)].name;
        assert_eq!(found["object"]["id"], wanted.instance.id.to_string());
        assert_eq!(found["object"]["kind"], kind.as_str());
        for (told, wanted_m) in
            [(&found["distance_m"], wanted.away_m), (&found["object"]["size_m"], wanted.instance.size_m)]
        {
            assert!((told.as_f64().unwrap() - wanted_m).abs() < 1e-9, "{told} {wanted_m}");
        }
        let (_, out, _) = nearest(more);
        assert!(out.contains(&format!("{kind} {}, ", wanted.instance.id)), "{out}");
    }
    // Bounds of the ground under the object count, too.
    let height_m = terrain.height_m(dir);
    let above = format!("{}", height_m + 1.0);
    let takes = |instance: &tellus::life::Instance| instance.ground_m >= height_m + 1.0;
    let wanted = terrain.nearest_object(dir, 1000.0, &[], &takes).unwrap();
    let (code, out, err) = nearest(&["--what", "object", "--above", &above]);
    match wanted {
        Some(wanted) => assert!(out.contains(&wanted.instance.id.to_string()), "{out}"),
        None => assert!(code == Some(1) && err.contains("no such object within 1 km"), "{err}"),
    }
    let (code, _, err) = nearest(&["--kind", "Trees"]);
    assert!(code == Some(1) && err.contains("no population \"Trees\"; use Boulder"), "{err}");
}

#[test]
fn equal_seeds_of_populations_are_noted_with_a_free_one_and_no_error() {
    let folder = tempfile::tempdir().unwrap();
    let path = preset(folder.path());
    let mut planet = Planet::load(&path).unwrap();
    planet.life[1].seed = planet.life[0].seed;
    planet.save(&path).unwrap();
    let (done, message) = tellus(&["check", path.to_str().unwrap()]);
    let wanted = format!("note: {}: life[1].seed: 1 is the seed of \"Boulder\", too", path.display());
    assert!(done && message.starts_with(&wanted) && message.trim_end().ends_with("such as 2"), "{message}");
    planet.life[0].enabled = false;
    planet.save(&path).unwrap();
    assert_eq!(tellus(&["check", path.to_str().unwrap()]), (true, String::new()));
}
