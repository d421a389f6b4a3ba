// Planting: what strokes of life, roads and walls, and the distance from water and the curvature of the ground, make of
// the share of its greatest density that a population has, from the planting map of the view
// (src/life/planting_map.rs).

// What is kept of a share and what is added to it, 16 bits each: channel by channel, square by square, row by row.
@group(0) @binding(6) var<storage, read> planting: array<u32>;

fn planting_texel(first: u32, at: vec2i) -> vec2f {
    let inside = vec2u(clamp(at, vec2i(0), vec2i(i32(PLANTING_SIDE) - 1)));
    return unpack2x16unorm(planting[first + inside.y * PLANTING_SIDE + inside.x]);
}

// The share that is kept (x) and what is added to it (y). `footprint_m`: width of the pixel on the ground.
fn planting_at(channel: u32, rel_m: vec3f, footprint_m: f32) -> vec2f {
    if body.planting_levels == 0u { return vec2f(1.0, 0.0); }
    // The place on the plane that touches the reference sphere.
    let at_m = vec2f(dot(rel_m, body.planting_east), dot(rel_m, body.planting_north)) + body.planting_eye_m;
    let flat_m = at_m * (body.radius_km / length(body.eye_km + rel_m * 0.001));
    let middle = 0.5 * f32(PLANTING_SIDE);
    let away_m = max(abs(flat_m.x), abs(flat_m.y));
    let needed = max(away_m / (middle - 1.0), footprint_m) / body.planting_texel_m;
    let level = u32(clamp(ceil(log2(max(needed, 1.0))), 0.0, f32(body.planting_levels - 1u)));
    let first = (channel * body.planting_levels + level) * PLANTING_SIDE * PLANTING_SIDE;
    let at = flat_m / (body.planting_texel_m * exp2(f32(level))) + middle - 0.5;
    let corner = vec2i(floor(at));
    let part = fract(at);
    let lower = mix(planting_texel(first, corner), planting_texel(first, corner + vec2i(1, 0)), part.x);
    let upper = mix(planting_texel(first, corner + vec2i(0, 1)), planting_texel(first, corner + vec2i(1, 1)), part.x);
    return mix(lower, upper, part.y);
}
