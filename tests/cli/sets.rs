//! Sets of files that are made part by part: what is damaged is made anew, what is done is not done again, and a set
//! that cannot be completed leaves the old one alone. Threads and progress of long work.

use crate::LAYERED;
use crate::bake::{command, run};
use serde_json::Value;
use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

fn text_of(path: &Path) -> &str {
    path.to_str().unwrap()
}

/// All files under a folder with their bytes.
fn files(folder: &Path) -> BTreeMap<PathBuf, Vec<u8>> {
    let mut found = BTreeMap::new();
    for entry in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        if entry.is_dir() {
            found.append(&mut files(&entry));
        } else {
            found.insert(entry.clone(), fs::read(&entry).unwrap());
        }
    }
    found
}

fn names(folder: &Path) -> Vec<String> {
    let mut names: Vec<_> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

const NOTHING: &str = "the maps are there already, whole, and made by this bake: nothing was done\n";

#[test]
fn a_strip_with_damaged_values_is_not_joined() {
    let root = tempfile::tempdir().unwrap();
    let (whole, damaged) = (root.path().join("whole"), root.path().join("damaged"));
    let bake = |folder: &Path, more: &[&str]| {
        run(&[&["bake", LAYERED, "-o", text_of(folder), "--size", "256", "--what", "height,normal"], more].concat())
    };
    assert_eq!(bake(&whole, &[]), (0, String::new()));
    assert_eq!(bake(&damaged, &["--shard", "1/1"]).0, 0);
    let strips = fs::read_dir(&damaged).unwrap().next().unwrap().unwrap().path();
    let second = strips.join("00001.strip");
    let mut bytes = fs::read(&second).unwrap();
    bytes[5000..5064].fill(0x3f);
    fs::write(&second, bytes).unwrap();
    assert_eq!(bake(&damaged, &[]), (0, String::new()));
    let bytes = |folder: &Path| -> Vec<Vec<u8>> { files(folder).into_values().collect() };
    assert!(bytes(&damaged) == bytes(&whole) && names(&damaged) == names(&whole));
}

#[test]
fn a_finished_bake_does_nothing_and_says_so_and_a_late_shard_neither() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let bake = |more: &[&str]| {
        run(&[&["bake", LAYERED, "-o", text_of(folder), "--size", "128", "--what", "height,slope"], more].concat())
    };
    assert_eq!(bake(&[]), (0, String::new()));
    let whole = files(folder);
    let about: Value = serde_json::from_slice(&fs::read(folder.join("height.json")).unwrap()).unwrap();
    assert_eq!(about["detail"], "pixel");
    let sum = crc32(&whole[&folder.join("height.png")]);
    assert_eq!(about["crc32"], format!("{sum:08x}"));
    assert!(about["algorithm_version"].is_number() && about["identity"].as_str().map(str::len) == Some(32));
    let modified = || fs::metadata(folder.join("height.png")).unwrap().modified().unwrap();
    let before = modified();
    assert_eq!(bake(&[]), (0, NOTHING.to_owned()));
    assert_eq!(bake(&["--shard", "2/3"]), (0, NOTHING.to_owned()));
    assert_eq!(
        (names(folder), modified()),
        (vec!["height.json".into(), "height.png".into(), "slope.json".into(), "slope.png".into()], before)
    );
    // A picture or what is said of it is not as it was written.
    for name in ["slope.png", "height.json"] {
        let path = folder.join(name);
        let text = fs::read(&path).unwrap();
        fs::write(&path, [&text[..text.len() / 2], &text[text.len() / 2 + 1..]].concat()).unwrap();
        assert_eq!(bake(&[]), (0, String::new()));
        assert!(files(folder) == whole);
    }
    let json = fs::read_to_string(folder.join("height.json")).unwrap();
    fs::write(folder.join("height.json"), json.replacen("\"max_m\": ", "\"max_m\": 1", 1)).unwrap();
    assert_eq!(bake(&[]), (0, String::new()));
    assert!(files(folder) == whole);
}

/// CRC-32 (ISO 3309), bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum: u32, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| sum >> 1 ^ if sum & 1 == 1 { 0xedb8_8320 } else { 0 })
    })
}

