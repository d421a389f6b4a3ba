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
}
