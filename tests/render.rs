//! The renderer on a real (software) adapter.

mod support;

use std::sync::Arc;
use std::time::Instant;
use support::{Gpu, camera, earth, frame, height_m, surface};
use tellus::lod::Quality;
use tellus::render::DebugView;

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
    let shots: [(&str, [f64; 7]); 16] = [
        ("orbit", [15.0, 20.0, 13e6, 0.0, -90.0, 12.0, 0.0]),
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
        ("sea2", [-20.0, -60.0, 2.0, 40.0, -4.0, 12.0, -30.0]),
        ("sea300", [-20.0, -60.0, 300.0, 80.0, -12.0, 0.0, -25.0]),
        ("in_cloud", [10.0, 10.0, 4.2e3, 40.0, 0.0, 12.0, 0.0]),
    ];
    for (name, [lat, lon, altitude_m, heading, pitch, sun_lat, sun_lon]) in shots {
        if !wanted.is_empty() && !wanted.split(',').any(|w| w == name) {
            continue;
        }
        let camera = camera(&planet, lat, lon, altitude_m, heading, pitch);
        let surface = surface(&planet, camera.position_planet_m, 17, &height_m);
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
