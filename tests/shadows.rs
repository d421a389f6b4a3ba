//! Shadows of the ground as they are drawn, against rays cast at the evaluator itself; and what they cost.
#![cfg(feature = "editor")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod support;

use std::sync::Arc;
use std::time::Duration;
use support::{Gpu, lights};
use tellus::build::{Builder, Surface, add_detail, build_now};
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Planet, shipped};
use tellus::render::{DebugView, Frame};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

const SIZE_PX: [u32; 2] = [160, 100];

/// A shipped planet as a moon of one colour: what is dark is in shadow.
fn bare(file: &str) -> Arc<Planet> {
    let mut planet = shipped::ALL.iter().find(|preset| preset.file == file).unwrap().load().unwrap();
    (planet.water, planet.atmosphere, planet.clouds) = (None, None, None);
    for biome in &mut planet.biomes.palette {
        (biome.color, biome.variation) = ([0.8; 3], 0.0);
    }
    Arc::new(planet)
}

fn view(planet: &Arc<Planet>, lat_deg: f64, lon_deg: f64, altitude_m: f64, pitch_deg: f64) -> View {
    let place = LatLon::from_degrees(lat_deg, lon_deg);
    let ground_m = Terrain::new(planet.clone()).height_m(place.direction());
    let radius_m = planet.radius_m() + ground_m + altitude_m;
    let camera = Camera::over(place, radius_m, 0.6, pitch_deg.to_radians(), Camera::DEFAULT_FOV_Y_RAD);
    View { camera, size_px: SIZE_PX, quality: Quality::Medium }
}

fn frame<'a>(planet: &'a Planet, surface: &'a Surface, view: View, sun: LatLon) -> Frame<'a> {
    Frame {
        surface,
        planet,
        view,
        frozen: None,
        sun_dir_planet: sun.direction(),
        time_secs: 0.0,
        exposure_ev: 2.0,
        debug_view: DebugView::Shaded,
    }
}

/// Share of pixels that are lit or dark as rays from the ground to the star say, among those on the ground that are not next to a
/// change; and the same without horizons.
fn agreement(gpu: &mut Gpu, planet: &Arc<Planet>, view: View, sun: LatLon) -> [f64; 2] {
    let mut surface = build_now(planet, &view);
    add_detail(&mut surface, &view);
    let [width, height] = SIZE_PX.map(|side| side as usize);
    let sun_dir = sun.direction();
    let truth: Vec<Option<bool>> = (0..width * height)
        .map(|i| {
            let ndc = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 * 2.0 - 1.0;
            let (x, y) = (ndc(i % width, width), -ndc(i / width, height));
            let eye = view.camera.position_planet_m;
            let ray = view.camera.ray_dir_planet(x, y, view.aspect());
            let distance_m = surface.terrain.raycast(eye, ray)?;
            let ground = eye + ray * distance_m;
            // From a little above, as small relief is nothing but shading.
            let above_m = distance_m * view.pixel_rad() * 0.2;
            let from = ground + ground.normalize() * above_m;
            Some(surface.terrain.raycast(from, sun_dir).is_none())
        })
        .collect();
    let score = |picture: &[u8]| {
        let light = lights(picture);
        let (mut right, mut all) = (0, 0);
        for y in 1..height - 1 {
            for x in 1..width - 1 {
                let around = [-1_i64, 0, 1].into_iter().flat_map(|dy| [-1_i64, 0, 1].map(|dx| (dx, dy)));
                let at = |(dx, dy): (i64, i64)| ((y as i64 + dy) as usize) * width + (x as i64 + dx) as usize;
                let here = truth[y * width + x];
                if here.is_some() && around.into_iter().all(|off| truth[at(off)] == here) {
                    all += 1;
                    right += usize::from(Some(light[y * width + x] > 12) == here);
                }
            }
        }
        right as f64 / f64::from(all)
    };
    let with = score(&gpu.draw(&frame(planet, &surface, view, sun)));
    surface.leaves.iter_mut().for_each(|leaf| leaf.horizon = None);
    [with, score(&gpu.draw(&frame(planet, &surface, view, sun)))]
}

