// The ground: tiles, coloured by climate and lit by suns and sky, and the debug views.
#include "screen.wgsl"
#include "cloud_model.wgsl"
#include "material.wgsl"
#include "highlight.wgsl"
#include "horizon.wgsl"
#include "reflectance.wgsl"
#include "object_shadow.wgsl"
#include "canopy.wgsl"
#include "sea.wgsl"
#include "settlements.wgsl"
#include "giant_tops.wgsl"
#include "debug_colors.wgsl"

struct Vertex {
    @location(0) high_m: vec3f,
    @location(2) low_m: vec3f,
    @location(5) normal_oct: vec2f,
    @location(6) parent_normal_oct: vec2f,
    // Distances in metres over which the parent's normals take over; level; layer of the detail texture, -1 without
    // one.
    @location(7) tile: vec4f,
    // The axis that the first tangent of the slopes follows.
    @location(8) slope_axis: vec3f,
    // Position of the tile in its detail texture: corner and side, 0 to 1; base height of the texture's heights,
    // metres.
    @location(9) detail_place: vec4f,
    // Distances in metres over which the parent of the detail texture takes over; metres between texels.
    @location(10) detail_fade: vec4f,
    // Vertical shift of the vertex by the morph, metres (morph.wgsl).
    @location(11) shift_m: f32,
    // Moisture and temperature at sea level (at the reference sphere of a planet with no sea), and height in metres,
    // all with morph.
    @location(12) morphed: vec3f,
    // Horizon tile; see `visibility`.
    @location(13) horizon: vec4f,
}

struct Ground {
    @builtin(position) position: vec4f,
    @location(0) rel_m: vec3f,
    @location(1) normal: vec3f,
    // Moisture and temperature in °C, at the same level
    @location(2) level_climate: vec2f,
    @location(3) height_m: f32,
    @location(4) @interpolate(flat) level: f32,
    // Position in the tile (xy) and in its detail texture (zw), 0 to 1
    @location(6) place: vec4f,
    // Distance from the eye that the LOD cut was chosen for
    @location(7) chosen_distance_m: f32,
    // Layer of the detail texture
    @location(8) @interpolate(flat) layer: f32,
    @location(9) @interpolate(flat) slope_axis: vec3f,
    // As in Vertex; w: base height of the texture's heights, metres
    @location(10) @interpolate(flat) detail_fade: vec4f,
    // Normal of the parent's mesh; distances in metres over which it takes over
    @location(11) parent_normal: vec3f,
    @location(12) @interpolate(flat) fade_m: vec2f,
    @location(13) @interpolate(flat) horizon: vec4f,
}

// Octahedral normal (Cigolle et al., A Survey of Efficient Representations for Independent Unit Vectors, 2014).
fn from_octahedral(e: vec2f) -> vec3f {
    var v = vec3f(e, 1.0 - abs(e.x) - abs(e.y));
    if v.z < 0.0 {
        let signs = select(vec2f(-1.0), vec2f(1.0), v.xy >= vec2f(0.0));
        v = vec3f((1.0 - abs(v.yx)) * signs, v.z);
    }
    return normalize(v);
}

@vertex
fn vertex(in: Vertex, @builtin(vertex_index) index: u32) -> Ground {
    var out: Ground;
    // High and low parts are subtracted separately: equal points give equal bits in every tile.
    out.rel_m = (in.high_m - body.eye_high_m) + (in.low_m - body.eye_low_m);
    out.rel_m += in.shift_m * normalize(in.high_m);
    out.position = body.clip_from_rel_m * vec4f(out.rel_m, 1.0);
    let chosen_rel_m = (in.high_m - body.chosen_eye_high_m) + (in.low_m - body.chosen_eye_low_m);
    out.chosen_distance_m = length(chosen_rel_m);
    out.normal = from_octahedral(in.normal_oct);
    out.parent_normal = from_octahedral(in.parent_normal_oct);
    out.fade_m = in.tile.xy;
    out.level_climate = in.morphed.xy;
    out.height_m = in.morphed.z;
    out.level = in.tile.z;
    // The vertices of a tile start at a multiple of the vertices of a tile in the buffer.
    let number = index % (TILE_SIDE * TILE_SIDE);
    let place = vec2f(vec2u(number % TILE_SIDE, number / TILE_SIDE)) / f32(TILE_SIDE - 1u);
    out.place = vec4f(place, in.detail_place.xy + place * in.detail_place.z);
    out.layer = in.tile.w;
    out.slope_axis = in.slope_axis;
    out.detail_fade = vec4f(in.detail_fade.xyz, in.detail_place.w);
    out.horizon = in.horizon;
    return out;
}

