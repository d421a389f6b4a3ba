//! Files that are broken, far too large, or no regular files: each gives an error, none crashes the program. The
//! command line runs as a process with little memory, because an abort would end the test.

use assert_cmd::Command;
use exr::math::RoundingMode;
use exr::meta::BlockDescription;
use exr::prelude::*;
use std::fmt::Write as _;
use std::path::Path;
use std::time::Duration;
use tellus::planet::VERSION;
use tellus::planet::picture::{Budget, PictureKey};
use tellus::planet::{PictureLayout, Planet, Shape};

const FIXTURES: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/tests/fixtures/hostile");

/// A preset with a height map for each file.
fn preset(folder: &Path, files: &[&str]) {
    let layers = files.iter().enumerate().fold(String::new(), |mut text, (i, file)| {
        writeln!(text, "(name: \"m{i}\", shape: HeightMap(file: {file:?})),").unwrap();
        text
    });
    std::fs::write(folder.join("p.ron"), format!("(version: {VERSION}, radius_km: 100.0, layers: [\n{layers}])"))
        .unwrap();
}

/// Exit status, standard output and standard error of the program with a limited memory. It must not be killed.
fn run(folder: &Path, mebibytes: usize, args: &[&str]) -> (i32, String, String) {
    let program = assert_cmd::cargo::cargo_bin!("tellus");
    let mut command = Command::new("sh");
    // Each thread takes address space, which the limit counts; glibc would reserve 64 MiB more for some of them, as
    // they happen to meet.
    command.env("RAYON_NUM_THREADS", "4").env("MALLOC_ARENA_MAX", "1");
    command.arg("-c").arg(format!("ulimit -v {}; exec \"$0\" \"$@\"", mebibytes << 10));
    let output =
        command.arg(program).args(args).current_dir(folder).timeout(Duration::from_secs(120)).output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap_or(-1), text(output.stdout), text(output.stderr))
}

/// The lines that `tellus check` prints about a preset; `tellus sample` must fail too.
fn refused(folder: &Path, mebibytes: usize) -> Vec<String> {
    let (status, out, err) = run(folder, mebibytes, &["check", "p.ron"]);
    assert_eq!((status, out.as_str()), (1, ""), "{err}");
    assert!(!err.contains("panicked"), "{err}");
    let (status, _, sampled) = run(folder, mebibytes, &["sample", "p.ron", "--lat", "0", "--lon", "0"]);
    assert_eq!((status, sampled), (1, format!("error: {err}")));
    err.lines().map(|line| line.replace(&format!("{}/", folder.display()), "")).collect()
}

#[test]
fn an_exr_that_lies_about_the_sizes_within_its_blocks_is_refused() {
    for file in ["dwa_huge_means.exr", "dwa_huge_coefficients.exr"] {
        let folder = tempfile::tempdir().unwrap();
        std::fs::copy(Path::new(FIXTURES).join(file), folder.path().join(file)).unwrap();
        preset(folder.path(), &[file]);
        let said = refused(folder.path(), 1024);
        let message = format!(
            ": layers[0].shape.file: {file} is broken: a block is larger than it may be; save the picture anew"
        );
        assert!(said.len() == 1 && said[0].ends_with(&message), "{said:?}");
    }
}

#[test]
fn a_small_file_of_too_many_pixels_is_refused_however_often_it_is_named() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::copy(Path::new(FIXTURES).join("bomb_1bit.png"), folder.path().join("bomb.png")).unwrap();
    let names: Vec<String> = (0..16).map(|i| format!("link{i}.png")).collect();
    for name in &names {
        std::os::unix::fs::symlink("bomb.png", folder.path().join(name)).unwrap();
    }
    let mut files: Vec<&str> = names.iter().map(String::as_str).collect();
    files.push("bomb.png");
    preset(folder.path(), &files);
    let said = refused(folder.path(), 1024);
    assert_eq!(said.len(), files.len());
    for (i, (said, file)) in said.iter().zip(files).enumerate() {
        let message = format!(
            "layers[{i}].shape.file: {file} is 32768 x 16384 pixels; use a smaller picture, of at most 134217728 \
             pixels (16384 x 8192)"
        );
        assert!(said.ends_with(&message), "{said}");
    }
}

