// The ground at a pixel from detail textures (src/lod/tile.rs), which have four times the density of the meshes.

// `detail_slopes`: slopes (rise over run) along both tangents (xy), and those of the parent's detail texture (zw).
// `detail_heights`: height in metres as the sum of two values (xy), steepness (rise over run) of the slopes in the
// texel (z), and steepness including finer slopes that are faded out of them (w).
@group(2) @binding(0) var detail_slopes: texture_2d_array<f32>;
@group(2) @binding(1) var detail_heights: texture_2d_array<f32>;
// `detail_water`: rivers and lakes. Share of the ground under water (x), depth of the water in metres (y), the share in
// the parent's detail texture (z), and 1 where the water has a shore, 0 where it is narrower than texels (w).
@group(2) @binding(2) var detail_water: texture_2d_array<f32>;

// Footprint of a pixel in a detail texture.
struct DetailFootprint {
    // Layer; -1 without a detail texture
    layer: i32,
    // Its middle, in texels from the node's corner
    at: vec2f,
    // Vectors across the footprint along its longer side and perpendicular to that, in texels
    along: vec2f,
    across: vec2f,
    // Share to which the parent has taken over by distance, 0 to 1
    parent: f32,
    // log2 of the shorter side in texels
    width: f32,
    // log2 of the stride between the sampled texels: the greater of `width` and `parent`, at most 5
    level: f32,
    // Samples along the longer side, as in anisotropic texture filters
    parts: i32,
}

// `right`, `below`: steps to the next pixel, in texels. `parent`: share of the parent by distance.
fn detail_place(layer: f32, at: vec2f, right: vec2f, below: vec2f, parent: f32) -> DetailFootprint {
    let is_right = dot(right, right) > dot(below, below);
    let along = select(below, right, is_right);
    // Component of the other side perpendicular to the longer one.
    let other = select(right, below, is_right);
    let length_along = max(length(along), 1e-6);
    let across = other - along * (dot(other, along) / (length_along * length_along));
    // The filter averages two texels to each side, so a footprint up to twice as long as wide needs one part.
    let fewest = length_along / max(length(across), length_along / 8.0);
    let parts = select(select(4, 2, fewest <= 4.0), 1, fewest <= 2.0 || length_along < 2.0);
    let width = log2(max(length(across), length_along / 8.0));
    return DetailFootprint(i32(layer), at, along, across, parent, width, clamp(width, parent, 5.0), parts);
}

// One of the parts of a footprint. `detail_slopes_at` is not meant for parts.
fn part_of(footprint: DetailFootprint, number: i32) -> DetailFootprint {
    var out = footprint;
    out.at += footprint.along * ((f32(number) + 0.5) / f32(footprint.parts) - 0.5);
    out.along /= f32(footprint.parts);
    return out;
}

fn detail_slopes_at(footprint: DetailFootprint) -> vec4f {
    let apron = f32(DETAIL_APRON);
    let at = (footprint.at + apron + 0.5) / (DETAIL_SIDE + 2.0 * apron);
    return textureSampleLevel(detail_slopes, clamped, at, footprint.layer, 0.0);
}

// Share of a pixel that is under the water of rivers and lakes (x), and the depth of that water in metres (y).
// `parent`: share to which the parent has taken over.
fn water_cover(footprint: DetailFootprint, parent: f32) -> vec2f {
    if body.has_rivers == 0u || footprint.layer < 0 { return vec2f(0.0); }
    let side = DETAIL_SIDE + 2.0 * f32(DETAIL_APRON);
    let length_texels = max(length(footprint.along), 1e-6);
    let texel_px = f32(footprint.parts) / length_texels;
    var sum = vec4f(0.0);
    if length_texels < 1.0 {
        // Magnified bilinear samples would show a row of beads along a river: four of them make a smoother kernel.
        let away = 0.5 * min(1.0 / length_texels - 1.0, 1.0) / side;
        let at = (footprint.at + f32(DETAIL_APRON) + 0.5) / side;
        for (var corner = 0; corner < 4; corner++) {
            let aside = away * (vec2f(vec2i(corner & 1, corner >> 1)) * 2.0 - 1.0);
            sum += 0.25 * textureSampleLevel(detail_water, clamped, at + aside, footprint.layer, 0.0);
        }
    } else {
        for (var number = 0; number < footprint.parts; number++) {
            let at = (part_of(footprint, number).at + f32(DETAIL_APRON) + 0.5) / side;
            sum += textureSampleLevel(detail_water, clamped, at, footprint.layer, 0.0) / f32(footprint.parts);
        }
    }
    let share = mix(sum.x, sum.z, parent);
    // Where texels are wider than pixels, a shore is as sharp as pixels.
    let sharp = saturate1(0.5 + (share - 0.5) * max(texel_px, 1.0));
    // A river much narrower than a pixel is drawn stronger than its share, as maps do: else none is seen from orbit.
    let line = pow(share, 0.65);
    return vec2f(mix(line, sharp, sum.w), max(sum.y, 0.0));
}

