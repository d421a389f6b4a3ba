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

// Weights of four pixels in a row for a place between the middle two (Catmull and Rom, A class of local interpolating
// splines, 1974). `x`: of the place, 0 to 1.
fn spline_weights(x: f32) -> vec4f {
    let x2 = x * x;
    let x3 = x2 * x;
    return 0.5 * vec4f(2.0 * x2 - x - x3, 3.0 * x3 - 5.0 * x2 + 2.0, x + 4.0 * x2 - 3.0 * x3, x3 - x2);
}

// An enlarged picture, by splines: straight lines between pixels would blur it. No darker and no brighter than the four
// pixels around, as splines overshoot beside bright edges.
fn enlarged(at_px: vec2f) -> vec3f {
    let last = vec2i(textureDimensions(shown)) - 1;
    let corner = floor(at_px - 0.5);
    let part = at_px - 0.5 - corner;
    let across = spline_weights(part.x);
    let down = spline_weights(part.y);
    var sum = vec3f(0.0);
    var least = vec3f(1e9);
    var most = vec3f(0.0);
    for (var i = 0; i < 16; i++) {
        let place = vec2i(i % 4, i / 4);
        let light = textureLoad(shown, clamp(vec2i(corner) + place - 1, vec2i(0), last), 0).rgb;
        sum += light * (across[place.x] * down[place.y]);
        if all(place >= vec2i(1)) && all(place <= vec2i(2)) {
            least = min(least, light);
            most = max(most, light);
        }
    }
    return clamp(sum, least, most);
}

@fragment
fn fragment(@builtin(position) position: vec4f) -> @location(0) vec4f {
    let pixel = vec2i(position.xy);
    var light = vec3f(0.0);
    let scale = frame.render_scale * frame.still_scale;
    if scale == 1.0 {
        light = textureLoad(shown, pixel, 0).rgb;
    } else if scale < 1.0 {
        light = enlarged(position.xy * scale);
    } else {
        // At render scale 2, the sample lies between four pixels and is their mean.
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
