//! Smooth edges (`antialias.wgsl`).

use super::screen_pass::{Input, Scope, ScreenPass, writes};
use super::targets::Target;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "antialias.wgsl",
    scope: Scope::View,
    reads: &[Input::Sample(Target::Toned)],
    writes: &[writes(Target::Smoothed)],
    depth: None,
    by_nearness: false,
    runs: |work| work.shaded && work.smooth_edges,
};
