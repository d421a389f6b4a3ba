//! The planets that ship with the program, drawn as a person would see them: no holes, the same twice, and as they
//! looked when somebody last looked (goldens, blessed on Mesa's software driver with `TELLUS_BLESS=1`).
#![cfg(feature = "editor")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod support;

use glam::DVec3;
use image::RgbImage;
use std::path::PathBuf;
use std::sync::Arc;
use support::{Gpu, camera_over, frame_of, inside_disc, lights, surface_of};
use tellus::lod::opening::{default_pitch_deg, opening_place, opening_view};
use tellus::lod::{Quality, View};
use tellus::planet::{Planet, shipped};
use tellus::render::DebugView;
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

const SIZE_PX: [u32; 2] = [192, 108];

fn planets() -> Vec<(&'static str, Arc<Planet>)> {
    shipped::ALL.iter().map(|preset| (preset.file, Arc::new(preset.load().unwrap()))).collect()
}

/// Over the planet's opening place, at a height over ground or sea.
fn view(planet: &Arc<Planet>, altitude_m: f64) -> View {
    let (terrain, place) = (Terrain::try_new(planet.clone()).unwrap(), opening_place(planet));
    let pitch_rad = default_pitch_deg(planet, altitude_m).to_radians();
    let camera = camera_over(&terrain, place, altitude_m, [0.8, pitch_rad]);
    View { camera, size_px: SIZE_PX, quality: Quality::Low }
}

/// Where the star stands at noon over the opening place, and where it sets there.
fn noon_and_sunset(planet: &Planet) -> [LatLon; 2] {
    let place = opening_place(planet);
    let west = |rad: f64| LatLon { lon_rad: place.lon_rad - rad, ..place };
    [west(0.2), LatLon { lat_rad: 0.0, ..west(1.5) }]
}

#[test]
fn every_planet_from_orbit_to_the_ground_has_no_hole_and_is_drawn_the_same_twice() {
    let mut gpu = Gpu::new();
    for (file, planet) in planets() {
        for altitude_m in [1.9 * planet.radius_m(), 10_000.0, 100.0] {
            let view = view(&planet, altitude_m);
            let surface = surface_of(&planet, &view);
            let lowest_m = surface.leaves.iter().map(|leaf| leaf.tile.min_height_m).fold(f64::MAX, f64::min);

            let mut coverage = frame_of(&surface, &planet, view, DVec3::X);
            coverage.debug_view = DebugView::Coverage;
            let white = lights(&gpu.draw(&coverage));
            // A coarse tile's chord lies below the sphere by up to spacing^2 / 8 R.
            let inside = inside_disc(&coverage, lowest_m.min(0.0) - 0.003 * planet.radius_m());
            let holes = white.iter().zip(&inside).filter(|(light, inside)| **inside && **light != 765).count();
            assert_eq!(holes, 0, "{file} from {altitude_m} m");

            for sun in noon_and_sunset(&planet) {
                let frame = frame_of(&surface, &planet, view, sun.direction());
                let picture = gpu.draw(&frame);
                assert!(lights(&picture).iter().any(|&light| light > 150), "{file} from {altitude_m} m is dark");
                // Where there is air no place that the star stands over is black; a value that
                // is not a number would be.
                let noon = sun == noon_and_sunset(&planet)[0] && planet.atmosphere.is_some();
                let black =
                    lights(&picture).iter().zip(&inside).filter(|(light, inside)| **inside && **light == 0).count();
                assert!(!noon || black == 0, "{file} from {altitude_m} m has {black} black pixels at noon");
                assert!(picture == gpu.draw(&frame), "{file} from {altitude_m} m");
            }
        }
    }
}

#[test]
fn every_planet_looks_as_it_did() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/goldens");
    let mut gpu = Gpu::new();
    let mut problems = Vec::new();
    for (file, planet) in planets() {
        let near = View { quality: Quality::Medium, ..view(&planet, 10_000.0) };
        for (name, view) in [("orbit", opening_view(&planet, SIZE_PX, Quality::Medium)), ("low", near)] {
            let surface = surface_of(&planet, &view);
            let star = LatLon::from_degrees(planet.star.latitude_deg, planet.star.longitude_deg);
            let drawn = gpu.draw(&frame_of(&surface, &planet, view, star.direction()));
            let rgb: Vec<u8> = drawn.chunks(4).flat_map(|p| p[..3].to_vec()).collect();
            let path = folder.join(format!("{}_{name}.png", file.trim_end_matches(".ron")));
            if std::env::var_os("TELLUS_BLESS").is_some() {
                std::fs::create_dir_all(&folder).unwrap();
                RgbImage::from_raw(SIZE_PX[0], SIZE_PX[1], rgb).unwrap().save(&path).unwrap();
                continue;
            }
            let golden = image::open(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).to_rgb8();
            assert_eq!([golden.width(), golden.height()], SIZE_PX);
            let mean =
                rgb.iter().zip(golden.as_raw()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / rgb.len() as f64;
            if mean > 1.5 {
                let seen = std::env::temp_dir().join(path.file_name().unwrap());
                RgbImage::from_raw(SIZE_PX[0], SIZE_PX[1], rgb).unwrap().save(&seen).unwrap();
                problems.push(format!(
                    "{}: differs by {mean:.2} of 255 in the mean; see {}",
                    path.display(),
                    seen.display()
                ));
            }
        }
    }
    assert!(problems.is_empty(), "on {}:\n{}", gpu.adapter, problems.join("\n"));
}
