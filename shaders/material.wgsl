// What the ground is made of at a pixel: the biomes of the table's cells around its climate, what the rules for steep ground,
// beaches and snow make of them, and the patterns of the two strongest. The rules are those of src/terrain/ground.rs, with soft
// edges where it has half-way marks. Must match the texels of src/render/biome_table.rs.
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
    temperature_c: f32,
    // Height over the level of the sea, metres; beyond every beach where there is no sea
    over_sea_m: f32,
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

// What a biome gives way to on steep ground (itself for nothing), and how much of it.
struct Steep {
    id: i32,
    share: f32,
}

fn steep_of(id: i32, slope_cosine: f32) -> Steep {
    let rule = biome_param(id, 5);
    if rule.x < 0.0 { return Steep(id, 0.0); }
    return Steep(i32(rule.x), soft(rule.y, rule.z, slope_cosine));
}

// How much of the ground is beach (x) and snow (y) by height, temperature and slope.
fn covers(site: Site) -> vec2f {
    let beach = biome_param(RULES, 0);
    let snow = biome_param(RULES, 1);
    let slopes = biome_param(RULES, 2);
    var share = vec2f(0.0);
    if beach.x >= 0.0 {
        let edge_m = beach.y * (1.0 + 0.25 * site.mottle);
        share.x = soft(1.3 * edge_m, 0.7 * edge_m, abs(site.over_sea_m)) * soft(slopes.y, slopes.x, site.slope_cosine);
    }
    if snow.x >= 0.0 {
        let line_c = snow.y + 0.35 * snow.z * site.mottle;
        share.y = soft(line_c + 0.5 * snow.z, line_c - 0.5 * snow.z, site.temperature_c)
            * soft(slopes.w, slopes.z, site.slope_cosine + 0.03 * site.mottle);
    }
    return share;
}

// The biome by the same rules without soft edges: what a query answers.
fn biome_of(site: Site) -> i32 {
    var id = biome_at(vec2i(floor(site.table * vec2f(textureDimensions(biome_ids)))));
    let steep = steep_of(id, site.slope_cosine);
    if steep.share > 0.5 && steep.id != ROCK { id = steep.id; }
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
    first: i32,
    second: i32,
    weights: vec2f,
}

fn patch_share(place: vec4f, patches: vec4f, site: Site) -> f32 {
    if patches.w <= 0.0 { return 0.0; }
    let lod = log2(site.footprint_m * 64.0 / place.z);
    let away = smoothstep(-1.0, 2.5, lod);
    if away >= 1.0 { return patches.w; }
    let at = (globals.eye_wrap_far_m.xyz + site.rel_m) / place.z;
    let noise = textureSampleLevel(noise_tile, repeated, at.zxy, max(lod, 0.0)).g;
    let edge = min(0.12, min(patches.w, 1.0 - patches.w));
    return mix(smoothstep(-edge, edge, patches.w - noise), patches.w, away);
}

fn color_of(id: i32, site: Site) -> vec3f {
    let color = biome_param(id, 0);
    let patches = biome_param(id, 1);
    let share = patch_share(biome_param(id, 2), patches, site);
    return mix(color.rgb, patches.rgb, share) * (1.0 + site.mottle * color.a);
}

fn put(mixture: ptr<function, Mixture>, id: i32, weight: f32, site: Site) {
    if weight <= 0.001 { return; }
    let surface = biome_param(id, 2);
    (*mixture).albedo += weight * color_of(id, site);
    (*mixture).roughness += weight * surface.x;
    (*mixture).specular += weight * surface.y;
    if id == (*mixture).first {
        (*mixture).weights.x += weight;
    } else if id == (*mixture).second {
        (*mixture).weights.y += weight;
    } else if weight > (*mixture).weights.x {
        (*mixture).second = (*mixture).first;
        (*mixture).weights.y = (*mixture).weights.x;
        (*mixture).first = id;
        (*mixture).weights.x = weight;
    } else if weight > (*mixture).weights.y {
        (*mixture).second = id;
        (*mixture).weights.y = weight;
    }
}

