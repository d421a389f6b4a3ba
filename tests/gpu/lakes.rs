//! Lakes and rivers of a planet with a structure are drawn as water.

use crate::support::{camera_over, debug, frame_of, gpu, surface_of};
use std::sync::Arc;
use tellus::lod::{Quality, View};
use tellus::planet::{Clouds, Planet, Structure, Water};
use tellus::render::DebugView;
use tellus::sphere::LatLon;
use tellus::terrain::{Lake, Terrain};

const SIDE_PX: u32 = 64;
/// Pixels of about this width. The planet's cells are 150 km wide.
const PIXEL_M: f64 = 1000.0;

/// A large lake, and the cell in its middle.
fn lake(terrain: &Terrain) -> (Lake, LatLon) {
    let lakes = terrain.rivers(1e9).lakes;
    let is_inner = |lake: &Lake, cell: &LatLon| {
        let near = |other: &&LatLon| other.direction().dot(cell.direction()) > 0.999;
        lake.level_m > 5.0 && cell.lat_rad.abs() < 0.8 && lake.cells.iter().filter(near).count() >= 9
    };
    let found = lakes.iter().find_map(|lake| {
        let cell = lake.cells.iter().find(|cell| is_inner(lake, cell))?;
        Some((lake.clone(), *cell))
    });
    found.expect("a large lake")
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
    assert_eq!(sample.water_level_m, Some(lake.level_m));
    assert!(sample.height_m < lake.level_m - 1.0, "queries answer the bed: {sample:?}");

    let altitude_m = PIXEL_M * f64::from(SIDE_PX);
    let camera = camera_over(&terrain, place, altitude_m, [0.0, -std::f64::consts::FRAC_PI_2]);
    let view = View { camera, size_px: [SIDE_PX; 2], quality: Quality::Low };
    let surface = surface_of(&planet, &view);
    let detail = surface.leaves.iter().filter_map(|leaf| leaf.detail.as_ref());
    assert!(detail.clone().count() > 0 && detail.clone().all(|detail| detail.water.len() == detail.slopes.len()));
    let is_level = |leaf: &&tellus::tiles::Leaf| {
        let to_place = leaf.tile.vertices.iter().map(|vertex| vertex.position_planet_m().normalize());
        let near = to_place.zip(&leaf.tile.vertices).filter(|(dir, _)| dir.dot(place.direction()) > 0.999_999);
        near.clone().count() > 0
            && near.clone().all(|(_, vertex)| (f64::from(vertex.height_m) - lake.level_m).abs() < 0.01)
    };
    assert!(surface.leaves.iter().any(|leaf| is_level(&leaf)), "vertices lie on the water");

    let mut gpu = gpu();
    let frame = frame_of(&surface, &planet, view, place.direction());
    gpu.draw_only(&debug(frame.clone(), DebugView::Albedo), 1);
    let middle = (SIDE_PX * SIDE_PX / 2 + SIDE_PX / 2) as usize;
    let (_, albedo) = gpu.renderer.radiance().unwrap();
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

#[test]
fn without_a_structure_tiles_have_no_water() {
    let planet = Arc::new(tellus::planet::shipped::default_planet());
    let terrain = Terrain::try_new(planet.clone()).unwrap();
    let camera = camera_over(&terrain, LatLon::from_degrees(20.0, 14.0), 2e6, [0.0, -1.5]);
    let surface = surface_of(&planet, &View { camera, size_px: [32; 2], quality: Quality::Low });
    let mut details = surface.leaves.iter().filter_map(|leaf| leaf.detail.as_ref()).peekable();
    assert!(details.peek().is_some() && details.all(|detail| detail.water.is_empty()));
}