#[test]
fn tiles_that_are_done_are_said_to_be() {
    let folder = tempfile::tempdir().unwrap();
    let args = ["tiles", LAYERED, "-o", text_of(folder.path()), "--levels", "0", "--cells", "8"];
    assert_eq!(run(&args), (0, String::new()));
    let whole = files(folder.path());
    let (status, told) = run(&args);
    assert!(status == 0 && told.contains("the tiles are there already") && files(folder.path()) == whole, "{told}");
}

/// What should be a file may be a pipe, which nobody writes to, or endless.
#[cfg(unix)]
#[test]
fn parts_that_are_no_files_are_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let made = |path: &Path| assert!(std::process::Command::new("mkfifo").arg(path).status().unwrap().success());
    let (tiles, maps) = (folder.path().join("tiles"), folder.path().join("maps"));
    fs::create_dir(&tiles).unwrap();
    made(&tiles.join("tiles.key"));
    let (status, told) = run(&["tiles", LAYERED, "-o", text_of(&tiles), "--levels", "0", "--cells", "8"]);
    assert!(status == 1 && told.contains("tiles.key: is a device or a pipe"), "{told}");
    let bake = |more: &[&str]| run(&[&["bake", LAYERED, "-o", text_of(&maps), "--size", "32"], more].concat());
    assert_eq!(bake(&["--shard", "1/1"]).0, 0);
    let strips = fs::read_dir(&maps).unwrap().next().unwrap().unwrap().path();
    fs::remove_file(strips.join("00002.strip")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", strips.join("00002.strip")).unwrap();
    let (status, told) = bake(&[]);
    assert!(status == 1 && told.contains("00002.strip: is a device or a pipe"), "{told}");
    fs::remove_dir_all(&maps).unwrap();
    fs::create_dir(&maps).unwrap();
    made(&maps.join("height.json"));
    let (status, told) = bake(&[]);
    assert!(status == 1 && told.contains("height.json: is a device or a pipe"), "{told}");
}

/// A limit on the size of files stands for a full disk: textures are below it, the mesh is not.
#[cfg(unix)]
#[test]
fn a_mesh_that_does_not_fit_leaves_the_old_set_as_it_was() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("m.obj");
    let mesh = |spacing: &'static str| ["mesh", LAYERED, "-o", text_of(&path), "--texture", "16", "--spacing", spacing];
    assert_eq!(run(&mesh("3000000")), (0, String::new()));
    let old = files(folder.path());
    assert_eq!(old.len(), 20);
    let text = String::from_utf8(old[&path].clone()).unwrap();
    for name in ["m.mtl", "m_pos_x_albedo.png", "m_neg_z_roughness.png"] {
        let sum = crc32(&old[&folder.path().join(name)]);
        assert!(text.contains(&format!("# crc32 of {name}: \"{sum:08x}\"")), "{name}");
    }
    let script = format!("trap '' XFSZ; ulimit -f 64; exec \"$0\" {}", mesh("400000").join(" "));
    let mut shell = std::process::Command::new("bash");
    shell.args(["-c", &script, env!("CARGO_BIN_EXE_tellus")]).current_dir(env!("CARGO_MANIFEST_DIR"));
    let output = shell.output().unwrap();
    let told = String::from_utf8(output.stderr).unwrap();
    assert!(output.status.code() == Some(1) && told.contains("m.obj: cannot write: File too large"), "{told}");
    assert!(files(folder.path()) == old);
}

