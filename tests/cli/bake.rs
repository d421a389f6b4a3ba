//! `tellus bake`: every kind of file against `tellus sample`, through readers of its own; interruptions, shards, and
//! what cannot be written.

use crate::{LAYERED, decode};
use decode::Picture;
use serde_json::Value;
use std::collections::BTreeMap;
use std::f64::consts::FRAC_PI_2;
use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::time::{Duration, Instant};
use tellus::sphere::LatLon;
use tellus::sphere::geo::east_north;

pub(crate) fn command(args: &[&str]) -> assert_cmd::Command {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
    command.env("TELLUS_MAPS", "").current_dir(env!("CARGO_MANIFEST_DIR")).args(args);
    command
}

pub(crate) fn run(args: &[&str]) -> (i32, String) {
    let output = command(args).output().unwrap();
    assert_eq!(output.stdout, b"");
    (output.status.code().unwrap_or(-1), String::from_utf8(output.stderr).unwrap())
}

/// Bakes into a folder, without a word.
fn bake(folder: &Path, more: &[&str]) {
    let args = [&["bake", LAYERED, "-o", folder.to_str().unwrap()], more].concat();
    assert_eq!(run(&args), (0, String::new()));
}

fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    entries.map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())).collect()
}

fn about(folder: &Path, name: &str) -> Value {
    serde_json::from_slice(&fs::read(folder.join(format!("{name}.json"))).unwrap()).unwrap()
}

/// The answers of `tellus sample` at locations.
pub(crate) fn sampled(places: &[(f64, f64)]) -> Vec<Value> {
    sampled_of(LAYERED, places)
}

