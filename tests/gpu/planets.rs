//! The shipped planets: no holes, repeatable pictures, and goldens (blessed on Mesa's software driver with
//! `TELLUS_BLESS=1`).

use crate::support::{
    Gpu, LAYERED, camera_over, debug, frame_of, gpu, inside_disc, lights, preset, surface_of, terrain,
};
use glam::DVec3;
use image::RgbImage;
use std::path::PathBuf;
use std::sync::Arc;
use tellus::lod::opening::{default_pitch_deg, opening_place, opening_view};
use tellus::lod::{Quality, View};
use tellus::planet::{Planet, shipped};
use tellus::render::{DebugView, Metering};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;
use tellus::tiles::Surface;

const SIZE_PX: [u32; 2] = [192, 108];
/// Smaller near the ground: the number of tiles goes with the number of pixels.
const NEAR_PX: [u32; 2] = [144, 81];

fn planets() -> Vec<(&'static str, Arc<Planet>)> {
    shipped::ALL.iter().map(|preset| (preset.file, Arc::new(preset.load().unwrap()))).collect()
}

/// A view from above the planet's opening location; altitude above ground or sea.
fn view(planet: &Arc<Planet>, altitude_m: f64) -> View {
    let (terrain, place) = (terrain(planet), opening_place(planet));
    let pitch_rad = default_pitch_deg(planet, altitude_m).to_radians();
    let camera = camera_over(&terrain, place, altitude_m, [0.8, pitch_rad]);
    View { camera, size_px: SIZE_PX, quality: Quality::Low }
}

/// A view from 10 km above dry land, near the opening location.
fn view_of_land(planet: &Arc<Planet>, pitch_rad: f64) -> View {
    let (terrain, opening) = (terrain(planet), opening_place(planet).direction());
    let least_m = planet.sea_level_m().map_or(f64::MIN, |level_m| level_m + 300.0);
    // Nearest first: where rivers are not yet known, each height takes milliseconds.
    let mut dirs: Vec<DVec3> = spread(2000).collect();
    dirs.sort_by(|a, b| b.dot(opening).total_cmp(&a.dot(opening)));
    let nearest = dirs.into_iter().find(|dir| terrain.height_m(*dir) > least_m);
    let place = LatLon::from_direction(nearest.expect("land"));
    let camera = camera_over(&terrain, place, 10_000.0, [0.8, pitch_rad]);
    View { camera, size_px: NEAR_PX, quality: Quality::Low }
}

/// Locations under the star at noon and at sunset of the opening location.
fn noon_and_sunset(planet: &Planet) -> [LatLon; 2] {
    let place = opening_place(planet);
    let west = |rad: f64| LatLon { lon_rad: place.lon_rad - rad, ..place };
    [west(0.2), LatLon { lat_rad: 0.0, ..west(1.5) }]
}

#[test]
#[ignore = "long: minutes"]
fn every_planet_from_orbit_to_the_ground_has_no_hole_and_is_drawn_the_same_twice() {
    for (file, planet) in planets() {
        look_at(file, &planet, &[1.9 * planet.radius_m(), 10_000.0, 100.0]);
    }
}

fn look_at(file: &str, planet: &Arc<Planet>, altitudes_m: &[f64]) {
    let mut gpu = gpu();
    for &altitude_m in altitudes_m {
        let view = view(planet, altitude_m);
        let surface = surface_of(planet, &view);
        let inside = look_for_holes(&mut gpu, &surface, view, &format!("{file} from {altitude_m} m"));
        for sun in noon_and_sunset(planet) {
            let frame = frame_of(&surface, planet, view, sun.direction());
            let picture = gpu.draw(&frame);
            assert!(lights(&picture).iter().any(|&light| light > 100), "{file} from {altitude_m} m is dark");
            // Under the sun no pixel with air is black; a NaN would be.
            let noon = sun == noon_and_sunset(planet)[0] && planet.atmosphere.is_some();
            let black = lights(&picture).iter().zip(&inside).filter(|(light, inside)| **inside && **light == 0).count();
            assert!(!noon || black == 0, "{file} from {altitude_m} m has {black} black pixels at noon");
            assert!(picture == gpu.draw(&frame), "{file} from {altitude_m} m");
        }
    }
}