// Distance between vertices of a level, metres.
fn spacing_m(level: f32) -> f32 { return 0.5 * PI * body.radius_km * 1000.0 / (f32(TILE_SIDE - 1u) * exp2(level)); }

// Share to which the parent has taken over at a distance.
fn faded(range_m: vec2f, distance_m: f32) -> f32 {
    return saturate1((distance_m - range_m.x) / max(range_m.y - range_m.x, 1e-3));
}

// The ground at a pixel, from the detail texture, or from the vertices where there is none yet.
struct PixelGround {
    normal: vec3f,
    height_m: f32,
    // Half the range of heights within the pixel in metres: from the slope alone, and with all unevenness no wider than
    // pixels
    plane_m: f32,
    spread_m: f32,
    steep: Steepness,
    // Share of the pixel that is under the water of rivers and lakes, and its depth in metres
    water: vec2f,
}

// Change from a pixel to the next on the right and below: position in the detail texture in texels (xy), height of the
// vertices in metres (z).
struct Step {
    right: vec3f,
    below: vec3f,
}

// `footprint_m`: the longer side of a pixel on the ground. Normals finer than the footprint would sparkle. Octave by
// octave of the footprint, the detail texture fades to its parent's, then to the vertices, then to the parent's
// vertices. A child tile fades one octave later, so both show the same normals.
fn pixel_ground_of(in: Ground, up: vec3f, footprint_m: f32, step: Step, reach: f32) -> PixelGround {
    let quarters = log2(footprint_m * 4.0 / spacing_m(in.level));
    let coarse = max(faded(in.fade_m, in.chosen_distance_m), saturate1(quarters - 2.0));
    let smooth_normal = normalize(mix(in.normal, in.parent_normal, coarse));
    let texels = log2(footprint_m / in.detail_fade.z);
    let by_distance = faded(in.detail_fade.xy, in.chosen_distance_m);
    let parent = max(by_distance, saturate1(texels));
    let texel = in.place.zw * (DETAIL_SIDE - 1.0);
    let footprint = detail_place(in.layer, texel, step.right.xy, step.below.xy, by_distance);
    let change_m = 0.5 * (abs(step.right.z) + abs(step.below.z));
    let steep = Steepness(footprint, vec2f(0.0), Heights(0.0, vec2f(0.0), 0.0), 0.0, reach, dot(smooth_normal, up));
    var out = PixelGround(smooth_normal, in.height_m, change_m, change_m, steep, vec2f(0.0));
    if in.layer < 0.0 { return out; }
    let slopes = detail_slopes_at(footprint);
    let slope = mix(slopes.xy, slopes.zw, parent);
    let east = normalize(in.slope_axis - up * dot(up, in.slope_axis));
    let fine = normalize(up - slope.x * east - slope.y * cross(up, east));
    out.normal = normalize(mix(fine, smooth_normal, saturate1(texels - 1.0)));
    let apart = smoothstep(-2.0, -1.0, footprint.width - by_distance);
    let heights = heights_at(footprint, apart);
    out.height_m = in.detail_fade.w + heights.middle_m;
    out.plane_m = plane_spread_m(heights, footprint);
    // Half the range of an even distribution with this standard deviation (sqrt(3)).
    out.spread_m = out.plane_m + 1.732 * heights.rest_m;
    if apart < 1.0 { out.steep.shown = rises_at(footprint); }
    out.steep.heights = heights;
    out.steep.apart = apart;
    out.water = water_cover(footprint, parent);
    return out;
}

