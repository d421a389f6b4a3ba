//! The renderer on a real (software) adapter.

#![allow(clippy::expect_used, clippy::panic)]

mod support;

use std::sync::Arc;
use std::time::Instant;
use support::{Gpu, camera, earth, frame, height_m, surface};
use tellus::lod::Quality;
use tellus::planet::{Clouds, Planet};
use tellus::render::{DebugView, Frame};
use tellus::sphere::LatLon;

/// Pictures to look at, with their times: `TELLUS_GALLERY=folder cargo test --test render gallery -- --ignored --nocapture`;
/// `TELLUS_SHOTS` picks some by name, `TELLUS_QUALITY` is low, medium or high.
#[test]
#[ignore = "makes pictures for people"]
#[allow(clippy::print_stdout)]
fn gallery() {
    let folder = std::env::var("TELLUS_GALLERY").unwrap_or_else(|_| std::env::temp_dir().display().to_string());
    let wanted = std::env::var("TELLUS_SHOTS").unwrap_or_default();
    let quality = match std::env::var("TELLUS_QUALITY").as_deref() {
        Ok("low") => Quality::Low,
        Ok("high") => Quality::High,
        _ => Quality::Medium,
    };
    let planet = Arc::new(earth());
    let mut gpu = Gpu::new();
    // Name, latitude, longitude, altitude in metres, heading, pitch, sun's latitude and longitude.
    let shots: [(&str, [f64; 7]); 17] = [
        ("orbit", [15.0, 20.0, 13e6, 0.0, -90.0, 12.0, 0.0]),
        ("orbit_back", [-10.0, 200.0, 13e6, 0.0, -90.0, 12.0, 180.0]),
        ("orbit_dusk", [15.0, 20.0, 13e6, 0.0, -90.0, 12.0, -70.0]),
        ("orbit_pole", [75.0, 20.0, 9e6, 0.0, -90.0, 12.0, 0.0]),
        ("limb", [10.0, 10.0, 400e3, 40.0, -18.0, 12.0, 0.0]),
        ("limb_sun", [10.0, 10.0, 400e3, 270.0, -14.0, 8.0, -95.0]),
        ("down400", [10.0, 10.0, 400e3, 40.0, -60.0, 12.0, 0.0]),
        ("km10", [10.0, 10.0, 10e3, 40.0, -12.0, 12.0, 0.0]),
        ("km10_sunset", [10.0, 10.0, 10e3, 270.0, -4.0, 12.0, -78.0]),
        ("m100", [10.0, 10.0, 100.0, 40.0, 0.0, 12.0, 0.0]),
        ("m2", [10.0, 10.0, 2.0, 40.0, 2.0, 12.0, 0.0]),
        ("m2_sunset", [10.0, 10.0, 2.0, 275.0, 8.0, 10.0, -76.0]),
        ("m2_night", [10.0, 10.0, 2.0, 40.0, 20.0, 12.0, 160.0]),
        ("m2_up", [10.0, 10.0, 2.0, 200.0, 60.0, 12.0, 0.0]),
        ("sea2", [-20.0, -60.0, 2.0, 60.0, -4.0, 0.0, 50.0]),
        ("sea300", [-20.0, -60.0, 300.0, 70.0, -12.0, 0.0, 60.0]),
        ("in_cloud", [10.0, 10.0, 4.2e3, 40.0, 0.0, 12.0, 0.0]),
    ];
    for (name, [lat, lon, altitude_m, heading, pitch, sun_lat, sun_lon]) in shots {
        if !wanted.is_empty() && !wanted.split(',').any(|w| w == name) {
            continue;
        }
        let mut lon = lon;
        while name.starts_with("sea") && height_m(LatLon::from_degrees(lat, lon).direction()) > -900.0 {
            lon += 0.5;
        }
        let camera = camera(&planet, lat, lon, altitude_m, heading, pitch);
        let surface = surface(&planet, camera.position_planet_m, 17, &height_m);
        let sun_lon = if name.starts_with("sea") { lon + sun_lon } else { sun_lon };
        let mut frame = frame(&surface, &planet, camera, (sun_lat, sun_lon));
        frame.view.size_px = [1280, 720];
        frame.view.quality = quality;
        frame.time_secs = 20.0;
        let picture = gpu.draw(&frame);
        let start = Instant::now();
        let again = gpu.draw(&frame);
        println!("{name}: {:.0} ms, {} tiles", start.elapsed().as_secs_f64() * 1e3, surface.leaves.len());
        assert_eq!(picture, again, "{name} differs when drawn twice");
        let path = std::path::Path::new(&folder).join(format!("{name}.png"));
        image::save_buffer(path, &picture, 1280, 720, image::ExtendedColorType::Rgba8).expect("saved");
    }
    let camera = camera(&planet, 15.0, 20.0, 13e6, 0.0, -90.0);
    let surface = surface(&planet, camera.position_planet_m, 17, &height_m);
    for view in DebugView::ALL.into_iter().skip(1) {
        let name = format!("debug_{}", view.label().replace(' ', "_"));
        if !wanted.is_empty() && !wanted.split(',').any(|w| w == "debug") {
            continue;
        }
        let mut frame = frame(&surface, &planet, camera, (12.0, 0.0));
        frame.debug_view = view;
        let picture = gpu.draw(&frame);
        let path = std::path::Path::new(&folder).join(format!("{name}.png"));
        image::save_buffer(path, &picture, 320, 180, image::ExtendedColorType::Rgba8).expect("saved");
    }
}

