//! The smallest picture of a planet: no window, one texture.
//!
//! ```sh
//! cargo run --example render -- OUT.png
//! ```

#![allow(clippy::print_stdout)]

mod common;

use common::{Failure, open_gpu, picture_path, save_png, view};
use std::sync::Arc;
use tellus::lod::{Quality, opening};
use tellus::planet::shipped;
use tellus::render::{Metering, Renderer, Scene, texture, wgpu};
use tellus::tiles::build_now;

fn main() -> Result<(), Failure> {
    let (device, queue) = open_gpu()?;
    let mut renderer = Renderer::new(&device, &queue)?;

    let planet = Arc::new(shipped::default_planet());
    let camera_view = opening::opening_view(&planet, [640, 360], Quality::Medium);
    let surface = build_now(&planet, &camera_view)?;
    let sun_dir_planet = planet.star.place(0.0).direction();
    let mut scene = Scene::of_planet(&surface, camera_view, sun_dir_planet);
    scene.post.metering = Metering::Instant;

    let target = texture(&device, "picture", scene.size_px, wgpu::TextureFormat::Rgba8UnormSrgb);
    renderer.render(&view(&target), &scene)?;
    save_png(&device, &queue, &target, &picture_path("tellus_render.png"))
}
