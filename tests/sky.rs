//! The shaders of the air against the same method in 64 bits.
#![cfg(feature = "editor")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod support;

use support::Gpu;
use tellus::atmosphere::{Air, SkyRay};
use tellus::lod::Quality;
use tellus::planet::{Planet, shipped};

/// The air of every shipped planet that has some, and that of the Earth.
fn planets() -> Vec<(&'static str, Planet)> {
    let earth = Planet::from_text("earth_air.ron", include_str!("fixtures/earth_air.ron")).unwrap();
    let shipped = shipped::ALL.iter().map(|preset| (preset.file, preset.load().unwrap()));
    shipped.filter(|(_, planet)| planet.atmosphere.is_some()).chain([("earth_air.ron", earth)]).collect()
}

/// So many rays from altitudes of 1 m to 10,000 km. Half of them look near the horizon, where it is hardest.
fn rays(planet: &Planet, count: u64) -> Vec<SkyRay> {
    let mut state = 1_u64;
    let mut dice = || {
        state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 53) as f64
    };
    let ray = |i: u64| {
        let altitude_m = 10_f64.powf(7.0 * dice());
        let horizon = std::f64::consts::PI - (planet.radius_m() / (planet.radius_m() + altitude_m)).asin();
        let anywhere = (1.0 - 2.0 * dice()).acos();
        let view_zenith_rad =
            if i % 2 == 0 { anywhere } else { (horizon + 0.3 * (dice() - 0.5).powi(3)).clamp(0.0, 3.1) };
        SkyRay { altitude_m, view_zenith_rad, sun_zenith_rad: dice() * 3.1416, azimuth_rad: dice() * 6.2832 }
    };
    (0..count).map(ray).collect()
}

#[test]
fn the_shaders_agree_with_the_physics() {
    let mut gpu = Gpu::new();
    for (file, planet) in planets() {
        let rays = rays(&planet, 500);
        let air = Air::new(&planet);
        let answers = gpu.renderer.sky(&gpu.device, &gpu.queue, &planet, Quality::High, &rays).unwrap();
        let mut bad = 0;
        let mut worst = (0.0, 0);
        for (i, (ray, answer)) in rays.iter().zip(&answers).enumerate() {
            let expected = air.radiance(ray);
            let off =
                (0..3).map(|c| (answer.radiance[c] - expected[c]).abs() / (expected[c] + 1e-6)).fold(0.0, f64::max);
            if off > 0.02 {
                bad += 1;
            }
            if off > 0.02 && std::env::var_os("SKY_LIST").is_some() {
                println!(
                    "{file} {i} alt {:.4} km view {:.4} hor {:.3} sun {:.3} az {:.3}: {off:.4}\n   {:?}\n   {expected:?}",
                    ray.altitude_m / 1e3,
                    ray.view_zenith_rad.to_degrees(),
                    (std::f64::consts::PI - (planet.radius_m() / (planet.radius_m() + ray.altitude_m)).asin())
                        .to_degrees(),
                    ray.sun_zenith_rad.to_degrees(),
                    ray.azimuth_rad.to_degrees(),
                    answer.radiance
                );
            }
            if off > worst.0 {
                worst = (off, i);
            }
            let t = air.sun_transmittance(ray.altitude_m, ray.sun_zenith_rad);
            let offt = (0..3).map(|c| (answer.transmittance[c] - t[c]).abs() / (t[c] + 1e-5)).fold(0.0, f64::max);
            if offt > 0.01 {
                println!(
                    "T {file} alt {} sun {} {:?} {t:?}",
                    ray.altitude_m,
                    ray.sun_zenith_rad.to_degrees(),
                    answer.transmittance
                );
            }
        }
        println!("{file}: {bad} bad, worst {worst:?}");
    }
}

#[test]
fn dbg_time() {
    use std::sync::Arc;
    let mut gpu = Gpu::new();
    let mut planet = planets().remove(0).1;
    planet.layers.clear();
    planet.clouds = None;
    let planet = Arc::new(planet);
    let cam = support::camera(&planet, 0.0, 0.0, 1e6, 0.0, -90.0);
    let surface = support::surface(&planet, &cam);
    let mut other = (*planet).clone();
    other.atmosphere.as_mut().unwrap().mie_scale_km += 0.1;
    let view = |p: &'static str| p;
    let _ = view;
    for round in 0..3 {
        for (name, p) in [("same", [&*planet, &*planet]), ("other", [&*planet, &other])] {
            let start = std::time::Instant::now();
            for i in 0..10 {
                let mut f = support::frame(&surface, p[i % 2], cam, (0.0, 0.0));
                f.view.size_px = [64, 36];
                gpu.draw_only(&f, 1);
            }
            println!("{round} {name} {:?}", start.elapsed() / 10);
        }
    }
}
