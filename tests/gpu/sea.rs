//! The sea: waves where queries say they are, the view from under it, floes, glow.

use crate::scene::Stages;
use crate::support::{camera, earth, frame, frame_of, gpu, lights, preset, surface, surface_of};
use std::sync::Arc;
use tellus::lod::{Quality, View};
use tellus::planet::{Planet, Water};
use tellus::render::Scene;
use tellus::sea::{Column, Waves};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

const SIZE_PX: [u32; 2] = [64, 64];

/// A planet of water alone, without air or clouds.
fn sea(water: Water) -> Arc<Planet> {
    Arc::new(Planet { layers: Vec::new(), clouds: None, atmosphere: None, water: Some(water), ..earth() })
}

/// Heights of the water under an eye 9 m over it, at 12 times: drawn, and found by a query.
fn heights_m(planet: &Arc<Planet>, place: LatLon) -> Vec<(f64, f64)> {
    let terrain = Terrain::try_new(planet.clone()).unwrap();
    let waves = Waves::near(&terrain, place.direction());
    let column = Column::at(&terrain, place.direction());
    let (lat_deg, lon_deg) = place.to_degrees();
    let camera = camera(planet, lat_deg, lon_deg, 9.0, 20.0, -90.0);
    let view = View { camera, size_px: SIZE_PX, quality: Quality::High };
    let surface = surface_of(planet, &view);
    let mut gpu = gpu();
    let stages = Stages::new(&gpu, SIZE_PX);
    let at = |step: i32| {
        let mut scene = frame_of(&surface, planet, view, LatLon::from_degrees(50.0, 20.0).direction());
        scene.time_secs = f64::from(step) * 2.3;
        scene.projection.near_m = Some(0.5);
        stages.draw(&mut gpu, &scene, [0, 0, SIZE_PX[0], SIZE_PX[1]], false).unwrap();
        let middle = (SIZE_PX[0] * (SIZE_PX[1] + 1) / 2) as usize;
        let drawn_m = 9.0 - 0.5 / f64::from(stages.depths(&gpu)[middle]);
        (drawn_m, waves.surface(place.direction(), scene.time_secs, &column).wave_m)
    };
    (0..12).map(at).collect()
}

/// Highest less lowest of the heights that were found.
fn range_m(heights_m: &[(f64, f64)]) -> f64 {
    let found = || heights_m.iter().map(|(_, found_m)| *found_m);
    found().fold(f64::MIN, f64::max) - found().fold(f64::MAX, f64::min)
}

/// A boat floats on the water that is drawn: in the open, near the shore and between floes.
#[test]
fn the_surface_is_drawn_where_queries_find_it() {
    let place = LatLon::from_degrees(31.0, 47.0);
    let rough = Water { level_m: 100.0, wind_m_s: 14.0, swell_m: 3.0, freezing_c: -100.0, ..Water::default() };
    let range_of = |water: Water, most_m: f64| {
        let heights_m = heights_m(&sea(water), place);
        for (drawn_m, found_m) in &heights_m {
            assert!((drawn_m - found_m).abs() < most_m, "{drawn_m} m drawn, {found_m} m found");
        }
        range_m(&heights_m)
    };
    let open_m = range_of(rough.clone(), 0.12);
    assert!(open_m > 1.0, "{open_m} m");
    // Where the depth is 3 m, waves have broken.
    let shallow_m = range_of(Water { level_m: 3.0, ..rough.clone() }, 0.12);
    assert!(shallow_m > 0.3 && shallow_m < 0.8 * open_m, "{shallow_m} m of {open_m} m");
    // Ice leaves the longest waves alone.
    let icy_m = range_of(Water { freezing_c: 100.0, ..rough }, 0.12);
    assert!(icy_m < 0.35 * open_m, "{icy_m} m of {open_m} m");
}

