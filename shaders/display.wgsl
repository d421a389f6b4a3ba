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

// Weights of three pixels in a row for a place nearest to the middle one: those of a spline (Catmull and Rom, A class
// of local interpolating splines, 1974), whose fourth pixel, of the least weight, is taken to be like its neighbour.
// `x`: of the place from the middle of the pixel, -0.5 to 0.5.
fn spline_weights(x: f32) -> vec3f {
    let a = abs(x);
    let behind = -0.5 * a * (1.0 - a) * (1.0 - a);
    let here = 1.0 + a * a * (1.5 * a - 2.5);
    let ahead = 1.0 - behind - here;
    return select(vec3f(behind, here, ahead), vec3f(ahead, here, behind), x < 0.0);
}

// An enlarged picture, by splines: straight lines between pixels would blur it. No darker and no brighter than the four
// pixels around, as splines overshoot beside bright edges.
fn enlarged(at_px: vec2f) -> vec3f {
    let last = vec2i(textureDimensions(shown)) - 1;
    let middle = vec2i(at_px);
    let aside = at_px - 0.5 - vec2f(middle);
    let across = spline_weights(aside.x);
    let down = spline_weights(aside.y);
    // Those of the nine that are nearest.
    let first = select(vec2i(1), vec2i(0), aside < vec2f(0.0));
    var sum = vec3f(0.0);
    var least = vec3f(1e9);
    var most = vec3f(0.0);
    for (var y = 0; y < 3; y++) {
        for (var x = 0; x < 3; x++) {
            let light = textureLoad(shown, clamp(middle + vec2i(x, y) - 1, vec2i(0), last), 0).rgb;
            sum += light * (across[x] * down[y]);
            let is_near = all(vec2i(x, y) - first >= vec2i(0)) && all(vec2i(x, y) - first <= vec2i(1));
            least = select(least, min(least, light), is_near);
            most = select(most, max(most, light), is_near);
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
