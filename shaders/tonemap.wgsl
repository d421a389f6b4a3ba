// From radiance to linear display values: white balance, exposure and tone curve (tone.wgsl), at the scene's
// resolution. Alpha: brightness in perceptually even steps, for the edge search in antialias.wgsl.
#include "screen.wgsl"
#include "tone.wgsl"

@group(1) @binding(0) var hdr: texture_2d<f32>;
// x: metered factor on radiance, 1 for manual exposure
@group(1) @binding(1) var<uniform> metered: vec4f;
// Square roots of the light of stars, which metering does not change
@group(1) @binding(2) var stars: texture_2d<f32>;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let radiance = textureLoad(hdr, vec2i(position.xy), 0).rgb;
    if frame.debug_view != VIEW_SHADED { return vec4f(saturate(radiance), 1.0); }
    let points = textureLoad(stars, vec2i(position.xy), 0).rgb;
    let shown = toned((radiance * frame.white * metered.x + points * points) * frame.exposure, frame.tone);
    return vec4f(shown, sqrt(max(luminance(shown), 0.0)));
}
