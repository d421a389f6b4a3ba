//! Objects of a region as a table and as points, against the library.

use crate::LAYERED;
use serde_json::Value;
use std::path::Path;
use std::sync::Arc;
use tellus::planet::life::ReadyPopulation;
use tellus::planet::{Planet, Population};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

/// A planet with two populations, in a folder of its own; the path of the preset.
fn preset(folder: &Path) -> std::path::PathBuf {
    let mut planet = Planet::load(Path::new(LAYERED)).unwrap();
    let boulders = ReadyPopulation::named("Boulder").unwrap();
    let quoted = "Stones, \"small\"".to_owned();
    planet.life = vec![
        Population { per_hectare: 30.0, shore_m: 0.0, in_water: true, ..boulders.clone() },
        Population { name: quoted, per_hectare: 60.0, shore_m: 0.0, in_water: true, slope_to_deg: 90.0, ..boulders },
    ];
    let path = folder.join("stony.ron");
    planet.save(&path).unwrap();
    path
}

fn tellus(args: &[&str]) -> (bool, String) {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
    let output = command.env("TELLUS_MAPS", "").args(args).output().unwrap();
    (output.status.success(), String::from_utf8(output.stderr).unwrap())
}

#[test]
fn a_table_and_points_hold_the_objects_of_the_library() {
    let folder = tempfile::tempdir().unwrap();
    let preset = preset(folder.path());
    let [table, points] = ["out.csv", "out.geojson"].map(|name| folder.path().join(name));
    for output in [&table, &points] {
        let place = ["--lat", "12", "--lon", "-30", "--km", "0.4", "-o", output.to_str().unwrap()];
        let (done, message) = tellus(&[&["instances", preset.to_str().unwrap()], &place[..]].concat());
        assert!(done, "{message}");
    }
    let planet = Planet::load(&preset).unwrap();
    let terrain = Terrain::try_new(Arc::new(planet.clone())).unwrap();
    let middle = LatLon::from_degrees(12.0, -30.0);
    let within = terrain.instances(middle.direction(), 200.0).unwrap();
    let text = std::fs::read_to_string(table).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines[0], "id,kind,latitude_deg,longitude_deg,height_m,turn_deg,scale");
    let ids: Vec<u64> = lines[1..].iter().map(|line| line.split(',').next().unwrap().parse().unwrap()).collect();
    assert!(ids.is_sorted() && ids.len() > 500, "{}", ids.len());
    // The square holds the circle within it, and little more than 4 / pi of it.
    assert!(within.iter().all(|instance| ids.binary_search(&instance.id).is_ok()));
    let share = ids.len() as f64 / within.len() as f64;
    assert!((1.15..1.4).contains(&share), "{share}");
    assert!(lines.iter().any(|line| line.contains("\"Stones, \"\"small\"\"\"")), "names are quoted");
    let found: Value = serde_json::from_slice(&std::fs::read(points).unwrap()).unwrap();
    let features = found["features"].as_array().unwrap();
    assert_eq!(features.len(), ids.len());
    for (feature, line) in features.iter().zip(&lines[1..]).step_by(40) {
        let properties = &feature["properties"];
        let id: u64 = properties["id"].as_str().unwrap().parse().unwrap();
        assert!(line.starts_with(&format!("{id},")), "{line}");
        let at: [f64; 3] = serde_json::from_value(feature["geometry"]["coordinates"].clone()).unwrap();
        let ground_m = terrain.height_m(LatLon::from_degrees(at[1], at[0]).direction());
        assert!((-0.05..2.0).contains(&(ground_m - at[2])), "{ground_m} {at:?}");
    }
}

#[test]
fn what_cannot_be_written_is_refused_with_what_would_be_right() {
    let folder = tempfile::tempdir().unwrap();
    let preset = preset(folder.path());
    let preset = preset.to_str().unwrap();
    let output = folder.path().join("out.csv");
    let output = output.to_str().unwrap();
    let place = ["--lat", "1", "--lon", "2"];
    for (more, part) in [
        (&["-o", output, "--km", "5000"][..], "ask for a smaller part"),
        (&["-o", output, "--kind", "Trees"], "there is no population \"Trees\"; use Boulder"),
        (&["-o", "out.png"], "use .csv"),
    ] {
        let (done, message) = tellus(&[&["instances", preset], &place[..], more].concat());
        assert!(!done && message.contains(part), "{message}");
    }
    let (done, message) = tellus(&["instances", LAYERED, "--lat", "1", "--lon", "2", "-o", output, "--kind", "Trees"]);
    assert!(!done && message.contains("has no populations"), "{message}");
}
