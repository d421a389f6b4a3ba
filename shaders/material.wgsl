// What the ground is made of at a pixel: the biomes of the table's cells around its climate, what the rules for steep ground,
// beaches and snow make of them, and the patterns of the two strongest. The rules are those of src/terrain/ground.rs, with soft
// edges where it has half-way marks. Must match the texels of src/render/biome_table.rs.
#include "detail.wgsl"
#include "mottle.wgsl"
#include "border.wgsl"
#include "material_pattern.wgsl"

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
    // How far the ground within the pixel goes above and below that: by its slope alone, and with all that is no wider than pixels
    plane_m: f32,
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

// How much of the ground is beach by height. Where a pixel is wider than a beach, its share of the land that is in the pixel.
fn beach_by_height(site: Site) -> f32 {
    let beach = biome_param(BIOME_RULES, 0);
    if beach.x < 0.0 { return 0.0; }
    let edge_m = beach.y * (1.0 + 0.25 * site.mottle);
    let spread_m = max(site.spread_m, 0.02 * edge_m);
    let high_m = site.over_sea_m + spread_m;
    let low_m = site.over_sea_m - spread_m;
    let land_m = mix(low_m, max(low_m, 0.0), saturate1(high_m / spread_m));
    return saturate1((beach_to(edge_m, high_m) - beach_to(edge_m, land_m)) / max(high_m - land_m, 1e-4));
}

// How far above the middle of a pixel snow covers all of the ground (x), and how far none (y): metres.
fn snow_heights(site: Site) -> vec2f {
    let snow = biome_param(BIOME_RULES, 1);
    if snow.x < 0.0 { return vec2f(2e9, 1e9); }
    let line_c = snow.y + 0.35 * snow.z * site.mottle;
    // As if the edge were as much softer as temperatures in the pixel differ by its slope.
    let colder = min(site.by_height.z, -1e-6);
    let plane_c = site.plane_m * colder;
    let soft_c = 0.5 * sqrt(snow.z * snow.z + 6.7 * plane_c * plane_c + 1e-6);
    return (vec2f(line_c - soft_c, line_c + soft_c) - site.temperature_c) / colder;
}

// The rules for slopes of the biomes around (rows 5 of their numbers), and of beach and snow.
fn slope_rules(cells: array<vec4f, 4>, site: Site) -> SlopeRules {
    let covers = biome_param(BIOME_RULES, 2);
    let shift = 0.04 * site.mottle;
    let from_x = vec4f(cells[0].y, cells[1].y, cells[2].y, cells[3].y) - shift;
    let to_x = vec4f(cells[0].z, cells[1].z, cells[2].z, cells[3].z) - shift;
    let covers_shift = vec2f(0.0, 0.03 * site.mottle);
    return SlopeRules(from_x, to_x, covers.yw - covers_shift, covers.xz - covers_shift, snow_heights(site));
}

// The biome by the same rules without soft edges: what a query answers.
fn biome_of(site: Site) -> i32 {
    var id = biome_at(vec2i(floor(site.table * vec2f(textureDimensions(biome_ids)))));
    let rule = biome_param(id, 5);
    var plain = site;
    plain.mottle = 0.0;
    let steep = slope_shares(site.steep, slope_rules(array<vec4f, 4>(rule, rule, rule, rule), plain)).cells.x;
    if rule.x >= 0.0 && steep > 0.5 && i32(rule.x) != BIOME_ROCK { id = i32(rule.x); }
    let rules = covers_hard(plain);
    if rules.x { id = i32(biome_param(BIOME_RULES, 0).x); }
    if rules.y { id = i32(biome_param(BIOME_RULES, 1).x); }
    return id;
}

