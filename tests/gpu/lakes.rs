//! Lakes and rivers of a planet with a structure are drawn as water.

use crate::support::{LAYERED, camera_over, debug, frame_of, gpu, preset, surface_of};
use std::sync::Arc;
use tellus::lod::{Quality, View};
use tellus::planet::{Clouds, Planet, Structure, Water};
use tellus::render::DebugView;
use tellus::sphere::LatLon;
use tellus::terrain::{Lake, Terrain};

const SIDE_PX: u32 = 64;
/// Width of a pixel on the lake, which is some kilometres wide.
const PIXEL_M: f64 = 30.0;

/// A lake without ice far from other lakes, and a location where it is deep.
fn lake(terrain: &Terrain) -> (Lake, LatLon) {
    let lakes = terrain.rivers(1e9).lakes;
    let is_alone = |lake: &&Lake| {
        let others = lakes.iter().filter(|other| other.id != lake.id).flat_map(|other| &other.cells);
        let is_warm = terrain.sample(lake.cells[0].direction()).temperature_c > 8.0;
        is_warm
            && lake.level_m > 1.0
            && others.into_iter().all(|other| other.direction().dot(lake.cells[0].direction()) < 0.99)
    };
    let lake = lakes.iter().find(is_alone).expect("a lake");
    let middle = lake.cells[0].direction();
    let (east, north) = middle.any_orthonormal_pair();
    // Across a cell.
    let step = |k: i32| f64::from(k) * 1e-3;
    let around = (-8..=8).flat_map(|x| (-8..=8).map(move |y| (x, y)));
    let places = around.map(|(x, y)| LatLon::from_direction((middle + east * step(x) + north * step(y)).normalize()));
    let bed_m = |place: &LatLon| terrain.height_m(place.direction());
    let place = places.min_by(|a, b| bed_m(a).total_cmp(&bed_m(b))).expect("a location");
    (lake.clone(), place)
}

#[test]
fn a_lake_is_drawn_as_level_water() {
    let color = [0.01, 0.03, 0.09];
    let planet = Arc::new(Planet {
        structure: Some(Structure { grids: 1, ..Structure::default() }),
        water: Some(Water { color, ..Water::default() }),
        clouds: None::<Clouds>,
        ..Planet::default()
    });
    let terrain = Terrain::try_new(planet.clone()).unwrap();
    let (lake, place) = lake(&terrain);
    let sample = terrain.sample(place.direction());
    assert!(sample.height_m < lake.level_m - 3.0, "queries answer the bed: {sample:?}");

    let altitude_m = PIXEL_M * f64::from(SIDE_PX);
    let camera = camera_over(&terrain, place, altitude_m, [0.0, -std::f64::consts::FRAC_PI_2]);
    let view = View { camera, size_px: [SIDE_PX; 2], quality: Quality::Low };
    let surface = surface_of(&planet, &view);
    let detail = surface.leaves.iter().filter_map(|leaf| leaf.detail.as_ref());
    assert!(detail.clone().count() > 0 && detail.clone().all(|detail| detail.water.len() == detail.slopes.len()));
    let vertices = surface.leaves.iter().flat_map(|leaf| &leaf.tile.vertices);
    let near = vertices.filter(|vertex| vertex.position_planet_m().normalize().dot(place.direction()) > 0.999_99);
    let level = near.filter(|vertex| (f64::from(vertex.height_m) - lake.level_m).abs() < 0.01).count();
    assert!(level > 3, "vertices lie on the water: {level}");

    let mut gpu = gpu();
    let frame = frame_of(&surface, &planet, view, place.direction());
    gpu.draw_only(&debug(frame.clone(), DebugView::Albedo), 1);
    let ([width, height], albedo) = gpu.renderer.radiance().unwrap();
    let middle = (height / 2 * width + width / 2) as usize;
    let wet = albedo[middle].map(f64::from);
    assert!(wet.iter().zip(color).all(|(seen, color)| (seen - color).abs() < 2e-3), "{wet:?}");
    // Water reflects the sun overhead and is no black hole; a sun aside leaves it darker than any ground.
    let aside = (place.direction() + place.direction().any_orthonormal_vector()).normalize();
    gpu.draw_only(&frame_of(&surface, &planet, view, aside), 1);
    let (_, lit) = gpu.renderer.radiance().unwrap();
    let [red, green, blue] = lit[middle].map(f64::from);
    assert!(red > 0.0 && blue > red && green < 0.3, "{:?}", lit[middle]);

    // The same view of the same planet without the water of its structure.
    let mut dry = surface.clone();
    for leaf in &mut dry.leaves {
        leaf.detail = None;
    }
    gpu.draw_only(&debug(frame_of(&dry, &planet, view, aside), DebugView::Albedo), 1);
    let (_, ground) = gpu.renderer.radiance().unwrap();
    let apart: f64 = ground[middle].iter().zip(wet).map(|(a, b)| (f64::from(*a) - b).abs()).sum();
    assert!(apart > 0.05, "{:?} {wet:?}", ground[middle]);
}

