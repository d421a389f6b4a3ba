//! Invalid planets and invalid directions: the result is a typed error or a finite number, never a panic.

use crate::support::edits::full_planet;
use glam::DVec3;
use std::sync::Arc;
use std::time::Duration;
use tellus::atmosphere::Air;
use tellus::lod::{Quality, opening};
use tellus::planet::param::{ParamPath, Value};
use tellus::planet::{InvalidPlanet, Planet, Table, diff, random};
use tellus::terrain::{Revision, Terrain, Wanted};
use tellus::tiles::{Builder, build_now};

/// Values of all types, none of them reasonable.
fn nonsense(value: &Value) -> Vec<Value> {
    const NUMBERS: [f64; 8] = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, -5.0, 0.0, 1e300, -1e300, 5e-324];
    match value {
        Value::Number(_) => NUMBERS.map(Value::Number).to_vec(),
        Value::Count(_) => vec![Value::Count(0), Value::Count(u32::MAX)],
        Value::Triple(_) => NUMBERS.map(|number| Value::Triple([0.5, number, 0.5])).to_vec(),
        Value::Curve(_) => {
            let curve = |points: &[[f64; 2]]| Value::Curve(points.to_vec());
            vec![
                curve(&[[0.0, 0.0]]),
                curve(&[[0.0, 0.0], [0.0, 1.0], [-3.0, f64::NAN]]),
                curve(&[[f64::NAN, 0.0], [f64::INFINITY, 1.0]]),
            ]
        }
        Value::Text(_) => vec![Value::Text(String::new()), Value::Text("no such thing".repeat(99))],
        Value::Letter(_) => vec![Value::Letter('\0'), Value::Letter('ß')],
        Value::Flag(_) | Value::Choice(_) => Vec::new(),
    }
}

/// Planets with one problem each, and the path of the problem.
fn broken_planets() -> Vec<(String, Planet)> {
    let planet = full_planet();
    let mut places: Vec<(ParamPath, Value)> = Vec::new();
    planet.each_value(&mut |path, _, value| places.push((path.clone(), value.get())));
    let mut broken: Vec<(String, Planet)> = Vec::new();
    for (path, value) in places {
        for wrong in nonsense(&value) {
            let mut edited = planet.clone();
            edited.each(&mut |at, _, mut value| {
                if *at == path {
                    value.set(&wrong);
                }
            });
            if edited.check().is_err() {
                broken.push((format!("{path} = {wrong:?}"), edited));
            }
        }
    }
    let mut with = |what: &str, change: &dyn Fn(&mut Planet)| {
        let mut edited = planet.clone();
        change(&mut edited);
        broken.push((what.to_owned(), edited));
    };
    with("no biome", &|planet| planet.biomes.palette.clear());
    with("a table without biomes", &|planet| planet.biomes.table = Table::uniform('?', 8, 8));
    with("too many layers", &|planet| planet.layers = vec![planet.layers[0].clone(); 65]);
    with("a layer that masks itself", &|planet| {
        let name = planet.layers[1].name.clone();
        planet.layers[1].masks[0].set_layer(&name);
    });
    broken
}

#[test]
fn no_planet_that_is_not_valid_is_evaluated() {
    let valid = Arc::new(full_planet());
    let broken = broken_planets();
    assert!(broken.len() > 1000, "{}", broken.len());
    for (what, planet) in broken {
        let planet = Arc::new(planet);
        // Functions that do not evaluate may return anything, but must return.
        let view = opening::opening_view(&planet, [64, 64], Quality::Low);
        let _ = opening::default_pitch_deg(&planet, 1000.0);
        let _ = (diff::diff(&valid, &planet), diff::diff(&planet, &valid));
        let _ = (planet.star.place(1e9), planet.star.hour(10.0, 1e9), planet.star.season_deg());
        let _ = random::vary(&planet, 3, 0.5);
        let _ = Air::returned_share(&planet, 1000.0);
        let _ = planet.to_text();
        // Functions that evaluate must refuse.
        let said = |error: Result<(), InvalidPlanet>| {
            let error = error.err().unwrap_or_else(|| panic!("{what} was taken"));
            assert!(
                !error.problems.is_empty() && error.to_string().starts_with("the planet is not valid: "),
                "{error}"
            );
        };
        said(Terrain::try_new(planet.clone()).map(drop));
        said(Revision::try_new(planet.clone()).map(drop));
        said(build_now(&planet, &view).map(drop));
        said(Air::try_new(&planet).map(drop));
        assert!(planet.save(std::env::temp_dir().join("never.ron")).is_err(), "{what} was saved");
    }
}

#[test]
fn an_invalid_planet_says_where_and_what_would_be_right() {
    let planet = Planet { radius_km: -5.0, ..Planet::default() };
    let error = Terrain::try_new(Arc::new(planet)).unwrap_err();
    assert_eq!(error.to_string(), "the planet is not valid: radius_km: -5 is out of range; use 1 to 100000 km");
    assert_eq!((error.problems.len(), error.problems[0].0.to_string()), (1, "radius_km".to_owned()));
}

