//! Coasts as lines and as polygons: valid GeoJSON, and what `tellus sample` says is land is within land.

use crate::dice::Dice;
use serde_json::Value;
use tellus::planet::Planet;
use tellus::terrain::Terrain;

type Place = [f64; 2];

fn coasts(preset: &str, more: &[&str]) -> Vec<Value> {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("coasts.geojson");
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
    command.env("TELLUS_MAPS", "").current_dir(env!("CARGO_MANIFEST_DIR"));
    command.args(["coasts", preset, "-o", path.to_str().unwrap()]).args(more);
    let output = command.output().unwrap();
    assert!(output.status.success(), "{}", String::from_utf8_lossy(&output.stderr));
    let found: Value = serde_json::from_slice(&std::fs::read(path).unwrap()).unwrap();
    found["features"].as_array().unwrap().clone()
}

fn line(value: &Value) -> Vec<Place> {
    serde_json::from_value(value.clone()).unwrap()
}

fn lines(geometry: &Value) -> Vec<Vec<Place>> {
    match geometry["type"].as_str().unwrap() {
        "LineString" => vec![line(&geometry["coordinates"])],
        _ => geometry["coordinates"].as_array().unwrap().iter().map(line).collect(),
    }
}

#[test]
fn parts_have_a_length_and_no_point_twice() {
    for (preset, height, spacing) in
        [("planets/pallor.ron", "0", "40000"), ("planets/pallor.ron", "-200", "20000"), (crate::LAYERED, "50", "4000")]
    {
        let found = coasts(preset, &["--height", height, "--spacing", spacing]);
        assert!(found.len() > 5, "{preset}: {}", found.len());
        let mut crossing = 0;
        for feature in &found {
            let parts = lines(&feature["geometry"]);
            crossing += usize::from(parts.len() > 1);
            for part in &parts {
                assert!(part.len() > 1 && part.windows(2).all(|pair| pair[0] != pair[1]), "{preset}: {part:?}");
            }
        }
        assert!(crossing > 0, "{preset}: nothing crosses the antimeridian");
    }
}

fn contains(ring: &[Place], [lon, lat]: Place) -> bool {
    let crosses = |pair: &&[Place]| {
        let ([x0, y0], [x1, y1]) = (pair[0], pair[1]);
        (y0 > lat) != (y1 > lat) && lon < x0 + (lat - y0) / (y1 - y0) * (x1 - x0)
    };
    ring.windows(2).filter(crosses).count() % 2 == 1
}

fn area(ring: &[Place]) -> f64 {
    0.5 * ring.windows(2).map(|pair| pair[0][0] * pair[1][1] - pair[1][0] * pair[0][1]).sum::<f64>()
}

#[test]
fn polygons_of_land_and_water_cover_the_globe_and_agree_with_the_ground() {
    let planet = Planet::load(format!("{}/planets/pallor.ron", env!("CARGO_MANIFEST_DIR"))).unwrap();
    let terrain = Terrain::try_new(planet.into()).unwrap();
    let found = coasts("planets/pallor.ron", &["--height", "0", "--spacing", "20000", "--as", "polygons"]);
    let polygons: Vec<(bool, Vec<Vec<Place>>)> =
        found.iter().map(|feature| (feature["properties"]["kind"] == "land", lines(&feature["geometry"]))).collect();
    assert!(found.iter().all(|feature| feature["geometry"]["type"] == "Polygon"));
    for (_, rings) in &polygons {
        assert!(area(&rings[0]) > 0.0 && rings[1..].iter().all(|hole| area(hole) < 0.0));
        assert!(rings.iter().all(|ring| ring.len() > 3 && ring.first() == ring.last()));
    }
    let total: f64 = polygons.iter().flat_map(|(_, rings)| rings).map(|ring| area(ring)).sum();
    assert!((total - 360.0 * 180.0).abs() < 1e-3, "{total} square degrees");
    let (mut dice, mut agree) = (Dice(7), 0);
    for _ in 0..500 {
        let at = dice.place();
        let (lat, lon) = at.to_degrees();
        let place = [lon, lat];
        let within =
            |rings: &[Vec<Place>]| contains(&rings[0], place) && !rings[1..].iter().any(|hole| contains(hole, place));
        let around: Vec<bool> =
            polygons.iter().filter(|(_, rings)| within(rings)).map(|(is_land, _)| *is_land).collect();
        assert_eq!(around.len(), 1, "{place:?} is in one polygon");
        let height_m = terrain.height_m(at.direction());
        agree += usize::from(around[0] == (height_m >= 0.0));
    }
    // Craters smaller than the spacing are left out.
    assert!(agree > 430, "{agree} of 500");
}
