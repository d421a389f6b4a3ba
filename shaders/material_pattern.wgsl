// Patterns of the ground: a tiling texture for each kind, projected along three axes (triplanar), at two scales,
// shifted from part to part so that no period is seen, and advected downhill where the material flows. Layout of the
// texels: src/planet/textures/layer.rs and src/render/biome_table.rs.
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
    // Share of the first sun's light that the heights around leave
    sun: f32,
}

fn no_pattern() -> Pattern { return Pattern(vec3f(1.0), 0.5, vec3f(0.0), 0.0, vec3f(0.0), 1.0, 0.0, 1.0); }

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

// A pattern between two; `t`: share of the second.
fn mixed_pattern(a: Pattern, b: Pattern, t: f32) -> Pattern {
    return Pattern(mix(a.tint, b.tint, t), mix(a.height, b.height, t), mix(a.slope, b.slope, t),
        mix(a.roughness, b.roughness, t), mix(a.glow, b.glow, t), mix(a.far, b.far, t), max(a.shown, b.shown),
        mix(a.sun, b.sun, t));
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

// Distances in periods over which the finer scale fades, and from there up to which the broader one comes, which is
// this many times as wide.
const FINE_PERIODS: vec2f = vec2f(3.0, 5.0);
const BROAD_PERIODS: f32 = 14.0;
const BROAD: f32 = 5.3;

// Parts of the ground show a pattern with a shift of their own, so that no period is seen. Where two parts meet, both
// shifts are mixed: the share of the second is 0 in most places.
struct Shifts {
    first: vec2f,
    second: vec2f,
    share: f32,
}

// Number of parts from the least to the greatest value of the noise, and periods of a pattern in a tile of that noise.
const SHIFTS: f32 = 8.0;
const SHIFT_PERIODS: f32 = 56.0;
// Half the width of the seam between two parts, as a share of a part.
const SHIFT_SEAM: f32 = 0.16;

fn shift_of(part: f32) -> vec2f { return unit_from_hash(hash3(vec3u(u32(part) + 1u, 7u, 19u))).xy; }

fn shifts_at(seen: Seen, period_m: f32) -> Shifts {
    let tiles = max(round(WRAP_M / (SHIFT_PERIODS * period_m)), 1.0);
    let at = (body.eye_wrap_m + seen.rel_m) * (tiles / WRAP_M);
    let lod = max(log2(seen.footprint_m * tiles * (NOISE_TILE_SIDE / WRAP_M)), 0.0);
    let part = SHIFTS * textureSampleLevel(noise_tile, repeated, at.yzx, lod).g;
    let whole = floor(part);
    let share = smoothstep(0.5 - SHIFT_SEAM, 0.5 + SHIFT_SEAM, part - whole);
    let next = shift_of(whole + 1.0);
    if share >= 1.0 { return Shifts(next, next, 0.0); }
    return Shifts(shift_of(whole), next, share);
}

// Texture layers of a biome (a column of `biome_params`): of its own pattern (x), and of that of its patches (y); -1
// for none.
fn pattern_layers(id: i32) -> vec2i {
    if id < 0 { return vec2i(-1); }
    return vec2i(textureLoad(biome_params, vec2i(id, 6), 0).xy);
}

// Relief of a pattern near the eye: how far the ground that is seen lies aside of the plane on which it is drawn, in
// metres, because its heights hide what is behind them; and the share of the first sun's light that they leave. Heights
// are about the plane, so their mean is the ground's.
struct PatternRelief {
    aside_m: vec3f,
    sun: f32,
}

// Levels of detail, by the mean side of the pixel, over which the relief ends.
const RELIEF_LODS: vec2f = vec2f(1.2, 3.4);
// Sines of rays over the ground over which it ends: on flatter ones steps are wide.
const RELIEF_SINES: vec2f = vec2f(0.05, 0.3);
// Lowest rays over the ground that are followed, as sines: lower ones are followed as these.
const LOWEST_EYE: f32 = 0.16;
const LOWEST_SUN: f32 = 0.09;
// Greatest range of heights in periods: deeper patterns are drawn as deep.
const DEEPEST: f32 = 0.1;
// Halvings of the last level.
const HALVINGS: u32 = 3u;
// Width of the edge of shadows: rise over run.
const SHADOW_EDGE: f32 = 0.3;

// Height of a pattern at a place in periods, as a share of its range, -0.5 to 0.5. Where patterns glow it is the rank.
fn pattern_height(at: vec2f, layer: i32, level: f32, by_rank: bool) -> f32 {
    if by_rank { return textureSampleLevel(material_tint, repeated, at, layer, level).a - 0.5; }
    return textureSampleLevel(material_surface, repeated, at, layer, level).a - 0.5;
}

// `range_m`: from the lowest to the highest ground. `at`: place in periods on the plane. Rays go through heights level
// by level from the top, and then by halves (Policarpo et al., Real-time relief mapping on arbitrary polygonal
// surfaces, 2005).
fn pattern_relief(
    layer: i32, by_rank: bool, range_m: f32, period_m: f32, level: f32, axis: u32, at: vec2f, seen: Seen,
) -> PatternRelief {
    let eye = normalize(-seen.rel_m);
    let eye_n = dot(eye, seen.n);
    // How far aside the ray to the eye, and that to the sun, go while they rise by the whole range.
    let to_eye_m = (eye - seen.n * eye_n) * (range_m / max(eye_n, LOWEST_EYE));
    let to_eye = projected(to_eye_m, axis) / period_m;
    let steps = select(6u, 12u, frame.pattern_quality > 1.0);
    var lower = 1.0 / f32(steps);
    // What is narrower than a step would be met or missed by chance: it is taken for its mean.
    let step_level = log2(max(length(to_eye) * lower * PATTERN_SIDE, 1e-3)) - 1.0;
    var z = 0.5;
    for (var i = 0u; i < steps; i++) {
        if pattern_height(at + to_eye * z, layer, max(level, step_level), by_rank) >= z { break; }
        z -= lower;
    }
    for (var i = 0u; i < HALVINGS; i++) {
        let is_under = pattern_height(at + to_eye * z, layer, max(level, step_level - f32(i)), by_rank) >= z;
        lower *= 0.5;
        z += select(-lower, lower, is_under);
    }
    z = clamp(z, -0.5, 0.5);
    var out = PatternRelief(to_eye_m * z, 1.0);
    let sun = body.suns[0].dir;
    let sun_n = dot(sun, seen.n);
    if sun_n <= 0.0 { return out; }
    let to_sun = projected(sun - seen.n * sun_n, axis) * (range_m / (max(sun_n, LOWEST_SUN) * period_m));
    let start = at + to_eye * z;
    // What was found on a steep side may lie within it.
    let foot = max(z, pattern_height(start, layer, level, by_rank));
    let sun_steps = select(5u, 10u, frame.pattern_quality > 1.0);
    let soft = SHADOW_EDGE * length(to_sun) * period_m / range_m;
    let per_rise = length(to_sun) * (0.5 - foot) * PATTERN_SIDE;
    var hidden = 0.0;
    for (var i = 1u; i <= sun_steps; i++) {
        // Closer near the ground, where thin things stand.
        let share = f32(i) / f32(sun_steps);
        let rise = (0.5 - foot) * share * share;
        let wide = per_rise * (2.0 * share - 1.0 / f32(sun_steps)) / f32(sun_steps);
        let blurred = max(level, log2(max(wide, 1e-3)) - 1.0);
        let ground = pattern_height(start + to_sun * rise, layer, blurred, by_rank);
        hidden = max(hidden, (ground - foot - rise) / (soft * rise + 0.04));
    }
    out.sun = 1.0 - saturate1(hidden);
    return out;
}

// How a biome shows a layer (row 7 of its parameters): the range of heights in periods, negative where they are ranks
// (x); the period of the finer scale in metres, 0 without one (y).
fn layer_shown(id: i32, is_patch: bool) -> vec2f {
    let row = textureLoad(biome_params, vec2i(id, 7), 0);
    return select(row.xz, row.yw, is_patch);
}

// Relief of a layer, which ends where pixels get wide and rays flat. `size`: row 3 of the biome's parameters.
fn relief_near(layer: i32, relief: f32, size: vec4f, planes: vec3f, shifts: Shifts, seen: Seen) -> PatternRelief {
    // By the mean of both sides of the pixel.
    let width_m = sqrt(max(length(seen.rel_x) * length(seen.rel_y), 1e-9));
    let lod = log2(width_m * PATTERN_SIDE / size.x);
    let eye_n = -dot(seen.rel_m, seen.n) / max(length(seen.rel_m), 1e-6);
    let clear = (1.0 - smoothstep(RELIEF_LODS.x, RELIEF_LODS.y, lod))
        * smoothstep(RELIEF_SINES.x, RELIEF_SINES.y, eye_n);
    let range_m = min(abs(relief), DEEPEST) * size.x * size.y * clear;
    if range_m <= 0.0 { return PatternRelief(vec3f(0.0), 1.0); }
    let axis = select(select(2u, 1u, planes.y > planes.z), 0u, planes.x > max(planes.y, planes.z));
    let at = projected(body.eye_wrap_m + seen.rel_m, axis) / size.x
        + select(shifts.first, shifts.second, shifts.share > 0.5);
    let found = pattern_relief(layer, relief < 0.0, range_m, size.x, max(lod - 0.5, 0.0), axis, at, seen);
    return PatternRelief(found.aside_m, mix(1.0, found.sun, clear));
}

// A layer as a biome shows it. All taps share one loop, because a software driver takes minutes to compile the unrolled
// taps.
fn pattern_of(id: i32, layer: i32, shown: vec2f, seen: Seen) -> Pattern {
    var out = no_pattern();
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
    // A second scale: a finer one for the ground at one's feet, and farther away a broader one, which is still seen
    // where the pattern itself has become its mean. Both go by distance, so that a picture of more pixels has the same.
    let away = length(seen.rel_m) / size.x;
    let is_broad = away > FINE_PERIODS.y;
    let second = 0.5 * select(
        1.0 - smoothstep(FINE_PERIODS.x, FINE_PERIODS.y, away), smoothstep(FINE_PERIODS.y, BROAD_PERIODS, away), is_broad,
    );
    let second_m = select(shown.y, WRAP_M / max(round(WRAP_M / (BROAD * size.x)), 1.0), is_broad);
    let scales = select(1u, 2u, frame.pattern_quality > 0.0 && lod < select(7.0, 8.5, is_broad)
        && second > 0.0 && second_m > 0.0);
    let is_low = frame.pattern_quality == 0.0;
    let most_steps = select(2u << u32(frame.pattern_quality), select(1u, 2u, lod < LOW_TAPS_LOD), is_low);
    let steps = taps_along(seen, select(size.x, shown.y, scales == 2u && !is_broad) / PATTERN_SIDE, most_steps);
    let tap_width = select(1.0, select(TAP_WIDTH, LOW_TAP_WIDTH, is_low), steps > 1u || is_low) / f32(steps);
    let axes = u32(planes.x > 0.0) + u32(planes.y > 0.0) + u32(planes.z > 0.0);
    let copies = axes * scales * steps;
    let taps = copies * select(1u, 2u, flows);
    var shifts = Shifts(vec2f(0.0), vec2f(0.0), 0.0);
    if !is_low && !flows { shifts = shifts_at(seen, size.x); }
    // Two patterns in their mean have less contrast than one: the deviation from the mean is as much greater.
    let contrast = inverseSqrt(1.0 - 2.0 * shifts.share * (1.0 - shifts.share));
    var relief = PatternRelief(vec3f(0.0), 1.0);
    if !is_low && !flows { relief = relief_near(layer, shown.x, size, planes, shifts, seen); }
    out.sun = relief.sun;
    var tint = vec3f(0.0);
    var slope = vec3f(0.0);
    var coarse = vec3f(0.0);
    for (var tap = 0u; tap < taps; tap++) {
        let axis = shown_axis(planes, tap % axes);
        let is_second = (tap / axes) % scales == 1u;
        let step = (tap / (axes * scales)) % steps;
        let is_reset = tap >= copies;
        var weight = planes[axis];
        let phase = fract(turn + select(0.0, 0.5, is_reset));
        if flows { weight *= 1.0 - abs(2.0 * phase - 1.0); }
        weight /= f32(steps);
        let carried_m = select(vec3f(0.0), flow_m * (phase - 0.5), flows);
        let x = projected(seen.rel_x, axis);
        let y = projected(seen.rel_y, axis);
        let is_x_longer = dot(x, x) > dot(y, y);
        let long_m = select(y, x, is_x_longer);
        let wide_m = max(length(select(x, y, is_x_longer)), length(long_m) * tap_width);
        var p = projected(body.eye_wrap_m + seen.rel_m + relief.aside_m - carried_m, axis);
        p += long_m * tap_place(step, steps);
        var period_m = size.x;
        if is_second {
            if !is_broad { p = rotated(p); }
            period_m = second_m;
        }
        let level = log2(max(wide_m, 1e-6) * PATTERN_SIDE / period_m);
        let at = p / period_m;
        var t = textureSampleLevel(material_tint, repeated, at + shifts.first, layer, level);
        var s = textureSampleLevel(material_surface, repeated, at + shifts.first, layer, level);
        if shifts.share > 0.0 {
            let other_t = textureSampleLevel(material_tint, repeated, at + shifts.second, layer, level);
            let other_s = textureSampleLevel(material_surface, repeated, at + shifts.second, layer, level);
            t = 0.5 + contrast * (mix(t, other_t, shifts.share) - 0.5);
            s = vec4f(0.5 + contrast * (mix(s.xyz, other_s.xyz, shifts.share) - 0.5), mix(s.w, other_s.w, shifts.share));
        }
        var tilt = s.xy - 0.5;
        if is_second && !is_broad { tilt = rotated_back(tilt); }
        let strength = weight * select(1.0, second, is_second);
        tint += strength * (2.0 * t.rgb - 1.0);
        slope += strength * unprojected(tilt, axis);
        // Where heights are told their place is that of the glow.
        if !is_second { coarse += weight * vec3f(t.a, s.z, select(0.0, s.w, shown.x <= 0.0)); }
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
