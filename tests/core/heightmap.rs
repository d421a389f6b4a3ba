//! Height maps: pictures as terrain, from the file to the ground, and the messages for wrong pictures.

use crate::support::dice::directions;
use exr::prelude::*;
use glam::DVec3;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use tellus::planet::param::Choice;
use tellus::planet::picture::{Budget, PictureKey};
use tellus::planet::{HeightMap, Layer, PictureLayout, Planet, Shape, VERSION};
use tellus::simd::Simd;
use tellus::sphere::LatLon;
use tellus::sphere::raster::cube_direction;
use tellus::terrain::Terrain;

/// A landscape from 0 to 1, different everywhere.
fn landscape(d: DVec3) -> f64 {
    0.5 + 0.2 * libm::sin(3.0 * d.x + 1.0) + 0.2 * libm::cos(4.0 * d.y * d.z) + 0.1 * d.z
}

fn equirectangular(height: usize) -> (usize, usize, Vec<f64>) {
    let texel = |i: usize| {
        let (row, column) = ((i / (2 * height)) as f64 + 0.5, (i % (2 * height)) as f64 + 0.5);
        landscape(
            LatLon::from_degrees(90.0 - row / height as f64 * 180.0, column / height as f64 * 180.0 - 180.0)
                .direction(),
        )
    };
    (2 * height, height, (0..2 * height * height).map(texel).collect())
}

/// The six faces at these squares of a picture that is `wide` by `high` squares.
fn faces(side: usize, [wide, high]: [usize; 2], squares: [(usize, usize); 6]) -> (usize, usize, Vec<f64>) {
    let (width, height) = (wide * side, high * side);
    let mut pixels = vec![0.0; width * height];
    for (face, (column, row)) in squares.into_iter().enumerate() {
        for y in 0..side {
            for x in 0..side {
                let d = cube_direction(face, side, x as f64 + 0.5, y as f64 + 0.5);
                pixels[(row * side + y) * width + column * side + x] = landscape(d);
            }
        }
    }
    (width, height, pixels)
}

const CROSS: [(usize, usize); 6] = [(1, 1), (3, 1), (2, 1), (0, 1), (1, 0), (1, 2)];

fn write_png(path: &Path, width: usize, height: usize, color: png::ColorType, depth: png::BitDepth, data: &[u8]) {
    let mut encoder = png::Encoder::new(std::fs::File::create(path).unwrap(), width as u32, height as u32);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.write_header().unwrap().write_image_data(data).unwrap();
}

fn png16(path: &Path, (width, height, pixels): &(usize, usize, Vec<f64>)) {
    let data: Vec<u8> = pixels.iter().flat_map(|v| ((v * 65535.0 + 0.5) as u16).to_be_bytes()).collect();
    write_png(path, *width, *height, png::ColorType::Grayscale, png::BitDepth::Sixteen, &data);
}

fn png8(path: &Path, (width, height, pixels): &(usize, usize, Vec<f64>), color: bool) {
    let grey = |v: &f64| (v * 255.0 + 0.5) as u8;
    let data: Vec<u8> = pixels.iter().flat_map(|v| vec![grey(v); if color { 3 } else { 1 }]).collect();
    let kind = if color { png::ColorType::Rgb } else { png::ColorType::Grayscale };
    write_png(path, *width, *height, kind, png::BitDepth::Eight, &data);
}

fn exr32(path: &Path, (width, height, pixels): &(usize, usize, Vec<f64>)) {
    let samples = FlatSamples::F32(pixels.iter().map(|v| *v as f32).collect());
    let channels = AnyChannels::sort(vec![AnyChannel::new("Y", samples)].into());
    Image::from_channels((*width, *height), channels).write().to_file(path).unwrap();
}

/// A planet whose only layer is a height map.
fn planet(file: impl Into<String>, layout: PictureLayout) -> Planet {
    let map = HeightMap { file: file.into().into(), layout, low: -0.5, high: 0.5 };
    let layer = Layer { name: "Map".to_owned(), amplitude_m: 8000.0, shape: Shape::HeightMap(map), ..Layer::default() };
    Planet { layers: vec![layer], ..Planet::default() }
}

