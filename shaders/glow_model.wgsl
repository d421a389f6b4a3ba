// What the passes of light that air scatters again have in common: directions of the light that a point sees, in tiles
// of a texture. Each tile has the columns and rows of the multiple-scattering LUT. Directions that differ in azimuth
// share much of the work: a fragment draws TURNS_AT_ONCE of them into as many layers, and each row of tiles has as many
// azimuths. As in src/atmosphere/glow.rs.
#include "gather.wgsl"

// Rings of directions of the light that a point sees: those over the horizon first, then two below it. When the sun has
// set, light comes from along the horizon, and there are more of them.
struct Rings {
    // In SEEN_NODES
    first: u32,
    upper: u32,
    count: u32,
    // Places of rings are this power of their nodes.
    power: f32,
}

// At night rings are denser at the horizon. The power grows over the second figure: a cosine of the sun to the zenith,
// negated.
const NIGHT_POWER: f32 = 1.85;
const NIGHT_OVER: f32 = 0.12;

fn rings_under(sun_mu: f32) -> Rings {
    if sun_mu >= 0.0 { return Rings(0u, 4u, 6u, 1.0); }
    return Rings(6u, 7u, 9u, mix(1.0, NIGHT_POWER, saturate1(-sun_mu / NIGHT_OVER)));
}

// Gauss-Legendre nodes between the horizon (0) and zenith or nadir (1), with their weights
const SEEN_NODES: array<vec2f, 15> = array<vec2f, 15>(
    vec2f(0.0694318442, 0.1739274226),
    vec2f(0.3300094782, 0.3260725774),
    vec2f(0.6699905218, 0.3260725774),
    vec2f(0.9305681558, 0.1739274226),
    vec2f(0.2113248654, 0.5),
    vec2f(0.7886751346, 0.5),
    vec2f(0.0254460438, 0.0647424831),
    vec2f(0.1292344072, 0.1398526957),
    vec2f(0.2970774243, 0.1909150253),
    vec2f(0.5000000000, 0.2089795918),
    vec2f(0.7029225757, 0.1909150253),
    vec2f(0.8707655928, 0.1398526957),
    vec2f(0.9745539562, 0.0647424831),
    vec2f(0.2113248654, 0.5),
    vec2f(0.7886751346, 0.5),
);

struct SeenRing {
    // Cosine to the zenith, and share of all directions
    mu: f32,
    share: f32,
    hits: bool,
}

fn seen_ring(h: f32, rings: Rings, number: u32) -> SeenRing {
    let horizon = horizon_cosine(h);
    let hits = number >= rings.upper;
    let span = select(1.0 - horizon, -1.0 - horizon, hits);
    let node = SEEN_NODES[rings.first + number];
    let denser = pow(node.x, rings.power - 1.0);
    return SeenRing(horizon + span * node.x * denser, 0.5 * abs(span) * node.y * rings.power * denser, hits);
}

// Cosines and sines of the azimuths from the sun of the directions: the middles of ninths of half a turn
const SEEN_AZIMUTHS: array<vec2f, SEEN_TURNS> = array<vec2f, SEEN_TURNS>(
    vec2f(0.9848077530, 0.1736481777),
    vec2f(0.8660254038, 0.5000000000),
    vec2f(0.6427876097, 0.7660444431),
    vec2f(0.3420201433, 0.9396926208),
    vec2f(0.0000000000, 1.0000000000),
    vec2f(-0.3420201433, 0.9396926208),
    vec2f(-0.6427876097, 0.7660444431),
    vec2f(-0.8660254038, 0.5000000000),
    vec2f(-0.9848077530, 0.1736481777),
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

// What a fragment draws for each of its azimuths.
struct Turns {
    @location(0) first: vec4f,
    @location(1) second: vec4f,
    @location(2) third: vec4f,
}

fn root_of(light: vec3f) -> vec3f { return sqrt(max(light, vec3f(0.0)) * MULTISCATTER_SCALE); }

// Light of these azimuths. Members, as software drivers are slow at arrays.
struct Lights {
    first: vec3f,
    second: vec3f,
    third: vec3f,
}
