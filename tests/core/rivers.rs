//! Rivers have their water on their whole course, whatever layers lie over the structure.

use crate::support::dice::Dice;
use std::sync::Arc;
use tellus::glam::DVec3;
use tellus::planet::{Planet, Structure, random, shipped};
use tellus::terrain::{Course, Sample, Terrain};

/// Share of the half width of a channel, from bank to bank, that is water.
const WATER: f64 = 0.8;

/// A planet with a structure of the coarsest grid.
fn coarse(planet: Planet) -> Planet {
    let structure = planet.structure.map(|structure| Structure { grids: 1, ..structure });
    Planet { structure, ..planet }
}

/// Depth of a river at a distance from its middle by that in the middle (see `world/rivers/channel.rs`).
fn depth_share(distance: f64) -> f64 {
    let u = (WATER * distance).powi(2);
    let freeboard = (1.0 - WATER * WATER).powi(2);
    ((1.0 - u).powi(2) - freeboard) / (1.0 - freeboard)
}

/// A number below `count`.
fn pick(dice: &mut Dice, count: usize) -> usize {
    ((dice.roll() * count as f64) as usize).min(count - 1)
}

/// A unit direction in the water or close beside it. Between the points of a course the river winds, so that it is
/// found by its distance. None where it cannot be found so, as in lakes.
fn beside(terrain: &Terrain, course: &Course, dice: &mut Dice) -> Option<DVec3> {
    let at = pick(dice, course.points.len() - 1);
    let [a, b] = [course.points[at], course.points[at + 1]].map(|point| point.place.direction());
    let dir = a.lerp(b, dice.roll()).normalize();
    let river = terrain.sample(dir).river?;
    let across = dir.cross(river.flow_planet) / terrain.planet().radius_m();
    let aside = (dice.roll() - 0.5) * river.width_m;
    let moved = |by_m: f64| (dir + across * by_m).normalize();
    let distance_m = |dir: DVec3| terrain.sample(dir).river.map_or(f64::MAX, |river| river.distance_m);
    let found = [river.distance_m, -river.distance_m]
        .into_iter()
        .find(|by_m| river.distance_m < 0.1 * river.width_m || distance_m(moved(*by_m)) < 0.1 * river.width_m);
    found.map(|by_m| moved(by_m + aside))
}

/// Checks points beside the courses of a planet: how many were in a river.
fn check(name: &str, planet: Planet, points: usize) -> usize {
    let terrain = Terrain::try_new(Arc::new(planet)).unwrap();
    let courses = terrain.rivers(20.0).courses;
    if courses.is_empty() {
        return 0;
    }
    let mut dice = Dice(7);
    let (mut inside, mut crossed) = (0, 0);
    for _ in 0..points {
        let course = &courses[pick(&mut dice, courses.len())];
        let Some(dir) = beside(&terrain, course, &mut dice) else { continue };
        let sample = terrain.sample(dir);
        let Some(river) = sample.river.filter(|river| river.distance_m < 0.49 * river.width_m) else { continue };
        inside += 1;
        let level_m = sample.water_level_m.unwrap_or_else(|| panic!("{name}: {dir} is dry: {sample:?}"));
        // Lakes and the sea may stand higher than the river.
        let is_stream = sample.lake.is_none() && terrain.planet().sea_level_m() != Some(level_m);
        let wanted_m = river.depth_m * depth_share(2.0 * river.distance_m / river.width_m);
        let depth_m = level_m - sample.height_m;
        assert!(depth_m > 0.9 * wanted_m - 0.01, "{name}: {dir}: {wanted_m}: {sample:?}");
        // Where channels meet or cross, the deepest counts.
        crossed += usize::from(is_stream && depth_m > 1.1 * wanted_m + 0.01);
    }
    assert!(crossed * 50 <= inside, "{name}: {crossed} of {inside} are too deep");
    // From a course's source to its mouth the water never rises.
    let (mut steps, mut rises) = (0, 0);
    for course in courses.iter().step_by(courses.len().div_ceil(points / 40)) {
        let mut last: Option<Sample> = None;
        for point in &course.points {
            let sample = terrain.sample(point.place.direction());
            let is_on = |sample: &Sample| sample.river.is_some_and(|river| river.id == course.id);
            if let (Some(before), true) = (last, is_on(&sample)) {
                steps += 1;
                rises += usize::from(sample.water_level_m > before.water_level_m.map(|level_m| level_m + 0.02));
            }
            last = Some(sample).filter(is_on);
        }
    }
    assert!(steps > points / 4 && rises * 200 <= steps, "{name}: the water rises at {rises} of {steps}");
    inside
}

#[test]
fn rivers_have_their_water_on_their_whole_course() {
    for preset in shipped::ALL {
        let planet = preset.load().unwrap();
        if planet.structure.is_some() {
            let inside = check(preset.file, coarse(planet), 200);
            assert!(inside > 100, "{}: {inside}", preset.file);
        }
    }
}

#[test]
#[ignore = "long: structures of 23 planets"]
fn rivers_of_shipped_and_random_planets_have_their_water_on_their_whole_course() {
    for preset in shipped::ALL {
        let planet = preset.load().unwrap();
        if planet.structure.is_some() {
            let inside = check(preset.file, planet, 1000);
            println!("counted: {inside} of 1000 points in rivers of {}", preset.file);
        }
    }
    let with_structure = |seed| Some(random::random(seed)).filter(|planet| planet.structure.is_some());
    for (number, planet) in (0..).filter_map(with_structure).take(20).enumerate() {
        let inside = check(&planet.name.clone(), coarse(planet), 1000);
        println!("counted: {inside} of 1000 points in rivers of random planet {number}");
    }
}
