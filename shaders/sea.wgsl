// Water of the sea, of lakes and of rivers: its body, waves, reflection, foam, ice.
#include "cloud_model.wgsl"
#include "macro_variation.wgsl"
#include "visibility.wgsl"

// Amplitudes of three sets of wave groups, some hundred metres wide; their mean square is 1. `footprint_m`: width of a
// pixel at the point.
fn wave_groups(rel_m: vec3f, footprint_m: f32) -> vec3f {
    let octave = body.variation[3];
    let lod = max(log2(footprint_m * NOISE_TILE_SIDE / octave.period), 0.0);
    let at = octave.offset + rel_m / octave.period;
    let first = textureSampleLevel(noise_tile, repeated, at.zxy * 4.0, lod + 2.0).rg;
    let second = textureSampleLevel(noise_tile, repeated, at.yzx * 4.0, lod + 2.0).r;
    return saturate(vec3f(first, second) * 3.0 - 1.0) * 1.5;
}

struct Waves {
    normal: vec3f,
    // Variance of the slope of all waves too small to be drawn
    rest: f32,
}

// Sum of plane waves in the planet frame. A wave shorter than a few pixels fades into roughness (Bruneton, Neyret,
// Holzschuch, Real-time Realistic Ocean Lighting, 2010), so that the mean stays and nothing shimmers. `step_x`,
// `step_y`: steps to the next pixel along the water, metres. `broad`: slow noise that bends crests. It must change
// little over a wavelength, or crests follow the contours of the noise like the grain of wood. `total`: variance of the
// slope of all waves.
fn waves_at(rel_m: vec3f, up: vec3f, step_x: vec3f, step_y: vec3f, broad: f32, total: f32) -> Waves {
    var slope = vec3f(0.0);
    var seen = 0.0;
    if min(length(step_x), length(step_y)) < 20.0 {
        // Three quarters of the variance belong to waves long enough to be drawn. Each wave bends the crests of the
        // next; straight crests would cross in a pattern.
        var twist = broad * 16.0;
        // Gradient of `twist`. It changes the distance between crests; waves fade where crests are too close.
        var twist_k = vec3f(0.0);
        let each = 0.75 * total / f32(WAVES);
        // Waves come in groups: a single long wave would be a grid of straight lines.
        let groups = wave_groups(rel_m, min(length(step_x), length(step_y)));
        for (var i = 0u; i < WAVES; i++) {
            let wave = body.waves[i];
            let along = wave.vector_per_m - up * dot(wave.vector_per_m, up);
            let k = length(along);
            let phase = dot(wave.vector_per_m, rel_m) + wave.phase + twist;
            let bent_k = along + twist_k;
            let bent_turn = max(abs(dot(bent_k, step_x)), abs(dot(bent_k, step_y)));
            let straight_turn = max(abs(dot(along, step_x)), abs(dot(along, step_y)));
            let cycles = max(bent_turn, straight_turn) / (2.0 * PI);
            twist = 1.3 * sin(phase) + 0.4 * twist;
            twist_k = 1.3 * cos(phase) * bent_k + 0.4 * twist_k;
            let weight = 1.0 - smoothstep(0.08, 0.28, cycles);
            if weight <= 0.0 { continue; }
            slope += along / max(k, 1e-6) * (sqrt(2.0 * each) * weight * groups[i % 3u] * cos(phase));
            seen += each * weight * weight;
        }
    }
    var out: Waves;
    out.normal = normalize(up - slope);
    out.rest = max(total - seen, 0.0004);
    return out;
}

// Mean Fresnel reflectance of a rough sea (Bruneton et al. 2010).
fn fresnel_sea(cosine: f32, variance: f32) -> f32 {
    let sigma = sqrt(variance);
    let grazing = pow(1.0 - saturate1(cosine), 5.0 * exp(-2.69 * sigma));
    return 0.02 + 0.98 * grazing / (1.0 + 22.7 * pow(sigma, 1.5));
}

// Radiance of the sun's glint for unit irradiance: Gaussian slopes (Cox and Munk, 1954) as a Beckmann distribution.
fn glint(n: vec3f, v: vec3f, l: vec3f, variance: f32) -> f32 {
    let n_l = dot(n, l);
    let n_v = max(dot(n, v), 0.03);
    if n_l <= 0.0 { return 0.0; }
    let middle = normalize(l + v);
    let c2 = max(dot(n, middle) * dot(n, middle), 1e-4);
    let slopes = exp(-(1.0 - c2) / (c2 * variance)) / (PI * variance * c2 * c2);
    let fresnel = 0.02 + 0.98 * pow(1.0 - saturate1(dot(v, middle)), 5.0);
    // Waves hide each other at grazing angles (approximation of Smith's term).
    let hidden = 1.0 / (1.0 + variance * (1.0 / max(n_l * n_l, 0.01) + 1.0 / (n_v * n_v)) * 0.25);
    return fresnel * slopes * hidden / (4.0 * n_v);
}

// Share of ice at a temperature, with an edge broken up by noise.
fn frozen(temperature_c: f32, variation: f32, broad: f32) -> f32 {
    let broken = temperature_c + broad * 3.0 + variation * 1.2;
    return 1.0 - smoothstep(-0.4, 0.4, broken - body.freezing_c);
}