fn put_with_slopes(mixture: ptr<function, Mixture>, id: i32, weight: f32, site: Site) {
    if weight <= 0.001 { return; }
    let steep = steep_of(id, site.slope_cosine + site.mottle * 0.04);
    put(mixture, id, weight * (1.0 - steep.share), site);
    put(mixture, steep.id, weight * steep.share, site);
}

fn mixture_at(site: Site) -> Mixture {
    var mixture = Mixture(vec3f(0.0), 0.0, 0.0, -1, -1, vec2f(0.0));
    let cover = covers(site);
    let bare = (1.0 - cover.x) * (1.0 - cover.y);
    // The cells around, as a texture's linear filter has them.
    let at = site.table * vec2f(textureDimensions(biome_ids)) - 0.5;
    let cell = vec2i(floor(at));
    let f = border_blend(at - floor(at));
    let ids = vec4i(
        biome_at(cell), biome_at(cell + vec2i(1, 0)), biome_at(cell + vec2i(0, 1)), biome_at(cell + vec2i(1, 1))
    );
    if bare > 0.001 {
        if all(ids == ids.xxxx) {
            put_with_slopes(&mixture, ids.x, bare, site);
        } else {
            put_with_slopes(&mixture, ids.x, bare * (1.0 - f.x) * (1.0 - f.y), site);
            put_with_slopes(&mixture, ids.y, bare * f.x * (1.0 - f.y), site);
            put_with_slopes(&mixture, ids.z, bare * (1.0 - f.x) * f.y, site);
            put_with_slopes(&mixture, ids.w, bare * f.x * f.y, site);
        }
    }
    if cover.x > 0.0 { put(&mixture, i32(biome_param(RULES, 0).x), cover.x * (1.0 - cover.y), site); }
    if cover.y > 0.0 { put(&mixture, i32(biome_param(RULES, 1).x), cover.y, site); }
    if mixture.weights.y > mixture.weights.x {
        let first = mixture.first;
        mixture.first = mixture.second;
        mixture.second = first;
        mixture.weights = mixture.weights.yx;
    }
    return mixture;
}

// Everything at a pixel. `rel_x`, `rel_y`: from pixel to pixel, metres; `n`, `up`: of the ground and of the sphere.
fn material_at(site: Site, n: vec3f, up: vec3f, rel_x: vec3f, rel_y: vec3f) -> Material {
    let mixture = mixture_at(site);
    var out = Material(mixture.albedo, mixture.roughness, mixture.specular, vec3f(0.0), vec3f(0.0));
    let view = Seen(site.rel_m, n, up, rel_x, rel_y, site.footprint_m);
    let first = pattern_of(mixture.first, view);
    var tint = first.tint;
    var pattern = first;
    let both = mixture.weights.x + mixture.weights.y;
    let share = mixture.weights.y / max(both, 1e-6);
    if share > 0.01 && globals.modes.w > 0u {
        // The higher one shows, as far as the mean stays what the weights say.
        let second = pattern_of(mixture.second, view);
        let shown = share_by_height(first, second, share);
        let colors = mix(first.tint * color_of(mixture.first, site), second.tint * color_of(mixture.second, site), shown)
            - mix(color_of(mixture.first, site), color_of(mixture.second, site), share);
        out.albedo = max(out.albedo + both * colors, vec3f(0.0));
        pattern = mixed(first, second, shown);
    } else {
        out.albedo *= mix(vec3f(1.0), first.tint, 1.0 - share);
    }
    out.roughness = clamp(out.roughness + pattern.roughness, 0.04, 1.0);
    out.slope = pattern.slope;
    out.glow = pattern.glow;
    out.specular *= 0.08;
    return out;
}
