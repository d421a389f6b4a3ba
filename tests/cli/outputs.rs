//! Outputs of commands: none replaces an input, follows a link of others, or becomes a folder called `s3:`.

use assert_cmd::Command;
use std::collections::BTreeMap;
use std::fs;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::time::Duration;

fn run(folder: &Path, args: &[&str]) -> (i32, String) {
    run_with_maps(folder, "", args)
}

/// `maps`: the folder of solved maps.
fn run_with_maps(folder: &Path, maps: &str, args: &[&str]) -> (i32, String) {
    let mut command: Command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
    command.env("TELLUS_MAPS", maps).current_dir(folder).args(args).timeout(Duration::from_secs(120));
    let output = command.output().unwrap();
    (output.status.code().unwrap_or(-1), String::from_utf8(output.stderr).unwrap())
}

fn grey(path: &Path) {
    let mut encoder = png::Encoder::new(fs::File::create(path).unwrap(), 16, 8);
    encoder.set_color(png::ColorType::Grayscale);
    encoder.write_header().unwrap().write_image_data(&[90; 128]).unwrap();
}

/// A folder with a preset that reads pictures named like outputs, and a system.
fn inputs() -> tempfile::TempDir {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let pictures = ["height.png", "height_pos_x.png", "m_pos_x_albedo.png", "way-0002.png"];
    fs::create_dir(at("maps")).unwrap();
    let mut layers = String::new();
    for name in pictures {
        grey(&at("maps").join(name));
        // Some are links: their targets are what is read.
        symlink(at("maps").join(name), at(name)).unwrap();
        layers += &format!("(name: \"{name}\", shape: HeightMap(file: \"{name}\")),\n");
    }
    let notes = "editor: (bookmarks: [(name: \"A\"), (name: \"B\", latitude_deg: 5)])";
    let edits = "edits: \"mine.edits-0123456789abcdef.ron\"";
    let preset = format!("(version: 3, radius_km: 100.0, layers: [{layers}], star: (), {edits}, {notes})");
    let list = "(version: 3, edits: [(tool: Volcano(), points: [(1, 2)])])";
    fs::write(at("mine.edits-0123456789abcdef.ron"), list).unwrap();
    for name in ["mine.ron", "mine.geojson", "mine.png", "m.mtl", "tileset.json"] {
        fs::write(at(name), &preset).unwrap();
    }
    let system = "(version: 1, name: \"Small\", bodies: [(name: \"S\", mass_earths: 3e5, light: ()), \
                  (name: \"One\", preset: \"mine.ron\", parent: \"S\", mass_earths: 0.01, orbit: ())])";
    for name in ["system.ron", "system.png"] {
        fs::write(at(name), system).unwrap();
    }
    symlink("mine.ron", at("link.ron")).unwrap();
    symlink("mine.ron", at("link.geojson")).unwrap();
    folder
}

/// Every file by its path, with its content and whether it is a link.
fn snapshot(folder: &Path) -> BTreeMap<String, (Vec<u8>, bool)> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(Result::unwrap) {
        let name = entry.file_name().to_string_lossy().into_owned();
        match entry.path().is_dir() {
            true => {
                found
                    .extend(snapshot(&entry.path()).into_iter().map(|(below, what)| (format!("{name}/{below}"), what)));
            }
            false => drop(found.insert(name, (fs::read(entry.path()).unwrap(), entry.path().is_symlink()))),
        }
    }
    found
}

#[test]
fn no_output_replaces_an_input() {
    let folder = inputs();
    let before = snapshot(folder.path());
    let coarse = ["--spacing", "20000"];
    let small = ["--size", "16"];
    for (args, more) in [
        (["coasts", "mine.geojson", "-o", "mine.geojson"], &["--height", "1"][..]),
        (["coasts", "mine.ron", "-o", "link.geojson"], &["--height", "1"]),
        (["instances", "mine.geojson", "-o", "mine.geojson"], &["--lat", "1", "--lon", "1"]),
        (["render", "mine.ron", "-o", "height.png"], &["--size", "16x16"]),
        (["render", "mine.ron", "-o", "maps/height.png"], &["--size", "16x16"]),
        (["render", "mine.png", "-o", "mine.png"], &["--size", "16x16"]),
        (["render", "system.png", "-o", "system.png"], &["--body", "One", "--size", "16x16"]),
        (["render", "system.ron", "-o", "height.png"], &["--body", "One", "--size", "16x16"]),
        (["film", "mine.ron", "-o", "way.png"], &["--seconds", "1", "--size", "16x16"]),
        (["bake", "mine.ron", "-o", "."], &small),
        (["bake", "link.ron", "-o", "maps"], &small),
        (["bake", "mine.ron", "-o", "maps/.."], &["--size", "16", "--as", "cube"]),
        (["mesh", "mine.ron", "-o", "m.obj"], &["--spacing", "20000", "--texture", "16"]),
        (["mesh", "m.mtl", "-o", "m.obj"], &coarse),
        (["tiles", "tileset.json", "-o", "."], &["--levels", "0", "--cells", "4"]),
        (["new", "--from=mine.ron", "-o", "mine.ron"], &["--force"]),
        (["new", "--from=mine.ron", "-o", "link.ron"], &["--force"]),
        (["new", "--from=mine.ron", "-o", "mine.edits-0123456789abcdef.ron"], &["--force"]),
    ] {
        let args = [&args[..], more].concat();
        let (status, told) = run(folder.path(), &args);
        let is_said = told.contains("which would be lost; write to another file");
        assert!(status == 1 && is_said, "{args:?}: {status} {told}");
        assert!(snapshot(folder.path()) == before, "{args:?}: something has changed");
    }
    // The same work beside is done.
    fs::create_dir(folder.path().join("out")).unwrap();
    for args in [
        &["coasts", "mine.ron", "-o", "out/c.geojson", "--height", "1", "--spacing", "20000"][..],
        &["bake", "mine.ron", "-o", "out", "--size", "16"],
        &["new", "-o", "out/new.ron", "--from", "mine.ron"],
    ] {
        let (status, told) = run(folder.path(), args);
        assert_eq!((status, told.as_str()), (0, ""), "{args:?}");
    }
}

