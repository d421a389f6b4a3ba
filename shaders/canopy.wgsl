// Canopy: what is seen of objects that are too far away to be drawn one by one, by the density that places them
// (src/life/suitability.rs). Objects of a population are spread like drops of rain: what they leave of the ground is
// exp(-areas). As in geometric-optical models of canopies (Li and Strahler, 1985), sun and eye look through the same
// gaps. Rows of the table: src/render/life/canopy.rs.
#include "neighbours.wgsl"
#include "stands.wgsl"
#include "crowns.wgsl"
#include "hues.wgsl"
#include "planting.wgsl"
#include "litter.wgsl"

// A population at a pixel.
struct CanopyLayer {
    albedo: vec3f,
    // Share of the ground's picture that its objects take
    seen: f32,
    // Area of all its objects for each area of ground, as seen from above (x) and from the side (y)
    areas: vec2f,
    // Whether its objects cast shadows
    casts: f32,
    height_m: f32,
    // Light of the sun and of the sky on what is seen here, factors on the mean
    relief: vec2f,
    // Biome, and first row of the population
    at: vec2<i32>,
}

// Biomes that count at a pixel.
const CANOPY_BIOMES: i32 = 2;
const CANOPY_MOST: i32 = CANOPY_BIOMES * CANOPY_LAYERS;

struct Canopy {
    layers: array<CanopyLayer, CANOPY_MOST>,
    // For each biome: the end of its layers, the first one's start at 0
    ends: vec2<i32>,
    // For each biome: its share of the pixel
    shares: vec2f,
    // Share of the ground that is seen
    floor: f32,
    // Distance over height of the ray to the eye
    eye_tangent: f32,
    // Light that leaves let through to the floor, as shares of the sun's
    through: vec3f,
    // What has fallen from the objects: its colour, and the share of the floor that it covers
    litter: vec4f,
    // Material of the objects that most of it has fallen from
    litter_kind: u32,
}

// What decides about the density at a pixel.
struct CanopyPlace {
    slope_deg: f32,
    // Height above sea level, or above the reference sphere
    above_m: f32,
    temperature_c: f32,
    moisture: f32,
    distance_m: f32,
    rel_m: vec3f,
    // Width of a pixel on the ground, the mean of its sides
    footprint_m: f32,
    // Normal of the ground; direction to the eye
    n: vec3f,
    v: vec3f,
}

// As in src/life/suitability.rs.
fn between(x: f32, from_x: f32, to_x: f32, softness: f32) -> f32 {
    return saturate1(1.0 - max(from_x - x, x - to_x) / softness);
}

// Share of its density that a population has, by its rules and by strokes. `row`: its first row. `suits`: 1 where its
// rules may put it, 0 where strokes alone do.
fn density_of(id: i32, row: i32, suits: f32, place: CanopyPlace) -> f32 {
    let shore_m = biome_param(id, row + 4).z;
    let on_land = select(1.0, saturate1(place.above_m - shore_m + 0.5), body.has_sea != 0u);
    if on_land <= 0.0 { return 0.0; }
    let ground = biome_param(id, row + 2);
    let climate = biome_param(id, row + 3);
    let by_rule = suits * between(place.slope_deg, ground.x, ground.y, SOFT_DEG)
        * between(place.moisture, ground.z, ground.w, SOFT_MOISTURE)
        * between(place.above_m, climate.x, climate.y, SOFT_M)
        * between(place.temperature_c, climate.z, climate.w, SOFT_C);
    let by_hand = planting_at(u32(biome_param(id, row + 8).w), place.rel_m, place.footprint_m);
    return on_land * (by_hand.x * by_rule + by_hand.y);
}

// Share of its density that a population of a biome has.
fn canopy_density(id: i32, row: i32, place: CanopyPlace) -> f32 { return density_of(id, row, 1.0, place); }

// Share of its density that the population has whose density is shown. `wet`: share of the pixel that is under rivers
// and lakes.
fn shown_density(biome: i32, place: CanopyPlace, wet: f32) -> f32 {
    let in_water = biome_param(BIOME_SHOWN, CANOPY_ROW + 4).z < 0.0;
    if biome_param(BIOME_SHOWN, SHOWN_ROW).x == 0.0 || (wet > 0.5 && !in_water) { return 0.0; }
    return density_of(BIOME_SHOWN, CANOPY_ROW, biome_param(biome, SHOWN_ROW).x, place);
}

