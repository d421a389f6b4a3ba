// Light that comes to a point from all directions, for LUTs. Directions are sampled in rings of equal elevation, as in
// src/atmosphere/multiscatter.rs. Radiance jumps at the horizon, so each side of it has its own Gauss-Legendre nodes
// between the horizon (0) and the zenith or nadir (1), with their weights.
#include "light.wgsl"

// Points along half of each ring, a quarter of the ring apart; the other half is its mirror image.
const ASIDE: f32 = 0.70710678;

// The point of a texel of the multiple-scattering LUT: altitude in km, and cosine of the sun to the zenith.
fn point_of_texel(pixel: vec4f) -> vec2f {
    let x = (pixel.xy - 0.5) / (MULTISCATTER_SIZE - 1.0);
    let top = body.air_height_km;
    return vec2f(clamp(x.y * x.y * top, top * 1e-5, top * 0.9999), sun_cosine_at(x.x));
}

struct Ring {
    mu: f32,
    // Share of the sphere of directions for each of the two points
    share: f32,
    // Cosines of both points to the sun
    cosines: vec2f,
    path_km: f32,
    hits: bool,
    // The steps: distance is bent(start + i * step, middle)
    middle: f32,
    start: f32,
    step: f32,
}

fn ring_around(h: f32, sun_mu: f32, node: vec2f, hits: bool, steps: u32) -> Ring {
    let radius = body.radius_km;
    let top = body.air_height_km;
    let horizon = horizon_cosine(h);
    let span = select(1.0 - horizon, -1.0 - horizon, hits);
    let mu = horizon + span * node.x;
    let b = (radius + h) * mu;
    let shell = ray_sphere(b, (h - top) * (2.0 * radius + h + top));
    let path_km = select(shell.y, ray_sphere(b, h * (2.0 * radius + h)).x, hits);
    let ahead = ASIDE * sqrt(1.0 - mu * mu) * sqrt(max(0.0, 1.0 - sun_mu * sun_mu));
    let middle = clamp(-b, 0.0, path_km);
    let start = -sqrt(middle);
    let step = (sqrt(path_km - middle) - start) / f32(steps);
    let share = 0.25 * abs(span) * node.y;
    return Ring(mu, share, mu * sun_mu + vec2f(ahead, -ahead), path_km, hits, middle, start, step);
}

// A step along a ring: its middle, its length, and the altitude of its middle.
struct Part {
    at_km: f32,
    length_km: f32,
    height: f32,
}

// `h`: altitude of the point.
fn part_of(ring: Ring, h: f32, number: u32) -> Part {
    let w = ring.start + f32(number) * ring.step;
    let at_km = bent(w + 0.5 * ring.step, ring.middle);
    let length_km = bent(w + ring.step, ring.middle) - bent(w, ring.middle);
    return Part(at_km, length_km, altitude_along(body.radius_km, h, ring.mu, at_km));
}

// Cosines of the sun to the zenith at distance `t` along both points of a ring.
fn sun_cosines(h: f32, sun_mu: f32, ring: Ring, t: f32, height: f32) -> vec2f {
    let radius = body.radius_km;
    return clamp(((radius + h) * sun_mu + t * ring.cosines) / (radius + height), vec2f(-1.0), vec2f(1.0));
}

// Radiance of the ground in the sun, without light from the sky.
fn sunlit_ground(sun_mu: f32) -> vec3f {
    return body.ground_albedo * sun_transmittance(0.0, sun_mu) * (max(sun_mu, 0.0) / PI);
}
