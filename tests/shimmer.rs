//! No shimmer at a distance: what changes from frame to frame of a slow flight is what changes in pictures with sixteen samples a pixel.
#![cfg(feature = "editor")]
#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic, clippy::print_stdout)]

mod support;

use std::sync::Arc;
use support::Gpu;
use tellus::build::{add_detail, build_now};
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Planet, shipped};
use tellus::render::{DebugView, Frame};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;

const SIZE_PX: [u32; 2] = [192, 128];
const FINER: u32 = 4;

/// Brightness of each pixel, 0 to 255, of a picture drawn so many times as large and averaged.
fn picture(gpu: &mut Gpu, planet: &Arc<Planet>, camera: Camera, sun: LatLon, times: u32) -> Vec<[f32; 3]> {
    let size_px = SIZE_PX.map(|side| side * times);
    let view = View { camera, size_px, quality: Quality::Medium };
    let mut surface = build_now(planet, &view);
    add_detail(&mut surface, &view);
    let pixels = gpu.draw(&Frame {
        surface: &surface,
        planet,
        view,
        frozen: None,
        sun_dir_planet: sun.direction(),
        time_secs: 0.0,
        exposure_ev: 0.0,
        debug_view: DebugView::Shaded,
    });
    let [w, h] = SIZE_PX.map(|side| side as usize);
    let n = times as usize;
    (0..w * h)
        .map(|i| {
            let (x, y) = (i % w, i / w);
            let mut sum = [0.0; 3];
            for (dx, dy) in (0..n * n).map(|j| (j % n, j / n)) {
                let at = ((y * n + dy) * w * n + x * n + dx) * 4;
                for c in 0..3 { sum[c] += f32::from(pixels[at + c]); }
            }
            sum.map(|s| s / (n * n) as f32)
        })
        .collect()
}

#[test]
fn explore() {
    let mut gpu = Gpu::new();
    let only = std::env::var("ONLY").unwrap_or_default();
    let out = std::env::var("PIX").unwrap_or("/tmp/pix-shim".into());
    std::fs::create_dir_all(&out).unwrap();
    for (file, lat, lon, altitude_m, pitch) in [
        ("aurel.ron", 16.0, -8.0, 4.0e6, -90.0_f64),
        ("aurel.ron", 16.0, -8.0, 3.0e5, -40.0),
        ("aurel.ron", 16.0, -8.0, 1.0e4, -25.0),
        ("hoarfrost.ron", 30.0, 20.0, 1.0e4, -30.0),
        ("hoarfrost.ron", 30.0, 20.0, 1.0e5, -50.0),
        ("cinnabar.ron", 10.0, 30.0, 1.0e5, -40.0),
        ("maren.ron", 41.0, -65.0, 1.0e4, -30.0),
        ("pallor.ron", 20.0, 0.0, 1.0e4, -30.0),
        ("aurel.ron", 16.0, -8.0, 100.0, -15.0),
        ("aurel.ron", 16.0, -8.0, 2.0, -10.0),
    ] {
        let name = format!("{}-{altitude_m}", file.trim_end_matches(".ron"));
        if !name.contains(&only) { continue; }
        let planet = shipped::ALL.iter().find(|s| s.file == file).unwrap().load().unwrap();
        let planet = Arc::new(Planet { clouds: None, ..planet });
        let terrain = Terrain::new(planet.clone());
        let place = LatLon::from_degrees(lat, lon);
        let radius_m = planet.radius_m() + terrain.height_m(place.direction()).max(planet.sea_level_m().unwrap_or(f64::MIN)) + altitude_m;
        let fov = Camera::DEFAULT_FOV_Y_RAD;
        let pixel_rad = 2.0 * (fov * 0.5).tan() / f64::from(SIZE_PX[1]);
        let sun = LatLon::from_degrees(lat + 15.0, lon - 35.0);
        // A glide to the side and forward by a quarter of a pixel in the middle of the picture.
        let step_rad = 0.25 * pixel_rad * altitude_m / (-pitch.to_radians().sin()) / planet.radius_m();
        let frames = 6;
        let (mut shots, mut truth) = (vec![], vec![]);
        for t in 0..frames {
            let east = place.direction().cross(glam::DVec3::NEG_Y).normalize();
            let north = east.cross(place.direction());
            let dir = (place.direction() + (east + 0.6 * north) * step_rad * f64::from(t)).normalize();
            let camera = Camera::over(LatLon::from_direction(dir), radius_m, 0.5, pitch.to_radians(), fov);
            shots.push(picture(&mut gpu, &planet, camera, sun, 1));
            truth.push(picture(&mut gpu, &planet, camera, sun, FINER));
        }
        let n = shots[0].len();
        let (mut jerk, mut moving) = ([vec![0.0f32; n], vec![0.0f32; n]], [0.0f64; 2]);
        let mut total = [0.0f64; 2];
        let noise = 0.0;
        for (k, (set, noise)) in [(&shots, noise), (&truth, noise / 16.0)].into_iter().enumerate() {
            for t in 1..frames as usize - 1 {
                for i in 0..n { for c in 0..3 {
                    let second = set[t + 1][i][c] - 2.0 * set[t][i][c] + set[t - 1][i][c];
                    let first = set[t + 1][i][c] - set[t][i][c];
                    jerk[k][i] += second * second;
                    total[k] += f64::from(second * second - 6.0 * noise);
                    moving[k] += f64::from(first * first - 2.0 * noise);
                } }
            }
        }
        let k = 3.0 * (frames - 2) as f32;
        let rms = |x: f64| (x.max(0.0) / f64::from(k) / n as f64).sqrt();
        println!("{name}: second differences {:.2} (truth {:.2}), first {:.2} (truth {:.2}), ratio {:.2} (truth {:.2})",
            rms(total[0]), rms(total[1]), rms(moving[0]), rms(moving[1]), rms(total[0]) / rms(moving[0]), rms(total[1]) / rms(moving[1]));
        let wrong = &jerk[0];
        let save = |what: &str, f: &dyn Fn(usize) -> [u8; 3]| {
            let mut img = image::RgbImage::new(SIZE_PX[0], SIZE_PX[1]);
            for i in 0..n { img.put_pixel(i as u32 % SIZE_PX[0], i as u32 / SIZE_PX[0], image::Rgb(f(i))); }
            img.save(format!("{out}/{name}-{what}.png")).unwrap();
        };
        save("shot", &|i| shots[0][i].map(|c| c as u8));
        save("truth", &|i| truth[0][i].map(|c| c as u8));
        save("shimmer", &|i| [((wrong[i] / k).sqrt() * 8.0).min(255.0) as u8; 3]);
    }
}
