//! Antialiased edges (limb, ridge, shore, glint) against a reference: the same picture drawn four times as wide and
//! high, and averaged. Compares the errors with and without antialiasing, in still and in moving pictures.

use crate::support::{Gpu, camera, earth, frame_of, gpu};
use glam::DQuat;
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Fbm, Layer, Planet, Shape};
use tellus::render::Scene;
use tellus::sphere::LatLon;
use tellus::tiles::{Surface, add_detail, build_now};

/// Sizes of still pictures, and of moving ones, which are many.
const STILL_PX: [u32; 2] = [96, 60];
const MOVING_PX: [u32; 2] = [56, 36];
/// Scale of the reference along each side.
const FINER: u32 = 4;

struct Case {
    name: &'static str,
    planet: Arc<Planet>,
    camera: Camera,
    sun: (f64, f64),
}

/// A sun so bright that exposure hides the night stars, which would count as edges. It is brighter than a preset
/// allows.
const STAR_BRIGHTNESS: f64 = 256.0;

fn scenes() -> Vec<Case> {
    let mut smooth = earth();
    smooth.clouds = None;
    let mut wet = smooth.clone();
    smooth.water = None;
    let mut rough = smooth.clone();
    let mut bare = smooth;
    bare.layers.clear();
    let airy = Arc::new(bare.clone());
    bare.atmosphere = None;
    let layer = |name: &str, wavelength_km, octaves, amplitude_m| Layer {
        name: name.to_owned(),
        amplitude_m,
        shape: Shape::Fbm(Fbm { wavelength_km, octaves, ..Fbm::default() }),
        ..Layer::default()
    };
    rough.layers = vec![layer("Peaks", 12.0, 8, 2500.0)];
    wet.layers = vec![layer("Islands", 12.0, 3, 400.0)];
    let [bare, rough, wet] = [bare, rough, wet].map(Arc::new);
    let radius_m = bare.radius_m();
    let scene = |name, planet: &Arc<Planet>, (lat, lon, altitude_m, heading, pitch), sun| Case {
        name,
        planet: planet.clone(),
        camera: camera(planet, lat, lon, altitude_m, heading, pitch),
        sun,
    };
    vec![
        scene("limb from 400 km", &bare, (5.0, 10.0, 400e3, 90.0, -18.0), (5.0, 60.0)),
        scene("limb from orbit", &bare, (5.0, 10.0, 1.9 * radius_m, 0.0, -88.0), (5.0, 40.0)),
        scene("limb in air", &airy, (5.0, 10.0, 1.9 * radius_m, 0.0, -88.0), (5.0, 40.0)),
        scene("ridge", &rough, (5.0, 10.0, 300.0, 70.0, 4.0), (5.0, 60.0)),
        scene("shore", &wet, (12.0, 30.0, 9e3, 120.0, -35.0), (-5.0, 60.0)),
        scene("glint", &wet, (12.0, 30.0, 30e3, 90.0, -35.0), (12.0, 80.0)),
    ]
}

/// Display codes of a picture, 0 to 255.
struct Picture {
    values: Vec<f64>,
}

/// From display codes to linear light, 0 to 1, and back.
fn decoded(value: f64) -> f64 {
    let c = value / 255.0;
    if c <= 0.04045 { c / 12.92 } else { ((c + 0.055) / 1.055).powf(2.4) }
}

fn encoded(light: f64) -> f64 {
    255.0 * if light <= 0.003_130_8 { light * 12.92 } else { 1.055 * light.powf(1.0 / 2.4) - 0.055 }
}

fn luma(pixel: &[u8]) -> f64 {
    let [r, g, b] = [0, 1, 2].map(|k| decoded(f64::from(pixel[k])));
    0.2126 * r + 0.7152 * g + 0.0722 * b
}

fn frame<'a>(
    scene: &'a Case,
    surface: &'a Surface,
    camera: Camera,
    chosen: View,
    finer: u32,
    quality: Quality,
) -> Scene<'a> {
    let view = View { camera, size_px: chosen.size_px.map(|side| side * finer), quality };
    let sun_dir_planet = LatLon::from_degrees(scene.sun.0, scene.sun.1).direction();
    let mut drawn = frame_of(surface, &scene.planet, view, sun_dir_planet);
    drawn.suns[0].brightness *= STAR_BRIGHTNESS;
    drawn.post.exposure_ev = -STAR_BRIGHTNESS.log2();
    drawn.bodies[0].frozen = Some(chosen);
    drawn
}

fn drawn(gpu: &mut Gpu, frame: &Scene<'_>, smooth_edges: bool) -> Picture {
    gpu.post.smooth_edges = smooth_edges;
    let values = gpu.draw(frame).chunks(4).map(|p| encoded(luma(p))).collect();
    Picture { values }
}