struct Climate {
    temperature_c: f32,
    moisture: f32,
    // Row of the biome table: 0 for the last row to 1 for the first
    row: f32,
}

// Climate at a height, as in src/terrain/climate.rs: higher ground is colder and drier, counted from sea level up.
fn climate_at(in: Ground, height_m: f32) -> Climate {
    let over_m = height_m - select(0.0, body.sea_level_km * 1000.0, body.has_sea != 0u);
    let above_m = max(over_m, 0.0);
    let temperature_c = in.level_climate.y - above_m * body.lapse_c_per_m;
    let row = body.row_offset + body.row_per_c * temperature_c + body.row_per_m * over_m;
    return Climate(temperature_c, saturate1(in.level_climate.x + above_m * body.moisture_per_m), saturate1(row));
}

// Tilts a normal by the small bumps of the macro variation; `share`: their height as a share of those of bare rock.
fn bumped(n: vec3f, rel_m: vec3f, slant: Slant, share: f32) -> vec3f {
    let tangent = normalize(cross(n, select(vec3f(0.0, 0.0, 1.0), vec3f(1.0, 0.0, 0.0), abs(n.z) > 0.7)));
    let other = cross(n, tangent);
    let rise = share * bumps_at(rel_m, slant, array<vec3f, 2>(tangent, other));
    return normalize(n - rise.x * tangent - rise.y * other);
}

// Inputs of biome and surface rules at a pixel. `at`: location in the biome table.
fn site_of(
    in: Ground, pixel_ground: PixelGround, up: vec3f, temperature_c: f32, at: vec2f, slant: Slant, variation: f32,
) -> Site {
    let over_sea_m = select(1e9, pixel_ground.height_m - body.sea_level_km * 1000.0, body.has_sea != 0u);
    // As in `climate_at`.
    let colder = select(0.0, body.lapse_c_per_m, over_sea_m > 0.0);
    let drier = select(0.0, body.moisture_per_m, over_sea_m > 0.0);
    let by_height = vec3f(drier, body.row_per_c * colder - body.row_per_m, -colder);
    return Site(
        at, in.rel_m, dot(pixel_ground.normal, up), pixel_ground.steep, temperature_c, over_sea_m,
        pixel_ground.plane_m, pixel_ground.spread_m, by_height, slant, variation,
    );
}

// The sea bed: sand near the shore (the beach's biome, if there is one), darker below.
fn seabed(ground: Material, site: Site) -> Material {
    if body.has_sea == 0u { return ground; }
    var out = ground;
    let beach = biome_param(BIOME_RULES, 0).x;
    var sand = vec3f(0.36, 0.31, 0.22);
    if beach >= 0.0 { sand = biome_param(i32(beach), 0).rgb; }
    let depth_m = -site.over_sea_m;
    sand = mix(sand, vec3f(0.10, 0.10, 0.10), smoothstep(5.0, 250.0, depth_m));
    // While there is land in the pixel, the sea bed counts by the share of the pixel under the sea.
    let wet = smoothstep(-2.0, 2.0, depth_m - site.spread_m + site.variation * 2.0);
    out.albedo = mix(out.albedo, sand * (1.0 + site.variation * 0.3), wet);
    return out;
}

// Pixels between neighbouring vertices, for ground seen head-on from the eye that the LOD cut was chosen for.
fn spacing_pixels(in: Ground) -> f32 {
    return spacing_m(in.level) / max(in.chosen_distance_m * body.chosen_pixel_rad, 1e-9);
}

// 1 at the border of the tile, about one and a half pixels wide on the tile's side.
fn border(in: Ground) -> f32 {
    let pixel = max(fwidth(in.place.xy), vec2f(1e-6));
    let away = min(in.place.xy, 1.0 - in.place.xy) / pixel;
    return 1.0 - smoothstep(0.7, 1.7, min(away.x, away.y));
}

