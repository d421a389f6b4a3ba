// First hit of the ray through a pixel, from the depth buffer, and its intersections with the sphere at sea level.
#include "screen.wgsl"
#include "math.wgsl"

@group(2) @binding(0) var scene_color: texture_2d<f32>;
@group(2) @binding(1) var scene_depth: texture_depth_2d;

// Distance in km along the ray of a pixel; NOTHING_KM where nothing was drawn.
fn surface_distance(pixel: vec2i, ray_length: f32) -> f32 {
    return distance_of(textureLoad(scene_depth, pixel, 0), ray_length);
}

// Inverse of `surface_distance`.
fn depth_at(distance_km: f32, ray_length: f32) -> f32 { return frame.near_m * ray_length / (distance_km * 1000.0); }

// Distances in km at which a ray enters and leaves the sphere at sea level; x > y without a hit.
fn sea_hits(dir: vec3f) -> vec2f {
    if body.has_sea == 0u { return vec2f(1.0, -1.0); }
    let h = body.eye_over_sea_km;
    let radius = body.radius_km + body.sea_level_km;
    return ray_sphere((radius + h) * dot(dir, body.eye_up), h * (2.0 * radius + h));
}

// Whether the pass of the clouds has run.
fn has_clouds() -> bool { return any(body.cloud_coverages > vec4f(0.0)); }
