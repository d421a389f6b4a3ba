// The sea's surface: waves, reflection, ice.
#include "cloud_model.wgsl"
#include "mottle.wgsl"

struct Waves {
    normal: vec3f,
    // Variance of the slope of all waves too small to be seen
    rest: f32,
}

// Sum of plane waves in the planet frame. A wave shorter than a few pixels fades into roughness (Bruneton, Neyret,
// Holzschuch, Real-time Realistic Ocean Lighting, 2010), so that the mean stays and nothing shimmers.
// `broad`: slow noise that makes crests wander.
fn waves_at(rel_m: vec3f, up: vec3f, footprint_m: f32, broad: f32) -> Waves {
    let total = globals.water_color.w;
    var slope = vec3f(0.0);
    var seen = 0.0;
    if footprint_m < 20.0 {
        // Three quarters of the variance are in waves long enough to be drawn.
        // Each wave bends the next one's crests, or they would cross in a pattern.
        var twist = broad * 16.0;
        let each = 0.75 * total / 16.0;
        for (var i = 0u; i < 16u; i++) {
            let wave = globals.waves[i];
            let along = wave.xyz - up * dot(wave.xyz, up);
            let k = length(along);
            let weight = 1.0 - smoothstep(0.12, 0.4, k * footprint_m / (2.0 * PI));
            if weight <= 0.0 { continue; }
            let phase = dot(wave.xyz, rel_m) + wave.w + twist;
            twist = 1.3 * sin(phase) + 0.4 * twist;
            slope += along / max(k, 1e-6) * (sqrt(2.0 * each) * weight * cos(phase));
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

// Radiance of the star's glint per irradiance: Gaussian slopes (Cox and Munk, 1954) as a Beckmann distribution.
fn glint(n: vec3f, v: vec3f, l: vec3f, variance: f32) -> f32 {
    let n_l = dot(n, l);
    let n_v = max(dot(n, v), 0.03);
    if n_l <= 0.0 { return 0.0; }
    let middle = normalize(l + v);
    let c2 = max(dot(n, middle) * dot(n, middle), 1e-4);
    let slopes = exp(-(1.0 - c2) / (c2 * variance)) / (PI * variance * c2 * c2);
    let fresnel = 0.02 + 0.98 * pow(1.0 - saturate1(dot(v, middle)), 5.0);
    // Waves hide each other at grazing angles (a cheap fit of Smith's term).
    let hidden = 1.0 / (1.0 + variance * (1.0 / max(n_l * n_l, 0.01) + 1.0 / (n_v * n_v)) * 0.25);
    return fresnel * slopes * hidden / (4.0 * n_v);
}

// Share of the sea that is frozen at a temperature, with an edge that noise breaks up.
fn frozen(temperature_c: f32, mottle: f32, broad: f32) -> f32 {
    let broken = temperature_c + broad * 3.0 + mottle * 1.2;
    return 1.0 - smoothstep(-0.4, 0.4, broken - globals.ice_color.w);
}