fn grey_png(path: &Path, width: usize, depth: png::BitDepth, color: png::ColorType, value: impl Fn(usize) -> u8) {
    use std::io::Write as _;
    let file = std::io::BufWriter::new(std::fs::File::create(path).unwrap());
    let mut encoder = png::Encoder::new(file, width as u32, width as u32 / 2);
    encoder.set_color(color);
    encoder.set_depth(depth);
    encoder.set_compression(png::Compression::Fast);
    let mut writer = encoder.write_header().unwrap();
    let mut stream = writer.stream_writer().unwrap();
    let row = vec![0_u8; (width * color.samples() * depth as usize).div_ceil(8)];
    for line in 0..width / 2 {
        let mut row = row.clone();
        row.fill(value(line));
        stream.write_all(&row).unwrap();
    }
    stream.finish().unwrap();
}

/// An OpenEXR file without the blocks that its header announces.
fn exr_header(path: &Path, width: usize, names: &[String], blocks: BlockDescription) {
    let channels = names.iter().map(|name| ChannelDescription::named(name.as_str(), SampleType::F32)).collect();
    let header = exr::meta::header::Header::new("l".into(), (width, width / 2), channels).with_encoding(
        Compression::ZIP16,
        blocks,
        LineOrder::Increasing,
    );
    let mut bytes = std::io::Cursor::new(Vec::new());
    let headers = exr::block::write(&mut bytes, [header].into_iter().collect(), true, |_, _| Err(Error::Aborted));
    assert!(headers.is_err());
    std::fs::write(path, bytes.into_inner()).unwrap();
}

/// The largest allowed height map fits into the stated memory, is read once for all its layers, and leaves the stated
/// room for others.
#[test]
fn an_honest_picture_of_the_largest_size_is_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    grey_png(&path("big.png"), 16384, png::BitDepth::Sixteen, png::ColorType::Grayscale, |line| (line / 64) as u8);
    std::os::unix::fs::symlink("big.png", path("link.png")).unwrap();
    preset(folder.path(), &["big.png", "link.png", "big.png"]);
    let (status, out, err) = run(folder.path(), 1536, &["sample", "p.ron", "--lat", "-45", "--lon", "10", "--json"]);
    assert_eq!((status, err.as_str()), (0, ""));
    let answer: serde_json::Value = serde_json::from_str(&out).unwrap();
    // At three quarters of the picture's height, on three layers of 1000 m.
    let height_m = answer["height_m"].as_f64().unwrap();
    assert!((height_m - 3000.0 * 96.0 / 255.0).abs() < 10.0, "{answer}");

    exr_header(&path("more.exr"), 16384, &["Y".to_owned()], BlockDescription::ScanLines);
    preset(folder.path(), &["big.png", "link.png", "more.exr"]);
    let (status, _, err) = run(folder.path(), 1536, &["check", "p.ron"]);
    let message = "more.exr takes 512 MiB of memory, and 256 MiB of 512 MiB are left for it beside the planet's other \
                   pictures; use smaller pictures, or one file in several layers\n";
    assert!(status == 1 && err.lines().count() == 1 && err.ends_with(message), "{err}");
}

#[test]
fn channels_that_are_not_used_take_no_memory() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    // A gigabyte of pixels, 16 MiB of which are heights.
    let (width, height) = (2048, 1024);
    let sample = |name: &str| AnyChannel::new(name, FlatSamples::F16(vec![f16::from_f32(0.25); width * height]));
    let channels = AnyChannels::sort((0..64).map(|i| sample(&format!("c{i:02}"))).collect());
    let encoding = Encoding { compression: Compression::RLE, ..Encoding::default() };
    let layer = Layer::new((width, height), LayerAttributes::named("l"), encoding, channels);
    Image::from_layer(layer).write().to_file(path("many.exr")).unwrap();
    grey_png(&path("color.png"), 4096, png::BitDepth::Sixteen, png::ColorType::Rgba, |_| 64);
    preset(folder.path(), &["many.exr", "color.png"]);
    let (status, _, err) = run(folder.path(), 224, &["check", "p.ron"]);
    assert_eq!((status, err.as_str()), (0, ""));

    // Too many channels take too much time.
    let names: Vec<String> = (0..64).map(|i| format!("c{i:02}")).collect();
    exr_header(&path("long.exr"), 8192, &names, BlockDescription::ScanLines);
    exr_header(&path("wide.exr"), 16384, &names, BlockDescription::ScanLines);
    preset(folder.path(), &["long.exr", "wide.exr"]);
    let said = refused(folder.path(), 1024);
    assert!(
        said[0].contains("long.exr holds 8192 MiB of numbers in all its channels, and 4096 MiB of 4096 MiB are left"),
        "{said:?}"
    );
    assert!(said.len() == 2 && said[1].contains("wide.exr "), "{said:?}");

    // So do too many blocks; and one block has a limit of memory.
    let tiles = |side: usize| {
        BlockDescription::Tiles(TileDescription {
            tile_size: Vec2(side, side),
            level_mode: exr::meta::attribute::LevelMode::Singular,
            rounding_mode: RoundingMode::Down,
        })
    };
    exr_header(&path("small.exr"), 1024, &["Y".to_owned()], tiles(1));
    exr_header(&path("large.exr"), 1024, &["Y".to_owned()], tiles(1 << 20));
    preset(folder.path(), &["small.exr", "large.exr"]);
    let said = refused(folder.path(), 1024);
    assert!(said[0].contains("small.exr is cut into 524288 blocks of 1 x 1 pixels; save it in scan lines"), "{said:?}");
    let message = "large.exr has blocks of 1048576 x 1048576 pixels in 1 channels, which is more than 64 MiB each";
    assert!(said.len() == 2 && said[1].contains(message), "{said:?}");
}