fn debug_color(in: Ground, pixel_ground: PixelGround, up: vec3f, footprint_m: f32) -> vec3f {
    let n = pixel_ground.normal;
    let v = normalize(-in.rel_m);
    let lit = 0.35 + 0.65 * saturate1(dot(n, v));
    // Computed before the switch, in uniform control flow, as derivatives require.
    let edge = border(in);
    let climate = climate_at(in, in.height_m);
    let location = table_place(vec2f(climate.moisture, climate.row), in.rel_m, 0.0);
    switch frame.debug_view {
        case VIEW_HEIGHT: {
            let span = max(body.height_range_m.y - body.height_range_m.x, 1.0);
            return ramp((in.height_m - body.height_range_m.x) / span) * lit;
        }
        case VIEW_NORMAL: { return pow(n * 0.5 + 0.5, vec3f(2.2)); }
        case VIEW_SLOPE: { return ramp(acos(clamp(dot(n, up), -1.0, 1.0)) / (PI / 3.0)); }
        case VIEW_BIOME: {
            let site = site_of(in, pixel_ground, up, climate.temperature_c, location, plain_slant(1.0), 0.0);
            return highlighted(biome_param(biome_of(site), 0).rgb, location, vec3f(1.0));
        }
        case VIEW_TEMPERATURE: { return temperature_color((climate.temperature_c + 40.0) / 80.0) * lit; }
        case VIEW_MOISTURE: { return moisture_color(climate.moisture) * lit; }
        case VIEW_LOD: { return level_color(in.level) * lit; }
        case VIEW_TILE_BORDERS: { return mix(vec3f(0.30) * lit, level_color(in.level), edge); }
        case VIEW_WIREFRAME: { return mix(level_color(in.level), vec3f(0.9), 0.4); }
        case VIEW_PLATES, VIEW_RAIN, VIEW_RIVERS: {
            return textureSampleLevel(map_picture, clamped, up, 0.0).rgb * (0.4 + 0.6 * lit);
        }
        case VIEW_DENSITY: {
            let site = site_of(in, pixel_ground, up, climate.temperature_c, location, plain_slant(1.0), 0.0);
            let place = canopy_place(in, climate, n, up, v, length(in.rel_m), footprint_m);
            let density = shown_density(biome_of(site), place, pixel_ground.water.x);
            // The sea is dark, so that land is known.
            if density <= 0.0 && site.over_sea_m < 0.0 { return UNDER_SEA * lit; }
            return density_color(density) * mix(1.0, lit, 0.5);
        }
        case VIEW_ERROR: { return spacing_color(spacing_pixels(in)) * lit; }
        default: { return vec3f(1.0); }
    }
}

// The ground at a pixel, for lighting.
struct Facet {
    n: vec3f,
    // Normal tilted by the pattern, and area relative to untilted ground
    tilted: vec3f,
    area: f32,
    // Direction to the eye
    v: vec3f,
    up: vec3f,
    rel_km: vec3f,
    altitude_km: f32,
    footprint_km: f32,
}

// What drawn objects leave of the light at the pixel.
var<private> objects: ObjectShade = NO_SHADE;
// Normal of the ground without bumps.
var<private> canopy_normal: vec3f;

// Shade of objects on the ground: of those that are drawn, and beyond their map of the canopy.
fn ground_shade(canopy: Canopy, is_first: bool) -> ObjectShade {
    let far = under_canopy(canopy, ray_tangent(dot(canopy_normal, active_sun.dir)));
    let known = select(vec2f(0.0, objects.known.y), objects.known, is_first);
    let near = select(vec2f(1.0, objects.sky), vec2f(objects.sun, objects.sky), is_first);
    let shade = near - (1.0 - known) * (1.0 - vec2f(far.sun, far.sky));
    return ObjectShade(shade.x, shade.y, vec2f(1.0));
}

