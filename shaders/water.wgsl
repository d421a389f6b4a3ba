// Lays the sea over the terrain, pixel by pixel: an analytic sphere, so there is no mesh to fight with.
#include "surface.wgsl"
#include "sea.wgsl"

// Temperature, °C; share of the star's light that the ground around takes; how far the ground within a pixel goes above and below its
// height, metres.
@group(2) @binding(2) var surface: texture_2d<f32>;

// Light that comes out of the water: the floor through it, and what the water itself sends back. `depths_m`: least and greatest in the
// pixel.
fn body(floor: vec3f, depths_m: vec2f, view_mu: f32, sun_mu: f32, downwelling: vec3f) -> vec3f {
    // Snell: the way under water is steeper than over it.
    let way = inverseSqrt(1.0 - (1.0 - view_mu * view_mu) / 1.7769) + inverseSqrt(1.0 - (1.0 - sun_mu * sun_mu) / 1.7769);
    let shallow = globals.water_absorption.rgb * min(way * depths_m.x, 1e5);
    let deeper = globals.water_absorption.rgb * min(way * (depths_m.y - depths_m.x), 1e5);
    // Mean over all depths between.
    let left = exp(-shallow) * select((1.0 - exp(-deeper)) / max(deeper, vec3f(1e-3)), 1.0 - 0.5 * deeper, deeper < vec3f(1e-3));
    return floor * left + globals.water_color.rgb * downwelling / PI * (1.0 - left);
}

// Deeper water has no foam.
const FOAM_M: f32 = 1.2;

// Integral of the share of foam (1 - smoothstep) from the shore down to a depth.
fn foam_down_to(depth_m: f32) -> f32 {
    let x = saturate1(depth_m / FOAM_M);
    return FOAM_M * x * (1.0 - x * x * (1.0 - 0.5 * x));
}

// Foam where waves run up the shore.
fn foam_between(depths_m: vec2f) -> f32 {
    return (foam_down_to(depths_m.y) - foam_down_to(depths_m.x)) / max(depths_m.y - depths_m.x, 1e-3);
}

// `depths_m`: least and greatest depth of what is wet of the pixel; what lines the shore would sparkle if its middle told all.
fn sea_radiance(rel_km: vec3f, dir: vec3f, floor: vec3f, depths_m: vec2f, temperature_c: f32, star: f32) -> vec3f {
    let distance_km = length(rel_km);
    let up = normalize(globals.eye_km.xyz + rel_km);
    let view_mu = clamp(-dot(up, dir), 0.0, 1.0);
    let sun = globals.sun_dir.xyz;
    let sun_mu = dot(up, sun);
    let footprint_m = distance_km * 1000.0 * globals.eye_low_m.w / max(sqrt(view_mu), 0.1);
    let h = max(globals.water.x, 0.0);
    let sunlight = globals.sun_irradiance.rgb * sun_transmittance(h, sun_mu);
    var shadow = 1.0;
    if sun_mu > -0.1 { shadow = cloud_shadow(rel_km, h, sun_mu, footprint_m * 0.001); }
    let share = overcast(shadow);
    shadow *= star;
    let diffused = sunlight * max(sun_mu, 0.0) * share.y;
    let sky = sky_irradiance(h, sun_mu) * share.x + diffused;
    let downwelling = sunlight * shadow * max(sun_mu, 0.0) + sky;

    let rel_m = rel_km * 1000.0;
    let mottle = mottle_at(rel_m, footprint_m);
    let broad = border_jitter(rel_m, footprint_m).x;
    let ice = frozen(temperature_c, mottle, broad);
    var water = vec3f(0.0);
    if ice < 1.0 {
        let waves = waves_at(rel_m, up, pixel_step(rel_m, up, globals.ray_right), pixel_step(rel_m, up, -globals.ray_up), border_jitter(rel_m, max(footprint_m, 15.0)).x);
        let fresnel = fresnel_sea(dot(waves.normal, -dir), waves.rest);
        let mirrored = reflect(dir, waves.normal);
        // Rough water mirrors a patch of sky above the exact direction.
        let mirror_mu = max(dot(mirrored, up), 0.0) + sqrt(waves.rest) * 0.5;
        let reflection = sky_radiance(mirror_mu, sun_mu) * share.x + diffused / PI;
        water = body(floor, depths_m, view_mu, max(sun_mu, 0.0), downwelling) * (1.0 - fresnel) + reflection * fresnel;
        water += sunlight * shadow * glint(waves.normal, -dir, sun, waves.rest);
        let foam = foam_between(depths_m) * smoothstep(0.1, 0.6, mottle + 0.25);
        water = mix(water, vec3f(0.7) * downwelling / PI, foam * 0.6);
    }
    let white = globals.ice_color.rgb * (1.0 + 0.18 * mottle) * downwelling / PI;
    return mix(water, white, ice);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    let scene = textureLoad(scene_color, pixel, 0);
    let height_m = scene.a;
    let ray = pixel_ray(position.xy);
    let ray_length = length(ray);
    let dir = ray / ray_length;
    let terrain = terrain_distance(pixel, ray_length);
    let hits = sea_hits(dir);

    if globals.water.y < 0.0 {
        // The eye is under water: everything drowns in the colour of the deep.
        let way_m = min(terrain, hits.y) * 1000.0;
        let left = exp(-globals.water_absorption.rgb * min(way_m, 1e5));
        let sun_mu = max(dot(globals.eye_up.xyz, globals.sun_dir.xyz), 0.0);
        let h = max(globals.water.x, 0.0);
        let light = globals.sun_irradiance.rgb * sun_transmittance(h, sun_mu) * sun_mu + sky_irradiance(h, sun_mu);
        let dimmed = exp(globals.water_absorption.rgb * min(globals.water.y * 1000.0, 0.0));
        return vec4f(scene.rgb * left + globals.water_color.rgb * light * dimmed / PI * (1.0 - left), height_m);
    }
    if hits.y < hits.x || hits.x <= 0.0 { return scene; }
    // Land is told from sea by its height, never by which of two close surfaces is nearer; only where the ray came out
    // of the sea again before it met land does the sea lie in front.
    var wet = 1.0;
    var depths_m = vec2f(1e4, 1.1e4);
    var star = 1.0;
    // Beyond the last terrain the climate of the latitude has to do.
    let sin_lat = normalize(globals.eye_km.xyz + dir * hits.x).z;
    var temperature_c = mix(globals.water.z, globals.water.w, sin_lat * sin_lat);
    if terrain < NOTHING_KM && terrain < max(hits.y, hits.x * 1.01) {
        let found = textureLoad(surface, pixel, 0);
        let spread_m = max(found.b, 0.025);
        wet = saturate1(0.5 - 0.5 * height_m / spread_m);
        depths_m = max(vec2f(-height_m - spread_m, spread_m - height_m), vec2f(0.0));
        temperature_c = found.r;
        // The floor that is seen lies aside of the sea's surface; too far aside its shadow is another one.
        let mu = dot(dir, normalize(globals.eye_km.xyz + dir * hits.x));
        let aside_km = max(terrain - hits.x, 0.0) * sqrt(max(1.0 - mu * mu, 0.0));
        star = 1.0 - found.g * (1.0 - smoothstep(1.0, 10.0, aside_km));
    }
    if wet <= 0.0 { return scene; }
    let sea = sea_radiance(dir * hits.x, dir, scene.rgb, depths_m, temperature_c, star);
    return vec4f(min(mix(scene.rgb, sea, wet), vec3f(60000.0)), height_m);
}
