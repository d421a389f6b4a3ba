//! A biome is the same wherever one asks: `Terrain::sample`, and the picture that shows biomes by themselves.
#![cfg(feature = "editor")]
#![allow(clippy::unwrap_used, clippy::panic, clippy::expect_used)]

mod support;

use std::sync::Arc;
use support::Gpu;
use tellus::build::{add_detail, build_now};
use tellus::lod::{Camera, Quality, View};
use tellus::planet::{Planet, TableBlend, shipped};
use tellus::render::{DebugView, Frame};
use tellus::sphere::LatLon;
use tellus::terrain::Terrain;
use tellus::terrain::survey::spread;

const SIZE_PX: [u32; 2] = [400, 400];
/// Points asked for on each planet.
const POINTS: usize = 2000;

/// A colour as the picture encodes it.
fn srgb(linear: [f64; 3]) -> [u8; 3] {
    linear.map(|x| {
        let encoded = if x <= 0.003_130_8 { x * 12.92 } else { 1.055 * x.powf(1.0 / 2.4) - 0.055 };
        (encoded * 255.0).round() as u8
    })
}

/// The biome whose colour a pixel has.
fn biome_of(palette: &[[u8; 3]], pixel: &[u8]) -> Option<usize> {
    palette.iter().position(|color| color.iter().zip(pixel).all(|(a, b)| a.abs_diff(*b) <= 1))
}

/// Of so many points seen at pixels of a view of a planet: how many have the query's biome in the picture, how many have it no
/// farther than a pixel away, how many there are.
fn compared(gpu: &mut Gpu, terrain: &Terrain, place: LatLon, distance_m: f64, points: usize) -> [usize; 3] {
    let planet = terrain.planet();
    let camera = Camera::over(place, distance_m, 0.0, -std::f64::consts::FRAC_PI_2, Camera::DEFAULT_FOV_Y_RAD);
    let view = View { camera, size_px: SIZE_PX, quality: Quality::Medium };
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
        debug_view: DebugView::Biome,
    });
    let palette: Vec<[u8; 3]> = planet.biomes.palette.iter().map(|biome| srgb(biome.color)).collect();
    let [width, height] = SIZE_PX.map(|side| side as usize);
    let pixel = |x: usize, y: usize| biome_of(&palette, &picture[(y * width + x) * 4..][..3]);
    let mut counts = [0; 3];
    let mut random = 12345_u32;
    for _ in 0..20 * points {
        let mut next = |below: usize| {
            random = random.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (random >> 8) as usize % below
        };
        let (x, y) = (1 + next(width - 2), 1 + next(height - 2));
        let ndc = |i: usize, n: usize| (i as f64 + 0.5) / n as f64 * 2.0 - 1.0;
        let ray = camera.ray_dir_planet(ndc(x, width), -ndc(y, height), view.aspect());
        let Some(way_m) = terrain.raycast(camera.position_planet_m, ray) else { continue };
        let ground_m = camera.position_planet_m + ray * way_m;
        // Well this side of the limb, where one pixel is many places.
        if -ray.dot(ground_m.normalize()) < 0.55 || counts[2] == points {
            continue;
        }
        let biome = Some(terrain.sample(ground_m).biome);
        let near = (x - 1..=x + 1).any(|x| (y - 1..=y + 1).any(|y| pixel(x, y) == biome));
        counts = [counts[0] + usize::from(pixel(x, y) == biome), counts[1] + usize::from(near), counts[2] + 1];
    }
    counts
}

#[test]
fn the_biome_of_a_query_is_the_one_in_the_picture() {
    let mut gpu = Gpu::new();
    let mut problems = Vec::new();
    for preset in shipped::ALL {
        let planet = Arc::new(preset.load().unwrap());
        let terrain = Terrain::new(planet.clone());
        let mut sums = [0; 3];
        // From where a pixel is a kilometre or less. From far away (the last, which does not count) most mountains are finer
        // than a pixel, and the picture shows the biome of a height between them.
        for (radii, count) in [(1.05, 1000), (1.01, 1000), (3.2, 200)] {
            let mut seen = [0; 3];
            for (lat, lon) in [(25.0, 10.0), (-35.0, 170.0)] {
                let place = LatLon::from_degrees(lat, lon);
                let counts = compared(&mut gpu, &terrain, place, radii * planet.radius_m(), count / 2);
                (0..3).for_each(|k| seen[k] += counts[k]);
            }
            println!("{} from {radii} radii: {seen:?}", preset.file);
            if radii > 2.0 {
                if seen[0] * 100 < seen[2] * 80 || seen[1] * 100 < seen[2] * 93 {
                    problems.push(format!("{} from space: {seen:?}", preset.file));
                }
                continue;
            }
            (0..3).for_each(|k| sums[k] += seen[k]);
        }
        let [same, near, all] = sums;
        println!("{}: {same} of {all} the same, {near} within a pixel of it", preset.file);
        assert_eq!(all, POINTS);
        // Aimed at: 99% and all the rest within a pixel. What is missing is probably steep ground, where the vertices of the
        // mesh and the point of a query stand at different heights.
        if (same as f64) < 0.985 * all as f64 || (near as f64) < 0.993 * all as f64 {
            problems.push(format!("{}: {same} of {all} the same, {near} within a pixel", preset.file));
        }
    }
    assert!(problems.is_empty(), "{problems:#?}");
}

#[test]
fn jitter_moves_borders_and_crisp_ones_have_edges() {
    let mut planet = shipped::default_planet();
    let terrain = Terrain::new(Arc::new(planet.clone()));
    planet.biomes.border_jitter = 0.0;
    let plain = Terrain::new(Arc::new(planet.clone()));
    let dirs: Vec<_> = spread(3000).collect();
    let moved = dirs.iter().filter(|dir| terrain.sample(**dir).cell != plain.sample(**dir).cell).count();
    assert!((300..2400).contains(&moved), "{moved} of 3000");

    // On a smooth airless ball lit from the eye, crisp borders have edges and blended ones none.
    let mut ball = Planet { biomes: planet.biomes.clone(), radius_km: 100.0, ..Planet::default() };
    ball.climate.temperature_variation_c = 0.0;
    ball.climate.moisture_variation = 0.0;
    for biome in &mut ball.biomes.palette {
        biome.variation = 0.0;
        biome.patches = 0.0;
        biome.detail = tellus::planet::Detail::None;
    }
    let mut gpu = Gpu::new();
    let mut edges = |blend| {
        ball.biomes.blend = blend;
        let planet = Arc::new(ball.clone());
        let camera = Camera::over(LatLon::from_degrees(30.0, 0.0), 1.6e5, 0.0, -1.5, Camera::DEFAULT_FOV_Y_RAD);
        let view = View { camera, size_px: [160, 120], quality: Quality::Medium };
        let surface = build_now(&planet, &view);
        let picture = gpu.draw(&Frame {
            surface: &surface,
            planet: &planet,
            view,
            frozen: None,
            sun_dir_planet: camera.position_planet_m,
            time_secs: 0.0,
            exposure_ev: 0.0,
            debug_view: DebugView::Shaded,
        });
        // Places where the ground changes from one pixel to the next.
        let step = |pair: &[u8]| (0..3).map(|i| u32::from(pair[i].abs_diff(pair[i + 4]))).sum::<u32>();
        picture.chunks(160 * 4).flat_map(|row| row.windows(8).step_by(4)).filter(|pair| step(pair) > 18).count()
    };
    let (linear, crisp) = (edges(TableBlend::Linear), edges(TableBlend::Crisp));
    assert!(crisp > 40 && 2 * linear < crisp, "{crisp} edges, {linear} when blended");
}
