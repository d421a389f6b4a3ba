// Light that comes to a point from all directions, for LUTs. Directions are sampled in rings of equal elevation, as in
// src/atmosphere/multiscatter.rs. Radiance jumps at the horizon, so each side of it has its own Gauss-Legendre nodes
// between the horizon (0) and the zenith or nadir (1), with their weights.
#include "light.wgsl"

// Cosine of the azimuth from the sun of the middle of the quarter of a ring towards the sun; half a ring is the mirror
// image of the other. Both halves of that quarter: cosines of their middles.
const ASIDE: f32 = 0.70710678;
const EIGHTHS: vec2f = vec2f(0.92387953, 0.38268343);

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
    // Product of the sines of the ring's and the sun's angles to the zenith
    flat: f32,
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
    let flat = sqrt(max(0.0, 1.0 - mu * mu)) * sqrt(max(0.0, 1.0 - sun_mu * sun_mu));
    let middle = clamp(-b, 0.0, path_km);
    let start = -sqrt(middle);
    let step = (sqrt(path_km - middle) - start) / f32(steps);
    let share = 0.25 * abs(span) * node.y;
    return Ring(mu, share, mu * sun_mu + vec2f(ASIDE, -ASIDE) * flat, flat, path_km, hits, middle, start, step);
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
    return body.ground_albedo * sun_beam(0.0, sun_mu) * (max(sun_mu, 0.0) / PI);
}

// Sums over directions that make a Diffuse.
struct Sums {
    mean: vec3f,
    // Cosine to the sun's azimuth on the horizon, times the sine of the sun's zenith angle
    ahead: f32,
    // Square of the cosine to the zenith
    zenith: vec3f,
    // Cosine to the zenith
    up: f32,
    // Second Legendre polynomial of the cosine to the sun
    around: f32,
}

fn sum_of(color: vec3f) -> f32 { return color.r + color.g + color.b; }

// Adds light, times its share of all directions. `mu` and `cosine`: cosines of its direction to the zenith and to the
// sun.
fn add_light(sums: ptr<function, Sums>, light: vec3f, mu: f32, cosine: f32, sun_mu: f32) {
    let all = sum_of(light);
    (*sums).mean += light;
    (*sums).ahead += all * (cosine - mu * sun_mu);
    (*sums).up += all * mu;
    (*sums).around += all * 1.5 * squared(cosine);
    (*sums).zenith += light * squared(mu);
}

// Weight of the second moment in the mean cosine to the sun, where the first one is weighted by the squared sine of the
// sun's zenith angle.
const WEIGHT_OF_SQUARE: f32 = 0.1;

// The light if its mean is another one: what it then has more or less is even. Light from the ground counts in the
// cosine to the sun, but neither in the horizontal part of it, which tells nothing when the sun is at the zenith, nor
// much in the square.
fn light_of(sums: Sums, mean: vec3f, sun_mu: f32) -> Diffuse {
    let all = max(sum_of(mean), 1e-30);
    let by_square = sqrt(clamp(sums.around / all, 0.0, 1.0));
    let weight = 1.0 - sun_mu * sun_mu + WEIGHT_OF_SQUARE;
    let along = clamp((sums.ahead / all + WEIGHT_OF_SQUARE * by_square) / weight, 0.0, 0.95);
    // A colour that all but vanishes can have moments beyond those of any light.
    let zenith = clamp(sums.zenith / max(mean, vec3f(1e-30)), vec3f(squared(0.0)), vec3f(squared(1.0)));
    let up = clamp(sums.up / all, -1.0, 1.0);
    return Diffuse(mean, along, zenith - along * along * squared(sun_mu), up - along * sun_mu);
}

// A texel of the LUT: light scattered any number of times, and scattered once.
struct Texel {
    @location(0) all: vec4f,
    @location(1) all_shape: vec4f,
    @location(2) once: vec4f,
    @location(3) once_shape: vec4f,
}

fn texel_of(all: Diffuse, once: Diffuse) -> Texel {
    return Texel(mean_of(all), vec4f(all.zenith, all.up), mean_of(once), vec4f(once.zenith, once.up));
}

fn mean_of(light: Diffuse) -> vec4f {
    return vec4f(sqrt(max(light.mean, vec3f(0.0)) * MULTISCATTER_SCALE), light.along);
}

fn dark_texel() -> Texel { return Texel(vec4f(0.0), vec4f(0.0), vec4f(0.0), vec4f(0.0)); }
