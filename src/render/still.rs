//! The mean of the frames of a still scene (`still.wgsl`).

use super::screen_pass::{Input, Scope, ScreenPass, writes};
use super::targets::Target;
use super::variant::Varies;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "still.wgsl",
    scope: Scope::View,
    reads: &[
        Input::Sample(Target::Composite),
        Input::Sample(Target::Stars),
        Input::Load(Target::MeanLightBefore),
        Input::Load(Target::MeanStarsBefore),
    ],
    writes: &[writes(Target::MeanLight), writes(Target::MeanStars)],
    depth: None,
    varies: Varies::Never,
    runs: |_| true,
};
