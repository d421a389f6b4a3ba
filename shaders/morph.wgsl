// Geomorphing: for each vertex its vertical shift towards the parent's mesh, and its height and climate blended in the
// same way. One workgroup for each tile. The arithmetic and its source are in src/lod/morph.rs.

#include "shared.wgsl"

const LANES: u32 = 64u;

struct Tile {
    first_vertex: u32,
    // Distance between neighbouring vertices, metres.
    spacing_m: f32,
    // Edges beyond which the neighbour is one level finer: left, right, bottom, top as bits.
    finer_edges: u32,
    padding: u32,
}

@group(0) @binding(0) var<storage, read> vertices: array<f32>;
// For each vertex: shift in metres; moisture and temperature at sea level, or at the reference sphere of a planet with
// no sea; height in metres.
@group(0) @binding(1) var<storage, read_write> morphed: array<f32>;
@group(0) @binding(2) var<storage, read> tiles: array<Tile>;
@group(0) @binding(3) var<uniform> eye: MorphEye;

fn three(word: u32) -> vec3f { return vec3f(vertices[word], vertices[word + 1u], vertices[word + 2u]); }

// Share of the morph by which a vertex has reached its exact position: 0 on the parent's mesh, 1 exact.
fn share_of(word: u32, spacing_m: f32) -> f32 {
    let rel_m = (three(word) - eye.high_m) + (three(word + VERTEX_LOW) - eye.low_m);
    let distance_m = sqrt(dot(rel_m, rel_m));
    let foreseen_m = vertices[word + VERTEX_FORESEEN];
    let begin_m = clamp(foreseen_m * eye.reach, eye.least_spacings * spacing_m, eye.most_spacings * spacing_m);
    return saturate((begin_m - distance_m) / (begin_m * eye.width_share));
}

// Moisture, temperature and height of the vertex without morph, in the order of `morphed`.
fn unmorphed(word: u32) -> vec3f {
    return vec3f(
        vertices[word + VERTEX_MOISTURE],
        vertices[word + VERTEX_TEMPERATURE],
        vertices[word + VERTEX_HEIGHT],
    );
}

fn morphed_of(word: u32) -> vec3f { return vec3f(morphed[word + 1u], morphed[word + 2u], morphed[word + 3u]); }

fn store(word: u32, shift_m: f32, rest: vec3f) {
    morphed[word] = shift_m;
    for (var i = 0u; i < 3u; i++) { morphed[word + 1u + i] = rest[i]; }
}

@compute @workgroup_size(LANES)
fn compute(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let tile = tiles[group.x];
    let first = tile.first_vertex;
    for (var i = lane; i < TILE_VERTICES; i += LANES) {
        store((first + i) * SHOWN_WORDS, 0.0, unmorphed((first + i) * VERTEX_WORDS));
    }
    for (var stride = COARSEST_MORPHING; stride > 0u; stride /= 2u) {
        storageBarrier();
        let side = TILE_QUADS / stride + 1u;
        for (var i = lane; i < side * side; i += LANES) {
            let x = i % side;
            let y = i / side;
            let odd = vec2u(x & 1u, y & 1u);
            if all(odd == vec2u(0u)) { continue; }
            // The diagonal of the coarser quad runs from the middle of a block of two by two quads to its corner.
            let turned = odd.x == 1u && odd.y == 1u && ((x / 2u + y / 2u) & 1u) == 1u;
            let from_x = select(x - odd.x, x + odd.x, turned);
            let to_x = select(x + odd.x, x - odd.x, turned);
            let a = first + ((y - odd.y) * TILE_SIDE + from_x) * stride;
            let b = first + ((y + odd.y) * TILE_SIDE + to_x) * stride;
            let v = first + (y * TILE_SIDE + x) * stride;
            let word = v * VERTEX_WORDS;
            // On an edge to a finer tile, which has these vertices exact.
            let edges = select(0u, 1u, x == 0u) | select(0u, 2u, x == side - 1u) | select(0u, 4u, y == 0u)
                | select(0u, 8u, y == side - 1u);
            let is_exact = stride == COARSEST_MORPHING && (edges & tile.finer_edges) != 0u;
            let share = select(share_of(word, tile.spacing_m * f32(stride)), 1.0, is_exact);
            let ends_m = morphed[a * SHOWN_WORDS] + morphed[b * SHOWN_WORDS];
            let shift_m = 0.5 * ends_m - (1.0 - share) * vertices[word + VERTEX_DEVIATION];
            let deviation = unmorphed(word) - 0.5 * (unmorphed(a * VERTEX_WORDS) + unmorphed(b * VERTEX_WORDS));
            let rest = 0.5 * (morphed_of(a * SHOWN_WORDS) + morphed_of(b * SHOWN_WORDS)) + share * deviation;
            store(v * SHOWN_WORDS, shift_m, rest);
        }
    }
}
