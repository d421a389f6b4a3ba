// The patterns of the ground: a tiling picture for each kind, seen along three axes, at two scales that never repeat together,
// and carried downhill where it flows. Must match src/render/material_maps.rs and biome_table.rs.
#include "globals.wgsl"
#include "tables.wgsl"

const PATTERN_STEEPEST: f32 = 1.25;
const PATTERN_ROUGHNESS: f32 = 0.5;
const PATTERN_SIDE: f32 = 256.0;

// A piece of ground as a pixel sees it.
struct Seen {
    rel_m: vec3f,
    n: vec3f,
    up: vec3f,
    rel_x: vec3f,
    rel_y: vec3f,
    footprint_m: f32,
}

struct Pattern {
    // Mean 1
    tint: vec3f,
    // 0 to 1, evenly spread; 0.5 without a pattern
    height: f32,
    slope: vec3f,
    roughness: f32,
    glow: vec3f,
    // 0 from near, 1 where only the mean is left
    far: f32,
    shown: f32,
}

fn no_pattern() -> Pattern { return Pattern(vec3f(1.0), 0.5, vec3f(0.0), 0.0, vec3f(0.0), 1.0, 0.0); }

fn mixed(a: Pattern, b: Pattern, share: f32) -> Pattern {
    var out = a;
    out.tint = mix(a.tint, b.tint, share);
    out.slope = mix(a.slope, b.slope, share);
    out.roughness = mix(a.roughness, b.roughness, share);
    out.glow = mix(a.glow, b.glow, share);
    return out;
}

// How much of the second shows where it has this share (at most a half) on the whole: where it is so much higher than the first.
// Of two heights that are spread evenly, or one and a plane, so much of the ground is beyond the threshold.
fn share_by_height(a: Pattern, b: Pattern, share: f32) -> f32 {
    let patterns = a.shown + b.shown;
    if patterns < 0.5 { return share; }
    let threshold = select(0.5 - share, 1.0 - sqrt(2.0 * share), patterns > 1.5);
    let edge = 0.10;
    return mix(smoothstep(threshold - edge, threshold + edge, b.height - a.height), share, max(a.far, b.far));
}

struct Texel {
    tint: vec4f,
    surface: vec4f,
}

// Low quality has one tap on one plane.
fn texel_at(uv: vec2f, x: vec2f, y: vec2f, layer: i32, lod: f32) -> Texel {
    if globals.modes.w == 0u {
        return Texel(
            textureSampleLevel(material_tint, repeated, uv, layer, lod),
            textureSampleLevel(material_surface, repeated, uv, layer, lod),
        );
    }
    return Texel(
        textureSampleGrad(material_tint, patterned, uv, layer, x, y),
        textureSampleGrad(material_surface, patterned, uv, layer, x, y),
    );
}

// Turned by the angle of the triangle with sides 3, 4 and 5: what repeats after 1024 m still does.
fn turned(p: vec2f) -> vec2f { return vec2f(0.6 * p.x + 0.8 * p.y, 0.6 * p.y - 0.8 * p.x); }
fn turned_back(p: vec2f) -> vec2f { return vec2f(0.6 * p.x - 0.8 * p.y, 0.6 * p.y + 0.8 * p.x); }

// One plane: tint and height; slopes along its axes, roughness, glow.
fn plane_at(p: vec2f, x: vec2f, y: vec2f, layer: i32, size: vec4f, fine_m: f32, lod: f32) -> Texel {
    var out = texel_at(p / size.x, x / size.x, y / size.x, layer, lod);
    var tint = 1.0 + (2.0 * out.tint.rgb - 1.0) * size.y;
    var slope = (out.surface.xy - 0.5) * (2.0 * PATTERN_STEEPEST * size.y);
    if globals.modes.w > 0u {
        // Finer, for what is right before one's feet; it also hides that the coarser one repeats.
        let fine = texel_at(turned(p) / fine_m, turned(x) / fine_m, turned(y) / fine_m, layer, lod + 1.7);
        tint *= 1.0 + (2.0 * fine.tint.rgb - 1.0) * size.y * 0.5;
        slope += turned_back(fine.surface.xy - 0.5) * (2.0 * PATTERN_STEEPEST * 0.5 * size.y);
        out.surface.z = mix(out.surface.z, fine.surface.z, 0.35);
    }
    out.tint = vec4f(max(tint, vec3f(0.0)), out.tint.a);
    out.surface = vec4f(slope, (out.surface.z - 0.5) * (2.0 * PATTERN_ROUGHNESS * min(size.y, 1.0)), out.surface.w);
    return out;
}