// Texels around the middle of a footprint, `reach` to each side: every texel of the tile, every second one (those of
// its parent), every fourth and so on.
struct Taps {
    // Middle, in strides
    at: vec2f,
    reach: f32,
    across: i32,
    share: f32,
    stride: i32,
}

struct Tap {
    texel: vec2i,
    // Share of all taps, by a tent filter
    weight: f32,
}

// Taps of the level just finer than the footprint's level, or of the level just coarser.
fn taps_around(footprint: DetailFootprint, coarser: i32, reach: f32) -> Taps {
    let finer = floor(footprint.level);
    let share = select(1.0 + finer - footprint.level, footprint.level - finer, coarser == 1);
    let stride = 1 << u32(i32(finer) + coarser);
    return Taps(footprint.at / f32(stride), reach, i32(2.0 * reach), share, stride);
}

fn tap_of(taps: Taps, number: i32) -> Tap {
    let texel = floor(taps.at) - (taps.reach - 1.0) + vec2f(f32(number % taps.across), f32(number / taps.across));
    let tent = max(1.0 - abs(taps.at - texel) / taps.reach, vec2f(0.0)) / taps.reach;
    // Only the parent's texels of weight 0 lie outside the image.
    let last = i32(DETAIL_SIDE) + 2 * DETAIL_APRON - 1;
    let inside = clamp(vec2i(texel) * taps.stride + DETAIL_APRON, vec2i(0), vec2i(last));
    return Tap(inside, taps.share * tent.x * tent.y);
}

// Height above the tile's base height in metres (x) and its change to the next texel along both sides (yz),
// interpolated in the patches between texels that are drawn.
fn patch_height(footprint: DetailFootprint) -> vec3f {
    var sum = vec3f(0.0);
    for (var coarser = 0; coarser < 2; coarser++) {
        let taps = taps_around(footprint, coarser, 1.0);
        if taps.share <= 0.0 { continue; }
        var corners: vec4f;
        for (var i = 0; i < 4; i++) {
            let texel = textureLoad(detail_heights, tap_of(taps, i).texel, footprint.layer, 0);
            corners[i] = texel.x + texel.y;
        }
        let f = fract(taps.at);
        let rows = mix(corners.xz, corners.yw, f.x);
        let change = vec2f(mix(corners.y - corners.x, corners.w - corners.z, f.y), rows.y - rows.x) / f32(taps.stride);
        sum += taps.share * vec3f(mix(rows.x, rows.y, f.y), change);
    }
    return sum;
}

// Heights in and around a pixel.
struct Heights {
    // In the middle of the pixel, metres above the tile's base height
    middle_m: f32,
    // Plane of best fit: change in metres to the next texel
    change: vec2f,
    // Standard deviation from that plane, metres
    rest_m: f32,
}

// How far the plane rises and falls from the middle within the pixel, metres.
fn plane_spread_m(heights: Heights, footprint: DetailFootprint) -> f32 {
    return 0.5 * (abs(dot(heights.change, footprint.along)) + abs(dot(heights.change, footprint.across)));
}

