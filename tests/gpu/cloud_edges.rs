//! Clouds near the horizon: no stairs where they end, no stripes within.

use crate::support::{Gpu, SIZE_PX, frame_of, gpu, surface_of};
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Clouds, Planet, Water};
use tellus::sphere::LatLon;

/// Clouds over a sea, before a black sky.
fn cloudy(coverage: f64, layering: f64) -> Arc<Planet> {
    let clear = Clouds { rain: 0.0, middle: 0.0, veil: 0.0, fog: 0.0, ..Clouds::default() };
    let low = Clouds { altitude_km: 3.5, thickness_km: 2.6, density: 36.0, puff_km: 5.0, towers: 0.6, ..clear };
    let clouds = Clouds { coverage, layering, ..low };
    let water = Some(Water { level_m: 10.0, ..Water::default() });
    Arc::new(Planet { clouds: Some(clouds), water, atmosphere: None, layers: Vec::new(), ..Planet::default() })
}

/// Green in each pixel, 0 to 255, with the sun high.
fn greens(gpu: &mut Gpu, planet: &Arc<Planet>, camera: Camera, quality: Quality) -> Vec<f64> {
    let view = View { camera, size_px: SIZE_PX, quality };
    let surface = surface_of(planet, &view);
    let scene = frame_of(&surface, planet, view, LatLon::from_degrees(30.0, 20.0).direction());
    gpu.draw(&scene).chunks(4).map(|pixel| f64::from(pixel[1])).collect()
}

/// A camera over the sea; angles in degrees.
fn camera(planet: &Planet, altitude_m: f64, heading: f64, pitch: f64, fov: f64) -> Camera {
    let angles = [heading, pitch, fov].map(f64::to_radians);
    Camera::over(
        LatLon::from_degrees(5.0, 10.0),
        planet.radius_m() + 10.0 + altitude_m,
        angles[0],
        angles[1],
        angles[2],
    )
}

/// The line where a deck of clouds ends before the sky moves with the camera in parts of a pixel. Of rays through the
/// middles of pixels a whole row crosses it at once, and where it is nearly level it is a staircase.
#[test]
fn clouds_end_at_the_horizon_without_stairs() {
    let planet = cloudy(1.0, 1.0);
    let mut gpu = gpu();
    let fov = Camera::DEFAULT_FOV_Y_RAD.to_degrees();
    for (quality, scale) in [(Quality::Low, 2.0), (Quality::Medium, 1.0)] {
        // Pitches over one pixel that is drawn.
        let pixel_deg = fov / f64::from(SIZE_PX[1]) * scale;
        let mut light = |step: u32| {
            let pitch = -3.0 - f64::from(step) / 9.0 * pixel_deg;
            let picture = greens(&mut gpu, &planet, camera(&planet, 10e3, 90.0, pitch, fov), quality);
            // In the middle the horizon is level.
            let [width, middle] = [SIZE_PX[0] as usize, SIZE_PX[0] as usize / 2];
            let level = picture.chunks(width).flat_map(|row| &row[middle - 6..middle + 6]);
            level.map(|green| (green / 255.0).powf(2.2)).sum::<f64>()
        };
        let lights: Vec<f64> = (0..=9).map(&mut light).collect();
        let whole = (lights[9] - lights[0]).abs();
        let most = lights.windows(2).map(|pair| (pair[1] - pair[0]).abs()).fold(0.0, f64::max);
        assert!(whole > 5.0 && most < 0.7 * whole, "{quality:?}: {most} of {whole} at once: {lights:?}");
    }
}

/// Heaps near the horizon, from the ground. Rows of pixels that sample clouds at one distance each show stripes: level
/// lines that are brighter or darker than what is above and below.
#[test]
fn clouds_near_the_horizon_have_no_stripes() {
    let planet = cloudy(0.15, -1.0);
    let mut gpu = gpu();
    let width = SIZE_PX[0] as usize;
    let mut striped = 0;
    for heading in [120.0, 180.0] {
        let picture = greens(&mut gpu, &planet, camera(&planet, 2.0, heading, 11.0, 20.0), Quality::Medium);
        for y in 1..SIZE_PX[1] as usize - 1 {
            let is_line = |x: usize| {
                let [over, here, under] = [y - 1, y, y + 1].map(|y| picture[y * width + x]);
                (here - over).min(here - under) >= 2.0 || (over - here).min(under - here) >= 2.0
            };
            let line: Vec<bool> = (0..width).map(is_line).collect();
            striped += line.split(|is_line| !is_line).map(<[bool]>::len).filter(|length| *length >= 6).sum::<usize>();
        }
    }
    assert!(striped < 400, "{striped} pixels are in stripes");
}
