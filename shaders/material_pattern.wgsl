// Patterns of the ground: a tiling texture for each kind, projected along three axes (triplanar), at two scales whose
// periods never coincide, and advected downhill where the material flows. Layout of the texels:
// src/render/material_maps.rs and src/render/biome_table.rs.
#include "uniforms.wgsl"
#include "luts.wgsl"
#include "macro_variation.wgsl"

// The ground under a pixel.
struct Seen {
    rel_m: vec3f,
    n: vec3f,
    up: vec3f,
    rel_x: vec3f,
    rel_y: vec3f,
    footprint_m: f32,
}

struct Pattern {
    // Factor on the albedo, with mean 1
    tint: vec3f,
    // Height of the pattern, distributed evenly over 0 to 1; 0.5 without a pattern
    height: f32,
    slope: vec3f,
    roughness: f32,
    glow: vec3f,
    // 0 in the foreground, 1 where only the mean is left
    far: f32,
    shown: f32,
}

fn no_pattern() -> Pattern { return Pattern(vec3f(1.0), 0.5, vec3f(0.0), 0.0, vec3f(0.0), 1.0, 0.0); }

// Weight of the second pattern where its share is `share` on average (at most a half): it shows where it is higher than
// the first by a threshold. With two heights distributed evenly, or one such height and a plane, exactly that share of
// the ground is above the threshold.
fn share_by_height(a: Pattern, b: Pattern, share: f32) -> f32 {
    let patterns = a.shown + b.shown;
    if patterns < 0.5 { return share; }
    let threshold = select(0.5 - share, 1.0 - sqrt(2.0 * share), patterns > 1.5);
    let edge = 0.10;
    return mix(smoothstep(threshold - edge, threshold + edge, b.height - a.height), share, max(a.far, b.far));
}

// Rotation by the angle of the triangle with sides 3, 4 and 5: a pattern that repeats after 1024 m still does.
fn rotated(p: vec2f) -> vec2f { return vec2f(0.6 * p.x + 0.8 * p.y, 0.6 * p.y - 0.8 * p.x); }
fn rotated_back(p: vec2f) -> vec2f { return vec2f(0.6 * p.x - 0.8 * p.y, 0.6 * p.y + 0.8 * p.x); }

// The two coordinates in the plane perpendicular to an axis, and back.
fn projected(p: vec3f, axis: u32) -> vec2f {
    if axis == 0u { return p.yz; }
    if axis == 1u { return p.zx; }
    return p.xy;
}
fn unprojected(p: vec2f, axis: u32) -> vec3f {
    if axis == 0u { return vec3f(0.0, p.xy); }
    if axis == 1u { return vec3f(p.y, 0.0, p.x); }
    return vec3f(p.xy, 0.0);
}

// Weights of the three projections, with narrow blends, because otherwise patterns show through each other. Low quality
// uses the strongest projection alone.
fn plane_shares(n: vec3f) -> vec3f {
    var w = n * n;
    w = w * w * w;
    w /= w.x + w.y + w.z;
    let most = max(w.x, max(w.y, w.z));
    w = select(max(w - 0.08, vec3f(0.0)), vec3f(w == vec3f(most)), frame.pattern_quality == 0.0);
    return w / (w.x + w.y + w.z);
}

// The nth axis with a positive weight: taps of weight 0 are skipped, not multiplied by zero.
fn shown_axis(planes: vec3f, nth: u32) -> u32 {
    let is_shown = planes > vec3f(0.0);
    let x = u32(is_shown.x);
    let xy = x + u32(is_shown.y);
    return select(select(2u, 1u, nth < xy), 0u, nth < x);
}

// Width of a tap at low quality, by the distance between taps: each pixel stands for four of the others.
const LOW_TAP_WIDTH: f32 = 0.4;
// Level of detail from which it has one tap: there a pixel holds so much of the pattern that hardly more than its mean
// is left, and a second tap is not worth its time.
const LOW_TAPS_LOD: f32 = 5.5;

// Number of taps along the longer side of a pixel's footprint. One is enough where the whole pixel lies within a texel.
fn taps_along(seen: Seen, texel_m: f32, most: u32) -> u32 {
    let x = length(seen.rel_x);
    let y = length(seen.rel_y);
    return taps_for(max(x, y) / max(min(x, y), texel_m), most);
}

// Temperature of glowing ground relative to the mean (1): the crust varies in thickness. Without this, the glow, the
// brightest thing at night, shows the lattice of the repeating pattern.
fn heat(seen: Seen, period_m: f32, glow: f32) -> f32 {
    if glow <= 0.0 { return 1.0; }
    var sum = 0.0;
    for (var i = 0u; i < 2u; i++) {
        // A whole number of noise tiles fits into the 1024 m by which the position of the eye is wrapped.
        let tiles = max(round(select(0.09, 0.021, i == 1u) * 1024.0 / period_m), 1.0);
        let at = (body.eye_wrap_m + seen.rel_m) * (tiles / 1024.0);
        sum += textureSampleLevel(noise_tile, repeated, at.yzx, max(log2(seen.footprint_m * tiles / 16.0), 0.0)).g;
    }
    // Both values are distributed evenly over 0 to 1.
    return 2.0 * smoothstep(0.35, 1.65, sum);
}