// A plane fitted to few texels (about nine, by weight) absorbs a third of the variance of their true deviation. This
// factor restores the standard deviation.
const SWELL: f32 = 1.25;
// Share of the deviation to add where texels are wider than pixels: heights interpolated between texels show part of it
// already. Fitted so that colours stay the same from level to level (tests/gpu/colours.rs).
const NEAR: f32 = 0.58;

// Fit over the texels around the pixel, two to each side.
fn heights_around(footprint: DetailFootprint) -> Heights {
    // Heights are relative to a nearby texel, because squares of full heights would lose all precision.
    let near = textureLoad(detail_heights, tap_of(taps_around(footprint, 0, 1.0), 0).texel, footprint.layer, 0);
    let zero_m = near.x + near.y;
    var sum = 0.0;
    var squares = 0.0;
    var by_offset = vec2f(0.0);
    var moments = vec3f(0.0);
    let one = 1.0 / f32(footprint.parts);
    for (var number = 0; number < footprint.parts; number++) {
        let part = part_of(footprint, number);
        for (var coarser = 0; coarser < 2; coarser++) {
            let taps = taps_around(part, coarser, 2.0);
            if taps.share <= 0.0 { continue; }
            for (var i = 0; i < taps.across * taps.across; i++) {
                let tap = tap_of(taps, i);
                let texel = textureLoad(detail_heights, tap.texel, footprint.layer, 0);
                let height_m = texel.x + texel.y - zero_m;
                let offset = vec2f(tap.texel - DETAIL_APRON) - footprint.at;
                sum += one * tap.weight * height_m;
                squares += one * tap.weight * height_m * height_m;
                by_offset += one * tap.weight * height_m * offset;
                moments += one * tap.weight * offset.xxy * offset.xyy;
            }
        }
    }
    let determinant = max(moments.x * moments.z - moments.y * moments.y, 1e-6);
    let change = vec2f(
        moments.z * by_offset.x - moments.y * by_offset.y,
        moments.x * by_offset.y - moments.y * by_offset.x,
    ) / determinant;
    return Heights(zero_m + sum, change, SWELL * sqrt(max(squares - sum * sum - dot(change, by_offset), 0.0)));
}

// Heights at the pixel: interpolated where texels are wider than pixels, fitted over the texels around where texels are
// no wider, because peaks, valleys and rivers as wide as a texel would sparkle. The deviation from the plane still
// counts while texels are a few pixels wide, because the ground between them deviates, too. `apart`: 0 to 1.
fn heights_at(footprint: DetailFootprint, apart: f32) -> Heights {
    let rough = smoothstep(-4.0, -3.0, footprint.width - footprint.parent);
    if rough <= 0.0 {
        let patch_m = patch_height(footprint);
        return Heights(patch_m.x, patch_m.yz, 0.0);
    }
    let around = heights_around(footprint);
    if apart >= 1.0 { return around; }
    let patch_m = patch_height(footprint);
    return Heights(
        mix(patch_m.x, around.middle_m, apart),
        mix(patch_m.yz, around.change, apart),
        rough * mix(NEAR, 1.0, apart) * around.rest_m,
    );
}

// Steepness (rise over run) shown by the detail texture at a pixel: its own (x) and the parent's (y). Means of the
// steepness of texels; averaged slopes would be gentler.
fn rises_at(footprint: DetailFootprint) -> vec2f {
    let apron = f32(DETAIL_APRON);
    let own_at = (footprint.at + apron + 0.5) / (DETAIL_SIDE + 2.0 * apron);
    let own = textureSampleLevel(detail_heights, clamped, own_at, footprint.layer, 0.0).z;
    if footprint.parent <= 0.0 { return vec2f(own, 0.0); }
    let at = 0.5 * footprint.at;
    let f = fract(at);
    var parents = 0.0;
    for (var i = 0; i < 4; i++) {
        let corner = vec2i(i & 1, i >> 1u);
        let share = mix(1.0 - f, f, vec2f(corner));
        let texel = min(2 * (vec2i(floor(at)) + corner), vec2i(i32(DETAIL_SIDE) - 1)) + DETAIL_APRON;
        parents += share.x * share.y * length(textureLoad(detail_slopes, texel, footprint.layer, 0).zw);
    }
    return vec2f(own, parents);
}

