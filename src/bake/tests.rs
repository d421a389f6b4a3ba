//! Bakes of a small planet: resumed, shared, stopped, refused.

use super::*;
use crate::planet::Planet;
use std::collections::BTreeMap;
use std::sync::atomic::{AtomicU32, Ordering};

const PLANET: &str = r#"(
    version: 3,
    name: "Islet",
    radius_km: 40.0,
    layers: [(name: "Hills", amplitude_m: 800.0, shape: Fbm(wavelength_km: 12.0, octaves: 4))],
    water: (level_m: -50.0),
)"#;

fn bake(maps: &[Map], projection: Projection, size: u32, format: Format) -> Bake {
    let planet = Planet::from_text("islet.ron", PLANET).unwrap();
    Bake::new(Arc::new(Terrain::try_new(planet.into()).unwrap()), maps.to_vec(), projection, size, format)
}

/// The files of a folder with their bytes.
fn files(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap());
    entries.map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())).collect()
}

fn baked(bake: &Bake) -> BTreeMap<String, Vec<u8>> {
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(bake.run(folder.path(), &|_| true).unwrap(), Outcome::Done(_)));
    files(folder.path())
}

#[test]
fn a_bake_that_was_stopped_goes_on_and_gives_the_same_bytes() {
    let bake = bake(&[Map::Height, Map::Normal], Projection::Equirect, 128, Format::Png16);
    let whole = baked(&bake);
    assert_eq!(whole.keys().collect::<Vec<_>>(), ["height.json", "height.png", "normal.json", "normal.png"]);
    let folder = tempfile::tempdir().unwrap();
    // Stops among the strips again and again, and then among the files.
    let mut runs = 0;
    loop {
        let asked = AtomicU32::new(0);
        let outcome = bake.run(folder.path(), &|_| asked.fetch_add(1, Ordering::Relaxed) < 10).unwrap();
        runs += 1;
        if runs < 4 {
            assert_eq!(outcome, Outcome::Stopped);
            let found = fs::read_dir(folder.path()).unwrap().count();
            assert_eq!(found, 1, "only the strips are there");
        } else {
            break;
        }
    }
    assert!(matches!(bake.run(folder.path(), &|_| true).unwrap(), Outcome::Done(_)));
    assert!(files(folder.path()) == whole);
}

#[test]
fn damaged_strips_are_computed_again() {
    let mut bake = bake(&[Map::Height], Projection::Equirect, 64, Format::R16);
    let whole = baked(&bake);
    let folder = tempfile::tempdir().unwrap();
    bake.shard = Some(Shard { number: 1, count: 1 });
    assert_eq!(bake.run(folder.path(), &|_| true).unwrap(), Outcome::Shard { missing: 0 });
    let strips = fs::read_dir(folder.path()).unwrap().next().unwrap().unwrap().path();
    let strip = |number: u32| strips.join(format!("{number:05}.strip"));
    fs::write(strip(3), b"short").unwrap();
    let mut other = fs::read(strip(5)).unwrap();
    other[9] ^= 1;
    fs::write(strip(5), other).unwrap();
    // Values: in the middle of the strip, and in what its head says of them.
    for (number, at) in [(6, 200), (7, 30), (8, 38)] {
        let mut damaged = fs::read(strip(number)).unwrap();
        damaged[at] ^= 0x10;
        fs::write(strip(number), damaged).unwrap();
    }
    bake.shard = None;
    assert!(matches!(bake.run(folder.path(), &|_| true).unwrap(), Outcome::Done(_)));
    assert!(files(folder.path()) == whole);
}

#[test]
fn shards_join_to_the_same_bytes() {
    let region = Projection::Region(Region { lat_deg: 50.0, lon_deg: -3.0, side_km: 20.0 });
    for (projection, format) in [(Projection::Cube, Format::Exr), (region, Format::Tiff)] {
        let mut bake = bake(&[Map::Height, Map::Biome], projection, 32, format);
        let whole = baked(&bake);
        let folder = tempfile::tempdir().unwrap();
        for (number, left) in [(3, false), (1, false), (2, true)] {
            bake.shard = Some(Shard { number, count: 3 });
            let outcome = bake.run(folder.path(), &|_| true).unwrap();
            assert!(matches!(outcome, Outcome::Shard { missing } if (missing == 0) == left), "{outcome:?}");
        }
        bake.shard = None;
        assert!(matches!(bake.run(folder.path(), &|_| true).unwrap(), Outcome::Done(_)));
        assert!(files(folder.path()) == whole);
    }
}

