// Material of objects near the eye: furrows of bark, grain and cracks of rock, single leaves. All are functions of the
// place in the form, in metres, whose tint has a mean of 1; each fades as it becomes narrower than a pixel.
#include "math.wgsl"
#include "shared.wgsl"

// Period of furrows around a trunk and along it, metres; depth of a furrow as a share of it.
const FURROW_M: vec2f = vec2f(0.075, 0.75);
const FURROW_DEPTH: f32 = 0.15;
// Width of a furrow, as a share of the way from one plate to the next.
const FURROW_WIDTH: f32 = 0.3;
// Period of the stains of bark along a trunk, metres.
const STAIN_M: f32 = 0.9;
// Periods of the grain of rock, metres, and its height as a share of the period.
const GRAIN_M: vec3f = vec3f(0.45, 0.13, 0.035);
const GRAIN_HEIGHT: f32 = 0.10;
// Widths of the faces along which rock broke, as shares of its height, and how far they are turned.
const FACES: vec2f = vec2f(0.34, 0.12);
const FACE_TILTS: vec2f = vec2f(0.45, 0.35);
// Width of a leaf, metres.
const LEAF_M: f32 = 0.09;
// How leaves and twigs of one object differ in colour.
const LEAF_TINTS: vec3f = vec3f(0.45, 0.40, 0.25);
// How the blades of a tuft differ in colour.
const BLADE_TINTS: vec3f = vec3f(1.0, 0.7, 0.4);
// Distance from one needle to the next, and width of a twig with needles, metres.
const NEEDLES_M: f32 = 0.014;
const TWIG_M: f32 = 0.18;
// Width of a cluster in pixels, at the least, and as a share of the height of the object, at the most.
const CLUSTER_PIXELS: f32 = 3.0;
const WIDEST_CLUSTER: f32 = 0.055;

struct ObjectMaterial {
    // Factor on the albedo
    tint: vec3f,
    // Height of the surface over that of the mesh, metres
    height_m: f32,
    // Tilt of a leaf against its twig, of a face of rock against the mesh
    tilt: vec3f,
    // Share of a leaf that is gap
    gap: f32,
}

const PLAIN: ObjectMaterial = ObjectMaterial(vec3f(1.0), 0.0, vec3f(0.0), 0.0);
// Means of `plates`, of cracks, and of the darkness at the edge of a leaf where it is not cut out: by sampling.
const PLATES_MEAN: f32 = 0.55;
const CRACKS_MEAN: f32 = 0.14;
const EDGE_MEAN: f32 = 0.05;

fn lattice_value(cell: vec3i) -> f32 { return unit_from_hash(hash3(vec3u(cell))).x; }

// Smooth noise of mean 0.5 with cells of length 1.
fn lattice_noise(p: vec3f) -> f32 {
    let cell = vec3i(floor(p));
    let f = smoothstep(vec3f(0.0), vec3f(1.0), p - floor(p));
    var rows: array<f32, 4>;
    for (var i = 0; i < 4; i++) {
        let at = cell + vec3i(0, i & 1, i >> 1u);
        rows[i] = mix(lattice_value(at), lattice_value(at + vec3i(1, 0, 0)), f.x);
    }
    return mix(mix(rows[0], rows[1], f.y), mix(rows[2], rows[3], f.y), f.z);
}

// The cell about a point, one for each cube of a lattice of length 1, that a place lies in.
struct NearestCell {
    random: vec3f,
    // Square of the distance to the point
    distance2: f32,
}

fn nearest_cell(q: vec3f) -> NearestCell {
    let first = floor(q - 0.5);
    var found = NearestCell(vec3f(0.5), 9.0);
    for (var i = 0; i < 8; i++) {
        let cell = first + vec3f(f32(i & 1), f32((i >> 1u) & 1), f32(i >> 2u));
        let random = unit_from_hash(hash3(vec3u(vec3i(cell))));
        let away = q - cell - 0.25 - 0.5 * random;
        let distance2 = dot(away, away);
        if distance2 < found.distance2 { found = NearestCell(random, distance2); }
    }
    return found;
}

// How well a pattern of a period is seen at a width of the pixel.
fn clear_at(period_m: f32, pixel_m: f32) -> f32 { return 1.0 - smoothstep(0.15, 0.5, pixel_m / period_m); }