// Radiance that the ground and the objects on it reflect of the active sun's light and of the sky lit by it.
fn lit(ground: Material, canopy: Canopy, facet: Facet, from_ground: Visibility, is_first: bool) -> vec3f {
    let sun = active_sun.dir;
    let n = facet.tilted;
    let tilted_l = lit_cosine(dot(n, sun));
    let n_v = max(dot(facet.n, facet.v), 0.0);
    let rough = rough_diffuse(max(dot(facet.n, sun), 0.0), n_v, dot(sun, facet.v), tilted_l, ground.roughness);
    let sun_mu = dot(facet.up, sun);
    let sunlight = active_sun.irradiance * sun_transmittance(facet.altitude_km, sun_mu);
    let clouds = under_clouds(facet.rel_km, facet.altitude_km, sun_mu, facet.footprint_km);
    let sky_share = overcast(clouds.straight, clouds.passed);
    let shade = ground_shade(canopy, is_first);
    let open_sky = sky_irradiance(facet.altitude_km, sun_mu) * sky_share.x + sunlight * max(sun_mu, 0.0) * sky_share.y;
    let open_sun = sunlight * (clouds.straight * from_ground.star);
    let shadow = clouds.straight * from_ground.star * shade.sun * select(1.0, ground.sun, is_first);
    // Crowns hide the sky, and let some of the sun through in its place.
    var sky = open_sky * shade.sky + sunlight * canopy.through * (1.0 - shade.sky);
    // Light goes to and fro between ground and fog.
    let again = ground.albedo * clouds.returned;
    sky += (sky + sunlight * max(sun_mu, 0.0) * shadow) * again / (1.0 - again);
    let open = saturate1(0.5 + 0.5 * dot(n, facet.up) * facet.area) * from_ground.sky;
    // Light reflected by the surrounding ground to a slope that does not see the whole sky.
    let bounce = (sky + sunlight * max(sun_mu, 0.0) * shadow) * ground.albedo * (1.0 - open);
    let glint = mirrored(n, facet.v, sun, ground.roughness, ground.specular);
    let floor = ground.albedo * (sunlight * shadow * tilted_l * rough * facet.area + (sky * open + bounce) / PI)
        + sunlight * shadow * glint.x + sky * open * glint.y / PI;
    if canopy.ends.y == 0 { return floor; }
    let rays = canopy_rays(facet.up, sun, facet.v);
    let crowns = canopy_radiance(canopy, open_sun, open_sky * from_ground.sky, dot(canopy_normal, sun), rays);
    return canopy.floor * floor + crowns;
}

// Absorption of what floats in rivers, and the light that it scatters back.
const SILT_PER_M: vec3f = vec3f(0.35, 0.28, 0.45);
const SILT_COLOR: vec3f = vec3f(0.010, 0.012, 0.005);

// Visibility of the active sun and of the sky over the surrounding ground.
fn visibility_at(in: Ground, up: vec3f) -> Visibility {
    let altitude_km = max(in.height_m, body.sea_level_km * 1000.0) * 0.001;
    return visibility(in.horizon, in.slope_axis, in.place.xy, faded(in.fade_m, in.chosen_distance_m), up, altitude_km);
}

// Radiance of rivers and lakes. They are murkier than the sea, shallow water most of all, and the wind raises lower
// waves on them.
fn inland_radiance(facet: Facet, floor: vec3f, depth_m: f32, temperature_c: f32, visible: Visibility) -> vec3f {
    let clear = smoothstep(2.0, 60.0, depth_m);
    let silt = mix(1.0, 0.1, clear);
    let absorption_per_m = body.water_absorption_per_m * mix(4.0, 1.5, clear) + SILT_PER_M * silt;
    let color = body.water_color + SILT_COLOR * mix(1.0, 0.3, clear);
    let variance = body.wave_slope_variance * mix(0.1, 0.4, clear);
    let column = Column(vec3f(0.0), depth_m, vec3f(0.0), ice_on(temperature_c - FRESH_WARMER_C));
    return water_radiance(Water(
        facet.rel_km, -facet.v, floor, vec2f(depth_m), temperature_c, visible, facet.altitude_km, absorption_per_m,
        color, variance, 0.0, 0.0, 0.0, column,
    ));
}

