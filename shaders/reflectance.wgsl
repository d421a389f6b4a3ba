// What ground reflects: diffuse and specular reflection.
#include "math.wgsl"

// Oren-Nayar in the form of Fujii (A tiny improvement of Oren-Nayar reflectance model). The result is to be multiplied
// by the cosine of the tilted normal to the light. `n_l` and `n_v` ignore the tilt, because it is part of the roughness
// already: counted twice, it would make patterns brighter from near than from far away, where they are too fine to be
// drawn. `tilted_l`: cosine of the tilted normal to the light. It bounds the retroreflection, which would grow without
// limit on ground seen edge-on under a low sun.
fn rough_diffuse(n_l: f32, n_v: f32, l_v: f32, tilted_l: f32, roughness: f32) -> f32 {
    let sigma = roughness * 0.6;
    let s = l_v - n_l * n_v;
    let t = select(1.0, max(max(n_l, n_v), max(tilted_l, 1e-3)), s > 0.0);
    let a = 1.0 / (PI + (PI / 2.0 - 2.0 / 3.0) * sigma);
    return a + sigma * a * s / t;
}

// Cosine to the light of ground with bumps finer than those drawn: some facets of a slope that just turns away still
// see the light, and some of a slope that just sees it do not. A clamp at zero would leave black blots under a low sun.
fn lit_cosine(n_l: f32) -> f32 {
    const SOFT: f32 = 0.12;
    let grazing = max(n_l + SOFT, 0.0);
    return select(n_l, grazing * grazing / (4.0 * SOFT), n_l < SOFT);
}

// Specular reflection of sunlight (x) and, on average, of skylight (y): GGX with the visibility of Hammon (PBR Diffuse
// Lighting for GGX+Smith Microsurfaces, 2017), and Karis' fit for light from all directions (Physically Based Shading
// on Mobile, 2014).
fn mirrored(n: vec3f, v: vec3f, l: vec3f, roughness: f32, reflectance: f32) -> vec2f {
    if reflectance <= 0.0 { return vec2f(0.0); }
    let n_v = max(dot(n, v), 1e-3);
    let fit = vec4f(1.0, 0.0425, 1.04, -0.04) + roughness * vec4f(-1.0, -0.0275, -0.572, 0.022);
    let grazing = min(fit.x * fit.x, exp2(-9.28 * n_v)) * fit.x + fit.y;
    let offset = min(reflectance * 50.0, 1.0) * (fit.w + 1.04 * grazing);
    let around = max(reflectance * (fit.z - 1.04 * grazing) + offset, 0.0);
    let n_l = dot(n, l);
    if n_l <= 0.0 { return vec2f(0.0, around); }
    let h = normalize(v + l);
    let n_h = max(dot(n, h), 0.0);
    let alpha = max(roughness * roughness, 0.02);
    let d = n_h * n_h * (alpha * alpha - 1.0) + 1.0;
    // Seen against a low sun, rough ground hides itself by more than its facets: by unevenness that is not drawn.
    let visible = 0.5 / (mix(2.0 * n_l * n_v, n_l + n_v, alpha) + 0.15 * alpha);
    // The facets of rough ground are no mirrors: at grazing angles it shines no more than Karis' fit says of skylight.
    let smooth_part = (1.0 - roughness) * (1.0 - roughness);
    let fresnel = reflectance + max(smooth_part - reflectance, 0.0) * pow(1.0 - saturate1(dot(v, h)), 5.0);
    return vec2f(alpha * alpha / (PI * d * d) * visible * fresnel * n_l, around);
}