#[test]
fn what_is_dark_is_what_cannot_see_the_star() {
    let mut gpu = Gpu::new();
    // Several faces, from orbit to the ground; the star some degrees high.
    for (file, lat, lon, altitude_m, pitch, height_deg) in [
        ("pallor.ron", 10.0, 20.0, 400e3, -90.0, 8.0),
        ("pallor.ron", -35.0, 140.0, 50e3, -60.0, 5.0),
        ("pallor.ron", 70.0, -100.0, 5e3, -30.0, 10.0),
        ("pallor.ron", 10.0, 20.0, 200.0, -20.0, 10.0),
        ("aurel.ron", 30.0, 10.0, 50e3, -50.0, 6.0),
    ] {
        let planet = bare(file);
        let view = view(&planet, lat, lon, altitude_m, pitch);
        let (down, lat_rad) = ((90.0 - f64::from(height_deg)).to_radians(), f64::to_radians(lat));
        // Westward along the circle of latitude until the star is so low.
        let turn = ((libm::cos(down) - libm::sin(lat_rad).powi(2)) / libm::cos(lat_rad).powi(2)).clamp(-1.0, 1.0);
        let sun = LatLon { lat_rad, lon_rad: f64::to_radians(lon) - libm::acos(turn) };
        let [with, without] = agreement(&mut gpu, &planet, view, sun);
        println!("{file} from {altitude_m} m: {with:.3}, without horizons {without:.3}");
        assert!(with > 0.93 && with > without, "{file} from {altitude_m} m: {with}, without horizons {without}");
    }
}

#[test]
fn at_noon_nothing_is_in_shadow() {
    let mut gpu = Gpu::new();
    let planet = bare("pallor.ron");
    let view = view(&planet, 10.0, 20.0, 100e3, -90.0);
    let mut surface = build_now(&planet, &view);
    add_detail(&mut surface, &view);
    let noon = LatLon::from_degrees(10.0, 20.0);
    let with = lights(&gpu.draw(&frame(&planet, &surface, view, noon)));
    surface.leaves.iter_mut().for_each(|leaf| leaf.horizon = None);
    let without = lights(&gpu.draw(&frame(&planet, &surface, view, noon)));
    // Of three times 255; what slopes throw at each other is left.
    let most = with.iter().zip(&without).map(|(a, b)| a.abs_diff(*b)).max();
    assert!(most < Some(60), "{most:?}");
}

#[test]
fn only_another_ground_makes_other_horizons() {
    let planet = bare("pallor.ron");
    let view = view(&planet, 10.0, 20.0, 400e3, -90.0);
    let builder = Builder::new(|| {});
    let settled = |planet: &Planet| {
        builder.request(&Arc::new(planet.clone()), &view);
        while builder.is_busy() {
            std::thread::sleep(Duration::from_millis(1));
        }
        builder.surface().unwrap()
    };
    let first = settled(&planet);
    assert!(first.stats.horizons.tiles >= first.leaves.iter().filter(|leaf| leaf.detail.is_some()).count());
    assert!(first.leaves.iter().all(|leaf| leaf.detail.is_none() || leaf.horizon.as_ref().unwrap().id == leaf.tile.id));
    assert!(builder.memory().horizons >= first.stats.horizons.tiles);

    let mut dusk = Planet::clone(&planet);
    dusk.star.longitude_deg += 40.0;
    dusk.star.latitude_deg = 3.0;
    let moved = settled(&dusk).stats;
    assert_eq!((moved.tiles_built, moved.horizons.tiles), (0, 0), "the star");
    let mut warmer = dusk.clone();
    warmer.climate.equator_c += 5.0;
    let stats = settled(&warmer).stats;
    assert!(stats.tiles_built > 0);
    assert_eq!(stats.horizons.tiles, 0, "the climate");
    let mut rougher = warmer.clone();
    rougher.layers[0].amplitude_m *= 1.1;
    assert_eq!(settled(&rougher).stats.horizons.tiles, first.stats.horizons.tiles, "heights");
}
