//! `tellus mesh`: GLB and OBJ against `tellus sample`, through a reader of its own, and what cannot be written.

use crate::bake::{command, run, sampled};
use crate::{LAYERED, decode};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::Path;
use tellus::glam::DVec3;
use tellus::planet::Planet;
use tellus::sphere::LatLon;

/// A GLB as its specification says it is read.
struct Glb {
    json: Value,
    bin: Vec<u8>,
}

impl Glb {
    fn read(path: &Path) -> Self {
        let bytes = fs::read(path).unwrap();
        let number = |at: usize| u32::from_le_bytes(bytes[at..at + 4].try_into().unwrap()) as usize;
        assert_eq!((&bytes[..4], number(4), number(8)), (&b"glTF"[..], 2, bytes.len()));
        let json_length = number(12);
        assert_eq!((&bytes[16..20], json_length % 4), (&b"JSON"[..], 0));
        let bin = 20 + json_length;
        assert_eq!((&bytes[bin + 4..bin + 8], bin + 8 + number(bin)), (&b"BIN\0"[..], bytes.len()));
        let json: Value = serde_json::from_slice(&bytes[20..bin]).unwrap();
        assert_eq!(json["asset"]["version"], "2.0");
        assert_eq!(json["buffers"][0]["byteLength"], number(bin));
        Self { json, bin: bytes[bin + 8..].to_vec() }
    }

    fn view(&self, index: &Value) -> &[u8] {
        let view = &self.json["bufferViews"][index.as_u64().unwrap() as usize];
        let start = view["byteOffset"].as_u64().unwrap() as usize;
        &self.bin[start..][..view["byteLength"].as_u64().unwrap() as usize]
    }

