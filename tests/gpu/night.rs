//! The night side: airglow, aurora, and lights of settlements.

use crate::support::{camera, earth, frame_of, gpu, surface_of};
use std::sync::Arc;
use tellus::bake::{Bake, Format, Map, Projection, Region};
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Atmosphere, Planet};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

/// Radiance of a view of 96 by 54 pixels, the star over the equator at a longitude.
pub(crate) fn radiance(planet: &Arc<Planet>, place: [f64; 5], sun_lon: f64) -> Vec<[f32; 3]> {
    let [lat, lon, altitude_m, heading, pitch] = place;
    let camera = camera(planet, lat, lon, altitude_m, heading, pitch);
    radiance_from(planet, View { camera, size_px: [96, 54], quality: Quality::Medium }, sun_lon)
}

fn radiance_from(planet: &Arc<Planet>, view: View, sun_lon: f64) -> Vec<[f32; 3]> {
    let surface = surface_of(planet, &view);
    gpu().radiance(&frame_of(&surface, planet, view, LatLon::from_degrees(0.0, sun_lon).direction()))
}

pub(crate) fn sum(pixels: &[[f32; 3]]) -> f64 {
    pixels.iter().flatten().map(|value| f64::from(*value)).sum()
}

fn with_aurora(aurora: f64) -> Arc<Planet> {
    let planet = earth();
    let air = planet.atmosphere.clone().map(|air| Atmosphere { aurora, ..air });
    Arc::new(Planet { atmosphere: air, clouds: None, ..planet })
}

#[test]
fn an_aurora_stands_over_its_oval_at_night() {
    // The magnetic pole leans towards longitude -70, so that the oval at midnight is at 53 degrees there.
    let under = [50.0, -70.0, 500.0, 0.0, 25.0];
    let [none, one, two] = [0.0, 1.0, 2.0].map(|aurora| radiance(&with_aurora(aurora), under, 110.0));
    let added = sum(&one) - sum(&none);
    assert!(added > 0.5 * sum(&none), "{added} over {}", sum(&none));
    assert!(((sum(&two) - sum(&none)) / added - 2.0).abs() < 0.05);
    // It is mostly green.
    let band = |band: usize| one.iter().zip(&none).map(|(a, b)| f64::from(a[band] - b[band])).sum::<f64>();
    assert!(band(1) > 1.4 * band(0) && band(1) > 1.3 * band(2), "{} {} {}", band(0), band(1), band(2));
    // There is none in the tropics, and daylight hides it.
    let tropics = [10.0, -70.0, 500.0, 0.0, 25.0];
    let [none, one] = [0.0, 1.0].map(|aurora| sum(&radiance(&with_aurora(aurora), tropics, 110.0)));
    assert!((one / none - 1.0).abs() < 1e-3, "{one} {none}");
    let [none, one] = [0.0, 1.0].map(|aurora| sum(&radiance(&with_aurora(aurora), under, -70.0)));
    assert!((one / none - 1.0).abs() < 0.02, "{one} {none}");
}

/// A single frame has no stripes: steps of its march are longer than curtains are wide.
#[test]
fn an_aurora_has_no_stripes() {
    let planet = Arc::new(Planet { radius_km: 5200.0, ..(*with_aurora(1.5)).clone() });
    let camera = camera(&planet, 50.0, -70.0, 420e3, 0.0, -15.0);
    let pixels = radiance_from(&planet, View { camera, size_px: [640, 360], quality: Quality::Medium }, 110.0);
    let green = |x: usize, y: usize| f64::from(pixels[y * 640 + x][1]);
    let (mut rough, mut all) = (0.0, 0.0);
    // Below the stars. Rays are upright and lower edges level: the mixed difference has neither.
    for (x, y) in (200..359).flat_map(|y| (0..639).map(move |x| (x, y))) {
        rough += (green(x, y) - green(x + 1, y) - green(x, y + 1) + green(x + 1, y + 1)).abs();
        all += green(x, y);
    }
    assert!(rough < 0.04 * all, "{}", rough / all);
}

/// From above, the shell in which air glows is an arc over the limb, as high as the shell.
#[test]
fn airglow_is_an_arc_over_the_limb() {
    let planet = Arc::new(Planet { clouds: None, ..earth() });
    let air_km = planet.atmosphere.as_ref().unwrap().height_km;
    let eye_km = planet.radius_km + 400.0;
    let dip_deg = |height_km: f64| ((planet.radius_km + height_km) / eye_km).acos().to_degrees();
    let pixels = radiance(&planet, [0.0, -70.0, 400e3, 0.0, -dip_deg(0.0)], 110.0);
    assert!(pixels.iter().flatten().all(|value| value.is_finite()));
    let rows: Vec<f64> = pixels.chunks(96).map(|row| sum(&row[46..50])).collect();
    let brightest = (0..54).max_by(|a, b| rows[*a].total_cmp(&rows[*b])).unwrap();
    // The limb lies between the middle rows.
    let half_rad = 0.5 * Camera::DEFAULT_FOV_Y_RAD;
    let rise_rad = (dip_deg(0.0) - dip_deg(0.9 * air_km)).to_radians();
    let expected = 26.5 - 27.0 * rise_rad.tan() / half_rad.tan();
    assert!((brightest as f64 - expected).abs() <= 1.0, "row {brightest} instead of {expected}");
    assert!(rows[brightest] > 5.0 * rows[40] && rows[brightest] > 5.0 * rows[10], "{rows:?}");
    // A giant is so wide that squares of lengths have few digits.
    let giant = Arc::new(Planet { radius_km: 70_000.0, ..(*planet).clone() });
    for altitude_m in [1e5, 1e7, 3e8] {
        let pixels = radiance(&giant, [0.0, -70.0, altitude_m, 0.0, -60.0], 110.0);
        // Radiance that is no number may be clamped to the greatest one.
        assert!(pixels.iter().flatten().all(|value| value.is_finite() && *value < 1.0), "from {altitude_m} m");
    }
}

