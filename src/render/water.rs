//! The sea of a body (`water.wgsl`): lays an analytic sphere over the ground, and writes radiance and depth of both.

use super::screen_pass::{Input, Scope, ScreenPass, writes};
use super::targets::Target;
use super::variant::Varies;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "water.wgsl",
    scope: Scope::Body,
    reads: &[
        Input::Load(Target::GroundRadiance),
        Input::Depth(Target::GroundDepth),
        Input::Load(Target::GroundSurface),
    ],
    writes: &[writes(Target::Radiance)],
    depth: Some(Target::Depth),
    varies: Varies::WithNearness,
    runs: |work| work.shaded && work.sea,
};
