// From radiance to linear display values: white balance, exposure and tone curve (tone.wgsl), at the scene's
// resolution. Alpha: brightness in perceptually even steps, for the edge search in antialias.wgsl.
#include "bloom.wgsl"
#include "tone.wgsl"

@group(1) @binding(0) var hdr: texture_2d<f32>;
// x: metered factor on radiance, 1 for manual exposure; z: stops by which highlights exceed white; w: stops by which
// dark parts are lifted
@group(1) @binding(1) var<uniform> metered: vec4f;
// Square roots of the light of stars
@group(1) @binding(2) var stars: texture_2d<f32>;
@group(1) @binding(3) var bloom: texture_2d<f32>;

// An exposure for sunlit ground leaves little of the stars: the share at factor 1, and the factor from which all
// of their light is there. A camera would show none; by eye.
const STARS_IN_SUNLIGHT: f32 = 0.12;
const STARS_IN_FULL: f32 = 10.0;

// The cosine-fourth law of lenses: of a lens whose half diagonal spans 45 degrees, the corners get a quarter of the
// light of the middle. The vignette asks for a share of this.
fn shaded_by_lens(at: vec2f) -> f32 {
    if frame.vignette <= 0.0 { return 1.0; }
    let away = (at + frame.lens_shift) * frame.vignette_extent;
    let fall = 1.0 + dot(away, away);
    return mix(1.0, 1.0 / (fall * fall), frame.vignette);
}

// Light that the lens scatters to a place in the picture.
fn scattered(at: vec2f) -> vec3f {
    if frame.bloom <= 0.0 { return vec3f(0.0); }
    let whole = at * frame.whole_scale + frame.whole_offset;
    return smoothed(bloom, whole * vec2f(0.5, -0.5) + 0.5);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let radiance = textureLoad(hdr, vec2i(position.xy), 0).rgb;
    if frame.debug_view != VIEW_SHADED { return vec4f(saturate(radiance), 1.0); }
    let points = textureLoad(stars, vec2i(position.xy), 0).rgb;
    let starlight = clamp(metered.x / STARS_IN_FULL, STARS_IN_SUNLIGHT, 1.0);
    let exposed = (radiance * frame.white * metered.x + points * points * starlight) * frame.exposure;
    let at = (position.xy / frame.still_scale - frame.origin_px) / frame.size_px * vec2f(2.0, -2.0) + vec2f(-1.0, 1.0);
    let light = (exposed * (1.0 - frame.bloom) + scattered(at)) * shaded_by_lens(at);
    let shown = toned(light * fill(luminance(light), metered.w), frame.tone, metered.z);
    return vec4f(shown, sqrt(max(luminance(shown), 0.0)));
}