/// Fails if the ground has a hole. For each pixel, whether it lies well inside the disc.
fn look_for_holes(gpu: &mut Gpu, surface: &Surface, view: View, told: &str) -> Vec<bool> {
    let planet = surface.terrain.planet();
    let lowest_m = surface.leaves.iter().map(|leaf| leaf.tile.min_height_m).fold(f64::MAX, f64::min);
    let coverage = debug(frame_of(surface, planet, view, DVec3::X), DebugView::Coverage);
    let white = lights(&gpu.draw(&coverage));
    // A chord lies below the sphere by up to spacing^2 / (8 R).
    let inside = inside_disc(&coverage, lowest_m.min(0.0) - 0.003 * planet.radius_m());
    let holes = white.iter().zip(&inside).filter(|(light, inside)| **inside && **light != 765).count();
    assert_eq!(holes, 0, "{told}");
    inside
}

/// Goldens from orbit at medium quality and from 10 km above land at low quality. The ground has no hole, and a frame
/// drawn twice is the same.
#[test]
fn every_planet_looks_as_it_did() {
    let folder = PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("tests/goldens");
    let mut gpu = gpu();
    let mut problems = Vec::new();
    for (file, planet) in planets() {
        let orbit = opening_view(&planet, SIZE_PX, Quality::Medium);
        let star = LatLon::from_degrees(planet.star.latitude_deg, planet.star.longitude_deg).direction();
        // The horizon is in one picture only: tiles as far as the horizon take most of the time.
        let low = view_of_land(&planet, if file == shipped::ALL[0].file { -0.5 } else { -0.9 });
        let up = low.camera.position_planet_m.normalize();
        // Over land the star is 35 degrees high, to the east.
        let low_star = (up + DVec3::Z.cross(up).normalize() * 1.4).normalize();
        for (name, view, star) in [("orbit", orbit, star), ("low", low, low_star)] {
            let surface = surface_of(&planet, &view);
            let frame = frame_of(&surface, &planet, view, star);
            let [width, height] = view.size_px;
            let drawn = gpu.draw(&frame);
            look_for_holes(&mut gpu, &surface, view, &format!("{file}, {name}"));
            assert!(drawn == gpu.draw(&frame), "{file}, {name}");
            let rgb: Vec<u8> = drawn.chunks(4).flat_map(|p| p[..3].to_vec()).collect();
            let path = folder.join(format!("{}_{name}.png", file.trim_end_matches(".ron")));
            if std::env::var_os("TELLUS_BLESS").is_some() {
                std::fs::create_dir_all(&folder).unwrap();
                RgbImage::from_raw(width, height, rgb).unwrap().save(&path).unwrap();
                continue;
            }
            let golden = image::open(&path).unwrap_or_else(|e| panic!("{}: {e}", path.display())).to_rgb8();
            assert_eq!([golden.width(), golden.height()], [width, height]);
            let mean =
                rgb.iter().zip(golden.as_raw()).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / rgb.len() as f64;
            if mean > 1.5 {
                let seen = std::env::temp_dir().join(path.file_name().unwrap());
                RgbImage::from_raw(width, height, rgb).unwrap().save(&seen).unwrap();
                problems.push(format!(
                    "{}: differs by {mean:.2} of 255 in the mean; see {}",
                    path.display(),
                    seen.display()
                ));
            }
        }
    }
    assert!(problems.is_empty(), "on {}:\n{}", gpu.adapter, problems.join("\n"));
}

