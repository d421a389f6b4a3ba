//! The cost of a frame on the GPU, and of its parts: the same frame with and without each.

use super::super::headless::Gpu;
use super::{median, repeat};
use crate::lod::{Camera, Quality, View, opening};
use crate::planet::Planet;
use crate::render::{Renderer, Reuse, Scene};
use crate::tiles::build_now;
use serde_json::{Value, json};
use std::f64::consts::FRAC_PI_2;
use std::sync::Arc;

/// Size of the frames.
pub(super) const SIZE_PX: [u32; 2] = [640, 360];
/// Height of the near view.
const NEAR_M: f64 = 12_000.0;
pub(super) const QUALITIES: [(&str, Quality); 3] =
    [("low", Quality::Low), ("medium", Quality::Medium), ("high", Quality::High)];

/// A list of frames: the opening view and one from 12 km at each quality. `frame_ms`, and the part of it that clouds,
/// sea and air take; `moving_ms`, a frame of a camera that moves, with clouds carried over. `None` without a GPU.
pub(super) fn measure(planet: &Planet) -> Option<Value> {
    let gpu = Gpu::open(SIZE_PX).ok()?;
    let mut frames = Vec::new();
    for (name, quality) in QUALITIES {
        for pose in ["orbit", "12 km"] {
            let place = opening::opening_place(planet);
            let far = opening::opening_view(planet, SIZE_PX, quality);
            let near = planet.radius_m() + NEAR_M;
            let camera = match pose {
                "orbit" => far.camera,
                _ => Camera::over(place, near, FRAC_PI_2, -0.25, Camera::DEFAULT_FOV_Y_RAD),
            };
            let view = View { camera, ..far };
            let frame_ms = frame_ms_of(&gpu, planet, view, Reuse::None)?;
            let without = |part: &dyn Fn(&mut Planet)| {
                let mut less = planet.clone();
                part(&mut less);
                frame_ms_of(&gpu, &less, view, Reuse::None).map(|ms| frame_ms - ms)
            };
            frames.push(json!({
                "quality": name,
                "view": pose,
                "frame_ms": frame_ms,
                "moving_ms": frame_ms_of(&gpu, planet, view, Reuse::Moving)?,
                "clouds_ms": without(&|planet| planet.clouds = None),
                "sea_ms": without(&|planet| planet.water = None),
                "air_ms": without(&|planet| planet.atmosphere = None),
            }));
        }
    }
    Some(json!(frames))
}

/// Milliseconds of a frame, with drawing waited for and the picture read back.
fn frame_ms_of(gpu: &Gpu, planet: &Planet, view: View, reuse: Reuse) -> Option<f64> {
    let planet = Arc::new(planet.clone());
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).ok()?;
    let surface = build_now(&planet, &view).ok()?;
    let sun = planet.star.place(0.0).direction();
    let mut draw = || {
        let mut scene = Scene::of_planet(&surface, view, sun);
        scene.reuse = reuse;
        // An error here shows in every figure of the GPU.
        let _ =
            gpu.picture(SIZE_PX, |target| renderer.render(target, &scene).map(drop).map_err(|error| error.to_string()));
    };
    // The first frame uploads and builds everything.
    draw();
    median(&repeat(draw))
}
