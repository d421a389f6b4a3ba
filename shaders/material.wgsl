// Material of the ground at a pixel: the biomes of the cells around its location in the biome table, surface rules
// (steep ground, beaches, snow), and the patterns of the two strongest biomes. The surface rules are those of
// src/terrain/ground.rs; they have soft edges centred on the thresholds there. Layout of the texels:
// src/render/biome_table.rs.
#include "detail.wgsl"
#include "border.wgsl"
#include "material_pattern.wgsl"

fn biome_param(id: i32, row: i32) -> vec4f { return textureLoad(biome_params, vec2i(id, row), 0); }

// Inputs of the biome and the surface rules at a pixel.
struct Site {
    // Location in the biome table: moisture, and 1 minus the row
    table: vec2f,
    rel_m: vec3f,
    // Cosine of the angle between the ground and the horizontal
    slope_cosine: f32,
    steep: Steepness,
    temperature_c: f32,
    // Height above sea level in metres; above every beach on a planet with no sea
    over_sea_m: f32,
    // Half the range of heights within the pixel in metres: from the slope alone, and with all unevenness no wider than
    // pixels
    plane_m: f32,
    spread_m: f32,
    // Change by a metre of height: of the location in the biome table (xy) and of the temperature in °C (z)
    by_height: vec3f,
    slant: Slant,
    // Macro variation, -1 to 1
    variation: f32,
}

struct Material {
    albedo: vec3f,
    roughness: f32,
    // Reflectance at normal incidence
    specular: f32,
    // Slope of the pattern (rise over run), as a gradient in the planet frame
    slope: vec3f,
    // Emitted radiance
    glow: vec3f,
    // The two strongest biomes, -1 for none, and their shares
    biomes: vec2<i32>,
    shares: vec2f,
    // Factor of the pattern on the albedo
    tint: vec3f,
    // Height of small bumps as a share of those of bare rock
    bumps: f32,
    // Share of the first sun's light that the heights of the pattern leave
    sun: f32,
}

fn biome_at(cell: vec2i) -> i32 {
    let last = vec2i(textureDimensions(biome_ids)) - 1;
    return i32(textureLoad(biome_ids, clamp(cell, vec2i(0), last), 0).r * 255.0 + 0.5);
}

// Smooth step from 0 at `from_x` to 1 at `to_x`; either may be the greater.
fn soft(from_x: f32, to_x: f32, x: f32) -> f32 {
    let span = to_x - from_x;
    let t = saturate1((x - from_x) / select(span, 1e-6, span == 0.0));
    return t * t * (3.0 - 2.0 * t);
}

// Integral over height of the beach's share, from sea level to `height_m`: the share is 1 up to 0.7 of the beach's
// height `edge_m` and 0 from 1.3 of it on.
fn beach_to(edge_m: f32, height_m: f32) -> f32 {
    let u = saturate1((abs(height_m) / edge_m - 0.7) / 0.6);
    return sign(height_m) * edge_m * (min(abs(height_m) / edge_m, 0.7) + 0.6 * (u - u * u * u + 0.5 * u * u * u * u));
}

// Share of beach by height. Where a pixel spans more than a beach, its share of the land in the pixel.
fn beach_by_height(site: Site) -> f32 {
    let beach = biome_param(BIOME_RULES, 0);
    if beach.x < 0.0 { return 0.0; }
    let edge_m = beach.y * (1.0 + 0.25 * site.variation);
    let spread_m = max(site.spread_m, 0.02 * edge_m);
    let high_m = site.over_sea_m + spread_m;
    let low_m = site.over_sea_m - spread_m;
    let land_m = mix(low_m, max(low_m, 0.0), saturate1(high_m / spread_m));
    return saturate1((beach_to(edge_m, high_m) - beach_to(edge_m, land_m)) / max(high_m - land_m, 1e-4));
}

// Height above the middle of a pixel from which snow covers all ground (x), and below which there is none (y), in
// metres.
fn snow_heights(site: Site) -> vec2f {
    let snow = biome_param(BIOME_RULES, 1);
    if snow.x < 0.0 { return vec2f(2e9, 1e9); }
    let line_c = snow.y + 0.35 * snow.z * site.variation;
    // The edge is widened by the range of temperatures within the pixel that is due to its slope.
    let colder = min(site.by_height.z, -1e-6);
    let plane_c = site.plane_m * colder;
    let soft_c = 0.5 * sqrt(snow.z * snow.z + 6.7 * plane_c * plane_c + 1e-6);
    return (vec2f(line_c - soft_c, line_c + soft_c) - site.temperature_c) / colder;
}

