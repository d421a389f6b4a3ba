// The light that the lens takes from the exposed picture, at a quarter of its size.
#include "bloom.wgsl"

@group(1) @binding(0) var scene: texture_2d<f32>;
// x: metered factor on radiance, 1 for manual exposure
@group(1) @binding(1) var<uniform> metered: vec4f;

// Exposed luminance from which a smaller share is scattered: 3 stops over white. Lenses scatter the same share of the
// sun, but film and eye hardly see it beside the sun; by eye.
const GLARE_FROM: f32 = 8.0;
const GLARE: f32 = 0.09;
// Most luminance that is scattered, for a night's exposure beside a sun.
const GLARE_MOST: f32 = 8000.0;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let texel = 1.0 / vec2f(textureDimensions(scene));
    let first = frame.origin_px + 1.0;
    let last = frame.origin_px + frame.size_px - 1.0;
    let place = floor(position.xy) * 4.0 + 2.0;
    let exposure = frame.white * metered.x * frame.exposure;
    // A tent over 8 by 8 pixels.
    var sum = vec3f(0.0);
    for (var i = 0; i < 16; i++) {
        let step = vec2f(f32(i % 4), f32(i / 4)) * 2.0 - 3.0;
        let weight = (4.0 - abs(step.x)) * (4.0 - abs(step.y)) / 64.0;
        let at = clamp(frame.origin_px + place + step, first, last);
        let light = textureSampleLevel(scene, clamped, at * texel, 0.0).rgb * exposure;
        let bright = max(luminance(light), 1e-6);
        let spread = light * mix(GLARE, 1.0, min(bright, GLARE_FROM) / bright);
        sum += weight * spread * min(1.0, GLARE_MOST / max(luminance(spread), 1e-6));
    }
    return vec4f(frame.bloom * sum, 1.0);
}