// Radiance; height above sea level in metres; half the range of heights within the pixel in metres.
struct Shaded {
    radiance: vec3f,
    over_sea_m: f32,
    spread_m: f32,
}

// Factor on the albedo of ground that waves run up to: water in its pores makes it darker (Lekner and Dorf 1988).
fn splashed(over_sea_m: f32, spread_m: f32, variation: f32) -> f32 {
    if body.has_sea == 0u || over_sea_m < -spread_m { return 1.0; }
    let reach_m = clamp(2.0 * body.wave_deviation_m, 0.15, 3.0) * (1.0 + 0.6 * variation);
    // Where the pixel is wider than the wet ground, its share.
    let share = (reach_m - over_sea_m) / max(2.0 * spread_m, 0.4 * reach_m);
    return mix(1.0, 0.55, saturate1(share) * smoothstep(-0.3 - spread_m, 0.0, over_sea_m));
}

// What decides about the objects at a pixel. `footprint_m`: width of the pixel, the mean of its sides.
fn canopy_place(
    in: Ground, climate: Climate, n: vec3f, up: vec3f, v: vec3f, distance_m: f32, footprint_m: f32,
) -> CanopyPlace {
    let above_m = in.height_m - select(0.0, body.sea_level_km * 1000.0, body.has_sea != 0u);
    let slope_deg = degrees(acos(clamp(dot(n, up), -1.0, 1.0)));
    return CanopyPlace(
        slope_deg, above_m, climate.temperature_c, climate.moisture, distance_m, in.rel_m, footprint_m, n, v,
    );
}