#[test]
fn outputs_have_their_ending_and_new_planets_replace_none() {
    let folder = inputs();
    let before = snapshot(folder.path());
    for (args, part) in [
        (["coasts", "mine.ron", "-o", "mine.ron"], "use .geojson or .json"),
        (["rivers", "mine.ron", "-o", "rivers.txt"], "use .geojson or .json"),
        (["new", "-o", "planet", "--seed=1"], "use .ron"),
        (["new", "-o", "system.ron", "--seed=1"], "replace it with --force"),
        (["new", "-o", "link.ron", "--seed=1"], "replace it with --force"),
    ] {
        let (status, told) = run(folder.path(), &args);
        assert!(status == 1 && told.contains(part), "{args:?}: {told}");
        assert!(snapshot(folder.path()) == before, "{args:?}: something has changed");
    }
    let (status, told) = run(folder.path(), &["new", "-o", "system.ron", "--seed=1", "--force"]);
    assert_eq!((status, told.as_str()), (0, ""));
}

#[test]
fn an_address_is_no_folder() {
    let folder = inputs();
    let before = snapshot(folder.path());
    for args in [
        &["bake", "mine.ron", "-o", "s3://bucket/x"][..],
        &["tiles", "mine.ron", "-o", "s3://bucket/x"],
        &["maps", "mine.ron", "-o", "gs://bucket"],
        &["mesh", "mine.ron", "-o", "s3://bucket/x.glb"],
        &["coasts", "mine.ron", "-o", "https://a/b.geojson", "--height", "1"],
        &["render", "mine.ron", "-o", "file:///tmp/x.png"],
        &["new", "-o", "s3://bucket/x.ron"],
    ] {
        let (status, told) = run(folder.path(), args);
        assert!(status == 1 && told.contains("is an address, not a place on this computer"), "{args:?}: {told}");
        assert!(snapshot(folder.path()) == before, "{args:?}: something has changed");
    }
}

/// The place of the output is looked at before a structure is solved, which would write its maps.
#[test]
fn a_wrong_place_is_said_before_the_work() {
    let folder = tempfile::tempdir().unwrap();
    let aurel = Path::new(env!("CARGO_MANIFEST_DIR")).join("planets/aurel.ron");
    let aurel = aurel.to_str().unwrap();
    fs::write(folder.path().join("file"), "").unwrap();
    for (args, part) in [
        (&["rivers", aurel, "-o", "none/r.geojson"][..], "there is no folder none"),
        (&["coasts", aurel, "-o", "none/c.geojson"], "there is no folder none"),
        (&["mesh", aurel, "-o", "none/m.glb"], "there is no folder none"),
        (&["render", aurel, "-o", "none/p.png"], "there is no folder none"),
        (&["film", aurel, "-o", "none/p.png"], "there is no folder none"),
        (&["bake", aurel, "-o", "file/maps"], "file is no folder"),
        (&["tiles", aurel, "-o", "file"], "is a file; name a folder"),
        (&["maps", aurel, "-o", "file"], "is a file; name a folder"),
    ] {
        let (status, told) = run_with_maps(folder.path(), "solved", args);
        assert!(status == 1 && told.contains(part), "{args:?}: {told}");
    }
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1, "nothing was solved and nothing made");
}

/// Of a preset behind a link, pictures and edits are beside the preset, where a save also goes.
#[test]
fn all_that_a_linked_preset_names_is_beside_the_preset() {
    let folder = inputs();
    let at = |name: &str| folder.path().join(name);
    fs::create_dir_all(at("mods/mine")).unwrap();
    symlink(at("mine.ron"), at("mods/mine/linked.ron")).unwrap();
    symlink(at("system.ron"), at("mods/system.ron")).unwrap();
    symlink("system.ron", at("mods/again.ron")).unwrap();
    let linked = ["mods/mine/linked.ron", "mods/system.ron", "mods/again.ron"];
    let (status, told) = run(folder.path(), &[&["check"][..], &linked].concat());
    assert_eq!((status, told.as_str()), (0, ""));
    let planet = tellus::planet::Planet::load(at("mods/mine/linked.ron")).unwrap();
    planet.save(at("mods/mine/linked.ron")).unwrap();
    assert!(at("mods/mine/linked.ron").is_symlink());
    let text = fs::read_to_string(at("mine.ron")).unwrap();
    assert!(text.contains("file: \"height.png\""), "{text}");
    assert_eq!(run(folder.path(), &[&["check"][..], &linked].concat()).0, 0);
    // A link that was made before its preset: the paths are those of the place to which it leads.
    symlink(at("later.ron"), at("mods/later.ron")).unwrap();
    planet.save(at("mods/later.ron")).unwrap();
    assert!(fs::read_to_string(at("later.ron")).unwrap().contains("file: \"height.png\""));
    // Where the links are, nothing has been put.
    assert_eq!(fs::read_dir(at("mods/mine")).unwrap().count(), 1);
}