#[test]
fn pipes_and_devices_are_not_read() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    assert!(std::process::Command::new("mkfifo").arg(path("pipe")).status().unwrap().success());
    std::os::unix::fs::symlink("pipe", path("link.png")).unwrap();
    for file in ["pipe", "/dev/zero"] {
        for args in [&["check", file][..], &["sample", file, "--lat", "0", "--lon", "0"], &[file]] {
            let (status, _, err) = run(folder.path(), 4096, args);
            assert!(
                status == 1 && err.ends_with(&format!("{file}: is a device or a pipe, not a file; name a file\n")),
                "{err}"
            );
        }
    }
    // A system, points, the key and the tiles of a tileset, and the file of a preset's edits.
    std::fs::write(path("e.ron"), format!("(version: {VERSION}, edits: \"edits.ron\")")).unwrap();
    std::fs::write(path("small.ron"), format!("(version: {VERSION}, radius_km: 50.0)")).unwrap();
    std::os::unix::fs::symlink("pipe", path("edits.ron")).unwrap();
    std::fs::create_dir(path("tiles")).unwrap();
    std::os::unix::fs::symlink("/dev/zero", path("tiles/tiles.key")).unwrap();
    for args in [
        &["system", "pipe"][..],
        &["system", "/dev/zero"],
        &["check", "e.ron"],
        &["sample", "small.ron", "--points", "pipe"],
        &["sample", "small.ron", "--points", "/dev/zero"],
        &["tiles", "small.ron", "-o", "tiles", "--levels", "0", "--cells", "4"],
    ] {
        let (status, out, err) = run(folder.path(), 4096, args);
        assert!(status == 1 && out.is_empty() && err.contains("is a device or a pipe, not a file"), "{args:?}: {err}");
    }
    // Tiles that are none are made anew.
    std::fs::remove_file(path("tiles/tiles.key")).unwrap();
    std::fs::create_dir(path("tiles/0")).unwrap();
    assert!(std::process::Command::new("mkfifo").arg(path("tiles/0/pos_x_0_0.glb")).status().unwrap().success());
    let (status, _, err) =
        run(folder.path(), 4096, &["tiles", "small.ron", "-o", "tiles", "--levels", "0", "--cells", "4"]);
    assert!(status == 1 && err.contains("pos_x_0_0.glb: is a device or a pipe"), "{err}");

    preset(folder.path(), &["pipe", "/dev/zero", "link.png"]);
    let said = refused(folder.path(), 1024);
    for (said, file) in said.iter().zip(["pipe", "/dev/zero", "link.png"]) {
        let message = format!("shape.file: {file} is a device or a pipe, not a file; name a PNG or EXR picture");
        assert!(said.ends_with(&message), "{said}");
    }
}