/// Saves a planet beside its picture and loads it.
fn loaded(folder: &Path, file: &str, layout: PictureLayout) -> Terrain {
    let preset = folder.join(format!("{file}.ron"));
    planet(file, layout).save(&preset).unwrap();
    Terrain::try_new(Arc::new(Planet::load(&preset).unwrap())).unwrap()
}

#[test]
fn every_file_and_layout_gives_the_same_planet() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    png16(&path("globe.png"), &equirectangular(256));
    png8(&path("globe8.png"), &equirectangular(256), false);
    png8(&path("color.png"), &equirectangular(256), true);
    exr32(&path("globe.exr"), &equirectangular(256));
    png16(&path("cross.png"), &faces(128, [4, 3], CROSS));
    png16(&path("row.png"), &faces(128, [6, 1], std::array::from_fn(|face| (face, 0))));
    exr32(&path("column.exr"), &faces(128, [1, 6], std::array::from_fn(|face| (0, face))));
    let right = |d: DVec3| (landscape(d) - 0.5) * 8000.0;
    for (file, layout, tolerance_m) in [
        ("globe.png", PictureLayout::Equirectangular, 6.0),
        ("globe8.png", PictureLayout::Equirectangular, 20.0),
        ("color.png", PictureLayout::Equirectangular, 20.0),
        ("globe.exr", PictureLayout::Equirectangular, 6.0),
        ("cross.png", PictureLayout::CubeCross, 6.0),
        ("row.png", PictureLayout::CubeStrip, 6.0),
        ("column.exr", PictureLayout::CubeStrip, 6.0),
    ] {
        let terrain = loaded(folder.path(), file, layout);
        let (lo, hi) = terrain.height_bounds_m();
        for dir in directions(1, 2000).into_iter().chain([DVec3::Z, DVec3::NEG_Z, DVec3::NEG_X, DVec3::ONE]) {
            let height_m = terrain.height_m(dir);
            assert!((height_m - right(dir.normalize())).abs() < tolerance_m, "{file} {dir}: {height_m} {}", right(dir));
            assert!((lo..=hi).contains(&height_m));
        }
    }
}

#[test]
fn normals_are_those_of_the_heights_and_bits_are_the_same_everywhere() {
    let folder = tempfile::tempdir().unwrap();
    png16(&folder.path().join("a.png"), &equirectangular(64));
    let terrain = loaded(folder.path(), "a.png", PictureLayout::Equirectangular);
    let radius_m = terrain.planet().radius_m();
    let dirs = directions(1, 500);
    for &dir in dirs.iter().chain(&[DVec3::Z, DVec3::NEG_X]) {
        let at = |d: DVec3| d.normalize() * (radius_m + terrain.height_m(d));
        let (a, b) = dir.any_orthonormal_pair();
        let step = 1e-5;
        let normal =
            (at(dir + a * step) - at(dir - a * step)).cross(at(dir + b * step) - at(dir - b * step)).normalize();
        assert!(normal.angle_between(terrain.sample(dir).normal_planet) < 1e-6, "{dir}");
    }
    let heights = terrain.heights_m(&dirs);
    for simd in Simd::available() {
        assert_eq!(terrain.clone().with_simd(simd).heights_m(&dirs), heights);
    }
    let alone = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    // Another file, so that the picture is decoded again.
    std::fs::copy(folder.path().join("a.png"), folder.path().join("b.png")).unwrap();
    let again = alone.install(|| loaded(folder.path(), "b.png", PictureLayout::Equirectangular).heights_m(&dirs));
    assert_eq!(again, heights);
}

/// Rows of an interlaced picture come in seven passes, some of which are empty at 10 x 5 pixels.
#[test]
fn an_interlaced_picture_is_the_same_picture() {
    let read = |name: &str| {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/fixtures").join(name);
        PictureKey { file, extent: PictureLayout::Equirectangular.into() }.load(&mut Budget::default()).unwrap()
    };
    let (plain, interlaced) = (read("plain.png"), read("interlaced.png"));
    assert_ne!(plain.bounds().0, plain.bounds().1);
    assert_eq!(plain, interlaced);
}

