// Ice on water: floes of the sea, leads between them, thin ice, ridges; closed ice of lakes and rivers.

// Ice at a pixel.
struct Ice {
    share: f32,
    albedo: vec3f,
}

// Range of temperature from the first floes to closed ice, °C.
const ICE_EDGE_C: f32 = 5.0;

fn floe_hash(cell: vec3f, seed: u32) -> vec3f {
    let wrapped = vec3u(vec3i(cell) + 4096) * vec3u(1597334677u, 3812015801u, 2798796415u);
    var x = wrapped.x ^ wrapped.y ^ wrapped.z ^ (seed * 747796405u);
    x = (x ^ (x >> 16u)) * 2146121005u;
    x = (x ^ (x >> 15u)) * 2221713035u;
    let y = (x ^ (x >> 16u)) * 2654435769u;
    let z = (y ^ (y >> 15u)) * 1597334677u;
    return vec3f(f32(x >> 8u), f32(y >> 8u), f32(z >> 8u)) / 16777216.0;
}

// Distance to the border between the nearest two floes, cells; a number from 0 to 1 that belongs to the floe; 0.
fn floe_at(at: vec3f, grid: f32, seed: u32) -> vec2f {
    let corner = floor(at - 0.5);
    var nearest = vec2f(9.0, 0.0);
    var second = 9.0;
    for (var i = 0u; i < 8u; i++) {
        let cell = corner + vec3f(f32(i & 1u), f32((i >> 1u) & 1u), f32(i >> 2u));
        let random = floe_hash(cell - grid * floor(cell / grid), seed);
        let to = cell + 0.5 + (random - 0.5) * 0.8 - at;
        let distance = length(to);
        if distance < nearest.x {
            second = nearest.x;
            nearest = vec2f(distance, fract(random.x * 7.0 + random.y * 3.0 + random.z));
        } else {
            second = min(second, distance);
        }
    }
    return vec2f(second - nearest.x, nearest.y);
}

// Share of a pixel that the lead between two floes covers, so that a lead thinner than a pixel is a faint line, not a
// row of dots. `difference`: of the distances to both floes, cells; `lead`: that difference at the edge of the lead;
// `width`: of the pixel, cells. The difference changes by twice the distance across the lead.
fn lead_share(difference: f32, lead: f32, width: f32) -> f32 {
    // Half as wide again as the pixel, as a narrower filter leaves dots; and never nothing.
    let half_pixel = 1.5 * width + 0.005;
    return max(min(difference + half_pixel, lead) - max(difference - half_pixel, -lead), 0.0) / (2.0 * half_pixel);
}

// Length below which nothing bends the edges of floes, to the width of the greatest floe.
const FINEST_BEND: f32 = 0.02;

// How much warmer fresh water freezes than that of the sea, °C.
const FRESH_WARMER_C: f32 = 1.9;
// Plates between the cracks of lake ice, to a width of the greatest floe.
const PLATES: vec2f = vec2f(8.0, 64.0);

// Ice of lakes and rivers: closed, with snow in drifts and pale cracks. `colder_c`: than it freezes.
fn fresh_ice(colder_c: f32, rel_m: vec3f, footprint_m: f32, variation: f32, broad: f32) -> Ice {
    let share = smoothstep(-0.4, 0.4, colder_c);
    // Young ice is dark and bare.
    let bare = body.ice_color * mix(vec3f(0.40, 0.50, 0.56), vec3f(0.66, 0.76, 0.82), smoothstep(0.0, 6.0, colder_c));
    let snowed = smoothstep(-0.45, 0.25, variation + 0.5 * broad) * smoothstep(0.0, 4.0, colder_c);
    var albedo = mix(bare, min(body.ice_color * 1.12, vec3f(0.9)), snowed);
    if NEARNESS == FROM_ORBIT || body.floes_per_m <= 0.0 || share <= 0.0 { return Ice(share, albedo); }
    let bend = vec3f(variation, broad, variation - broad) * 0.15;
    for (var size = 0u; size < 2u; size++) {
        let width_cells = footprint_m * body.floes_per_m * PLATES[size];
        let seen = 1.0 - smoothstep(0.05, 0.25, width_cells);
        if seen <= 0.0 { break; }
        let at = (body.floe_eye + rel_m * body.floes_per_m) * PLATES[size] + bend;
        let plate = floe_at(at, FLOE_GRID * PLATES[size], size + 11u);
        let crack = 1.0 - smoothstep(0.004, 0.014 + 0.5 * width_cells, plate.x);
        // Snow hides most of them.
        albedo = mix(albedo, body.ice_color, crack * seen * (0.5 - 0.4 * snowed));
        albedo *= 1.0 + 0.1 * (plate.y - 0.5) * seen * (1.0 - snowed);
    }
    return Ice(share, albedo);
}