/// The same of a preset.
pub(crate) fn sampled_of(preset: &str, places: &[(f64, f64)]) -> Vec<Value> {
    let mut input = String::new();
    for (lat, lon) in places {
        writeln!(input, "{lat},{lon}").unwrap();
    }
    let output = command(&["sample", preset, "--points", "-"]).write_stdin(input).output().unwrap();
    assert_eq!(output.stderr, b"");
    String::from_utf8(output.stdout).unwrap().lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// A thousand pixels of a picture, the corners among them.
pub(crate) fn pixels(width: usize, height: usize) -> Vec<(usize, usize)> {
    let corners = [(0, 0), (width - 1, 0), (0, height - 1), (width - 1, height - 1)];
    let spread = (0..996_usize).map(|i| (i * 7919 % width, (i * 104_729 + i * i) % height));
    corners.into_iter().chain(spread).collect()
}

fn equirect(width: usize, height: usize, (x, y): (usize, usize)) -> (f64, f64) {
    let lon = (x as f64 + 0.5) * 360.0 / width as f64 - 180.0;
    (90.0 - (y as f64 + 0.5) * 180.0 / height as f64, lon)
}

/// What `tellus sample` says of a map.
pub(crate) fn expected(map: &str, answer: &Value, palette: &[Value], place: (f64, f64)) -> Vec<f64> {
    let number = |key: &str| answer[key].as_f64().unwrap_or_else(|| panic!("{key}: {answer}"));
    let normal = || -> Vec<f64> { answer["normal"].as_array().unwrap().iter().map(|n| n.as_f64().unwrap()).collect() };
    match map {
        "height" => vec![number("height_m")],
        "slope" => vec![number("slope_deg")],
        "temperature" => vec![number("temperature_c")],
        "precipitation" => vec![number("precipitation_mm")],
        "rain" => vec![number("rain_mm")],
        "water_depth" => vec![answer["water_level_m"].as_f64().map_or(0.0, |level_m| level_m - number("height_m"))],
        "normal_planet" => normal(),
        "normal" => {
            let dir = LatLon::from_degrees(place.0, place.1).direction();
            let (east, north) = east_north(dir);
            let normal = tellus::glam::DVec3::from_slice(&normal());
            vec![normal.dot(east), normal.dot(north), normal.dot(dir)]
        }
        "biome" => {
            let id = palette.iter().position(|biome| biome["name"] == answer["biome"]).unwrap();
            vec![id as f64]
        }
        other => vec![number(other)],
    }
}

/// Checks a map of the globe at many pixels. `value`: of a number of the file; `near`: how close it must be to a value.
fn check(folder: &Path, map: &str, picture: &Picture, value: impl Fn(f64) -> f64, near: impl Fn(f64) -> f64) {
    let about = about(folder, map);
    assert_eq!((about["width"].as_u64(), about["height"].as_u64()), (Some(96), Some(48)));
    assert_eq!((picture.width, picture.height), (96, 48));
    let palette = about["palette"].as_array().cloned().unwrap_or_default();
    let pixels = pixels(96, 48);
    let places: Vec<_> = pixels.iter().map(|&pixel| equirect(96, 48, pixel)).collect();
    for ((answer, &(x, y)), place) in sampled(&places).iter().zip(&pixels).zip(places) {
        let wanted = expected(map, answer, &palette, place);
        assert_eq!(wanted.len(), picture.channels);
        for (&number, wanted) in picture.at(x, y).iter().zip(wanted) {
            let found = value(number);
            assert!((found - wanted).abs() <= near(wanted), "{map} at {x},{y}: {found}, not {wanted}");
        }
    }
}

/// Floats of 32 bits are as near as they can be.
fn float(value: f64) -> f64 {
    value.abs() * 1e-7 + 1e-12
}

/// Least and greatest value of the sidecar, and half a step of numbers up to `top`. Strips hold floats of 32 bits,
/// which adds a little.
fn steps(folder: &Path, map: &str, top: f64) -> (f64, f64, f64) {
    let about = about(folder, map);
    let [min, max] = ["min", "max"].map(|key| about[key].as_f64().unwrap());
    let half = 0.5 * (max - min) / top;
    (min, max, half + 1e-7 * min.abs().max(max.abs()))
}

const MAPS: [&str; 13] = [
    "height",
    "normal",
    "normal_planet",
    "slope",
    "temperature",
    "precipitation",
    "moisture",
    "rain",
    "biome",
    "water_depth",
    "cloud_cover",
    "veil_cover",
    "fog_cover",
];

#[test]
fn png_holds_what_the_evaluator_answers() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    for (format, top) in [("png8", 255.0), ("png16", 65_535.0)] {
        bake(folder, &["--what", &MAPS.join(","), "--size", "96", "--format", format]);
        assert_eq!(files(folder).len(), 2 * MAPS.len());
        for map in MAPS {
            let (picture, _) = decode::png(&fs::read(folder.join(format!("{map}.png"))).unwrap());
            let (min, max, half) = steps(folder, map, top);
            check(folder, map, &picture, |number| min + number / top * (max - min), |_| half);
        }
    }
    // The range is that of the map.
    let (picture, _) = decode::png(&fs::read(folder.join("height.png")).unwrap());
    let extremes = picture.numbers.iter().fold((f64::MAX, 0.0_f64), |(lo, hi), &n| (lo.min(n), hi.max(n)));
    assert_eq!(extremes, (0.0, 65_535.0));
    let about = about(folder, "height");
    for (key, value) in [("unit", "m"), ("projection", "equirect"), ("planet", "Layered"), ("encoding", "linear")] {
        assert_eq!(about[key], value, "{key}");
    }
    assert_eq!((&about["min"], &about["max"]), (&about["min_m"], &about["max_m"]));
    assert_eq!(about["radius_m"], 6_371_000.0);
    assert!(about["sea_level_m"].is_number() && about["algorithm_version"].is_number(), "{about}");
    assert_eq!(about["preset_hash"].as_str().map(str::len), Some(32));
}

