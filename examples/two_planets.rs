//! Two planets in one picture, one behind the other: a second planet is a second entry in the scene's list.
//!
//! ```sh
//! cargo run --example two_planets -- OUT.png
//! ```

#![allow(clippy::print_stdout)]

mod common;

use common::{Failure, open_gpu, picture_path, save_png, view};
use std::sync::Arc;
use tellus::glam::{DQuat, DVec3};
use tellus::lod::Quality;
use tellus::planet::{Planet, shipped};
use tellus::render::{Body, BodyId, Metering, Projection, Renderer, Scene, Sun, texture, wgpu};
use tellus::tiles::build_now;

const SIZE_PX: [u32; 2] = [960, 540];

fn main() -> Result<(), Failure> {
    let (device, queue) = open_gpu()?;
    let mut renderer = Renderer::new(&device, &queue)?;

    // Scene space is the camera's own: x to the right, y up, the picture along -z.
    let projection = Projection::symmetric(40_f64.to_radians(), f64::from(SIZE_PX[0]) / f64::from(SIZE_PX[1]));
    let mut scene = Scene::new(DQuat::IDENTITY, projection, SIZE_PX, Quality::Medium);
    let near = Arc::new(load("cinnabar.ron")?);
    let far = Arc::new(load("aurel.ron")?);
    // The planets' north poles are up; each is turned until a side worth seeing faces the camera.
    let turned = |degrees: f64| {
        DQuat::from_rotation_x(-std::f64::consts::FRAC_PI_2) * DQuat::from_rotation_z(degrees.to_radians())
    };
    let placed = [
        (BodyId(1), &near, DVec3::new(-0.9, -0.3, -3.9) * near.radius_m(), turned(60.0)),
        (BodyId(2), &far, DVec3::new(0.35, 0.25, -5.2) * far.radius_m(), turned(-70.0)),
    ];

    let mut surfaces = Vec::new();
    for (_, planet, position_m, scene_from_body) in &placed {
        surfaces.push(build_now(planet, &scene.view_of(*position_m, *scene_from_body))?);
    }
    scene.suns.push(Sun::new(&far.star, DVec3::new(-0.75, 0.35, 0.55)));
    for ((id, _, position_m, scene_from_body), surface) in placed.iter().zip(&surfaces) {
        let mut body = Body::new(*id, surface, *position_m);
        body.scene_from_body = *scene_from_body;
        scene.bodies.push(body);
    }
    scene.post.metering = Metering::Instant;

    let target = texture(&device, "picture", SIZE_PX, wgpu::TextureFormat::Rgba8UnormSrgb);
    renderer.render(&view(&target), &scene)?;
    save_png(&device, &queue, &target, &picture_path("tellus_two_planets.png"))
}

fn load(file: &str) -> Result<Planet, Failure> {
    let preset = shipped::ALL.iter().find(|preset| preset.file == file);
    Ok(preset.ok_or_else(|| format!("{file} is not a shipped preset"))?.load()?)
}
