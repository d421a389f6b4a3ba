//! Walkers on the ground of a patch: they climb what the limit allows, stand still, and never sink, on all planets.

use std::sync::Arc;
use tellus::glam::DVec3;
use tellus::planet::{Planet, shipped};
use tellus::rayon::prelude::*;
use tellus::sphere::{Tangent, spread};
use tellus::terrain::{GroundPatch, Terrain, Walker, WalkerBody};

const RATE_HZ: f64 = 60.0;
const STEP_SECS: f64 = 1.0 / RATE_HZ;
const PACE_M_S: f64 = 1.5;

/// One smooth wave with slopes up to some 70 degrees.
fn waves() -> Arc<Terrain> {
    let text = r#"(version: 3, name: "Waves", radius_km: 100.0,
        layers: [(name: "Waves", amplitude_m: 900.0, shape: Fbm(wavelength_km: 1.6, octaves: 1))])"#;
    Arc::new(Terrain::try_new(Planet::from_text("waves.ron", text).unwrap().into()).unwrap())
}

/// Height of the feet over the evaluator's ground.
fn over_m(terrain: &Terrain, walker: &Walker) -> f64 {
    let feet_m = walker.feet_planet_m();
    feet_m.length() - terrain.planet().radius_m() - terrain.height_m(feet_m)
}

#[test]
fn a_walker_climbs_what_the_limit_allows_and_nothing_steeper() {
    let terrain = waves();
    let mut patch = GroundPatch::new(terrain.clone());
    let body = WalkerBody::default();
    let limit = body.slope_limit_rad;
    let (mut gentle, mut steep) = (0, 0);
    for dir in spread(600) {
        let ground = terrain.sample(dir);
        let uphill = (dir - ground.normal_planet / ground.normal_planet.dot(dir)).normalize_or_zero();
        let mut walker = Walker::on_ground(body, &mut patch, dir);
        let start_m = walker.feet_planet_m();
        let mut steepest: f64 = 0.0;
        let mut least: f64 = 9.0;
        for _ in 0..60 {
            walker.step(&mut patch, uphill * PACE_M_S, STEP_SECS);
            let slope = terrain.sample(walker.feet_planet_m()).slope_rad;
            (steepest, least) = (steepest.max(slope), least.min(slope));
        }
        let rise_m = walker.feet_planet_m().length() - start_m.length();
        let gone_m = walker.feet_planet_m().distance(start_m);
        if steepest < limit - 0.03 && ground.slope_rad > 0.2 {
            gentle += 1;
            // As fast along the slope as on level ground.
            assert!((gone_m - PACE_M_S).abs() < 0.1 && rise_m > 0.0, "{dir}: {gone_m} {rise_m} {steepest}");
            assert!(walker.is_standing());
        } else if least > limit + 0.03 {
            steep += 1;
            assert!(rise_m < 0.01, "{dir}: {rise_m} {least}");
        }
    }
    assert!(gentle > 100 && steep > 20, "{gentle} {steep}");
}

#[test]
fn a_walker_slides_down_what_is_too_steep_and_rests_on_what_is_not() {
    let terrain = waves();
    let mut patch = GroundPatch::new(terrain.clone());
    let body = WalkerBody::default();
    let (mut slid, mut stood) = (0, 0);
    for dir in spread(400) {
        let slope = terrain.sample(dir).slope_rad;
        let mut walker = Walker::on_ground(body, &mut patch, dir);
        walker.step(&mut patch, DVec3::ZERO, STEP_SECS);
        let start_m = walker.feet_planet_m();
        let mut before_m = start_m.length();
        for _ in 0..60 {
            // One who was put on a slope stands there until it moves.
            walker.jump(0.0);
            walker.step(&mut patch, DVec3::ZERO, STEP_SECS);
            let height_m = walker.feet_planet_m().length();
            // No trembling: it never rises.
            assert!(height_m < before_m + 1e-3, "{dir}: {}", height_m - before_m);
            before_m = height_m;
        }
        let sunk_m = start_m.length() - before_m;
        if slope > body.slope_limit_rad + 0.1 {
            slid += 1;
            // Half of a second of the gravity that friction leaves.
            let pull_m_s2 = body.gravity_m_s2 * (slope.sin() - slope.cos() * body.slope_limit_rad.tan());
            assert!(sunk_m > 0.25 * pull_m_s2 * slope.sin(), "{dir}: {slope} {sunk_m}");
        } else if slope < body.slope_limit_rad - 0.03 {
            stood += 1;
            assert!(sunk_m.abs() < 1e-3 && walker.is_standing(), "{dir}: {slope} {sunk_m}");
        }
    }
    assert!(slid > 20 && stood > 100, "{slid} {stood}");
}