#[test]
fn floats_and_raw_numbers_hold_what_the_evaluator_answers() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let some = ["height", "normal_planet", "biome", "temperature"];
    let read = |map: &str, ending: &str| fs::read(folder.join(format!("{map}.{ending}"))).unwrap();
    for format in ["exr", "exr16", "tiff", "tiff16"] {
        bake(folder, &["--what", &some.join(","), "--size", "96", "--format", format]);
        for map in some {
            let (min, max, half) = steps(folder, map, 65_535.0);
            match format {
                "exr" => check(folder, map, &decode::exr(&read(map, "exr")), |value| value, float),
                // Half of the last of eleven bits.
                "exr16" => {
                    let near = |value: f64| value.abs() / 2048.0 + 1e-7;
                    check(folder, map, &decode::exr(&read(map, "exr")), |value| value, near);
                }
                "tiff" => check(folder, map, &decode::tiff(&read(map, "tif")).0, |value| value, float),
                _ => {
                    let picture = decode::tiff(&read(map, "tif")).0;
                    check(folder, map, &picture, |number| min + number / 65_535.0 * (max - min), |_| half);
                }
            }
        }
    }
    bake(folder, &["--size", "96", "--format", "r16"]);
    let (min, max, half) = steps(folder, "height", 65_535.0);
    let picture = decode::r16(&read("height", "r16"), 96, 48);
    check(folder, "height", &picture, |number| min + number / 65_535.0 * (max - min), |_| half);
}

#[test]
fn colours_are_those_of_the_palette() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    bake(folder, &["--what", "albedo,biome,roughness", "--size", "96", "--format", "png8"]);
    let [(albedo, chunks), (biome, _)] =
        ["albedo", "biome"].map(|map| decode::png(&fs::read(folder.join(format!("{map}.png"))).unwrap()));
    assert!(chunks.contains(&"sRGB".to_owned()), "{chunks:?}");
    assert_eq!(about(folder, "albedo")["encoding"], "srgb");
    let about = about(folder, "biome");
    assert_eq!(about["encoding"], "numbers");
    let pixels = pixels(96, 48);
    let places: Vec<_> = pixels.iter().map(|&pixel| equirect(96, 48, pixel)).collect();
    let answers = sampled(&places);
    // Where water stands over the ground, it has a share in the colour.
    let dry = answers.iter().zip(&pixels).filter(|(answer, _)| answer["water_level_m"].is_null());
    assert!(dry.clone().count() > 5);
    for (_, &(x, y)) in dry {
        let entry = &about["palette"][biome.at(x, y)[0] as usize];
        for (k, number) in albedo.at(x, y).iter().enumerate() {
            let share = number / 255.0;
            let linear = if share <= 0.040_45 { share / 12.92 } else { ((share + 0.055) / 1.055).powf(2.4) };
            assert!((linear - entry["color"][k].as_f64().unwrap()).abs() < 0.005, "{entry}: {number}");
        }
    }
}

#[test]
fn faces_of_a_cube_are_those_of_a_cube_texture() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    bake(folder, &["--as", "cube", "--size", "24", "--format", "tiff"]);
    // The direction of a texel, as the specification of WebGPU has it (and OpenGL, Direct3D and Vulkan).
    type Texel = fn(f64, f64) -> [f64; 3];
    let faces: [(&str, Texel); 6] = [
        ("pos_x", |u, v| [1.0, -v, -u]),
        ("neg_x", |u, v| [-1.0, -v, u]),
        ("pos_y", |u, v| [u, 1.0, v]),
        ("neg_y", |u, v| [u, -1.0, -v]),
        ("pos_z", |u, v| [u, -v, 1.0]),
        ("neg_z", |u, v| [-u, -v, -1.0]),
    ];
    for (face, texel) in faces {
        let (picture, tags) = decode::tiff(&fs::read(folder.join(format!("height_{face}.tif"))).unwrap());
        assert_eq!((picture.width, picture.height), (24, 24));
        assert!(!tags.contains_key(&33_550), "a face of a cube is not georeferenced");
        assert_eq!(about(folder, &format!("height_{face}"))["face"], face);
        let pixels = pixels(24, 24);
        let place = |&(x, y): &(usize, usize)| {
            let [u, v] = [x, y].map(|at| (at as f64 + 0.5) / 12.0 - 1.0);
            LatLon::from_direction(tellus::glam::DVec3::from_array(texel(u, v))).to_degrees()
        };
        let places: Vec<_> = pixels.iter().map(place).collect();
        for (answer, &(x, y)) in sampled(&places).iter().zip(&pixels) {
            let (found, wanted) = (picture.at(x, y)[0], answer["height_m"].as_f64().unwrap());
            assert!((found - wanted).abs() < 0.01, "{face} {x},{y}: {found}, not {wanted}");
        }
    }
}

