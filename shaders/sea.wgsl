// The surface of the sea: waves, reflection, ice.
#include "cloud_model.wgsl"
#include "macro_variation.wgsl"

// Amplitudes of three sets of wave groups, some hundred metres wide; their mean square is 1. `footprint_m`: width of a
// pixel at the point.
fn wave_groups(rel_m: vec3f, footprint_m: f32) -> vec3f {
    let octave = body.variation[2];
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
// `step_y`: steps to the next pixel along the sea, metres. `broad`: slow noise that bends crests. It must change little
// over a wavelength, or crests follow the contours of the noise like the grain of wood.
fn waves_at(rel_m: vec3f, up: vec3f, step_x: vec3f, step_y: vec3f, broad: f32) -> Waves {
    let total = body.wave_slope_variance;
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