/// Processor time of this process so far, in milliseconds (Linux: clock ticks of 10 ms).
fn processor_ms() -> f64 {
    let stat = std::fs::read_to_string("/proc/self/stat").unwrap_or_default();
    let fields: Vec<&str> = stat.rsplit(')').next().unwrap_or("").split_whitespace().collect();
    let ticks = |i: usize| fields.get(i).and_then(|f| f.parse::<f64>().ok()).unwrap_or(0.0);
    (ticks(11) + ticks(12)) * 10.0
}

/// What each pass costs: the same view with ever more of the planet. Processor time too, because other work on the machine
/// stretches the wall's.
#[test]
#[ignore = "measures"]
#[allow(clippy::print_stdout)]
fn timing() {
    let mut gpu = Gpu::new();
    let qualities = [Quality::Low, Quality::Medium, Quality::High];
    let count = std::env::var("TELLUS_QUALITIES").ok().and_then(|n| n.parse().ok()).unwrap_or(3);
    let qualities = qualities.into_iter().take(count).collect::<Vec<_>>();
    let full = earth();
    let parts: [(&str, [bool; 3]); 5] = [
        ("stars, tone mapping", [false, false, false]),
        ("+ terrain", [false, false, false]),
        ("+ air", [true, false, false]),
        ("+ water", [true, true, false]),
        ("+ clouds", [true, true, true]),
    ];
    for (pose, altitude_m, pitch) in [("orbit", 13e6, -90.0), ("10 km", 10e3, -12.0), ("2 m", 2.0, 2.0)] {
        for &quality in &qualities {
            for (name, [air, water, clouds]) in parts {
                let mut planet = full.clone();
                planet.atmosphere = planet.atmosphere.filter(|_| air);
                planet.water = planet.water.filter(|_| water);
                planet.clouds = planet.clouds.filter(|_| clouds);
                let planet = Arc::new(planet);
                let camera = camera(&full, 10.0, 10.0, altitude_m, 40.0, pitch);
                let mut surface = surface(&planet, camera.position_planet_m, 12, &height_m);
                if name.starts_with("stars") {
                    surface.leaves.clear();
                }
                let mut frame = frame(&surface, &planet, camera, (12.0, 0.0));
                frame.view.size_px = [1280, 720];
                frame.view.quality = quality;
                gpu.draw_only(&frame, 1);
                let frames = if quality == Quality::High { 1 } else { 4 };
                let (start, before) = (Instant::now(), processor_ms());
                gpu.draw_only(&frame, frames);
                let each = 1.0 / frames as f64;
                println!(
                    "{pose}, {}, {name}: {:.0} ms, processor {:.0} ms",
                    quality.label(),
                    start.elapsed().as_secs_f64() * 1e3 * each,
                    (processor_ms() - before) * each
                );
            }
        }
    }
}

