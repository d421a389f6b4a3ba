// From radiance to what a display shows: exposure, a curve (tone.wgsl), dither; shrinks or enlarges to the target.
#include "screen.wgsl"
#include "tone.wgsl"

@group(1) @binding(0) var hdr: texture_2d<f32>;
// x: factor that was metered, 1 for manual exposure
@group(1) @binding(1) var<uniform> metered: vec4f;

fn encode_srgb(c: vec3f) -> vec3f {
    let low = c * 12.92;
    let high = 1.055 * pow(max(c, vec3f(0.0031308)), vec3f(1.0 / 2.4)) - 0.055;
    return select(high, low, c <= vec3f(0.0031308));
}

fn decode_srgb(c: vec3f) -> vec3f {
    let high = pow((max(c, vec3f(0.04045)) + 0.055) / 1.055, vec3f(2.4));
    return select(high, c / 12.92, c <= vec3f(0.04045));
}

fn show(radiance: vec3f) -> vec3f {
    if globals.modes.x != 0u { return saturate(radiance); }
    return toned(radiance * (globals.misc.w * metered.x), globals.modes.w);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    var shown = vec3f(0.0);
    if globals.modes.y == 2u {
        // Each sample is shown first and averaged then, so that a bright edge stays smooth.
        for (var i = 0; i < 4; i++) {
            let at = pixel * 2 + vec2i(i & 1, i >> 1u);
            shown += show(textureLoad(hdr, at, 0).rgb) * 0.25;
        }
    } else if globals.modes.y == 1u {
        shown = show(textureLoad(hdr, pixel, 0).rgb);
    } else {
        let size = vec2f(textureDimensions(hdr));
        shown = show(textureSampleLevel(hdr, clamped, position.xy * 0.5 / size, 0.0).rgb);
    }
    var encoded = encode_srgb(shown);
    if globals.modes.x == 0u {
        // Triangular noise of one step hides the 256 steps of the display.
        let bits = hash3(vec3u(vec2u(pixel), 7u));
        // None on black, which is exact.
        let strength = min(encoded, vec3f(1.0 / 255.0));
        encoded += (unit_from_hash(bits) - unit_from_hash(hash3(bits + 1u))) * strength;
    }
    encoded = saturate(encoded);
    if globals.modes.z == 1u { return vec4f(decode_srgb(encoded), 1.0); }
    return vec4f(encoded, 1.0);
}