// Plates of bark, cells about points of a lattice of length 1 whose columns are shifted against one another: 0 in the
// furrows between them, 1 on them (x); a random number of the plate (y).
fn plates(q: vec3f) -> vec2f {
    let first = floor(q.xy - 0.5);
    var nearest = vec2f(9.0);
    var found = 0.5;
    for (var i = 0; i < 8; i++) {
        let column = first + vec2f(f32(i & 1), f32((i >> 1u) & 1));
        let z = q.z - lattice_value(vec3i(vec2i(column), 0));
        let cell = vec3f(column, floor(z - 0.5) + f32(i >> 2u));
        let random = unit_from_hash(hash3(vec3u(vec3i(cell))));
        let away = vec3f(q.xy, z) - cell - 0.25 - 0.5 * random;
        let distance = dot(away, away);
        if distance < nearest.x {
            nearest = vec2f(distance, nearest.x);
            found = random.x;
        } else {
            nearest.y = min(nearest.y, distance);
        }
    }
    return vec2f(smoothstep(0.03, FURROW_WIDTH, sqrt(nearest.y) - sqrt(nearest.x)), found);
}

fn bark(p_m: vec3f, pixel_m: f32) -> ObjectMaterial {
    var out = PLAIN;
    let bend = 0.12 * (lattice_noise(p_m * vec3f(5.3, 5.3, 2.3)) - 0.5);
    let stain = lattice_noise(p_m / vec3f(0.5, 0.5, 1.0) / STAIN_M) - 0.5;
    out.tint = 1.0 + stain * vec3f(0.38, 0.30, 0.34);
    for (var i = 0; i < 2; i++) {
        let period_m = FURROW_M * select(1.0, 0.4, i == 1);
        let clear = clear_at(period_m.x, pixel_m);
        if clear <= 0.0 { break; }
        let at = (p_m + bend) / period_m.xxy + 31.0 * f32(i);
        let plate = plates(at);
        // Plates differ, and are rough along their length.
        let rough = lattice_noise(at * vec3f(3.7, 3.7, 1.9)) - 0.5;
        let height = plate.x - PLATES_MEAN + 0.35 * rough;
        out.tint *= 1.0 + clear * select(0.7, 0.4, i == 1) * (height + 0.4 * (plate.y - 0.5));
        out.height_m += clear * FURROW_DEPTH * period_m.x * height;
    }
    return out;
}

fn rock(p_m: vec3f, size_m: f32, pixel_m: f32) -> ObjectMaterial {
    var out = PLAIN;
    var shade = 1.0;
    for (var i = 0; i < 3; i++) {
        let period_m = min(GRAIN_M[i], 0.5 * size_m / f32(1 + 2 * i));
        let clear = clear_at(period_m, pixel_m);
        if clear <= 0.0 { break; }
        let noise = lattice_noise(p_m / period_m + 17.0 * f32(i)) - 0.5;
        // Cracks between grains of the widest period.
        let crack = select(0.0, 1.0 - smoothstep(0.0, 0.07, abs(noise)) - CRACKS_MEAN, i == 0);
        shade *= 1.0 + clear * (0.55 * noise - 0.35 * crack);
        out.height_m += clear * GRAIN_HEIGHT * period_m * (noise - 0.25 * crack);
    }
    // Faces along which it broke: each is turned a little.
    for (var i = 0; i < 2; i++) {
        let width_m = FACES[i] * size_m;
        let clear = clear_at(width_m, pixel_m);
        if clear <= 0.0 { break; }
        let bend = 0.3 * (lattice_noise(p_m / (0.7 * width_m) + 3.0) - 0.5);
        out.tilt += clear * FACE_TILTS[i] * (nearest_cell(p_m / width_m + bend).random - 0.5);
    }
    // Lichen and weather stain the stone.
    let stain = lattice_noise(p_m / (0.35 * max(size_m, 0.6)) + 5.0) - 0.5;
    out.tint = shade * (1.0 + stain * vec3f(0.26, 0.23, 0.17));
    return out;
}

// Leaves of one width: cells about points, one for each leaf.
fn leaves_of(width_m: f32, p_m: vec3f) -> ObjectMaterial {
    let cell = nearest_cell(p_m / width_m);
    let found = cell.random;
    let nearest = cell.distance2;
    let edge = smoothstep(0.10, 0.45, nearest);
    let tint = 1.0 + LEAF_TINTS * (found.x - 0.5) + 0.25 * (EDGE_MEAN - edge);
    return ObjectMaterial(tint, 0.0, found - 0.5, smoothstep(0.10, 0.30, nearest));
}

// Leaves on the blades of a crown, which are wider than leaves: single ones near the eye, farther away clusters that
// are some pixels wide, as far as they are narrower than blades.
fn leaves(p_m: vec3f, size_m: f32, pixel_m: f32) -> ObjectMaterial {
    let octave = log2(max(CLUSTER_PIXELS * pixel_m / LEAF_M, 1.0));
    let width_m = LEAF_M * exp2(floor(octave));
    let clear = 1.0 - smoothstep(0.5, 1.0, 0.5 * LEAF_M * exp2(octave) / (WIDEST_CLUSTER * size_m));
    if clear <= 0.0 { return PLAIN; }
    let fine = leaves_of(width_m, p_m);
    let coarse = leaves_of(2.0 * width_m, p_m);
    let share = fract(octave);
    return ObjectMaterial(
        mix(vec3f(1.0), mix(fine.tint, coarse.tint, share), clear), 0.0,
        clear * mix(fine.tilt, coarse.tilt, share), clear * mix(fine.gap, coarse.gap, share),
    );
}

