//! Time of small pictures: nine variations of a planet, as the editor shows them.

use super::super::headless::Gpu;
use crate::film::Thumbnail;
use crate::lod::opening::opening_place;
use crate::planet::{Planet, random};
use crate::render::Renderer;
use serde_json::{Value, json};
use std::sync::Arc;
use std::time::Instant;

/// Side of the pictures, pixels.
const SIDE_PX: u32 = 224;
/// How far the variations stray.
const STRAY: f64 = 0.25;
const COUNT: u64 = 9;

/// Seconds until nine pictures are drawn with pipelines that are there. `None` without a GPU.
pub(super) fn measure(planet: &Planet) -> Option<Value> {
    let gpu = Gpu::open([SIDE_PX; 2]).ok()?;
    let pipelines = Renderer::new(&gpu.device, &gpu.queue).ok()?;
    let mut secs = Vec::new();
    // In the first run the driver compiles what it has put off.
    for run in 0..2 {
        let mut renderer = pipelines.sibling();
        let begun = Instant::now();
        for number in 0..COUNT {
            let varied = Arc::new(random::vary(planet, run * COUNT + number, STRAY));
            let place = opening_place(planet);
            Thumbnail { planet: varied, like: None, place, time_secs: 0.0, side_px: SIDE_PX }
                .draw(&mut renderer)
                .ok()?;
        }
        secs.push(begun.elapsed().as_secs_f64());
    }
    Some(json!({ "planet": planet.name, "first_secs": secs[0], "secs": secs[1] }))
}