fn planes_at(p: vec3f, view: Seen, layer: i32, size: vec4f, fine_m: f32, lod: f32) -> Pattern {
    // The plane that the ground faces, and the others where it faces both; sharply, or patterns show through each other.
    var w = view.n * view.n;
    w = w * w * w;
    w /= w.x + w.y + w.z;
    let most = max(w.x, max(w.y, w.z));
    w = select(max(w - 0.08, vec3f(0.0)), select(vec3f(0.0), vec3f(1.0), w == vec3f(most)), globals.modes.w == 0u);
    w /= w.x + w.y + w.z;
    var tint = vec4f(0.0);
    var slope = vec3f(0.0);
    var rest = vec2f(0.0);
    if w.x > 0.0 {
        let t = plane_at(p.yz, view.rel_x.yz, view.rel_y.yz, layer, size, fine_m, lod);
        tint += w.x * t.tint;
        slope += w.x * vec3f(0.0, t.surface.xy);
        rest += w.x * t.surface.zw;
    }
    if w.y > 0.0 {
        let t = plane_at(p.zx, view.rel_x.zx, view.rel_y.zx, layer, size, fine_m, lod);
        tint += w.y * t.tint;
        slope += w.y * vec3f(t.surface.y, 0.0, t.surface.x);
        rest += w.y * t.surface.zw;
    }
    if w.z > 0.0 {
        let t = plane_at(p.xy, view.rel_x.xy, view.rel_y.xy, layer, size, fine_m, lod);
        tint += w.z * t.tint;
        slope += w.z * vec3f(t.surface.xy, 0.0);
        rest += w.z * t.surface.zw;
    }
    return Pattern(tint.rgb, tint.a, slope, rest.x, vec3f(rest.y), 0.0, 1.0);
}

// The pattern of a biome (a column of `biome_params`); -1 has none.
fn pattern_of(id: i32, view: Seen) -> Pattern {
    if id < 0 { return no_pattern(); }
    let layer = textureLoad(biome_params, vec2i(id, 2), 0).w;
    if layer < 0.0 { return no_pattern(); }
    let size = textureLoad(biome_params, vec2i(id, 3), 0);
    let glow = textureLoad(biome_params, vec2i(id, 4), 0);
    let lod = log2(view.footprint_m * PATTERN_SIDE / size.x);
    // Where not even the coarsest level would show more than its mean, a glow excepted.
    if lod > 8.5 && size.w <= 0.0 { return no_pattern(); }
    let p = globals.eye_wrap_m.xyz + view.rel_m;
    var out: Pattern;
    if size.z > 0.0 && lod < 6.0 {
        // Downhill; each of two copies is carried for a while and starts anew while the other is shown.
        let downhill = view.n - view.up * dot(view.n, view.up);
        let steep = length(downhill);
        let way = downhill / max(steep, 0.02) * saturate1(0.15 + 3.0 * steep);
        let turns = globals.ray_forward.w * size.z / (0.5 * size.x);
        let a = fract(turns);
        let b = fract(turns + 0.5);
        out = mixed(
            planes_at(p - way * (a - 0.5) * 0.5 * size.x, view, i32(layer), size, glow.w, lod),
            planes_at(p - way * (b - 0.5) * 0.5 * size.x, view, i32(layer), size, glow.w, lod),
            abs(2.0 * a - 1.0),
        );
    } else {
        out = planes_at(p, view, i32(layer), size, glow.w, lod);
    }
    out.glow *= glow.rgb * size.w;
    out.far = smoothstep(1.0, 5.0, lod);
    return out;
}