// Steepness of the ground around a pixel, including slopes too fine to be drawn: they still decide the share of steep
// ground.
struct Steepness {
    footprint: DetailFootprint,
    // Rise over run in the detail texture at the pixel: its own and the parent's
    shown: vec2f,
    heights: Heights,
    // 0 where texels are wider than pixels, 1 where they are finer
    apart: f32,
    // Texels to each side that count: 1 takes the nearest only, 2 avoids speckles where the ground is finer than texels
    reach: f32,
    // Cosine of the slope where there is no detail texture
    cosine: f32,
}

// Surface rules by the cosine of the slope. A rule applies from 0 at `from` to 1 at `to`; either may be the greater.
struct SlopeRules {
    cells_from: vec4f,
    cells_to: vec4f,
    // x: beach, y: snow
    covers_from: vec2f,
    covers_to: vec2f,
    // Height above the middle of the pixel in metres from which the ground is cold enough for full snow (x), and below
    // which it is too warm for any (y)
    snow_m: vec2f,
}

// Share of the ground to which each rule applies.
struct SlopeShares {
    cells: vec4f,
    covers: vec2f,
}

fn cosine_of(rise: f32) -> f32 {
    let r = max(rise, 0.0);
    return inverseSqrt(1.0 + r * r);
}

fn add_slope(shares: ptr<function, SlopeShares>, rules: SlopeRules, cosine: f32, above_m: f32, weight: f32) {
    let cells_span = rules.cells_to - rules.cells_from;
    let cells = saturate((cosine - rules.cells_from) / select(cells_span, vec4f(1e-6), cells_span == vec4f(0.0)));
    (*shares).cells += weight * cells * cells * (3.0 - 2.0 * cells);
    let covers_span = rules.covers_to - rules.covers_from;
    let covers = saturate((cosine - rules.covers_from) / select(covers_span, vec2f(1e-6), covers_span == vec2f(0.0)));
    let cold = saturate1((above_m - rules.snow_m.y) / (rules.snow_m.x - rules.snow_m.y));
    (*shares).covers += weight * covers * covers * (3.0 - 2.0 * covers) * vec2f(1.0, cold * cold * (3.0 - 2.0 * cold));
}

// Rules are evaluated at texels, where slopes are known, and their results are averaged. Averaging the slopes first
// would give rough ground less rock and more snow, and more so with distance.
fn slope_shares(steep: Steepness, rules: SlopeRules) -> SlopeShares {
    var out = SlopeShares(vec4f(0.0), vec2f(0.0));
    let footprint = steep.footprint;
    if footprint.layer < 0 {
        add_slope(&out, rules, steep.cosine, 0.0, 1.0);
        return out;
    }
    for (var part = 0; part < footprint.parts; part++) {
        for (var coarser = 0; coarser < 2; coarser++) {
            let taps = taps_around(part_of(footprint, part), coarser, steep.reach);
            if taps.share <= 0.0 { continue; }
            for (var i = 0; i < taps.across * taps.across; i++) {
                let tap = tap_of(taps, i);
                if tap.weight <= 0.0 { continue; }
                let heights = textureLoad(detail_heights, tap.texel, footprint.layer, 0);
                var rise = heights.w;
                // Where texels are wider than pixels, the position of the pixel between them counts.
                if steep.apart < 1.0 && taps.stride == 1 { rise += (1.0 - steep.apart) * (steep.shown.x - heights.z); }
                if steep.apart < 1.0 && taps.stride == 2 {
                    let parents = textureLoad(detail_slopes, tap.texel, footprint.layer, 0).zw;
                    rise += (1.0 - steep.apart) * (steep.shown.y - length(parents));
                }
                // Height of the texel above the plane.
                let offset = vec2f(tap.texel - DETAIL_APRON) - footprint.at;
                let above_m = heights.x + heights.y - steep.heights.middle_m - dot(steep.heights.change, offset);
                let swollen_m = mix(NEAR * SWELL, SWELL, steep.apart) * above_m;
                add_slope(&out, rules, cosine_of(rise), swollen_m, tap.weight / f32(footprint.parts));
            }
        }
    }
    return out;
}