// Slope rules of the four biomes around (row 5 of their parameters), of beaches and of snow.
fn slope_rules(cells: array<vec4f, 4>, site: Site) -> SlopeRules {
    let covers = biome_param(BIOME_RULES, 2);
    let shift = 0.04 * site.variation;
    let from_x = vec4f(cells[0].y, cells[1].y, cells[2].y, cells[3].y) - shift;
    let to_x = vec4f(cells[0].z, cells[1].z, cells[2].z, cells[3].z) - shift;
    let covers_shift = vec2f(0.0, 0.03 * site.variation);
    return SlopeRules(from_x, to_x, covers.yw - covers_shift, covers.xz - covers_shift, snow_heights(site));
}

// Biome by the same rules with hard edges: the answer of a query.
fn biome_of(site: Site) -> i32 {
    var id = biome_at(vec2i(floor(site.table * vec2f(textureDimensions(biome_ids)))));
    let rule = biome_param(id, 5);
    var plain = site;
    plain.variation = 0.0;
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

// Weighted sums over all biomes at a pixel, and the two strongest biomes.
struct Mixture {
    albedo: vec3f,
    roughness: f32,
    specular: f32,
    ids: vec2i,
    weights: vec2f,
    first_color: vec3f,
    second_color: vec3f,
    // Share of the patches of the two strongest biomes
    patches: vec2f,
    // Height of small bumps as a share of those of bare rock
    bumps: f32,
}

fn patch_share(tile_m: f32, patches: f32, site: Site) -> f32 {
    let lod = log2(site.slant.wide_m * NOISE_TILE_SIDE / tile_m);
    let away = smoothstep(-1.0, 2.5, lod);
    if patches <= 0.0 || away >= 1.0 { return patches; }
    let edge = min(0.12, min(patches, 1.0 - patches));
    var sum = 0.0;
    for (var tap = 0u; tap < site.slant.taps; tap++) {
        let rel_m = site.rel_m + site.slant.long_m * tap_place(tap, site.slant.taps);
        let at = (body.eye_wrap_far_m + rel_m) / tile_m;
        let noise = textureSampleLevel(noise_tile, repeated, at.zxy, max(lod, 0.0)).g;
        sum += smoothstep(-edge, edge, patches - noise);
    }
    return mix(sum / f32(site.slant.taps), patches, away);
}

// Adds a biome with a weight.
fn add_biome(mixture: ptr<function, Mixture>, id: i32, weight: f32, site: Site) {
    let plain = biome_param(id, 0);
    let patches = biome_param(id, 1);
    let surface = biome_param(id, 2);
    let patched = patch_share(surface.z, patches.w, site);
    let color = mix(plain.rgb, patches.rgb, patched) * (1.0 + site.variation * plain.a);
    (*mixture).albedo += weight * color;
    (*mixture).roughness += weight * surface.x;
    (*mixture).specular += weight * surface.y;
    (*mixture).bumps += weight * surface.w;
    if id == (*mixture).ids.x {
        (*mixture).weights.x += weight;
    } else if id == (*mixture).ids.y {
        (*mixture).weights.y += weight;
    } else if weight > (*mixture).weights.x {
        (*mixture).ids = vec2i(id, (*mixture).ids.x);
        (*mixture).weights = vec2f(weight, (*mixture).weights.x);
        (*mixture).second_color = (*mixture).first_color;
        (*mixture).first_color = color;
        (*mixture).patches = vec2f(patched, (*mixture).patches.x);
    } else if weight > (*mixture).weights.y {
        (*mixture).ids.y = id;
        (*mixture).weights.y = weight;
        (*mixture).second_color = color;
        (*mixture).patches.y = patched;
    }
}

// The four cells of the biome table around a location, weighted as by bilinear filtering.
struct Cells {
    ids: array<i32, 4>,
    shares: vec4f,
    // Row 5 of their parameters
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

// `steep`: share of steep ground for each cell. `cover`: shares of beach and snow.
fn mixture_of(cells: Cells, steep: vec4f, cover: vec2f, site: Site) -> Mixture {
    var ids: array<i32, MIXTURE_ENTRIES>;
    var weights: array<f32, MIXTURE_ENTRIES>;
    let bare = (1.0 - cover.x) * (1.0 - cover.y);
    for (var i = 0; i < 4; i++) {
        let weight = bare * cells.shares[i];
        // A biome without a steep rule keeps its steep ground.
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
    // Usually all are the same biome.
    for (var i = 1; i < 8; i++) {
        if ids[i] == ids[0] { weights[0] += weights[i]; weights[i] = 0.0; }
    }
    var mixture = Mixture(vec3f(0.0), 0.0, 0.0, vec2i(-1), vec2f(0.0), vec3f(0.0), vec3f(0.0), vec2f(0.0), 0.0);
    for (var i = 0; i < i32(frame.mixture_entries); i++) {
        if weights[i] > 0.001 { add_biome(&mixture, ids[i], weights[i], site); }
    }
    return mixture;
}

// Mixture at a pixel. Where the heights in the pixel span more than a cell of the biome table, the mean of several
// height bands from the lowest to the highest ground, because peaks and valleys no wider than pixels would sparkle.
fn mixture_at(site: Site) -> Mixture {
    let cells = cells_at(site.table);
    let rules = slope_rules(cells.rules, site);
    let shares = slope_shares(site.steep, rules);
    let cover = vec2f(beach_by_height(site) * shares.covers.x, shares.covers.y);
    var sum = mixture_of(cells, shares.cells, cover, site);
    let size = vec2f(textureDimensions(biome_ids));
    let spread = site.spread_m * site.by_height.xy;
    let crossed = max(abs(spread.x) * size.x, abs(spread.y) * size.y);
    // Bands above and below the middle band, which alone has patterns.
    let half = i32(clamp(ceil(crossed - 0.25), 0.0, 2.0));
    let share = 1.0 / f32(2 * half + 1);
    for (var i = -half; i <= half; i++) {
        if i == 0 { continue; }
        let location = clamp(site.table + f32(2 * i) * share * spread, vec2f(0.0), vec2f(1.0) - 0.5 / size / size);
        let others = cells_at(location);
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

// Whether a biome's own pattern is shown, and that of its patches. `patches`: share of the patches. Where both patterns
// are the same there is one.
fn shown_layers(layers: vec2i, patches: f32, is_low: bool) -> vec2<bool> {
    if layers.x == layers.y { return vec2<bool>(true, false); }
    if is_low { return vec2<bool>((patches < 0.5), (patches >= 0.5)); }
    return vec2<bool>((patches < 0.98), (patches > 0.02));
}

// Patterns of the two strongest biomes; `share`: share of the second. Each is that of the biome or of its patches, and
// both where patches end. Low quality draws the stronger of all.
fn patterns_of(mixture: Mixture, share: f32, seen: Seen) -> array<Pattern, 2> {
    let is_low = frame.pattern_quality == 0.0;
    let strongest = select(0, 1, share > 0.5);
    var out: array<Pattern, 2>;
    out[0] = no_pattern();
    out[1] = no_pattern();
    for (var i = 0; i < 4; i++) {
        let biome = i >> 1u;
        if select(biome == 1 && share <= 0.01, biome != strongest, is_low) { continue; }
        let layers = pattern_layers(mixture.ids[biome]);
        let patches = mixture.patches[biome];
        let shown = shown_layers(layers, patches, is_low);
        if !shown[i & 1] { continue; }
        let is_patch = (i & 1) == 1;
        let id = mixture.ids[biome];
        let pattern = pattern_of(id, layers[i & 1], layer_shown(id, is_patch), seen);
        if !is_patch || !shown.x {
            out[biome] = pattern;
            continue;
        }
        // The rarer one shows where it is the higher.
        if patches <= 0.5 {
            out[biome] = mixed_pattern(out[biome], pattern, share_by_height(out[biome], pattern, patches));
        } else {
            out[biome] = mixed_pattern(pattern, out[biome], share_by_height(pattern, out[biome], 1.0 - patches));
        }
    }
    return out;
}

// Material at a pixel. `rel_x`, `rel_y`: steps to the next pixel in metres. `n`, `up`: normals of the ground and of the
// sphere.
fn material_at(site: Site, n: vec3f, up: vec3f, rel_x: vec3f, rel_y: vec3f) -> Material {
    let mixture = mixture_at(site);
    let both = mixture.weights.x + mixture.weights.y;
    let share = mixture.weights.y / max(both, 1e-6);
    let seen = Seen(site.rel_m, n, up, rel_x, rel_y, slant_length_m(site.slant));
    let patterns = patterns_of(mixture, share, seen);
    let a = patterns[0];
    let b = patterns[1];
    var out: Material;
    var t = share;
    if frame.pattern_quality > 0.0 { t = share_by_height(a, b, share); }
    let tinted = mix(mixture.first_color * a.tint, mixture.second_color * b.tint, t);
    let plain = mix(mixture.first_color, mixture.second_color, share);
    out.albedo = max(mixture.albedo + both * (tinted - plain), vec3f(0.0));
    out.roughness = clamp(mixture.roughness + mix(a.roughness, b.roughness, t), 0.04, 1.0);
    out.slope = mix(a.slope, b.slope, t);
    out.glow = mix(a.glow, b.glow, t);
    out.specular = mixture.specular * 0.08;
    out.biomes = mixture.ids;
    out.shares = mixture.weights;
    out.tint = mix(vec3f(1.0), mix(a.tint, b.tint, t), both);
    out.bumps = mixture.bumps;
    out.sun = mix(1.0, mix(a.sun, b.sun, t), both);
    return out;
}
