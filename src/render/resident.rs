//! The memory on the GPU that a renderer holds.

use super::history::CloudHistory;
use super::life::ShadowMap;
use super::renderer::{BodyView, Renderer, ViewResources};

impl Renderer {
    /// Memory on the GPU that the renderer holds now: tiles and LUTs of its bodies, textures of its views, and the
    /// patterns, which siblings share. What the driver and staging take comes on top.
    pub fn resident_bytes(&self) -> u64 {
        let bodies = self
            .bodies
            .values()
            .map(|body| body.tiles.resident_bytes() + body.luts.resident_bytes() + body.models.resident_bytes());
        self.patterns.resident_bytes() + bodies.sum::<u64>() + self.views.values().map(of_view).sum::<u64>()
    }
}

fn of_view(view: &ViewResources) -> u64 {
    let still = view.still.as_ref().map_or(0, |still| still.targets.resident_bytes());
    let bodies: u64 = view.bodies.values().map(of_body).sum();
    view.targets.resident_bytes() + view.bloom.resident_bytes() + still + bodies
}

fn of_body(body: &BodyView) -> u64 {
    let clouds = body.clouds.as_ref().map_or(0, CloudHistory::resident_bytes);
    let shadows = body.shadows.as_ref().map_or(0, ShadowMap::resident_bytes);
    let planting = body.planting.resident_bytes();
    body.ground.resident_bytes() + body.life.resident_bytes() + planting + shadows + clouds
}
