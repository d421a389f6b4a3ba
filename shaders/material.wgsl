// What the ground is made of at a pixel: the biomes of the table's cells around its climate, what the rules for steep ground,
// beaches and snow make of them, and the patterns of the two strongest. The rules are those of src/terrain/ground.rs, with soft
// edges where it has half-way marks. Must match the texels of src/render/biome_table.rs.
#include "detail.wgsl"
#include "mottle.wgsl"
#include "border.wgsl"
#include "material_pattern.wgsl"

// Columns of `biome_params` beside those of the palette: the rock that biomes share, and the rules for all.
const ROCK: i32 = 64;
const RULES: i32 = 65;

fn biome_param(id: i32, row: i32) -> vec4f { return textureLoad(biome_params, vec2i(id, row), 0); }

// What decides about the ground at a pixel.
struct Site {
    // Place in the table: moisture, and 1 minus the row
    table: vec2f,
    rel_m: vec3f,
    // Of the ground against the horizontal
    slope_cosine: f32,
    steep: Steepness,
    temperature_c: f32,
    // Height over the level of the sea, metres; beyond every beach where there is no sea
    over_sea_m: f32,
    // How far the ground within the pixel goes above and below that
    spread_m: f32,
    // What a metre of height adds to the place in the table (xy) and to the temperature (z)
    by_height: vec3f,
    footprint_m: f32,
    // -1 to 1
    mottle: f32,
}

struct Material {
    albedo: vec3f,
    roughness: f32,
    // Reflectance at a right angle
    specular: f32,
    // Rise over run of the pattern, as a gradient in the planet frame
    slope: vec3f,
    // Radiance of its own
    glow: vec3f,
}

fn biome_at(cell: vec2i) -> i32 {
    let last = vec2i(textureDimensions(biome_ids)) - 1;
    return i32(textureLoad(biome_ids, clamp(cell, vec2i(0), last), 0).r * 255.0 + 0.5);
}

// From 0 at `from` to 1 at `to`, whichever is greater.
fn soft(from_x: f32, to_x: f32, x: f32) -> f32 {
    let span = to_x - from_x;
    let t = saturate1((x - from_x) / select(span, 1e-6, span == 0.0));
    return t * t * (3.0 - 2.0 * t);
}

// Integral of what a beach's height alone makes of it, from its middle on: all up to 0.7 of its half width, nothing from 1.3 on.
fn beach_to(edge_m: f32, height_m: f32) -> f32 {
    let u = saturate1((abs(height_m) / edge_m - 0.7) / 0.6);
    return sign(height_m) * edge_m * (min(abs(height_m) / edge_m, 0.7) + 0.6 * (u - u * u * u + 0.5 * u * u * u * u));
}

// How much of the ground is beach (x) and snow (y) by height and temperature. Where a pixel is wider than a beach, its share of the
// land that is in the pixel.
fn covers_by_height(site: Site) -> vec2f {
    let beach = biome_param(RULES, 0);
    let snow = biome_param(RULES, 1);
    var share = vec2f(0.0);
    if beach.x >= 0.0 {
        let edge_m = beach.y * (1.0 + 0.25 * site.mottle);
        let spread_m = max(site.spread_m, 0.02 * edge_m);
        let high_m = site.over_sea_m + spread_m;
        let low_m = site.over_sea_m - spread_m;
        let land_m = mix(low_m, max(low_m, 0.0), saturate1(high_m / spread_m));
        share.x = saturate1((beach_to(edge_m, high_m) - beach_to(edge_m, land_m)) / max(high_m - land_m, 1e-4));
    }
    if snow.x >= 0.0 {
        let line_c = snow.y + 0.35 * snow.z * site.mottle;
        // As if the edge were as much softer as temperatures in the pixel differ.
        let spread_c = site.spread_m * site.by_height.z;
        let soft_c = 0.5 * sqrt(snow.z * snow.z + 6.7 * spread_c * spread_c);
        share.y = soft(line_c + soft_c, line_c - soft_c, site.temperature_c);
    }
    return share;
}

// The rules for slopes of the biomes around (rows 5 of their numbers), and of beach and snow.
fn slope_rules(cells: array<vec4f, 4>, cells_shift: f32, snow_shift: f32) -> SlopeRules {
    let covers = biome_param(RULES, 2);
    let from_x = vec4f(cells[0].y, cells[1].y, cells[2].y, cells[3].y) - cells_shift;
    let to_x = vec4f(cells[0].z, cells[1].z, cells[2].z, cells[3].z) - cells_shift;
    let shift = vec2f(0.0, snow_shift);
    return SlopeRules(from_x, to_x, covers.yw - shift, covers.xz - shift);
}

