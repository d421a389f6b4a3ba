//! No shimmer at a distance: in a slow flight, pictures change nearly as smoothly as with nine samples per pixel.

use crate::support::{Gpu, LAYERED, frame_of, gpu, preset, settled};
use std::sync::Arc;
use tellus::lod::{Camera, Quality, View};
use tellus::planet::Planet;
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;
use tellus::tiles::Builder;

const SIZE_PX: [u32; 2] = [144, 96];
/// Samples of the reference along each side of a pixel.
const FINER: u32 = 3;
/// Pictures of a flight, and pixels from one to the next.
const PICTURES: usize = 5;
const STEP_PX: f64 = 0.25;

/// A flight to the side and forward.
struct Flight {
    file: &'static str,
    lat_deg: f64,
    lon_deg: f64,
    altitude_m: f64,
    pitch_deg: f64,
}

const fn flight(file: &'static str, [lat_deg, lon_deg]: [f64; 2], altitude_m: f64, pitch_deg: f64) -> Flight {
    Flight { file, lat_deg, lon_deg, altitude_m, pitch_deg }
}

/// Scenes with many features as narrow as a pixel: coasts and snowy mountains from orbit, rivers, snow above a beach,
/// crevasses.
const FLIGHTS: [Flight; 4] = [
    flight(LAYERED, [16.0, -8.0], 4.0e6, -90.0),
    flight(LAYERED, [16.0, -8.0], 3.0e5, -40.0),
    flight("maren.ron", [41.0, -65.0], 1.0e4, -30.0),
    flight("hoarfrost.ron", [66.4, 85.0], 1.0e4, -30.0),
];

/// Pixels, 0 to 255, of a picture drawn `finer` times as wide and high, and averaged.
fn picture(
    gpu: &mut Gpu,
    builder: &Builder,
    planet: &Arc<Planet>,
    camera: Camera,
    sun: LatLon,
    times: u32,
) -> Vec<[f32; 3]> {
    let view = View { camera, size_px: SIZE_PX.map(|side| side * times), quality: Quality::Medium };
    let surface = settled(builder, planet, &view);
    let pixels = gpu.draw(&frame_of(&surface, planet, view, sun.direction()));
    let [width, height] = SIZE_PX.map(|side| side as usize);
    let times = times as usize;
    let mean = |i: usize| {
        let (x, y) = (i % width * times, i / width * times);
        let samples = (0..times * times).map(|j| ((y + j / times) * width * times + x + j % times) * 4);
        let sum = samples.fold([0.0; 3], |sum, at| std::array::from_fn(|c| sum[c] + f32::from(pixels[at + c])));
        sum.map(|sum| sum / (times * times) as f32)
    };
    (0..width * height).map(mean).collect()
}

/// Second differences caused by rounding alone.
const ROUNDING: f32 = 2.0;

/// Root mean squares of the first and second differences from picture to picture.
fn changes(pictures: &[Vec<[f32; 3]>]) -> [f64; 2] {
    let (mut sums, mut count) = ([0.0; 2], 0.0);
    for three in pictures.windows(3) {
        for ((before, now), after) in three[0].iter().zip(&three[1]).zip(&three[2]) {
            for c in 0..3 {
                let first = after[c] - now[c];
                let second = ((after[c] - 2.0 * now[c] + before[c]).abs() - ROUNDING).max(0.0);
                sums[0] += f64::from(first * first);
                sums[1] += f64::from(second * second);
                count += 1.0;
            }
        }
    }
    sums.map(|sum: f64| (sum / count).sqrt())
}

#[test]
fn what_is_as_narrow_as_pixels_moves_as_smoothly_as_in_the_truth() {
    fly(&FLIGHTS[1..2]);
}

#[test]
#[ignore = "long: minutes"]
fn on_all_flights_what_is_as_narrow_as_pixels_moves_as_smoothly_as_in_the_truth() {
    fly(&FLIGHTS);
}

fn fly(flights: &[Flight]) {
    let mut gpu = gpu();
    let mut problems = Vec::new();
    for &Flight { file, lat_deg, lon_deg, altitude_m, pitch_deg } in flights {
        let planet = preset(file);
        let planet = Arc::new(Planet { clouds: None, ..planet });
        let terrain = Terrain::try_new(planet.clone()).unwrap();
        let place = LatLon::from_degrees(lat_deg, lon_deg).direction();
        let surface_m = terrain.height_m(place).max(planet.sea_level_m().unwrap_or(f64::MIN));
        let (radius_m, pitch_rad) = (planet.radius_m() + surface_m + altitude_m, pitch_deg.to_radians());
        let fov_rad = Camera::DEFAULT_FOV_Y_RAD;
        let pixel_m = 2.0 * (fov_rad * 0.5).tan() / f64::from(SIZE_PX[1]) * altitude_m / -pitch_rad.sin();
        let east = place.cross(glam::DVec3::NEG_Z).normalize();
        let way = (east + 0.6 * east.cross(place)) * (STEP_PX * pixel_m / planet.radius_m());
        let sun = LatLon::from_degrees(lat_deg + 15.0, lon_deg - 35.0);
        let mut seen = |times: u32| -> [f64; 2] {
            let builder = Builder::new(|| {});
            let pictures = (0..PICTURES).map(|i| {
                let place = LatLon::from_direction((place + way * i as f64).normalize());
                picture(&mut gpu, &builder, &planet, Camera::over(place, radius_m, 0.5, pitch_rad, fov_rad), sun, times)
            });
            changes(&pictures.collect::<Vec<_>>())
        };
        let ([first, second], [true_first, true_second]) = (seen(1), seen(FINER));
        let told = format!(
            "{file} from {altitude_m} m: changes by {first:.2} ({true_first:.2} in truth), unevenly by {second:.2} ({true_second:.2})"
        );
        println!("{told}");
        // Something moves, and pixels do not jump: a jump has a second difference as large as its first. The margin
        // allows for rounding to display codes under a steep tone curve.
        if true_first < 0.2 || second > (1.15 * first).max(1.1 * true_second) {
            problems.push(told);
        }
    }
    assert!(problems.is_empty(), "{problems:#?}");
}
