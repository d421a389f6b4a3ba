//! A region has the same colour from orbit as on the ground: pictures of one place, each four times as fine as the one before.
#![cfg(feature = "editor")]
#![allow(clippy::unwrap_used, clippy::panic, clippy::expect_used)]

mod support;

use glam::DVec3;
use std::sync::Arc;
use support::Gpu;
use tellus::build::{add_detail, build_now};
use tellus::lod::{Camera, Quality, View};
use tellus::planet::shipped;
use tellus::render::{DebugView, Frame};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;
use tellus::terrain::survey::spread;

/// Pixels along a side of each picture, and how much finer each is than the one before.
const SIDE_PX: usize = 192;
const FINER: usize = 4;
/// What a colour may be off between any two pictures of a place, however much finer one is: a share of each channel.
const MOST_OFF: f64 = 0.03;

type Color = [f64; 3];

/// The albedo of the ground around a place, pixel by pixel.
fn albedo(gpu: &mut Gpu, terrain: &Terrain, place: LatLon, pixel_m: f64) -> Vec<Color> {
    let planet = terrain.planet();
    let fov_rad = Camera::DEFAULT_FOV_Y_RAD;
    let altitude_m = pixel_m * SIDE_PX as f64 / (2.0 * (0.5 * fov_rad).tan());
    let eye_radius_m = planet.radius_m() + terrain.height_m(place.direction()) + altitude_m;
    let camera = Camera::over(place, eye_radius_m, 0.0, -std::f64::consts::FRAC_PI_2, fov_rad);
    let view = View { camera, size_px: [SIDE_PX as u32; 2], quality: Quality::Medium };
    let mut surface = build_now(planet, &view);
    add_detail(&mut surface, &view);
    let frame = Frame {
        surface: &surface,
        planet,
        view,
        frozen: None,
        sun_dir_planet: camera.position_planet_m,
        time_secs: 0.0,
        exposure_ev: 0.0,
        debug_view: DebugView::Albedo,
    };
    gpu.draw_only(&frame, 1);
    let (size_px, colors) = gpu.renderer.radiance(&gpu.device, &gpu.queue).unwrap();
    assert_eq!(size_px, view.size_px);
    colors.into_iter().map(|color| color.map(f64::from)).collect()
}

/// The mean over so many pixels in the middle.
fn mean(colors: &[Color], side_px: usize) -> Color {
    let from = (SIDE_PX - side_px) / 2;
    let inside = (from..from + side_px).flat_map(|y| (from..from + side_px).map(move |x| y * SIDE_PX + x));
    let sum = inside.fold([0.0; 3], |sum, i| std::array::from_fn(|c| sum[c] + colors[i][c]));
    sum.map(|c| c / (side_px * side_px) as f64)
}

/// Widest pixels of pictures of a place that show land alone, with their place; the bed of the sea is not seen from orbit.
fn widest_m(terrain: &Terrain, dir: DVec3) -> Option<f64> {
    let planet = terrain.planet();
    let sea_m = planet.sea_level_m().unwrap_or(f64::MIN);
    let is_land = |widest_m: &f64| {
        let side = dir.any_orthonormal_vector() * (widest_m * SIDE_PX as f64 / FINER as f64 / planet.radius_m());
        let other = dir.cross(side);
        let grid =
            (0..25).map(|i| dir + side * (f64::from(i % 5) * 0.25 - 0.5) + other * (f64::from(i / 5) * 0.25 - 0.5));
        terrain.heights_m(&grid.collect::<Vec<_>>()).iter().all(|height_m| *height_m > sea_m + 30.0)
    };
    [8000.0, 4000.0, 2000.0, 1000.0, 500.0, 250.0].into_iter().find(is_land)
}

#[test]
fn a_region_has_the_same_colour_from_orbit_and_on_the_ground() {
    let mut gpu = Gpu::new();
    let mut problems = Vec::new();
    let only = std::env::var("ONLY").unwrap_or_default();
    for preset in shipped::ALL {
        if !preset.file.contains(&only) { continue; }
        let terrain = Terrain::new(Arc::new(preset.load().unwrap()));
        let mut places: Vec<(DVec3, f64)> =
            spread(60).filter_map(|dir| Some((dir, widest_m(&terrain, dir)?))).collect();
        places.sort_by(|a, b| b.1.total_cmp(&a.1));
        // Of one place down to the ground, of another as far as mountains are larger than pixels.
        for ((dir, widest_m), finest_m) in places.into_iter().step_by(3).zip([1.0, 50.0]) {
            let place = LatLon::from_direction(dir);
            let mut coarse = albedo(&mut gpu, &terrain, place, widest_m);
            // How much brighter than in the first picture; the least and the most of it so far.
            let mut brighter: Color = [1.0; 3];
            let mut reached = [[1.0_f64; 3]; 2];
            let mut pixel_m = widest_m;
            while pixel_m > finest_m {
                pixel_m /= FINER as f64;
                let fine = albedo(&mut gpu, &terrain, place, pixel_m);
                let (far, near) = (mean(&coarse, SIDE_PX / FINER), mean(&fine, SIDE_PX));
                brighter = std::array::from_fn(|c| brighter[c] * near[c] / far[c]);
                reached = [
                    std::array::from_fn(|c| reached[0][c].min(brighter[c])),
                    std::array::from_fn(|c| reached[1][c].max(brighter[c])),
                ];
                println!("{} {:?} {pixel_m:.2} m: {far:.4?} {near:.4?}, of the first {brighter:.3?}", preset.file, place.to_degrees());
                coarse = fine;
            }
            let off = (0..3).map(|c| reached[1][c] / reached[0][c] - 1.0).fold(0.0, f64::max);
            println!("{} {:?} from {widest_m} m: {:.2}%", preset.file, place.to_degrees(), 100.0 * off);
            if off > MOST_OFF {
                problems.push(format!("{} at {:?}: {off:.3}", preset.file, place.to_degrees()));
            }
        }
    }
    assert!(problems.is_empty(), "{problems:#?}");
}
