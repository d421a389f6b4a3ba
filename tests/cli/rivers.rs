//! `tellus rivers`, `tellus coasts`, and `tellus sample` at many points.

use crate::LAYERED;
use serde_json::Value;
use std::path::PathBuf;

fn run(args: &[&str], input: &str) -> (i32, String, String) {
    let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
    command.env("TELLUS_MAPS", "").current_dir(env!("CARGO_MANIFEST_DIR")).args(args).write_stdin(input);
    let output = command.output().unwrap();
    let text = |bytes: Vec<u8>| String::from_utf8(bytes).unwrap();
    (output.status.code().unwrap_or(-1), text(output.stdout), text(output.stderr))
}

/// A planet whose rivers are solved in a moment.
fn rills(folder: &tempfile::TempDir) -> PathBuf {
    let path = folder.path().join("rills.ron");
    let text = "(version: 3, name: \"Rills\", structure: (grids: 1), water: (level_m: 0))";
    std::fs::write(&path, text).unwrap();
    path
}

fn json_lines(out: &str) -> Vec<Value> {
    out.lines().map(|line| serde_json::from_str(line).unwrap()).collect()
}

/// All positions of a geometry, at any depth of its coordinates.
fn positions(coordinates: &Value, found: &mut Vec<[f64; 2]>) {
    let array = coordinates.as_array().unwrap();
    if array[0].is_number() {
        found.push([array[0].as_f64().unwrap(), array[1].as_f64().unwrap()]);
    } else {
        array.iter().for_each(|inner| positions(inner, found));
    }
}

fn numbers(value: &Value) -> Vec<f64> {
    value.as_array().unwrap().iter().map(|number| number.as_f64().unwrap()).collect()
}

#[test]
fn rivers_are_written_as_geojson() {
    let folder = tempfile::tempdir().unwrap();
    let (planet, out) = (rills(&folder), folder.path().join("out.geojson"));
    let args = ["rivers", planet.to_str().unwrap(), "-o", out.to_str().unwrap(), "--min-discharge", "100"];
    let (status, shown, err) = run(&args, "");
    assert_eq!((status, shown.as_str(), err.as_str()), (0, "", ""));
    let first = std::fs::read(&out).unwrap();
    let all: Value = serde_json::from_slice(&first).unwrap();
    assert_eq!(all["type"], "FeatureCollection");
    let features = all["features"].as_array().unwrap();
    for feature in features {
        let mut places = Vec::new();
        positions(&feature["geometry"]["coordinates"], &mut places);
        assert!(places.iter().all(|[lon, lat]| lon.abs() <= 180.0 && lat.abs() <= 90.0), "{feature}");
    }
    let of = |kind: &str| features.iter().filter(|feature| feature["properties"]["kind"] == kind).collect::<Vec<_>>();
    let (rivers, basins) = (of("river"), of("basin"));
    assert!(rivers.len() > 50 && basins.len() > 20, "{} rivers, {} basins", rivers.len(), basins.len());
    for river in rivers {
        let (geometry, properties) = (&river["geometry"], &river["properties"]);
        let nested = |value: &Value| value.as_array().unwrap().clone();
        let (lines, parts) = match geometry["type"].as_str().unwrap() {
            "LineString" => (vec![geometry["coordinates"].clone()], vec![properties.clone()]),
            "MultiLineString" => {
                let keys = ["height_m", "width_m", "discharge_m3_s"];
                let part =
                    |k: usize| keys.map(|key| (key.to_owned(), properties[key][k].clone())).into_iter().collect();
                let lines = nested(&geometry["coordinates"]);
                let parts = (0..lines.len()).map(part).collect();
                (lines, parts)
            }
            other => panic!("{other}"),
        };
        for (line, part) in lines.iter().zip(&parts) {
            let mut places = Vec::new();
            positions(line, &mut places);
            assert!(places.len() >= 2, "{river}");
            assert!(places.windows(2).all(|pair| (pair[0][0] - pair[1][0]).abs() <= 180.0), "{river}");
            let [height_m, width_m, discharge] =
                ["height_m", "width_m", "discharge_m3_s"].map(|key| numbers(&part[key]));
            assert_eq!([height_m.len(), width_m.len(), discharge.len()], [places.len(); 3]);
            assert!(height_m.is_sorted_by(|a, b| a >= b) && discharge.is_sorted(), "{river}");
        }
        assert!(properties["length_km"].as_f64().unwrap() > 0.0, "{river}");
        assert!(properties["mouth_discharge_m3_s"].as_f64().unwrap() >= 100.0, "{river}");
        assert!(["sea", "lake", "river", "ground"].contains(&properties["into"].as_str().unwrap()), "{river}");
    }
    // The same command writes the same file.
    assert_eq!(run(&args, "").0, 0);
    assert!(std::fs::read(&out).unwrap() == first);
}