// Share of the area of a population that is drawn as objects (src/life/thinning.rs). `height_m`: of an object;
// `full_m`: distance beyond which fewer and wider ones stand for all; 0 where each stands for itself.
fn drawn_share(height_m: f32, reach_m: f32, full_m: f32, place: CanopyPlace) -> f32 {
    let near = saturate1((1.0 - place.distance_m / max(reach_m, 1e-3)) / (1.0 - FULL_SHARE));
    if full_m <= 0.0 || place.distance_m <= full_m { return near; }
    let sine = abs(dot(place.v, normalize(body.eye_km + place.rel_m * 0.001)));
    let steep = saturate1((sine - WIDEST_SINES.x) / (WIDEST_SINES.y - WIDEST_SINES.x));
    let widest_px = WIDEST_PX * place.distance_m * frame.pixel_rad / max(height_m, 1e-3);
    let left = full_m / place.distance_m;
    return near * min(left * left * min(mix(WIDEST.x, WIDEST.y, steep), max(widest_px, 1.0)), 1.0);
}

// Share of a pixel below which lower objects are left out.
const HIDDEN: f32 = 0.02;
// Strength of groves in the density of objects that stand in groups.
const GROUPS: f32 = 0.8;

// Adds the layers of a biome, the highest first. Single crowns are those of the layer that covers most.
fn add_canopy(canopy: ptr<function, Canopy>, number: i32, id: i32, share: f32, place: CanopyPlace) {
    let count = i32(biome_param(id, 6).w);
    var end = select(0, (*canopy).ends.x, number == 1);
    var densities = array<f32, CANOPY_LAYERS>();
    var most = 0;
    var most_seen = 0.0;
    var open = 1.0;
    for (var i = 0; i < count; i++) {
        let row = CANOPY_ROW + i * CANOPY_LAYER_ROWS;
        densities[i] = canopy_density(id, row, place);
        let rest = exp(-densities[i] * biome_param(id, row).w);
        if open * (1.0 - rest) > most_seen {
            most = i;
            most_seen = open * (1.0 - rest);
        }
        open *= rest;
    }
    open = 1.0;
    var bare = 1.0;
    var fallen = vec4f(0.0);
    var through = vec4f(0.0);
    var most_littered = 0.0;
    let at_m = body.eye_wrap_far_m + place.rel_m;
    var woods_here = 0.0;
    if most_seen > 0.0 { woods_here = woods(at_m, place.footprint_m); }
    for (var i = 0; i < count && most_seen > 0.0; i++) {
        if densities[i] <= 0.0 { continue; }
        // What higher objects hide does not count.
        if open < HIDDEN { break; }
        let row = CANOPY_ROW + i * CANOPY_LAYER_ROWS;
        let color = biome_param(id, row);
        let shape = biome_param(id, row + 1);
        let kind = biome_param(id, row + 4);
        let height_m = biome_param(id, row + 5).z;
        let material = u32(biome_param(id, row + 5).w + 0.5);
        var stand = woods_here;
        var density = densities[i];
        if i == most {
            stand += of_one_age(kind.x, at_m, place.footprint_m);
            density *= max(1.0 + GROUPS * kind.y * groves(kind.x, at_m, place.footprint_m), 0.0);
        }
        let areas = density * vec2f(color.w, shape.x);
        let sides = biome_param(id, row + 9);
        let drawn = drawn_share(height_m, shape.w, sides.w, place);
        var rest = exp(-(1.0 - drawn) * (areas.x + areas.y * (*canopy).eye_tangent));
        var relief = vec2f(1.0);
        var hue = 0.5;
        if i == most && drawn < 1.0 {
            let left = (1.0 - drawn) * density;
            let crowns = crowns_seen(kind.x, height_m, color.w, shape.x, left, place, body.suns[0].dir);
            rest = mix(rest, 1.0 - crowns.hit, crowns.clear);
            relief = crowns.relief;
            if crowns.clear < 1.0 { relief = mix(vec2f(crown_grain(kind.x, place)), relief, crowns.clear); }
            hue = mix(0.5, crowns.random, crowns.clear);
        }
        // Flat rays meet the sides of objects, steep ones their tops, which hide what is below.
        let of_sides = areas.y * (*canopy).eye_tangent;
        let from_side = smoothstep(0.5, 1.0, of_sides / max(areas.x + of_sides, 1e-6));
        var albedo = mix(color.rgb, sides.rgb, from_side);
        // As in life.wgsl.
        if material >= LEAFY { albedo = hue_of_one(albedo, hue + STAND_HUES * stand) * (1.0 + STANDS * stand); }
        (*canopy).layers[end] = CanopyLayer(
            albedo, share * open * (1.0 - rest), areas, kind.w, height_m, relief, vec2<i32>(id, row),
        );
        open *= rest;
        end += 1;
        let litter = biome_param(id, row + 7);
        let littered = litter.w * (1.0 - exp(-areas.x / LITTER_AREA));
        bare *= 1.0 - littered;
        fallen += littered * vec4f(litter.rgb, 1.0);
        if littered > most_littered && share > 0.5 {
            most_littered = littered;
            (*canopy).litter_kind = material;
        }
        through += kind.w * areas.x * vec4f(biome_param(id, row + 8).rgb, 1.0);
    }
    (*canopy).through += share * through.rgb / max(through.w, 1e-6);
    (*canopy).litter += share * (1.0 - bare) * vec4f(fallen.rgb / max(fallen.w, 1e-6), 1.0);
    (*canopy).floor -= share * (1.0 - open);
    if number == 0 { (*canopy).ends = vec2<i32>(end); } else { (*canopy).ends.y = end; }
    (*canopy).shares[number] = share;
}

