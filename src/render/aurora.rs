//! The aurora of a body (`aurora.wgsl`), over its air.

use super::screen_pass::{Blend, Input, Output, Scope, ScreenPass};
use super::targets::Target;
use super::variant::Varies;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "aurora.wgsl",
    scope: Scope::Body,
    reads: &[Input::Load(Target::BeforeAir), Input::Depth(Target::Depth), Input::Load(Target::CloudLight)],
    writes: &[Output { target: Target::AfterAir, blend: Blend::Add }],
    depth: None,
    varies: Varies::Never,
    runs: |work| work.shaded && work.aurora,
};
