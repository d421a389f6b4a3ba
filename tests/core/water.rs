//! Rivers, lakes, basins and weather of a planet with a structure: as a description, and at points.

use crate::support::layered::layered;
use std::collections::{BTreeMap, BTreeSet};
use std::f64::consts::PI;
use std::sync::{Arc, OnceLock};
use tellus::glam::DVec3;
use tellus::planet::{Fbm, Layer, Planet, Shape, Structure, Water};
use tellus::sphere::spread;
use tellus::terrain::{Course, CoursePoint, Mouth, Rivers, Scratch, Terrain, Wanted};

pub(crate) fn planet() -> Planet {
    Planet {
        structure: Some(Structure { grids: 1, ..Structure::default() }),
        water: Some(Water::default()),
        ..Planet::default()
    }
}

fn terrain() -> &'static Terrain {
    static ONCE: OnceLock<Terrain> = OnceLock::new();
    ONCE.get_or_init(|| Terrain::try_new(planet().into()).unwrap())
}

fn rivers() -> &'static Rivers {
    static ONCE: OnceLock<Rivers> = OnceLock::new();
    ONCE.get_or_init(|| terrain().rivers(50.0))
}

fn mouth(course: &Course) -> CoursePoint {
    *course.points.last().unwrap()
}

#[test]
fn beds_never_rise_and_discharge_never_falls_towards_the_mouth() {
    let rivers = rivers();
    assert!(rivers.courses.len() > 100, "{}", rivers.courses.len());
    for course in &rivers.courses {
        assert!(course.points.len() >= 2 && course.length_km > 0.0, "{}", course.id);
        assert!(course.points[0].discharge_m3_s >= 50.0, "{}", course.id);
        for pair in course.points.windows(2) {
            let [a, b] = [pair[0], pair[1]];
            assert!(a.height_m >= b.height_m, "{}: {a:?} {b:?}", course.id);
            assert!(a.discharge_m3_s <= b.discharge_m3_s, "{}: {a:?} {b:?}", course.id);
            // Around the width of the discharge (see `world/rivers/reach.rs`) it varies by up to 30%.
            let usual = a.width_m / (7.2 * a.discharge_m3_s.sqrt());
            assert!((0.69..1.31).contains(&usual), "{}: {a:?}", course.id);
        }
    }
    let order: Vec<(f64, u64)> =
        rivers.courses.iter().map(|course| (mouth(course).discharge_m3_s, course.id)).collect();
    assert!(order.is_sorted_by(|a, b| a.0 > b.0 || (a.0 == b.0 && a.1 < b.1)), "the greatest comes first");
}

#[test]
fn every_river_ends_in_the_sea_in_a_lake_or_in_a_river() {
    let rivers = rivers();
    let courses: BTreeMap<u64, &Course> = rivers.courses.iter().map(|course| (course.id, course)).collect();
    assert_eq!(courses.len(), rivers.courses.len(), "ids are unique");
    let lakes: BTreeSet<u32> = rivers.lakes.iter().map(|lake| lake.id).collect();
    let mut at_sea = 0;
    for course in &rivers.courses {
        let end = mouth(course);
        match course.mouth {
            Mouth::Sea => {
                at_sea += 1;
                let sample = terrain().sample(end.place.direction());
                assert!(end.height_m < 0.0 && sample.water_level_m.is_some(), "{}: {sample:?}", course.id);
            }
            Mouth::Lake(lake) => assert!(lakes.contains(&lake), "{}", course.id),
            Mouth::River(id) => {
                let joined = courses[&id];
                let meets = |point: &CoursePoint| {
                    point.place.direction().distance(end.place.direction()) < 1e-9
                        && point.discharge_m3_s >= end.discharge_m3_s
                };
                assert!(joined.points.iter().any(meets), "{} does not meet {id}", course.id);
            }
            Mouth::Ground => {}
        }
    }
    assert!(at_sea > 20, "{at_sea}");
}

/// Where the great rivers flow, a query finds them within their width, and their water stands above the bed.
#[test]
fn a_query_on_a_river_finds_it() {
    let (mut found, mut asked) = (0, 0);
    for course in &rivers().courses[..12] {
        let inner = &course.points[1..course.points.len() - 1];
        for point in inner.iter().step_by(23).filter(|point| point.height_m > 5.0) {
            let sample = terrain().sample(point.place.direction());
            asked += 1;
            let is_here = |river: &tellus::terrain::River| {
                (river.id == course.id || sample.lake.is_some()) && river.distance_m <= 0.5 * river.width_m
            };
            let is_wet = sample.water_level_m.is_some_and(|level_m| level_m >= point.height_m - 1.0);
            found += usize::from(is_wet && (sample.lake.is_some() || sample.river.as_ref().is_some_and(is_here)));
            if let Some(river) = sample.river {
                assert!(river.flow_planet.dot(point.place.direction()).abs() < 1e-9);
                assert!((river.flow_planet.length() - 1.0).abs() < 1e-9);
            }
        }
    }
    // Where two reaches of the solver cross, the lower one has the ground.
    assert!(asked > 50 && 100 * found >= 95 * asked, "{found} of {asked}");
}

