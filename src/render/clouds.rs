//! The clouds of a body (`clouds.wgsl`): radiance, transmittance and distance, for the air pass to lay in.

use super::screen_pass::{Input, Scope, ScreenPass, writes};
use super::targets::Target;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "clouds.wgsl",
    scope: Scope::Body,
    reads: &[Input::Load(Target::BeforeAir), Input::Depth(Target::Depth)],
    writes: &[writes(Target::CloudLight), writes(Target::CloudDistance)],
    depth: None,
    by_nearness: true,
    runs: |work| work.shaded && work.clouds,
};