#[test]
fn regions_lie_where_their_georeference_says() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    let (lat, lon, km, side) = (-20.0_f64, 178.0_f64, 900.0, 40);
    let region = ["--as", "region", "--lat", "-20", "--lon", "178", "--km", "900", "--size", "40"];
    bake(folder, &[&region[..], &["--format", "tiff"]].concat());
    let (picture, tags) = decode::tiff(&fs::read(folder.join("height.tif")).unwrap());
    let pixel_m = km * 1000.0 / side as f64;
    assert_eq!(tags[&33_550], [pixel_m, pixel_m, 0.0]);
    assert_eq!(tags[&33_922], [0.0, 0.0, 0.0, -450_000.0, 450_000.0, 0.0]);
    assert_eq!(tags[&34_736], [6_371_000.0, 6_371_000.0, lat, lon, 0.0, 0.0]);
    let about = about(folder, "height");
    assert_eq!((&about["projection"], &about["pixel_m"]), (&"azimuthal_equidistant".into(), &pixel_m.into()));
    let pixels = pixels(side, side);
    // From the corner and the size of a pixel back to the globe (Snyder 1987, 25-14, 20-14 and 20-15).
    let place = |&(x, y): &(usize, usize)| {
        let east = tags[&33_922][3] + (x as f64 + 0.5) * pixel_m;
        let north = tags[&33_922][4] - (y as f64 + 0.5) * pixel_m;
        let away = east.hypot(north);
        let (sin, cos) = (away / tags[&34_736][0]).sin_cos();
        let (sin_lat, cos_lat) = lat.to_radians().sin_cos();
        let found_lat = (cos * sin_lat + north * sin * cos_lat / away).asin();
        let turn = (east * sin).atan2(away * cos_lat * cos - north * sin_lat * sin);
        let found_lon = (lon.to_radians() + turn).to_degrees();
        (found_lat.to_degrees(), if found_lon > 180.0 { found_lon - 360.0 } else { found_lon })
    };
    let places: Vec<_> = pixels.iter().map(place).collect();
    assert!(places.iter().any(|(_, lon)| *lon < 0.0) && places.iter().all(|(lat, _)| lat.to_radians() < FRAC_PI_2));
    for (answer, &(x, y)) in sampled(&places).iter().zip(&pixels) {
        let (found, wanted) = (picture.at(x, y)[0], answer["height_m"].as_f64().unwrap());
        assert!((found - wanted).abs() < 0.01, "{x},{y}: {found}, not {wanted}");
    }
}

/// The folder of strips in a folder.
fn strips(folder: &Path) -> Option<PathBuf> {
    let mut entries = fs::read_dir(folder).ok()?.map(|entry| entry.unwrap().path());
    entries.find(|path| path.extension().is_some_and(|extension| extension == "strips"))
}

fn strip_count(folder: &Path) -> usize {
    strips(folder).and_then(|strips| fs::read_dir(strips).ok()).map_or(0, |entries| {
        entries.filter(|entry| entry.as_ref().is_ok_and(|e| e.path().extension() == Some("strip".as_ref()))).count()
    })
}

