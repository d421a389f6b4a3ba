//! A region has the same colour from orbit as on the ground: pictures of one place, each four times as fine as the one before.
#![cfg(feature = "editor")]
#![allow(clippy::unwrap_used, clippy::panic, clippy::expect_used)]

mod support;

use glam::DVec3;
use std::sync::Arc;
use support::Gpu;
use tellus::build::{add_detail, build_now};
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Planet, shipped};
use tellus::render::{DebugView, Frame};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;
use tellus::terrain::survey::spread;

/// Pixels along a side of each picture, and how much finer each is than the one before.
const SIDE_PX: usize = 192;
const FINER: usize = 4;
/// How many pictures follow the first: of one place down to the ground, of another as far as mountains are larger than pixels.
const STEPS: [usize; 2] = [6, 3];

/// The albedo of the ground around a place, pixel by pixel.
fn albedo(gpu: &mut Gpu, planet: &Arc<Planet>, terrain: &Terrain, place: LatLon, pixel_m: f64) -> Vec<[f64; 3]> {
    let fov_rad = Camera::DEFAULT_FOV_Y_RAD;
    let altitude_m = pixel_m * SIDE_PX as f64 / (2.0 * (0.5 * fov_rad).tan());
    let eye_radius_m = planet.radius_m() + terrain.height_m(place.direction()) + altitude_m;
    let camera = Camera::over(place, eye_radius_m, 0.0, -std::f64::consts::FRAC_PI_2, fov_rad);
    let view = View { camera, size_px: [SIDE_PX as u32; 2], quality: Quality::Medium };
    let mut surface = build_now(planet, &view);
    add_detail(&mut surface, &view);
    let picture = gpu.draw(&Frame {
        surface: &surface,
        planet,
        view,
        frozen: None,
        sun_dir_planet: camera.position_planet_m,
        time_secs: 0.0,
        exposure_ev: 0.0,
        debug_view: DebugView::Albedo,
    });
    let linear = |byte: u8| {
        let x = f64::from(byte) / 255.0;
        if x <= 0.040_45 { x / 12.92 } else { ((x + 0.055) / 1.055).powf(2.4) }
    };
    picture.chunks(4).map(|p| [linear(p[0]), linear(p[1]), linear(p[2])]).collect()
}

/// The mean over so many pixels in the middle.
fn mean(colors: &[[f64; 3]], side_px: usize) -> [f64; 3] {
    let from = (SIDE_PX - side_px) / 2;
    let inside = (from..from + side_px).flat_map(|y| (from..from + side_px).map(move |x| y * SIDE_PX + x));
    let sum = inside.fold([0.0; 3], |sum, i| std::array::from_fn(|c| sum[c] + colors[i][c]));
    sum.map(|c| c / (side_px * side_px) as f64)
}

#[test]
fn a_region_has_the_same_colour_from_orbit_and_on_the_ground() {
    let mut gpu = Gpu::new();
    let mut problems = Vec::new();
    for preset in shipped::ALL {
        let planet = Arc::new(preset.load().unwrap());
        let terrain = Terrain::new(planet.clone());
        let sea_m = planet.sea_level_m().unwrap_or(f64::MIN);
        // Land all around, for the bed of the sea is not seen from orbit; on small islands the pictures begin nearer.
        let is_land = |dir: DVec3, coarsest_m: f64| {
            let side = dir.any_orthonormal_vector() * (coarsest_m * SIDE_PX as f64 / FINER as f64 / planet.radius_m());
            let other = dir.cross(side);
            let grid =
                (0..25).map(|i| dir + side * (f64::from(i % 5) * 0.25 - 0.5) + other * (f64::from(i / 5) * 0.25 - 0.5));
            terrain.heights_m(&grid.collect::<Vec<_>>()).iter().all(|height_m| *height_m > sea_m + 30.0)
        };
        let place =
            |dir| [4000.0, 1000.0, 250.0].into_iter().find(|from_m| is_land(dir, *from_m)).map(|from_m| (dir, from_m));
        let mut places: Vec<(DVec3, f64)> = spread(60).filter_map(place).collect();
        places.sort_by(|a, b| b.1.total_cmp(&a.1));
        for ((dir, coarsest_m), steps) in places.into_iter().step_by(3).zip(STEPS) {
            let place = LatLon::from_direction(dir);
            let mut coarse = albedo(&mut gpu, &planet, &terrain, place, coarsest_m);
            for step in 1..=steps {
                let pixel_m = coarsest_m / (FINER as f64).powi(step as i32);
                let fine = albedo(&mut gpu, &planet, &terrain, place, pixel_m);
                let (far, near) = (mean(&coarse, SIDE_PX / FINER), mean(&fine, SIDE_PX));
                let light = |color: [f64; 3]| color.iter().sum::<f64>();
                let off = light(near) / light(far) - 1.0;
                println!(
                    "{} {:?} {pixel_m:.2} m: {far:.4?} {near:.4?} {:.2}%",
                    preset.file,
                    place.to_degrees(),
                    100.0 * off
                );
                if off.abs() > 0.03 {
                    problems.push(format!(
                        "{} at {:?}, pixels of {pixel_m:.2} m: {off:.3}",
                        preset.file,
                        place.to_degrees()
                    ));
                }
                coarse = fine;
            }
        }
    }
    assert!(problems.is_empty(), "{problems:#?}");
}
