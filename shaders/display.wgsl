// From linear display values to the caller's target: resampled to its size, encoded as sRGB, dithered.
#include "screen.wgsl"
#include "math.wgsl"

// rgb: linear display values
@group(1) @binding(0) var shown: texture_2d<f32>;

// Whether the format of the target encodes sRGB in hardware.
override TARGET_ENCODES_SRGB: bool = false;
// Whether the target takes linear values: floats of 32 bits, of which a photograph is made.
override TARGET_IS_LINEAR: bool = false;

fn encode_srgb(c: vec3f) -> vec3f {
    let low = c * 12.92;
    let high = 1.055 * pow(max(c, vec3f(0.0031308)), vec3f(1.0 / 2.4)) - 0.055;
    return select(high, low, c <= vec3f(0.0031308));
}

fn decode_srgb(c: vec3f) -> vec3f {
    let high = pow((max(c, vec3f(0.04045)) + 0.055) / 1.055, vec3f(2.4));
    return select(high, c / 12.92, c <= vec3f(0.04045));
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    var light = vec3f(0.0);
    let scale = frame.render_scale * frame.still_scale;
    if scale == 1.0 {
        light = textureLoad(shown, pixel, 0).rgb;
    } else {
        // At render scale 2, the sample lies between four pixels and is their mean; at 0.5, it is bilinear.
        let at = position.xy * scale / vec2f(textureDimensions(shown));
        light = textureSampleLevel(shown, clamped, at, 0.0).rgb;
    }
    if TARGET_IS_LINEAR { return vec4f(saturate(light), 1.0); }
    var encoded = encode_srgb(light);
    if frame.debug_view == VIEW_SHADED {
        // Triangular noise with the amplitude of one step hides the 256 steps of the display.
        let bits = hash3(vec3u(vec2u(pixel) - vec2u(frame.origin_px), 7u));
        // No noise on black, so that black stays exactly black.
        let strength = min(encoded, vec3f(1.0 / 255.0));
        encoded += (unit_from_hash(bits) - unit_from_hash(hash3(bits + 1u))) * strength;
    }
    encoded = saturate(encoded);
    if TARGET_ENCODES_SRGB { return vec4f(decode_srgb(encoded), 1.0); }
    return vec4f(encoded, 1.0);
}
