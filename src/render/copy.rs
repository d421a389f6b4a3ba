//! The air stage where there is no air to draw (`copy.wgsl`): debug views and scenes without bodies.

use super::screen_pass::{Blend, Input, Output, Scope, ScreenPass, writes};
use super::targets::Target;
use super::variant::Varies;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "copy.wgsl",
    scope: Scope::View,
    reads: &[Input::Load(Target::BeforeAir)],
    writes: &[writes(Target::AfterAir), Output { target: Target::Stars, blend: Blend::Multiply }],
    depth: None,
    varies: Varies::Never,
    runs: |_| true,
};