fn shade(on_mesh: Ground, from_ground: Visibility) -> Shaded {
    let rel_km = on_mesh.rel_m * 0.001;
    let up = normalize(body.eye_km + rel_km);
    // On ground seen at a slant, a pixel is long. The longer side decides; otherwise far slopes sparkle. The normals of
    // vertices vary smoothly; those of triangles would show as stripes.
    let mesh_normal = normalize(on_mesh.normal);
    let rel_x = pixel_step(on_mesh.rel_m, mesh_normal, body.pixel_right);
    let rel_y = pixel_step(on_mesh.rel_m, mesh_normal, body.pixel_up);
    let footprint_m = max(max(length(rel_x), length(rel_y)), 1e-6);
    let at = vec3f(on_mesh.place.zw * (DETAIL_SIDE - 1.0), on_mesh.height_m);
    // Biomes and densities are shown exactly, with hard edges, whatever the footprint.
    let exact = frame.debug_view == VIEW_BIOME || frame.debug_view == VIEW_DENSITY;
    let share = select(1.0, 0.0, exact);
    let step = Step(share * dpdx(at), share * dpdy(at));
    let pixel_ground = pixel_ground_of(on_mesh, up, select(footprint_m, 1e-6, exact), step, select(2.0, 1.0, exact));
    var in = on_mesh;
    in.height_m = pixel_ground.height_m;
    var n = pixel_ground.normal;
    let sea_level_m = body.sea_level_km * 1000.0;
    let over_sea_m = clamp(in.height_m - sea_level_m, -60000.0, 60000.0);
    if frame.debug_view != VIEW_SHADED && frame.debug_view != VIEW_ALBEDO {
        let width_m = sqrt(length(rel_x) * length(rel_y));
        return Shaded(debug_color(in, pixel_ground, up, width_m), over_sea_m, pixel_ground.spread_m);
    }

    let distance_m = length(in.rel_m);
    let v = -in.rel_m / max(distance_m, 1e-6);
    let slant = slant_of(rel_x, rel_y);
    let variation = slanted_variation(in.rel_m, slant);
    let climate = climate_at(in, in.height_m);
    let location = table_place(vec2f(climate.moisture, climate.row), in.rel_m, footprint_m);
    cells_per_pixel = (abs(dpdx(location)) + abs(dpdy(location))) * vec2f(textureDimensions(biome_ids));
    let site = site_of(in, pixel_ground, up, climate.temperature_c, location, slant, variation);
    var ground = seabed(material_at(site, n, up, rel_x, rel_y), site);
    ground.albedo *= splashed(over_sea_m, pixel_ground.spread_m, variation);
    if GIANT {
        let deck = giant_tops(up, footprint_m * 0.001 / body.radius_km);
        ground = Material(
            deck.albedo, 1.0, 0.0, deck.slope, vec3f(0.0), vec2<i32>(-1), vec2f(0.0), vec3f(1.0), 1.0, 1.0,
        );
    }
    let wet = pixel_ground.water.x;
    canopy_normal = n;
    let place = canopy_place(in, climate, n, up, v, distance_m, sqrt(length(rel_x) * length(rel_y)));
    // Nothing stands in a river: through its water one sees the bed.
    let on_land = 1.0 - smoothstep(0.4, 0.9, wet);
    let canopy = canopy_at(ground.biomes, on_land * ground.shares, place);
    littered(canopy, place, &ground);
    if frame.debug_view == VIEW_ALBEDO {
        let albedo = canopy_albedo(canopy, ground.albedo);
        return Shaded(mix(albedo, body.water_color, wet), over_sea_m, pixel_ground.spread_m);
    }
    n = bumped(n, in.rel_m, slant, ground.bumps);
    // Tilted ground has a larger area than the untilted ground below it. With the area included, bumps vary the light
    // but not its mean, so the ground is as bright from near as from far away, where bumps are too fine to be drawn.
    let tilt = ground.slope - n * dot(n, ground.slope);
    let area = sqrt(1.0 + dot(tilt, tilt));
    let facet = Facet(n, (n - tilt) / area, area, v, up, rel_km, max(in.height_m * 0.001, 0.0), footprint_m * 0.001);
    var radiance = ground.glow;
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun_at(i, body.eye_km + rel_km);
        var from_here = from_ground;
        if i > 0u { from_here = visibility_at(on_mesh, up); }
        if GIANT { from_here.star *= tops_in_sun(up, footprint_m * 0.001 / body.radius_km); }
        radiance += lit(ground, canopy, facet, from_here, i == 0u);
    }
    let slope = length(n - up * dot(n, up)) / max(dot(n, up), 0.05);
    let sun_mu = dot(up, body.suns[0].dir);
    let settled = vec2f(climate.temperature_c, climate.moisture);
    radiance += settlement_light(in.rel_m, footprint_m, over_sea_m, slope, settled, sun_mu);
    if wet > 0.0 {
        let over_water = Visibility(from_ground.star * objects.sun, from_ground.sky * objects.sky);
        let water = inland_radiance(facet, radiance, pixel_ground.water.y, climate.temperature_c, over_water);
        radiance = mix(radiance, water, wet);
    }
    let marked_radiance = highlighted(radiance, location, body.suns[0].irradiance / PI);
    return Shaded(min(marked_radiance, vec3f(60000.0)), over_sea_m, pixel_ground.spread_m);
}

struct Output {
    // rgb: radiance; a: height above sea level, metres
    @location(0) light: vec4f,
    // Temperature at sea level in °C; share of the sun's light that the surrounding ground hides; half the range of
    // heights within the pixel, metres
    @location(1) surface: vec4f,
}

@fragment
fn fragment(in: Ground) -> Output {
    let up = normalize(body.eye_km + in.rel_m * 0.001);
    use_sun(0u);
    let from_ground = visibility_at(in, up);
    objects = object_shade(in.rel_m, normalize(in.normal));
    let shaded = shade(in, from_ground);
    let spread_m = min(shaded.spread_m, 60000.0);
    let surface = vec4f(in.level_climate.y, 1.0 - from_ground.star * objects.sun, spread_m, 0.0);
    return Output(vec4f(shaded.radiance, shaded.over_sea_m), surface);
}
