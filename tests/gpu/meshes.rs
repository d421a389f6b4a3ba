//! Meshes of artists in pictures: their colours, and the plain form where they are missing.

use crate::glb::{Part, block, glb};
use crate::support::{SIZE_PX, camera, debug, frame_of, gpu, surface_of};
use std::sync::Arc;
use tellus::lod::{Quality, View};
use tellus::planet::life::FileMesh;
use tellus::planet::{Biome, Form, Planet, Population, Table};
use tellus::render::DebugView;

/// A grey sphere with posts 6 m high, the lower half of them red and the upper half blue.
fn planet(own_colors: bool, bytes: Option<&[u8]>) -> Arc<Planet> {
    let life = vec![Population {
        per_hectare: 40.0,
        height_m: 6.0,
        height_spread: 0.0,
        lean_deg: 0.0,
        sunk: 0.0,
        clumping: 0.0,
        color_spread: 0.0,
        color: [0.02, 0.6, 0.02],
        form: Form::Mesh(FileMesh { file: "post.glb".to_owned().into(), own_colors, ..FileMesh::default() }),
        ..Population::default()
    }];
    let mut planet = Planet { radius_km: 500.0, life, ..Planet::default() };
    planet.biomes.palette = vec![Biome { color: [0.3; 3], variation: 0.0, ..Biome::default() }];
    planet.biomes.table = Table::uniform('a', 2, 2);
    (planet.biomes.snow, planet.biomes.beach_m) = (false, 0.0);
    let problems = planet.load_pictures_from(|_| bytes.map(<[u8]>::to_vec).ok_or_else(|| "it is missing".to_owned()));
    assert_eq!(problems.is_empty(), bytes.is_some(), "{problems:?}");
    Arc::new(planet)
}

fn post() -> Vec<u8> {
    let lower = block([1.0, 1.0, 1.0], 0.0, [0.6, 0.02, 0.02]);
    glb(&[lower.clone(), Part { color: [0.02, 0.02, 0.6], ..block([1.0, 1.0, 1.0], 1.0, [0.0; 3]) }])
}

/// Colours of the near objects a quarter and three quarters of their height above the ground, without light.
fn colors(planet: &Arc<Planet>) -> [Vec<[f32; 3]>; 2] {
    let camera = camera(planet, 10.0, 20.0, 30.0, 0.0, -40.0);
    let view = View { camera, size_px: SIZE_PX, quality: Quality::Medium };
    let surface = surface_of(planet, &view);
    let sun = camera.position_planet_m.normalize();
    let seen = gpu().radiance(&debug(frame_of(&surface, planet, view, sun), DebugView::Albedo));
    let found = surface.terrain.instances(sun, 120.0).unwrap();
    [0.25, 0.75].map(|share| {
        let pixel = |point_m: glam::DVec3| {
            let rel = camera.planet_from_view.inverse() * (point_m - camera.position_planet_m);
            let tan = (camera.fov_y_rad * 0.5).tan();
            let [wide, high] = SIZE_PX.map(f64::from);
            let x = 0.5 * (1.0 + rel.x / (-rel.z * tan * wide / high)) * wide;
            let y = 0.5 * (1.0 - rel.y / (-rel.z * tan)) * high;
            let inside = rel.z < 0.0 && (1.0..wide - 1.0).contains(&x) && (1.0..high - 1.0).contains(&y);
            inside.then(|| seen[y as usize * SIZE_PX[0] as usize + x as usize])
        };
        let at = |height_m: f64| move |dir: glam::DVec3| dir * (500_000.0 + height_m);
        let near = found.iter().filter_map(|one| {
            let point_m = at(one.base_m + share * one.size_m)(one.dir_planet);
            pixel(point_m).filter(|_| point_m.distance(camera.position_planet_m) < 70.0)
        });
        near.collect()
    })
}

fn share(colors: &[[f32; 3]], wanted: [f32; 3]) -> f64 {
    assert!(colors.len() >= 4, "{}", colors.len());
    let is_near = |color: &&[f32; 3]| color.iter().zip(wanted).all(|(a, b)| (a - b).abs() < 0.04);
    colors.iter().filter(is_near).count() as f64 / colors.len() as f64
}

#[test]
fn objects_have_the_colours_of_their_file() {
    let [low, high] = colors(&planet(true, Some(&post())));
    // Some stand before others.
    assert!(share(&low, [0.6, 0.02, 0.02]) > 0.5, "{low:?}");
    assert!(share(&high, [0.02, 0.02, 0.6]) > 0.7, "{high:?}");
}

#[test]
fn objects_have_the_colours_of_their_population_if_it_asks() {
    let [low, high] = colors(&planet(false, Some(&post())));
    for seen in [low, high] {
        assert!(share(&seen, [0.02, 0.6, 0.02]) > 0.7, "{seen:?}");
    }
}

#[test]
fn a_plain_form_stands_where_the_mesh_is_missing() {
    let [low, high] = colors(&planet(true, None));
    for seen in [low, high] {
        assert!(share(&seen, [0.02, 0.6, 0.02]) > 0.7, "{seen:?}");
    }
}