fn covers_hard(site: Site) -> vec2<bool> {
    let beach = biome_param(BIOME_RULES, 0);
    let snow = biome_param(BIOME_RULES, 1);
    let slopes = biome_param(BIOME_RULES, 2);
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
    let lod = log2(site.footprint_m * NOISE_TILE_SIDE / tile_m);
    let away = smoothstep(-1.0, 2.5, lod);
    if patches <= 0.0 || away >= 1.0 { return patches; }
    let at = (body.eye_wrap_far_m + site.rel_m) / tile_m;
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

// The cells of the table around a place, as a texture's linear filter has them.
struct Cells {
    ids: array<i32, 4>,
    shares: vec4f,
    // Rows 5 of their numbers
    rules: array<vec4f, 4>,
}

fn cells_at(table: vec2f) -> Cells {
    let at = table * vec2f(textureDimensions(biome_ids)) - 0.5;
    let cell = vec2i(floor(at));
    let f = border_blend(at - floor(at));
    var out: Cells;
    out.shares = vec4f(1.0 - f.x, f.x, 1.0 - f.x, f.x) * vec4f(1.0 - f.y, 1.0 - f.y, f.y, f.y);
    for (var i = 0; i < 4; i++) {
        out.ids[i] = biome_at(cell + vec2i(i & 1, i >> 1u));
        out.rules[i] = biome_param(out.ids[i], 5);
    }
    return out;
}

// `steep`: how much of each cell's ground is steep; `cover`: how much is beach and snow.
fn mixture_of(cells: Cells, steep: vec4f, cover: vec2f, site: Site) -> Mixture {
    var ids: array<i32, MIXTURE_ENTRIES>;
    var weights: array<f32, MIXTURE_ENTRIES>;
    let bare = (1.0 - cover.x) * (1.0 - cover.y);
    for (var i = 0; i < 4; i++) {
        let weight = bare * cells.shares[i];
        // What gives way to nothing has no rule.
        let into = cells.rules[i].x;
        let gone = select(0.0, steep[i], into >= 0.0);
        ids[2 * i] = cells.ids[i];
        weights[2 * i] = weight * (1.0 - gone);
        ids[2 * i + 1] = select(cells.ids[i], i32(into), into >= 0.0);
        weights[2 * i + 1] = weight * gone;
    }
    ids[8] = max(i32(biome_param(BIOME_RULES, 0).x), 0);
    weights[8] = cover.x * (1.0 - cover.y);
    ids[9] = max(i32(biome_param(BIOME_RULES, 1).x), 0);
    weights[9] = cover.y;
    // Most often all are the same.
    for (var i = 1; i < 8; i++) {
        if ids[i] == ids[0] { weights[0] += weights[i]; weights[i] = 0.0; }
    }
    var mixture = Mixture(vec3f(0.0), 0.0, 0.0, vec2i(-1), vec2f(0.0), vec3f(0.0), vec3f(0.0));
    for (var i = 0; i < i32(frame.mixture_entries); i++) {
        if weights[i] > 0.001 { put(&mixture, ids[i], weights[i], site); }
    }
    return mixture;
}

// The mixture at a pixel. Where it has more height in it than a cell of the table, that of a few layers from the lowest to the highest
// ground: peaks and valleys no wider than pixels would sparkle.
fn mixture_at(site: Site) -> Mixture {
    let cells = cells_at(site.table);
    let rules = slope_rules(cells.rules, site);
    let shares = slope_shares(site.steep, rules);
    let cover = vec2f(beach_by_height(site) * shares.covers.x, shares.covers.y);
    var sum = mixture_of(cells, shares.cells, cover, site);
    let size = vec2f(textureDimensions(biome_ids));
    let spread = site.spread_m * site.by_height.xy;
    let crossed = max(abs(spread.x) * size.x, abs(spread.y) * size.y);
    // Above and below the middle one, which has the patterns.
    let half = i32(clamp(ceil(crossed - 0.25), 0.0, 2.0));
    let share = 1.0 / f32(2 * half + 1);
    for (var i = -half; i <= half; i++) {
        if i == 0 { continue; }
        let place = clamp(site.table + f32(2 * i) * share * spread, vec2f(0.0), vec2f(1.0) - 0.5 / size / size);
        let others = cells_at(place);
        let others_rules = slope_rules(others.rules, site);
        var steep = shares.cells;
        if any(others_rules.cells_from != rules.cells_from) || any(others_rules.cells_to != rules.cells_to) {
            steep = slope_shares(site.steep, others_rules).cells;
        }
        let other = mixture_of(others, steep, cover, site);
        sum.albedo += other.albedo;
        sum.roughness += other.roughness;
        sum.specular += other.specular;
    }
    sum.albedo *= share;
    sum.roughness *= share;
    sum.specular *= share;
    return sum;
}

// Everything at a pixel. `rel_x`, `rel_y`: from pixel to pixel, metres; `n`, `up`: of the ground and of the sphere.
fn material_at(site: Site, n: vec3f, up: vec3f, rel_x: vec3f, rel_y: vec3f) -> Material {
    let mixture = mixture_at(site);
    let both = mixture.weights.x + mixture.weights.y;
    let share = mixture.weights.y / max(both, 1e-6);
    let seen = Seen(site.rel_m, n, up, rel_x, rel_y, site.footprint_m);
    // Low quality has the pattern of the strongest alone.
    let strongest = select(0, 1, share > 0.5);
    var patterns: array<Pattern, 2>;
    patterns[0] = no_pattern();
    patterns[1] = no_pattern();
    for (var i = 0; i < 2; i++) {
        let shown = select(i == strongest, i == 0 || share > 0.01, frame.pattern_quality > 0.0);
        if shown { patterns[i] = pattern_of(mixture.ids[i], seen); }
    }
    let a = patterns[0];
    let b = patterns[1];
    var out: Material;
    var t = share;
    if frame.pattern_quality > 0.0 { t = share_by_height(a, b, share); }
    let tinted = mix(mixture.first_color * a.tint, mixture.second_color * b.tint, t);
    out.albedo = max(mixture.albedo + both * (tinted - mix(mixture.first_color, mixture.second_color, share)), vec3f(0.0));
    out.roughness = clamp(mixture.roughness + mix(a.roughness, b.roughness, t), 0.04, 1.0);
    out.slope = mix(a.slope, b.slope, t);
    out.glow = mix(a.glow, b.glow, t);
    out.specular = mixture.specular * 0.08;
    return out;
}