// `footprint_m`: width of a pixel; `variation` and `broad`: noise, about -1 to 1.
fn ice_at(water: Water, rel_m: vec3f, up: vec3f, footprint_m: f32, variation: f32, broad: f32) -> Ice {
    let colder = body.freezing_c - (water.temperature_c + broad * 3.0 + variation * 1.2);
    let thick = body.ice_color * (1.0 + 0.18 * variation);
    if water.floes <= 0.0 { return fresh_ice(colder + FRESH_WARMER_C, rel_m, footprint_m, variation, broad); }
    if body.floes_per_m <= 0.0 {
        return Ice(smoothstep(-0.4, 0.4, colder), thick);
    }
    let closed = smoothstep(-0.5 * ICE_EDGE_C, 0.5 * ICE_EDGE_C, colder);
    if closed <= 0.0 { return Ice(0.0, thick); }
    // The mean of floes too small to be seen.
    let mean = mix(closed * 0.9, 1.0, closed * closed);
    if NEARNESS == FROM_ORBIT { return Ice(mean, thick); }
    // Bent, so that edges of floes are no straight lines. Noise finer than that would break leads into dots.
    let least_m = FINEST_BEND / body.floes_per_m;
    var bent = vec2f(variation, broad);
    if footprint_m < least_m { bent = vec2f(macro_variation(rel_m, least_m), edge_jitter(rel_m, least_m)); }
    let bend = vec3f(bent, bent.x - bent.y) * 0.25;
    var share = 1.0;
    var albedo = thick;
    var width_cells = footprint_m * body.floes_per_m;
    var scale = 1.0;
    // Floes of three sizes: the smaller ones where greater ones broke.
    for (var size = 0u; size < 3u; size++) {
        let seen = 1.0 - smoothstep(0.15, 0.5, width_cells);
        if seen <= 0.0 { break; }
        let at = (body.floe_eye + rel_m * body.floes_per_m) * scale + bend;
        let floe = floe_at(at, FLOE_GRID * scale, size + 1u);
        let lead = mix(0.16, 0.022, closed) * (0.4 + 1.2 * fract(floe.y * 13.0));
        let edge = 1.0 - lead_share(floe.x, lead, width_cells);
        // Whether the floe is there at all.
        let there = smoothstep(-0.02, 0.02, closed * 1.12 - floe.y);
        share *= mix(1.0, edge * there, seen);
        // Young floes are thin and grey; ridges stand where floes meet.
        let young = smoothstep(0.75, 0.95, fract(floe.y * 5.0)) * (1.0 - 0.5 * closed);
        let ridge = (1.0 - smoothstep(lead, lead + 0.08, floe.x)) * 0.1;
        albedo *= mix(1.0, (1.0 - 0.35 * young) * (1.0 + ridge) * (0.94 + 0.1 * fract(floe.y * 3.0)), seen);
        // Only broken floes show the next size.
        if floe.y < closed * closed * 0.85 { break; }
        scale *= 4.0;
        width_cells *= 4.0;
    }
    let far = smoothstep(0.15, 0.5, footprint_m * body.floes_per_m);
    return Ice(mix(share, mean, far), albedo);
}
