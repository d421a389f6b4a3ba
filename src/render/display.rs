//! The picture in the caller's target (`display.wgsl`): its size, its encoding, dither.

use super::screen_pass::{Input, Scope, ScreenPass, writes};
use super::targets::Target;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "display.wgsl",
    scope: Scope::View,
    reads: &[Input::Sample(Target::Picture)],
    writes: &[writes(Target::Output)],
    depth: None,
    by_nearness: false,
    runs: |_| true,
};