/// The reference: the mean of many samples for each pixel, and the range of those samples.
fn reference(gpu: &mut Gpu, frame: &Scene<'_>) -> (Picture, Vec<f64>) {
    gpu.post.smooth_edges = false;
    let fine = gpu.draw(frame);
    let (finer, wide) = (FINER as usize, frame.size_px[0] as usize);
    let [width, height] = frame.size_px.map(|side| (side / FINER) as usize);
    let (mut values, mut ranges) = (Vec::new(), Vec::new());
    for y in 0..height {
        for x in 0..width {
            let all = (0..finer * finer).map(|i| {
                let at = (y * finer + i / finer) * wide + x * finer + i % finer;
                luma(&fine[at * 4..at * 4 + 4])
            });
            let (mut sum, mut least, mut most) = (0.0, f64::MAX, f64::MIN);
            for light in all {
                sum += light;
                least = least.min(encoded(light));
                most = most.max(encoded(light));
            }
            values.push(encoded(sum / (finer * finer) as f64));
            ranges.push(most - least);
        }
    }
    (Picture { values }, ranges)
}

fn mean_and_p95(mut all: Vec<f64>) -> (f64, f64) {
    all.sort_by(f64::total_cmp);
    let mean = all.iter().sum::<f64>() / all.len().max(1) as f64;
    (mean, all.get(all.len() * 95 / 100).copied().unwrap_or(0.0))
}

fn surface(scene: &Case, size_px: [u32; 2]) -> (Surface, View) {
    let view = View { camera: scene.camera, size_px, quality: Quality::Medium };
    let mut surface = build_now(&scene.planet, &view).unwrap();
    add_detail(&mut surface, &view);
    (surface, view)
}

/// The best that a picture of half the size can show.
fn halved_and_enlarged(picture: &Picture) -> Picture {
    let [width, height] = STILL_PX.map(|side| side as usize);
    let light = |x: usize, y: usize| decoded(picture.values[y * width + x]);
    let half = |x: usize, y: usize| {
        let (x, y) = (2 * x.min(width / 2 - 1), 2 * y.min(height / 2 - 1));
        (light(x, y) + light(x + 1, y) + light(x, y + 1) + light(x + 1, y + 1)) / 4.0
    };
    let values = (0..width * height).map(|i| {
        // Three quarters of the nearest pixel, one quarter of the next.
        let near_and_next = |i: usize| (i / 2, if i.is_multiple_of(2) { (i / 2).saturating_sub(1) } else { i / 2 + 1 });
        let ((x0, x1), (y0, y1)) = (near_and_next(i % width), near_and_next(i / width));
        let row = |y| 0.75 * half(x0, y) + 0.25 * half(x1, y);
        encoded(0.75 * row(y0) + 0.25 * row(y1))
    });
    Picture { values: values.collect() }
}

/// Mean and 95th percentile of the error over the chosen pixels.
fn errors(picture: &Picture, truth: &Picture, chosen: &dyn Fn(usize) -> bool) -> (f64, f64) {
    let pixels = (0..truth.values.len()).filter(|i| chosen(*i));
    mean_and_p95(pixels.map(|i| (picture.values[i] - truth.values[i]).abs()).collect())
}

/// Range of samples within a pixel, of 255: above the first it is an edge, below the second it is not.
const EDGE: f64 = 40.0;
const PLAIN: f64 = 25.0;

/// Largest error of antialiased edges relative to aliased ones at low, medium and high quality, and of 255 at medium.
/// Shores and a distant limb in air are smooth without antialiasing; the pass has nothing to add there.
fn bars(name: &str) -> ([f64; 3], f64) {
    match name {
        "limb from 400 km" => ([0.9, 0.4, 0.6], 12.0),
        "limb from orbit" => ([0.96, 0.55, 0.85], 15.0),
        "limb in air" => ([1.3, 1.6, 1.6], 11.0),
        "ridge" => ([0.95, 0.75, 0.92], 14.0),
        "shore" => ([1.1, 1.1, 1.3], 16.5),
        _ => ([1.1, 1.1, 1.3], 9.5),
    }
}

#[test]
fn standing_edges_are_smooth() {
    look_at_edges(scenes().into_iter().step_by(3));
}

#[test]
#[ignore = "long: minutes"]
fn all_standing_edges_are_smooth() {
    look_at_edges(scenes().into_iter());
}