#[test]
fn what_has_no_rivers_or_cannot_be_written_is_said() {
    let folder = tempfile::tempdir().unwrap();
    let (planet, out) = (rills(&folder), folder.path().join("out.geojson"));
    let (planet, out_text) = (planet.to_str().unwrap(), out.to_str().unwrap());
    let moon = "tests/fixtures/earth_air.ron";
    let (status, _, err) = run(&["rivers", moon, "-o", out_text], "");
    assert!(status == 1 && err.contains("has no structure, so it has no rivers") && !out.exists(), "{err}");
    let (status, _, err) = run(&["rivers", planet, "-o", "no/such/folder/x.geojson"], "");
    assert!(status == 1 && err.contains("there is no folder"), "{err}");
    for (more, part) in [("much", "this is not a number; use 0 to"), ("-1", "-1 is out of range; use 0 to")] {
        let (status, _, err) = run(&["rivers", planet, "-o", out_text, "--min-discharge", more], "");
        assert!(status == 2 && err.contains(part), "{err}");
    }
    let (status, _, err) = run(&["rivers", planet], "");
    assert!(status == 2 && err.contains("--output <OUT.geojson>"), "{err}");
}

#[test]
fn maps_are_written_once_and_then_read() {
    let folder = tempfile::tempdir().unwrap();
    let planet = rills(&folder);
    let (planet, maps) = (planet.to_str().unwrap(), folder.path().join("game").join("maps"));
    let names = || {
        let mut names: Vec<_> = std::fs::read_dir(&maps).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        names.sort();
        names
    };
    assert_eq!(run(&["maps", planet, "-o", maps.to_str().unwrap()], ""), (0, String::new(), String::new()));
    let first = names();
    assert_eq!(first.len(), 3, "{first:?}");
    let (status, _, err) = run(&["maps", planet, LAYERED, "-o", maps.to_str().unwrap()], "");
    assert!(status == 0 && err.contains("layered.ron: has no structure, so nothing was written for it"), "{err}");
    assert_eq!(names(), first);
    // The answers are the same with the maps.
    let ask = |maps: &str| {
        let mut command = assert_cmd::cargo::cargo_bin_cmd!("tellus");
        command.env("TELLUS_MAPS", maps).current_dir(env!("CARGO_MANIFEST_DIR"));
        let output = command.args(["sample", planet, "--lat", "12", "--lon", "34", "--json"]).output().unwrap();
        assert_eq!((output.status.code(), output.stderr.as_slice()), (Some(0), b"".as_slice()));
        output.stdout
    };
    assert_eq!(ask(maps.to_str().unwrap()), ask(""));
    let (status, _, err) = run(&["maps", planet, "-o", planet], "");
    assert!(status == 1 && err.contains("is a file; name a folder"), "{err}");
}