// The pattern of a biome (a column of `biome_params`); -1 has none. All taps share one loop, because a software driver
// takes minutes to compile the unrolled taps.
fn pattern_of(id: i32, seen: Seen) -> Pattern {
    var out = no_pattern();
    if id < 0 { return out; }
    let layer = i32(textureLoad(biome_params, vec2i(id, 2), 0).w);
    let size = textureLoad(biome_params, vec2i(id, 3), 0);
    let glow = textureLoad(biome_params, vec2i(id, 4), 0);
    let lod = log2(seen.footprint_m * PATTERN_SIDE / size.x);
    // At this distance the coarsest level shows only its mean. Glow is still drawn.
    if layer < 0 || (lod > 8.5 && size.w <= 0.0) { return out; }

    // Flow downhill: two copies of the pattern are advected and reset in turn, and each fades out before its reset.
    let flows = size.z > 0.0 && lod < 6.0;
    let downhill = seen.n - seen.up * dot(seen.n, seen.up);
    let steep = length(downhill);
    let flow_m = downhill / max(steep, 0.02) * saturate1(0.15 + 3.0 * steep) * 0.5 * size.x;
    let turn = fract(frame.time_secs * size.z / (0.5 * size.x));

    let planes = plane_shares(seen.n);
    // The finer scale is for the ground at one's feet; it also hides the repetition of the coarser scale.
    let scales = select(1u, 2u, frame.pattern_quality > 0.0 && lod < 7.0);
    let is_low = frame.pattern_quality == 0.0;
    let most_steps = select(2u << u32(frame.pattern_quality), select(1u, 2u, lod < LOW_TAPS_LOD), is_low);
    let steps = taps_along(seen, select(size.x, glow.w, scales == 2u) / PATTERN_SIDE, most_steps);
    let tap_width = select(1.0, select(TAP_WIDTH, LOW_TAP_WIDTH, is_low), steps > 1u || is_low) / f32(steps);
    let axes = u32(planes.x > 0.0) + u32(planes.y > 0.0) + u32(planes.z > 0.0);
    let copies = axes * scales * steps;
    let taps = copies * select(1u, 2u, flows);
    var tint = vec3f(0.0);
    var slope = vec3f(0.0);
    var coarse = vec3f(0.0);
    for (var tap = 0u; tap < taps; tap++) {
        let axis = shown_axis(planes, tap % axes);
        let is_fine = (tap / axes) % scales == 1u;
        let step = (tap / (axes * scales)) % steps;
        let is_second = tap >= copies;
        var weight = planes[axis];
        let phase = fract(turn + select(0.0, 0.5, is_second));
        if flows { weight *= 1.0 - abs(2.0 * phase - 1.0); }
        weight /= f32(steps);
        let carried_m = select(vec3f(0.0), flow_m * (phase - 0.5), flows);
        let x = projected(seen.rel_x, axis);
        let y = projected(seen.rel_y, axis);
        let is_x_longer = dot(x, x) > dot(y, y);
        let long_m = select(y, x, is_x_longer);
        let wide_m = max(length(select(x, y, is_x_longer)), length(long_m) * tap_width);
        var p = projected(body.eye_wrap_m + seen.rel_m - carried_m, axis);
        p += long_m * tap_place(step, steps);
        var period_m = size.x;
        if is_fine {
            p = rotated(p);
            period_m = glow.w;
        }
        let level = log2(max(wide_m, 1e-6) * PATTERN_SIDE / period_m);
        let t = textureSampleLevel(material_tint, repeated, p / period_m, layer, level);
        let s = textureSampleLevel(material_surface, repeated, p / period_m, layer, level);
        var tilt = s.xy - 0.5;
        if is_fine { tilt = rotated_back(tilt); }
        let strength = weight * select(1.0, 0.5, is_fine);
        tint += strength * (2.0 * t.rgb - 1.0);
        slope += strength * unprojected(tilt, axis);
        if !is_fine { coarse += weight * vec3f(t.a, s.zw); }
    }
    out.tint = max(1.0 + tint * size.y, vec3f(0.0));
    out.slope = slope * (2.0 * PATTERN_STEEPEST * size.y);
    out.height = coarse.x;
    out.roughness = (coarse.y - 0.5) * (2.0 * PATTERN_ROUGHNESS * min(size.y, 1.0));
    // Cooler ground glows redder.
    out.glow = heat(seen, size.x, size.w) * coarse.z * size.w * pow(glow.rgb, vec3f(1.7 - 0.9 * saturate1(coarse.z)));
    out.far = smoothstep(1.0, 5.0, lod);
    out.shown = 1.0;
    return out;
}