fn look_at_edges(scenes: impl Iterator<Item = Case>) {
    let mut gpu = gpu();
    let mut problems = Vec::new();
    for scene in scenes {
        let (surface, chosen) = surface(&scene, STILL_PX);
        let draw = |finer, quality| frame(&scene, &surface, scene.camera, chosen, finer, quality);
        let (truth, ranges) = reference(&mut gpu, &draw(FINER, Quality::Medium));
        let truth_at_low = halved_and_enlarged(&truth);
        let edge = |i: usize| ranges[i] > EDGE;
        let plain = |i: usize| ranges[i] < PLAIN;
        let count = (0..ranges.len()).filter(|i| edge(*i)).count();
        assert!(count > 25, "{}: {count} edge pixels", scene.name);
        let (shares, most) = bars(scene.name);
        for (quality, share) in [Quality::Low, Quality::Medium, Quality::High].into_iter().zip(shares) {
            let truth = if quality == Quality::Low { &truth_at_low } else { &truth };
            let with = drawn(&mut gpu, &draw(1, quality), true);
            let without = drawn(&mut gpu, &draw(1, quality), false);
            let (before, after) = (errors(&without, truth, &edge), errors(&with, truth, &edge));
            let (ground_before, ground) = (errors(&without, truth, &plain).0, errors(&with, truth, &plain).0);
            let told = format!(
                "{}, {quality:?}: {count} edge pixels off by {:.1} (95 in 100: {:.1}), stairs by {:.1} ({:.1}); elsewhere {ground:.2}, {ground_before:.2}",
                scene.name, after.0, after.1, before.0, before.1
            );
            println!("{told}");
            if (quality == Quality::Medium && after.0 > most)
                || after.0 > share * before.0
                || ground > 1.1 * ground_before + 0.15
            {
                problems.push(told);
            }
        }
    }
    assert!(problems.is_empty(), "on {}:\n{}", gpu.adapter, problems.join("\n"));
}

/// Scenes, and the largest jump (95th percentile) of their edges at medium quality, relative to aliased edges and of
/// 255.
const MOVING: [(&str, f64, f64); 4] =
    [("limb from 400 km", 0.55, 40.0), ("limb in air", 1.13, 30.0), ("ridge", 0.6, 40.0), ("glint", 1.1, 10.0)];

#[test]
fn a_moving_ridge_does_not_crawl() {
    move_edges(&MOVING[2..3], 7);
}

#[test]
#[ignore = "long: minutes"]
fn moving_edges_do_not_crawl() {
    move_edges(&MOVING, 16);
}

fn move_edges(scenes_and_bars: &[(&str, f64, f64)], steps: u32) {
    let mut gpu = gpu();
    let mut problems = Vec::new();
    for &(name, share, most) in scenes_and_bars {
        let scene = scenes().into_iter().find(|scene| scene.name == name).unwrap();
        let (surface, chosen) = surface(&scene, MOVING_PX);
        let mut last: Option<[Picture; 5]> = None;
        let mut jumps = [(); 4].map(|()| Vec::new());
        for step in 0..steps {
            // An eighth of a pixel to the right, and down.
            let turn = f64::from(step) * chosen.pixel_rad() / 8.0;
            let mut camera = scene.camera;
            camera.planet_from_view *= DQuat::from_rotation_y(-turn) * DQuat::from_rotation_x(-0.7 * turn);
            let draw = |finer, quality| frame(&scene, &surface, camera, chosen, finer, quality);
            let (truth, ranges) = reference(&mut gpu, &draw(FINER, Quality::Medium));
            let here = [
                drawn(&mut gpu, &draw(1, Quality::Low), false),
                drawn(&mut gpu, &draw(1, Quality::Low), true),
                drawn(&mut gpu, &draw(1, Quality::Medium), false),
                drawn(&mut gpu, &draw(1, Quality::Medium), true),
                truth,
            ];
            if let Some(last) = &last {
                for i in (0..ranges.len()).filter(|i| ranges[*i] > EDGE) {
                    let change = |k: usize| here[k].values[i] - last[k].values[i];
                    (0..4).for_each(|k| jumps[k].push((change(k) - change(4)).abs()));
                }
            }
            last = Some(here);
        }
        let [low_before, low, before, medium] = jumps.map(mean_and_p95);
        let told = format!(
            "{}: edge pixels change from frame to frame otherwise than they should by (mean, 95 in 100) low {low:.1?}, medium {medium:.1?}; \
             stairs by {low_before:.1?}, {before:.1?}",
            scene.name
        );
        println!("{told}");
        if low.1 > low_before.1 || medium.1 > (share * before.1).min(most) || medium.0 > 1.08 * before.0 {
            problems.push(told);
        }
    }
    assert!(problems.is_empty(), "on {}:\n{}", gpu.adapter, problems.join("\n"));
}