#[test]
fn many_points_are_answered_in_order() {
    let input = "# the first two\n-33.5,-70\n\n 10 , 20\r\n90,0";
    let (status, out, err) = run(&["sample", LAYERED, "--points", "-"], input);
    assert_eq!((status, err.as_str()), (0, ""));
    let answers = json_lines(&out);
    let places: Vec<[f64; 2]> =
        answers.iter().map(|answer| ["lat", "lon"].map(|key| answer[key].as_f64().unwrap())).collect();
    assert_eq!(places, [[-33.5, -70.0], [10.0, 20.0], [90.0, 0.0]]);
    let (_, one, _) = run(&["sample", LAYERED, "--lat", "-33.5", "--lon", "-70", "--json"], "");
    let one: Value = serde_json::from_str(&one).unwrap();
    for (key, value) in one.as_object().unwrap() {
        assert_eq!(answers[0][key], *value, "{key}");
    }
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("points.csv");
    // Two batches, and a part of one.
    std::fs::write(&file, [input, &"\n1,2".repeat(9000)].concat()).unwrap();
    let (status, again, _) = run(&["sample", LAYERED, "--points", file.to_str().unwrap()], "");
    assert_eq!((status, again.lines().count()), (0, 9003));
    assert!(again.starts_with(&out));
    assert_eq!(run(&["sample", LAYERED, "--points", "-"], "\n# nothing\n"), (0, String::new(), String::new()));
}

#[test]
fn a_wrong_line_is_named_and_what_stands_before_it_is_answered() {
    let (status, out, err) = run(&["sample", LAYERED, "--points", "-"], "1,2\n# 3\n91,5\n4,5\n");
    assert_eq!((status, out.lines().count()), (1, 1));
    assert_eq!(err, "error: standard input:3: latitude: 91 is out of range; use -90 to 90\n");
    let (status, _, err) = run(&["sample", LAYERED, "--points", "-"], "north\n");
    assert!(status == 1 && err.contains(":1: this is not a location; write LAT,LON such as 20,-45"), "{err}");
    let (status, _, err) = run(&["sample", LAYERED, "--points", "-"], &"1".repeat(100_000));
    assert!(status == 1 && err.contains("LAT,LON"), "{err}");
    let (status, _, err) = run(&["sample", LAYERED, "--points", "no.csv"], "");
    assert!(status == 1 && err.starts_with("error: no.csv: "), "{err}");
    let (status, _, err) = run(&["sample", LAYERED, "--points", "-", "--lat", "5"], "");
    assert!(status == 2 && err.contains("cannot be used with"), "{err}");
}

#[test]
fn a_sample_on_a_planet_with_rivers_says_what_water_there_is() {
    let folder = tempfile::tempdir().unwrap();
    let planet = rills(&folder);
    let out = folder.path().join("out.geojson");
    let (planet, out_text) = (planet.to_str().unwrap(), out.to_str().unwrap());
    assert_eq!(run(&["rivers", planet, "-o", out_text, "--min-discharge", "1000"], "").0, 0);
    let all: Value = serde_json::from_slice(&std::fs::read(&out).unwrap()).unwrap();
    let lines =
        all["features"].as_array().unwrap().iter().filter(|feature| feature["geometry"]["type"] == "LineString");
    let mut input = String::new();
    for line in lines.take(10) {
        let coordinates = line["geometry"]["coordinates"].as_array().unwrap();
        let middle = &coordinates[coordinates.len() / 2];
        input.extend([middle[1].to_string(), ",".to_owned(), middle[0].to_string(), "\n".to_owned()]);
    }
    let (status, shown, err) = run(&["sample", planet, "--points", "-"], &input);
    assert_eq!((status, err.as_str()), (0, ""));
    let answers = json_lines(&shown);
    let wet = answers.iter().filter(|answer| answer["water_level_m"].is_number()).count();
    assert!(wet * 10 >= answers.len() * 9, "{wet} of {}", answers.len());
    for answer in answers {
        assert!(answer["rain_mm"].is_number() && answer["plate"].is_number(), "{answer}");
        assert_eq!(numbers(&answer["wind_m_s"]).len(), 2);
        assert!(answer["river"].is_null() || answer["river"]["width_m"].as_f64().unwrap() > 0.0, "{answer}");
    }
    let first = input.lines().next().unwrap().split_once(',').unwrap();
    let (status, shown, _) = run(&["sample", planet, "--lat", first.0, "--lon", first.1], "");
    assert!(status == 0 && shown.contains("wind   ") && shown.contains("basin  "), "{shown}");
}

