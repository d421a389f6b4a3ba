// Colours of the debug views. src/render/legend.rs has them, too.
#include "math.wgsl"

fn ramp(x: f32) -> vec3f {
    // Deep blue, teal, green, sand, brown, white.
    let k = saturate1(x) * 5.0;
    var c = mix(vec3f(0.01, 0.02, 0.12), vec3f(0.02, 0.22, 0.30), saturate1(k));
    c = mix(c, vec3f(0.06, 0.28, 0.08), saturate1(k - 1.0));
    c = mix(c, vec3f(0.52, 0.44, 0.20), saturate1(k - 2.0));
    c = mix(c, vec3f(0.26, 0.13, 0.07), saturate1(k - 3.0));
    return mix(c, vec3f(0.95), saturate1(k - 4.0));
}

fn level_color(level: f32) -> vec3f {
    let hue = fract(level * 0.381966);
    return 0.15 + 0.75 * saturate(abs(fract(hue + vec3f(0.0, 0.6667, 0.3333)) * 6.0 - 3.0) - 1.0);
}

// Cold to hot, white in the middle.
fn temperature_color(x: f32) -> vec3f {
    let k = saturate1(x) * 4.0;
    var c = mix(vec3f(0.05, 0.03, 0.35), vec3f(0.10, 0.40, 0.80), saturate1(k));
    c = mix(c, vec3f(0.85), saturate1(k - 1.0));
    c = mix(c, vec3f(0.85, 0.40, 0.06), saturate1(k - 2.0));
    return mix(c, vec3f(0.35, 0.01, 0.02), saturate1(k - 3.0));
}

// Sand, grass, deep water.
fn moisture_color(x: f32) -> vec3f {
    let c = mix(vec3f(0.75, 0.55, 0.25), vec3f(0.10, 0.45, 0.10), saturate1(x * 2.0));
    return mix(c, vec3f(0.01, 0.08, 0.55), saturate1(x * 2.0 - 1.0));
}

// Blue, green, yellow, red: one step for each factor of four, starting at 1.
fn spacing_color(pixels: f32) -> vec3f {
    let k = log2(max(pixels, 1.0)) * 0.5;
    var c = mix(vec3f(0.03, 0.08, 0.60), vec3f(0.05, 0.50, 0.10), saturate1(k));
    c = mix(c, vec3f(0.80, 0.65, 0.05), saturate1(k - 1.0));
    return mix(c, vec3f(0.65, 0.02, 0.02), saturate1(k - 2.0));
}

// Ground under the sea on which nothing stands.
const UNDER_SEA: vec3f = vec3f(0.006, 0.008, 0.014);

// None to the most of a population: dark violet, blue, teal, green, yellow, in steps that look even (viridis, Smith and
// van der Walt 2015).
fn density_color(x: f32) -> vec3f {
    let k = saturate1(x) * 5.0;
    var c = mix(vec3f(0.058, 0.001, 0.089), vec3f(0.053, 0.058, 0.242), saturate1(k));
    c = mix(c, vec3f(0.023, 0.188, 0.270), saturate1(k - 1.0));
    c = mix(c, vec3f(0.016, 0.392, 0.231), saturate1(k - 2.0));
    c = mix(c, vec3f(0.195, 0.638, 0.082), saturate1(k - 3.0));
    return mix(c, vec3f(0.982, 0.799, 0.019), saturate1(k - 4.0));
}