// Water at a pixel.
struct Water {
    rel_km: vec3f,
    // Direction of the view ray
    dir: vec3f,
    // Radiance of the bed without the water
    floor: vec3f,
    // Least and greatest depth in the wet part of the pixel
    depths_m: vec2f,
    temperature_c: f32,
    // Over the surrounding ground, of the first sun and of the sky
    visible: Visibility,
    altitude_km: f32,
    absorption_per_m: vec3f,
    // Light that deep water scatters back
    color: vec3f,
    // Variance of the slope of all waves
    slope_variance: f32,
    // Strength of foam along the shore
    foam: f32,
}

// Light that leaves the water: light of the sea bed through the water, and light scattered by the water itself.
fn water_body(water: Water, view_mu: f32, sun_mu: f32, downwelling: vec3f) -> vec3f {
    // Refraction (Snell, refractive index 1.333): paths under water are steeper.
    let path = inverseSqrt(1.0 - (1.0 - view_mu * view_mu) / 1.7769)
        + inverseSqrt(1.0 - (1.0 - sun_mu * sun_mu) / 1.7769);
    let shallow = water.absorption_per_m * min(path * water.depths_m.x, 1e5);
    let deeper = water.absorption_per_m * min(path * (water.depths_m.y - water.depths_m.x), 1e5);
    // Mean over all depths in between.
    let mean = (1.0 - exp(-deeper)) / max(deeper, vec3f(1e-3));
    let transmittance = exp(-shallow) * select(mean, 1.0 - 0.5 * deeper, deeper < vec3f(1e-3));
    return water.floor * transmittance + water.color * downwelling / PI * (1.0 - transmittance);
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

// How gusts and slicks vary the part of the slopes' variance that the wind raises, as the exponent of the noise: glints
// show streaks on photographs from orbit. By eye.
const GUSTS: f32 = 1.2;

fn gusty(variance: f32, noise: f32) -> f32 {
    let raised = max(variance - CALM_SLOPE_VARIANCE, 0.0);
    return min(variance, CALM_SLOPE_VARIANCE) + raised * exp(GUSTS * noise);
}

// Share of the sea that breaking waves whiten (Monahan and Muircheartaigh 1980), from the variance of the slopes (Cox
// and Munk 1954: 0.003 + 0.00512 times the wind in m/s).
fn whitecaps(variance: f32) -> f32 {
    let wind_m_s = max(variance - CALM_SLOPE_VARIANCE, 0.0) / 0.00512;
    return min(2.95e-6 * pow(wind_m_s, 3.52), 0.12);
}

// Water is not the same everywhere: plankton makes it greener, its absence bluer.
fn tinted(color: vec3f, noise: f32) -> vec3f {
    return color * mix(vec3f(0.9, 0.8, 0.95), vec3f(1.1, 1.3, 1.05), saturate1(0.5 + 0.7 * noise));
}

// Radiance of water.
fn water_radiance(water: Water) -> vec3f {
    let rel_km = water.rel_km;
    let dir = water.dir;
    let distance_km = length(rel_km);
    let up = normalize(body.eye_km + rel_km);
    let view_mu = clamp(-dot(up, dir), 0.0, 1.0);
    let footprint_m = distance_km * 1000.0 * frame.pixel_rad / max(sqrt(view_mu), 0.1);
    let h = water.altitude_km;
    let rel_m = rel_km * 1000.0;
    let variation = macro_variation(rel_m, footprint_m);
    let jitter = border_jitter(rel_m, footprint_m);
    let broad = jitter.x;
    let ice = frozen(water.temperature_c, variation, broad);
    // Only the first sun determines the path of light down through the water.
    let first_mu = max(dot(up, body.suns[0].dir), 0.0);
    // From near, single waves show the wind.
    let gust = jitter.y * smoothstep(5.0, 50.0, distance_km);
    let slope_variance = gusty(water.slope_variance, gust);
    var waves = Waves(up, 0.0);
    var fresnel = 0.0;
    var mirror_mu = 0.0;
    if ice < 1.0 {
        let step_x = pixel_step(rel_m, up, body.pixel_right);
        let step_y = pixel_step(rel_m, up, body.pixel_up);
        let bend = border_jitter(rel_m, max(footprint_m, 15.0)).x;
        waves = waves_at(rel_m, up, step_x, step_y, bend, slope_variance);
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
        shadow *= select(1.0, water.visible.star, i == 0u);
        let diffused = sunlight * max(sun_mu, 0.0) * share.y;
        downwelling += sunlight * shadow * max(sun_mu, 0.0) + sky_irradiance(h, sun_mu) * share.x + diffused;
        if ice < 1.0 {
            mirrored_light += (sky_radiance(mirror_mu, sun_mu) * share.x + diffused / PI) * fresnel * water.visible.sky;
            mirrored_light += sunlight * shadow * glint(waves.normal, -dir, sun, waves.rest);
        }
    }
    var light = vec3f(0.0);
    if ice < 1.0 {
        var here = water;
        here.color = tinted(water.color, variation);
        light = water_body(here, view_mu, first_mu, downwelling) * (1.0 - fresnel) + mirrored_light;
        let surf = foam_between(water.depths_m) * smoothstep(0.1, 0.6, variation + 0.25);
        let foam = max(surf * 0.6, whitecaps(water.slope_variance)) * water.foam;
        light = mix(light, vec3f(0.7) * downwelling / PI, foam);
    }
    let white = body.ice_color * (1.0 + 0.18 * variation) * downwelling / PI;
    return mix(light, white, ice);
}