fn lights(picture: &[u8]) -> Vec<u32> {
    picture.chunks(4).map(|p| u32::from(p[0]) + u32::from(p[1]) + u32::from(p[2])).collect()
}

/// Whether the middle of each pixel of a 320x180 picture lies well within the planet's disc.
fn inside_disc(frame: &Frame<'_>, lowest_m: f64) -> Vec<bool> {
    let [width, height] = frame.view.size_px;
    let eye = frame.view.camera.position_planet_m;
    let radius_m = frame.planet.radius_m() + lowest_m;
    (0..height)
        .flat_map(|y| (0..width).map(move |x| (x, y)))
        .map(|(x, y)| {
            let ndc = |i: u32, n: u32| (f64::from(i) + 0.5) / f64::from(n) * 2.0 - 1.0;
            let dir = frame.view.camera.ray_dir_planet(ndc(x, width), -ndc(y, height), frame.view.aspect());
            let closest = eye - dir * eye.dot(dir);
            eye.dot(dir) < 0.0 && closest.length() < radius_m * 0.999
        })
        .collect()
}

/// Poses from space to the ground, by day, at dusk and at night: altitude, pitch, the sun's longitude.
const POSES: [(f64, f64, f64); 8] = [
    (13e6, -90.0, 0.0),
    (13e6, -90.0, -80.0),
    (400e3, -18.0, 0.0),
    (400e3, -18.0, -100.0),
    (10e3, -12.0, 10.0),
    (100.0, 0.0, -78.0),
    (2.0, 2.0, 0.0),
    (2.0, 90.0, 10.0),
];

#[test]
fn every_pose_is_lit_and_drawn_twice_the_same() {
    let planet = Arc::new(earth());
    let mut gpu = Gpu::new();
    for quality in Quality::ALL {
        for (altitude_m, pitch, sun_lon) in POSES {
            let camera = camera(&planet, 10.0, 10.0, altitude_m, 40.0, pitch);
            let surface = surface(&planet, camera.position_planet_m, 10, &height_m);
            let mut frame = frame(&surface, &planet, camera, (12.0, sun_lon));
            frame.view.quality = quality;
            let picture = gpu.draw(&frame);
            assert_eq!(picture, gpu.draw(&frame), "{altitude_m} m, {quality:?}");
            // A pixel that is not a number comes out black, and so would every one that it is averaged with.
            let day = sun_lon.abs() < 20.0;
            let disc = inside_disc(&frame, 0.0);
            let black = lights(&picture).iter().zip(&disc).filter(|(light, inside)| **inside && **light < 12).count();
            assert!(!day || black == 0, "{black} black pixels from {altitude_m} m, {quality:?}");
        }
    }
}

#[test]
fn the_surface_has_no_holes() {
    let planet = Arc::new(earth());
    let mut gpu = Gpu::new();
    for (altitude_m, pitch, _) in POSES {
        let camera = camera(&planet, 40.0, 44.0, altitude_m, 40.0, pitch);
        let surface = surface(&planet, camera.position_planet_m, 10, &height_m);
        let mut frame = frame(&surface, &planet, camera, (12.0, 0.0));
        frame.debug_view = DebugView::Coverage;
        let picture = gpu.draw(&frame);
        let holes = lights(&picture)
            .iter()
            .zip(inside_disc(&frame, -8000.0))
            .filter(|(light, inside)| *inside && **light != 765)
            .count();
        assert_eq!(holes, 0, "from {altitude_m} m");
        assert!(lights(&picture).iter().all(|&light| light == 0 || light == 765));
    }
}

