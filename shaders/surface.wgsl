// What the ray through a pixel meets first: terrain (from depth) or the analytic sphere of the sea.
#include "screen.wgsl"
#include "math.wgsl"

@group(2) @binding(0) var scene_color: texture_2d<f32>;
@group(2) @binding(1) var scene_depth: texture_depth_2d;

// Distance to the terrain in km along a ray of length `ray_length` at unit depth; NOTHING_KM for none.
fn terrain_distance(pixel: vec2i, ray_length: f32) -> f32 {
    let depth = textureLoad(scene_depth, pixel, 0);
    if depth <= 0.0 { return NOTHING_KM; }
    return globals.eye_high_m.w / depth * ray_length * 0.001;
}

// Near and far distance to the sea's sphere, far < near for none.
fn sea_hits(dir: vec3f) -> vec2f {
    if globals.water_absorption.w <= 0.0 { return vec2f(1.0, -1.0); }
    let h = globals.water.y;
    let radius = globals.eye_km.w + globals.water.x;
    return ray_sphere((radius + h) * dot(dir, globals.eye_up.xyz), h * (2.0 * radius + h));
}

fn surface_distance(pixel: vec2i, dir: vec3f, ray_length: f32) -> f32 {
    let terrain = terrain_distance(pixel, ray_length);
    let sea = sea_hits(dir);
    return select(terrain, min(terrain, sea.x), sea.y >= sea.x && sea.x > 0.0);
}