#[test]
fn threads_and_progress_are_as_asked_for() {
    let root = tempfile::tempdir().unwrap();
    let bake = |name: &str, more: &[&str]| {
        let folder = root.path().join(name);
        let ended = run(&[&["bake", LAYERED, "-o", text_of(&folder), "--size", "128"], more].concat());
        (ended, files(&folder).into_values().collect::<Vec<_>>())
    };
    let ((status, told), one) = bake("one", &["--threads", "1", "--progress", "json"]);
    let lines: Vec<Value> = told.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    assert!(status == 0 && lines.iter().any(|line| line["progress"] == "baked"), "{told}");
    let shares: Vec<f64> =
        lines.iter().filter(|line| line["progress"] == "baked").map(|line| line["share"].as_f64().unwrap()).collect();
    assert!(shares.is_sorted() && shares.last() == Some(&1.0), "{shares:?}");
    assert!(lines.iter().all(|line| line["elapsed_s"].is_number() && line.get("left_s").is_some()));
    let (ended, three) = bake("three", &["--threads", "3", "--progress", "none"]);
    assert!(ended == (0, String::new()) && three == one);
    let (status, told) = run(&["bake", LAYERED, "-o", text_of(&root.path().join("no")), "--threads", "0"]);
    assert!(status == 2 && told.contains("use 1 to 1024"), "{told}");
}

#[test]
fn heights_alone_are_those_of_samples_in_the_order_of_the_points() {
    let folder = tempfile::tempdir().unwrap();
    let rills = folder.path().join("rills.ron");
    fs::write(&rills, "(version: 3, name: \"Rills\", structure: (grids: 1), water: (level_m: 0))").unwrap();
    let points: String = (0..300).map(|i| format!("{},{}\n", i * 37 % 179 - 89, i * 101 % 360 - 180)).collect();
    let file = folder.path().join("points.csv");
    fs::write(&file, format!("# points\n{points}\n")).unwrap();
    for preset in [LAYERED, text_of(&rills)] {
        let sampled = |points: &str, more: &[&str]| {
            let mut sample = command(&[&["sample", preset, "--points", points], more].concat());
            let output = sample.write_stdin(format!("{points}\n")).output().unwrap();
            assert_eq!((output.status.code(), output.stderr), (Some(0), Vec::new()));
            String::from_utf8(output.stdout).unwrap()
        };
        let (all, heights) = (sampled(text_of(&file), &[]), sampled(text_of(&file), &["--heights"]));
        assert_eq!((all.lines().count(), heights.lines().count()), (300, 300));
        for (all, height_m) in all.lines().zip(heights.lines()) {
            // The number of the object, digit for digit.
            assert!(all.contains(&format!("\"height_m\":{height_m}")), "{height_m}: {all}");
        }
    }
    let refused = |args: &[&str], status: i32, part: &str| {
        let (code, told) = run(&[&["sample"], args].concat());
        assert!(code == status && told.contains(part), "{told}");
    };
    refused(&[LAYERED, "--lat", "1", "--lon", "2", "--heights"], 2, "cannot be used with");
    refused(&["planets/garland.ron", "--points", text_of(&file), "--heights"], 1, "it has no ground");
}

/// All detail of a structure is what samples answer, in whatever order pixels are asked.
#[test]
fn all_detail_is_what_samples_answer() {
    let folder = tempfile::tempdir().unwrap();
    let rills = folder.path().join("rills.ron");
    fs::write(&rills, "(version: 3, name: \"Rills\", structure: (grids: 1), water: (level_m: 0))").unwrap();
    let maps = folder.path().join("maps");
    let bake = |more: &[&str]| {
        let args = [
            "bake",
            text_of(&rills),
            "-o",
            text_of(&maps),
            "--size",
            "24",
            "--format",
            "exr",
            "--what",
            "height,water_depth",
        ];
        assert_eq!(run(&[&args[..], &["--progress", "none"], more].concat()).0, 0);
        crate::decode::exr(&fs::read(maps.join("height.exr")).unwrap())
    };
    let (all, pixel) = (bake(&["--detail", "all"]), bake(&[]));
    assert!(all.numbers != pixel.numbers);
    let place = |i: usize| (90.0 - ((i / 24) as f64 + 0.5) * 15.0, ((i % 24) as f64 + 0.5) * 15.0 - 180.0);
    let places: Vec<_> = (0..288).map(place).collect();
    for (answer, found) in crate::bake::sampled_of(text_of(&rills), &places).iter().zip(&all.numbers) {
        let wanted = answer["height_m"].as_f64().unwrap();
        assert!((wanted - found).abs() <= wanted.abs() * 1e-7 + 1e-9, "{wanted} {found}");
    }
}