#[test]
fn a_killed_bake_goes_on_and_shards_join_to_the_same_bytes() {
    let root = tempfile::tempdir().unwrap();
    let folder = |name: &str| root.path().join(name);
    let what = ["--what", "height,normal", "--size", "768"];
    bake(&folder("whole"), &what);
    let whole = files(&folder("whole"));
    assert_eq!(whole.len(), 4);
    // Killed among its strips.
    let killed = folder("killed");
    let mut child = Command::new(env!("CARGO_BIN_EXE_tellus"))
        .args([&["bake", LAYERED, "-o", killed.to_str().unwrap()], &what[..]].concat())
        .current_dir(env!("CARGO_MANIFEST_DIR"))
        .stderr(Stdio::null())
        .spawn()
        .unwrap();
    let begun = Instant::now();
    while strip_count(&killed) < 3 && begun.elapsed() < Duration::from_secs(20) {
        std::thread::sleep(Duration::from_millis(1));
    }
    child.kill().unwrap();
    child.wait().unwrap();
    assert!(strip_count(&killed) >= 3 && files_are_strips_only(&killed), "killed too late");
    bake(&killed, &what);
    assert!(files(&killed) == whole);
    // Shared by three, in any order, with others' strips in a folder of their own.
    let [one, two] = ["one", "two"].map(folder);
    let shard = |folder: &Path, shard: &str| {
        let args = [&["bake", LAYERED, "-o", folder.to_str().unwrap(), "--shard", shard], &what[..]].concat();
        run(&args)
    };
    let (status, told) = shard(&one, "3/3");
    assert!(status == 0 && told.contains("strips of others are not there yet"), "{told}");
    assert_eq!(shard(&two, "2/3").0, 0);
    let to = strips(&one).unwrap();
    for entry in fs::read_dir(strips(&two).unwrap()).unwrap() {
        let path = entry.unwrap().path();
        fs::copy(&path, to.join(path.file_name().unwrap())).unwrap();
    }
    let (status, told) = shard(&one, "1/3");
    assert!(status == 0 && told.contains("the same command without --shard joins them"), "{told}");
    bake(&one, &what);
    assert!(files(&one) == whole);
}

fn files_are_strips_only(folder: &Path) -> bool {
    fs::read_dir(folder).unwrap().all(|entry| entry.unwrap().path().is_dir())
}

#[test]
fn what_cannot_be_baked_or_written_is_said() {
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("out");
    let out_text = out.to_str().unwrap();
    let refused = |status: i32, more: &[&str], part: &str| {
        let found = run(&[&["bake", LAYERED, "-o", out_text], more].concat());
        assert!(found.0 == status && found.1.contains(part), "{found:?}");
        assert!(!out.exists(), "{more:?}");
    };
    refused(2, &["--size", "65538"], "65538 is out of range; use 2 to 65536");
    refused(2, &["--what", "heights"], "[possible values: height, normal,");
    refused(2, &["--format", "jpg"], "[possible values: png8, png16, exr,");
    refused(2, &["--as", "mercator"], "[possible values: equirect, cube, region, landscape, quadtree]");
    refused(2, &["--as", "region"], "--lat <DEG>");
    refused(2, &["--shard", "4/3"], "write I/N with I from 1 to N");
    refused(2, &["--range", "5,1"], "write MIN,MAX in metres");
    refused(1, &["--size", "63"], "63 is odd");
    refused(1, &["--what", "height,discharge"], "Layered has no structure, so it has no rivers; leave it out");
    refused(1, &["--what", "normal", "--format", "r16"], "r16 holds one");
    refused(1, &["--lat", "5"], "--lat, --lon and --km are for --as region");
    refused(2, &["--as", "landscape"], "--lat <DEG>");
    refused(1, &["--tiles", "2"], "--tiles is for --as landscape");
    refused(1, &["--apron", "2"], "--levels and --apron are for --as quadtree");
    refused(1, &["--as", "quadtree", "--levels", "9"], "9 levels are out of range; use 0 to 7");
    let (status, told) = run(&["bake", "no.ron", "-o", out_text]);
    assert!(status == 1 && told.starts_with("error: no.ron: ") && !out.exists(), "{told}");
    let (status, told) = run(&["bake", LAYERED]);
    assert!(status == 2 && told.contains("--output <DIR>"), "{told}");
    // The folder is a file; a map's place is taken by a folder; an old map is read-only. Nothing is computed.
    fs::write(&out, "").unwrap();
    let small = ["bake", LAYERED, "-o", out_text, "--size", "32"];
    let (status, told) = run(&small);
    assert!(status == 1 && told.contains("out: is a file; name a folder"), "{told}");
    fs::remove_file(&out).unwrap();
    fs::create_dir_all(out.join("height.json")).unwrap();
    let (status, told) = run(&small);
    assert!(status == 1 && told.contains("height.json: is a folder; name a file in it"), "{told}");
    fs::remove_dir(out.join("height.json")).unwrap();
    fs::write(out.join("height.png"), "old").unwrap();
    let mut permissions = fs::metadata(out.join("height.png")).unwrap().permissions();
    permissions.set_readonly(true);
    fs::set_permissions(out.join("height.png"), permissions).unwrap();
    let (status, told) = run(&small);
    assert!(status == 1 && told.contains("height.png: is read-only"), "{told}");
    assert_eq!(files(&out), BTreeMap::from([("height.png".to_owned(), b"old".to_vec())]));
}

