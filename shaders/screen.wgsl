// A triangle over the whole target, and the ray through each pixel.
#include "globals.wgsl"

@vertex
fn screen_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

// Ray through a pixel of the scene, not normalised: one unit of it is one unit of depth.
fn pixel_ray(pixel: vec2f) -> vec3f {
    let size = vec2f(globals.ray_right.w, globals.ray_up.w);
    let ndc = (pixel / size) * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    return globals.ray_forward.xyz + globals.ray_right.xyz * ndc.x + globals.ray_up.xyz * ndc.y;
}
