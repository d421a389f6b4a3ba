// A triangle that covers the whole target, and the ray through each pixel.
#include "uniforms.wgsl"
#include "math.wgsl"

@vertex
fn screen_vertex(@builtin(vertex_index) index: u32) -> @builtin(position) vec4f {
    let corner = vec2f(f32((index << 1u) & 2u), f32(index & 2u));
    return vec4f(corner * 2.0 - 1.0, 0.0, 1.0);
}

// Whole pixels from where the view axis meets the picture. Parts of a picture agree on it, wherever they are drawn.
fn place_from_axis(pixel: vec2f) -> vec2f {
    let axis = 0.5 * frame.size_px * (1.0 + frame.lens_shift * vec2f(-1.0, 1.0));
    return floor(pixel) - frame.origin_px - round(axis);
}

// Noise from 0 to 1 of which any 3x3 pixels have all values: the jitter of marches (interleaved gradient noise,
// Jimenez, Next Generation Post Processing in Call of Duty: Advanced Warfare, 2014).
fn gradient_noise(pixel: vec2f) -> f32 {
    let place = floor(pixel) - frame.origin_px;
    return fract(52.9829189 * fract(dot(place, vec2f(0.06711056, 0.00583715))) + frame.noise_shift);
}

// Offset in metres from the point `rel_m` of a plane with normal `n` to the point of the plane one pixel away.
// `across`: change of the ray to that pixel, `body.pixel_right` or `body.pixel_up`.
fn pixel_step(rel_m: vec3f, n: vec3f, across: vec3f) -> vec3f {
    let away_m = dot(rel_m, body.view_axis);
    let ray = rel_m / away_m;
    // For a plane seen edge-on the step would be infinite.
    let towards = max(-dot(ray, n), 0.02 * length(ray));
    return away_m * (across + ray * (dot(across, n) / towards));
}

// Distance in km along a ray, from reverse-Z depth; NOTHING_KM where nothing was drawn. `ray_length`: length of the ray
// at unit depth.
fn distance_of(depth: f32, ray_length: f32) -> f32 {
    if depth <= 0.0 { return NOTHING_KM; }
    return frame.near_m / depth * ray_length * 0.001;
}

// Ray through a pixel of the scene, not normalised: its depth (distance along the view axis) is 1.
fn pixel_ray(pixel: vec2f) -> vec3f {
    let ndc = (pixel - frame.origin_px) / frame.size_px * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    return body.ray_center + body.ray_right * ndc.x + body.ray_up * ndc.y;
}
