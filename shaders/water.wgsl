// Draws the sea over the terrain, pixel by pixel: an analytic sphere, with no mesh and so no depth fighting.
#include "surface.wgsl"
#include "object_shadow.wgsl"
#include "sea.wgsl"
#include "underwater.wgsl"
#include "bed.wgsl"

// Temperature at sea level in °C; share of the sun's light that the surrounding ground hides; half the range of heights
// within the pixel, metres.
@group(2) @binding(2) var surface: texture_2d<f32>;

// Variance of the slope of all waves at a direction: the part that the wind raises varies with its speed.
fn slope_variance(up: vec3f) -> f32 {
    if body.has_wind == 0u { return body.wave_slope_variance; }
    let wind = textureSampleLevel(cloud_maps, clamped, up, 0, 0.0).g;
    return CALM_SLOPE_VARIANCE + (body.wave_slope_variance - CALM_SLOPE_VARIANCE) * wind;
}

// `depths_m`: least and greatest depth in the wet part of the pixel. Foam and shallows along the shore would sparkle if
// only the middle of the pixel counted.
fn sea_radiance(
    rel_km: vec3f, dir: vec3f, floor: vec3f, depths_m: vec2f, temperature_c: f32, star: f32, lift_m: f32,
    column: Column,
) -> vec3f {
    return water_radiance(Water(
        rel_km, dir, floor, depths_m, temperature_c, Visibility(star, 1.0), max(body.sea_level_km, 0.0),
        body.water_absorption_per_m, body.water_color, slope_variance(normalize(body.eye_km + rel_km)), 1.0, lift_m,
        1.0, column,
    ));
}

// The water where a ray meets the calm sea, `flat_km` away; negative where it does not. `depth_m`: of the bed under the
// pixel.
fn column_at(dir: vec3f, flat_km: f32, sine: f32, temperature_c: f32, depth_m: f32) -> Column {
    let ice = ice_on(temperature_c);
    let plain = Column(vec3f(0.0), depth_m, vec3f(0.0), ice);
    if NEARNESS == FROM_ORBIT || flat_km <= 0.0 { return plain; }
    let rel_m = dir * flat_km * 1000.0;
    let up = normalize(body.eye_km + dir * flat_km);
    let calm_m = rel_m - up * altitude_over_sea_m(dir, flat_km, sine);
    let step_x = pixel_step(calm_m, up, body.pixel_right);
    let step_y = pixel_step(calm_m, up, body.pixel_up);
    let footprint_m = max(length(step_x), length(step_y));
    // Beyond, no wave is drawn.
    if body.wave_count == 0u || 0.2 * length(body.waves[0].vector_per_m) * footprint_m > WAVE_LOST { return plain; }
    return column_under(calm_m, up, footprint_m, ice);
}

// Shares of the way of a ray through the sphere of the sea within which the bed counts less, and no longer.
const FAR_BEYOND: vec2f = vec2f(0.05, 0.3);

// Whether the sea hides land whose drawn surface lies under the sea. Far tiles are flat between vertices that are
// kilometres apart, so that they sag, and seen along the water the sag is many kilometres of it.
fn sea_hides(dir: vec3f, terrain_km: f32, sine: f32, height_m: f32) -> bool {
    let lift_km = 0.001 * (height_m - altitude_over_sea_m(dir, terrain_km, sine));
    let there = dir * terrain_km + normalize(body.eye_km + dir * terrain_km) * lift_km;
    let hits = sea_hits(normalize(there));
    return hits.y > hits.x && hits.x > 0.0 && hits.x < 0.999 * length(there);
}

