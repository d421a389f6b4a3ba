// Draws the sea over the terrain, pixel by pixel: an analytic sphere, with no mesh and so no depth fighting.
#include "surface.wgsl"
#include "sea.wgsl"

// Temperature at sea level in °C; share of the sun's light that the surrounding ground hides; half the range of heights
// within the pixel, metres.
@group(2) @binding(2) var surface: texture_2d<f32>;

// Light that leaves the water: light of the sea bed through the water, and light scattered by the water itself.
// `depths_m`: least and greatest depth in the pixel.
fn water_body(floor: vec3f, depths_m: vec2f, view_mu: f32, sun_mu: f32, downwelling: vec3f) -> vec3f {
    // Refraction (Snell, refractive index 1.333): paths under water are steeper.
    let path = inverseSqrt(1.0 - (1.0 - view_mu * view_mu) / 1.7769)
        + inverseSqrt(1.0 - (1.0 - sun_mu * sun_mu) / 1.7769);
    let shallow = body.water_absorption_per_m * min(path * depths_m.x, 1e5);
    let deeper = body.water_absorption_per_m * min(path * (depths_m.y - depths_m.x), 1e5);
    // Mean over all depths in between.
    let mean = (1.0 - exp(-deeper)) / max(deeper, vec3f(1e-3));
    let transmittance = exp(-shallow) * select(mean, 1.0 - 0.5 * deeper, deeper < vec3f(1e-3));
    return floor * transmittance + body.water_color * downwelling / PI * (1.0 - transmittance);
}

// Greatest depth of foam.
const FOAM_M: f32 = 1.2;

// Integral of the share of foam (1 - smoothstep) from the shore down to a depth.
fn foam_down_to(depth_m: f32) -> f32 {
    let x = saturate1(depth_m / FOAM_M);
    return FOAM_M * x * (1.0 - x * x * (1.0 - 0.5 * x));
}

// Mean share of foam between two depths, where waves run up the shore.
fn foam_between(depths_m: vec2f) -> f32 {
    return (foam_down_to(depths_m.y) - foam_down_to(depths_m.x)) / max(depths_m.y - depths_m.x, 1e-3);
}

