//! Smooth edges (`antialias.wgsl`).

use super::screen_pass::{Input, Scope, ScreenPass, writes};
use super::targets::Target;
use super::variant::Varies;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "antialias.wgsl",
    scope: Scope::View,
    reads: &[Input::Sample(Target::Toned)],
    writes: &[writes(Target::Smoothed)],
    depth: None,
    varies: Varies::Never,
    runs: |work| work.shaded && work.smooth_edges,
};
