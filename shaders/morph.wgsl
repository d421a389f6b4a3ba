// How far each vertex is drawn above its true place, before it has come out of the coarser mesh in full: a workgroup for each tile.
// The same arithmetic as src/lod/morph.rs, which says what it is about.

// Must match src/lod/tile.rs, and src/render/morph.rs.
const QUADS: u32 = 32u;
const SIDE: u32 = 33u;
const VERTICES: u32 = 1089u;
const VERTEX_WORDS: u32 = 13u;
const LANES: u32 = 64u;
// Must match src/lod/morph.rs.
const COARSEST_MORPHING: u32 = 4u;

struct Tile {
    first_vertex: u32,
    // From vertex to vertex, metres.
    spacing_m: f32,
    padding: vec2u,
}

struct Eye {
    // The eye that vertices come out for, greater part and rest, metres.
    high_m: vec4f,
    low_m: vec4f,
    // Spacings out to which a level always shows, and beyond which it never does; metres of distance for each metre of
    // error; share of its distance over which a vertex comes out.
    least: f32,
    most: f32,
    reach: f32,
    width: f32,
}

@group(0) @binding(0) var<storage, read> vertices: array<f32>;
@group(0) @binding(1) var<storage, read_write> shift_m: array<f32>;
@group(0) @binding(2) var<storage, read> tiles: array<Tile>;
@group(0) @binding(3) var<uniform> eye: Eye;

var<workgroup> shift: array<f32, VERTICES>;

fn three(word: u32) -> vec3f { return vec3f(vertices[word], vertices[word + 1u], vertices[word + 2u]); }

// How far a vertex has come out: 0 not at all, 1 in full.
fn share_of(word: u32, spacing_m: f32) -> f32 {
    let rel_m = (three(word) - eye.high_m.xyz) + (three(word + 4u) - eye.low_m.xyz);
    let distance_m = sqrt(dot(rel_m, rel_m));
    let foreseen_m = vertices[word + 12u];
    let begin_m = clamp(foreseen_m * eye.reach, eye.least * spacing_m, eye.most * spacing_m);
    return saturate((begin_m - distance_m) / (begin_m * eye.width));
}

@compute @workgroup_size(64)
fn compute(@builtin(workgroup_id) group: vec3u, @builtin(local_invocation_index) lane: u32) {
    let tile = tiles[group.x];
    for (var i = lane; i < VERTICES; i += LANES) { shift[i] = 0.0; }
    for (var stride = COARSEST_MORPHING; stride > 0u; stride /= 2u) {
        workgroupBarrier();
        let side = QUADS / stride + 1u;
        for (var i = lane; i < side * side; i += LANES) {
            let x = i % side;
            let y = i / side;
            let odd = vec2u(x & 1u, y & 1u);
            if all(odd == vec2u(0u)) { continue; }
            // The coarser quad's diagonal goes from the middle of a block of two by two to its corner.
            let turned = odd.x == 1u && odd.y == 1u && ((x / 2u + y / 2u) & 1u) == 1u;
            let a = vec2u(select(x - odd.x, x + odd.x, turned), y - odd.y) * stride;
            let b = vec2u(select(x + odd.x, x - odd.x, turned), y + odd.y) * stride;
            let index = (y * SIDE + x) * stride;
            let word = (tile.first_vertex + index) * VERTEX_WORDS;
            let share = share_of(word, tile.spacing_m * f32(stride));
            let ends_m = shift[a.y * SIDE + a.x] + shift[b.y * SIDE + b.x];
            shift[index] = 0.5 * ends_m - (1.0 - share) * vertices[word + 11u];
        }
    }
    workgroupBarrier();
    for (var i = lane; i < VERTICES; i += LANES) { shift_m[tile.first_vertex + i] = shift[i]; }
}