    /// The numbers of an accessor, element by element.
    fn numbers(&self, index: &Value) -> Vec<Vec<f64>> {
        let accessor = &self.json["accessors"][index.as_u64().unwrap() as usize];
        let bytes = self.view(&accessor["bufferView"]);
        let components =
            ["", "SCALAR", "VEC2", "VEC3", "VEC4"].iter().position(|kind| accessor["type"] == *kind).unwrap();
        let values: Vec<f64> = match accessor["componentType"].as_u64().unwrap() {
            5126 => bytes.as_chunks().0.iter().map(|bytes| f32::from_le_bytes(*bytes).into()).collect(),
            5125 => bytes.as_chunks().0.iter().map(|bytes| u32::from_le_bytes(*bytes).into()).collect(),
            5123 => {
                let one = if accessor["normalized"] == true { 65_535.0 } else { 1.0 };
                bytes.as_chunks().0.iter().map(|bytes| f64::from(u16::from_le_bytes(*bytes)) / one).collect()
            }
            5120 => bytes.iter().map(|byte| f64::from(byte.cast_signed()) / 127.0).collect(),
            other => panic!("component {other}"),
        };
        // Elements may be padded to a multiple of four bytes.
        let stride = self.json["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize]["byteStride"].as_u64();
        let padded = stride.map_or(components, |stride| {
            stride as usize
                / match accessor["componentType"].as_u64() {
                    Some(5120) => 1,
                    Some(5123) => 2,
                    _ => 4,
                }
        });
        let elements: Vec<_> = values.chunks_exact(padded).map(|element| element[..components].to_vec()).collect();
        assert_eq!(elements.len() as u64, accessor["count"].as_u64().unwrap());
        elements
    }

    /// The nodes of the scene by their names, with the levels of detail that they refer to.
    fn nodes(&self) -> BTreeMap<String, &Value> {
        let nodes = self.json["nodes"].as_array().unwrap();
        nodes.iter().map(|node| (node["name"].as_str().unwrap().to_owned(), node)).collect()
    }

    fn primitive(&self, node: &Value) -> &Value {
        &self.json["meshes"][node["mesh"].as_u64().unwrap() as usize]["primitives"][0]
    }

    fn vectors(&self, index: &Value) -> Vec<DVec3> {
        self.numbers(index).iter().map(|v| DVec3::new(v[0], v[1], v[2])).collect()
    }
}

fn write(path: &Path, more: &[&str]) {
    let args = [&["mesh", LAYERED, "-o", path.to_str().unwrap()], more].concat();
    assert_eq!(run(&args), (0, String::new()));
}

fn radius_m() -> f64 {
    Planet::load(Path::new(LAYERED)).unwrap().radius_m()
}

/// Compares points in the planet frame with the heights, or water levels, that `tellus sample` answers under them.
fn check_heights(points: &[DVec3], near_m: f64) {
    let places: Vec<_> = points.iter().map(|point| LatLon::from_direction(*point).to_degrees()).collect();
    let radius_m = radius_m();
    for ((answer, point), place) in sampled(&places).iter().zip(points).zip(&places) {
        let ground_m = answer["height_m"].as_f64().unwrap();
        let wanted_m = answer["water_level_m"].as_f64().unwrap_or(ground_m).max(ground_m);
        let found_m = point.length() - radius_m;
        assert!((found_m - wanted_m).abs() <= near_m, "{place:?}: {found_m}, not {wanted_m}");
    }
}

#[test]
fn a_globe_has_the_heights_of_samples() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("globe.glb");
    write(&path, &["--spacing", "400000", "--lods", "2", "--skirt", "1000"]);
    let glb = Glb::read(&path);
    let nodes = glb.nodes();
    // Six squares in two levels of detail, under a root that tells of the planet.
    assert_eq!(nodes.len(), 13);
    let root = nodes["Layered"];
    assert_eq!(root["children"].as_array().unwrap().len(), 6);
    assert_eq!((&root["extras"]["radius_m"], &root["extras"]["units_per_m"]), (&radius_m().into(), &1.0.into()));
    let finest = nodes["pos_x_LOD0"];
    assert_eq!(finest["extensions"]["MSFT_lod"]["ids"].as_array().unwrap().len(), 1);
    assert_eq!(glb.json["extensionsUsed"], serde_json::json!(["MSFT_lod"]));
    for name in ["pos_x_LOD0", "neg_y_LOD1", "pos_z_LOD0"] {
        let primitive = glb.primitive(nodes[name]);
        let cells = if name.ends_with('0') { 26 } else { 13 };
        let positions = glb.vectors(&primitive["attributes"]["POSITION"]);
        let surface = (cells + 1) * (cells + 1);
        assert_eq!(positions.len(), surface + 4 * cells, "{name}");
        let triangles = glb.numbers(&primitive["indices"]);
        assert_eq!(triangles.len(), 3 * (2 * cells * cells + 8 * cells));
        assert!(triangles.iter().all(|index| index[0] < positions.len() as f64));
        // Floats of 32 bits are half a metre apart so far from the centre.
        let planet_frame: Vec<_> = positions[..surface].iter().step_by(7).map(|p| DVec3::new(p.x, -p.z, p.y)).collect();
        check_heights(&planet_frame, 0.6);
        let colors = glb.numbers(&primitive["attributes"]["COLOR_0"]);
        assert!(colors.iter().all(|color| color[3] == 1.0) && colors.iter().any(|color| color[0] != color[2]));
        let accessor = &glb.json["accessors"][primitive["attributes"]["POSITION"].as_u64().unwrap() as usize];
        for axis in 0..3 {
            let values = positions.iter().map(|p| p[axis]);
            assert_eq!(accessor["min"][axis], values.clone().fold(f64::MAX, f64::min));
            assert_eq!(accessor["max"][axis], values.fold(f64::MIN, f64::max));
        }
    }
}

