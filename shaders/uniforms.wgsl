// Uniforms of every pass: the frame, and the body that the pass draws. Their structs and all constants shared with the
// CPU are generated from src/render/uniforms and src/render/shared.rs. Directions are in the body's frame. Positions
// are in the body's frame and relative to the eye unless a name says otherwise. Lengths are kilometres unless a name
// says metres.
#include "shared.wgsl"

@group(0) @binding(0) var<uniform> frame: Frame;
@group(0) @binding(1) var<uniform> body: Body;
@group(0) @binding(2) var clamped: sampler;
@group(0) @binding(3) var repeated: sampler;
// Depth of objects and of things of a game from the first sun, in maps of several widths
@group(0) @binding(4) var object_shadows: texture_depth_2d_array;
@group(0) @binding(5) var compared: sampler_comparison;

// The sun whose light is being computed. Passes loop over the suns of the scene and call `use_sun` for each.
var<private> active_sun: Sun;
var<private> is_first_sun: bool = true;
// Irradiance of that sun on the air of the sky around a point.
var<private> irradiance_of_sky: vec3f;

fn use_sun(index: u32) {
    active_sun = body.suns[index];
    irradiance_of_sky = active_sun.irradiance;
    is_first_sun = index == 0u;
}

// LUTs hold light for unit irradiance. The only property of a sun that they depend on is its angular radius.
fn set_lut_sun() { active_sun.radius_rad = body.lut_sun_radius_rad; }