// The biome by the same rules without soft edges: what a query answers.
fn biome_of(site: Site) -> i32 {
    var id = biome_at(vec2i(floor(site.table * vec2f(textureDimensions(biome_ids)))));
    let rule = biome_param(id, 5);
    let steep = slope_shares(site.steep, slope_rules(array<vec4f, 4>(rule, rule, rule, rule), 0.0, 0.0)).cells.x;
    if rule.x >= 0.0 && steep > 0.5 && i32(rule.x) != ROCK { id = i32(rule.x); }
    var plain = site;
    plain.mottle = 0.0;
    let rules = covers_hard(plain);
    if rules.x { id = i32(biome_param(RULES, 0).x); }
    if rules.y { id = i32(biome_param(RULES, 1).x); }
    return id;
}

fn covers_hard(site: Site) -> vec2<bool> {
    let beach = biome_param(RULES, 0);
    let snow = biome_param(RULES, 1);
    let slopes = biome_param(RULES, 2);
    let is_beach = beach.x >= 0.0 && abs(site.over_sea_m) < beach.y && site.slope_cosine > 0.5 * (slopes.x + slopes.y);
    let is_snow = snow.x >= 0.0 && site.temperature_c < snow.y && site.slope_cosine > 0.5 * (slopes.z + slopes.w);
    return vec2<bool>(is_beach, is_snow);
}

// Sums over all biomes at a place, and the two strongest.
struct Mixture {
    albedo: vec3f,
    roughness: f32,
    specular: f32,
    ids: vec2i,
    weights: vec2f,
    first_color: vec3f,
    second_color: vec3f,
}

fn patch_share(tile_m: f32, patches: f32, site: Site) -> f32 {
    let lod = log2(site.footprint_m * 64.0 / tile_m);
    let away = smoothstep(-1.0, 2.5, lod);
    if patches <= 0.0 || away >= 1.0 { return patches; }
    let at = (globals.eye_wrap_far_m.xyz + site.rel_m) / tile_m;
    let noise = textureSampleLevel(noise_tile, repeated, at.zxy, max(lod, 0.0)).g;
    let edge = min(0.12, min(patches, 1.0 - patches));
    return mix(smoothstep(-edge, edge, patches - noise), patches, away);
}

// Adds a biome with its weight.
fn put(mixture: ptr<function, Mixture>, id: i32, weight: f32, site: Site) {
    let plain = biome_param(id, 0);
    let patches = biome_param(id, 1);
    let surface = biome_param(id, 2);
    let color = mix(plain.rgb, patches.rgb, patch_share(surface.z, patches.w, site)) * (1.0 + site.mottle * plain.a);
    (*mixture).albedo += weight * color;
    (*mixture).roughness += weight * surface.x;
    (*mixture).specular += weight * surface.y;
    if id == (*mixture).ids.x {
        (*mixture).weights.x += weight;
    } else if id == (*mixture).ids.y {
        (*mixture).weights.y += weight;
    } else if weight > (*mixture).weights.x {
        (*mixture).ids = vec2i(id, (*mixture).ids.x);
        (*mixture).weights = vec2f(weight, (*mixture).weights.x);
        (*mixture).second_color = (*mixture).first_color;
        (*mixture).first_color = color;
    } else if weight > (*mixture).weights.y {
        (*mixture).ids.y = id;
        (*mixture).weights.y = weight;
        (*mixture).second_color = color;
    }
}

fn mixture_at(site: Site) -> Mixture {
    // The cells around, as a texture's linear filter has them.
    let at = site.table * vec2f(textureDimensions(biome_ids)) - 0.5;
    let cell = vec2i(floor(at));
    let f = border_blend(at - floor(at));
    var ids: array<i32, 10>;
    var weights: array<f32, 10>;
    var rules: array<vec4f, 4>;
    for (var i = 0; i < 4; i++) {
        ids[2 * i] = biome_at(cell + vec2i(i & 1, i >> 1u));
        rules[i] = biome_param(ids[2 * i], 5);
    }
    let by_slope = slope_shares(site.steep, slope_rules(rules, 0.04 * site.mottle, 0.03 * site.mottle));
    let cover = covers_by_height(site) * by_slope.covers;
    let bare = (1.0 - cover.x) * (1.0 - cover.y);
    for (var i = 0; i < 4; i++) {
        let share = mix(1.0 - f, f, vec2f(vec2i(i & 1, i >> 1u)));
        let weight = bare * share.x * share.y;
        // What gives way to nothing has no rule.
        let steep = select(0.0, by_slope.cells[i], rules[i].x >= 0.0);
        weights[2 * i] = weight * (1.0 - steep);
        ids[2 * i + 1] = select(ids[2 * i], i32(rules[i].x), rules[i].x >= 0.0);
        weights[2 * i + 1] = weight * steep;
    }
    ids[8] = max(i32(biome_param(RULES, 0).x), 0);
    weights[8] = cover.x * (1.0 - cover.y);
    ids[9] = max(i32(biome_param(RULES, 1).x), 0);
    weights[9] = cover.y;
    // Most often all are the same.
    for (var i = 1; i < 8; i++) {
        if ids[i] == ids[0] { weights[0] += weights[i]; weights[i] = 0.0; }
    }
    var mixture = Mixture(vec3f(0.0), 0.0, 0.0, vec2i(-1), vec2f(0.0), vec3f(0.0), vec3f(0.0));
    for (var i = 0; i < i32(globals.misc.x); i++) {
        if weights[i] > 0.001 { put(&mixture, ids[i], weights[i], site); }
    }
    return mixture;
}