#[test]
fn a_region_has_textures_and_water_apart() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("region.glb");
    // A coast.
    let place = ["--lat", "15.5", "--lon", "-28.5", "--km", "1200", "--spacing", "20000"];
    write(&path, &[&place[..], &["--texture", "128", "--water", "apart", "--scale", "0.001"]].concat());
    let glb = Glb::read(&path);
    let nodes = glb.nodes();
    let region = glb.primitive(nodes["region"]);
    let tangents = glb.numbers(&region["attributes"]["TANGENT"]);
    assert!(tangents.iter().all(|tangent| tangent[3] == 1.0) && tangents.len() == 61 * 61);
    assert!(region["attributes"]["COLOR_0"].is_null(), "colours would darken the texture");
    let material = &glb.json["materials"][region["material"].as_u64().unwrap() as usize];
    let textures = [
        &material["pbrMetallicRoughness"]["baseColorTexture"],
        &material["pbrMetallicRoughness"]["metallicRoughnessTexture"],
        &material["normalTexture"],
    ];
    for texture in textures {
        let source = &glb.json["textures"][texture["index"].as_u64().unwrap() as usize]["source"];
        let image = &glb.json["images"][source.as_u64().unwrap() as usize];
        let (picture, _) = decode::png(glb.view(&image["bufferView"]));
        assert_eq!((picture.width, picture.height, picture.channels), (128, 128, 3));
    }
    // The sea is level with the sample's, and the ground goes on beneath it.
    let radius_km = radius_m() / 1000.0;
    let from_center = |p: &DVec3| (*p + DVec3::new(0.0, radius_km, 0.0)) * 1000.0;
    let water = glb.primitive(nodes["region_water"]);
    assert_eq!(glb.json["materials"][water["material"].as_u64().unwrap() as usize]["alphaMode"], "BLEND");
    let level_m = Planet::load(Path::new(LAYERED)).unwrap().sea_level_m().unwrap();
    let ground = glb.vectors(&region["attributes"]["POSITION"]);
    let sea = glb.vectors(&water["attributes"]["POSITION"]);
    assert!(sea.len() > 100 && sea.len() < ground.len(), "{} of {}", sea.len(), ground.len());
    assert!(sea.iter().all(|p| (from_center(p).length() - radius_m() - level_m).abs() < 1.0));
    assert!(ground.iter().any(|p| from_center(p).length() - radius_m() < level_m - 10.0));
}

#[test]
fn whole_numbers_are_within_half_a_step_of_samples() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("mesh.glb");
    let own = |node: &Value, key: &str| DVec3::from_slice(&numbers_of(&node[key]));
    // A globe in kilometres: its squares meet on one lattice.
    write(&path, &["--spacing", "200000", "--scale", "0.001", "--quantize", "--skirt", "1000"]);
    let glb = Glb::read(&path);
    assert_eq!(glb.json["extensionsRequired"], serde_json::json!(["KHR_mesh_quantization"]));
    let mut step_m = 0.0;
    for name in ["pos_x", "neg_y", "pos_z"] {
        let node = glb.nodes()[name];
        let primitive = glb.primitive(node);
        let (scale, corner) = (own(node, "scale"), own(node, "translation"));
        let positions = glb.vectors(&primitive["attributes"]["POSITION"]);
        assert!(positions.iter().all(|p| p.round() == *p && p.min_element() >= 0.0 && p.max_element() <= 65_535.0));
        let surface = &positions[..52 * 52];
        let planet_frame = surface.iter().step_by(3).map(|p| (*p * scale + corner) * 1000.0);
        let planet_frame: Vec<_> = planet_frame.map(|p| DVec3::new(p.x, -p.z, p.y)).collect();
        step_m = scale.x * 1000.0;
        check_heights(&planet_frame, 0.5 * step_m * 3.0_f64.sqrt() + 0.6);
        let normals = glb.vectors(&primitive["attributes"]["NORMAL"]);
        assert!(normals.iter().all(|normal| (normal.length() - 1.0).abs() < 0.007));
    }
    assert!(step_m > 100.0 && step_m < 300.0, "{step_m}");
    // A region with its water: the step is a few centimetres.
    let place = ["--lat", "15.5", "--lon", "-28.5", "--km", "3", "--spacing", "100", "--water", "apart", "--lods", "2"];
    write(&path, &[&place[..], &["--quantize"]].concat());
    let glb = Glb::read(&path);
    let node = glb.nodes()["region_LOD1"];
    let (scale, corner) = (own(node, "scale"), own(node, "translation"));
    assert!(scale.x < 0.2, "{scale}");
    let positions = glb.vectors(&glb.primitive(node)["attributes"]["POSITION"]);
    let radius_m = radius_m();
    let tangent = tellus::sphere::Tangent::at(LatLon::from_degrees(15.5, -28.5));
    let level_m = Planet::load(Path::new(LAYERED)).unwrap().sea_level_m().unwrap();
    let points = positions.iter().step_by(5).map(|p| {
        let local = *p * scale + corner + DVec3::new(0.0, radius_m, 0.0);
        // East, up, south in the frame of the mesh.
        tangent.planet(DVec3::new(local.x, -local.z, local.y))
    });
    let points: Vec<DVec3> = points.collect();
    let places: Vec<_> = points.iter().map(|point| LatLon::from_direction(*point).to_degrees()).collect();
    for (answer, point) in sampled(&places).iter().zip(&points) {
        let away_m = point.length() - radius_m - answer["height_m"].as_f64().unwrap();
        // A slope carries half a step aside into the height.
        assert!(away_m.abs() <= 3.0 * scale.x, "{away_m}");
    }
    if let Some(water) = glb.nodes().get("region_water_LOD0") {
        let (scale, corner) = (own(water, "scale"), own(water, "translation"));
        let sea = glb.vectors(&glb.primitive(water)["attributes"]["POSITION"]);
        assert!(sea.iter().all(|p| {
            let from_center_m = (*p * scale + corner + DVec3::new(0.0, radius_m, 0.0)).length();
            (from_center_m - radius_m - level_m).abs() <= scale.x
        }));
    }
}

