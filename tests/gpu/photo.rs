//! Photographs: tiles, samples, the lens, radiance.

use crate::support::{camera, earth, frame_of, gpu, surface_of};
use std::sync::Arc;
use tellus::lod::{Quality, View};
use tellus::planet::Planet;
use tellus::render::{Develop, Lens, Metered, Metering, Photo, Scene, Tone};
use tellus::sphere::LatLon;

fn luminance(pixel: &[f32; 3]) -> f64 {
    f64::from(0.2126 * pixel[0] + 0.7152 * pixel[1] + 0.0722 * pixel[2])
}

/// Mean difference of neighbours along rows: how sharp a picture is.
fn sharpness(pixels: &[[f32; 3]], width: usize) -> f64 {
    let steps = pixels.chunks(width).flat_map(|row| row.windows(2));
    let all: Vec<f64> = steps.map(|pair| (luminance(&pair[0]) - luminance(&pair[1])).abs()).collect();
    all.iter().sum::<f64>() / all.len() as f64
}

/// The earth without clouds, from 300 km, with an exposure that no tile can change; each pixel by itself.
fn wide(draw: impl FnOnce(Scene<'_>)) {
    of(&Arc::new(Planet { clouds: None, ..earth() }), [2200, 40], 3e5, |mut scene| {
        scene.post.smooth_edges = false;
        scene.post.metering = Metering::Fixed(Metered { ev: -1.0, beyond_ev: 1.0, fill_ev: 0.0 });
        draw(scene);
    });
}

fn of(planet: &Arc<Planet>, size_px: [u32; 2], altitude_m: f64, draw: impl FnOnce(Scene<'_>)) {
    let view = View { camera: camera(planet, 10.0, 10.0, altitude_m, 40.0, -90.0), size_px, quality: Quality::Medium };
    let surface = surface_of(planet, &view);
    let mut scene = frame_of(&surface, planet, view, LatLon::from_degrees(30.0, 40.0).direction());
    scene.post.metering = Metering::Instant;
    draw(scene);
}

/// Tiles join without a seam: each has the exposure, the ground and the footprints of the whole picture.
#[test]
fn a_picture_in_tiles_is_the_picture() {
    let mut gpu = gpu();
    wide(|scene| {
        let tiled = Photo::default().take(&mut gpu.renderer, &scene, &mut |_| true).unwrap().unwrap();
        assert_eq!(tiled.len(), 2200 * 40);
        // A picture of the left half is one tile.
        let [left, right, bottom, top] = scene.projection.tangents;
        let mut half = scene.clone();
        half.bodies[0].frozen = Some(scene.view_of(scene.bodies[0].position_m, scene.bodies[0].scene_from_body));
        half.projection.tangents = [left, 0.5 * (left + right), bottom, top];
        half.size_px = [1100, 40];
        let whole = Photo::default().take(&mut gpu.renderer, &half, &mut |_| true).unwrap().unwrap();
        let same = tiled.chunks(2200).flat_map(|row| &row[..1100]).zip(&whole);
        let apart = same.map(|(a, b)| (luminance(a) - luminance(b)).abs()).sum::<f64>() / whole.len() as f64;
        assert!(apart < 1e-3, "{apart}");
        // Along the border of two tiles the picture is as smooth as elsewhere.
        let step_at = |x: usize| {
            tiled.chunks(2200).map(|row| (luminance(&row[x]) - luminance(&row[x + 1])).abs()).sum::<f64>() / 40.0
        };
        let usual = (900..1300).filter(|x| *x != 1023).map(step_at).sum::<f64>() / 399.0;
        assert!(step_at(1023) < 3.0 * usual, "{} at the border, {usual} elsewhere", step_at(1023));
        assert!(usual > 1e-4);
    });
}

/// The corners of the whole picture are darker, not those of its tiles; a camera set to lamps shows a bluer planet.
#[test]
fn vignette_and_white_balance_are_of_the_whole_picture() {
    let mut gpu = gpu();
    wide(|mut scene| {
        scene.post.tone = Tone::Plain;
        let mut take = |scene: &Scene<'_>| {
            let pixels = Photo::default().take(&mut gpu.renderer, scene, &mut |_| true).unwrap().unwrap();
            let row = &pixels[20 * 2200..21 * 2200];
            let mean =
                |x: usize| row[x..x + 20].iter().fold([0.0; 3], |sum, pixel| [0, 1, 2].map(|k| sum[k] + pixel[k]));
            (0..2180).step_by(20).map(mean).collect::<Vec<_>>()
        };
        let plain = take(&scene);
        scene.post.vignette = 1.0;
        let dark = take(&scene);
        let kept: Vec<f64> = dark.iter().zip(&plain).map(|(a, b)| luminance(a) / luminance(b)).collect();
        assert!((0.22..0.3).contains(&kept[0]) && kept[54] > 0.97, "{} {}", kept[0], kept[54]);
        assert!(kept[..54].windows(2).all(|pair| pair[1] > pair[0] - 0.02 && pair[1] < pair[0] + 0.08), "{kept:?}");
        scene.post.vignette = 0.0;
        scene.post.white_k = 3200.0;
        let blue = take(&scene);
        let blueness = |pixels: &[[f32; 3]]| {
            let sum = |band: usize| pixels.iter().map(|pixel| pixel[band]).sum::<f32>();
            sum(2) / sum(0)
        };
        assert!(blueness(&blue) > 1.2 * blueness(&plain), "{} {}", blueness(&blue), blueness(&plain));
    });
}

/// A lens leaves what is in focus as it is and blurs the rest.
#[test]
fn the_plane_in_focus_is_sharp() {
    let planet = Arc::new(Planet { clouds: None, water: None, ..earth() });
    let mut gpu = gpu();
    of(&planet, [96, 54], 3e5, |scene| {
        let mut take = |lens: Option<Lens>| {
            let mut photo = Photo::default();
            (photo.samples, photo.lens) = (4, lens);
            photo.take(&mut gpu.renderer, &scene, &mut |_| true).unwrap().unwrap()
        };
        let plain = sharpness(&take(None), 96);
        let focused = sharpness(&take(Some(Lens { diameter_m: 40e3, focus_m: 3e5 })), 96);
        let blurred = sharpness(&take(Some(Lens { diameter_m: 40e3, focus_m: 1e5 })), 96);
        assert!(focused > 0.8 * plain, "{plain} without a lens, {focused} in focus");
        assert!(blurred < 0.6 * plain, "{plain} without a lens, {blurred} out of focus");
    });
}

/// Many samples converge; radiance is not cut off at white; a person may cancel.
#[test]
fn samples_radiance_and_cancel() {
    let planet = Arc::new(Planet { clouds: None, ..earth() });
    let mut gpu = gpu();
    of(&planet, [96, 54], 3e4, |scene| {
        let mut take = |samples: u32, develop: Develop, most: f64| {
            let mut photo = Photo::default();
            (photo.samples, photo.develop) = (samples, develop);
            photo.take(&mut gpu.renderer, &scene, &mut |done| done <= most).unwrap()
        };
        let apart = |a: &[[f32; 3]], b: &[[f32; 3]]| {
            let off = a.iter().zip(b).map(|(a, b)| (luminance(a) - luminance(b)).abs());
            off.sum::<f64>() / a.len() as f64
        };
        let [one, three, five] = [1, 3, 5].map(|samples| take(samples, Develop::Shown, 1.0).unwrap());
        assert!(apart(&three, &five) < 0.5 * apart(&one, &five).max(1e-4));
        let radiance = take(2, Develop::Radiance, 1.0).unwrap();
        assert!(radiance.iter().flatten().all(|value| value.is_finite() && *value >= 0.0));
        assert!(radiance.iter().zip(&three).any(|(a, b)| (a[1] - b[1]).abs() > 0.02));
        assert!(take(4, Develop::Shown, 0.4).is_none());
    });
}
