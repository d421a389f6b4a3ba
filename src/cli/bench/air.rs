//! The cost on the GPU of an edit of the air: a small frame with new LUTs, against the same frame without.

use super::super::headless::Gpu;
use super::{median, repeat};
use crate::lod::{Quality, opening};
use crate::planet::Planet;
use crate::render::{Renderer, Scene};
use crate::terrain::Revision;
use crate::tiles::build_now;
use serde_json::{Value, json};
use std::sync::Arc;

/// Small: the LUTs have the same size whatever the picture is.
const SIZE_PX: [u32; 2] = [16, 16];

/// `tables_ms`: the median time that new LUTs of scattered light add to a frame, with drawing waited for; `draft_ms`:
/// the same for drafts, while a slider is held. `None` without a GPU or air.
pub(super) fn measure(planet: &Arc<Planet>) -> Option<Value> {
    let gpu = Gpu::open(SIZE_PX).ok()?;
    let mut renderer = Renderer::new(&gpu.device, &gpu.queue).ok()?;
    let view = opening::opening_view(planet, SIZE_PX, Quality::Low);
    let surface = build_now(planet, &view).ok()?;
    let mut planet = Planet::clone(planet);
    planet.atmosphere.as_ref()?;
    let mut times = |change: bool, drafts: bool| {
        repeat(|| {
            if let Some(air) = planet.atmosphere.as_mut().filter(|_| change) {
                air.ground_albedo = if air.ground_albedo[0] > 0.3 { [0.25; 3] } else { [0.35; 3] };
            }
            let Ok(revision) = Revision::try_new(Arc::new(planet.clone())) else { return };
            let mut scene = Scene::of_revision(revision, &surface, view, planet.star.place(0.0).direction());
            scene.drafts = drafts;
            // An error here shows in every figure of the GPU.
            let _ = gpu.picture(SIZE_PX, |target| {
                renderer.render(target, &scene).map(drop).map_err(|error| error.to_string())
            });
        })
    };
    // The first frame uploads and builds everything.
    times(false, false);
    let (whole, draft) = (median(&times(true, false))?, median(&times(true, true))?);
    let without = median(&times(false, true))?;
    Some(json!({ "tables_ms": whole - without, "draft_ms": draft - without, "frame_ms": without }))
}
