//! Objects that a view draws are those that queries answer, on shipped planets.

use crate::support::dice::Dice;
use glam::DVec3;
use std::sync::Arc;
use std::time::Duration;
use tellus::life::Instance;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Planet, shipped};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;
use tellus::tiles::{Builder, Surface};

/// Height of the eye over the ground, metres.
const EYE_M: f64 = 2.0;
/// Share of its reach within which the view has every object of a population that it needs, whatever the height of the
/// eye.
const INSIDE: f64 = 0.99;

/// Angle between unit vectors; precise where it is small.
fn angle(a: DVec3, b: DVec3) -> f64 {
    2.0 * (0.5 * (a - b).length()).min(1.0).asin()
}

/// An object as both sides tell of it: id, foot in millimetres, height as the bits of 32.
type Told = (u64, [i64; 3], u32);

fn told(id: u64, foot_m: DVec3, size_m: f32) -> Told {
    (id, (foot_m * 1000.0).round().to_array().map(|part| part as i64), size_m.to_bits())
}

/// Objects of all populations within a distance, by queries of one population each, and whether a view needs each.
/// `full_m`: distance beyond which it needs those of low rank alone.
fn queried(whole: &Terrain, population: usize, dir: DVec3, [radius_m, full_m]: [f64; 2]) -> Vec<(Told, bool)> {
    let mut planet = Planet::clone(whole.planet());
    for (index, other) in planet.life.iter_mut().enumerate() {
        other.enabled &= index == population;
    }
    let alone = Terrain::builder(planet.into()).reuse(whole).build().unwrap();
    let found: Vec<Instance> = alone.instances(dir, radius_m).unwrap();
    let planet_m = whole.planet().radius_m();
    let told = found.iter().map(|one| {
        let needed = (full_m / (angle(one.dir_planet, dir) * planet_m).hypot(EYE_M).max(full_m)).powi(2);
        (told(one.id, one.foot_planet_m(planet_m), one.size_m as f32), one.rank < needed)
    });
    let mut told: Vec<(Told, bool)> = told.collect();
    told.sort_unstable();
    told
}

/// Surface of a view, after the builder has finished.
fn settled(builder: &Builder, planet: &Arc<Planet>, view: &View) -> Arc<Surface> {
    builder.request(planet, view).unwrap();
    while builder.is_busy() {
        std::thread::sleep(Duration::from_millis(1));
    }
    builder.surface().unwrap()
}

/// Compares both sides around a place; gives the number of objects.
fn compare(builder: &Builder, terrain: &Terrain, place: LatLon, quality: Quality) -> usize {
    let planet = terrain.planet();
    let (dir, planet_m) = (place.direction(), planet.radius_m());
    let ground_m = terrain.height_m(dir).max(planet.sea_level_m().unwrap_or(f64::MIN));
    let camera = Camera::over(place, planet_m + ground_m + EYE_M, 0.0, -0.1, Camera::DEFAULT_FOV_Y_RAD);
    let view = View { camera, size_px: [64, 36], quality };
    let scenery = &settled(builder, planet, &view).scenery;
    let mut compared = 0;
    for (population, reach_m) in scenery.reach_m.iter().enumerate().filter(|(_, reach_m)| **reach_m > 0.0) {
        let (radius_m, full_m) = (INSIDE * reach_m, scenery.full_m[population].min(*reach_m));
        let cells = scenery.cells.iter().filter(|cell| usize::from(cell.population) == population);
        let inside = cells
            .flat_map(|cell| &cell.objects)
            .filter(|object| angle(object.foot_planet_m.normalize(), dir) * planet_m <= radius_m - 0.01);
        let mut drawn: Vec<Told> = inside.map(|one| told(one.id, one.foot_planet_m, one.size_m)).collect();
        drawn.sort_unstable();
        let mut answered = queried(terrain, population, dir, [radius_m, full_m]);
        // Far away objects of low rank stand for all. Those within a centimetre of the rim may be on either side of it.
        answered.retain(|(told, is_needed)| {
            drawn.binary_search(told).is_ok()
                || *is_needed && {
                    let foot = DVec3::from_array(told.1.map(|part| part as f64 * 0.001));
                    angle(foot.normalize(), dir) * planet_m <= radius_m - 0.02
                }
        });
        let answered: Vec<Told> = answered.into_iter().map(|(told, _)| told).collect();
        let name = &planet.life[population].name;
        assert!(drawn == answered, "{name} at {place:?}: {} drawn, {} by query", drawn.len(), answered.len());
        compared += drawn.len();
    }
    compared
}

/// Number of objects compared, at least `wanted`, at random places of all shipped planets with life.
fn compare_objects(wanted: usize, quality: Quality) -> usize {
    let planets = shipped::ALL.iter().map(|shipped| shipped.load().unwrap());
    let planets = planets.filter(|planet| !planet.life.is_empty());
    let sides: Vec<(Builder, Arc<Terrain>)> =
        planets.map(|planet| (Builder::new(|| {}), Arc::new(Terrain::try_new(planet.into()).unwrap()))).collect();
    let (mut dice, mut compared) = (Dice(57), 0);
    while compared < wanted {
        for (builder, terrain) in &sides {
            compared += compare(builder, terrain, dice.place(), quality);
        }
    }
    compared
}

#[test]
fn a_view_draws_the_objects_that_queries_answer() {
    // Structures take the builder seconds to solve.
    for (file, lat_deg, lon_deg) in [("pallor.ron", -20.0, 10.0), ("maren.ron", 31.0, -138.0)] {
        let planet = shipped::ALL.iter().find(|shipped| shipped.file == file).unwrap().load().unwrap();
        let terrain = Terrain::try_new(planet.into()).unwrap();
        let place = LatLon::from_degrees(lat_deg, lon_deg);
        let compared = compare(&Builder::new(|| {}), &terrain, place, Quality::Low);
        assert!(compared > 100, "{file}: {compared}");
    }
}

#[test]
#[ignore = "long: half an hour"]
fn a_hundred_million_objects_are_drawn_as_queries_answer() {
    let compared = compare_objects(100_000_000, Quality::High);
    println!("counted: {compared} objects, drawn as queries answer");
}
