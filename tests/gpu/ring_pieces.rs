//! Rings near the eye: their pieces dim and scatter light in the mean as the plane layer of the reference does, and go
//! over into it with distance without a step.

use crate::support::{frame_of, gpu, rays, surface_of};
use glam::{DQuat, DVec3};
use std::f64::consts::{FRAC_PI_2, PI, TAU};
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Planet, Rings};
use tellus::render::{Body, BodyId, Scene};
use tellus::rings::Profile;
use tellus::sphere::LatLon;
use tellus::tiles::{Surface, build_now};

const SIZE_PX: [u32; 2] = [128, 72];
/// Thickness of the rings.
const THICKNESS_M: f64 = 30.0;
/// Heights of the eye over the plane, from within the slab to beyond the reach of the largest pieces.
const HEIGHTS_M: [f64; 6] = [10.0, 40.0, 120.0, 300.0, 600.0, 1500.0];

/// A ball with rings of one optical depth and colour.
fn ringed(depth: f64, dust: f64, color: f64) -> Arc<Planet> {
    Arc::new(Planet {
        radius_km: 6000.0,
        rings: Some(Rings {
            ringlets: 0.0,
            gaps: 0,
            dust,
            optical_depth: depth,
            thickness_m: THICKNESS_M,
            largest_m: 4.0,
            profile: vec![[0.0, 1.0], [1.0, 1.0]],
            inner_color: [color; 3],
            outer_color: [color; 3],
            ..Rings::default()
        }),
        ..Planet::default()
    })
}

/// An eye above the rings that looks down at them at an angle to their plane.
fn camera(planet: &Planet, height_m: f64, lon_rad: f64, down_rad: f64) -> Camera {
    let radius_m = (planet.radius_m() * 1.8).hypot(height_m);
    let place = LatLon { lat_rad: (height_m / radius_m).asin(), lon_rad };
    Camera::over(place, radius_m, FRAC_PI_2 + down_rad, 0.0, 0.5)
}

fn scene<'a>(surface: &'a Surface, planet: &Arc<Planet>, camera: Camera, sun_dir: DVec3) -> Scene<'a> {
    frame_of(surface, planet, View { camera, size_px: SIZE_PX, quality: Quality::Medium }, sun_dir)
}

fn mean(values: impl ExactSizeIterator<Item = f64>) -> f64 {
    let count = values.len() as f64;
    values.sum::<f64>() / count
}

#[test]
fn pieces_let_as_much_light_through_as_the_layer() {
    let mut gpu = gpu();
    let ball = Arc::new(Planet { radius_km: 15_000.0, ..Planet::default() });
    for (depth, down_rad) in [(0.2, 0.6), (0.8, 1.2), (1.5, 0.6), (0.3, 0.32)] {
        let planet = ringed(depth, 0.1, 0.0);
        for height_m in HEIGHTS_M {
            let (mut found, mut expected) = (0.0, 0.0);
            // Few large pieces are in a picture from near: the mean of several.
            let places = if height_m < 200.0 { 8 } else { 2 };
            for place in 0..places {
                let camera = camera(&planet, height_m, TAU * f64::from(place) / 7.3, down_rad);
                let ahead = camera.ray_dir_planet(0.0, 0.0, 1.0);
                let surface = surface_of(&planet, &View { camera, size_px: SIZE_PX, quality: Quality::Medium });
                // A white ball behind the rings, lit from the side of the eye.
                let mut with = scene(&surface, &planet, camera, -ahead);
                let behind = build_now(&ball, &with.view_of(ahead * 3e7, DQuat::IDENTITY)).unwrap();
                with.bodies.push(Body::new(BodyId(7), &behind, ahead * 3e7));
                let bare = Arc::new(Planet { rings: None, ..(*planet).clone() });
                let bare_surface = surface_of(&bare, &View { camera, size_px: SIZE_PX, quality: Quality::Medium });
                let mut without = scene(&bare_surface, &bare, camera, -ahead);
                without.bodies.push(Body::new(BodyId(7), &behind, ahead * 3e7));
                let (with_light, without_light) = (gpu.radiance(&with), gpu.radiance(&without));
                let share = |(a, b): (&[f32; 3], &[f32; 3])| f64::from(a[1] / b[1].max(1e-6));
                found += mean(with_light.iter().zip(&without_light).map(share)) / f64::from(places);
                // From within, a part of the layer is behind the eye; a ray that rises meets only what is above it.
                let through = |dir: DVec3| {
                    let ahead_share = (0.5 - dir.z.signum() * height_m / THICKNESS_M).clamp(0.0, 1.0);
                    libm::exp(-depth * ahead_share / dir.z.abs())
                };
                expected += mean(rays(&with).into_iter().map(through)) / f64::from(places);
            }
            println!("depth {depth}, {down_rad} rad, {height_m} m: {found:.4} of {expected:.4}");
            assert!((found - expected).abs() < 0.05 * expected + 0.012, "{found} of {expected} from {height_m} m");
        }
    }
}

#[test]
fn pieces_are_as_bright_as_the_layer_at_any_distance() {
    let mut gpu = gpu();
    for (depth, dust, sun_dir) in [
        (0.3, 0.0, DVec3::new(0.5, -0.4, 0.6)),
        (1.2, 0.2, DVec3::new(0.3, 0.5, 0.5)),
        (0.6, 0.1, DVec3::new(0.3, -0.5, -0.6)),
    ] {
        let (planet, sun_dir) = (ringed(depth, dust, 0.5), sun_dir.normalize());
        let profile = Profile::new(&planet).unwrap();
        let mut before: Option<f64> = None;
        // From within, the layer has no reference.
        for height_m in &HEIGHTS_M[1..] {
            let (mut found, mut expected) = (0.0, 0.0);
            let places = if *height_m < 200.0 { 10 } else { 3 };
            for place in 0..places {
                let camera = camera(&planet, *height_m, 0.3 * f64::from(place) / 10.0, 0.9);
                let surface = surface_of(&planet, &View { camera, size_px: SIZE_PX, quality: Quality::Medium });
                let scene = scene(&surface, &planet, camera, sun_dir);
                let drawn = gpu.radiance(&scene);
                found += mean(drawn.iter().map(|light| f64::from(light[1]))) / f64::from(places);
                let light = |dir: DVec3| {
                    let at = profile.at(planet.radius_m() * 1.8, 1.0);
                    let is_lit = sun_dir.z > 0.0;
                    profile.radiance(at, dir.z.abs(), sun_dir.z.abs(), is_lit, dir.dot(sun_dir))[1]
                };
                expected += mean(rays(&scene).into_iter().map(light)) * PI * planet.star.color[1] / f64::from(places);
            }
            let ratio = found / expected;
            println!("depth {depth}, dust {dust}, {height_m} m: {found:.4} of {expected:.4}, ratio {ratio:.3}");
            assert!((ratio - 1.0).abs() < 0.08, "{ratio} from {height_m} m");
            assert!(before.is_none_or(|before| (ratio - before).abs() < 0.08), "a step of brightness at {height_m} m");
            before = Some(ratio);
        }
    }
}
