//! What a view takes from its frames before: clouds while the camera moves, and the mean of a still picture.

use crate::support::{Gpu, SIZE_PX, camera, earth, frame_of, gpu, surface_of};
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Clouds, Planet};
use tellus::render::{Photo, Reuse, ViewId};
use tellus::sphere::LatLon;

/// Heaps of cloud over land and sea.
fn cloudy() -> Arc<Planet> {
    Arc::new(Planet { clouds: Some(Clouds { coverage: 0.5, ..Clouds::default() }), ..earth() })
}

/// A camera among the clouds, moved ahead by a number of metres.
fn among_clouds(planet: &Planet, ahead_m: f64) -> Camera {
    let lat = 10.0 + (ahead_m / planet.radius_m()).to_degrees();
    camera(planet, lat, 10.0, 9000.0, 0.0, -14.0)
}

/// A series of pictures of one view.
struct Series<'a> {
    gpu: &'a mut Gpu,
    planet: Arc<Planet>,
    quality: Quality,
    id: ViewId,
}

impl Series<'_> {
    fn draw(&mut self, camera: Camera, reuse: Reuse) -> Vec<u8> {
        let view = View { camera, size_px: SIZE_PX, quality: self.quality };
        let surface = surface_of(&self.planet, &view);
        let sun = LatLon::from_degrees(30.0, 50.0).direction();
        let mut scene = frame_of(&surface, &self.planet, view, sun);
        (scene.view_id, scene.reuse) = (self.id, reuse);
        self.gpu.draw(&scene)
    }
}

/// Root of the mean squared difference of two pictures, of 255.
fn difference(a: &[u8], b: &[u8]) -> f64 {
    let sum: u64 = a.iter().zip(b).map(|(a, b)| u64::from(a.abs_diff(*b)).pow(2)).sum();
    (sum as f64 / a.len() as f64).sqrt()
}

/// A picture that begins a history is the picture by itself. After a flight, the clouds that were carried over are
/// where a picture by itself has them.
#[test]
fn clouds_are_carried_over_to_where_they_are() {
    let planet = cloudy();
    let mut gpu = gpu();
    for (quality, most) in [(Quality::Low, 4.0), (Quality::Medium, 5.0)] {
        let mut series = Series { gpu: &mut gpu, planet: planet.clone(), quality, id: ViewId(71) };
        let cameras: Vec<Camera> = (0..8).map(|step| among_clouds(&planet, 60.0 * f64::from(step))).collect();
        let alone = series.draw(cameras[0], Reuse::None);
        assert!(series.draw(cameras[0], Reuse::Begin) == alone, "{quality:?}");
        let mut last = Vec::new();
        for camera in &cameras[1..] {
            last = series.draw(*camera, Reuse::Moving);
        }
        let [begun, whole] = [cameras[0], cameras[7]].map(|camera| series.draw(camera, Reuse::None));
        let (off, moved) = (difference(&last, &whole), difference(&begun, &whole));
        assert!(last != whole, "{quality:?}: clouds were marched anew");
        assert!(off < most && moved > 3.0 * off, "{quality:?}: {off} of 255 off; the flight changed {moved}");
    }
}

/// A still picture comes close to one of many samples, from frames with half of its pixels.
#[test]
fn still_pictures_converge() {
    let planet = cloudy();
    let camera = among_clouds(&planet, 0.0);
    let mut gpu = gpu();
    let quality = Quality::Low;
    let mut series = Series { gpu: &mut gpu, planet: planet.clone(), quality, id: ViewId(72) };
    let first = series.draw(camera, Reuse::Begin);
    let mut still = Vec::new();
    for _ in 0..12 {
        still = series.draw(camera, Reuse::Still);
    }
    let reference = many_samples(series.gpu, &planet, camera, quality);
    let [before, after] = [&first, &still].map(|picture| difference(picture, &reference));
    assert!(before > 2.0 * after, "{before} became {after}");
    let again = series.draw(camera, Reuse::Begin);
    assert!(difference(&again, &first) < 0.5 * before, "another picture begins anew");
}

/// A photograph of twice the size, of 9 samples to a pixel, shrunk.
fn many_samples(gpu: &mut Gpu, planet: &Arc<Planet>, camera: Camera, quality: Quality) -> Vec<u8> {
    let view = View { camera, size_px: SIZE_PX, quality };
    let surface = surface_of(planet, &view);
    let large = View { size_px: SIZE_PX.map(|side| 2 * side), ..view };
    let mut scene = frame_of(&surface, planet, large, LatLon::from_degrees(30.0, 50.0).direction());
    scene.bodies[0].frozen = Some(view);
    let mut photo = Photo::default();
    photo.samples = 3;
    let pixels = photo.take(&mut gpu.renderer, &scene, &mut |_| true).unwrap().expect("nobody stops it");
    let encoded = |linear: f32| {
        let low = linear * 12.92;
        let high = 1.055 * linear.max(0.003_130_8).powf(1.0 / 2.4) - 0.055;
        (if linear <= 0.003_130_8 { low } else { high } * 255.0).round() as u8
    };
    let [wide, high] = SIZE_PX.map(|side| side as usize);
    let mean = |i: usize| {
        let (x, y) = (2 * (i % wide), 2 * (i / wide));
        let four = [(0, 0), (1, 0), (0, 1), (1, 1)].map(|(dx, dy)| pixels[(y + dy) * 2 * wide + x + dx]);
        [0, 1, 2].map(|band| encoded(four.iter().map(|pixel| 0.25 * pixel[band]).sum()))
    };
    (0..wide * high).map(mean).flat_map(|[r, g, b]| [r, g, b, 255]).collect()
}
