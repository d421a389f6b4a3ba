//! Meshes of artists on the command line: checks, and objects in files.

use crate::glb::{glb, tree};
use serde_json::Value;
use std::path::Path;
use tellus::planet::VERSION;

/// Runs in a folder. Whether it succeeded, and what it said.
fn run(folder: &Path, args: &[&str]) -> (bool, String) {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
    let output = command.env("TELLUS_MAPS", "").current_dir(folder).args(args).output().unwrap();
    let said = [output.stdout, output.stderr].concat();
    (output.status.success(), String::from_utf8(said).unwrap())
}

fn write_preset(folder: &Path, form: &str) {
    let life = format!("(name: \"Oak\", height_m: 8.0, shore_m: 0.0, per_hectare: 60.0,\n form: {form})");
    std::fs::write(folder.join("a.ron"), format!("(version: {VERSION}, radius_km: 300.0, life: [{life}])")).unwrap();
}

#[test]
fn a_check_says_what_is_wrong_with_a_mesh_and_where() {
    let folder = tempfile::tempdir().unwrap();
    write_preset(folder.path(), "Mesh(file: \"oak.glb\")");
    let (valid, said) = run(folder.path(), &["check", "a.ron"]);
    assert!(!valid && said.starts_with("a.ron:2:"), "{said}");
    assert!(said.contains("life[0].form.file: there is no file") && said.contains("put the mesh there"), "{said}");
    std::fs::write(folder.path().join("oak.glb"), "solid").unwrap();
    let (valid, said) = run(folder.path(), &["check", "a.ron"]);
    assert!(!valid && said.contains("is no glTF 2.0 file; export the mesh as .glb or .gltf"), "{said}");
    std::fs::write(folder.path().join("oak.glb"), glb(&tree())).unwrap();
    assert_eq!(run(folder.path(), &["check", "a.ron"]), (true, "a.ron: valid\n".to_owned()));
}

#[test]
fn objects_in_a_file_have_the_mesh_and_its_colours() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("oak.glb"), glb(&tree())).unwrap();
    write_preset(folder.path(), "Mesh(file: \"oak.glb\")");
    let place = ["--lat", "10", "--lon", "20", "--km", "0.2"];
    let objects = |output: &str| {
        let (done, said) = run(folder.path(), &[&["instances", "a.ron", "-o", output], &place[..]].concat());
        assert!(done, "{said}");
        let bytes = std::fs::read(folder.path().join(output)).unwrap();
        let length = u32::from_le_bytes(bytes[12..16].try_into().unwrap()) as usize;
        let document: Value = serde_json::from_slice(&bytes[20..20 + length]).unwrap();
        (document, bytes[28 + length..].to_vec())
    };
    let (document, bytes) = objects("objects.glb");
    let attributes = &document["meshes"][0]["primitives"][0]["attributes"];
    let view = |name: &str| {
        let accessor = &document["accessors"][attributes[name].as_u64().unwrap() as usize];
        let view = &document["bufferViews"][accessor["bufferView"].as_u64().unwrap() as usize];
        (accessor["count"].as_u64().unwrap() as usize, view["byteOffset"].as_u64().unwrap() as usize)
    };
    let (count, at) = view("COLOR_0");
    // A corner for each of 24 flat triangles.
    assert_eq!(count, 72);
    let colors = bytes[at..at + 8 * count].chunks_exact(8).map(|color| {
        [0, 2, 4].map(|i| (f64::from(u16::from_le_bytes([color[i], color[i + 1]])) / 655.35).round() as i32)
    });
    let colors: std::collections::BTreeSet<[i32; 3]> = colors.collect();
    assert_eq!(colors, [[5, 40, 10], [30, 10, 5]].into_iter().collect());
    // The file is read, and nothing replaces it.
    let (done, said) = run(folder.path(), &[&["instances", "a.ron", "-o", "oak.glb"], &place[..]].concat());
    assert!(!done && said.contains("a mesh that the planet reads, which would be lost"), "{said}");
    // Objects of a form that a game draws carry the name of its asset.
    write_preset(folder.path(), "Game(asset: \"hut_a\", width: 1.0)");
    let (document, _) = objects("huts.glb");
    let node = document["nodes"].as_array().unwrap().iter().find(|node| node["extras"]["kind"] == "Oak").unwrap();
    assert_eq!(node["extras"]["asset"], "hut_a");
}