#[cfg(unix)]
#[test]
fn a_folder_that_cannot_be_written_is_said() {
    use std::os::unix::fs::PermissionsExt as _;
    let root = tempfile::tempdir().unwrap();
    let out = root.path().join("shut");
    fs::create_dir(&out).unwrap();
    fs::set_permissions(&out, fs::Permissions::from_mode(0o555)).unwrap();
    // Nothing is shut for the superuser.
    if fs::write(out.join("probe"), "").is_ok() {
        return;
    }
    let (status, told) = run(&["bake", LAYERED, "-o", out.to_str().unwrap(), "--size", "32"]);
    assert!(status == 1 && told.contains("cannot write to the folder"), "{told}");
    assert_eq!(fs::read_dir(&out).unwrap().count(), 0);
}

#[test]
fn ambient_occlusion_is_of_the_pixel_alone_and_tells_its_distances() {
    let folder = tempfile::tempdir().unwrap();
    let folder = folder.path();
    // Regions about one place, whose pixels are a kilometre wide.
    let read = |side: &str| {
        let region = ["--as", "region", "--lat", "16.3", "--lon", "-32.4", "--km", side, "--size", side];
        bake(folder, &[&["--what", "ambient_occlusion", "--format", "exr"][..], &region].concat());
        decode::exr(&fs::read(folder.join("ambient_occlusion.exr")).unwrap())
    };
    let (wide, narrow) = (read("33"), read("3"));
    assert!(wide.numbers.iter().all(|open| (0.0..=1.0).contains(open)));
    let least = wide.numbers.iter().copied().fold(1.0, f64::min);
    assert!(least < 0.999, "nothing is hidden anywhere: {least}");
    // What lies beyond the border of a region counts.
    assert_eq!(narrow.at(1, 1), wide.at(16, 16));
    let about = about(folder, "ambient_occlusion");
    let distances: Vec<f64> = about["distances_m"].as_array().unwrap().iter().map(|m| m.as_f64().unwrap()).collect();
    for (found, wanted) in distances.iter().zip([1e3, 2e3, 4e3, 8e3, 16e3, 32e3]) {
        assert!((found / wanted - 1.0).abs() < 1e-9, "{distances:?}");
    }
    let (code, error) = run(&["bake", LAYERED, "-o", folder.to_str().unwrap(), "--what", "night_lights"]);
    assert!(code == 1 && error.contains("night_lights: Layered has no settlements; leave it out"), "{error}");
}