/// All messages of [`Planet::load`], without the folder.
fn said(folder: &Path, preset: &str) -> String {
    let error = Planet::load(folder.join(preset)).map(|_| ()).unwrap_err().to_string();
    error.replace(&format!("{}/", folder.display()), "")
}

#[test]
fn a_picture_that_is_wrong_is_told_with_its_place_and_loses_no_work() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    png16(&path("square.png"), &(8, 8, vec![0.5; 64]));
    std::fs::write(path("text.png"), "hello, this is no picture").unwrap();
    png16(&path("cut.png"), &equirectangular(16));
    let bytes = std::fs::read(path("cut.png")).unwrap();
    std::fs::write(path("cut.png"), &bytes[..bytes.len() / 2]).unwrap();
    exr32(&path("nan.exr"), &(16, 8, (0..128).map(|i| if i == 18 { f64::NAN } else { 0.1 }).collect()));
    std::fs::create_dir(path("dir")).unwrap();
    // A header that promises far more pixels than the file has.
    png16(&path("huge.png"), &equirectangular(8));
    let mut huge = std::fs::read(path("huge.png")).unwrap();
    huge[16..24].copy_from_slice(&[0, 2, 0, 0, 0, 1, 0, 0]);
    let mut crc = 0xffff_ffff_u32;
    for byte in &huge[12..29] {
        crc = (0..8).fold(crc ^ u32::from(*byte), |c, _| if c & 1 == 1 { 0xedb8_8320 ^ (c >> 1) } else { c >> 1 });
    }
    huge[29..33].copy_from_slice(&(!crc).to_be_bytes());
    std::fs::write(path("huge.png"), huge).unwrap();

    for (file, layout, message) in [
        ("no.png", "Equirectangular", "there is no file no.png; put the picture there or correct the path"),
        ("dir", "Equirectangular", "dir is a folder; name a PNG or EXR picture in it"),
        ("text.png", "Equirectangular", "text.png is neither PNG nor OpenEXR; save the picture as one of them"),
        ("cut.png", "Equirectangular", "cut.png is broken: "),
        ("nan.exr", "Equirectangular", "nan.exr holds NaN at pixel (2, 1); use numbers from -1e6 to 1e6"),
        (
            "huge.png",
            "Equirectangular",
            "huge.png is 131072 x 65536 pixels; use a smaller picture, of at most 134217728 pixels (16384 x 8192)",
        ),
        (
            "square.png",
            "Equirectangular",
            "square.png is 8 x 8 pixels; an equirectangular picture is twice as wide as high",
        ),
        ("square.png", "CubeCross", "square.png is 8 x 8 pixels; a cube cross is 4 squares wide and 3 high"),
        ("square.png", "CubeStrip", "square.png is 8 x 8 pixels; a cube strip is 6 squares in a row or a column"),
    ] {
        let text =
            format!("(version: {VERSION}, layers: [\n  (shape: HeightMap(layout: {layout}, file: {file:?})),\n])");
        std::fs::write(path("p.ron"), &text).unwrap();
        let column = text.lines().nth(1).unwrap().find('"').unwrap() + 1;
        let said = said(folder.path(), "p.ron");
        assert!(said.starts_with(&format!("p.ron:2:{column}: layers[0].shape.file: {message}")), "{said}");
        // The editor still opens it: flat, and with its reference.
        let planet = Planet::open(path("p.ron")).unwrap();
        planet.save(path("q.ron")).unwrap();
        assert!(std::fs::read_to_string(path("q.ron")).unwrap().contains(file));
        assert_eq!(Terrain::try_new(Arc::new(planet)).unwrap().height_m(DVec3::X), 0.0);
    }
}

#[test]
fn a_height_map_without_a_file_is_valid_and_flat() {
    let planet = Planet::from_text("p.ron", &format!("(version: {VERSION}, layers: [(shape: HeightMap())])")).unwrap();
    assert!(planet.missing_files().is_empty());
    let terrain = Terrain::try_new(Arc::new(planet)).unwrap();
    assert_eq!((terrain.height_m(DVec3::X), terrain.height_bounds_m()), (0.0, (0.0, 0.0)));
}