/// Sunlit clouds and snow are white, and the open sea is dark, as the editor opens these planets.
#[test]
fn white_is_white_and_the_open_sea_is_dark() {
    let mut gpu = gpu();
    gpu.post.metering = Metering::Instant;
    // Lower limit of the brightest pixels, and upper limit of the sea: the lens scatters light of ice over it.
    let bars: [(&str, u8, [u8; 3]); 3] =
        [("aurel.ron", 228, [28, 48, 84]), ("maren.ron", 235, [32, 60, 106]), ("hoarfrost.ron", 225, [39, 62, 103])];
    for (file, whitest, darkest) in bars {
        let planet = Arc::new(preset(file));
        let view = opening_view(&planet, [320, 240], Quality::Medium);
        let surface = surface_of(&planet, &view);
        let star = LatLon::from_degrees(planet.star.latitude_deg, planet.star.longitude_deg);
        let frame = frame_of(&surface, &planet, view, star.direction());
        let drawn = gpu.draw(&frame);
        let disc = inside_disc(&frame, -0.1 * planet.radius_m());
        let mut pixels: Vec<[u8; 3]> =
            drawn.chunks(4).zip(disc).filter(|(_, inside)| *inside).map(|(p, _)| [p[0], p[1], p[2]]).collect();
        pixels.sort_by_key(|p| p.iter().map(|c| u32::from(*c)).sum::<u32>());
        // The mean of a percent of the pixels: neighbours in brightness differ in colour.
        let whites = &pixels[pixels.len() * 98 / 100..pixels.len() * 99 / 100];
        let white: [u8; 3] = std::array::from_fn(|channel| {
            let sum: u32 = whites.iter().map(|pixel| u32::from(pixel[channel])).sum();
            (sum / whites.len() as u32) as u8
        });
        assert!(white.iter().all(|c| *c >= whitest), "{file}: the brightest pixels are {white:?}");
        let spread = white.iter().max().unwrap() - white.iter().min().unwrap();
        assert!(spread <= 10, "{file}: white has a tint: {white:?}");
        // Blue pixels of the sea, without the twilight at the terminator and forests behind haze.
        let is_sea = |p: &&[u8; 3]| {
            let [red, green, blue] = p.map(u32::from);
            blue > 2 * red && 2 * blue > 3 * green && blue > 40
        };
        let sea: Vec<_> = pixels.iter().filter(is_sea).collect();
        // The median of each channel: neighbours in brightness differ in colour.
        let sea: [u8; 3] = std::array::from_fn(|channel| {
            let mut codes: Vec<u8> = sea.iter().map(|pixel| pixel[channel]).collect();
            codes.sort_unstable();
            codes[codes.len() / 2]
        });
        assert!(sea.iter().zip(darkest).all(|(c, most)| *c <= most), "{file}: the sea is {sea:?}");
    }
}

/// Places for a report: the preset; latitude, longitude, altitude, heading and pitch of the camera; longitude of the
/// star.
const REPORTED: [(&str, [f64; 6]); 5] = [
    ("aurel.ron", [-15.03, -77.8, 2.0, 60.0, -8.0, -110.0]),
    ("aurel.ron", [-15.03, -77.8, 12_000.0, 60.0, -15.0, -110.0]),
    ("maren.ron", [5.0, -120.0, 300.0, 90.0, 6.0, -150.0]),
    ("maren.ron", [5.0, -120.0, 3000.0, 90.0, -8.0, -150.0]),
    ("maren.ron", [5.0, -120.0, 60_000.0, 270.0, -45.0, -165.0]),
];