// The same where a pixel has more height in it than a cell of the table or the edge of the snow: in the middle of each of a few layers,
// or peaks and valleys as wide as pixels would sparkle.
fn mixture_over(site: Site) -> Mixture {
    let cells = abs(site.by_height.xy) * vec2f(textureDimensions(biome_ids));
    let snow = biome_param(RULES, 1);
    let by_snow = select(0.0, abs(site.by_height.z) / max(snow.z, 0.5), snow.x >= 0.0);
    let layers = i32(clamp(ceil(2.0 * site.spread_m * max(max(cells.x, cells.y), by_snow)), 1.0, 5.0));
    // An odd number, for the middle one has the patterns.
    let half = layers / 2;
    var sum = mixture_at(layer_of(site, 0.0, f32(2 * half + 1)));
    for (var i = 1; i <= half; i++) {
        for (var sign = -1; sign <= 1; sign += 2) {
            let other = mixture_at(layer_of(site, f32(sign * i), f32(2 * half + 1)));
            sum.albedo += other.albedo;
            sum.roughness += other.roughness;
            sum.specular += other.specular;
        }
    }
    let share = 1.0 / f32(2 * half + 1);
    sum.albedo *= share;
    sum.roughness *= share;
    sum.specular *= share;
    return sum;
}

// One of so many layers of the ground in a pixel, the middle one's number being 0.
fn layer_of(site: Site, number: f32, layers: f32) -> Site {
    var out = site;
    out.spread_m = site.spread_m / layers;
    let above_m = 2.0 * number * out.spread_m;
    let last = vec2f(1.0) - 0.5 / vec2f(textureDimensions(biome_ids));
    out.over_sea_m += above_m;
    out.table = clamp(site.table + above_m * site.by_height.xy, vec2f(0.0), last);
    out.temperature_c += above_m * site.by_height.z;
    return out;
}

// Everything at a pixel. `rel_x`, `rel_y`: from pixel to pixel, metres; `n`, `up`: of the ground and of the sphere.
fn material_at(site: Site, n: vec3f, up: vec3f, rel_x: vec3f, rel_y: vec3f) -> Material {
    let mixture = mixture_over(site);
    let both = mixture.weights.x + mixture.weights.y;
    let share = mixture.weights.y / max(both, 1e-6);
    let seen = Seen(site.rel_m, n, up, rel_x, rel_y, site.footprint_m);
    // Low quality has the pattern of the strongest alone.
    let strongest = select(0, 1, share > 0.5);
    var patterns: array<Pattern, 2>;
    patterns[0] = no_pattern();
    patterns[1] = no_pattern();
    for (var i = 0; i < 2; i++) {
        let shown = select(i == strongest, i == 0 || share > 0.01, globals.eye_wrap_far_m.w > 0.0);
        if shown { patterns[i] = pattern_of(mixture.ids[i], seen); }
    }
    let a = patterns[0];
    let b = patterns[1];
    var out: Material;
    var t = share;
    if globals.eye_wrap_far_m.w > 0.0 { t = share_by_height(a, b, share); }
    let tinted = mix(mixture.first_color * a.tint, mixture.second_color * b.tint, t);
    out.albedo = max(mixture.albedo + both * (tinted - mix(mixture.first_color, mixture.second_color, share)), vec3f(0.0));
    out.roughness = clamp(mixture.roughness + mix(a.roughness, b.roughness, t), 0.04, 1.0);
    out.slope = mix(a.slope, b.slope, t);
    out.glow = mix(a.glow, b.glow, t);
    out.specular = mixture.specular * 0.08;
    return out;
}
