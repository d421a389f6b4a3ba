// Uniforms of every pass: the frame, and the body that the pass draws. Their structs and all constants that the CPU shares are
// generated from src/render/uniforms and src/render/shared.rs. Directions and positions are in the body's frame, relative to
// the eye unless a name says otherwise; lengths are kilometres unless a name says metres.
#include "shared.wgsl"

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<uniform> body: Body;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(3) var repeated: sampler;

// The sun whose light is computed now. Passes loop over the suns of the scene and call `use_sun` for each.
var<private> active_sun: Sun;
var<private> is_first_sun: bool = true;

fn use_sun(index: u32) {
    active_sun = body.suns[index];
    is_first_sun = index == 0u;
}

// LUTs hold light per unit irradiance: of a sun they know the angular radius alone.
fn set_lut_sun() { active_sun.radius_rad = body.lut_sun_radius_rad; }
