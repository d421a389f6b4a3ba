// The ground of many tiles, four times as fine as their meshes: what a detail tile (src/lod/tile.rs) knows around a pixel.

// Slopes along both tangents, and the same as the parents show them; height in metres as a sum of two, how much higher the parents
// show it, and how much steeper (rise over run) the ground is at the very texel.
@group(2) @binding(0) var detail_slopes: texture_2d_array<f32>;
@group(2) @binding(1) var detail_heights: texture_2d_array<f32>;

// Texels along the node's side, and of the ground around on each side; must match src/lod/tile.rs.
const DETAIL_SIDE: f32 = 129.0;
const DETAIL_APRON: i32 = 2;

// Where a pixel lies in a detail tile.
struct DetailPlace {
    // -1 without a tile
    layer: i32,
    // Texels from the node's corner
    at: vec2f,
    // How far the parent has taken over, 0 to 1
    parent: f32,
    // How many times as far apart as the tile's own the texels lie that show no more than the pixel does, as a power of two: beyond 1
    // where tiles are finer than pixels, in slopes that are seen from the side
    level: f32,
}

fn detail_slopes_at(place: DetailPlace) -> vec4f {
    let apron = f32(DETAIL_APRON);
    return textureSampleLevel(detail_slopes, clamped, (place.at + apron + 0.5) / (DETAIL_SIDE + 2.0 * apron), place.layer, 0.0);
}

// Height over the tile's own zero (x), and how much it changes from texel to texel along both sides (yz): of the very patch between
// four texels that is drawn.
fn detail_height_at(place: DetailPlace) -> vec3f {
    let low = floor(place.at);
    let f = place.at - low;
    var corners: vec4f;
    for (var i = 0; i < 4; i++) {
        let texel = textureLoad(detail_heights, vec2i(low) + vec2i(i & 1, i >> 1u) + DETAIL_APRON, place.layer, 0);
        corners[i] = texel.x + texel.y + texel.z * place.parent;
    }
    let rows = mix(corners.xz, corners.yw, f.x);
    return vec3f(mix(rows.x, rows.y, f.y), mix(corners.y - corners.x, corners.w - corners.z, f.y), rows.y - rows.x);
}

// Mean height over the tile's own zero (x) of the texels around, two to each side, and the standard deviation (y).
fn detail_heights_around(place: DetailPlace) -> vec2f {
    var sum = 0.0;
    var squares = 0.0;
    // Counted from the middle, or squares would lose it all.
    let middle_m = detail_height_at(place).x;
    for (var coarser = 0; coarser < 2; coarser++) {
        let taps = taps_around(place, coarser, 2.0);
        if taps.share <= 0.0 { continue; }
        for (var i = 0; i < taps.across * taps.across; i++) {
            let tap = tap_of(taps, i);
            let texel = textureLoad(detail_heights, tap.texel, place.layer, 0);
            let height_m = texel.x + texel.y - middle_m;
            sum += tap.weight * height_m;
            squares += tap.weight * height_m * height_m;
        }
    }
    return vec2f(middle_m + sum, sqrt(max(squares - sum * sum, 0.0)));
}

// Texels around a pixel, so many to each side: every one of the tile, or every second (which are its parent's), or fourth...
struct Taps {
    // In strides
    at: vec2f,
    reach: f32,
    across: i32,
    share: f32,
    stride: i32,
}

struct Tap {
    texel: vec2i,
    // Of all taps: a tent
    weight: f32,
}

// Those of the level that is just finer than the place's, or just coarser.
fn taps_around(place: DetailPlace, coarser: i32, reach: f32) -> Taps {
    let finer = floor(place.level);
    let share = select(1.0 + finer - place.level, place.level - finer, coarser == 1);
    let stride = 1 << u32(i32(finer) + coarser);
    return Taps(place.at / f32(stride), reach, i32(2.0 * reach), share, stride);
}

fn tap_of(taps: Taps, number: i32) -> Tap {
    let texel = floor(taps.at) - (taps.reach - 1.0) + vec2f(f32(number % taps.across), f32(number / taps.across));
    let tent = max(1.0 - abs(taps.at - texel) / taps.reach, vec2f(0.0)) / taps.reach;
    // Of a parent's, only those of no weight lie outside the image.
    let last = i32(DETAIL_SIDE) + 2 * DETAIL_APRON - 1;
    let inside = clamp(vec2i(texel) * taps.stride + DETAIL_APRON, vec2i(0), vec2i(last));
    return Tap(inside, taps.share * tent.x * tent.y);
}

// What the ground around a pixel is known to be as steep as, everything counted in: slopes too fine to be shown still decide what
// share of the ground is steep.
struct Steepness {
    place: DetailPlace,
    // Rise over run that the detail shows at the pixel, its own and the parent's
    shown: vec2f,
    // How many texels away the last are that have a say: 1 is what is nearest, 2 has no speckles where the ground is finer than texels.
    reach: f32,
    // Where there is no detail
    cosine: f32,
}

// Rules that ask for the cosine of the slope: how much a rule holds goes from 0 at `from` to 1 at `to`, whichever is greater.
struct SlopeRules {
    cells_from: vec4f,
    cells_to: vec4f,
    covers_from: vec2f,
    covers_to: vec2f,
}

// How much of the ground each rule holds for.
struct SlopeShares {
    cells: vec4f,
    covers: vec2f,
}

fn cosine_of(rise: f32) -> f32 {
    let r = max(rise, 0.0);
    return inverseSqrt(1.0 + r * r);
}

fn add_slope(shares: ptr<function, SlopeShares>, rules: SlopeRules, cosine: f32, weight: f32) {
    let cells_span = rules.cells_to - rules.cells_from;
    let cells = saturate((cosine - rules.cells_from) / select(cells_span, vec4f(1e-6), cells_span == vec4f(0.0)));
    (*shares).cells += weight * cells * cells * (3.0 - 2.0 * cells);
    let covers_span = rules.covers_to - rules.covers_from;
    let covers = saturate((cosine - rules.covers_from) / select(covers_span, vec2f(1e-6), covers_span == vec2f(0.0)));
    (*shares).covers += weight * covers * covers * (3.0 - 2.0 * covers);
}

// Rules are asked at texels, where slopes are known, and what they answer is mixed: the other way round, slopes that are mixed first
// would make less rock and more snow of rough ground, the farther away the more.
fn slope_shares(steep: Steepness, rules: SlopeRules) -> SlopeShares {
    var out = SlopeShares(vec4f(0.0), vec2f(0.0));
    let place = steep.place;
    if place.layer < 0 {
        add_slope(&out, rules, steep.cosine, 1.0);
        return out;
    }
    for (var coarser = 0; coarser < 2; coarser++) {
        let taps = taps_around(place, coarser, steep.reach);
        if taps.share <= 0.0 { continue; }
        for (var i = 0; i < taps.across * taps.across; i++) {
            let tap = tap_of(taps, i);
            if tap.weight <= 0.0 { continue; }
            var rise = textureLoad(detail_heights, tap.texel, place.layer, 0).w;
            if taps.stride == 1 {
                rise += steep.shown.x;
            } else {
                let slopes = textureLoad(detail_slopes, tap.texel, place.layer, 0);
                rise += length(slopes.xy);
                // Where the parent's texels show as much as the pixel does, the pixel's own place between them counts.
                if taps.stride == 2 { rise += steep.shown.y - length(slopes.zw); }
            }
            add_slope(&out, rules, cosine_of(rise), tap.weight);
        }
    }
    return out;
}
