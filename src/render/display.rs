//! The picture in the caller's target (`display.wgsl`): its size, its encoding, dither.

use super::screen_pass::{Input, Scope, ScreenPass, writes};
use super::targets::Target;
use super::variant::Varies;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "display.wgsl",
    scope: Scope::View,
    reads: &[Input::Sample(Target::Picture)],
    writes: &[writes(Target::Output)],
    depth: None,
    varies: Varies::Never,
    runs: |_| true,
};