// Canopy of a pixel. `ids`, `shares`: biomes and their shares.
fn canopy_at(ids: vec2<i32>, shares: vec2f, place: CanopyPlace) -> Canopy {
    var out: Canopy;
    out.floor = 1.0;
    out.eye_tangent = ray_tangent(dot(place.n, place.v));
    for (var i = 0; i < CANOPY_BIOMES; i++) {
        if ids[i] >= 0 && shares[i] > 0.004 { add_canopy(&out, i, ids[i], shares[i], place); }
    }
    return out;
}

// Covers the ground with what has fallen on it.
fn littered(canopy: Canopy, place: CanopyPlace, ground: ptr<function, Material>) {
    let share = canopy.litter.w;
    if share <= 0.003 { return; }
    let axes = lattice_axes(normalize(body.eye_km + place.rel_m * 0.001));
    let at_m = (body.eye_wrap_m + place.rel_m) * axes;
    let leaves = fallen_leaves(canopy.litter_kind, saturate1(share), at_m, place.footprint_m);
    // Leaves gather in the hollows of the pattern, which are dark.
    let hollows = saturate1(share + 1.6 * share * (1.0 - share) * (1.0 - luminance((*ground).tint)));
    let covered = mix(hollows, leaves.cover, leaves.clear);
    let tint = leaves.tint * mix((*ground).tint, vec3f(1.0), 0.7 * leaves.clear);
    (*ground).albedo = mix((*ground).albedo, canopy.litter.rgb / share * tint, covered);
    (*ground).slope = mix((*ground).slope, axes * leaves.slope, covered * leaves.clear);
}

// What objects of all layers leave to the ground: of the light of a sun with this tangent, and of the sky.
fn under_canopy(canopy: Canopy, sun_tangent: f32) -> ObjectShade {
    var out = ObjectShade(1.0, 1.0, vec2f(1.0));
    for (var biome = 0; biome < CANOPY_BIOMES; biome++) {
        var casting = vec2f(0.0);
        for (var i = select(0, canopy.ends.x, biome == 1); i < canopy.ends[biome]; i++) {
            casting += canopy.layers[i].casts * canopy.layers[i].areas;
        }
        out.sun -= canopy.shares[biome] * (1.0 - exp(-casting.x - casting.y * sun_tangent));
        out.sky -= canopy.shares[biome] * (1.0 - UNDER_CROWNS) * (1.0 - exp(-casting.x));
    }
    return out;
}

// Directions to the sun and to the eye over the ground.
struct CanopyRays {
    // Angles from the vertical in degrees: sun, eye
    sun_deg: f32,
    eye_deg: f32,
    // 0 where the eye looks away from the sun, 1 where it looks towards it
    against: f32,
    // Of the angle between both
    cosine: f32,
}