#[test]
fn heights_beyond_the_range_that_was_asked_for_are_refused_and_the_strips_stay() {
    let mut bake = bake(&[Map::Height], Projection::Equirect, 32, Format::Png16);
    let folder = tempfile::tempdir().unwrap();
    bake.heights_m = Some([-1.0, 1.0]);
    let error = bake.run(folder.path(), &|_| true).unwrap_err().to_string();
    assert!(error.contains("which is beyond the range of -1 to 1 m"), "{error}");
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 1);
    bake.heights_m = Some([-2000.0, 2000.0]);
    assert!(matches!(bake.run(folder.path(), &|_| true).unwrap(), Outcome::Done(_)));
    let about: serde_json::Value = serde_json::from_slice(&files(folder.path())["height.json"]).unwrap();
    assert_eq!((&about["min_m"], &about["max_m"]), (&(-2000.0).into(), &2000.0.into()));
}

#[test]
fn what_is_not_possible_is_said_before_anything_is_written() {
    let region = |side_km| Projection::Region(Region { lat_deg: 0.0, lon_deg: 0.0, side_km });
    let wrong = |maps: &[Map], projection, size, format, part: &str| {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let error = bake(maps, projection, size, format).run(&out, &|_| true).unwrap_err().to_string();
        assert!(error.contains(part) && !out.exists(), "{error}");
    };
    wrong(&[], Projection::Equirect, 64, Format::Exr, "no map to bake");
    wrong(&[Map::Slope, Map::Slope], Projection::Equirect, 64, Format::Exr, "slope is named twice");
    wrong(&[Map::Discharge], Projection::Equirect, 64, Format::Exr, "Islet has no structure, so it has no rivers");
    wrong(&[Map::CloudCover], Projection::Equirect, 64, Format::Exr, "Islet has no clouds");
    wrong(&[Map::Normal], Projection::Equirect, 64, Format::R16, "r16 holds one");
    wrong(
        &[Map::Height],
        Projection::Equirect,
        33,
        Format::Exr,
        "33 is odd, and the map is half as high as wide; use 34",
    );
    wrong(&[Map::Height], Projection::Cube, 1, Format::Exr, "use 2 to 65536");
    wrong(&[Map::Height], region(126.0), 64, Format::Exr, "use more than 0 and at most 126 km on Islet");
    wrong(&[Map::Height], region(f64::NAN), 64, Format::Exr, "out of range");
    let quadtree = |levels, apron| Projection::Quadtree(Quadtree { levels, apron });
    wrong(&[Map::Height], quadtree(30, 1), 64, Format::Exr, "30 levels are out of range; use 0 to 7");
    wrong(&[Map::Height], quadtree(2, 9), 64, Format::Exr, "an apron of 9 pixels is out of range; use 0 to 8");
    let landscape = |tiles| {
        let region = Region { lat_deg: 0.0, lon_deg: 0.0, side_km: 10.0 };
        Projection::Landscape(Landscape { region, tiles })
    };
    wrong(&[Map::Height], landscape(0), 1009, Format::R16, "0 tiles of 1009 pixels along a side are out of range");
    wrong(&[Map::Height], landscape(66), 1009, Format::R16, "use 1 to 65, which is 65536 pixels");
}

/// The numbers of a file of 16 bits without a head.
fn numbers(bytes: &[u8]) -> Vec<u16> {
    bytes.as_chunks().0.iter().map(|&pair| u16::from_le_bytes(pair)).collect()
}