// Needles on the blades of a conifer, which are boughs: strokes that lie side by side along each twig, some pixels
// apart. They stand so close that gaps show near the eye alone.
fn needles(p_m: vec3f, pixel_m: f32) -> ObjectMaterial {
    let clear = 1.0 - smoothstep(0.012, 0.035, pixel_m);
    if clear <= 0.0 { return PLAIN; }
    let turn = leaves_of(TWIG_M, p_m).tilt;
    let octave = log2(max(CLUSTER_PIXELS * pixel_m / NEEDLES_M, 1.0));
    let across = dot(p_m, normalize(turn + vec3f(0.013, 0.007, 0.011))) / (NEEDLES_M * exp2(floor(octave)));
    let waves = abs(fract(vec2f(across, 0.5 * across)) - 0.5) * 2.0;
    let gaps = smoothstep(vec2f(0.4), vec2f(0.8), waves);
    let tint = 1.0 + clear * LEAF_TINTS * turn.x;
    return ObjectMaterial(tint, 0.0, 0.5 * clear * turn, clear * mix(gaps.x, gaps.y, fract(octave)));
}

// Blades of a tuft: stains that differ from blade to blade, and a fine grain along them.
fn blades(p_m: vec3f, size_m: f32, pixel_m: f32) -> ObjectMaterial {
    var out = PLAIN;
    let clear = clear_at(0.1 * size_m, pixel_m);
    if clear <= 0.0 { return out; }
    let stain = lattice_noise(p_m / (0.16 * size_m)) - 0.5;
    let fine = lattice_noise(p_m * vec3f(1.0, 1.0, 0.3) / (0.03 * size_m)) - 0.5;
    out.tint = 1.0 + clear * (stain * BLADE_TINTS + 0.35 * fine);
    return out;
}

// Widths of shoots of moss and of the groups they stand in, metres.
const SHOOT_M: f32 = 0.014;
const SHOOTS_M: f32 = 0.06;

// Moss: soft shoots with dark gaps, in groups of different greens.
fn moss(p_m: vec3f, pixel_m: f32) -> ObjectMaterial {
    let clear = vec2f(clear_at(2.0 * SHOOT_M, pixel_m), clear_at(2.0 * SHOOTS_M, pixel_m));
    if clear.y <= 0.0 { return PLAIN; }
    let group = nearest_cell(p_m / SHOOTS_M);
    var shoots = 0.0;
    if clear.x > 0.0 {
        shoots = clear.x * (lattice_noise(p_m / SHOOT_M) + 0.5 * lattice_noise(p_m / (0.45 * SHOOT_M)) - 0.75);
    }
    let dome = 0.22 - group.distance2;
    let hue = (group.random.x - 0.5) * vec3f(0.5, 0.3, 0.2);
    let tint = (1.0 + 1.1 * shoots) * (1.0 + clear.y * (0.9 * dome + hue));
    return ObjectMaterial(tint, 0.5 * SHOOT_M * shoots + 0.25 * SHOOTS_M * clear.y * dome, vec3f(0.0), 0.0);
}

// Bark, and moss over it. `p_m`: place in the form, with z along the wood.
fn fallen(covered: f32, p_m: vec3f, pixel_m: f32) -> ObjectMaterial {
    if covered >= 1.0 { return moss(p_m, pixel_m); }
    let wood = bark(p_m, pixel_m);
    if covered <= 0.0 { return wood; }
    let over = moss(p_m, pixel_m);
    return ObjectMaterial(
        mix(wood.tint, over.tint, covered), mix(wood.height_m, over.height_m, covered), vec3f(0.0), 0.0,
    );
}

// `leaf`: share of the second colour. `p_m`: place in the form.
fn object_material(kind: u32, leaf: f32, p_m: vec3f, size_m: f32, pixel_m: f32) -> ObjectMaterial {
    if kind == ROCK { return rock(p_m, size_m, pixel_m); }
    if kind == BLADED { return blades(p_m, size_m, pixel_m); }
    if kind == MOSSY { return moss(p_m, pixel_m); }
    if kind == FALLEN { return fallen(leaf, p_m.zyx, pixel_m); }
    if kind >= LEAFY && leaf < 0.5 { return bark(p_m, pixel_m); }
    if kind == LEAFY { return leaves(p_m, size_m, pixel_m); }
    if kind == NEEDLED { return needles(p_m, pixel_m); }
    return PLAIN;
}