fn canopy_rays(up: vec3f, sun: vec3f, v: vec3f) -> CanopyRays {
    let cosines = clamp(vec2f(dot(up, sun), dot(up, v)), vec2f(-1.0), vec2f(1.0));
    let flat_sun = sun - up * cosines.x;
    let flat_eye = v - up * cosines.y;
    let scale = max(length(flat_sun) * length(flat_eye), 1e-6);
    let angles = degrees(acos(cosines));
    return CanopyRays(angles.x, angles.y, 0.5 - 0.5 * dot(flat_sun, flat_eye) / scale, dot(sun, v));
}

// Mean light of what is seen of an object: share of the sun's (x) and of the sky's (y), between the directions that
// were measured (src/life/form/cover.rs).
fn object_light(at: vec2<i32>, rays: CanopyRays) -> vec2f {
    let above = biome_param(at.x, at.y + 5).xy;
    let aslant = biome_param(at.x, at.y + 6);
    let sky = biome_param(at.x, at.y + 1).yz;
    let low = saturate1((rays.sun_deg - COVER_SUNS_DEG.x) / (COVER_SUNS_DEG.y - COVER_SUNS_DEG.x));
    let aside = saturate1(rays.eye_deg / COVER_EYES_DEG.y);
    let from_side = mix(mix(aslant.x, aslant.y, low), mix(aslant.z, aslant.w, low), rays.against);
    return vec2f(mix(mix(above.x, above.y, low), from_side, aside), mix(sky.x, sky.y, aside));
}

// Light that the tops of crowns have more than all that is seen of a crown that stands alone: from above, aslant from
// the side of the sun, and aslant against it.
const TOPS_FROM_ABOVE: f32 = 0.27;
const TOPS_ASLANT: f32 = 0.2;
const TOPS_AGAINST: f32 = 1.4;

// What stands around the objects of a layer, as areas for each area of ground.
struct LayerAmong {
    // Of the objects that overtop it, as seen from above and from the side
    above: vec2f,
    // Of those beside it, from the side: the less, the more crowns close
    neighbours: f32,
}

fn layer_among(canopy: Canopy, number: i32) -> LayerAmong {
    var above = vec2f(0.0);
    var beside = vec2f(0.0);
    let is_second = number >= canopy.ends.x;
    for (var i = select(0, canopy.ends.x, is_second); i < select(canopy.ends.x, canopy.ends.y, is_second); i++) {
        let heights = canopy.layers[number].height_m / max(canopy.layers[i].height_m, 1e-3);
        let areas = canopy.layers[i].casts * canopy.layers[i].areas;
        above += max(1.0 - heights, 0.0) * areas;
        beside += min(heights, 1.0 / heights) * areas;
    }
    return LayerAmong(above, beside.y * exp(-0.5 * beside.x));
}

// Radiance of all layers. `sunlight`: irradiance on a surface that faces the sun; `sky`: irradiance of level ground.
// `sun_cosine`: of the angle between the sun and the normal of the ground.
fn canopy_radiance(canopy: Canopy, sunlight: vec3f, sky: vec3f, sun_cosine: f32, rays: CanopyRays) -> vec3f {
    let sun_tangent = ray_tangent(sun_cosine);
    var sum = vec3f(0.0);
    for (var i = 0; i < canopy.ends.y; i++) {
        let layer = canopy.layers[i];
        let among = layer_among(canopy, i);
        let sun = exp(-among.above.x - among.above.y * sun_tangent)
            * neighbours_leave(among.neighbours, sun_tangent, rays.cosine);
        let open = mix(1.0, exp(-among.above.x), 1.0 - UNDER_CROWNS);
        // Of crowns that close, one sees the tops, which have more light.
        let closed = layer.casts * (1.0 - exp(-layer.areas.x));
        let aslant = mix(TOPS_ASLANT, TOPS_AGAINST, rays.against);
        let tops = mix(TOPS_FROM_ABOVE, aslant, saturate1(rays.eye_deg / COVER_EYES_DEG.y));
        let light = object_light(layer.at, rays) * (1.0 + closed * tops);
        let of_sun = sunlight * (sun * layer.relief.x * light.x);
        sum += layer.seen * layer.albedo * (of_sun + sky * (open * layer.relief.y * light.y));
    }
    return sum / PI;
}

// Mean albedo of objects and ground.
fn canopy_albedo(canopy: Canopy, ground: vec3f) -> vec3f {
    var sum = canopy.floor * ground;
    for (var i = 0; i < canopy.ends.y; i++) { sum += canopy.layers[i].seen * canopy.layers[i].albedo; }
    return sum;
}
