// Litter: what has fallen from objects onto the ground. Near the eye single leaves lie there, in two layers; farther
// away they fade into their mean.

// Cell of the lattice of fallen leaves, metres: one leaf lies in each. Leaves of broadleaf trees, and fronds.
const FALLEN_M: f32 = 0.075;
const FALLEN_FRONDS_M: f32 = 0.28;
// Length of a leaf in cells, least and spread, and its half width as a share of its length.
const FALLEN_LENGTH: vec2f = vec2f(0.95, 0.55);
const FALLEN_WIDTHS: vec2f = vec2f(0.24, 0.14);
// Shade of the ground below the leaves, and of leaves that lie below others.
const HUMUS: f32 = 0.45;
const BELOW: f32 = 0.72;
// Mean of the brightness over the ground, by sampling.
const FALLEN_MEAN: f32 = 0.81;
// How leaves differ in colour: from fresh and yellow to old and grey.
const FALLEN_HUES: vec3f = vec3f(0.34, 0.22, -0.02);
// Slope at the rim of a leaf that is bent.
const FALLEN_BENT: f32 = 0.7;

// Share of the ground that the leaves of one layer cover where they lie everywhere.
const LAYER_COVER: f32 = 0.54;

// Fallen leaves at a pixel.
struct FallenLeaves {
    // Factor on the albedo, with mean 1
    tint: vec3f,
    // Share of the pixel that they cover, where single ones are told
    cover: f32,
    // Slope along the axes of the lattice
    slope: vec2f,
    // How far single leaves are told, 0 to 1
    clear: f32,
}

// The uppermost leaf of a layer over a place: its brightness (x, 0 without one), its hue (y), and its slope (zw).
// `cells`: cells of the wrapped length; `share`: share of them with a leaf.
fn fallen_leaf(q: vec2f, cells: f32, share: f32, layer: u32) -> vec4f {
    var found = vec4f(0.0);
    var highest = -1.0;
    let first = floor(q - 1.0);
    for (var i = 0; i < 9; i++) {
        let cell = first + vec2f(f32(i % 3), f32(i / 3));
        let wrapped = cell - cells * floor(cell / cells);
        let random = unit_from_hash(hash3(vec3u(vec2u(wrapped), layer)));
        if random.z <= highest || fract(random.z * 211.0) > share { continue; }
        let away = q - cell - random.xy;
        let turn = 6.2832 * fract(random.z * 37.0);
        let axis = vec2f(cos(turn), sin(turn));
        let length = 0.5 * (FALLEN_LENGTH.x + FALLEN_LENGTH.y * fract(random.x * 53.0));
        let along = dot(away, axis) / length;
        let across = (away.y * axis.x - away.x * axis.y) / length;
        // Broadest before the middle, pointed at the tip.
        let width = 2.0 * (FALLEN_WIDTHS.x + FALLEN_WIDTHS.y * fract(random.y * 71.0))
            * (1.0 - along * along) * (1.0 - 0.35 * along);
        if abs(along) >= 1.0 || abs(across) >= width { continue; }
        highest = random.z;
        let rib = smoothstep(0.0, 0.05, abs(across));
        let brightness = (0.62 + 0.76 * fract(random.z * 113.0)) * mix(0.82, 1.0, rib);
        let bent = FALLEN_BENT * (fract(random.x * 29.0) - 0.3) * across / max(width, 1e-3);
        found = vec4f(brightness, fract(random.y * 19.0) - 0.5, vec2f(-axis.y, axis.x) * bent);
    }
    return found;
}

// `kind`: material of the objects that most has fallen from; `share`: share of the ground that it covers; `at_m`: the
// wrapped position; `footprint_m`: width of a pixel, the mean of its sides.
fn fallen_leaves(kind: u32, share: f32, at_m: vec2f, footprint_m: f32) -> FallenLeaves {
    var out = FallenLeaves(vec3f(1.0), share, vec2f(0.0), 0.0);
    if kind != LEAFY && kind != FRONDED { return out; }
    let cells = round(WRAP_M / select(FALLEN_M, FALLEN_FRONDS_M, kind == FRONDED));
    let q = at_m * (cells / WRAP_M);
    out.clear = 1.0 - smoothstep(0.12, 0.5, footprint_m * cells / WRAP_M);
    if out.clear <= 0.0 { return out; }
    var leaf = fallen_leaf(q, cells, share, 0u);
    if leaf.x <= 0.0 { leaf = fallen_leaf(q + 0.5, cells, share, 1u) * vec4f(BELOW, vec3f(1.0)); }
    // What lies between them, so that the mean of the cover is the share.
    let open = (1.0 - LAYER_COVER * share) * (1.0 - LAYER_COVER * share);
    out.cover = mix(share, select(max(share - 1.0 + open, 0.0) / open, 1.0, leaf.x > 0.0), out.clear);
    leaf.x = select(HUMUS, leaf.x, leaf.x > 0.0);
    out.tint = mix(vec3f(1.0), leaf.x / FALLEN_MEAN * (1.0 + leaf.y * FALLEN_HUES), out.clear);
    out.slope = leaf.zw * out.clear;
    return out;
}