/// The open sea around an eye 2 m over it has waves as far as the foot of the picture: bed that is not in the picture
/// is no shore. The waves are those of the solved wind: without it the sea on the equator is calm.
#[test]
fn open_water_has_waves_up_to_the_eye() {
    let planet = Arc::new(preset("maren.ron"));
    let mut gpu = gpu();
    let camera = camera(&planet, 0.0, -120.0, 2.0, 270.0, -3.0);
    let view = View { camera, size_px: [192, 108], quality: Quality::High };
    let surface = surface_of(&planet, &view);
    let scene = Scene::of_planet(&surface, view, LatLon::from_degrees(10.0, -130.0).direction());
    gpu.draw_only(&scene, 1);
    let ([width, height], radiance) = gpu.renderer.radiance().unwrap();
    let [width, height] = [width as usize, height as usize];
    // How much the light changes from row to row, by the light, in bands of rows.
    let roughness = |rows: std::ops::Range<usize>| {
        let (mut change, mut light) = (0.0, 0.0);
        for i in rows.flat_map(|y| (0..width).map(move |x| y * width + x)) {
            change += f64::from(radiance[i][1] - radiance[i - width][1]).abs();
            light += f64::from(radiance[i][1]);
        }
        change / light
    };
    let bands = [0.54, 0.74, 0.87].map(|from: f64| {
        let first = (from * height as f64) as usize;
        roughness(first..first + height / 8)
    });
    assert!(bands[1].min(bands[2]) > 0.5 * bands[0], "{bands:?}");
}

/// From below, the sky is a bright window overhead; beyond it the surface mirrors dark water.
#[test]
fn snells_window_is_overhead() {
    let planet = Arc::new(Planet {
        layers: Vec::new(),
        clouds: None,
        water: Some(Water { level_m: 500.0, wind_m_s: 1.0, swell_m: 0.0, ..Water::default() }),
        ..earth()
    });
    let mut gpu = gpu();
    let mut mean = |pitch: f64| {
        let camera = camera(&planet, 10.0, 10.0, -5.0, 0.0, pitch);
        let surface = surface(&planet, &camera);
        gpu.draw(&frame(&surface, &planet, camera, (12.0, 60.0)));
        let (size_px, radiance) = gpu.renderer.radiance().unwrap();
        // The middle of the picture alone: its rays are those of the pitch.
        let [width, height] = size_px.map(|side| side as usize);
        let rows = height * 2 / 5..height * 3 / 5;
        let middle = rows.flat_map(|y| (width * 2 / 5..width * 3 / 5).map(move |x| y * width + x));
        let greens: Vec<f64> = middle.map(|i| f64::from(radiance[i][1])).collect();
        greens.iter().sum::<f64>() / greens.len() as f64
    };
    // The window ends 48.6° from the zenith.
    let (inside, outside, down) = (mean(60.0), mean(20.0), mean(-60.0));
    assert!(inside > 1.5 * outside, "{inside} inside of the window, {outside} outside");
    // The surface mirrors water that is nearly level, which is brighter than the depths (Tyler 1960).
    assert!(outside > down && outside < 5.0 * down, "{outside} outside of the window, {down} below");
}

/// Gusts and slicks are longer along the wind than across it. Here it blows from 77 degrees, from right to left.
#[test]
fn ripples_are_drawn_out_along_the_wind() {
    let planet = sea(Water { fetch_km: 0.2, swell_m: 0.0, level_m: 500.0, ..Water::default() });
    let camera = camera(&planet, 3.0, 10.0, 6000.0, 347.0, -90.0);
    let surface = surface(&planet, &camera);
    let mut gpu = gpu();
    gpu.draw_only(&frame(&surface, &planet, camera, (3.0, 32.0)), 1);
    let ([width, height], light) = gpu.renderer.radiance().unwrap();
    // Curvature over a distance of about the width of a patch: the glint itself is smooth.
    let curvature = |step: [u32; 2]| {
        let (away_x, away_y) = (step[0] as usize, step[1] as usize);
        // The water itself is not red.
        let at = |x: usize, y: usize| f64::from(light[y * width as usize + x][0]);
        let inside = (8..height as usize - 8).flat_map(|y| (8..width as usize - 8).map(move |x| (x, y)));
        inside
            .map(|(x, y)| (at(x + away_x, y + away_y) - 2.0 * at(x, y) + at(x - away_x, y - away_y)).abs() / at(x, y))
            .sum::<f64>()
    };
    let (along, across) = (curvature([4, 0]), curvature([0, 4]));
    assert!(across > 1.4 * along, "{along} along the wind, {across} across it");
}