#[test]
fn water_stands_above_the_ground_and_weather_is_sane() {
    let dirs: Vec<DVec3> = spread(300).collect();
    let samples = terrain().samples(&dirs, Wanted::ALL);
    for (sample, &dir) in samples.iter().zip(&dirs) {
        assert!(sample.water_level_m.is_none_or(|level_m| level_m > sample.height_m), "{sample:?}");
        assert!(sample.height_m >= 0.0 || sample.water_level_m.is_some(), "{sample:?}");
        assert!(sample.lake.is_none() || sample.water_level_m.is_some(), "{sample:?}");
        assert!((0.0..20_000.0).contains(&sample.rain_mm), "{sample:?}");
        assert!(sample.wind_planet_m_s.dot(dir).abs() < 1e-6 && sample.wind_planet_m_s.length() < 60.0, "{sample:?}");
        assert!(sample.plate.is_some(), "{sample:?}");
    }
    let basins: BTreeSet<u32> = samples.iter().filter_map(|sample| sample.basin).collect();
    let plates: BTreeSet<u16> = samples.iter().filter_map(|sample| sample.plate).collect();
    assert!(basins.len() > 10 && plates.len() > 5, "{} basins, {} plates", basins.len(), plates.len());
    // Alone and in a batch, with other wishes: the same.
    let some = terrain().samples(&dirs[..20], Wanted::HEIGHT.and_water());
    for ((some, all), dir) in some.iter().zip(&samples).zip(&dirs) {
        assert_eq!(terrain().sample(*dir), *all);
        assert_eq!((some.water_level_m, some.river, some.rain_mm), (all.water_level_m, all.river, all.rain_mm));
    }
}

#[test]
fn basins_cover_the_land_and_lakes_their_cells() {
    let rivers = terrain().rivers(0.0);
    let globe_km2 = 4.0 * PI * terrain().planet().radius_km.powi(2);
    let land_km2: f64 = rivers.basins.iter().map(|basin| basin.area_km2).sum();
    assert!(land_km2 > 0.1 * globe_km2 && land_km2 < 0.6 * globe_km2, "{}", land_km2 / globe_km2);
    for lake in &rivers.lakes {
        assert!(lake.area_km2 > 0.0 && !lake.cells.is_empty(), "{lake:?}");
    }
    // Every river to the sea leaves a basin of its own discharge.
    let discharges: BTreeMap<u32, f64> = rivers.basins.iter().map(|basin| (basin.id, basin.discharge_m3_s)).collect();
    for course in rivers.courses.iter().filter(|course| course.mouth == Mouth::Sea) {
        let basin = discharges[&u32::try_from(course.id).unwrap()];
        assert!((basin - mouth(course).discharge_m3_s).abs() < 1e-6 * basin, "{}", course.id);
    }
}

#[test]
fn a_layer_over_the_structure_may_lift_the_ground_out_of_the_water() {
    let shape = Shape::Fbm(Fbm { wavelength_km: 400.0, octaves: 1, ..Fbm::default() });
    let hills = Layer { name: "Hills".to_owned(), amplitude_m: 8000.0, shape, ..Layer::default() };
    let raised = Terrain::try_new(Planet { layers: vec![hills], ..planet() }.into()).unwrap();
    let (mut lifted, mut sunk) = (0, 0);
    for dir in spread(150) {
        let (before, after) = (terrain().sample(dir), raised.sample(dir));
        assert!(after.water_level_m.is_none_or(|level_m| level_m > after.height_m), "{after:?}");
        lifted += usize::from(before.water_level_m.is_some() && after.water_level_m.is_none());
        sunk += usize::from(before.water_level_m.is_none() && after.water_level_m == Some(0.0));
    }
    assert!(lifted > 3 && sunk > 3, "{lifted} lifted, {sunk} sunk");
}

#[test]
fn without_a_structure_there_is_the_sea_and_the_rain_of_the_climate() {
    let planet = Arc::new(layered());
    let terrain = Terrain::try_new(planet.clone()).unwrap();
    assert_eq!(terrain.rivers(0.0), Rivers::default());
    let sea_m = planet.sea_level_m().unwrap();
    let dirs: Vec<DVec3> = spread(200).collect();
    let mut samples = terrain.samples(&dirs, Wanted::ALL);
    for sample in &samples {
        assert_eq!(sample.water_level_m, Some(sea_m).filter(|sea_m| sample.height_m < *sea_m));
        assert_eq!((sample.rain_mm, sample.wind_planet_m_s), (sample.precipitation_mm, DVec3::ZERO));
        assert_eq!((sample.river, sample.lake, sample.basin, sample.plate), (None, None, None, None));
    }
    let rain_mm: Vec<f64> = samples.iter().map(|sample| sample.rain_mm).collect();
    terrain.samples_into(&dirs, Wanted::HEIGHT.and_water(), &mut samples, &mut Scratch::default()).unwrap();
    assert!(samples.iter().map(|sample| sample.rain_mm).eq(rain_mm));
}