#[test]
fn references_follow_the_preset_from_folder_to_folder() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    for name in ["a/maps", "b/c"] {
        std::fs::create_dir_all(path(name)).unwrap();
    }
    png16(&path("a/maps/m.png"), &equirectangular(16));
    let written = |preset: &PathBuf| {
        let text = std::fs::read_to_string(preset).unwrap();
        text.lines().find_map(|line| line.trim().strip_prefix("file: ")).unwrap().to_owned()
    };
    // An unsaved planet holds an absolute path; a saved one, a path relative to the preset.
    let whole = path("a/maps/m.png").to_str().unwrap().to_owned();
    let mut unsaved = planet(whole, PictureLayout::Equirectangular);
    assert_eq!(unsaved.load_pictures(), []);
    let first = path("a/p.ron");
    unsaved.save(&first).unwrap();
    assert_eq!(written(&first), "\"maps/m.png\",");
    let planet = Planet::load(&first).unwrap();
    assert_eq!(planet, unsaved, "the same picture, however it is written");
    let height_m = Terrain::try_new(Arc::new(planet.clone())).unwrap().height_m(DVec3::X);
    assert_ne!(height_m, 0.0);

    let second = path("b/c/p.ron");
    planet.save(&second).unwrap();
    assert_eq!(written(&second), "\"../../a/maps/m.png\",");
    assert_eq!(Terrain::try_new(Arc::new(Planet::load(&second).unwrap())).unwrap().height_m(DVec3::X), height_m);
    // And back again: the text is unchanged.
    let back = path("a/q.ron");
    Planet::load(&second).unwrap().save(&back).unwrap();
    assert_eq!(written(&back), written(&first));

    // A typed name of another file has no pixels until they are loaded.
    let mut other = planet.clone();
    if let Shape::HeightMap(map) = &mut other.layers[0].shape {
        map.file = "maps/n.png".to_owned().into();
    }
    other.set_folder(&path("a"));
    assert_ne!(other, planet);
    assert_eq!(Terrain::try_new(Arc::new(other)).unwrap().height_m(DVec3::X), 0.0);
}

#[test]
fn no_random_planet_has_one() {
    for seed in 0..200 {
        let planet = tellus::planet::random::random(seed);
        assert!(planet.layers.iter().all(|layer| layer.shape.names()[layer.shape.index()] != "HeightMap"));
    }
}

#[test]
fn a_preset_and_its_pictures_come_from_memory() {
    let folder = tempfile::tempdir().unwrap();
    for (file, is_png) in [("globe.png", true), ("globe.exr", false)] {
        let path = folder.path().join(file);
        if is_png {
            png16(&path, &equirectangular(64));
        } else {
            exr32(&path, &equirectangular(64));
        }
        let from_disk = loaded(folder.path(), file, PictureLayout::Equirectangular);
        let (bytes, text) = (std::fs::read(&path).unwrap(), planet(file, PictureLayout::Equirectangular).to_text());
        std::fs::remove_file(&path).unwrap();
        let mut asked = Vec::new();
        let packed = Planet::from_pack("pack.ron", &text, |path| {
            asked.push(path.to_owned());
            Ok(bytes.clone())
        });
        assert_eq!(asked, [Path::new(file)]);
        let terrain = Terrain::try_new(Arc::new(packed.unwrap())).unwrap();
        let dirs = directions(5, 200);
        assert_eq!(terrain.heights_m(&dirs), from_disk.heights_m(&dirs), "{file}");
        for (bytes, part) in
            [(Err("is not packed".to_owned()), "is not packed"), (Ok(b"none".to_vec()), "is neither PNG")]
        {
            let error = Planet::from_pack("pack.ron", &text, |_| bytes.clone()).unwrap_err().to_string();
            assert!(error.starts_with("pack.ron:") && error.contains(part), "{error}");
        }
    }
}