fn numbers_of(list: &Value) -> Vec<f64> {
    list.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn an_obj_names_its_materials_and_has_the_same_vertices() {
    let folder = tempfile::tempdir().unwrap();
    let (obj, glb) = (folder.path().join("region.obj"), folder.path().join("region.glb"));
    let place = ["--lat", "10", "--lon", "20", "--km", "900", "--spacing", "50000", "--lods", "2"];
    write(&obj, &[&place[..], &["--texture", "64"]].concat());
    write(&glb, &place);
    let mut names: Vec<_> =
        fs::read_dir(folder.path()).unwrap().map(|e| e.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    let expected = ["albedo.png", "normal.png", "roughness.png"].map(|end| format!("region_region_{end}"));
    assert_eq!(names[..3], ["region.glb", "region.mtl", "region.obj"]);
    assert_eq!(names[3..], expected);
    let text = fs::read_to_string(&obj).unwrap();
    let numbers =
        |line: &str| line.split(' ').skip(1).map(|n| f64::from(n.parse::<f32>().unwrap())).collect::<Vec<_>>();
    let vertices: Vec<_> = text.lines().filter(|line| line.starts_with("v ")).map(numbers).collect();
    let glb = Glb::read(&glb);
    let nodes = glb.nodes();
    let mut wanted = glb.numbers(&glb.primitive(nodes["region_LOD0"])["attributes"]["POSITION"]);
    wanted.extend(glb.numbers(&glb.primitive(nodes["region_LOD1"])["attributes"]["POSITION"]));
    assert!(vertices == wanted);
    // Triangles name vertices of their own object.
    let mut objects = text.split("\no ").skip(1).map(|object| {
        let corners = object.lines().filter(|line| line.starts_with("f ")).flat_map(|line| {
            line.split(' ').skip(1).map(|corner| corner.split('/').next().unwrap().parse::<usize>().unwrap())
        });
        let corners: Vec<_> = corners.collect();
        (*corners.iter().min().unwrap(), *corners.iter().max().unwrap())
    });
    assert_eq!(objects.next(), Some((1, 19 * 19)));
    assert_eq!(objects.next(), Some((362, 361 + 10 * 10)));
    let materials = fs::read_to_string(folder.path().join("region.mtl")).unwrap();
    assert!(text.contains("mtllib region.mtl\n") && text.contains("usemtl region\n"));
    assert!(materials.contains("newmtl region\n") && materials.contains("map_Kd region_region_albedo.png\n"));
}

#[test]
fn what_cannot_be_written_is_refused_in_words() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name).to_str().unwrap().to_owned();
    let glb = at("mesh.glb");
    let coarse = ["--spacing", "1000000"];
    for (output, more, words) in [
        (at("mesh.fbx"), &coarse[..], "use .glb or .obj"),
        (at("none/mesh.glb"), &coarse, "there is no folder"),
        (glb.clone(), &["--spacing", "10"], "more than 8 million vertices; use 8473.788 m or more"),
        (glb.clone(), &["--lat", "0", "--lon", "0", "--km", "90000"], "out of range"),
        (at("mesh.obj"), &["--spacing", "1000000", "--quantize"], "use .glb"),
    ] {
        let (status, error) = run(&[&["mesh", LAYERED, "-o", &output], more].concat());
        assert!(status == 1 && error.contains(words), "{more:?}: {status} {error}");
    }
    for more in [
        &["--lat", "5"][..],
        &["--km", "5"],
        &["--spacing", "0"],
        &["--water", "ice"],
        &["--lods", "9"],
        &["--texture", "1"],
    ] {
        let status = command(&[&["mesh", LAYERED, "-o", &glb], more].concat()).output().unwrap().status;
        assert_eq!(status.code(), Some(2), "{more:?}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}