#[test]
fn tiles_of_a_landscape_are_named_as_unreal_reads_them_and_share_their_borders() {
    let region = Region { lat_deg: 50.0, lon_deg: -3.0, side_km: 24.0 };
    let landscape = Projection::Landscape(Landscape { region, tiles: 3 });
    let files = baked(&bake(&[Map::Height], landscape, 17, Format::R16));
    assert_eq!(files.len(), 18);
    let tile = |x: u32, y: u32| numbers(&files[&format!("height_x{x}_y{y}.r16")]);
    for i in 0..17 {
        assert_eq!(tile(0, 1)[i * 17 + 16], tile(1, 1)[i * 17]);
        assert_eq!(tile(2, 0)[16 * 17 + i], tile(2, 1)[i]);
    }
    let about: serde_json::Value = serde_json::from_slice(&files["height_x2_y1.json"]).unwrap();
    assert_eq!((&about["tile"]["x"], &about["tile"]["y"], &about["pixel_m"]), (&2.into(), &1.into(), &500.0.into()));
    // The middle of the middle tile is the region's, in Unreal's own words for heights.
    let number = f64::from(tile(1, 1)[8 * 17 + 8]);
    let (scale, location) = (about["unreal"]["scale"][2].as_f64().unwrap(), about["unreal"]["location_z"].as_f64());
    let found_m = ((number - 32_768.0) / 128.0 * scale + location.unwrap()) / 100.0;
    let wanted_m = bake(&[Map::Height], landscape, 17, Format::R16)
        .terrain
        .height_m(crate::sphere::LatLon::from_degrees(50.0, -3.0).direction());
    let half_m = 0.5 * scale / 128.0 / 100.0;
    assert!((found_m - wanted_m).abs() <= 1.01 * half_m, "{found_m} {wanted_m}");
}

#[test]
fn a_quadtree_has_all_its_tiles_with_aprons_and_many_strips_do_not_fill_the_stack() {
    let tree = Projection::Quadtree(Quadtree { levels: 4, apron: 1 });
    let bake = bake(&[Map::Height], tree, 8, Format::R16);
    let folder = tempfile::tempdir().unwrap();
    let Outcome::Done(paths) = bake.run(folder.path(), &|_| true).unwrap() else { panic!("it was not done") };
    assert_eq!(paths.len(), 2046);
    let about: serde_json::Value =
        serde_json::from_slice(&fs::read(folder.path().join("height.json")).unwrap()).unwrap();
    assert_eq!(about["file"], "height/{level}/{face}_{x}_{y}.r16");
    let keys = ["levels", "apron", "tile_size", "width"].map(|key| about[key].as_u64().unwrap());
    assert_eq!(keys, [4, 1, 8, 10]);
    let tile = |name: &str| numbers(&fs::read(folder.path().join("height").join(name)).unwrap());
    let [min, max] = ["min_m", "max_m"].map(|key| about[key].as_f64().unwrap());
    for (face, x, y) in [(0, 3, 4), (3, 0, 15), (5, 15, 7)] {
        let node = crate::sphere::NodeId { level: 4, face: crate::sphere::Face::ALL[face], x, y };
        let found = tile(&format!("4/{}_{x}_{y}.r16", node.face.name()));
        for (row, column) in [(0, 0), (4, 7), (9, 3)] {
            let share = |pixel: i32| (f64::from(pixel) - 0.5) / 8.0;
            let wanted_m = bake.terrain.height_m(node.direction(share(column), 1.0 - share(row)));
            let found_m = min + f64::from(found[(row * 10 + column) as usize]) / 65_535.0 * (max - min);
            assert!((found_m - wanted_m).abs() < 0.51 * (max - min) / 65_535.0 + 1e-3, "{found_m} {wanted_m}");
        }
    }
    // Neighbours: the apron of one is the border of the other.
    let (left, right) = (tile("4/pos_x_3_4.r16"), tile("4/pos_x_4_4.r16"));
    assert!((1..9).all(|row| left[row * 10 + 9] == right[row * 10 + 1]));
}

