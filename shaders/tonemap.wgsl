// From radiance to what a display shows, linear: white balance, exposure and a curve (tone.wgsl), pixel by pixel of the scene.
// Alpha: how bright it looks, about even steps for the eye, by which edges are found (antialias.wgsl).
#include "screen.wgsl"
#include "tone.wgsl"

@group(1) @binding(0) var hdr: texture_2d<f32>;
// x: factor that was metered, 1 for manual exposure
@group(1) @binding(1) var<uniform> metered: vec4f;
// Square roots of what stars show, whatever was metered
@group(1) @binding(2) var stars: texture_2d<f32>;

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let radiance = textureLoad(hdr, vec2i(position.xy), 0).rgb;
    if frame.debug_view != VIEW_SHADED { return vec4f(saturate(radiance), 1.0); }
    let points = textureLoad(stars, vec2i(position.xy), 0).rgb;
    let shown = toned((radiance * frame.white * metered.x + points * points) * frame.exposure, frame.tone);
    return vec4f(shown, sqrt(max(luminance(shown), 0.0)));
}