#[test]
fn a_walker_falls_as_things_fall_and_jumps_as_high_as_it_should() {
    let terrain = waves();
    let mut patch = GroundPatch::new(terrain.clone());
    let body = WalkerBody { gravity_m_s2: 3.0, ..WalkerBody::default() };
    let dir = spread(300).find(|dir| terrain.sample(*dir).slope_rad < 0.1).unwrap();
    let mut walker = Walker::on_ground(body, &mut patch, dir);
    let ground_m = walker.feet_planet_m();
    walker.jump(2.0);
    let mut highest_m: f64 = 0.0;
    let mut secs = 0.0;
    while !walker.is_standing() && secs < 10.0 {
        walker.step(&mut patch, DVec3::ZERO, STEP_SECS);
        highest_m = highest_m.max((walker.feet_planet_m() - ground_m).dot(dir));
        secs += STEP_SECS;
    }
    assert!((highest_m - 2.0 * 2.0 / 6.0).abs() < 0.03 && (secs - 4.0 / 3.0).abs() < 0.05, "{highest_m} {secs}");
    assert!(walker.feet_planet_m().distance(ground_m) < 1e-3);
    // What is not finite is no wish, and takes no time.
    let before = walker;
    walker.step(&mut patch, DVec3::NAN, STEP_SECS);
    walker.step(&mut patch, DVec3::X, f64::NAN);
    assert_eq!(walker, before);
}

/// The gravity of a body as dense as the Earth goes with its radius.
#[test]
fn gravity_is_the_planets() {
    let aurel = WalkerBody::on(&shipped::default_planet()).gravity_m_s2;
    let moon = Planet { radius_km: 1737.4, ..shipped::default_planet() };
    assert!((aurel - 9.81).abs() < 0.01 && (WalkerBody::on(&moon).gravity_m_s2 - 2.675).abs() < 0.01);
}

/// What a walker does in some seconds at a place: it walks, each in a direction of its own, then stands.
fn walks(terrain: &Arc<Terrain>, place: usize, dir: DVec3, secs: f64) {
    let name = &terrain.planet().name;
    let mut patch = GroundPatch::new(terrain.clone());
    let body = WalkerBody::on(terrain.planet());
    let mut walker = Walker::on_ground(body, &mut patch, dir);
    let start_m = walker.feet_planet_m();
    let tangent = Tangent::new(dir);
    let (sin, cos) = (place as f64).sin_cos();
    let wish_m_s = (tangent.east_planet * sin + tangent.north_planet * cos) * PACE_M_S;
    let (mut gone_m, mut before_m) = (0.0, start_m);
    for step in 0..(secs * RATE_HZ) as u32 {
        let was_standing = walker.is_standing();
        walker.step(&mut patch, wish_m_s, STEP_SECS);
        let feet_m = walker.feet_planet_m();
        let moved_m = feet_m.distance(before_m);
        gone_m += moved_m;
        assert!(feet_m.is_finite(), "{name} {place}");
        if was_standing && walker.is_standing() {
            // No hop: no more than a step, and what the slope adds.
            let rise_m = (feet_m.length() - before_m.length()).abs();
            assert!(rise_m < body.step_m + 2.0 * PACE_M_S * STEP_SECS, "{name} {place}: hops by {rise_m}");
        }
        before_m = feet_m;
        if step % 60 == 0 {
            let contact = patch.contact(&body.capsule_at(feet_m), 0.5);
            let deviation_m = contact.map_or(0.0, |contact| contact.deviation_m);
            let over_m = over_m(terrain, &walker);
            assert!(over_m > -deviation_m, "{name} {place}: sinks to {over_m}, {deviation_m}");
            let gap_m = contact.map_or(1.0, |contact| contact.gap_m);
            assert!(gap_m > 0.2 * body.skin_m, "{name} {place}: {gap_m}");
        }
    }
    // It comes to rest, and then does not move at all.
    for _ in 0..(20.0 * RATE_HZ) as u32 {
        walker.step(&mut patch, DVec3::ZERO, STEP_SECS);
        if walker.is_standing() {
            break;
        }
    }
    if walker.is_standing() {
        let still = walker.feet_planet_m();
        (0..60).for_each(|_| walker.step(&mut patch, DVec3::ZERO, STEP_SECS));
        assert_eq!(walker.feet_planet_m(), still, "{name} {place}");
    }
    // Nobody is stuck: one who cannot go on in a direction, up a steep slope, goes back.
    if gone_m < 0.5 * PACE_M_S * secs {
        let stuck_m = walker.feet_planet_m();
        let around = (0..8).map(|i| {
            let (sin, cos) = (f64::from(i) * 0.785).sin_cos();
            let mut walker = walker;
            let wish_m_s = (tangent.east_planet * sin + tangent.north_planet * cos) * PACE_M_S;
            (0..60).for_each(|_| walker.step(&mut patch, wish_m_s, STEP_SECS));
            walker.feet_planet_m().distance(stuck_m)
        });
        assert!(around.fold(0.0, f64::max) > 0.5, "{name} {place}: stuck after {gone_m} m");
    }
}

fn on_all_planets(places: usize, secs: f64) {
    let planets: Vec<Planet> = shipped::ALL.iter().map(|shipped| shipped.load().unwrap()).collect();
    let on_each = places.div_ceil(planets.len());
    for (number, planet) in planets.into_iter().enumerate() {
        let terrain = Arc::new(Terrain::try_new(planet.into()).unwrap());
        let dirs: Vec<DVec3> = spread(on_each * (number + 2)).step_by(number + 2).collect();
        dirs.par_iter().enumerate().for_each(|(place, dir)| walks(&terrain, place, *dir, secs));
    }
}

#[test]
fn walkers_on_all_planets_neither_sink_nor_tremble() {
    on_all_planets(72, 10.0);
}

#[test]
#[ignore = "long: 1,000 places, a minute at each"]
fn walkers_on_a_thousand_places_neither_sink_nor_tremble() {
    on_all_planets(1000, 60.0);
}
