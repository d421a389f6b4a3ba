// What the passes of light that air scatters again have in common: directions of the light that a point sees, in tiles
// of a texture. Each tile has the columns and rows of the multiple-scattering LUT. Directions that differ in azimuth
// share much of the work: a fragment draws TURNS_AT_ONCE of them into as many layers, and the two rows of tiles have
// the halves of all azimuths. As in src/atmosphere/glow.rs.
#include "gather.wgsl"

const SEEN_UPPER: u32 = 5u;
// Gauss-Legendre nodes between the horizon (0) and zenith or nadir (1), with their weights
const SEEN_NODES: array<vec2f, SEEN_RINGS> = array<vec2f, SEEN_RINGS>(
    vec2f(0.0469100770, 0.1184634425),
    vec2f(0.2307653449, 0.2393143352),
    vec2f(0.5, 0.2844444444),
    vec2f(0.7692346551, 0.2393143352),
    vec2f(0.9530899230, 0.1184634425),
    vec2f(0.2113248654, 0.5),
    vec2f(0.7886751346, 0.5),
);

// Cosine of the sun to the zenith, negated, from which on moments replace the sums: in the planet's shadow, light comes
// from a part of the sky that is narrower than the directions are apart. Over the second figure, both are mixed.
const SHADOW: f32 = 0.05;
const SHADOW_BLEND: f32 = 0.03;

fn share_of_moments(sun_mu: f32) -> f32 { return saturate1((-SHADOW - sun_mu) / SHADOW_BLEND); }

struct SeenRing {
    // Cosine to the zenith, and share of all directions
    mu: f32,
    share: f32,
    hits: bool,
}

fn seen_ring(h: f32, number: u32) -> SeenRing {
    let horizon = horizon_cosine(h);
    let hits = number >= SEEN_UPPER;
    let span = select(1.0 - horizon, -1.0 - horizon, hits);
    let node = SEEN_NODES[number];
    return SeenRing(horizon + span * node.x, 0.5 * abs(span) * node.y, hits);
}

// Cosines and sines of the azimuths from the sun of the directions: the middles of sixths of half a turn
const SEEN_AZIMUTHS: array<vec2f, 6> = array<vec2f, 6>(
    vec2f(0.9659258263, 0.2588190451),
    vec2f(0.7071067812, 0.7071067812),
    vec2f(0.2588190451, 0.9659258263),
    vec2f(-0.2588190451, 0.9659258263),
    vec2f(-0.7071067812, 0.7071067812),
    vec2f(-0.9659258263, 0.2588190451),
);

fn flat_of(mu: f32) -> f32 { return sqrt(max(0.0, 1.0 - mu * mu)); }

// Pixel of the multiple-scattering LUT of a pixel of a texture of tiles, and the number of its tile.
struct Tiled {
    pixel: vec4f,
    tile: vec2u,
}

fn tiled(pixel: vec4f) -> Tiled {
    let tile = floor(pixel.xy / MULTISCATTER_SIZE);
    return Tiled(vec4f(pixel.xy - tile * MULTISCATTER_SIZE, 0.0, 1.0), vec2u(tile));
}

// Square roots of the light of the azimuths that a fragment draws, as in the multiple-scattering LUT.
struct Turns {
    @location(0) first: vec4f,
    @location(1) second: vec4f,
    @location(2) third: vec4f,
}

fn root_of(light: vec3f) -> vec4f { return vec4f(sqrt(max(light, vec3f(0.0)) * MULTISCATTER_SCALE), 1.0); }

fn turns_of(light: Lights) -> Turns { return Turns(root_of(light.first), root_of(light.second), root_of(light.third)); }

// Light of these azimuths. Members, as software drivers are slow at arrays.
struct Lights {
    first: vec3f,
    second: vec3f,
    third: vec3f,
}