#[test]
fn a_builder_tells_what_is_wrong_with_a_planet_and_goes_on_with_the_next() {
    let builder = Builder::new(|| {});
    let valid = Arc::new(Planet::default());
    let view = opening::opening_view(&valid, [64, 64], Quality::Low);
    let settle = |planet: &Arc<Planet>| {
        builder.request(planet, &view).unwrap();
        while builder.is_busy() {
            std::thread::sleep(Duration::from_millis(1));
        }
    };
    settle(&valid);
    for (what, planet) in broken_planets().into_iter().step_by(40) {
        let Err(error) = builder.request(&Arc::new(planet), &view) else { panic!("{what} is built") };
        assert!(error.to_string().starts_with("the planet is not valid: "), "{what}: {error}");
        // The surface on screen stays.
        assert!(builder.surface().is_some_and(|surface| surface.complete));
    }
    settle(&Arc::new(Planet { radius_km: 3000.0, ..Planet::default() }));
    assert_eq!(builder.error(), None);
    assert!(builder.surface().is_some_and(|surface| surface.terrain.planet().radius_km == 3000.0));
}

#[test]
fn every_direction_has_a_finite_answer() {
    let terrain = Terrain::try_new(Arc::new(full_planet())).unwrap();
    let dir = DVec3::new(0.3, -0.5, 0.7);
    let right = terrain.sample(dir);
    for scale in [5e-324, 1e-310, 1e-200, 1e-170, 1e-3, 1e3, 1e150, 1e200, 1e307] {
        let scaled = dir * scale;
        let sample = terrain.sample(scaled);
        assert!(sample.height_m.is_finite() && sample.normal_planet.is_finite(), "{scale}: {sample:?}");
        assert_eq!((terrain.height_m(scaled), terrain.heights_m(&[scaled])), (sample.height_m, vec![sample.height_m]));
        // Numbers this small have few digits left for a direction.
        if scale > 1e-300 {
            assert!((sample.height_m - right.height_m).abs() < 1e-3, "{scale}: {} {}", sample.height_m, right.height_m);
            assert!(sample.normal_planet.angle_between(right.normal_planet) < 1e-6, "{scale}");
        }
        let (lo, hi) = terrain.height_bounds_near_m(scaled, 0.01);
        assert!(lo <= sample.height_m && sample.height_m <= hi);
        assert_eq!(terrain.samples(&[scaled], Wanted::ALL), vec![sample]);
    }
    let pole = terrain.sample(DVec3::Z);
    let nowhere = [f64::NAN, f64::INFINITY, f64::NEG_INFINITY].map(|x| DVec3::new(x, 0.0, 1.0));
    for dir in [DVec3::ZERO, -DVec3::ZERO, DVec3::NAN, DVec3::INFINITY].into_iter().chain(nowhere) {
        assert_eq!(terrain.sample(dir), pole, "{dir}");
        assert_eq!(terrain.height_m(dir), pole.height_m);
        assert_eq!(terrain.samples(&[dir], Wanted::ALL), vec![pole]);
        for angle_rad in [0.0, -0.1, 0.2, 1e300, f64::NAN, f64::INFINITY] {
            let (lo, hi) = terrain.height_bounds_near_m(dir, angle_rad);
            assert!(lo <= pole.height_m && pole.height_m <= hi, "{dir} {angle_rad}: {lo} to {hi}");
        }
    }
}

#[test]
fn a_ray_from_nowhere_or_to_nowhere_meets_nothing() {
    let terrain = Terrain::try_new(Arc::new(full_planet())).unwrap();
    let (above, down) = (DVec3::X * 2.0 * terrain.planet().radius_m(), DVec3::NEG_X);
    let right_m = terrain.raycast(above, down).unwrap();
    for scale in [1e-310, 1e-200, 1e-3, 7.0, 1e200] {
        assert!((terrain.raycast(above, down * scale).unwrap() - right_m).abs() < 1e-6, "{scale}");
    }
    for dir in [DVec3::ZERO, DVec3::NAN, DVec3::INFINITY, DVec3::new(f64::NAN, -1.0, 0.0)] {
        assert_eq!(terrain.raycast(above, dir), None, "{dir}");
    }
    for origin in [DVec3::NAN, DVec3::INFINITY, DVec3::new(0.0, f64::NEG_INFINITY, 0.0)] {
        assert_eq!(terrain.raycast(origin, down), None, "{origin}");
    }
    assert_eq!(terrain.raycast(DVec3::X * 1e300, DVec3::X), None);
    assert_eq!(terrain.raycast(DVec3::ZERO, DVec3::X), Some(0.0), "within the ground");
}