// `depths_m`: least and greatest depth in the wet part of the pixel. Foam and shallows along the shore would sparkle if
// only the middle of the pixel counted.
fn sea_radiance(rel_km: vec3f, dir: vec3f, floor: vec3f, depths_m: vec2f, temperature_c: f32, star: f32) -> vec3f {
    let distance_km = length(rel_km);
    let up = normalize(body.eye_km + rel_km);
    let view_mu = clamp(-dot(up, dir), 0.0, 1.0);
    let footprint_m = distance_km * 1000.0 * frame.pixel_rad / max(sqrt(view_mu), 0.1);
    let h = max(body.sea_level_km, 0.0);
    let rel_m = rel_km * 1000.0;
    let variation = macro_variation(rel_m, footprint_m);
    let broad = border_jitter(rel_m, footprint_m).x;
    let ice = frozen(temperature_c, variation, broad);
    // Only the first sun determines the path of light down through the water.
    let first_mu = max(dot(up, body.suns[0].dir), 0.0);
    var waves = Waves(up, 0.0);
    var fresnel = 0.0;
    var mirror_mu = 0.0;
    if ice < 1.0 {
        let step_x = pixel_step(rel_m, up, body.pixel_right);
        let step_y = pixel_step(rel_m, up, body.pixel_up);
        waves = waves_at(rel_m, up, step_x, step_y, border_jitter(rel_m, max(footprint_m, 15.0)).x);
        fresnel = fresnel_sea(dot(waves.normal, -dir), waves.rest);
        let mirrored = reflect(dir, waves.normal);
        // Rough water reflects a patch of sky above the mirror direction.
        mirror_mu = max(dot(mirrored, up), 0.0) + sqrt(waves.rest) * 0.5;
    }
    var downwelling = vec3f(0.0);
    var mirrored_light = vec3f(0.0);
    for (var i = 0u; i < body.sun_count; i++) {
        use_sun(i);
        let sun = active_sun.dir;
        let sun_mu = dot(up, sun);
        let sunlight = active_sun.irradiance * sun_transmittance(h, sun_mu);
        var shadow = 1.0;
        if sun_mu > -0.1 { shadow = cloud_shadow(rel_km, h, sun_mu, footprint_m * 0.001); }
        let share = overcast(shadow);
        // The shadow of the ground is known for the first sun only.
        shadow *= select(1.0, star, i == 0u);
        let diffused = sunlight * max(sun_mu, 0.0) * share.y;
        downwelling += sunlight * shadow * max(sun_mu, 0.0) + sky_irradiance(h, sun_mu) * share.x + diffused;
        if ice < 1.0 {
            mirrored_light += (sky_radiance(mirror_mu, sun_mu) * share.x + diffused / PI) * fresnel;
            mirrored_light += sunlight * shadow * glint(waves.normal, -dir, sun, waves.rest);
        }
    }
    var water = vec3f(0.0);
    if ice < 1.0 {
        water = water_body(floor, depths_m, view_mu, first_mu, downwelling) * (1.0 - fresnel) + mirrored_light;
        let foam = foam_between(depths_m) * smoothstep(0.1, 0.6, variation + 0.25);
        water = mix(water, vec3f(0.7) * downwelling / PI, foam * 0.6);
    }
    let white = body.ice_color * (1.0 + 0.18 * variation) * downwelling / PI;
    return mix(water, white, ice);
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

    if body.eye_over_sea_km < 0.0 {
        // The eye is under water: the water's colour replaces distant light.
        let path_m = min(terrain, hits.y) * 1000.0;
        let transmittance = exp(-body.water_absorption_per_m * min(path_m, 1e5));
        let h = max(body.sea_level_km, 0.0);
        var light = vec3f(0.0);
        for (var i = 0u; i < body.sun_count; i++) {
            use_sun(i);
            let sun_mu = max(dot(body.eye_up, active_sun.dir), 0.0);
            light += active_sun.irradiance * sun_transmittance(h, sun_mu) * sun_mu + sky_irradiance(h, sun_mu);
        }
        let dimmed = exp(body.water_absorption_per_m * min(body.eye_over_sea_km * 1000.0, 0.0));
        let water = body.water_color * light * dimmed / PI;
        return Output(vec4f(scene.rgb * transmittance + water * (1.0 - transmittance), height_m), ground.depth);
    }
    if hits.y < hits.x || hits.x <= 0.0 {
        if terrain >= NOTHING_KM { discard; }
        return ground;
    }
    let depth = max(ground.depth, depth_at(hits.x, ray_length));
    // Sea and land are told apart by the height of the ground, never by the depth of two close surfaces. The sea lies
    // in front of land only where the ray leaves the sea again before it meets land.
    var wet = 1.0;
    var depths_m = vec2f(1e4, 1.1e4);
    var star = 1.0;
    // Where there is no terrain, the climate of the latitude is used.
    let sin_lat = normalize(body.eye_km + dir * hits.x).z;
    var temperature_c = mix(body.equator_c, body.pole_c, sin_lat * sin_lat);
    if terrain < NOTHING_KM && terrain < max(hits.y, hits.x * 1.01) {
        let found = textureLoad(surface, pixel, 0);
        let spread_m = max(found.b, 0.025);
        wet = saturate1(0.5 - 0.5 * height_m / spread_m);
        depths_m = max(vec2f(-height_m - spread_m, spread_m - height_m), vec2f(0.0));
        temperature_c = found.r;
        // The visible sea bed is offset sideways from the point on the sea; with a large offset, its shadow does not
        // apply there.
        let mu = dot(dir, normalize(body.eye_km + dir * hits.x));
        let aside_km = max(terrain - hits.x, 0.0) * sqrt(max(1.0 - mu * mu, 0.0));
        star = 1.0 - found.g * (1.0 - smoothstep(1.0, 10.0, aside_km));
    }
    if wet <= 0.0 { return Output(scene, depth); }
    let sea = sea_radiance(dir * hits.x, dir, scene.rgb, depths_m, temperature_c, star);
    return Output(vec4f(min(mix(scene.rgb, sea, wet), vec3f(60000.0)), height_m), depth);
}