/// Near the temperature of freezing there is ice and open water; where it is colder, ice alone.
#[test]
fn floes_cover_more_where_it_is_colder() {
    let mut gpu = gpu();
    let mut whites = |freezing_c: f64| {
        let mut planet = (*sea(Water { freezing_c, level_m: 500.0, ..Water::default() })).clone();
        (planet.climate.equator_c, planet.climate.pole_c) = (-5.0, -5.0);
        planet.climate.temperature_variation_c = 0.0;
        let planet = Arc::new(planet);
        let camera = camera(&planet, 10.0, 10.0, 9500.0, 0.0, -90.0);
        let surface = surface(&planet, &camera);
        let lights = lights(&gpu.draw(&frame(&surface, &planet, camera, (30.0, 10.0))));
        let white = lights.iter().filter(|light| **light > 3 * 110).count();
        white as f64 / lights.len() as f64
    };
    let shares = [-15.0, -6.0, -4.0, 5.0].map(&mut whites);
    // The glint of the sun is white as well, without any ice.
    assert!(shares[0] < 0.03 && shares[3] > 0.9, "{shares:?}");
    assert!(shares[1] > 0.05 && shares[1] < shares[2] && shares[2] < 0.97, "{shares:?}");
}

/// A sea of lava shines at night.
#[test]
fn a_glowing_sea_shines_at_night() {
    let mut gpu = gpu();
    let mut light = |glow: f64| {
        let planet = sea(Water { glow, freezing_c: -100.0, level_m: 500.0, ..Water::default() });
        let camera = camera(&planet, 10.0, 10.0, 1e6, 0.0, -90.0);
        let surface = surface(&planet, &camera);
        let lights = lights(&gpu.draw(&frame(&surface, &planet, camera, (-10.0, -170.0))));
        lights[lights.len() / 2]
    };
    assert!(light(0.0) < 10 && light(1.0) > 150);
}

/// Number of single pixels on the water of a view from 2 m that are darker than all pixels around.
fn specks(file: &str, [lat, lon, heading, pitch]: [f64; 4], sun: LatLon) -> usize {
    let planet = Arc::new(Planet { clouds: None, ..preset(file) });
    let camera = camera(&planet, lat, lon, 2.0, heading, pitch);
    let view = View { camera, size_px: [640, 360], quality: Quality::Medium };
    let surface = surface_of(&planet, &view);
    let light = gpu().radiance(&frame_of(&surface, &planet, view, sun.direction()));
    let [width, height] = view.size_px.map(|px| px as usize);
    let green = |x: usize, y: usize| f64::from(light[y * width + x][1]);
    let is_speck = |x: usize, y: usize| {
        let mut around = (0..9).filter(|k| *k != 4).map(|k| green(x + k % 3 - 1, y + k / 3 - 1));
        around.all(|other| green(x, y) < 0.8 * other)
    };
    let below = height * 7 / 10..height - 1;
    below.flat_map(|y| (1..width - 1).map(move |x| (x, y))).filter(|&(x, y)| is_speck(x, y)).count()
}

/// Where the bed is so far away that it tells nothing about the depth here, waves are those of deep water. Single
/// pixels had those of shallow water. Some waves are as narrow as a pixel.
#[test]
fn a_deep_sea_has_no_specks() {
    let specks = specks("maren.ron", [8.0, -35.0, 60.0, 12.0], LatLon::from_degrees(20.0, -20.0));
    assert!(specks <= 12, "{specks} specks");
}

/// Leads between floes are lines: noise finer than they are wide broke them into dots.
#[test]
fn leads_are_no_specks() {
    let specks = specks("hoarfrost.ron", [30.0, 10.0, 60.0, -4.0], LatLon::from_degrees(10.0, 30.0));
    assert!(specks <= 3, "{specks} specks");
}