#[test]
fn clouds_that_cover_nothing_are_no_clouds() {
    let bare = Arc::new(Planet { clouds: None, ..earth() });
    let clear = Planet { clouds: Some(Clouds { coverage: 0.0, ..Clouds::default() }), ..earth() };
    let mut gpu = Gpu::new();
    for (altitude_m, pitch, sun_lon) in POSES {
        let camera = camera(&bare, 10.0, 10.0, altitude_m, 40.0, pitch);
        let surface = surface(&bare, camera.position_planet_m, 8, &height_m);
        let without = gpu.draw(&frame(&surface, &bare, camera, (12.0, sun_lon)));
        let with = gpu.draw(&frame(&surface, &clear, camera, (12.0, sun_lon)));
        assert_eq!(without, with, "from {altitude_m} m");
    }
}

#[test]
fn closed_clouds_hide_the_ground_from_above_beneath_and_within() {
    let clouds = Clouds { coverage: 1.0, density: 20.0, ..Clouds::default() };
    let dark = Planet { clouds: Some(clouds), ..earth() };
    let mut gpu = Gpu::new();
    // Only what is behind the clouds differs: the stars' brightness through them cannot show, nor can the ground.
    for (altitude_m, pitch) in [(2000e3, -90.0), (10e3, -60.0), (4e3, 0.0)] {
        let camera = camera(&dark, 10.0, 10.0, altitude_m, 40.0, pitch);
        let bright = Planet { water: None, ..dark.clone() };
        let planet = Arc::new(dark.clone());
        let surface = surface(&planet, camera.position_planet_m, 8, &height_m);
        let one = lights(&gpu.draw(&frame(&surface, &planet, camera, (12.0, 10.0))));
        let other = lights(&gpu.draw(&frame(&surface, &bright, camera, (12.0, 10.0))));
        let disc = inside_disc(&frame(&surface, &planet, camera, (12.0, 10.0)), 0.0);
        let most = one.iter().zip(&other).zip(disc).filter(|(_, inside)| *inside);
        let most = most.map(|((a, b), _)| a.abs_diff(*b)).max().unwrap_or(0);
        assert!(most <= 12, "the ground shows through by {most} from {altitude_m} m");
    }
}

#[test]
fn the_night_side_of_a_moon_is_black() {
    let moon = Arc::new(Planet { water: None, atmosphere: None, clouds: None, ..earth() });
    let mut gpu = Gpu::new();
    let camera = camera(&moon, 0.0, 0.0, 13e6, 0.0, -90.0);
    let surface = surface(&moon, camera.position_planet_m, 3, &height_m);
    let night = frame(&surface, &moon, camera, (0.0, 180.0));
    let disc = inside_disc(&night, -5000.0);
    let brightest = lights(&gpu.draw(&night)).into_iter().zip(&disc).filter(|(_, i)| **i).map(|(l, _)| l).max();
    assert_eq!(brightest, Some(0));
    let day = lights(&gpu.draw(&frame(&surface, &moon, camera, (0.0, 0.0))));
    let center = day[90 * 320 + 160];
    assert!(center > 60, "{center}");
}

#[test]
fn the_sea_lies_where_the_ground_is_below_its_level() {
    // Half of the globe two kilometres deep, half two kilometres high; neither clouds nor ice.
    let mut planet = earth();
    planet.clouds = None;
    planet.climate.pole_c = 20.0;
    let planet = Arc::new(planet);
    let step = |dir: glam::DVec3| if dir.y < 0.0 { -2000.0 } else { 2000.0 };
    let mut gpu = Gpu::new();
    let camera = camera(&planet, 0.0, 0.0, 13e6, 0.0, -90.0);
    let surface = surface(&planet, camera.position_planet_m, 4, &step);
    let picture = gpu.draw(&frame(&surface, &planet, camera, (30.0, 0.0)));
    let pixel = |x: usize| &picture[(90 * 320 + x) * 4..][..3];
    let (sea, land) = (pixel(160 - 30), pixel(160 + 30));
    assert!(sea[2] > sea[0] + 30 && sea[2] > sea[1], "{sea:?}");
    assert!(land[2] < land[1] + 20, "{land:?}");
}