struct Output {
    // rgb: radiance; a: height above sea level, metres
    @location(0) light: vec4f,
    @builtin(frag_depth) depth: f32,
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> Output {
    let pixel = vec2i(position.xy);
    let scene = textureLoad(scene_color, pixel, 0);
    let height_m = scene.a;
    let ray = pixel_ray(position.xy);
    let ray_length = length(ray);
    let dir = ray / ray_length;
    let terrain = surface_distance(pixel, ray_length);
    let hits = sea_hits(dir);
    let ground = Output(scene, textureLoad(scene_depth, pixel, 0));
    let sine = dot(dir, body.eye_up);

    if NEARNESS == FROM_GROUND && body.eye_is_under == 1u {
        let surface_km = displaced_km(dir, select(-1.0, hits.y, hits.y > 0.0), sine, eye_column());
        let light = underwater(dir, scene.rgb, terrain, surface_km);
        // Water hides what is farther: the air's light must not cover it.
        let nearest_km = min(select(terrain, min(surface_km, terrain), surface_km > 0.0), 0.2);
        return Output(vec4f(min(light, vec3f(60000.0)), height_m), depth_at(nearest_km, ray_length));
    }
    let flat_km = select(-1.0, hits.x, hits.y >= hits.x && hits.x > 0.0);
    var has_bed = terrain < NOTHING_KM && terrain < max(hits.y, hits.x * 1.01);
    // How far along its way through the sphere of the sea the ray meets the ground. A flat ray does so on slopes far
    // beyond the place where it meets the sea, which say nothing about the water there.
    let beyond = select(0.0, (terrain - flat_km) / max(hits.y - flat_km, 1e-6), has_bed && flat_km > 0.0);
    if beyond > FAR_BEYOND.y && (height_m <= 0.0 || sea_hides(dir, terrain, sine, height_m)) { has_bed = false; }
    let found = textureLoad(surface, pixel, 0);
    // Where there is no terrain, the climate of the latitude is used.
    let sin_lat = normalize(body.eye_km + dir * max(flat_km, 0.0)).z;
    let temperature_c = select(mix(body.equator_c, body.pole_c, sin_lat * sin_lat), found.r, has_bed);
    let column = column_at(dir, flat_km, sine, temperature_c, select(1e4, max(-height_m, 0.0), has_bed));
    let surface_km = displaced_km(dir, flat_km, sine, column);
    if surface_km <= 0.0 {
        if terrain >= NOTHING_KM { discard; }
        return ground;
    }
    let depth = max(ground.depth, depth_at(surface_km, ray_length));
    // Sea and land are told apart by the height of the ground, never by the depth of two close surfaces. The sea lies
    // in front of land only where the ray leaves the sea again before it meets land.
    var wet = 1.0;
    var depths_m = vec2f(1e4, 1.1e4);
    var star = 1.0;
    if has_bed {
        let spread_m = max(found.b, 0.025);
        wet = saturate1(0.5 - 0.5 * height_m / spread_m);
        depths_m = max(vec2f(-height_m - spread_m, spread_m - height_m), vec2f(0.0));
        depths_m += 1e3 * smoothstep(FAR_BEYOND.x, FAR_BEYOND.y, beyond);
        // The visible sea bed is offset sideways from the point on the sea; with a large offset, its shadow does not
        // apply there.
        let mu = dot(dir, normalize(body.eye_km + dir * surface_km));
        let aside_km = max(terrain - surface_km, 0.0) * sqrt(max(1.0 - mu * mu, 0.0));
        star = 1.0 - found.g * (1.0 - smoothstep(1.0, 10.0, aside_km));
    }
    if wet <= 0.0 { return Output(scene, depth); }
    if body.has_casters != 0u {
        // The bed knows the shadow that falls on it; that of a ship lies on the water.
        let there = dir * surface_km;
        star = min(star, object_shade(there * 1000.0, normalize(body.eye_km + there)).sun);
    }
    let lift_m = select(0.0, altitude_over_sea_m(dir, surface_km, sine), body.wave_steps > 0u);
    let sea = sea_radiance(dir * surface_km, dir, scene.rgb, depths_m, temperature_c, star, lift_m, column);
    return Output(vec4f(min(mix(scene.rgb, sea, wet), vec3f(60000.0)), height_m), depth);
}
