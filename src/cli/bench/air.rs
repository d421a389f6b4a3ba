//! What an edit of the air costs on the GPU: a small frame with new tables against the same frame without.

use super::super::headless::Gpu;
use super::{median, repeat};
use crate::lod::{Quality, opening};
use crate::planet::Planet;
use crate::render::{Renderer, Scene};
use crate::tiles::build_now;
use serde_json::{Value, json};
use std::sync::Arc;

/// Small: the tables are as large whatever the picture is.
const SIZE_PX: [u32; 2] = [16, 16];

/// `tables_ms`: median of what making the tables of the air adds to a frame, drawing waited for. Nothing without a GPU or air.
pub(super) fn measure(planet: &Arc<Planet>) -> Option<Value> {
    let gpu = Gpu::open(SIZE_PX).ok()?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).ok()?;
    let view = opening::opening_view(planet, SIZE_PX, Quality::Low);
    let surface = build_now(planet, &view).ok()?;
    let mut planet = Planet::clone(planet);
    planet.atmosphere.as_ref()?;
    let mut times = |change: bool| {
        repeat(|| {
            if let Some(air) = planet.atmosphere.as_mut().filter(|_| change) {
                air.mie_anisotropy = if air.mie_anisotropy > 0.7 { 0.65 } else { 0.75 };
            }
            let scene = Scene::of_planet(&planet, &surface, view, planet.star.place(0.0).direction());
            // What goes wrong here goes wrong for every figure of the GPU.
            let _ = gpu.picture(SIZE_PX, |target| {
                renderer.render(target, &scene).map(drop).map_err(|error| error.to_string())
            });
        })
    };
    // The first frame uploads and makes everything.
    times(false);
    let (with, without) = (median(&times(true))?, median(&times(false))?);
    Some(json!({ "tables_ms": with - without, "frame_ms": without }))
}
