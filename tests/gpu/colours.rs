//! A region has the same mean colour from orbit as on the ground: pictures of one location, each with pixels four times
//! smaller.

use crate::support::{Gpu, LAYERED, debug, files, frame_of, gpu, preset, surface_of, terrain};
use glam::DVec3;
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::render::DebugView;
use tellus::sphere::LatLon;
use tellus::sphere::spread;
use tellus::terrain::Terrain;

/// Side of each picture in pixels, and the factor by which pixels shrink from one picture to the next.
const SIDE_PX: usize = 384;
const FINER: usize = 4;
/// A narrow field of view: from close up, mountains would lean out of the picture and change its region.
const FOV_DEG: f64 = 5.0;
/// Largest relative difference of a channel between the picture from orbit and any finer one.
const MOST_OFF: f64 = 0.035;
/// The same with a structure: each level of rivers makes slopes steeper than the coarser ones show, and snow leaves
/// them. To be brought down.
const MOST_OFF_AMONG_RIVERS: f64 = 0.17;
/// Snowy mountains with green valleys: the greatest variation within a pixel.
const SNOWY: (&str, f64, f64) = (LAYERED, -30.0, 20.0);

type Color = [f64; 3];

/// The albedo of the ground around a location, by pixel.
fn albedo(gpu: &mut Gpu, terrain: &Terrain, place: LatLon, pixel_m: f64) -> Vec<Color> {
    let planet = terrain.planet();
    let fov_rad = FOV_DEG.to_radians();
    let altitude_m = pixel_m * SIDE_PX as f64 / (2.0 * (0.5 * fov_rad).tan());
    let eye_radius_m = planet.radius_m() + terrain.height_m(place.direction()) + altitude_m;
    let camera = Camera::over(place, eye_radius_m, 0.0, -std::f64::consts::FRAC_PI_2, fov_rad);
    let view = View { camera, size_px: [SIDE_PX as u32; 2], quality: Quality::Medium };
    let surface = surface_of(planet, &view);
    let plain = frame_of(&surface, planet, view, camera.position_planet_m);
    let frame = debug(plain, DebugView::Albedo);
    gpu.draw_only(&frame, 1);
    let (size_px, colors) = gpu.renderer.radiance().unwrap();
    assert_eq!(size_px, [SIDE_PX as u32; 2]);
    colors.into_iter().map(|color| color.map(f64::from)).collect()
}

/// The mean over a centred square of pixels.
fn mean(colors: &[Color], side_px: usize) -> Color {
    let from = (SIDE_PX - side_px) / 2;
    let inside = (from..from + side_px).flat_map(|y| (from..from + side_px).map(move |x| y * SIDE_PX + x));
    let sum = inside.fold([0.0; 3], |sum, i| std::array::from_fn(|c| sum[c] + colors[i][c]));
    sum.map(|c| c / (side_px * side_px) as f64)
}

/// The widest pixels whose pictures of a location show only land. The sea bed is not visible from orbit.
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
    look_at_regions(&[LAYERED], &[200.0]);
}

#[test]
#[ignore = "long: minutes"]
fn regions_of_all_planets_have_the_same_colours_from_orbit_and_on_the_ground() {
    look_at_regions(&files(), &[1.0, 200.0]);
}

/// `finest_m`: size of the last pixels on the ground, for one location each.
fn look_at_regions(presets: &[&str], finest_m: &[f64]) {
    let mut gpu = gpu();
    let mut problems = Vec::new();
    for &name in presets {
        let terrain = terrain(&Arc::new(preset(name)));
        let mut places: Vec<(DVec3, f64)> =
            spread(60).filter_map(|dir| Some((dir, widest_m(&terrain, dir)?))).collect();
        places.sort_by(|a, b| b.1.total_cmp(&a.1));
        // One location down to the ground, the others as long as mountains are larger than pixels.
        let mut ways: Vec<_> = places.into_iter().step_by(3).zip(finest_m.iter().copied()).collect();
        let (file, lat_deg, lon_deg) = SNOWY;
        if name == file {
            let dir = LatLon::from_degrees(lat_deg, lon_deg).direction();
            ways.push(((dir, widest_m(&terrain, dir).expect("land")), 20.0));
        }
        for ((dir, widest_m), finest_m) in ways {
            let place = LatLon::from_direction(dir);
            let mut coarse = albedo(&mut gpu, &terrain, place, widest_m);
            // Brightness relative to the first picture, and its difference from 1.
            let (mut brighter, mut off): (Color, f64) = ([1.0; 3], 0.0);
            let mut pixel_m = widest_m;
            while pixel_m > finest_m {
                pixel_m /= FINER as f64;
                let fine = albedo(&mut gpu, &terrain, place, pixel_m);
                let (far, near) = (mean(&coarse, SIDE_PX / FINER), mean(&fine, SIDE_PX));
                brighter = std::array::from_fn(|c| brighter[c] * near[c] / far[c]);
                off = brighter.iter().fold(off, |off, brighter| off.max((brighter - 1.0).abs()));
                println!("{name} {pixel_m:.2} m: {far:.4?} {near:.4?}, of the first {brighter:.3?}");
                coarse = fine;
            }
            let told = format!(
                "{} at {:.1?}, pixels from {widest_m} m to {pixel_m:.1} m: {:.2}%",
                name,
                place.to_degrees(),
                100.0 * off
            );
            println!("{told}");
            let most = if terrain.planet().structure.is_some() { MOST_OFF_AMONG_RIVERS } else { MOST_OFF };
            if off > most {
                problems.push(told);
            }
        }
    }
    assert!(problems.is_empty(), "{problems:#?}");
}
