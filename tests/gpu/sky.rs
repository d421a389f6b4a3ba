//! The shaders of the air against the same method in f64.

use crate::support::gpu;
use std::f64::consts::{PI, TAU};
use tellus::atmosphere::{Air, SkyRay};
use tellus::lod::Quality;
use tellus::planet::{Planet, shipped};

/// Every shipped planet with an atmosphere of its own, and the Earth. Planets with a structure have Aurel's.
fn planets() -> Vec<(&'static str, Planet)> {
    let earth = Planet::from_text("earth_air.ron", include_str!("../fixtures/earth_air.ron")).unwrap();
    let shipped = shipped::ALL.iter().map(|preset| (preset.file, preset.load().unwrap()));
    shipped
        .filter(|(_, planet)| planet.atmosphere.is_some() && planet.structure.is_none())
        .chain([("earth_air.ron", earth)])
        .collect()
}

/// Radiance below which errors are absolute: a ten-thousandth of the sky at noon.
const FLOOR: f64 = 3e-6;

/// Random rays from altitudes of 1 m to 10,000 km. Half of them are near the horizon, the hardest case.
fn rays(planet: &Planet, count: u64) -> Vec<SkyRay> {
    let mut state = 1_u64;
    let mut dice = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let ray = |i: u64| {
        let altitude_m = 10_f64.powf(7.0 * dice());
        let horizon = PI - (planet.radius_m() / (planet.radius_m() + altitude_m)).asin();
        let anywhere = (1.0 - 2.0 * dice()).acos();
        // Closer to the horizon, f32 cannot decide whether a ray hits the ground.
        let off = 0.3 * (dice() - 0.5).powi(3);
        let off = off.abs().max(4e-6).copysign(off);
        let view_zenith_rad = if i.is_multiple_of(2) { anywhere } else { (horizon + off).clamp(0.0, 3.1) };
        SkyRay { altitude_m, view_zenith_rad, sun_zenith_rad: dice() * PI, azimuth_rad: dice() * TAU }
    };
    (0..count).map(ray).collect()
}

#[test]
fn the_shaders_agree_with_the_physics() {
    compare_with_the_physics(40);
}

#[test]
#[ignore = "long: minutes"]
fn the_shaders_agree_with_the_physics_along_many_rays() {
    compare_with_the_physics(500);
}

/// Relative error of a channel that a ray may have, and that one ray of a thousand may have: at dusk, tables are steep.
const MOST: f64 = 0.02;
const RARELY: f64 = 0.04;

fn compare_with_the_physics(count: u64) {
    let mut gpu = gpu();
    let (mut rare, mut compared) = (Vec::new(), 0);
    for (file, planet) in planets() {
        let rays = rays(&planet, count);
        let air = Air::try_new(&planet).unwrap();
        let answers = gpu.renderer.sky(&planet, Quality::High, &rays).unwrap();
        for (ray, answer) in rays.iter().zip(&answers) {
            compared += 1;
            let off = |found: [f64; 3], expected: [f64; 3], floor: f64| {
                let errors = found.iter().zip(expected);
                let relative = errors.map(|(found, expected)| ((found - expected).abs() - floor) / expected);
                // What is no number is as wrong as can be.
                relative.map(|error| if error.is_nan() { f64::INFINITY } else { error }).fold(0.0, f64::max)
            };
            let expected = [air.radiance(ray), air.sun_transmittance(ray.altitude_m, ray.sun_zenith_rad)];
            let error = off(answer.radiance, expected[0], FLOOR).max(off(answer.transmittance, expected[1], 1e-5));
            if error > MOST {
                rare.push((error, format!("{file}: {ray:?}: {answer:?} instead of {expected:?}")));
            }
        }
    }
    let rays: Vec<&str> = rare.iter().map(|(_, ray)| ray.as_str()).collect();
    println!("on {}: {} of {compared} rays differ by over 2%:\n{}", gpu.adapter, rays.len(), rays.join("\n"));
    assert!(rare.iter().all(|(error, _)| *error < RARELY));
    assert!(1000 * rare.len() <= compared);
}
