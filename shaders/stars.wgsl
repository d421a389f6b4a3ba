// Stars: one to a cell of a grid on a cube around the planet, a soft point as wide as a pixel, so that they stay as
// bright when the picture is larger or smaller.
#include "math.wgsl"

fn star_layer(dir: vec3f, cells: f32, seed: u32, pixel_rad: f32) -> vec3f {
    let a = abs(dir);
    var axis = 0u;
    var p = vec3f(dir.y, dir.z, dir.x);
    if a.y > a.x && a.y >= a.z { axis = 1u; p = vec3f(dir.z, dir.x, dir.y); }
    else if a.z > a.x && a.z > a.y { axis = 2u; p = vec3f(dir.x, dir.y, dir.z); }
    let face = axis * 2u + select(0u, 1u, p.z < 0.0);
    let x = (p.xy / abs(p.z) * 0.5 + 0.5) * cells;
    let cell = floor(x);
    let bits = hash3(vec3u(vec2u(cell), face * 977u + seed));
    let r = unit_from_hash(bits);
    let more = unit_from_hash(hash3(bits));
    // Few bright, many faint.
    let magnitude = pow(more.x, 7.0);
    if more.y > 0.3 { return vec3f(0.0); }
    let place = cell + 0.2 + 0.6 * r.xy;
    let away = (x - place) * (2.0 / cells) / max(pixel_rad, 0.0006);
    let spot = exp(-dot(away, away) * 1.6);
    let tint = mix(vec3f(1.0, 0.82, 0.66), vec3f(0.72, 0.83, 1.0), r.z);
    // A pixel that is wider than a star dims it, or a small picture would be full of blots.
    let dim = clamp(0.0009 / pixel_rad, 0.25, 1.0);
    return tint * (spot * dim * (0.014 + 0.8 * magnitude));
}

fn stars(dir: vec3f, pixel_rad: f32) -> vec3f {
    return star_layer(dir, 60.0, 1u, pixel_rad) + 0.6 * star_layer(dir.yzx, 130.0, 2u, pixel_rad);
}
