//! Texture sets of biomes on the command line: pictures, warnings, samples.

use crate::textures_of::{even, stripes};
use std::path::Path;
use tellus::planet::VERSION;

/// Runs in a folder. Exit status, standard output and standard error.
fn run(folder: &Path, args: &[&str]) -> (i32, String, String) {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
    let output = command.env("TELLUS_MAPS", "").current_dir(folder).args(args).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap_or(-1), text(output.stdout), text(output.stderr))
}

fn preset(folder: &Path, name: &str, textures: &str) {
    let biome = format!("(key: 'a', detail: Gravel, color: (0.3, 0.3, 0.3),\n textures: {textures:?})");
    let biomes = format!("(palette: [{biome}], table: [\"aa\", \"aa\"])");
    let text = format!("(version: {VERSION}, radius_km: 100.0, biomes: {biomes}, layers: [], star: ())");
    std::fs::write(folder.join(name), text).unwrap();
}

/// The picture of a preset from 2 m, and what was said.
fn render(folder: &Path, preset: &str) -> (Vec<u8>, String) {
    let place = ["--lat", "3", "--lon", "4", "--altitude", "2", "--pitch", "-60", "--sun", "3,40"];
    let args = [&["render", preset, "-o", "a.png", "--size", "64x36", "--quality", "low"], &place[..]].concat();
    let (status, _, said) = run(folder, &args);
    assert_eq!(status, 0, "{said}");
    (std::fs::read(folder.join("a.png")).unwrap(), said)
}

#[test]
fn a_picture_has_the_textures_and_a_missing_set_is_a_warning() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("rock_color.png"), stripes()).unwrap();
    preset(folder, "with.ron", "rock_color.png");
    preset(folder, "gone.ron", "gone_color.png");
    preset(folder, "without.ron", "");
    let [(with, quiet), (gone, warning), (without, _)] =
        ["with.ron", "gone.ron", "without.ron"].map(|preset| render(folder, preset));
    assert!(!quiet.contains("warning"), "{quiet}");
    let told = "gone.ron:2:12: biomes.palette[0].textures: there is no file";
    assert!(warning.contains("warning: ") && warning.contains(told), "{warning}");
    assert!(warning.contains("gone_color.png; put the picture there or correct the path"), "{warning}");
    assert!(with != without, "the textures do not show");
    assert!(gone == without, "without its textures the biome has its pattern");
}

#[test]
fn a_check_warns_and_a_sample_names_the_set() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    std::fs::write(folder.join("rock_color.png"), stripes()).unwrap();
    std::fs::write(folder.join("rock_normal.png"), "a normal map").unwrap();
    preset(folder, "a.ron", "rock_color.png");
    let (status, said, warning) = run(folder, &["check", "a.ron"]);
    assert_eq!((status, said.as_str()), (0, "a.ron: valid\n"));
    assert!(warning.contains("rock_normal.png is neither PNG, JPEG nor OpenEXR"), "{warning}");
    let sample = || {
        let (status, said, why) = run(folder, &["sample", "a.ron", "--lat", "3", "--lon", "4", "--json"]);
        assert_eq!(status, 0, "{why}");
        serde_json::from_str::<serde_json::Value>(&said).unwrap()["material"].clone()
    };
    assert_eq!(sample()["textures"], serde_json::Value::Null);
    std::fs::write(folder.join("rock_normal.png"), even(128)).unwrap();
    assert_eq!((&sample()["textures"], &sample()["detail"]), (&"rock_color.png".into(), &"Gravel".into()));
}
