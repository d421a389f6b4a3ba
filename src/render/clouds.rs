//! The clouds of a body (`clouds.wgsl`): radiance, transmittance and distance, for the air pass to lay in. While the
//! camera moves, a part of the pixels is marched, and the others are carried over (`cloud_gather.wgsl`).

use super::screen_pass::{Input, Scope, ScreenPass, writes};
use super::targets::Target;
use super::variant::Varies;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "clouds.wgsl",
    scope: Scope::Body,
    reads: &[Input::Load(Target::BeforeAir), Input::Depth(Target::Depth)],
    writes: &[writes(Target::CloudLight), writes(Target::CloudDistance)],
    depth: None,
    varies: Varies::WithNearness,
    runs: |work| work.shaded && work.clouds,
};

/// Puts the clouds of all pixels together.
pub(crate) const GATHER: ScreenPass = ScreenPass {
    shader: "cloud_gather.wgsl",
    scope: Scope::BodyAlone,
    reads: &[
        Input::Depth(Target::Depth),
        Input::Load(Target::MarchedLight),
        Input::Load(Target::MarchedDistance),
        Input::Sample(Target::LightBefore),
        Input::Load(Target::DistanceBefore),
    ],
    writes: &[writes(Target::CloudLight), writes(Target::CloudDistance)],
    depth: None,
    varies: Varies::Never,
    runs: |work| work.shaded && work.clouds && work.carries_clouds,
};