#[test]
fn what_is_done_is_not_done_again_unless_it_is_damaged_or_another_bake() {
    let quadtree = Projection::Quadtree(Quadtree { levels: 1, apron: 1 });
    for (projection, format) in
        [(Projection::Equirect, Format::Png16), (Projection::Cube, Format::Ktx2), (quadtree, Format::R16)]
    {
        let mut bake = bake(&[Map::Height, Map::Slope], projection, 32, format);
        let folder = tempfile::tempdir().unwrap();
        let run = |bake: &Bake| bake.run(folder.path(), &|_| true).unwrap();
        let Outcome::Done(made) = run(&bake) else { panic!("it was not done") };
        let contents = || -> Vec<_> { made.iter().map(|path| fs::read(path).unwrap()).collect() };
        let whole = contents();
        assert_eq!(run(&bake), Outcome::Kept(made.clone()));
        for path in [
            &made[0],
            &made[made.len() - 1],
            &folder.path().join(if projection == Projection::Cube { "slope.json" } else { "height.json" }),
        ] {
            let mut damaged = fs::read(path).unwrap();
            let middle = damaged.len() / 2;
            damaged[middle] ^= 1;
            fs::write(path, &damaged).unwrap();
            assert_eq!(run(&bake), Outcome::Done(made.clone()), "{}", path.display());
            assert!(contents() == whole);
        }
        // A late shard has nothing to do, however the maps were encoded, and leaves nothing.
        let count = || fs::read_dir(folder.path()).unwrap().count();
        let before = count();
        bake.shard = Some(Shard { number: 2, count: 3 });
        assert_eq!(run(&bake), Outcome::Kept(made.clone()));
        bake.format = Format::Exr;
        assert!(matches!(run(&bake), Outcome::Kept(_)));
        assert_eq!(count(), before);
        // Another bake has.
        (bake.shard, bake.format, bake.heights_m) = (None, format, Some([-3000.0, 3000.0]));
        assert!(matches!(run(&bake), Outcome::Done(_)));
        bake.size = 64;
        assert!(matches!(run(&bake), Outcome::Done(_)));
    }
}

#[test]
fn no_map_is_replaced_before_all_are_complete() {
    let bake = bake(&[Map::Height, Map::Normal], Projection::Equirect, 64, Format::Png16);
    let folder = tempfile::tempdir().unwrap();
    assert!(matches!(bake.run(folder.path(), &|_| true).unwrap(), Outcome::Done(_)));
    let before = files(folder.path());
    // Stops at each of the last steps, while files are encoded.
    let larger = Bake { size: 128, ..bake };
    let steps = AtomicU32::new(0);
    let elsewhere = tempfile::tempdir().unwrap();
    larger.run(elsewhere.path(), &|_| steps.fetch_add(1, Ordering::Relaxed) < u32::MAX).unwrap();
    let all = steps.load(Ordering::Relaxed);
    let mut most = all / 2;
    loop {
        let asked = AtomicU32::new(0);
        let outcome = larger.run(folder.path(), &|_| asked.fetch_add(1, Ordering::Relaxed) < most).unwrap();
        let mut found = files_of(folder.path());
        if outcome != Outcome::Stopped {
            assert!(found == files_of(elsewhere.path()));
            break;
        }
        found.retain(|name, _| !name.ends_with(".strips"));
        assert!(found == before);
        most += 1;
        assert!(most <= all);
    }
}

/// As [`files`], without folders.
fn files_of(folder: &Path) -> BTreeMap<String, Vec<u8>> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap()).filter(|entry| entry.path().is_file());
    entries.map(|entry| (entry.file_name().into_string().unwrap(), fs::read(entry.path()).unwrap())).collect()
}

#[test]
fn what_all_detail_takes_is_found_before() {
    let text = r#"(version: 3, name: "Rills", structure: (grids: 1), water: (level_m: 0))"#;
    let planet = Planet::from_text("rills.ron", text).unwrap();
    let terrain = Arc::new(Terrain::try_new(planet.into()).unwrap());
    let mut rivers = Bake::new(terrain, vec![Map::Height, Map::Normal], Projection::Equirect, 32, Format::Png16);
    let folder = tempfile::tempdir().unwrap();
    assert!(rivers.expected(folder.path()).is_none(), "the detail of a pixel");
    rivers.detail = Detail::All;
    let expected = rivers.expected(folder.path()).unwrap();
    assert_eq!((expected.pixels, expected.strip_bytes), (512, 512 * 16));
    assert!(expected.secs > 0.0 && folder.path().read_dir().unwrap().count() == 0);
    rivers.shard = Some(Shard { number: 1, count: 2 });
    rivers.run(folder.path(), &|_| true).unwrap();
    rivers.shard = None;
    assert_eq!(rivers.expected(folder.path()).unwrap().pixels, 256);
    rivers.run(folder.path(), &|_| true).unwrap();
    assert!(rivers.expected(folder.path()).is_none(), "nothing is left to do");
    let plain = bake(&[Map::Height], Projection::Equirect, 32, Format::Png16);
    assert!(Bake { detail: Detail::All, ..plain }.expected(folder.path()).is_none(), "a planet without a structure");
}