#[test]
fn coasts_are_closed_lines_at_the_sea_level() {
    let folder = tempfile::tempdir().unwrap();
    let out = folder.path().join("out.geojson");
    let out = out.to_str().unwrap();
    let coasts = |more: &[&str]| {
        let (status, shown, err) = run(&[&["coasts", LAYERED, "-o", out], more].concat(), "");
        assert_eq!((status, shown.as_str(), err.as_str()), (0, "", ""));
        let all: Value = serde_json::from_slice(&std::fs::read(out).unwrap()).unwrap();
        all["features"].as_array().unwrap().clone()
    };
    let lines = coasts(&["--spacing", "100000"]);
    assert!(lines.len() > 20, "{}", lines.len());
    let mut places = Vec::new();
    for line in &lines {
        let mut points = Vec::new();
        positions(&line["geometry"]["coordinates"], &mut points);
        assert!(points.len() >= 4 && points.first() == points.last(), "{line}");
        places.extend(points.into_iter().step_by(40));
    }
    let input: String = places.iter().map(|[lon, lat]| format!("{lat},{lon}\n")).collect();
    let (_, answers, _) = run(&["sample", LAYERED, "--points", "-"], &input);
    let level_m = tellus::planet::Planet::load(LAYERED).unwrap().sea_level_m().unwrap();
    for answer in json_lines(&answers) {
        // Coordinates are rounded to a decimetre.
        assert!((answer["height_m"].as_f64().unwrap() - level_m).abs() < 0.5, "{answer}");
    }
    let long = coasts(&["--spacing", "100000", "--min-length", "3000"]);
    assert!(!long.is_empty() && long.len() < lines.len());
    assert!(long.iter().all(|line| line["properties"]["length_km"].as_f64().unwrap() >= 3000.0));
    let high = coasts(&["--spacing", "100000", "--height", "2000"]);
    assert!(high.iter().all(|line| line["properties"]["height_m"] == 2000.0));

    let (status, _, err) = run(&["coasts", "planets/pallor.ron", "-o", out], "");
    assert!(status == 1 && err.contains("has no sea; name the --height"), "{err}");
    let (status, _, err) = run(&["coasts", LAYERED, "-o", out, "--spacing", "1"], "");
    assert!(status == 1 && err.contains("use 610.812 m or more"), "{err}");
}

#[test]
fn the_nearest_place_has_what_was_asked_for() {
    let at = ["--lat", "10", "--lon", "20", "--json"];
    let nearest = |more: &[&str]| run(&[&["nearest", LAYERED][..], &at, more].concat(), "");
    for what in ["land", "sea"] {
        let (code, out, err) = nearest(&["--what", what, "--within", "4000"]);
        assert_eq!((code, err.as_str()), (0, ""));
        let place: Value = serde_json::from_str(&out).unwrap();
        let number = |key: &str| place[key].as_f64().unwrap_or_else(|| panic!("{key}: {place}"));
        let sea_m = place["water_level_m"].as_f64();
        assert_eq!(sea_m.is_some_and(|level_m| level_m > number("height_m")), what == "sea", "{place}");
        assert!(number("distance_m") <= 4e6);
        // What `tellus sample` answers there.
        let (lat, lon) = (number("lat").to_string(), number("lon").to_string());
        let (_, out, _) = run(&["sample", LAYERED, "--lat", &lat, "--lon", &lon, "--json"], "");
        let sample: Value = serde_json::from_str(&out).unwrap();
        assert!((sample["height_m"].as_f64().unwrap() - number("height_m")).abs() < 0.1);
    }
    let (code, out, err) = nearest(&["--above", "50000"]);
    assert_eq!((code, out.as_str()), (1, ""));
    assert!(err.contains("no such place within 1000 km"), "{err}");
    let (code, _, err) = nearest(&["--biome", "Cheese"]);
    assert!(code == 1 && err.contains("has no biome Cheese; it has "), "{err}");
    let (code, _, err) = nearest(&["--what", "land", "--spacing", "1"]);
    assert!(code == 1 && err.contains("million points"), "{err}");
    assert_eq!(nearest(&[]).0, 2);
}
