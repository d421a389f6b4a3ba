// A triangle over the whole target, and the ray through each pixel.
#include "globals.wgsl"

@vertex
fn screen_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

// From a pixel to the next one to the right (`half_picture`: `ray_right`) or below (minus `ray_up`) along a plane with normal `n`
// through the point `rel_m`, metres.
fn pixel_step(rel_m: vec3f, n: vec3f, half_picture: vec4f) -> vec3f {
    let away_m = dot(rel_m, globals.ray_forward.xyz);
    let across = half_picture.xyz * (2.0 / half_picture.w);
    let ray = rel_m / away_m;
    // A plane seen nearly along itself would step to infinity.
    let towards = max(-dot(ray, n), 0.02 * length(ray));
    return away_m * (across + ray * (dot(across, n) / towards));
}

// Ray through a pixel of the scene, not normalised: one unit of it is one unit of depth.
fn pixel_ray(pixel: vec2f) -> vec3f {
    let size = vec2f(globals.ray_right.w, globals.ray_up.w);
    let ndc = (pixel / size) * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    return globals.ray_forward.xyz + globals.ray_right.xyz * ndc.x + globals.ray_up.xyz * ndc.y;
}