/// Prints milliseconds of a frame of 640 x 360 at low quality.
#[test]
#[ignore = "long: a report of figures"]
fn report_what_low_quality_costs() {
    let mut gpu = gpu();
    for (file, [lat, lon, altitude_m, heading, pitch, star_lon]) in REPORTED {
        let planet = Arc::new(preset(file));
        let angles = [heading, pitch].map(f64::to_radians);
        let camera = camera_over(&terrain(&planet), LatLon::from_degrees(lat, lon), altitude_m, angles);
        let view = View { camera, size_px: [640, 360], quality: Quality::Low };
        let surface = surface_of(&planet, &view);
        let frame = frame_of(&surface, &planet, view, LatLon::from_degrees(5.0, star_lon).direction());
        gpu.draw_only(&frame, 2);
        let times = (0..15).map(|_| {
            let begun = std::time::Instant::now();
            gpu.draw_only(&frame, 1);
            begun.elapsed().as_secs_f64() * 1e3
        });
        println!("{file} from {altitude_m} m: {:.1} ms", times.fold(f64::MAX, f64::min));
    }
}

/// Directions spread evenly over the sphere.
fn spread(count: usize) -> impl Iterator<Item = DVec3> {
    (0..count).map(move |i| {
        let z = 1.0 - 2.0 * (i as f64 + 0.5) / count as f64;
        let (y, x) = (i as f64 * 2.399_963).sin_cos();
        let flat = (1.0 - z * z).sqrt();
        DVec3::new(x * flat, y * flat, z)
    })
}

fn shipped_terrain(file: &str) -> Terrain {
    Terrain::try_new(Arc::new(preset(file))).unwrap()
}

/// Contributions of single layers at points, metres.
fn layer_m(terrain: &Terrain, dir: DVec3, name: &str) -> f64 {
    let at = terrain.planet().layers.iter().position(|layer| layer.name == name).unwrap();
    terrain.layers_m(dir)[at]
}

/// Cinnabar's black sand lies in dry basins, not in rings around volcanoes. Pallor's dark basalt fills its maria, not
/// its craters.
#[test]
fn dark_ground_lies_where_the_land_says_so() {
    let terrain = shipped_terrain("cinnabar.ron");
    let black = terrain.planet().biomes.palette.iter().position(|biome| biome.name == "Black sand").unwrap();
    let on_volcanoes = spread(6000)
        .filter(|dir| layer_m(&terrain, *dir, "Shield volcanoes") > 1500.0)
        .filter(|dir| terrain.sample(*dir).biome == black)
        .count();
    assert!(on_volcanoes <= 3, "{on_volcanoes}");
    let terrain = shipped_terrain("pallor.ron");
    let basalt = terrain.planet().biomes.palette.iter().position(|biome| biome.name == "Dark basalt").unwrap();
    let floors: Vec<DVec3> = spread(6000)
        .filter(|dir| layer_m(&terrain, *dir, "Great craters") < -1200.0 && layer_m(&terrain, *dir, "Maria") > -300.0)
        .collect();
    let dark = floors.iter().filter(|dir| terrain.sample(**dir).biome == basalt).count();
    assert!(floors.len() > 50 && dark * 8 < floors.len(), "{dark} of {}", floors.len());
}

/// In their belts, dunes have realistic heights.
#[test]
fn dunes_stand_in_their_belts() {
    for (file, least_m) in [(LAYERED, 75.0), ("cinnabar.ron", 110.0)] {
        let terrain = shipped_terrain(file);
        // The tallest stretches of 2 km among many.
        let mut rises: Vec<f64> = spread(1500)
            .map(|dir| {
                let east = DVec3::Z.cross(dir).normalize_or(DVec3::X);
                let step = 100.0 / terrain.planet().radius_m();
                let heights: Vec<f64> =
                    (0..20).map(|i| layer_m(&terrain, dir + east * step * f64::from(i), "Dunes")).collect();
                let most = heights.iter().copied().fold(f64::MIN, f64::max);
                most - heights.iter().copied().fold(f64::MAX, f64::min)
            })
            .collect();
        rises.sort_by(f64::total_cmp);
        let tall = rises[rises.len() - 4];
        assert!(tall > least_m, "{file}: {tall} m");
    }
}
