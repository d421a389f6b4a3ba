//! The air of a body (`air.wgsl`): in front of everything that is drawn, with clouds at their distance. The body
//! farthest away has stars and the discs of suns behind it.

use super::screen_pass::{Blend, Input, Output, Scope, ScreenPass, writes};
use super::targets::Target;
use super::variant::Varies;

/// See the module.
pub(crate) const PASS: ScreenPass = ScreenPass {
    shader: "air.wgsl",
    scope: Scope::Body,
    reads: &[
        Input::Load(Target::BeforeAir),
        Input::Depth(Target::Depth),
        Input::Load(Target::CloudLight),
        Input::Load(Target::CloudDistance),
    ],
    writes: &[writes(Target::AfterAir), Output { target: Target::Stars, blend: Blend::Multiply }],
    depth: None,
    varies: Varies::WithNeighbours,
    runs: |work| work.shaded,
};