/// A lake is frozen, and bright, where it is cold enough.
#[test]
fn lakes_freeze() {
    let planet = Planet {
        structure: Some(Structure { grids: 1, ..Structure::default() }),
        water: Some(Water::default()),
        clouds: None::<Clouds>,
        ..Planet::default()
    };
    let terrain = Terrain::try_new(planet.clone().into()).unwrap();
    let (_, place) = lake(&terrain);
    let temperature_c = terrain.sample(place.direction()).temperature_c;
    let camera = camera_over(&terrain, place, PIXEL_M * f64::from(SIDE_PX), [0.0, -std::f64::consts::FRAC_PI_2]);
    let view = View { camera, size_px: [SIDE_PX; 2], quality: Quality::Medium };
    let mut gpu = gpu();
    let mut green = |freezing_c: f64| {
        let water = Some(Water { freezing_c, ..Water::default() });
        let planet = Arc::new(Planet { water, ..planet.clone() });
        let surface = surface_of(&planet, &view);
        // A sun aside, so that open water is dark.
        let sun = (place.direction() + place.direction().any_orthonormal_vector()).normalize();
        gpu.draw_only(&frame_of(&surface, &planet, view, sun), 1);
        let ([width, height], lit) = gpu.renderer.radiance().unwrap();
        f64::from(lit[(height / 2 * width + width / 2) as usize][1])
    };
    // The noise that bends edges of ice moves them by up to 4 °C.
    let [open, frozen] = [temperature_c - 10.0, temperature_c + 10.0].map(&mut green);
    assert!(frozen > 0.3 && frozen > 4.0 * open, "{open} open, {frozen} frozen");
    let steps = [-7.0, -4.0, -2.0, 0.0, 2.0, 4.0].map(|warmer_c| green(temperature_c + warmer_c));
    assert!(steps[0] < 1.5 * open && steps[5] > 3.0 * open, "{steps:?}");
    assert!(steps.is_sorted_by(|a, b| *b > a - 0.02), "{steps:?}");
}

#[test]
fn without_a_structure_tiles_have_no_water() {
    let planet = Arc::new(preset(LAYERED));
    let terrain = Terrain::try_new(planet.clone()).unwrap();
    let camera = camera_over(&terrain, LatLon::from_degrees(20.0, 14.0), 2e6, [0.0, -1.5]);
    let surface = surface_of(&planet, &View { camera, size_px: [32; 2], quality: Quality::Low });
    let mut details = surface.leaves.iter().filter_map(|leaf| leaf.detail.as_ref()).peekable();
    assert!(details.peek().is_some() && details.all(|detail| detail.water.is_empty()));
}

#[test]
fn maps_of_a_structure_are_shown_where_there_is_one() {
    let with = Planet { structure: Some(Structure { grids: 1, ..Structure::default() }), ..Planet::default() };
    let mut gpu = gpu();
    let mut colours = |planet: &Planet, debug_view| {
        let planet = Arc::new(planet.clone());
        let terrain = Terrain::try_new(planet.clone()).unwrap();
        let camera = camera_over(&terrain, LatLon::from_degrees(10.0, 20.0), 1e7, [0.0, -std::f64::consts::FRAC_PI_2]);
        let view = View { camera, size_px: [SIDE_PX; 2], quality: Quality::Low };
        let surface = surface_of(&planet, &view);
        let scene = debug(frame_of(&surface, &planet, view, LatLon::from_degrees(10.0, 20.0).direction()), debug_view);
        let picture = gpu.draw(&scene);
        let coloured = |pixel: &&[u8]| pixel[..3].iter().max().unwrap() - pixel[..3].iter().min().unwrap() > 12;
        picture.chunks(4).filter(coloured).map(<[u8]>::to_vec).collect::<std::collections::HashSet<_>>()
    };
    let views = [DebugView::Plates, DebugView::Rain, DebugView::Rivers];
    let [plates, rain, rivers] = views.map(|view| colours(&with, view));
    assert!([&plates, &rain, &rivers].iter().all(|seen| seen.len() > 20), "{plates:?} {rain:?} {rivers:?}");
    assert!(plates != rain && rain != rivers);
    let none = colours(&Planet { structure: None, ..with.clone() }, DebugView::Plates);
    assert!(none.is_empty(), "{none:?}");
}