#[test]
fn settlements_shine_on_land_at_night() {
    let with = |settlements: f64, level_m: f64| {
        let mut planet = Planet { settlements, clouds: None, layers: Vec::new(), ..earth() };
        planet.water.as_mut().unwrap().level_m = level_m;
        (planet.climate.moisture, planet.climate.temperature_variation_c) = (0.6, 0.0);
        Arc::new(planet)
    };
    let above = [30.0, 20.0, 300e3, 0.0, -90.0];
    let seen =
        |settlements: f64, level_m: f64, sun_lon: f64| sum(&radiance(&with(settlements, level_m), above, sun_lon));
    let (dark, lit) = (seen(0.0, -20.0, 200.0), seen(1.0, -20.0, 200.0));
    assert!(lit > 3.0 * dark, "{lit} over {dark}");
    let (dark, lit) = (seen(0.0, 20.0, 200.0), seen(1.0, 20.0, 200.0));
    assert!((lit / dark - 1.0).abs() < 1e-3, "at sea: {lit} over {dark}");
    let (dark, lit) = (seen(0.0, -20.0, 20.0), seen(1.0, -20.0, 20.0));
    assert!((lit / dark - 1.0).abs() < 1e-3, "by day: {lit} over {dark}");
}

#[test]
fn baked_lights_are_those_that_are_drawn() {
    let with = |settlements: f64| {
        let mut planet = Planet { settlements, clouds: None, atmosphere: None, layers: Vec::new(), ..earth() };
        planet.water.as_mut().unwrap().level_m = -20.0;
        (planet.climate.moisture, planet.climate.temperature_variation_c) = (0.6, 0.0);
        Arc::new(planet)
    };
    let above = [30.0, 20.0, 300e3, 0.0, -90.0];
    let (dark, lit) = (radiance(&with(0.0), above, 200.0), radiance(&with(1.0), above, 200.0));
    // The square in the middle of the picture, as high as the picture.
    let side_km = 2.0 * 300.0 * (0.5 * Camera::DEFAULT_FOV_Y_RAD).tan();
    let region = Projection::Region(Region { lat_deg: 30.0, lon_deg: 20.0, side_km });
    let terrain = Arc::new(Terrain::try_new(with(1.0)).unwrap());
    let folder = tempfile::tempdir().unwrap();
    let bake = Bake::new(terrain, vec![Map::NightLights], region, 54, Format::Png16);
    bake.run(folder.path(), &|_| true).unwrap();
    let about = std::fs::read_to_string(folder.path().join("night_lights.json")).unwrap();
    let about: serde_json::Value = serde_json::from_str(&about).unwrap();
    let (min, max) = (about["min"].as_f64().unwrap(), about["max"].as_f64().unwrap());
    let baked = image::open(folder.path().join("night_lights.png")).unwrap().into_rgb16();
    // Means of blocks of 9 by 9 pixels: the projections of picture and map differ by less.
    let block = |value: &dyn Fn(u32, u32) -> f64, i: u32| {
        let (left, top) = (i % 6 * 9, i / 6 * 9);
        (0..81).map(|k| value(left + k % 9, top + k / 9)).sum::<f64>() / 81.0
    };
    let drawn = |x: u32, y: u32| {
        let pixel = (y * 96 + x + 21) as usize;
        f64::from(lit[pixel][0] - dark[pixel][0])
    };
    let found = |x: u32, y: u32| min + f64::from(baked.get_pixel(x, y).0[0]) / 65_535.0 * (max - min);
    let pairs: Vec<(f64, f64)> = (0..36).map(|i| (block(&drawn, i), block(&found, i))).collect();
    let (mean_drawn, mean_found) =
        pairs.iter().fold((0.0, 0.0), |(a, b), (drawn, found)| (a + drawn / 36.0, b + found / 36.0));
    assert!((mean_found / mean_drawn - 1.0).abs() < 0.15, "{mean_found} baked, {mean_drawn} drawn");
    let (mut both, mut of_drawn, mut of_found) = (0.0, 0.0, 0.0);
    for (drawn, found) in pairs {
        let (a, b) = (drawn - mean_drawn, found - mean_found);
        (both, of_drawn, of_found) = (both + a * b, of_drawn + a * a, of_found + b * b);
    }
    let alike = both / (of_drawn * of_found).sqrt();
    assert!(alike > 0.9, "the pattern is another one: {alike}");
}
