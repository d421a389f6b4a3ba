// Stars: at most one in each cell of a grid on a cube around the planet, drawn as a soft point as wide as a pixel, so
// that brightness does not depend on the size of the picture.
#include "math.wgsl"

// `share`: share of the cells that have a star.
fn star_layer(dir: vec3f, cells: f32, seed: u32, share: f32, pixel_rad: f32) -> vec3f {
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
    // Few bright stars, many faint ones.
    let magnitude = pow(more.x, 7.0);
    if more.y > share { return vec3f(0.0); }
    let center = cell + 0.2 + 0.6 * r.xy;
    let away = (x - center) * (2.0 / cells) / max(pixel_rad, 0.0006);
    let spot = exp(-dot(away, away) * 1.6);
    let tint = mix(vec3f(1.0, 0.82, 0.66), vec3f(0.72, 0.83, 1.0), r.z);
    // Stars are dimmed where a pixel is wider than a star; otherwise a small picture would be full of blots.
    let dim = clamp(0.0009 / pixel_rad, 0.25, 1.0);
    return tint * (spot * dim * (0.07 + 2.0 * magnitude));
}

// Value noise, 0 to 1.
fn sky_noise(p: vec3f) -> f32 {
    let cell = vec3i(floor(p));
    let f = p - floor(p);
    let u = f * f * (3.0 - 2.0 * f);
    var sum = 0.0;
    for (var i = 0; i < 8; i++) {
        let corner = vec3i(i & 1, (i >> 1u) & 1, i >> 2u);
        let share = mix(1.0 - u, u, vec3f(corner));
        sum += share.x * share.y * share.z * unit_from_hash(hash3(bitcast<vec3u>(cell + corner))).x;
    }
    return sum;
}

// Pole of the galaxy, and the direction of its core, perpendicular to the pole.
const GALAXY_POLE: vec3f = vec3f(0.48, -0.6, 0.64);
const GALAXY_CORE: vec3f = vec3f(0.8, 0.6, -0.0375);

// Closeness of a direction to the plane of the galaxy: 1 in the plane.
fn galaxy_band(dir: vec3f) -> f32 {
    let away = dot(dir, GALAXY_POLE) / 0.2;
    return exp(-away * away);
}

// Glow of unresolved stars, in clouds, with dark dust along the plane.
fn galaxy_glow(dir: vec3f, band: f32) -> vec3f {
    if band < 0.02 { return vec3f(0.0); }
    var clouds = 0.0;
    var share = 0.5;
    var p = dir * 5.0 + 31.0;
    for (var i = 0; i < 4; i++) {
        clouds += share * sky_noise(p);
        share *= 0.5;
        p = p.yzx * 2.3 + 7.0;
    }
    let core = saturate1(0.5 + 0.5 * dot(dir, GALAXY_CORE));
    let lane = dot(dir, GALAXY_POLE) + 0.12 * (clouds - 0.5);
    let dust = 1.0 - 0.75 * exp(-lane * lane * 900.0) * smoothstep(0.3, 0.6, clouds);
    let light = band * (0.25 + 0.75 * core * core) * smoothstep(0.25, 0.75, clouds) * dust;
    return mix(vec3f(0.75, 0.85, 1.0), vec3f(1.0, 0.88, 0.7), core * band) * (0.05 * light);
}

// The plane of the galaxy has about twice as many stars as the rest of the sky.
fn stars(dir: vec3f, pixel_rad: f32) -> vec3f {
    let band = galaxy_band(dir);
    let share = mix(0.2, 0.45, band);
    let bright = star_layer(dir, 60.0, 1u, share, pixel_rad);
    let faint = star_layer(dir.yzx, 130.0, 2u, share, pixel_rad);
    return bright + 0.6 * faint + galaxy_glow(dir, band);
}