/// A picture with each compression, in scan lines and in tiles.
fn exr_files() -> Vec<(String, Vec<u8>)> {
    let (width, height) = (64, 32);
    let value = |i: usize| (i % width) as f32 * 0.01 + (i / width) as f32 * 0.003;
    let mut files = Vec::new();
    for compression in [
        Compression::Uncompressed,
        Compression::RLE,
        Compression::ZIP1,
        Compression::ZIP16,
        Compression::PIZ,
        Compression::PXR24,
        Compression::B44,
        Compression::B44A,
        Compression::DWAA(None),
        Compression::DWAB(None),
    ] {
        for blocks in [Blocks::ScanLines, Blocks::Tiles(Vec2(32, 16))] {
            let halves = FlatSamples::F16((0..width * height).map(|i| f16::from_f32(value(i))).collect());
            let floats = FlatSamples::F32((0..width * height).map(value).collect());
            let channels = vec![AnyChannel::new("A", halves), AnyChannel::new("Y", floats)];
            let line_order = LineOrder::Increasing;
            let encoding = Encoding { compression, blocks, line_order };
            let layer =
                Layer::new((width, height), LayerAttributes::named("l"), encoding, AnyChannels::sort(channels.into()));
            let mut bytes = std::io::Cursor::new(Vec::new());
            Image::from_layer(layer).write().to_buffered(&mut bytes).unwrap();
            files.push((format!("{compression:?} {blocks:?}"), bytes.into_inner()));
        }
    }
    files
}

fn read(file: &Path) -> std::result::Result<std::sync::Arc<tellus::planet::picture::Picture>, String> {
    let key = PictureKey { file: file.to_owned(), extent: PictureLayout::Equirectangular.into() };
    key.load(&mut Budget::default())
}

/// A file with a few changed bytes gives a picture or an error. (An abort would end this test.)
#[test]
fn no_byte_of_an_exr_is_dangerous() {
    const CASES: u64 = 60;
    let folder = tempfile::tempdir().unwrap();
    let (mut number, mut state) = (0, 0x2545_f491_4f6c_dd1d_u64);
    let mut dice = |below: usize| {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 33) as usize % below
    };
    let mut write_and_read = |bytes: &[u8]| {
        number += 1;
        // A new name for each: pictures are cached by file.
        let file = folder.path().join(format!("{number}.exr"));
        std::fs::write(&file, bytes).unwrap();
        read(&file)
    };
    let (mut read, mut refused) = (0, 0);
    for (name, bytes) in exr_files() {
        write_and_read(&bytes).unwrap_or_else(|error| panic!("{name}: {error}"));
        for case in 0..CASES {
            let mut broken = bytes.clone();
            if case % 10 == 0 {
                broken.truncate(dice(bytes.len()));
            }
            // Half of the changes hit the begin of the file: header, offsets, the first block.
            let near = if case % 2 == 0 { broken.len().min(700) } else { broken.len() };
            for _ in 0..=dice(3) {
                let at = dice(near.max(1)).min(broken.len().saturating_sub(1));
                if let Some(byte) = broken.get_mut(at) {
                    *byte = [0, 0xff, 0x7f, 0x80, dice(256) as u8][dice(5)];
                }
            }
            match write_and_read(&broken) {
                Ok(_) => read += 1,
                Err(_) => refused += 1,
            }
        }
    }
    assert!(read > 20 && refused > 200, "{read} read, {refused} refused");
}

#[test]
fn every_compression_gives_the_heights() {
    let folder = tempfile::tempdir().unwrap();
    for (number, (name, bytes)) in exr_files().into_iter().enumerate() {
        let file = folder.path().join(format!("{number}.exr"));
        std::fs::write(&file, bytes).unwrap();
        let (lo, hi) = read(&file).unwrap_or_else(|error| panic!("{name}: {error}")).bounds();
        assert!((-0.01..0.05).contains(&lo) && (0.65..0.75).contains(&hi), "{name}: {lo} to {hi}");
    }
}

/// Two files with equal pixels, and links to them, are one picture.
#[test]
fn equal_pictures_are_kept_once() {
    let folder = tempfile::tempdir().unwrap();
    let path = |name: &str| folder.path().join(name);
    grey_png(&path("a.png"), 64, png::BitDepth::Eight, png::ColorType::Grayscale, |line| line as u8);
    std::fs::copy(path("a.png"), path("b.png")).unwrap();
    std::os::unix::fs::symlink("b.png", path("c.png")).unwrap();
    preset(folder.path(), &["a.png", "b.png", "c.png"]);
    let planet = Planet::load(path("p.ron")).unwrap();
    let pictures = planet.layers.iter().map(|layer| match &layer.shape {
        Shape::HeightMap(map) => map.file.picture(map.layout).unwrap(),
        other => panic!("{other:?}"),
    });
    let pictures: Vec<_> = pictures.collect();
    assert!(pictures.iter().all(|picture| std::sync::Arc::ptr_eq(picture, pictures[0])));
}
