//! The tone curve (`tonemap.wgsl`): radiance to what a display shows, in the size of the scene.

use super::screen_pass::{Input, Scope, ScreenPass, writes};
use super::targets::Target;
use super::variant::Varies;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "tonemap.wgsl",
    scope: Scope::View,
    reads: &[Input::Load(Target::Composite), Input::Exposure, Input::Load(Target::Stars), Input::Sample(Target::Bloom)],
    writes: &[writes(Target::Toned)],
    depth: None,
    varies: Varies::Never,
    runs: |_| true,
};
